//! A picture in memory.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use marbles_core::{Summary, View};
use marbles_scene::Scene;

use super::error::Error;
use crate::base::size::Size;
use crate::formats::facts::Facts;
use crate::formats::form::Form;
use crate::formats::npy::memory::{NamedArray, Numbers};
use crate::formats::sidecar::Sidecar;
use crate::sequence::collector::Collected;
use crate::sequence::digest::Input;
use crate::sequence::layers::layer_name;
use crate::sequence::parts::PicturePart;

/// A picture, with its arrays, and all that is needed to save it.
pub struct Picture {
    pub(super) scene: Arc<Scene>,
    pub(super) scene_path: PathBuf,
    pub(super) facts: Facts,
    pub(super) form: Form,
    pub(super) part: PicturePart,
    pub(super) input: Input,
    pub(super) summary: Summary,
    /// The checksum of the light and the errors as they were rendered.
    pub(super) checksum: u32,
    arrays: Vec<PictureArray>,
    per_light: Vec<(String, Picture)>,
}

/// An array of a picture.
pub struct PictureArray {
    /// Its name: `light`, `error`, `bound`, or that of channels.
    pub name: String,
    /// Rows, columns, and the numbers for each pixel if there is more than one.
    pub shape: Vec<usize>,
    /// Its numbers, row by row from the top.
    pub numbers: Numbers,
}

impl Picture {
    /// The picture of a frame, from those of its parts, of which the last one shows all light.
    pub(super) fn of_frame(
        scene: &Arc<Scene>,
        path: &Path,
        parts: &[PicturePart],
        collected: Vec<Collected>,
    ) -> Result<Self, Error> {
        let names = &scene.description().lights;
        let count = scene.world().lights.len();
        let mut pictures: Vec<(String, Self)> = Vec::new();
        for collected in collected {
            let part = &parts[collected.part];
            let name = part.light.map(|light| layer_name(light, count, names));
            let picture = Self::new(scene, path, part, collected);
            pictures.push((name.unwrap_or_default(), picture));
        }
        let whole = pictures.pop();
        let (_, whole) =
            whole.ok_or_else(|| Error::Work("the picture is not complete".to_owned()))?;
        Ok(Self {
            per_light: pictures,
            ..whole
        })
    }

    fn new(scene: &Arc<Scene>, path: &Path, part: &PicturePart, collected: Collected) -> Self {
        let Collected {
            facts,
            form,
            input,
            arrays,
            summary,
            ..
        } = collected;
        let arrays: Vec<PictureArray> = arrays.into_iter().map(PictureArray::new).collect();
        let lit = arrays.iter().filter_map(|array| match &array.numbers {
            Numbers::F64(numbers) => Some((&*array.name, &**numbers)),
            Numbers::U32(_) | Numbers::Bool(_) => None,
        });
        Self {
            scene: Arc::clone(scene),
            scene_path: path.to_owned(),
            facts,
            form,
            part: part.clone(),
            input,
            summary,
            checksum: checksum(lit),
            arrays,
            per_light: Vec::new(),
        }
    }

    /// The number of the frame.
    pub fn frame(&self) -> i32 {
        self.facts.frame
    }

    /// The number of columns and rows.
    pub fn size(&self) -> (u32, u32) {
        let Size { width, height } = self.form.region.size();
        (width, height)
    }

    /// The errors of the picture as a whole.
    pub fn summary(&self) -> Summary {
        self.summary
    }

    /// Takes the arrays: light, errors, `bound`, and then the channels.
    pub fn take_arrays(&mut self) -> Vec<PictureArray> {
        std::mem::take(&mut self.arrays)
    }

    /// Takes the pictures of single lights with their names, that of ambient light last.
    pub fn take_per_light(&mut self) -> Vec<(String, Self)> {
        std::mem::take(&mut self.per_light)
    }

    /// The text of the sidecar of a picture: JSON with the camera, the lights and the errors.
    ///
    /// # Errors
    /// None that is known.
    pub fn sidecar(&self) -> Result<String, Error> {
        self.sidecar_of(&self.facts)
    }

    pub(super) fn sidecar_of(&self, facts: &Facts) -> Result<String, Error> {
        let (path, view) = (&self.scene_path, &facts.view);
        let mut sidecar = Sidecar::of(&self.scene, path, facts.frame, view);
        if let Some(light) = self.part.light {
            sidecar = sidecar.under(light);
        }
        let (region, summary) = (&self.form.region, &self.summary);
        let sidecar = sidecar.with_results(region, facts.method, summary, &facts.digest);
        sidecar.text().map_err(Error::Work)
    }
}

impl PictureArray {
    fn new(array: NamedArray) -> Self {
        let NamedArray {
            name,
            array,
            numbers,
        } = array;
        let Size { width, height } = array.size;
        let sides = [Some(height), Some(width), array.channels];
        Self {
            name,
            shape: sides
                .into_iter()
                .flatten()
                .map(|side| side as usize)
                .collect(),
            numbers,
        }
    }
}

/// The checksum of the light and the errors among some arrays.
pub(super) fn checksum<'a>(arrays: impl Iterator<Item = (&'a str, &'a [f64])>) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    for (name, numbers) in arrays {
        if ["light", "error"].contains(&name) {
            for part in numbers.chunks(1 << 10) {
                let mut bytes = [0; 8 << 10];
                for (bytes, number) in bytes.chunks_exact_mut(8).zip(part) {
                    bytes.copy_from_slice(&number.to_le_bytes());
                }
                hasher.update(&bytes[..8 * part.len()]);
            }
        }
    }
    hasher.finalize()
}

/// The sidecar of a picture of a frame without its errors, in the scene's size or another one.
///
/// # Errors
/// If there is no such frame.
pub fn sidecar_of(
    scene: &Scene,
    path: &Path,
    frame: i32,
    size: Option<(u32, u32)>,
) -> Result<String, Error> {
    let view = scene.view(frame);
    let view: View = view.map_err(|error| Error::Value(error.to_string()))?;
    let size = size.map(|(width, height)| Size { width, height });
    let view = size.map_or(view, |size| size.resize(view));
    let sidecar = Sidecar::of(scene, path, frame, &view);
    sidecar.text().map_err(Error::Work)
}
