//! Renders every scene again with the radius of one sphere an ulp larger.
//!
//! If a pixel changes by more than both pictures claim together, and by more than the sphere can change it, it is wrong
//! in one of them. This check needs no reference, and finds errors that finer pictures share.

use glam::DVec4;
use marbles_core::Light;
use marbles_tests::numbers::Numbers;

use super::draft::Draft;
use super::picture::Picture;
use super::subject::Subject;
use super::{Broken, Found};

/// The change of a pixel if an edge moves by a pixel, in units of the visible light. An edge in a pixel is at most as
/// long as two of its sides, several edges may cross it, and edges of shadows move farther than the sphere that casts
/// them.
///
/// This is an estimate: the factor by which shadows move farther depends on the slope of the light, and is larger if
/// the light grazes the surface. For large spheres, whose ulps are long, [`grazing`] computes it.
const EDGES: f64 = 100.0;

/// The rounding of visible light, in units of the visible light, in addition to edges. Powers multiply it by their
/// exponents.
const ROUNDING: f64 = 1e-11;

/// A sphere is large if its radius is this many times its distance.
const LARGE: f64 = 100.0;

/// The number of a sphere of the scene, chosen by a seed, and the scene in which this sphere is an ulp larger.
pub(super) fn grown(draft: &Draft, seed: u64) -> Option<(usize, Draft)> {
    let count = draft.spheres.len();
    let index = Numbers(seed).below(count);
    Some((index, draft.grown(index)?))
}

/// Adds the pixels that change too much if a sphere grows by an ulp.
pub(super) fn judge(
    found: &mut Found,
    draft: &Draft,
    subject: &Subject,
    seed: u64,
    tolerances: &[f64],
) {
    let Some((index, grown)) = grown(draft, seed) else {
        return;
    };
    let Ok(other) = Subject::of(&grown) else {
        return;
    };
    let Some(shift) = shift(subject, &other, index) else {
        return;
    };
    for &tolerance in tolerances {
        let pictures = (subject.picture(tolerance), other.picture(tolerance));
        if let (Some(one), Some(other)) = pictures {
            found.moved.extend(moved(&one, &other, shift, tolerance));
        }
    }
}

/// The pixels whose difference in two pictures is larger than both claims and the shift of edges explain.
fn moved(one: &Picture, other: &Picture, shift: f64, tolerance: f64) -> Vec<Broken> {
    let places = || one.places();
    let brightest = places()
        .map(|(col, row)| one.value(col, row).max_element())
        .fold(0.0, f64::max);
    let explained = brightest * (EDGES * shift + ROUNDING);
    let broken = places().filter_map(|(col, row)| {
        let apart: DVec4 = one.value(col, row) - other.value(col, row);
        let error = apart.abs().max_element();
        let claimed = one.claimed(col, row) + other.claimed(col, row);
        (error > claimed + explained).then_some(Broken {
            col,
            row,
            tolerance,
            error,
            claimed,
            is_confessed: one.is_over(col, row) || other.is_over(col, row),
        })
    });
    broken.collect()
}

/// Returns whether a pixel still changes too much.
pub(super) fn still_moves(draft: &Draft, grown: usize, broken: &Broken) -> bool {
    let pictures = || {
        let (subject, other) = (
            Subject::of(draft).ok()?,
            Subject::of(&draft.grown(grown)?).ok()?,
        );
        let shift = shift(&subject, &other, grown)?;
        let (one, other) = (
            subject.picture(broken.tolerance)?,
            other.picture(broken.tolerance)?,
        );
        let moved = moved(&one, &other, shift, broken.tolerance);
        let place = (broken.col, broken.row);
        Some(moved.iter().any(|it| (it.col, it.row) == place))
    };
    pictures() == Some(true)
}

/// The distance in pixels by which edges move if a sphere grows to that of another scene; `None` if the picture may
/// change completely.
fn shift(subject: &Subject, other: &Subject, index: usize) -> Option<f64> {
    let world = subject.plain().world();
    let sphere = world.spheres().get(index)?;
    let grown = other.plain().world().spheres().get(index)?;
    let ulp = grown.radius() - sphere.radius();
    let view = subject.plain().view(1).ok()?;
    let lens = &view.lens;
    // Pixels may be lower than wide.
    let pixels = f64::from(view.width) * view.zoom / lens.width * lens.pixel_aspect.max(1.0);
    if lens.is_parallel() {
        /// More than the rounding error, in ulps.
        const TOUCHES: f64 = 8.0;
        let ahead = (sphere.center() - view.camera.position).dot(view.camera.forward());
        if (ahead - sphere.radius()).abs() <= TOUCHES * ulp {
            // The plane that rays begin on touches the sphere, and cuts the grown one: that is seen from inside.
            return None;
        }
        return Some(ulp * pixels * grazing(subject, index, f64::INFINITY));
    }
    // Beside the axis a retina shows things larger.
    let side = lens.width * (1.0 / lens.pixel_aspect).max(1.0);
    let slope = (0.5 * side + lens.shift.length()) / (lens.distance * view.zoom);
    let pixels = pixels * lens.distance * (1.0 + slope * slope);
    let near = reach(subject, view.camera.position);
    Some(ulp / near * pixels * grazing(subject, index, near))
}

/// The distance from the viewpoint, or from a lamp, to the nearest surface: edges turn by an ulp divided by this
/// distance.
fn reach(subject: &Subject, eye: glam::DVec3) -> f64 {
    let world = subject.plain().world();
    let lamps = world.lights.iter().filter_map(Light::point);
    let places = [eye].into_iter().chain(lamps.map(|lamp| lamp.position()));
    let ways = places.flat_map(|place| {
        let spheres = world.spheres().iter();
        spheres.map(move |sphere| ((place - sphere.center()).length() - sphere.radius()).abs())
    });
    ways.fold(f64::INFINITY, f64::min)
}

/// The factor by which shadows move farther than the large sphere that they fall on.
fn grazing(subject: &Subject, index: usize, near: f64) -> f64 {
    let world = subject.plain().world();
    let sphere = &world.spheres()[index];
    let Ok(view) = subject.plain().view(1) else {
        return 1.0;
    };
    if near.is_finite() && sphere.radius() < LARGE * near {
        return 1.0;
    }
    let up = (view.camera.position - sphere.center()).normalize_or_zero();
    let suns = world.lights.iter().filter_map(Light::toward);
    suns.map(|toward| 1.0 / toward.dot(up).abs().max(1e-9))
        .fold(1.0, f64::max)
}
