//! A scene of a hunt, and the true values of its pixels.

use std::num::NonZeroU32;
use std::time::Duration;

use glam::DVec4;
use marbles_core::{Method, View, World};
use marbles_scene::Scene;
use marbles_tests::reference::{Reference, Truth};

use super::draft::{Draft, MOMENTS};
use super::picture::{Mode, Picture};
use super::{Broken, random};

/// The rounding error of sums in the true value.
const ROUNDING: f64 = 1e-13;

/// The longest time for a picture under soft light.
const PATIENCE: Duration = Duration::from_secs(90);

/// A scene, an equivalent scene in units that suit the reference pictures, and one with many frames instead of one, if
/// the shutter is open.
pub(super) struct Subject {
    scene: Scene,
    plain: Scene,
    moments: Option<Scene>,
    mode: Mode,
    /// The size of a pixel at the distance of the spheres.
    pub(super) pixel: f64,
}

impl Subject {
    pub(super) fn of(draft: &Draft) -> Result<Self, String> {
        let scene = draft.scene()?;
        let mode = Mode::of(&scene, draft.alpha, draft.per_light, draft.light);
        Ok(Self {
            scene,
            plain: draft.plain()?,
            moments: draft.moments(),
            mode,
            pixel: draft.pixel,
        })
    }

    /// The scene for reference pictures.
    pub(super) fn plain(&self) -> &Scene {
        &self.plain
    }

    fn frame(&self) -> i32 {
        if self.moments.is_some() { 2 } else { 1 }
    }

    /// The picture at a tolerance.
    pub(super) fn picture(&self, tolerance: f64) -> Option<Picture> {
        self.shown(Method::Tolerance(tolerance))
    }

    /// The picture by a method.
    pub(super) fn shown(&self, method: Method) -> Option<Picture> {
        let view = self.scene.view(self.frame()).ok()?;
        Picture::of(&self.scene, &view, self.mode, method, self.patience())
    }

    /// The reference picture with this many times as many columns and rows, at a tolerance.
    pub(super) fn finer_picture(&self, times: u32, tolerance: f64) -> Option<Picture> {
        self.plain_picture(times, Method::Tolerance(tolerance))
    }

    /// The reference picture by samples.
    pub(super) fn sampled_picture(&self, samples: NonZeroU32) -> Option<Picture> {
        self.plain_picture(1, Method::Samples(samples))
    }

    fn plain_picture(&self, times: u32, method: Method) -> Option<Picture> {
        let view = self.plain.view(self.frame()).ok()?;
        let view = View {
            width: view.width * times,
            height: view.height * times,
            ..view
        };
        let mode = Mode {
            light: 1.0,
            ..self.mode
        };
        Picture::of(&self.plain, &view, mode, method, self.patience())
    }

    /// Returns whether the true value of a pixel takes a large part of a second: with bumps, and over time.
    pub(super) fn is_slow(&self) -> bool {
        self.moments.is_some() || random::grains(&self.plain).next().is_some()
    }

    /// Returns whether a scene is under soft light, for which both the renderer and the integrator take long.
    pub(super) fn is_soft(&self) -> bool {
        let world = self.plain.world();
        world.sky.is_some() || world.lights.iter().any(|light| light.sun().is_some())
    }

    /// The time after which a picture is given up.
    fn patience(&self) -> Option<Duration> {
        self.is_soft().then_some(PATIENCE)
    }

