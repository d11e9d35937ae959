//! The way from a scene file to a scene.

use std::borrow::Cow;
use std::fs::File as OpenFile;
use std::io::{ErrorKind, Read as _};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::other_file::{self, Kind};
use super::oversights;
use super::own_camera::AsWritten;
use super::read::{BLOCK, LARGEST_FILE, STANDARD_INPUT, read_at_most, read_standard_input};
use super::refused::refused;
use super::setting::Setting;
use super::{Description, Scene};
use crate::figure::Figure;
use crate::file::{Camera, File, Materials};
use crate::motion::{CameraMotion, Lights};
use crate::report::SceneError;
use crate::text::{
    Fault, Placed, Read, Slice, collect, is_json, optional, reason, set, to_ron, token,
};
use crate::values::{MOST_FRAMES, MaterialName};
use crate::world::{self, Cloud, OpenCloud, Part, Progress, Series, Step};

impl Scene {
    /// Reads and checks the scene file at `path`, and the tables that it names; or the scene in the standard input if the path
    /// is [`STANDARD_INPUT`], whose tables are in the current folder.
    ///
    /// Tables are read on the threads of the current rayon pool.
    ///
    /// # Errors
    /// Refuses what is not a readable file of at most 1 GiB, and everything that the format and
    /// those of the tables do not allow.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::load_with(path, &[], &|_| {})
    }

    /// Loads as [`Self::load`] does with the values of `settings` in place of the file's own, and calls `watch` each
    /// time that some megabytes of a table were read.
    ///
    /// # Errors
    /// As [`Self::load`]; places in messages are those of the file with the settings. Refuses settings of what the
    /// file does not have.
    pub fn load_with(
        path: &Path,
        settings: &[Setting],
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        Self::load_figure(path, &Figure::default(), settings, watch)
    }

    /// Loads a scene file as [`Self::load_with`] does, with the values that `figure` replaces; or loads the figure of a
    /// table of particles.
    ///
    /// # Errors
    /// As [`Self::load_with`].
    pub fn load_figure(
        path: &Path,
        figure: &Figure,
        settings: &[Setting],
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        if path.is_dir() {
            let reason = "expected a scene file, found a folder";
            return Err(SceneError::unreadable(path, reason));
        }
        if other_file::is_named_pipe(path) {
            let reason = "expected a scene file, found a named pipe";
            return Err(SceneError::unreadable(path, reason));
        }
        let is_input = path == Path::new(STANDARD_INPUT);
        if !is_input && let Some(name) = table_name(path)? {
            let text = figure.scene_text(path, &name);
            let own_path = path.with_file_name(format!("{name} (its scene)"));
            let scene = Self::parse_with(&text, &own_path, settings, watch);
            return scene.map_err(SceneError::of_table_alone);
        }
        let bytes = if is_input {
            read_standard_input()
        } else {
            read_at_most(path, LARGEST_FILE)
        };
        let bytes = bytes.map_err(|error| {
            let why = match error.kind() {
                ErrorKind::NotFound => "no such file",
                ErrorKind::PermissionDenied => "no permission to read this file",
                ErrorKind::FileTooLarge => {
                    "expected a scene file of at most 1 GiB, found a larger one"
                }
                ErrorKind::OutOfMemory => "there is not enough memory to read this file",
                _ => &reason(&error),
            };
            SceneError::unreadable(path, why)
        })?;
        match other_file::kind(path, &bytes) {
            Kind::Scene => {}
            Kind::Table => {
                let message =
                    "expected a scene, found a table that is not a regular file: save it as one";
                return Err(SceneError::unreadable(path, message));
            }
            Kind::Other(message) => return Err(SceneError::unreadable(path, &message)),
        }
        let text = str::from_utf8(&bytes).map_err(|error| error.valid_up_to());
        let text = text.and_then(|text| {
            text.strip_suffix('\0')
                .map_or(Ok(text), |text| Err(text.len()))
        });
        match text {
            Ok(text) => {
                let own = figure.settings().into_iter();
                let own = own.map(|(path, value)| Setting::new(path, &value));
                let settings: Vec<Setting> = own.chain(settings.iter().cloned()).collect();
                Self::parse_with(text, path, &settings, watch)
            }
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

    /// Returns whether the file at `path` is a table of particles.
    ///
    /// # Errors
    /// Refuses files that cannot be opened, and files of other kinds than scenes and tables.
    pub fn is_table(path: &Path) -> Result<bool, SceneError> {
        let refused = |reason: &str| Err(SceneError::unreadable(path, reason));
        if path.is_dir() {
            return refused("expected a table of particles, found a folder");
        }
        if !path.is_file() {
            return refused("no such file");
        }
        let mut head = Vec::new();
        let is_read = OpenFile::open(path).and_then(|file| file.take(BLOCK).read_to_end(&mut head));
        match (is_read, other_file::kind(path, &head)) {
            (Err(error), _) => refused(&reason(&error)),
            (Ok(_), Kind::Other(message)) => refused(&message),
            (Ok(_), kind) => Ok(matches!(kind, Kind::Table)),
        }
    }

    /// Checks a scene file's text; `path` is named in messages, and its folder is where tables are.
    ///
    /// A byte order mark at the start is skipped.
    ///
    /// # Errors
    /// Refuses everything that the format does not allow.
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneError> {
        Self::parse_with(text, path, &[], &|_| {})
    }

    /// Checks a scene file's text with the values of `settings` in place of its own.
    fn parse_with(
        text: &str,
        path: &Path,
        settings: &[Setting],
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        let shown = without_byte_order_mark(text);
        let ron = if is_json(shown) {
            let ron = to_ron(shown);
            Cow::Owned(ron.map_err(|fault| SceneError::refused(path, shown, vec![fault]))?)
        } else {
            Cow::Borrowed(shown)
        };
        if settings.is_empty() {
            return Self::parse_watched(&ron, shown, path, watch);
        }
        let mut text = ron.into_owned();
        for Setting { path: at, value } in settings {
            text = set(&text, at, value).map_err(|message| {
                let message = format!("--set {at}: {message}");
                SceneError::unreadable(path, &message)
            })?;
        }
        Self::parse_watched(&text, &text, path, watch)
    }

    /// Checks a text in RON; messages show another one, with the same places.
    fn parse_watched(
        text: &str,
        shown: &str,
        path: &Path,
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        let (draft, faults) = collect(text, || {
            let start = token::skip_trivia(text, 0);
            let file = File::read(Slice::of_text_being_read(&text[start..]))?;
            Draft::new(&file, text)
        });
        match draft {
            Some(draft) if faults.is_empty() => draft.finish(shown, path, watch),
            _ => Err(SceneError::refused(path, shown, faults)),
        }
    }
}

/// A scene whose tables are not yet read.
struct Draft {
    scene: Scene,
    clouds: Vec<Cloud>,
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
        if lights.may_have_color() {
            world.expect_colored_lights();
        }
        let camera = file.camera.value.as_ref()?;
        let fill = match camera {
            Camera::Frame {
                fill, frame_over, ..
            } => Some((fill.get()?.0, frame_over.get()?)),
            _ => None,
        };
        let lens = lens?;
        let scene = Scene {
            world,
            motion: motion?,
            lights: lights.clone(),
            lens,
            width: image.width.get()?.0,
            height: image.height.get()?.0,
            description: Description {
                materials: names(&file.materials)?,
                lights: Vec::new(),
                camera: camera.kind(),
                animation: optional(&file.animation, |animation| Some(animation.kind()))?,
                lens: world::lens_as_written(&file.lens)?,
                unit: optional(&file.unit, |unit| Some(unit.0.clone()))?,
            },
            clouds: Vec::new(),
            warnings: oversights::warnings(file),
            hints: oversights::hints(file),
            series: None,
            framed: Vec::new(),
            as_written: AsWritten { lens, fill, lights },
            own_camera: None,
            tables: Vec::new(),
        };
        Some(Self {
            scene,
            clouds,
            camera: file.camera.place.clone(),
        })
    }

    /// Reads the tables, and places the camera where that depends on the spheres.
    fn finish(
        self,
        text: &str,
        path: &Path,
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Scene, SceneError> {
        let mut scene = self.scene;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut clouds = Vec::new();
        for cloud in self.clouds {
            let place = cloud.place.clone();
            let open = OpenCloud::new(cloud, folder);
            clouds.push(open.map_err(|error| refused(path, text, (place, error)))?);
        }
        let longest = clouds.iter().filter_map(OpenCloud::frames).max();
        if let Some(frames) = longest {
            if frames > MOST_FRAMES {
                let slow = clouds.iter().find(|cloud| cloud.frames() == longest);
                let place = slow.map(|cloud| cloud.cloud.place.clone());
                let message = format!(
                    "expected steps for at most {MOST_FRAMES} frames, found steps for {frames}: choose a larger \
                     `speed`"
                );
                let fault = Fault::new(place.unwrap_or_default(), message);
                return Err(SceneError::refused(path, text, vec![fault]));
            }
            scene.motion.last(frames);
        }
        let first_frame = scene.frames().map_or(1, |frames| *frames.start());
        let mut parts = Vec::new();
        let mut count = scene.world.spheres().len();
        for mut cloud in clouds {
            let place = cloud.cloud.place.clone();
            let added = scene.add_cloud(&mut cloud, &mut count, (path, text), watch);
            let step = added.map_err(|error| refused(path, text, (place, error)))?;
            let material = cloud.cloud.material;
            let cloud = Arc::new(cloud);
            scene.tables.push(Arc::clone(&cloud));
            let Step {
                spheres, albedos, ..
            } = step;
            if cloud.steps().is_none() && parts.is_empty() {
                scene.world.add_spheres(spheres, material, albedos);
                continue;
            }
            // What pictures have to have room for, though these spheres are not in this world.
            scene.world.expect_spheres(material, albedos.is_some());
            parts.push(match cloud.steps() {
                Some(_) => Part::Changing(cloud),
                None => Part::Still {
                    spheres,
                    albedos,
                    material,
                },
            });
        }
        if !parts.is_empty() {
            let source = (path.to_owned(), text.to_owned());
            let series = Series::new(scene.world.clone(), parts, first_frame, source);
            scene.series = Some(Arc::new(series));
        }
        if let Some((fill, over)) = scene.as_written.fill {
            let is_framed = scene.place_camera(fill, over)?;
            if is_framed.is_none() {
                let place = self.camera.start..token::token_end(text, self.camera.start);
                let message = "expected spheres for a `Frame` camera, found none";
                let fault = Fault::new(place, message);
                return Err(SceneError::refused(path, text, vec![fault]));
            }
        }
        for table in &scene.tables {
            scene.warnings.extend(table.take_warnings());
        }
        scene.choose_references()?;
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

/// The name of the file at `path` if it is a table of particles; `None` if it is something else, or cannot be opened.
///
/// # Errors
/// Refuses a table whose name is not in UTF-8.
fn table_name(path: &Path) -> Result<Option<String>, SceneError> {
    if !path.is_file() {
        return Ok(None);
    }
    let mut head = Vec::new();
    let is_read = OpenFile::open(path).and_then(|file| file.take(BLOCK).read_to_end(&mut head));
    if is_read.is_err() {
        return Ok(None);
    }
    match other_file::kind(path, &head) {
        Kind::Table => {}
        Kind::Scene => return Ok(None),
        // Of all its bytes, those that tell this may not be read: no more than up to the first of 0.
        Kind::Other(message) => return Err(SceneError::unreadable(path, &message)),
    }
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| {
        let message = "expected a file name in UTF-8, as a scene names a table";
        SceneError::unreadable(path, message)
    })?;
    Ok(Some(name.to_owned()))
}

/// The text behind a byte order mark.
fn without_byte_order_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

#[cfg(test)]
mod tests;
