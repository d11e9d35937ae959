//! Pictures as files, and what else is written.
//!
//! A file is encoded in memory, written beside its place under a temporary name, and moved there
//! when it is complete.

mod exr;
mod half;
mod header;
mod png;
pub(crate) mod srgb;
pub(crate) mod temporary;

use std::path::{Path, PathBuf};

use marbles_core::{Camera, Image, Method};

pub(crate) use self::exr::ExrOptions;
pub(crate) use self::png::PngOptions;
use self::temporary::TemporaryFile;
use crate::failure::{Failure, lower};
use crate::memory::Form;

/// What files say about who wrote them.
const SOFTWARE: &str = concat!("marbles ", env!("CARGO_PKG_VERSION"));

/// How pictures are turned into bytes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Encoding {
    Png(PngOptions),
    Exr(ExrOptions),
}

impl Encoding {
    /// Bytes that encoding a picture of this form takes at most, the file's own included.
    pub(crate) fn memory(self, form: &Form) -> u64 {
        match self {
            Self::Png(options) => options.memory(form),
            Self::Exr(options) => options.memory(form),
        }
    }
}

/// What a file says about its picture beside the pixels, where the format has room for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    pub(crate) camera: Camera,
    pub(crate) frame: i32,
    pub(crate) frames_per_second: Option<f64>,
    pub(crate) method: Method,
}

/// A file in memory.
struct Encoded {
    bytes: Vec<u8>,
    /// How many finite numbers were too large for the format's floats.
    clipped: u64,
}

/// What became of a file that was written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Written {
    /// How many numbers are the largest of the format's floats in place of a larger one.
    pub(crate) clipped: u64,
}

/// Makes sure that a file can be created at `path`, folders included, and leaves none.
pub(crate) fn prepare(path: &Path) -> Result<(), Failure> {
    let destination = destination(path)?;
    let folder = folder(&destination);
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::io(folder, "cannot create the folder", &error))?;
    TemporaryFile::beside(&destination)
        .map(drop)
        .map_err(|error| Failure::io(path, "cannot create the file", &error))
}

/// Writes a picture to `path`, whole or not at all.
pub(crate) fn write(
    image: &Image,
    facts: &Facts,
    encoding: Encoding,
    path: PathBuf,
) -> Result<Written, Failure> {
    let encoded = match encoding {
        Encoding::Png(options) => options.encode(image),
        Encoding::Exr(options) => options.encode(image, facts),
    };
    save(encoded, &path)
}

/// Writes a grey PNG of 8 bit codes, row by row, whole or not at all.
pub(crate) fn write_codes(
    width: u32,
    height: u32,
    codes: &[u8],
    path: &Path,
) -> Result<Written, Failure> {
    save(png::grey(width, height, codes), path)
}

/// Writes a PNG of 8 bit codes of red, green and blue, row by row, whole or not at all.
pub(crate) fn write_rgb_codes(
    width: u32,
    height: u32,
    codes: &[u8],
    path: &Path,
) -> Result<(), Failure> {
    save(png::rgb(width, height, codes), path).map(drop)
}

/// Writes a file that is no picture, or already encoded, whole or not at all.
pub(crate) fn write_bytes(bytes: Vec<u8>, path: &Path) -> Result<(), Failure> {
    save(Ok(Encoded { bytes, clipped: 0 }), path).map(drop)
}

/// Writes an EXR of channels in single precision, whole or not at all.
pub(crate) fn write_floats(
    width: u32,
    height: u32,
    channels: Vec<(&str, Vec<f32>)>,
    path: &Path,
) -> Result<Written, Failure> {
    save(
        exr::floats((width as usize, height as usize), channels),
        path,
    )
}

/// Puts a file where it belongs, if it could be encoded.
fn save(encoded: Result<Encoded, String>, path: &Path) -> Result<Written, Failure> {
    let Encoded { bytes, clipped } = encoded.map_err(|error| {
        Failure::at(
            path,
            &format!("cannot encode the picture: {}", lower(&error)),
        )
    })?;
    let destination = destination(path)?;
    TemporaryFile::beside(&destination)
        .and_then(|mut file| {
            file.write(&bytes)?;
            file.persist()
        })
        .map_err(|error| Failure::io(path, "cannot write the file", &error))?;
    Ok(Written { clipped })
}

/// Where the file for `path` belongs: at the end of symbolic links, which stay as they are, and
/// only in place of another file.
fn destination(path: &Path) -> Result<PathBuf, Failure> {
    /// As many as Linux follows.
    const MOST_LINKS: usize = 40;
    let mut destination = path.to_owned();
    for _ in 0..=MOST_LINKS {
        let Ok(target) = std::fs::read_link(&destination) else {
            return match std::fs::metadata(&destination) {
                Ok(found) if found.is_dir() => Err("there is a folder"),
                Ok(found) if !found.is_file() => Err("there is something that is no file"),
                _ => Ok(destination),
            }
            .map_err(|what| Failure::at(path, &format!("cannot write the file: {what}")));
        };
        // A relative target starts at the folder of the link; an absolute one replaces it.
        destination = folder(&destination).join(target);
    }
    let what = "cannot create the file: too many symbolic links";
    Err(Failure::at(path, what))
}

/// The folder that a file lies in.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::num::NonZeroU32;
    use std::ops::ControlFlow;

    use glam::{DVec2, DVec3};
    use marbles_core::{
        Angle, Camera, DirectionalLight, Image, Lens, Material, Method, Settings, Sphere, View,
        World,
    };

    use super::{ExrOptions, Facts, PngOptions};

    /// The bytes of a PNG file.
    pub(crate) fn png(image: &Image, options: PngOptions) -> Vec<u8> {
        options.encode(image).unwrap().bytes
    }

    /// The bytes of an EXR file.
    pub(crate) fn exr(image: &Image, options: ExrOptions) -> Vec<u8> {
        let facts = Facts {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            frame: 1,
            frames_per_second: None,
            method: Method::Samples(NonZeroU32::MIN),
        };
        options.encode(image, &facts).unwrap().bytes
    }

    /// Light on a ball.
    #[derive(Clone, Copy, Debug)]
    pub(crate) enum Scene {
        Grey,
        Color,
        /// More light than a half can hold.
        Bright,
    }

    /// A small picture of a ball before a background.
    pub(crate) fn render(scene: Scene, alpha: bool) -> Image {
        let (albedo, background, intensity) = match scene {
            Scene::Grey => (DVec3::ONE, DVec3::splat(0.25), 1.0),
            Scene::Color => (DVec3::new(1.0, 0.5, 0.001), DVec3::new(0.0, 0.2, 0.4), 1.5),
            Scene::Bright => (DVec3::ONE, DVec3::ZERO, 1e5),
        };
        let mut world = World::new();
        let material = world.add_material(Material {
            albedo,
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(4.0 * DVec3::Z, 1.0).unwrap(), material);
        world.background = background;
        let toward = DVec3::new(-1.0, 1.0, -1.0);
        let light = DirectionalLight::new(toward, DVec3::splat(intensity)).unwrap();
        world.lights.push(light);
        let view = View {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens {
                width: 0.6,
                distance: 1.0,
                shift: DVec2::ZERO,
            },
            zoom: 1.0,
            width: 23,
            height: 19,
            frame: 1,
        };
        let settings = Settings {
            method: Method::Samples(NonZeroU32::new(3).unwrap()),
            alpha,
        };
        marbles_core::Renderer::new(&world)
            .render(&view, &settings, &|_| ControlFlow::Continue(()))
            .unwrap()
    }
}