    /// The true value for [`Picture::value`], and its error, from an integrator for single moments.
    pub(super) fn truth(
        &self,
        fine: f64,
        judge: impl Fn(&Reference<'_>, i32) -> Truth,
    ) -> Option<(DVec4, f64)> {
        match &self.moments {
            None => self.at(&self.plain, 1, &judge),
            Some(moments) => over_time(fine, |frame| self.at(moments, frame, &judge)),
        }
    }

    /// The same for a frame of a reference scene.
    pub(super) fn at(
        &self,
        scene: &Scene,
        frame: i32,
        judge: impl Fn(&Reference<'_>, i32) -> Truth,
    ) -> Option<(DVec4, f64)> {
        let mut view = scene.view(frame).ok()?;
        // Bumps of pixels are drawn once for the frame.
        view.frame = self.plain.view(self.frame()).ok()?.frame;
        let part = self.mode.part(scene.world());
        let part: Option<World> = part.map(|part| scene.world().under(part));
        let world = part.as_ref().unwrap_or(scene.world());
        let truth = judge(&Reference::new(world, &view), frame);
        let light = truth.value.truncate();
        if self.mode.alpha {
            let of_alpha = self.mode.of_alpha;
            let value = light.extend(truth.value.w * of_alpha);
            return Some((value, truth.error * of_alpha.max(1.0) + ROUNDING));
        }
        let background = world.background * (1.0 - truth.value.w);
        Some(((light + background).extend(0.0), truth.error + ROUNDING))
    }

    /// The scene with many frames instead of one, if the shutter is open.
    pub(super) fn moments(&self) -> Option<&Scene> {
        self.moments.as_ref()
    }

    /// The distance of a pixel's light from the true value, and the error of this distance.
    ///
    /// If a pixel seems to have a larger error than allowed, it is also compared with the sum of its quarters: details
    /// that lines through the pixel miss are hardly missed in the quarters as well. Where a pixel takes the integrator long, a
    /// million points are asked first. If they side with the pixel, the integrator is uncertain by its distance from them:
    /// bumps like pixels beside contours are hard for it.
    pub(super) fn error_of(
        &self,
        (col, row): (u32, u32),
        value: DVec4,
        allowed: f64,
    ) -> Option<(f64, f64)> {
        /// The uncertainty that is small enough, as a fraction of the allowed error.
        const FINE: f64 = 0.02;
        /// The distance from the mean of points that is far more than its error, and how many times as near to it a value
        /// lies with which they side.
        const FAR: f64 = 1e-3;
        const SIDES: f64 = 4.0;
        let error = |(exact, _): (DVec4, f64)| (value - exact).abs().max_element();
        let is_screened = self.moments.is_none() && self.is_slow();
        let points = if is_screened {
            self.points((col, row))
        } else {
            None
        };
        if let Some(points) = points
            && error(points) + points.1 <= allowed
        {
            return Some((error(points), points.1));
        }
        let fine = FINE * allowed;
        let whole = self.truth(fine, |judge, _| judge.pixel(col, row))?;
        if error(whole) <= allowed + whole.1 {
            return Some((error(whole), whole.1));
        }
        let parts = self.truth(fine, |judge, _| judge.pixel_by_quarters(col, row))?;
        let apart = (whole.0 - parts.0).abs().max_element();
        let mut uncertain = if apart > whole.1 + parts.1 {
            apart + parts.1
        } else {
            whole.1.min(parts.1)
        };
        if let Some(points) = points {
            let of_parts = (parts.0 - points.0).abs().max_element();
            if of_parts > FAR && SIDES * error(points) < of_parts {
                uncertain = uncertain.max(of_parts);
            }
        }
        Some((error(parts), uncertain))
    }

    /// The mean of a million points of a pixel, or of thousands under soft light, and an estimate of its error: twice by how much a quarter of them differ.
    /// The integrator takes minutes for pixels in which bumps, outlines and contours meet.
    fn points(&self, (col, row): (u32, u32)) -> Option<(DVec4, f64)> {
        const COUNTS: [u32; 2] = [500, 1000];
        const SOFT_COUNTS: [u32; 2] = [40, 80];
        let counts = if self.is_soft() { SOFT_COUNTS } else { COUNTS };
        let [coarse, fine] = counts.map(|count| {
            self.truth(0.0, |judge, _| Truth {
                value: judge.midpoints(col, row, count),
                error: 0.0,
                has_edge: true,
                lines: 0,
            })
        });
        let (coarse, fine) = (coarse?.0, fine?.0);
        Some((fine, 2.0 * (fine - coarse).abs().max_element()))
    }

    /// Returns whether a pixel is reported as over its tolerance.
    pub(super) fn gives_up(&self, broken: &Broken) -> bool {
        let picture = self.picture(broken.tolerance);
        picture.is_some_and(|picture| picture.is_over(broken.col, broken.row))
    }

    /// The error of one pixel at a tolerance, if it is over it without a report, or over its claim.
    pub(super) fn shortfall(&self, broken: &Broken) -> Option<f64> {
        let (col, row) = (broken.col, broken.row);
        let picture = self.picture(broken.tolerance)?;
        let allowed = if picture.is_over(col, row) {
            picture.claimed(col, row)
        } else {
            broken.tolerance
        };
        let value = picture.value(col, row);
        let (error, uncertain) = self.error_of((col, row), value, allowed)?;
        (error > allowed + uncertain).then_some(error)
    }
}

/// The mean over the midpoints of equal parts of the time. The number of parts is doubled as long as this changes the
/// mean noticeably. Light is continuous in time, so the mean converges with the square of their number; its error is
/// taken as twice the last change.
fn over_time(fine: f64, of_frame: impl Fn(i32) -> Option<(DVec4, f64)>) -> Option<(DVec4, f64)> {
    const FIRST: i32 = 32;
    const LAST: i32 = 1024;
    let mean = |count: i32| {
        let step = MOMENTS / count;
        let mut sum = (DVec4::ZERO, 0.0);
        for part in 0..count {
            let frame = 2 * MOMENTS - MOMENTS / 2 + part * step + step / 2;
            let (light, error) = of_frame(frame)?;
            sum.0 += light / f64::from(count);
            sum.1 += error / f64::from(count);
        }
        Some(sum)
    };
    let (mut count, mut known) = (FIRST, mean(FIRST)?);
    loop {
        count *= 2;
        let better = mean(count)?;
        let change = (better.0 - known.0).abs().max_element();
        known = better;
        if change < fine || count == LAST {
            return Some((known.0, known.1 + 2.0 * change));
        }
    }
}
