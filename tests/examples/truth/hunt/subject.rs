//! A scene of a hunt, and the truth about its pixels.

use std::ops::ControlFlow;

use glam::{DVec3, DVec4};
use marbles_core::{Image, Method, Renderer, Settings, View};
use marbles_scene::Scene;
use marbles_tests::reference::Reference;

use super::draft::{Draft, MOMENTS};
use super::{Broken, random};

/// A scene, and the same with many frames for one, where its shutter is open.
pub(super) struct Subject {
    pub(super) scene: Scene,
    moments: Option<Scene>,
}

impl Subject {
    pub(super) fn of(draft: &Draft) -> Result<Self, String> {
        let scene = draft.scene()?;
        let moments = draft.moments();
        Ok(Self { scene, moments })
    }

    pub(super) fn view(&self) -> Option<View> {
        let frame = if self.moments.is_some() { 2 } else { 1 };
        self.scene.view(frame).ok()
    }

    /// True if the truth about a pixel takes a large part of a second: of bumps, and over time.
    pub(super) fn is_slow(&self) -> bool {
        self.moments.is_some() || random::grains(&self.scene).next().is_some()
    }

    /// The light of a pixel with its background, and what that may be off by.
    fn truth(&self, col: u32, row: u32, fine: f64) -> Option<(DVec3, f64)> {
        match &self.moments {
            None => Some(truth(&self.scene, &self.view()?, col, row)),
            Some(moments) => over_time(moments, col, row, fine),
        }
    }

    /// How far a pixel's light is from the truth, and what that may be off by.
    pub(super) fn error_of(
        &self,
        col: u32,
        row: u32,
        value: DVec4,
        allowed: f64,
    ) -> Option<(f64, f64)> {
        /// Of what is allowed.
        const FINE: f64 = 0.02;
        let (exact, uncertain) = self.truth(col, row, FINE * allowed)?;
        Some(((value.truncate() - exact).abs().max_element(), uncertain))
    }

    /// The error of one pixel at a tolerance, where it is over it without saying so, or over its claim.
    pub(super) fn shortfall(&self, broken: &Broken) -> Option<f64> {
        let (col, row) = (broken.col, broken.row);
        let image = render(&self.scene, &self.view()?, broken.tolerance)?;
        let value = DVec4::from_array(image.rgba(col, row));
        let allowed = if image.status(col, row).is_over_tolerance() {
            image.error(col, row)
        } else {
            broken.tolerance
        };
        let (error, uncertain) = self.error_of(col, row, value, allowed)?;
        (error > allowed + uncertain).then_some(error)
    }
}

fn truth(scene: &Scene, view: &View, col: u32, row: u32) -> (DVec3, f64) {
    let truth = Reference::new(scene.world(), view).pixel(col, row);
    let background = scene.world().background * (1.0 - truth.value.w);
    (truth.value.truncate() + background, truth.error + 1e-13)
}

/// The mean over the midpoints of equal parts of the time, twice as many as long as that changes it by more than
/// a little. Light goes with time without jumps, so that the mean converges with the square of their number:
/// it is said to be off by twice the last change.
fn over_time(moments: &Scene, col: u32, row: u32, fine: f64) -> Option<(DVec3, f64)> {
    const FIRST: i32 = 32;
    const LAST: i32 = 1024;
    let mean = |count: i32| {
        let step = MOMENTS / count;
        let mut sum = (DVec3::ZERO, 0.0);
        for part in 0..count {
            let frame = 2 * MOMENTS - MOMENTS / 2 + part * step + step / 2;
            let view = moments.view(frame).ok()?;
            let (light, error) = truth(moments, &view, col, row);
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

/// The picture to a tolerance.
pub(super) fn render(scene: &Scene, view: &View, tolerance: f64) -> Option<Image> {
    render_by(scene, view, Method::Tolerance(tolerance))
}

/// The picture by a method.
pub(super) fn render_by(scene: &Scene, view: &View, method: Method) -> Option<Image> {
    let settings = Settings {
        method,
        alpha: false,
    };
    let go = |_| ControlFlow::Continue(());
    Renderer::new(scene.world())
        .render(scene.exposure(view), &settings, &go)
        .ok()
}
