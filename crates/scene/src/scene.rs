//! A scene: a world, a camera over time, and the image.

use std::fs::File as OpenFile;
use std::io::{self, ErrorKind, Read as _};
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use marbles_core::{Exposure, Lens, Pose, View, World};

use crate::assemble;
use crate::cloud::{Cloud, CloudError};
use crate::error::{FrameError, SceneError};
use crate::fault::{self, Fault, Slice};
use crate::file::{self, File};
use crate::framing::{self, Frame, Framing, Turning};
use crate::motion::{self, Motion};
use crate::placed::Read;
use crate::shutter::OpenShutter;
use crate::token;

/// The largest scene file that is read, in bytes: more than ten million spheres take, and a limit
/// for files that never end.
const LARGEST_FILE: u64 = 1 << 30;

/// A scene file that was read and found valid.
#[derive(Clone, Debug)]
pub struct Scene {
    world: World,
    motion: Motion,
    lens: Lens,
    width: u32,
    height: u32,
    description: Description,
    clouds: Vec<CloudDescription>,
}

/// The spheres of a table.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct CloudDescription {
    /// The table as the scene file names it.
    pub file: PathBuf,
    /// Which spheres of the world are in it.
    pub spheres: Range<usize>,
}

/// A scene in words and numbers, for people.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Description {
    /// Number of materials that the file defines.
    pub materials: usize,
    /// The kind of camera: `Free`, `LookAt` or `Orbit`.
    pub camera: &'static str,
    /// The kind of animation, `Keyframes` or `Turntable`; `None` for a still.
    pub animation: Option<&'static str>,
    /// The lens as the file writes it, for example `Fov(50)`.
    pub lens: String,
}

