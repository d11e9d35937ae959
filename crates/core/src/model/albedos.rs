//! Albedos of many spheres, one for each.

use glam::DVec3;

use super::color::Color;
use super::color::is_grey;
use crate::numeric::pair::three;

/// Albedos of spheres, in place of their material's.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Albedos, Material, Sphere, World};
///
/// let mut world = World::new();
/// let white = world.add_material(Material::default());
/// let spheres = vec![Sphere::new(DVec3::ZERO, 1.0)?, Sphere::new(DVec3::X, 1.0)?];
/// let red_and_blue = Albedos::Each(vec![[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
/// world.add_spheres(spheres, white, Some(red_and_blue));
/// assert_eq!(world.albedo(1), DVec3::new(0.0, 0.0, 1.0));
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
    /// Returns the number of spheres that have albedos.
    pub fn len(&self) -> usize {
        match self {
            Self::Each(albedos) => albedos.len(),
            Self::Palette { indices, .. } => indices.len(),
        }
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The albedo of one of the spheres.
    pub fn get(&self, index: usize) -> Option<Color> {
        match self {
            Self::Each(albedos) => {
                let albedo = albedos.get(index)?;
                Some(DVec3::from_array(three(*albedo, f64::from)))
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
