//! Changes of soft light that points of a cell may miss.

use glam::{DMat3, DVec2, DVec3};

use super::candidate::Candidate;
use super::edges::Height;
use super::gather::Neighborhood;
use super::point::{Occluders, SurfacePoint};
use super::sun::Sun;
use crate::light::shading_normal::ShadingNormal;
use crate::model::camera::Projection;
use crate::model::sphere::Sphere;
use crate::model::world::World;
use crate::numeric::pair::both;
use crate::search::beyond::Beyond;

/// A ball around the part of a sphere that a cell may see.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub(crate) middle: DVec3,
    pub(crate) around: f64,
    /// The same across the ray through its middle, which is much less where a surface is seen at a grazing angle.
    pub(crate) across: f64,
    /// A bound of the angle between normals in it and that in its middle.
    pub(crate) turn: f64,
    /// The unit vector from its middle toward the eye.
    pub(crate) to_eye: DVec3,
    /// A bound of the angle between directions toward the eye in it and that in its middle.
    pub(crate) eye_turn: f64,
    /// The normal nearest to its middle.
    pub(crate) normal: DVec3,
}

impl Extent {
    /// That of what a cell sees of a candidate, in the camera's frame and the candidate's units.
    ///
    /// The distance of a point of a sphere from the eye grows with the distance of its ray from the center.
    pub(crate) fn new(candidate: &Candidate, cell: [[f64; 2]; 2], projection: Projection) -> Self {
        let [u, v] = cell;
        let middle = DVec2::new(0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
        let half = 0.5 * DVec2::new(u[1] - u[0], v[1] - v[0]).length();
        let (center, radius) = (candidate.center, candidate.radius);
        let (origin, axis, aside, spread, eye_turn) = match projection {
            Projection::Central => {
                // A ray turns by less than its end moves.
                let axis = middle.extend(1.0).normalize();
                let distance = center.length();
                (
                    DVec3::ZERO,
                    axis,
                    axis.cross(center).length(),
                    half * distance,
                    half,
                )
            }
            Projection::Parallel => {
                let origin = middle.extend(0.0);
                (
                    origin,
                    DVec3::Z,
                    (center - origin).truncate().length(),
                    half,
                    0.0,
                )
            }
        };
        let [near, far] = both([aside - spread, aside + spread], |aside| {
            aside.clamp(0.0, radius)
        });
        let along = |aside: f64| {
            let to_foot = match projection {
                Projection::Central => (center.length_squared() - aside * aside).max(0.0).sqrt(),
                Projection::Parallel => center.z,
            };
            to_foot - (radius * radius - aside * aside).max(0.0).sqrt()
        };
        let (near, far) = (along(near), along(far));
        let depth = 0.5 * (near + far);
        let across = match projection {
            Projection::Central => half * far.abs(),
            Projection::Parallel => half,
        };
        let middle = origin + axis * depth;
        let around = across + 0.5 * (far - near).abs();
        Self {
            middle,
            around,
            across,
            turn: 2.0 * around / radius,
            to_eye: -axis,
            eye_turn,
            normal: (middle - center).normalize(),
        }
    }

    /// The point in its middle, which stands for a point of the sphere.
    pub(crate) fn point(&self, sphere: usize) -> SurfacePoint {
        SurfacePoint {
            position: self.middle,
            normal: self.normal,
            shading: self.normal,
            to_eye: self.to_eye,
            sphere,
        }
    }

    /// The same in the world's frame and units.
    pub(crate) fn in_world(&self, world_from_camera: &DMat3, eye: DVec3, scale: f64) -> Self {
        Self {
            middle: eye + *world_from_camera * self.middle * scale,
            around: self.around * scale,
            across: self.across * scale,
            turn: self.turn,
            to_eye: *world_from_camera * self.to_eye,
            eye_turn: self.eye_turn,
            normal: *world_from_camera * self.normal,
        }
    }
}

/// How many times as fast as the sphere's the normals of a rough surface turn in most places: they turn as fast as they may in
/// few. Not tuned.
fn usual_slope(shading: &ShadingNormal) -> f64 {
    const OF_BOUND: f64 = 0.3;
    1.0 + OF_BOUND * (shading.slope_bound() - 1.0)
}

/// Bumps that are finer than points of a cell are apart. They bend evenly within a cell of the noise.
pub(crate) fn of_bumps(extent: &Extent, spacing: f64, shading: &ShadingNormal) -> f64 {
    /// The cells of the noise that points may be apart. Not tuned.
    const FINE: f64 = 1.0;
    if shading.cells() * extent.turn * spacing > FINE {
        shading.most_tilt().min(1.0)
    } else {
        0.0
    }
}

/// The part of a cell's light that points may miss of light which falls to e^(−1/2) at some angle from a normal: it is at most
/// 1, and the nearest normal of the cell is farther away by `aside`.
fn of_lobe(width: f64, aside: f64, turn: f64, spacing: f64) -> f64 {
    if spacing * turn < 0.5 * width {
        return 0.0;
    }
    let aside = aside.max(0.0) / width;
    0.5 * libm::exp(-0.5 * aside * aside)
}

/// Matte light of a large exponent, which is as narrow as a highlight.
pub(crate) fn of_exponent(
    sun: &Sun,
    (extent, spacing): (&Extent, f64),
    exponent: f64,
    shading: &ShadingNormal,
) -> f64 {
    /// That of lobes so wide that points do not miss them. Not tuned.
    const WIDE: f64 = 8.0;
    if exponent < WIDE {
        return 0.0;
    }
    let turn = extent.turn * shading.slope_bound();
    let aside = extent.normal.angle_between(sun.disc.axis) - turn - shading.most_tilt();
    let turn = extent.turn * usual_slope(shading);
    of_lobe(1.0 / exponent.sqrt(), aside, turn, spacing)
}

/// A highlight that is narrower than points of a cell are apart.
pub(crate) fn of_highlight(
    sun: &Sun,
    (extent, spacing): (&Extent, f64),
    (world, sphere): (&World, usize),
    shading: &ShadingNormal,
) -> f64 {
    let Some(highlight) = &world.material(sphere).highlight else {
        return 0.0;
    };
    let twice_half = sun.disc.axis + extent.to_eye;
    let eye_turn = extent.eye_turn / twice_half.length();
    let turn = extent.turn * shading.slope_bound() + eye_turn;
    let angle = extent.normal.angle_between(twice_half.normalize());
    let aside = angle - turn - shading.most_tilt();
    let turn = extent.turn * usual_slope(shading) + eye_turn;
    let width = 1.0 / highlight.shininess.sqrt();
    of_lobe(width, aside, turn, spacing) * highlight.strength / (1.0 + highlight.strength)
}

/// The place where a surface turns away from a sun: light may begin between points.
pub(crate) fn of_terminator(
    sun: &Sun,
    extent: &Extent,
    shading: &ShadingNormal,
    exponent: f64,
) -> f64 {
    /// The mean over a cell of light that begins in it, in parts of what it grows to. Not tuned.
    const OF_BEND: f64 = 0.125;
    let turn = extent.turn * shading.slope_bound();
    let height = extent.normal.dot(sun.disc.axis).abs();
    if height > sun.disc.sine + turn + shading.most_tilt() {
        return 0.0;
    }
    // Over the disc's diameter light bends evenly.
    let bend = (turn / sun.disc.sine).min(1.0);
    OF_BEND * libm::pow(turn.min(1.0), exponent) * bend
}

/// A penumbra that begins or ends in a cell of some size around a point.
///
/// Where a sphere begins to hide the disc, and where it hides all of it, is a cone around the sphere's shadow. The distance
/// from either changes by no more than the place does. From there on the share of the disc grows with the power 3/2 of that
/// distance.
pub(crate) fn of_penumbra(height: &Height, radius: f64, around: f64) -> f64 {
    /// The mean over a cell of a share that begins in it, in parts of the power of its size. Not tuned.
    const OF_EDGE: f64 = 0.25;
    if height.outer.abs() > around && height.inner.abs() > around {
        return 0.0;
    }
    let size = radius / height.wide;
    let share = (around / height.wide).sqrt() * (around / height.wide);
    OF_EDGE * share * (size * size).min(1.0)
}

/// A bound of what a sphere hides of the light of a sun, of intensity 1, from a part of a surface: the solid angle that it fills,
/// in parts of the disc's, as if all of it were straight above.
pub(crate) fn most_hidden(sun: &Sun, extent: &Extent, (center, radius): (DVec3, f64)) -> f64 {
    let nearest = ((center - extent.middle).length() - extent.around).max(radius);
    let sine = radius / nearest;
    // Within a cap of this sine, the integral of cosines is at most π s².
    std::f64::consts::PI * sine * sine / sun.disc.solid_angle()
}

/// About half of the width of the shadow that a sphere casts on a candidate: at least that of the circle in which they cut each
/// other, if the sphere's center is inside. A shadow that is wider than a cell does not lie between lines: it crosses the sides of
/// the cell, on which it is looked for.
pub(crate) fn shadow_half_width(candidate: &Candidate, (center, radius): (DVec3, f64)) -> f64 {
    let depth = (candidate.radius - (center - candidate.center).length()).clamp(0.0, radius);
    ((radius - depth) * (radius + depth)).sqrt()
}

/// A shadow that lies between the lines of a cell of some size.
pub(crate) fn of_speck(height: &Height, radius: f64, around: f64) -> f64 {
    /// Lines are closer to each other than so many times the size of the cell.
    const GAP: f64 = 0.4;
    let (size, depth) = (radius + height.wide, radius / height.wide);
    if size > GAP * around {
        return 0.0;
    }
    // Half of the cell's area is at least that of the size's square.
    let part = size / around;
    (part * part * (depth * depth).min(1.0)).min(1.0)
}

/// What small spheres beside a part of a smooth surface, or above it, darken between points some part of its size apart.
/// `part_near` tells how large the part of the cell is that sees the surface right below a sphere, in parts of the cell's side.
pub(crate) fn of_shadows(
    of: &Neighborhood,
    spacing: f64,
    sphere: usize,
    occluders: Option<&Occluders<'_>>,
    part_near: &dyn Fn(&Sphere) -> f64,
) -> f64 {
    /// Of spheres that are larger, in parts of the distance between points, or farther away, points tell.
    const WIDEST: f64 = 2.0;
    const NEAR: f64 = 3.0;
    let Some(occluders) = occluders else {
        return 0.0;
    };
    let spacing = WIDEST * spacing;
    let near = Beyond::Ball {
        center: of.middle,
        radius: (1.0 + NEAR * spacing) * of.around,
    };
    let mut doubt: f64 = 0.0;
    occluders
        .hierarchy
        .for_each_beyond(occluders.spheres, &near, &mut |index| {
            if occluders.may_hide(index, sphere) {
                let other = &occluders.spheres[index];
                // The part of a long cell that lies about as near to it as its size: of a surface that the eye sees at a
                // grazing angle, most of the cell may be near.
                let part = (2.0 * other.radius() / of.around)
                    .max(part_near(other))
                    .min(1.0);
                doubt = doubt.max(of.missed(other, spacing) * part);
            }
        });
    doubt
}

/// Small spheres right above a cell.
pub(crate) fn of_small_spheres(
    extent: &Extent,
    sphere: usize,
    occluders: Option<&Occluders<'_>>,
) -> f64 {
    /// Spheres within so many times the size of the cell that are not as many times as large.
    const NEAR: f64 = 2.0;
    let Some(occluders) = occluders else {
        return 0.0;
    };
    let near = Beyond::Ball {
        center: extent.middle,
        radius: NEAR * extent.around,
    };
    let mut doubt: f64 = 0.0;
    let own = &occluders.spheres[sphere];
    occluders
        .hierarchy
        .for_each_beyond(occluders.spheres, &near, &mut |index| {
            let other = &occluders.spheres[index];
            if index != sphere && other != own && other.radius() < NEAR * extent.around {
                let size = other.radius() / extent.around;
                doubt = doubt.max((size * size).min(1.0));
            }
        });
    doubt
}

#[cfg(test)]
mod tests;
