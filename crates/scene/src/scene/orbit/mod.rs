//! A camera that goes around a point, in place of the scene's own: the camera that a user moves by hand.

mod seen;
mod text;

#[cfg(test)]
mod tests;

use glam::DVec3;
use marbles_core::{Camera, View};

use super::Scene;
use super::own_camera::{AsWritten, OwnCamera};
use crate::motion::{CameraMotion, FrameError};
use crate::report::SceneError;

/// A still camera that looks at a point from some distance, and can go around it.
///
/// # Example
/// ```
/// use std::path::Path;
///
/// use marbles_scene::{OrbitCamera, Scene};
///
/// let text = "(image: (width: 64, height: 48), lens: Fov(40), camera: Frame(), // from the front
///     spheres: [(center: (0, 0, 0), radius: 1)])";
/// let mut scene = Scene::parse(text, Path::new("ball.ron"))?;
/// let camera = OrbitCamera { azimuth: 30.0, ..scene.orbit_camera(1)? };
/// scene.set_orbit_camera(&camera)?;
/// let view = scene.view(1)?;
///
/// let edited = camera.put_into(text)?;
/// assert_eq!(edited, text.replace("Frame()", "Frame(azimuth: 30)"));
/// assert_eq!(Scene::parse(&edited, Path::new("ball.ron"))?.view(1)?, view);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitCamera {
    /// The point that it looks at, and the distance.
    pub center: OrbitCenter,
    /// The turn of the view about the vertical axis, in degrees: 0 looks along z, 90 along x.
    pub azimuth: f64,
    /// The height of the camera over the horizon, in degrees.
    pub elevation: f64,
    /// The turn about the axis of view, in degrees, clockwise as seen from behind the camera.
    pub roll: f64,
    /// The zoom of the scene, greater than 0.
    pub zoom: f64,
}

/// The point that a camera looks at, and its distance from it.
///
/// # Example
/// ```
/// use std::path::Path;
///
/// use marbles_core::glam::DVec3;
/// use marbles_scene::{OrbitCenter, Scene};
///
/// // The camera sees the ball 3 in front of it.
/// let text = "(image: (width: 64, height: 48), lens: Fov(40), camera: Free(),
///     spheres: [(center: (0, 0, 4), radius: 1)])";
/// let camera = Scene::parse(text, Path::new("ball.ron"))?.orbit_camera(1)?;
/// let OrbitCenter::At { target, radius } = camera.center else { panic!("it does not frame") };
/// assert!(target.abs_diff_eq(radius * DVec3::Z, 1e-12) && (3.0..3.1).contains(&radius));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrbitCenter {
    /// The middle of all spheres, from as near as shows all of them, as with a `Frame` camera.
    Framed,
    /// A point that stays where it is.
    At {
        /// The point.
        target: DVec3,
        /// The distance of the camera from it, greater than 0.
        radius: f64,
    },
}

/// The reason for which the camera of a scene cannot go around what it sees.
///
/// # Example
/// ```
/// use std::path::Path;
///
/// use marbles_scene::{Scene, Unturnable};
///
/// let text = "(image: (width: 64, height: 48), lens: Fov(40), camera: Free(), spheres: [])";
/// let reason = Scene::parse(text, Path::new("empty.ron"))?.orbit_camera(1).unwrap_err();
/// assert_eq!(reason, Unturnable::NothingSeen);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unturnable {
    /// Keys of the animation say where it is.
    #[error("the keys of the animation move the camera")]
    Keyed,
    /// It has no target, and sees no sphere that could be one.
    #[error("the camera sees no sphere that it could go around")]
    NothingSeen,
    /// Each turn would scale the lens anew, and read all steps of the tables for that.
    #[error(
        "a `Frame` camera with a parallel lens needs all steps of the tables to find its width"
    )]
    ScaledByAllSteps,
    /// It has no place in this frame.
    #[error("{0}")]
    Frame(FrameError),
}

/// The digits behind the point of angles that are not those of the file.
const ANGLE_DIGITS: usize = 4;

impl Scene {
    /// The camera of a frame as one that goes around the middle of what it sees.
    ///
    /// A camera without a target looks at the surfaces in the middle of the picture. The numbers that the file does not
    /// have are rounded by less than a picture shows. If tables change over time, a camera
    /// that frames their spheres stays at the distance that it has.
    ///
    /// # Errors
    /// Refuses cameras that cannot go around anything.
    pub fn orbit_camera(&self, frame: i32) -> Result<OrbitCamera, Unturnable> {
        let (motion, _) = self.motion_at(frame);
        if motion.is_keyed() {
            return Err(Unturnable::Keyed);
        }
        let view = self.view(frame).map_err(Unturnable::Frame)?;
        let center = self.center(&view, motion, frame)?;
        let [azimuth, elevation, roll] = motion.orbit_angles().unwrap_or_else(|| {
            let [pan, tilt, roll] = view.camera.pan_tilt_roll();
            let angles = [pan.degrees(), -tilt.degrees(), roll.degrees()];
            angles.map(|angle| rounded(angle, ANGLE_DIGITS))
        });
        Ok(OrbitCamera {
            center,
            azimuth,
            elevation,
            roll,
            zoom: view.zoom,
        })
    }

