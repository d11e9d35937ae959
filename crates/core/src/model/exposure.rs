//! The exposure of a picture: one view, or those of a camera that moves meanwhile.

use std::fmt::Debug;
use std::sync::Arc;

use super::camera::Camera;
use super::light::Light;
use super::view::View;

/// The place of a camera at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its viewpoint and its directions.
    pub camera: Camera,
    /// Factor on the retina's distance, greater than 0.
    pub zoom: f64,
}

/// The motion of a camera while the shutter is open.
pub trait Motion: Debug + Send + Sync {
    /// The pose at a time from −½, when the shutter opens, to ½, when it closes: always the same for
    /// the same time. Where there is none, that of the middle is taken for it.
    fn pose(&self, time: f64) -> Option<Pose>;

    /// True where it goes on without a bend or a jump at time 0. It does at all other times.
    fn is_smooth(&self) -> bool;
}

/// A view, the motion of its camera while the shutter is open, and its lights where these are not the world's.
#[derive(Clone, Debug)]
pub struct Exposure<'motion> {
    view: View,
    motion: Option<Arc<dyn Motion + 'motion>>,
    lights: Option<Arc<[Light]>>,
}

impl<'motion> Exposure<'motion> {
    /// A view of a moving camera: where it is in the middle of the time.
    pub fn of_motion(view: View, motion: impl Motion + 'motion) -> Self {
        Self {
            view,
            motion: Some(Arc::new(motion)),
            lights: None,
        }
    }

    /// The same under these lights in place of the world's, as many as the world has.
    pub fn with_lights(self, lights: Vec<Light>) -> Self {
        Self {
            lights: Some(lights.into()),
            ..self
        }
    }

    /// The lights that take the place of the world's; none where these count.
    pub fn lights(&self) -> Option<&[Light]> {
        self.lights.as_deref()
    }

    /// The view in the middle of the time.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The camera's poses at some moments, from when the shutter opens to when it closes, those just
    /// before and in the middle among them: enough to tell motions apart. None for an exposure of a
    /// moment.
    pub fn poses(&self) -> Vec<Pose> {
        let Some(motion) = &self.motion else {
            return Vec::new();
        };
        let pose = |time| pose(&self.view, motion.as_ref(), time);
        HALVES.into_iter().flatten().map(pose).collect()
    }

    /// The motion, where the camera moves at all.
    pub(crate) fn motion(&self) -> Option<Arc<dyn Motion + 'motion>> {
        let motion = self.motion.as_ref()?;
        let rest = Pose::of(&self.view);
        let moves = self.poses().iter().any(|pose| *pose != rest);
        moves.then(|| Arc::clone(motion))
    }
}

/// Moments of the two halves of the time; the first ends just before the second begins, where there
/// may be a jump.
pub(crate) const HALVES: [[f64; 5]; 2] = [
    [-0.5, -0.375, -0.25, -0.125, -1.0 / 1_048_576.0],
    [0.0, 0.125, 0.25, 0.375, 0.5],
];

impl Pose {
    fn of(view: &View) -> Self {
        Self {
            camera: view.camera,
            zoom: view.zoom,
        }
    }
}

/// The pose at a time, or that of the view.
fn pose(view: &View, motion: &dyn Motion, time: f64) -> Pose {
    motion.pose(time).unwrap_or(Pose::of(view))
}

/// The view at a time.
pub(crate) fn view_at(view: &View, motion: &dyn Motion, time: f64) -> View {
    let Pose { camera, zoom } = pose(view, motion, time);
    View {
        camera,
        zoom,
        ..*view
    }
}

/// An exposure of a moment.
impl From<&View> for Exposure<'_> {
    fn from(view: &View) -> Self {
        Self {
            view: *view,
            motion: None,
            lights: None,
        }
    }
}

impl<'motion> From<&Exposure<'motion>> for Exposure<'motion> {
    fn from(exposure: &Exposure<'motion>) -> Self {
        exposure.clone()
    }
}
