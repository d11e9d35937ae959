//! A scene: a world, a camera over time, and the image.

mod clouds;
mod description;
mod load;
mod orbit;
mod other_file;
mod oversights;
mod own_camera;
mod read;
mod references;
mod refused;
mod setting;
mod source_text;

use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use marbles_core::{Angle, Camera, Exposure, Lens, Light, Pose, Sky, Sphere, View, World};

use crate::motion::{
    CameraMotion, FrameError, Framing, Lights, OpenShutter, Picture, SkyMotion, Turning,
    axes_of_orbit,
};
use crate::report::SceneError;
use crate::world::{ColumnSummary, OpenCloud, Series, StepKey};
use own_camera::{AsWritten, OwnCamera};

pub use read::STANDARD_INPUT;

pub use description::{
    CellDescription, CloudDescription, ColorDescription, ColorMeaning, Description,
};
pub use orbit::{OrbitCamera, OrbitCenter, Unturnable};
pub use setting::{Setting, SettingError};

/// A scene file that was read and found valid.
///
/// # Example
/// ```
/// use std::path::Path;
///
/// use marbles_scene::Scene;
///
/// let text = "(image: (width: 64, height: 48), lens: Fov(40), camera: Orbit(target: (0, 0, 0), radius: 5),
///     animation: Turntable(frames: 4), spheres: [(center: (0, 0, 0), radius: 1)])";
/// let scene = Scene::parse(text, Path::new("ball.ron"))?;
/// assert_eq!(scene.world().spheres().len(), 1);
/// assert_eq!(scene.frames(), Some(1..=4));
/// // The camera goes around the ball: after half a turn it is on the other side.
/// let [first, third] = [scene.view(1)?, scene.view(3)?];
/// assert_eq!(first.width, 64);
/// assert!((first.camera.position + third.camera.position).length() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    world: World,
    motion: CameraMotion,
    lights: Lights,
    /// The sky, if keys change it.
    sky: Option<SkyMotion>,
    lens: Lens,
    width: u32,
    height: u32,
    description: Description,
    clouds: Vec<CloudDescription>,
    warnings: Vec<String>,
    hints: Vec<String>,
    /// Present if some clouds change over time.
    series: Option<Arc<Series>>,
    /// Cameras that frame the spheres of each step alone.
    framed: Vec<(StepKey, CameraMotion, Lens)>,
    /// The parts of the file that the spheres have a say in.
    as_written: AsWritten,
    /// Present if another camera is in the place of the scene's own.
    own_camera: Option<Box<OwnCamera>>,
    /// The clouds in the order of the file.
    tables: Vec<Arc<OpenCloud>>,
}

impl Scene {
    /// The spheres and materials, the same in every frame, and the lights of the first frame. If the lights change,
    /// [`Self::exposure`] and [`Self::lights`] have those of another frame.
    ///
    /// The spheres of clouds that change over time are missing: [`Self::world_at`] has them, too.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Returns whether some clouds change over time.
    pub fn has_steps(&self) -> bool {
        self.series.is_some()
    }

    /// The steps that a frame shows of clouds that change over time; `None` if there are no such clouds.
    pub fn steps_at(&self, frame: i32) -> Option<StepKey> {
        Some(self.series.as_ref()?.key(frame))
    }

    /// The world of a frame: that of [`Self::world`], with the spheres of its step. They are read from their tables on
    /// the threads of the current rayon pool.
    ///
    /// # Errors
    /// Refuses tables as [`Self::load`] does.
    pub fn world_at(&self, frame: i32) -> Result<World, SceneError> {
        let Some(series) = &self.series else {
            return Ok(self.world.clone());
        };
        let mut world = series
            .world(&series.key(frame))
            .map_err(|refused| refused::explain(series, refused))?;
        world.lights.clone_from(&self.world.lights);
        world.sky = self.world.sky;
        Ok(world)
    }

    /// The camera of a frame over time, and its lens.
    fn motion_at(&self, frame: i32) -> (&CameraMotion, Lens) {
        let key = self.steps_at(frame);
        let framed = self
            .framed
            .iter()
            .find(|framed| Some(&framed.0) == key.as_ref());
        framed.map_or((&self.motion, self.lens), |(_, motion, lens)| {
            (motion, *lens)
        })
    }

    /// Returns possible oversights, one line each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Returns hints, one line each: values that are valid but were probably meant otherwise.
    pub fn hints(&self) -> &[String] {
        &self.hints
    }

    /// The view of a frame, inside the animation or not.
    ///
    /// # Errors
    /// Refuses a frame in which the camera looks nowhere, in the middle or when the shutter opens or closes: keys may
    /// lead a `LookAt` camera to its target. Refuses also a frame in which a light or the sky has no direction.
    pub fn view(&self, frame: i32) -> Result<View, FrameError> {
        let (motion, lens) = self.motion_at(frame);
        let Pose { camera, zoom } = motion.pose(frame, 0.0)?;
        if let Some(shutter) = self.shutter() {
            motion.pose(frame, -0.5 * shutter)?;
            motion.pose(frame, 0.5 * shutter)?;
        }
        self.lights.at(frame, &camera, motion.target())?;
        self.sky_at(frame)?;
        Ok(View {
            camera,
            lens,
            zoom,
            width: self.width,
            height: self.height,
            // What a camera frames alone tells turns apart.
            frame: i64::from(match self.framed.is_empty() {
                true => self.lights.looped(motion.looped(frame)),
                false => frame,
            }),
        })
    }

