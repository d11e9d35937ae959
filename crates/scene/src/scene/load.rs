//! The way from a scene file to a scene.

use std::fs::File as OpenFile;
use std::io::{self, ErrorKind, Read as _};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::{CloudDescription, Description, Scene};
use crate::file::{Camera, File, Materials};
use crate::motion::{CameraMotion, Lights};
use crate::report::SceneError;
use crate::text::{Fault, Placed, Read, Slice, collect, optional, reason, token};
use crate::values::MaterialName;
use crate::world::{self, Cloud, CloudError, Progress};

/// The largest scene file that is read, in bytes: more than ten million spheres take, and a limit
/// for files that never end.
const LARGEST_FILE: u64 = 1 << 30;

/// Bytes that are read at a time.
const BLOCK: u64 = 1 << 20;

impl Scene {
    /// Reads and checks the scene file at `path`, and the tables that it names.
    ///
    /// Tables are read on the threads of the current rayon pool.
    ///
    /// # Errors
    /// Refuses what is not a readable file of at most 1 GiB, and everything that the format and
    /// those of the tables do not allow.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::load_watched(path, &|_| {})
    }

    /// Loads as [`Self::load`] does, and calls `watch` each time that some megabytes of a table were
    /// read.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn load_watched(path: &Path, watch: &dyn Fn(Progress<'_>)) -> Result<Self, SceneError> {
        if path.is_dir() {
            let reason = "expected a scene file, found a folder";
            return Err(SceneError::unreadable(path, reason));
        }
        let bytes = read_at_most(path, LARGEST_FILE).map_err(|error| {
            let why = match error.kind() {
                ErrorKind::NotFound => "no such file",
                ErrorKind::PermissionDenied => "no permission to read this file",
                ErrorKind::FileTooLarge => {
                    "expected a scene file of at most 1 GiB, found a larger one"
                }
                ErrorKind::OutOfMemory => "there is no memory to read this file",
                _ => &reason(&error),
            };
            SceneError::unreadable(path, why)
        })?;
        let text = str::from_utf8(&bytes).map_err(|error| error.valid_up_to());
        let text = text.and_then(|text| {
            text.strip_suffix('\0')
                .map_or(Ok(text), |text| Err(text.len()))
        });
        match text {
            Ok(text) => Self::parse_watched(text, path, watch),
            Err(valid_up_to) => {
                let (valid, rest) = bytes.split_at(valid_up_to);
                let valid = without_byte_order_mark(str::from_utf8(valid).unwrap_or_default());
                let byte = rest.first().copied().unwrap_or_default();
                let expected = if byte == 0 { "text" } else { "text in UTF-8" };
                let message = format!("expected {expected}, found the byte 0x{byte:02x}");
                let fault = Fault::new(valid.len()..valid.len(), message);
                Err(SceneError::refused(path, valid, vec![fault]))
            }
        }
    }

    /// Checks a scene file's text; `path` is named in messages, and its folder is where tables are.
    ///
    /// A byte order mark at the start is skipped.
    ///
    /// # Errors
    /// Refuses everything that the format does not allow.
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneError> {
        Self::parse_watched(text, path, &|_| {})
    }

    fn parse_watched(
        text: &str,
        path: &Path,
        watch: &dyn Fn(Progress<'_>),
    ) -> Result<Self, SceneError> {
        let text = without_byte_order_mark(text);
        let (draft, faults) = collect(text, || {
            let start = token::skip_trivia(text, 0);
            let file = File::read(Slice::of_text_being_read(&text[start..]))?;
            Draft::new(&file, text)
        });
        match draft {
            Some(draft) if faults.is_empty() => draft.finish(text, path, watch),
            _ => Err(SceneError::refused(path, text, faults)),
        }
    }
}

/// A scene whose tables are not yet read.
struct Draft {
    scene: Scene,
    clouds: Vec<Cloud>,
    /// The part of the picture that a framing camera fills.
    fill: Option<f64>,
    /// The place of the camera in the text.
    camera: Range<usize>,
}

