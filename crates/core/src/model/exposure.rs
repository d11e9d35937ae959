//! The exposure of a picture: one view, or those of a camera that moves meanwhile.

use std::fmt::Debug;
use std::sync::Arc;

use super::camera::Camera;
use super::light::Light;
use super::sky::Sky;
use super::view::View;

/// The place of a camera at a moment.
///
/// # Example
/// ```
/// use marbles_core::{Camera, Exposure, Lens, Motion, Pose, View};
/// # use marbles_core::glam::DVec2;
///
/// /// A camera that zooms in while the shutter is open.
/// #[derive(Debug)]
/// struct Zoom;
///
/// impl Motion for Zoom {
///     fn pose(&self, time: f64) -> Option<Pose> {
///         Some(Pose { camera: Camera::default(), zoom: 1.5 + time })
///     }
///
///     fn is_smooth(&self) -> bool {
///         true
///     }
/// }
///
/// # let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 32, 32);
/// let poses = Exposure::of_motion(view, Zoom).poses();
/// assert_eq!(poses.first().map(|pose| pose.zoom), Some(1.0));
/// assert_eq!(poses.last().map(|pose| pose.zoom), Some(2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its viewpoint and its directions.
    pub camera: Camera,
    /// Factor on the retina's distance, greater than 0.
    pub zoom: f64,
}

/// The motion of a camera while the shutter is open.
///
/// # Example
/// ```
/// use marbles_core::glam::{DVec2, DVec3};
/// use marbles_core::{Camera, Exposure, Lens, Material, Motion, Pose, Renderer};
/// use marbles_core::{Settings, Sphere, View, World};
///
/// /// A camera that moves by 4 pixels to the right while the shutter is open.
/// #[derive(Debug)]
/// struct ToTheRight;
///
/// impl Motion for ToTheRight {
///     fn pose(&self, time: f64) -> Option<Pose> {
///         let camera = Camera::default().moved(DVec3::X * time);
///         Some(Pose { camera, zoom: 1.0 })
///     }
///
///     fn is_smooth(&self) -> bool {
///         true
///     }
/// }
///
/// let mut world = World::new();
/// let white = world.add_material(Material::default());
/// // So large that its contour is straight in the picture: the left half is white.
/// world.add_sphere(Sphere::new(DVec3::new(-1e9, 0.0, 2e9), 1e9)?, white);
/// world.ambient = DVec3::ONE;
/// let view = View::new(Camera::default(), Lens::parallel(4.0, DVec2::ZERO), 16, 1);
/// let exposure = Exposure::of_motion(view, ToTheRight);
/// let image = Renderer::new(&world).render(&exposure, &Settings::default());
/// // The edge passes this pixel in the third quarter of the time: 3/8 of it is white on average.
/// assert!((image.rgba(8, 0)[0] - 0.375).abs() <= image.error(8, 0));
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
pub trait Motion: Debug + Send + Sync {
    /// Returns the pose at a time from −½, when the shutter opens, to ½, when it closes: always the same for the same
    /// time. If there is none, marbles takes the pose of the view.
    fn pose(&self, time: f64) -> Option<Pose>;

    /// Returns whether the motion has no bend and no jump at time 0. It must have none at any other time.
    fn is_smooth(&self) -> bool;
}

/// A view, the motion of its camera while the shutter is open, and its lights and its sky if they are not the world's.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Exposure, Light, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// let sun = |intensity| Light::directional(DVec3::NEG_Z, DVec3::splat(intensity));
/// world.lights.push(sun(1.0)?);
/// let renderer = Renderer::new(&world);
/// let bright = renderer.render(&view, &Settings::default());
/// // The same view, under a light of half the intensity.
/// let exposure = Exposure::from(&view).with_lights(vec![sun(0.5)?]);
/// let dim = renderer.render(&exposure, &Settings::default());
/// assert_eq!(dim.rgba(8, 8)[0], 0.5 * bright.rgba(8, 8)[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Exposure<'motion> {
    view: View,
    motion: Option<Arc<dyn Motion + 'motion>>,
    lights: Option<Arc<[Light]>>,
    sky: Option<Sky>,
}

impl<'motion> Exposure<'motion> {
    /// Creates the exposure of a moving camera; `view` is what it sees in the middle of the time.
    pub fn of_motion(view: View, motion: impl Motion + 'motion) -> Self {
        Self {
            view,
            motion: Some(Arc::new(motion)),
            lights: None,
            sky: None,
        }
    }

    /// The same exposure under these lights in place of the world's. There must be as many as the world has.
    pub fn with_lights(self, lights: Vec<Light>) -> Self {
        Self {
            lights: Some(lights.into()),
            ..self
        }
    }

    /// The same exposure under this sky in place of the world's. A world without a sky stays without one.
    pub fn with_sky(self, sky: Sky) -> Self {
        Self {
            sky: Some(sky),
            ..self
        }
    }

    /// The sky that takes the place of the world's, if there is one.
    pub fn sky(&self) -> Option<Sky> {
        self.sky
    }

    /// The lights that take the place of the world's, if there are any.
    pub fn lights(&self) -> Option<&[Light]> {
        self.lights.as_deref()
    }

    /// The view in the middle of the time.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The camera's poses at some moments from when the shutter opens to when it closes, two of them just before and in
    /// the middle: enough to distinguish motions. Empty for an exposure of a moment.
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
            sky: None,
        }
    }
}

impl<'motion> From<&Exposure<'motion>> for Exposure<'motion> {
    fn from(exposure: &Exposure<'motion>) -> Self {
        exposure.clone()
    }
}
