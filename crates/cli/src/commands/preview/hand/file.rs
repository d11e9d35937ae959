//! The scene file that the camera is written into.

use std::fs;
use std::io::Write;
use std::path::Path;

use marbles_scene::{OrbitCamera, OrbitCenter, Scene, Setting};

use super::motion::{Change, Hand};
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::files::save::save;

const BYTE_ORDER_MARK: char = '\u{feff}';

/// The file that the camera comes from.
pub(super) struct CameraFile<'a> {
    path: &'a Path,
    /// The camera that the scene file has; `None` for a table.
    camera: Option<String>,
    /// The camera that the command line has instead of it.
    settings: Vec<&'a Setting>,
}

impl<'a> CameraFile<'a> {
    /// The file that the preview is of, and the values of the command line that replace some of its own.
    pub(super) fn of(path: &'a Path, settings: &'a [Setting]) -> Result<Self, Failure> {
        let is_table = Scene::is_table(path).unwrap_or(false);
        let camera = match is_table {
            true => None,
            false => Some(OrbitCamera::line_of(parts(&read(path)?).1)),
        };
        let settings = settings.iter().filter(|setting| setting.is_of_camera());
        Ok(Self {
            path,
            camera,
            settings: settings.collect(),
        })
    }

    /// Writes the camera into the scene file; returns what was done, for the user.
    pub(super) fn write(&mut self, hand: &mut Hand) -> String {
        let name = self.path.shown();
        let Some(before) = &self.camera else {
            return format!(
                "{name} is a table, which has no camera: p prints the one that you see"
            );
        };
        let read = read(self.path).map_err(|failure| failure.to_string());
        let changed = read.and_then(|text| {
            let (mark, scene) = parts(&text);
            if OrbitCamera::line_of(scene) != *before {
                let why = "its camera has changed since it was read: p prints the one that you see";
                return Err(format!("{name}: {why}"));
            }
            let after = self.changed(scene, hand.change())?;
            Ok((format!("{mark}{after}"), text))
        });
        let (after, text) = match changed {
            Ok(texts) => texts,
            Err(message) => return message,
        };
        if text == after {
            return format!("{name} has this camera already");
        }
        if let Err(failure) = self.replace(&after) {
            return failure.to_string();
        }
        self.camera = Some(OrbitCamera::line_of(parts(&after).1));
        self.settings.clear();
        hand.is_written();
        format!("{name}: the camera is written")
    }

    /// The lines to paste: the camera as a scene file has it, and for a table the command that renders it so.
    pub(super) fn lines(&self, hand: &Hand) -> Result<String, Failure> {
        if self.camera.is_none() {
            let camera = hand.camera();
            return Ok(format!("{}\n{}", camera.line(), self.command(&camera)));
        }
        let text = self.changed(parts(&read(self.path)?).1, hand.change());
        let text = text.map_err(|message| Failure::at(self.path, &message))?;
        Ok(OrbitCamera::line_of(&text))
    }

    /// The text of a scene file with the camera that is seen.
    fn changed(&self, text: &str, change: Change) -> Result<String, String> {
        let mut text = text.to_owned();
        for setting in &self.settings {
            text = setting.put_into(&text)?;
        }
        match change {
            Change::None => Ok(text),
            Change::Zoom(camera) => camera.put_zoom_into(&text),
            Change::Turn(camera) => camera.put_into(&text),
        }
    }

    /// Replaces the text of the file, at once and with the same permissions.
    fn replace(&self, text: &str) -> Result<(), Failure> {
        let permissions = fs::metadata(self.path).map(|metadata| metadata.permissions());
        let written = save(self.path, |mut file| {
            file.file().write_all(text.as_bytes())?;
            file.file().set_permissions(permissions?)?;
            Ok(file)
        });
        Ok(written?)
    }

    /// The command that renders a table from there.
    fn command(&self, camera: &OrbitCamera) -> String {
        let name = self.path.to_string_lossy();
        let name = shlex::try_quote(&name).unwrap_or_default();
        let mut command = format!("marbles render {name}");
        let OrbitCamera {
            azimuth,
            elevation,
            roll,
            zoom,
            ..
        } = camera;
        match camera.center {
            OrbitCenter::Framed => command += &format!(" --view {azimuth},{elevation}"),
            // Which the command line had: a table is framed otherwise.
            OrbitCenter::At { .. } => {
                command += &format!(" --set 'camera={}'", camera.value());
            }
        }
        if *roll != 0.0 && camera.center == OrbitCenter::Framed {
            command += &format!(" --set camera.roll={roll}");
        }
        if *zoom != 1.0 {
            command += &format!(" --set zoom={zoom}");
        }
        command
    }
}

/// The byte order mark that a text may begin with, and the rest of it.
fn parts(text: &str) -> (&str, &str) {
    match text.strip_prefix(BYTE_ORDER_MARK) {
        Some(rest) => text.split_at(text.len() - rest.len()),
        None => ("", text),
    }
}

/// The text of a scene file.
fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path).map_err(|error| Failure::io(path, "cannot read the file", &error))
}

#[cfg(test)]
mod tests;
