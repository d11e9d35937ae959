//! Albedos of many spheres, one for each.

use glam::DVec3;

use super::color::Color;
use super::color::is_grey;

/// Albedos of spheres that do not have their material's.
#[derive(Clone, Debug, PartialEq)]
pub enum Albedos {
    /// Red, green and blue, linear, of each sphere: 12 bytes.
    Each(Vec<[f32; 3]>),
    /// For each sphere one of at most 256 colors: a byte. An index beyond the colors stands for the
    /// material's albedo.
    Palette {
        /// The colors.
        colors: Vec<Color>,
        /// For each sphere the index of its color.
        indices: Vec<u8>,
    },
}

impl Albedos {
    /// For how many spheres there are albedos.
    pub fn len(&self) -> usize {
        match self {
            Self::Each(albedos) => albedos.len(),
            Self::Palette { indices, .. } => indices.len(),
        }
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The albedo of one of the spheres.
    pub fn get(&self, index: usize) -> Option<Color> {
        match self {
            Self::Each(albedos) => {
                let albedo = albedos.get(index)?;
                Some(DVec3::from_array(albedo.map(f64::from)))
            }
            Self::Palette { colors, indices } => {
                colors.get(usize::from(*indices.get(index)?)).copied()
            }
        }
    }

    /// True where none has a color.
    pub(crate) fn are_grey(&self) -> bool {
        match self {
            Self::Each(albedos) => albedos
                .iter()
                .all(|[red, green, blue]| red == green && green == blue),
            Self::Palette { colors, indices } => {
                let mut is_used = [false; 256];
                for index in indices {
                    is_used[usize::from(*index)] = true;
                }
                let used = colors.iter().zip(&is_used).filter(|(_, used)| **used);
                used.into_iter().all(|(color, _)| is_grey(*color))
            }
        }
    }
}
