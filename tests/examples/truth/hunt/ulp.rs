//! Every scene again with the radius of one sphere an ulp larger.
//!
//! A pixel that moves by more than both pictures claim, and by more than the sphere can move it, is wrong in one of
//! them. It needs no judge, and finds what finer pictures get wrong in the same way.

use glam::DVec4;
use marbles_core::Light;
use marbles_tests::numbers::Numbers;

use super::draft::Draft;
use super::picture::Picture;
use super::subject::Subject;
use super::{Broken, Found};

/// The change by an edge that moves by a pixel, in units of the light in sight: an edge in a pixel is at most as long
/// as two of its sides, some edges may cross it, and edges of shadows move farther than what casts them.
///
/// An estimate: shadows move as many times as far as the sphere as the light is steep, and where it grazes what they
/// fall on, that is more. Of large spheres, whose ulps are long, [`reach`] counts it.
const EDGES: f64 = 100.0;

/// The rounding of visible light, in units of the light in sight, beside edges: powers multiply it by their
/// exponents.
const ROUNDING: f64 = 1e-11;

/// A sphere is large where it is so many times as large as the way to it.
const LARGE: f64 = 100.0;

/// A sphere of the scene by a number, and the scene with that one grown.
pub(super) fn grown(draft: &Draft, seed: u64) -> Option<(usize, Draft)> {
    let count = draft.spheres.len();
    let index = Numbers(seed).below(count);
    Some((index, draft.grown(index)?))
}

/// Adds the pixels that move too far when a sphere grows by an ulp.
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

/// The pixels of two pictures that are farther apart than both claim, and than a shift of edges explains.
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

/// True where a pixel still moves too far.
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

/// The pixels that edges move by if a sphere grows to that of another scene; none where the picture may be another
/// one.
fn shift(subject: &Subject, other: &Subject, index: usize) -> Option<f64> {
    let world = subject.plain().world();
    let sphere = world.spheres().get(index)?;
    let grown = other.plain().world().spheres().get(index)?;
    let ulp = grown.radius() - sphere.radius();
    let view = subject.plain().view(1).ok()?;
    let lens = &view.lens;
    let pixels = f64::from(view.width) * view.zoom / lens.width;
    if lens.is_parallel() {
        /// More than rounding, in ulps.
        const TOUCHES: f64 = 8.0;
        let ahead = (sphere.center() - view.camera.position).dot(view.camera.forward());
        if (ahead - sphere.radius()).abs() <= TOUCHES * ulp {
            // The plane that rays begin on touches the sphere, and cuts the grown one: that is seen from inside.
            return None;
        }
        return Some(ulp * pixels * grazing(subject, index, f64::INFINITY));
    }
    // Beside the axis a retina shows things larger.
    let slope = (0.5 * lens.width + lens.shift.length()) / (lens.distance * view.zoom);
    let pixels = pixels * lens.distance * (1.0 + slope * slope);
    let near = reach(subject, view.camera.position);
    Some(ulp / near * pixels * grazing(subject, index, near))
}

/// The way from the eye, or from a lamp, to the nearest surface: edges turn by an ulp over that.
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

/// The distance by which shadows move, in multiples of that of the large sphere that they fall on.
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