    /// A view of a frame, which may have another size, with the motion of the camera while the
    /// frame's shutter is open.
    pub fn exposure(&self, view: &View) -> Exposure<'_> {
        match (self.shutter(), i32::try_from(view.frame)) {
            (Some(duration), Ok(frame)) => Exposure::of_motion(
                *view,
                OpenShutter {
                    motion: self.motion_at(frame).0,
                    frame,
                    duration,
                },
            ),
            (None, Ok(_)) => {
                let mut exposure = Exposure::from(view);
                if self.lights.may_move() {
                    exposure = exposure.with_lights(self.lights(view));
                }
                match self.sky(view).filter(|_| self.sky.is_some()) {
                    Some(sky) => exposure.with_sky(sky),
                    None => exposure,
                }
            }
            _ => Exposure::from(view),
        }
    }

    /// The sky in a view of a frame.
    pub fn sky(&self, view: &View) -> Option<Sky> {
        let frame = i32::try_from(view.frame).ok();
        let sky = frame.and_then(|frame| self.sky_at(frame).ok());
        sky.flatten().or(self.world.sky)
    }

    /// The sky of a frame, if keys change it.
    fn sky_at(&self, frame: i32) -> Result<Option<Sky>, FrameError> {
        self.sky.as_ref().map(|sky| sky.at(frame)).transpose()
    }

    /// The sky of the first frame; of a frame without one, that of the scene.
    fn first_sky(&self) -> Option<Sky> {
        let first = self.frames().map_or(1, |frames| *frames.start());
        let sky = self.sky_at(first).ok();
        sky.flatten().or(self.world.sky)
    }

    /// The lights in a view of a frame, which may have another size, in the world's axes.
    pub fn lights(&self, view: &View) -> Vec<Light> {
        let frame = i32::try_from(view.frame).ok();
        let lights = frame.and_then(|frame| self.lights_at(frame, &view.camera).ok());
        lights.unwrap_or_else(|| self.world.lights.clone())
    }

    fn lights_at(&self, frame: i32, camera: &Camera) -> Result<Vec<Light>, FrameError> {
        self.lights.at(frame, camera, self.motion.target())
    }

    /// Returns whether the lights or the sky of frames may differ from those of others: through keys, on a turntable, or
    /// attached to the camera.
    pub fn has_moving_lights(&self) -> bool {
        self.lights.may_move() || self.sky.is_some()
    }

    /// The lights of the first frame; of a frame without a view, those that a camera at the origin sees.
    fn first_lights(&self) -> Vec<Light> {
        let first = self.frames().map_or(1, |frames| *frames.start());
        let camera = self.motion.pose(first, 0.0).map(|pose| pose.camera);
        let none = Angle::from_degrees(0.0);
        let camera = camera.unwrap_or_else(|_| Camera::free(DVec3::ZERO, none, none, none));
        self.lights_at(first, &camera)
            .unwrap_or_else(|_| self.lights.somewhere())
    }

    /// The time for which the shutter is open in each frame, in frames: half of it before the frame's time, half after
    /// it. `None` if a frame shows a moment.
    pub fn shutter(&self) -> Option<f64> {
        self.motion.timing()?.shutter
    }

    /// The frames of the animation; `None` for a still.
    pub fn frames(&self) -> Option<RangeInclusive<i32>> {
        Some(self.motion.timing()?.frames.clone())
    }

    /// Frames per second of the animation, `None` for a still.
    pub fn frames_per_second(&self) -> Option<f64> {
        Some(self.motion.timing()?.frames_per_second)
    }

    /// The scene in words and numbers.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The tables of the scene, in the order of the file.
    pub fn clouds(&self) -> &[CloudDescription] {
        &self.clouds
    }

    /// The files of all tables, those of each step among them.
    pub fn table_files(&self) -> Vec<PathBuf> {
        self.tables.iter().flat_map(|table| table.files()).collect()
    }

    /// Returns the contents of the columns of a table's first step, at most the first 64; `cloud` is the table's index
    /// in [`Self::clouds`]. Reads the table once for each column.
    ///
    /// # Errors
    /// Fails if the table can no longer be read.
    pub fn columns(&self, cloud: usize) -> Result<Vec<ColumnSummary>, SceneError> {
        let Some(table) = self.tables.get(cloud) else {
            return Ok(Vec::new());
        };
        let columns = table.columns();
        columns.map_err(|error| SceneError::unreadable(&self.clouds[cloud].file, &error.message()))
    }

    /// The point that the camera of a frame looks at, if it is `LookAt`, `Orbit` or `Frame`.
    pub fn target_at(&self, frame: i32) -> Option<DVec3> {
        self.motion_at(frame).0.target_at(f64::from(frame))
    }

    /// The target and the radius with which an `Orbit` camera has these spheres in its picture from any azimuth, at
    /// this elevation in degrees and with the scene's lens.
    ///
    /// `None` if there are no spheres, or if the lens is parallel, where the distance does not matter, or shifted,
    /// where no target is in the middle.
    pub fn orbit_around(&self, spheres: &[Sphere], elevation: f64) -> Option<(DVec3, f64)> {
        const FILL: f64 = 0.9;
        if self.lens.shift != DVec2::ZERO || self.lens.is_parallel() {
            return None;
        }
        let axes = axes_of_orbit([0.0, elevation, 0.0]);
        let framing = Framing::new(spheres, &self.picture(FILL), Turning::UPRIGHT, axes)?;
        Some((framing.target, framing.distance))
    }

    /// The picture of which a framing camera fills the part `fill`.
    fn picture(&self, fill: f64) -> Picture {
        Picture {
            lens: self.lens,
            aspect: f64::from(self.height) / f64::from(self.width) / self.lens.pixel_aspect,
            fill,
        }
    }
}

#[cfg(test)]
mod tests;