/// How far the reading of a table is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Progress<'scene> {
    /// The table as the scene file names it.
    pub table: &'scene Path,
    /// Bytes that were read.
    pub read: u64,
    /// Bytes of the whole file; 0 where it does not say.
    pub size: u64,
}

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
            return Err(SceneError::unreadable(
                path,
                "expected a scene file, found a folder",
            ));
        }
        let bytes = read_at_most(path, LARGEST_FILE).map_err(|error| {
            let reason = match error.kind() {
                ErrorKind::NotFound => String::from("no such file"),
                ErrorKind::PermissionDenied => String::from("no permission to read this file"),
                ErrorKind::FileTooLarge => {
                    String::from("expected a scene file of at most 1 GiB, found a larger one")
                }
                ErrorKind::OutOfMemory => String::from("there is no memory to read this file"),
                _ => error.to_string(),
            };
            SceneError::unreadable(path, &reason)
        })?;
        match str::from_utf8(&bytes) {
            Ok(text) => Self::parse_watched(text, path, watch),
            Err(error) => {
                let (valid, rest) = bytes.split_at(error.valid_up_to());
                let valid = without_byte_order_mark(str::from_utf8(valid).unwrap_or_default());
                let byte = rest.first().copied().unwrap_or_default();
                let message = format!("expected text in UTF-8, found the byte 0x{byte:02x}");
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
        let (scene, faults) = fault::collect(text, || {
            let start = token::skip_trivia(text, 0);
            let file = File::read(Slice::of_text_being_read(&text[start..]))?;
            Self::assemble(&file, text)
        });
        match scene {
            Some(draft) if faults.is_empty() => draft.finish(text, path, watch),
            _ => Err(SceneError::refused(path, text, faults)),
        }
    }

    /// What is rendered, the same in every frame.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// From where frame `frame` is rendered; any number, inside the animation or not.
    ///
    /// # Errors
    /// Refuses frames in which the camera looks nowhere, in their middle or where their shutter opens
    /// or closes: keys may lead a `LookAt` camera to its target.
    pub fn view(&self, frame: i32) -> Result<View, FrameError> {
        let Pose { camera, zoom } = self.pose(frame, 0.0)?;
        if let Some(shutter) = self.shutter() {
            self.pose(frame, -0.5 * shutter)?;
            self.pose(frame, 0.5 * shutter)?;
        }
        let turntable = self.motion.turntable.as_ref();
        Ok(View {
            camera,
            lens: self.lens,
            zoom,
            width: self.width,
            height: self.height,
            frame: i64::from(turntable.map_or(frame, |turntable| turntable.looped(frame))),
        })
    }

    /// A view of a frame, which may have another size, with what the camera does while the frame's
    /// shutter is open.
    pub fn exposure(&self, view: &View) -> Exposure<'_> {
        match (self.shutter(), i32::try_from(view.frame)) {
            (Some(shutter), Ok(frame)) => {
                Exposure::of_motion(*view, OpenShutter::new(self, frame, shutter))
            }
            _ => Exposure::from(view),
        }
    }

    /// How long the shutter is open in each frame, in frames: half of it before the frame's time,
    /// half after it. `None` where a frame shows a moment.
    pub fn shutter(&self) -> Option<f64> {
        self.motion.timing.as_ref()?.shutter
    }

    /// Where the camera is so many frames after frame `frame`, fewer than 1.
    pub(crate) fn pose(&self, frame: i32, later: f64) -> Result<Pose, FrameError> {
        let time = f64::from(frame) + later;
        let turntable = self.motion.turntable.as_ref();
        let turned = turntable.map_or(0.0, |turntable| turntable.azimuth_degrees_at(frame, later));
        let camera = self.motion.rig.camera(time, turned);
        Ok(Pose {
            camera: camera.map_err(|fault| FrameError { frame, fault })?,
            zoom: self.motion.zoom.at(time),
        })
    }

    /// Whether some key is at this frame.
    pub(crate) fn has_key_at(&self, frame: i32) -> bool {
        let timing = self.motion.timing.as_ref();
        timing.is_some_and(|timing| timing.key_frames.binary_search(&frame).is_ok())
    }

    /// The frames of the animation, `None` for a still.
    pub fn frames(&self) -> Option<RangeInclusive<i32>> {
        Some(self.motion.timing.as_ref()?.frames.clone())
    }

    /// Frames per second of the animation, `None` for a still.
    pub fn frames_per_second(&self) -> Option<f64> {
        Some(self.motion.timing.as_ref()?.frames_per_second)
    }

    /// What kind of scene this is.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The tables of the scene, in the order of the file.
    pub fn clouds(&self) -> &[CloudDescription] {
        &self.clouds
    }

    /// Target and radius of an `Orbit` camera with this elevation in degrees and the scene's lens
    /// that has some of the world's spheres in its picture from any azimuth.
    ///
    /// `None` for no spheres, and where the lens is shifted, so that no target is in the middle.
    pub fn orbit_around(&self, spheres: Range<usize>, elevation: f64) -> Option<(DVec3, f64)> {
        const FILL: f64 = 0.9;
        if self.lens.shift != DVec2::ZERO {
            return None;
        }
        let frame = self.frame(FILL);
        let axes = framing::axes_of_orbit(0.0, elevation, 0.0);
        let spheres = self.world.spheres().get(spheres)?;
        let framing = Framing::new(spheres, &frame, Turning::Around, axes)?;
        Some((framing.target, framing.distance))
    }

    fn frame(&self, fill: f64) -> Frame {
        Frame {
            lens: self.lens,
            aspect: f64::from(self.height) / f64::from(self.width),
            fill,
        }
    }

    /// The scene of a file; `None` where a fault was reported.
    fn assemble(file: &File, text: &str) -> Option<Draft> {
        // Each part is made before any is missed, so that the faults of all are told.
        let world = assemble::world(file);
        let motion = motion::motion(file, text);
        let image = file.image.value.as_ref()?;
        let (world, clouds) = world?;
        let camera = file.camera.value.as_ref()?;
        let fill = match camera {
            file::Camera::Frame { fill, .. } => Some(fill.get()?.0),
            _ => None,
        };
        let scene = Self {
            world,
            motion: motion?,
            lens: assemble::lens(&file.lens)?,
            width: image.width.get()?.0,
            height: image.height.get()?.0,
            description: Description {
                materials: file.materials.0.len(),
                camera: motion::kind(camera),
                animation: match &file.animation {
                    Some(animation) => Some(match animation.value.as_ref()? {
                        file::Animation::Keyframes { .. } => "Keyframes",
                        file::Animation::Turntable { .. } => "Turntable",
                    }),
                    None => None,
                },
                lens: assemble::lens_as_written(&file.lens)?,
            },
            clouds: Vec::new(),
        };
        Some(Draft {
            scene,
            clouds,
            fill,
            camera: file.camera.place.clone(),
        })
    }
}

/// A scene whose tables are not yet read.
struct Draft {
    scene: Scene,
    clouds: Vec<Cloud>,
    /// How much of the picture a camera fills that frames.
    fill: Option<f64>,
    /// Where the camera is in the text.
    camera: Range<usize>,
}

impl Draft {
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
            match cloud.add_to(&mut scene.world, folder, watch) {
                Ok(spheres) => scene.clouds.push(CloudDescription {
                    file: PathBuf::from(&cloud.name),
                    spheres,
                }),
                Err(CloudError::Scene(fault)) => {
                    return Err(SceneError::refused(path, text, vec![fault]));
                }
                Err(CloudError::Table(table, fault)) => {
                    return Err(SceneError::in_table(
                        &table,
                        &fault,
                        (path, text, &cloud.place),
                    ));
                }
            }
        }
        if let Some(fill) = self.fill {
            let frame = scene.frame(fill);
            if !scene.motion.frame(scene.world.spheres(), &frame) {
                let place = self.camera.start..token::token_end(text, self.camera.start);
                let message = String::from("expected spheres for a `Frame` camera, found none");
                let fault = Fault::new(place, message);
                return Err(SceneError::refused(path, text, vec![fault]));
            }
        }
        Ok(scene)
    }
}

/// The bytes of a file that has at most `most`; [`ErrorKind::FileTooLarge`] where it has more.
fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = OpenFile::open(path)?;
    let mut bytes = Vec::new();
    // What the size says is not always so: devices and pipes have none.
    let size = file.metadata()?.len();
    if size <= most {
        file.take(most + 1).read_to_end(&mut bytes)?;
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