impl Draft {
    /// The scene of a file; `None` where a fault was reported.
    fn new(file: &File, text: &str) -> Option<Self> {
        // Each part is made before any is missed, so that the faults of all are told.
        let world = world::world(file);
        let motion = CameraMotion::new(file, text);
        let lights = Lights::new(file);
        let lens = world::lens(&file.lens, &file.image);
        let image = file.image.value.as_ref()?;
        let (mut world, clouds) = world?;
        let lights = lights?;
        world.has_colored_lights = lights.may_have_color();
        let camera = file.camera.value.as_ref()?;
        let fill = match camera {
            Camera::Frame { fill, .. } => Some(fill.get()?.0),
            _ => None,
        };
        let scene = Scene {
            world,
            motion: motion?,
            lights,
            lens: lens?,
            width: image.width.get()?.0,
            height: image.height.get()?.0,
            description: Description {
                materials: names(&file.materials)?,
                lights: Vec::new(),
                camera: camera.kind(),
                animation: optional(&file.animation, |animation| Some(animation.kind()))?,
                lens: world::lens_as_written(&file.lens)?,
            },
            clouds: Vec::new(),
        };
        Some(Self {
            scene,
            clouds,
            fill,
            camera: file.camera.place.clone(),
        })
    }

    /// Reads the tables, and places the camera where that depends on the spheres.
    fn finish(
        self,
        text: &str,
        path: &Path,
        watch: &dyn Fn(Progress<'_>),
    ) -> Result<Scene, SceneError> {
        let mut scene = self.scene;
        let folder = path.parent().unwrap_or(Path::new(""));
        for cloud in &self.clouds {
            let spheres = cloud.add_to(&mut scene.world, folder, watch);
            let spheres = spheres.map_err(|error| match error {
                CloudError::Scene(fault) => SceneError::refused(path, text, vec![fault]),
                CloudError::Table(table, fault) => {
                    SceneError::in_table(&table, fault, (path, text, &cloud.place))
                }
            })?;
            let file = PathBuf::from(&cloud.name);
            scene.clouds.push(CloudDescription { file, spheres });
        }
        if let Some(fill) = self.fill {
            let picture = scene.picture(fill);
            let Some(scale) = scene.motion.frame(scene.world.spheres(), &picture) else {
                let place = self.camera.start..token::token_end(text, self.camera.start);
                let message = "expected spheres for a `Frame` camera, found none";
                let fault = Fault::new(place, message);
                return Err(SceneError::refused(path, text, vec![fault]));
            };
            scene.lens.width *= scale;
            scene.lens.shift *= scale;
        }
        scene.description.lights = scene.lights.names();
        scene.world.lights = scene.first_lights();
        Ok(scene)
    }
}

/// The names of materials that were not refused.
fn names(materials: &Materials) -> Option<Vec<String>> {
    let name = |name: &Placed<MaterialName>| Some(name.value.as_ref()?.0.clone());
    materials.0.iter().map(|(key, _)| name(key)).collect()
}

/// The bytes of a file that has at most `most`, up to the first of 0; [`ErrorKind::FileTooLarge`] where it has more.
fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = OpenFile::open(path)?;
    let mut bytes = Vec::new();
    // What the size says is not always so: devices and pipes have none.
    let size = file.metadata()?.len();
    if size <= most {
        let mut rest = file.take(most + 1);
        let mut seen = 0;
        // No text has a byte of 0: what has one may never end.
        while rest.by_ref().take(BLOCK).read_to_end(&mut bytes)? > 0 {
            if let Some(zero) = bytes[seen..].iter().position(|&byte| byte == 0) {
                bytes.truncate(seen + zero + 1);
                return Ok(bytes);
            }
            seen = bytes.len();
        }
    }
    if size.max(bytes.len() as u64) > most {
        return Err(ErrorKind::FileTooLarge.into());
    }
    Ok(bytes)
}

/// The text behind a byte order mark.
fn without_byte_order_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

#[cfg(test)]
mod tests;