    /// The point that the camera of a frame goes around.
    fn center(
        &self,
        view: &View,
        motion: &CameraMotion,
        frame: i32,
    ) -> Result<OrbitCenter, Unturnable> {
        let camera = &view.camera;
        if self.as_written.fill.is_some() {
            return match (self.has_steps(), view.lens.is_parallel()) {
                (false, _) => Ok(OrbitCenter::Framed),
                (true, true) => Err(Unturnable::ScaledByAllSteps),
                (true, false) => {
                    let radius = (camera.on_axis - camera.position).length();
                    Ok(rounded_center(camera, radius))
                }
            };
        }
        if let Some((target, radius)) = motion.orbit_center() {
            return Ok(OrbitCenter::At { target, radius });
        }
        if let Some(target) = motion.target_at(f64::from(frame)) {
            let radius = (target - camera.position).length();
            let radius = rounded(radius, digits(radius));
            return Ok(OrbitCenter::At { target, radius });
        }
        let world = self.world_at(frame).map_err(|_| Unturnable::NothingSeen)?;
        let radius = seen::distance(view, world.spheres()).ok_or(Unturnable::NothingSeen)?;
        Ok(rounded_center(camera, radius))
    }

    /// Puts a camera in the place of the scene's own, as if the file had it. A turntable still turns it.
    ///
    /// [`Self::reset_camera`] brings the scene's own camera back.
    ///
    /// # Errors
    /// Fails if tables have to be read again, and cannot be read.
    pub fn set_orbit_camera(&mut self, camera: &OrbitCamera) -> Result<(), SceneError> {
        let OrbitCamera {
            azimuth,
            elevation,
            roll,
            zoom,
            ..
        } = *camera;
        let angles = [azimuth, elevation, roll];
        self.keep_own_camera();
        let AsWritten { lens, fill, .. } = self.as_written;
        self.lens = lens;
        match (camera.center, fill) {
            (OrbitCenter::Framed, Some((fill, over))) => {
                self.framed.clear();
                self.motion.orbit(None, angles, zoom);
                self.place_camera(fill, over)?;
            }
            // A camera that does not frame has a target of its own.
            (OrbitCenter::Framed, None) => self.motion.orbit(None, angles, zoom),
            (OrbitCenter::At { target, radius }, _) => {
                self.framed.clear();
                self.motion.orbit(Some((target, radius)), angles, zoom);
                self.description.camera = "Orbit";
            }
        }
        if self.as_written.lights.lack_attached_references() {
            self.lights = self.as_written.lights.clone();
            self.choose_references()?;
        }
        self.world.lights = self.first_lights();
        Ok(())
    }

    /// Changes the zoom of the scene's own camera, which may be of any kind.
    pub fn set_zoom(&mut self, zoom: f64) {
        self.reset_camera();
        self.keep_own_camera();
        self.motion.zoom(zoom);
        self.framed
            .iter_mut()
            .for_each(|(_, motion, _)| motion.zoom(zoom));
    }

    /// Puts the scene's own camera back, exactly as it was before [`Self::set_orbit_camera`] and [`Self::set_zoom`].
    pub fn reset_camera(&mut self) {
        if let Some(own) = self.own_camera.take() {
            let OwnCamera {
                motion,
                lens,
                framed,
                lights,
                kind,
            } = *own;
            (self.motion, self.lens, self.framed) = (motion, lens, framed);
            self.lights = lights;
            self.description.camera = kind;
            self.world.lights = self.first_lights();
        }
    }

    /// Makes the present camera the scene's own, to which [`Self::reset_camera`] leads back.
    pub fn accept_camera(&mut self) {
        self.own_camera = None;
    }

    fn keep_own_camera(&mut self) {
        if self.own_camera.is_none() {
            self.own_camera = Some(Box::new(OwnCamera {
                motion: self.motion.clone(),
                lens: self.lens,
                framed: self.framed.clone(),
                lights: self.lights.clone(),
                kind: self.description.camera,
            }));
        }
    }
}

/// The point at about this distance in front of a camera, and its distance.
fn rounded_center(camera: &Camera, distance: f64) -> OrbitCenter {
    let digits = digits(distance);
    let radius = rounded(distance, digits);
    let target = camera.position + radius * camera.forward();
    let target = target.to_array().map(|number| rounded(number, digits));
    OrbitCenter::At {
        target: target.into(),
        radius,
    }
}

/// The digits behind the point of a distance that has about six digits in all.
fn digits(distance: f64) -> usize {
    const DIGITS: f64 = 5.0;
    (DIGITS - libm::floor(libm::log10(distance))).clamp(0.0, 300.0) as usize
}

/// A number with so many digits behind the point.
fn rounded(number: f64, digits: usize) -> f64 {
    // What was just written is a number.
    format!("{number:.digits$}").parse().unwrap_or(number) + 0.0
}
