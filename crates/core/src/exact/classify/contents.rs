//! What may be seen in a cell: spheres, their edges, and what keeps the light from them.

use std::ops::Range;

use fearless_simd::f64x8;
use fearless_simd::prelude::*;
use glam::DVec3;

use super::active::{Active, Terminators};
use super::coincidence::{ALIKE, has_same_outline, hides_all, is_at_eye, is_outline};
use super::hidden::HiddenSpheres;
use super::occluder_cache::{OccluderCache, Shade};
use super::patch::Patch;
use crate::edges::cell::{Ball, Cell};
use crate::edges::seam::seam;
use crate::edges::shadow::{Caster, Cone};
use crate::edges::silhouette::silhouette;
use crate::edges::terminator::terminator;
use crate::exact::points::Points;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::light::reflection::NearLight;
use crate::model::camera::Projection;
use crate::model::roughness::PixelKey;
use crate::numeric::polynomial::Quadratic;
use crate::numeric::rounding::{GEOMETRY_SLACK, UNIT_ROUNDOFF};
use crate::numeric::vectors::Vectors;
use crate::search::point_occluders::Beam;

/// The way of a light to a sphere in a cell.
#[derive(Clone, Debug)]
pub(crate) enum Reach {
    /// The light reaches it nowhere.
    Nowhere,
    /// The light reaches it where none of these occluders is in the way.
    Past(Range<usize>),
}

/// A curve on which light may change abruptly.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Kind {
    /// The outline of the active sphere with this position.
    Silhouette(usize),
    /// The intersection of two active spheres.
    Seam(usize, usize),
    /// The great circle of an active sphere that faces a light edge-on.
    Terminator(usize, usize),
}

/// The spheres, curves and occluders that matter in a cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contents {
    pub(crate) active: Vec<Active>,
    pub(crate) conics: Vec<(Kind, Quadratic)>,
    /// For every active sphere and every light.
    pub(crate) reach: Vec<Reach>,
    pub(crate) occluders: Vec<Caster>,
    /// The pixel that the cell belongs to.
    pub(crate) pixel: PixelKey,
    /// How far, in sides of the cell, rounding may move an edge; and the area of spheres that are too small to
    /// be resolved, which are left out.
    pub(crate) rounding: f64,
    /// Whether all parallel rays of the cell begin inside of a sphere that casts shadows, so that no directional light
    /// gets to what they see.
    pub(super) is_enclosed: bool,
    /// Spheres of which some parallel rays of the cell begin inside, and others not.
    pub(super) cut: Vec<(usize, Ball)>,
    /// Whether edges of the cell are not known because of these.
    pub(crate) is_mixed: bool,
    hidden: HiddenSpheres,
}

/// The width, in sides of a cell, below which the silhouette of a sphere is not resolved: rounding moves the
/// roots of a discriminant, whose coefficients are of the order of the cell, by the square root of some units
/// in the last place, 1e-8. Such a sphere covers less than 1e-14 of the cell.
pub(super) const NARROWEST: f64 = 1e-7;

/// A bound of what rounding moves points by, relative to the largest numbers that they are computed from:
/// some units in the last place.
pub(super) const ROUNDINGS: f64 = 8.0 * UNIT_ROUNDOFF;

/// How near to the eye, in radii, the plane of a circle passes that is seen as a line, and what
/// rounding moves such a line by, in sides of a cell: it is a double root.
const SEEN_EDGE_ON: f64 = 1e-5;
const ROOT_OF_ROUNDING: f64 = 1e-7;

/// The length of a patch of a surface, over its distance from a point light, up to which rules follow its light.
const NEAREST: f64 = 0.5;

/// The fall of a highlight over half a cell, in powers of e, that rules along lines still follow.
const FOLLOWED: f64 = 4.0;

impl Contents {
    /// Takes in the spheres out of some that a cell of the pixel may see, and their edges.
    pub(crate) fn see(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
    ) {
        self.active.clear();
        self.conics.clear();
        self.reach.clear();
        self.occluders.clear();
        let size = cell.size[0].min(cell.size[1]);
        self.rounding = ROUNDINGS * cell.extent() / size;
        self.is_enclosed = false;
        self.is_mixed = false;
        self.cut.clear();
        let mut unresolved = 0.0;
        for &(sphere, mut ball) in spheres {
            if ball.is_cut() && !self.take_cut(scene, cell, (sphere, &mut ball)) {
                continue;
            }
            let width = silhouette_width(&ball) / size;
            if width < NARROWEST {
                unresolved += width * width;
                continue;
            }
            let discriminant = silhouette(cell, &ball);
            let along = cell.along(ball.center);
            let spread = discriminant.spread();
            let mut slack = GEOMETRY_SLACK * (spread + discriminant.one.abs());
            if ball.is_parallel() {
                let length = ball.center.length() + ball.radius;
                self.rounding = self.rounding.max(ROUNDINGS * length / size);
                slack += 2.0 * ROUNDINGS * length * ball.radius;
            }
            let half = 0.5 * (along.x.abs() + along.y.abs());
            let is_outside = ball.outside > 0.0;
            let is_behind = along.one + half <= 0.0;
            if is_outside && (discriminant.one + spread + slack < 0.0 || is_behind) {
                continue;
            }
            // Of spheres that coincide the first is seen.
            let is_same = |other: &&mut Active| {
                other.ball.center == ball.center && other.ball.radius == ball.radius
            };
            if let Some(other) = self.active.iter_mut().find(is_same) {
                if sphere < other.sphere {
                    other.sphere = sphere;
                    other.terminators = Terminators::of(scene, sphere, self.pixel);
                }
                continue;
            }
            // Of spheres with one outline the nearest hides the others.
            let is_alike = |other: &&mut Active| has_same_outline(&other.ball, &ball);
            if let Some(other) = self.active.iter_mut().find(is_alike) {
                let moved = ALIKE * (cell.extent() + ball.center.length()) / size;
                self.rounding = self.rounding.max(moved);
                if ball.outside < other.ball.outside {
                    *other = Active {
                        sphere,
                        ball,
                        discriminant,
                        along,
                        terminators: Terminators::of(scene, sphere, self.pixel),
                        is_dark: false,
                    };
                }
                continue;
            }
            self.active.push(Active {
                sphere,
                ball,
                discriminant,
                along,
                terminators: Terminators::of(scene, sphere, self.pixel),
                is_dark: false,
            });
        }
        let begins_inside = self.is_enclosed || !self.cut.is_empty();
        self.add_caps(scene, cell);
        // Which of the rays that begin inside of spheres see what a light in them reaches is not told apart.
        self.is_mixed |= cell.is_parallel() && begins_inside && scene.has_near_lights;
        self.hidden.remove(cache.level, &mut self.active);
        for position in 0..self.active.len() {
            let active = self.active[position];
            let is_outside = active.ball.outside > 0.0;
            if is_outside && active.discriminant.may_vanish() {
                let kind = Kind::Silhouette(position);
                self.conics.push((kind, active.discriminant));
            }
            self.add_seams(cell, position);
            let may_be_lit = is_outside && !self.is_enclosed && !active.is_dark;
            let is_reached = scene.lights.iter().any(|light| !light.is_shut_off);
            let may_be_shaded = may_be_lit && is_reached && scene.world.shadows;
            let patch = may_be_shaded.then(|| {
                let Active {
                    ball,
                    discriminant,
                    along,
                    ..
                } = &active;
                Patch::new(cell, ball, discriminant, along)
            });
            for light in 0..scene.lights.len() {
                let reach = if may_be_lit && !scene.lights[light].is_shut_off {
                    self.reach_of(scene, cell, (&active, patch.as_ref()), light, cache)
                } else {
                    Reach::Nowhere
                };
                let plane = active.terminators.plane(scene, &active.ball, light);
                // Through the center and across the view it coincides with the outline.
                let is_aligned = cell.is_parallel() && plane.as_ref().is_some_and(is_outline);
                let reach = match plane {
                    // It faces away from all that rays see.
                    Some(plane) if is_aligned && plane.axis.z > 0.0 => Reach::Nowhere,
                    _ => reach,
                };
                if let (Some(plane), Reach::Past(_), false) = (plane, &reach, is_aligned) {
                    let terminator = terminator(cell, &active.ball, &plane);
                    if terminator.may_vanish() {
                        self.conics
                            .push((Kind::Terminator(position, light), terminator));
                    }
                }
                self.reach.push(reach);
            }
        }
        self.rounding += unresolved;
    }

    /// Adds the curves in which an active sphere intersects those before it.
    fn add_seams(&mut self, cell: &Cell, position: usize) {
        let ball = self.active[position].ball;
        for (index, other) in self.active[..position].iter().enumerate() {
            let apart_sq = (ball.center - other.ball.center).length_squared();
            let sum = ball.radius + other.ball.radius;
            // Most are far apart.
            if apart_sq > 1.001 * sum * sum {
                continue;
            }
            let apart = apart_sq.sqrt();
            let difference = (ball.radius - other.ball.radius).abs();
            let slack = GEOMETRY_SLACK * (sum + apart);
            if apart < sum + slack && apart > difference - slack && apart > 0.0 {
                let seam = seam(cell, &ball, &other.ball);
                if seam.may_vanish() {
                    self.conics.push((Kind::Seam(index, position), seam));
                    // The plane's place, by the radii or by K, whichever rounds less.
                    let by_radii = ball.radius.max(other.ball.radius).max(apart);
                    let by_outside = (ball.outside.abs() + other.ball.outside.abs()) / apart
                        + ball.center.length().min(other.ball.center.length());
                    let nearest = ball.outside.abs().min(other.ball.outside.abs())
                        / ball.radius.min(other.ball.radius).max(ball.center.length());
                    let size = cell.size[0].min(cell.size[1]) * nearest.max(f64::MIN_POSITIVE);
                    let moved = ROUNDINGS * by_radii.min(by_outside) / size;
                    self.rounding = self.rounding.max(moved);
                    let past_eye = 0.5 * (ball.outside - other.ball.outside).abs() / apart;
                    if past_eye < SEEN_EDGE_ON * ball.radius.min(other.ball.radius) {
                        self.rounding = self.rounding.max(ROOT_OF_ROUNDING);
                    }
                }
            }
        }
    }

    /// The way of a light to a sphere that the eye is outside of, past others where there is a patch of it that they
    /// may shade.
    fn reach_of(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        (active, patch): (&Active, Option<&Patch>),
        light: usize,
        cache: &mut OccluderCache,
    ) -> Reach {
        let first = self.occluders.len();
        if let Some(near) = &scene.lights[light].near {
            return self.reach_of_near(scene, cell, (active, patch), (light, near), cache);
        }
        if let Some(patch) = patch {
            let in_camera = &scene.lights[light];
            let Some(range) = cache.occluders(scene, active.sphere, light) else {
                return Reach::Nowhere;
            };
            cache.tests += range.len() as u64;
            let found = match cache.shade(patch, in_camera, range) {
                Shade::Everything => return Reach::Nowhere,
                Shade::Nothing => &[],
                Shade::Edges(found) => found,
            };
            let extent = |center: DVec3, radius: f64| center.length() + radius;
            let own = extent(active.ball.center, active.ball.radius);
            let distance = match cell.projection {
                Projection::Central => patch.ends[0].length() / cell.middle.length(),
                Projection::Parallel => 1.0,
            };
            let size = cell.size[0].min(cell.size[1]) * distance;
            let hides_itself = cell.is_parallel() && is_at_eye(in_camera.toward);
            for &sphere in found {
                let (center, radius) = scene.center(sphere as usize);
                if hides_itself && center.z >= radius {
                    continue;
                }
                let mut known = self.occluders[first..].iter();
                if known.any(|occluder| occluder.center == center && occluder.radius == radius) {
                    continue;
                }
                if hides_all(&active.ball, center, radius, in_camera.toward) {
                    return Reach::Nowhere;
                }
                let largest = own.max(extent(center, radius));
                self.rounding = self.rounding.max(ROUNDINGS * largest / size);
                self.occluders.push(in_camera.caster(center, radius));
            }
        }
        Reach::Past(first..self.occluders.len())
    }

    /// The way of a point light to a sphere that the eye is outside of; to none that the light is inside of.
    fn reach_of_near(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        (active, patch): (&Active, Option<&Patch>),
        (light, near): (usize, &NearLight),
        cache: &mut OccluderCache,
    ) -> Reach {
        let first = self.occluders.len();
        let in_camera = &scene.lights[light];
        let from_center = near.position - active.ball.center;
        if from_center.length() <= active.ball.radius {
            return Reach::Nowhere;
        }
        if let Some(patch) = patch {
            let size = cell.size[0].min(cell.size[1]);
            let size = size * patch.ends[0].length() / cell.middle.length();
            let (middle, around) = patch.ball();
            let beam = Beam::new(near.position, middle, around);
            let apart = (middle - near.position).length() + around;
            let range = cache.occluders_of_near(scene, active.sphere, light);
            cache.tests += range.len() as u64;
            for index in range {
                let sphere = cache.sphere(index);
                let (center, radius) = scene.center(sphere);
                if !beam.is_reached_by(center, radius) {
                    continue;
                }
                let mut known = self.occluders[first..].iter();
                if known.any(|occluder| occluder.center == center && occluder.radius == radius) {
                    continue;
                }
                let caster = in_camera.caster(center, radius);
                let Some(cone) = caster.cone else { continue };
                if cone.contains(middle, around) || hides_all_near(&active.ball, &cone, radius) {
                    return Reach::Nowhere;
                }
                // What rounding turns the edges of the cone by grows toward its apex, and where it is flat.
                let distance = cone.axis.length();
                let largest = near.position.length() + center.length() + radius;
                let turned = largest / distance.min(cone.power.max(0.0).sqrt());
                let moved = ROUNDINGS * (largest + active.ball.center.length() + turned * apart);
                // Squares of distances nearly cancel in the functions of the cone and of the way to the ball.
                let cancelled = ROUNDINGS * apart * apart / radius.min(active.ball.radius);
                self.rounding = self.rounding.max((moved + cancelled) / size);
                self.occluders.push(caster);
            }
        }
        Reach::Past(first..self.occluders.len())
    }

    /// Returns whether some sphere has a larger exponent than this, or bumps, which make any exponent steep.
    pub(crate) fn is_narrow(&self, scene: &InCamera<'_>, broad: f64) -> bool {
        scene.has_near_lights
            || self.active.iter().any(|active| {
                if active.terminators == Terminators::Anywhere {
                    return true;
                }
                let material = scene.world.material(active.sphere);
                let highlight = material.highlight;
                let shininess = highlight.map_or(0.0, |highlight| highlight.shininess);
                material.exponent.max(shininess) > broad
            })
    }

    /// Returns whether highlights are too sharp for rules along chords of the cell.
    #[inline(always)]
    pub(crate) fn is_sharp<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        negligible: f64,
    ) -> bool {
        let lights = scene.lights.len();
        for (position, active) in self.active.iter().enumerate() {
            if active.ball.outside <= 0.0 {
                continue;
            }
            // The patch is no longer than this.
            let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
            let length = (patch.ends[1] - patch.ends[0]).length() + 2.0 * patch.around;
            let turn = 0.5 * length / active.ball.radius + cell.turn()[0];
            let finish = Finish::new(scene, active.sphere, self.pixel);
            // On bumps rules are at most a quarter of a cell of the noise from the middles of their parts.
            let cells = finish.shading_normal.cells();
            let usual = turn.min(0.25 / cells) * finish.usual_slope();
            for light in 0..lights {
                // The way to a point light turns and shortens: rules follow it from farther than the patch is long.
                if let (Some(near), Reach::Past(_)) = (
                    &scene.lights[light].near,
                    &self.reach[position * lights + light],
                ) && length > NEAREST * patch.distance_from(near.position)
                {
                    return true;
                }
            }
            if finish.sharpness() * usual * usual < 2.0 * FOLLOWED {
                continue;
            }
            let points = Points::new(simd, &active.ball, Vectors::splat(simd, cell.middle));
            for light in 0..lights {
                let reach = &self.reach[position * lights + light];
                let Reach::Past(_) = reach else { continue };
                let turn = f64x8::splat(simd, turn);
                let light = &scene.lights[light];
                if finish.too_sharp(simd, &points, light, turn, FOLLOWED, negligible) != 0 {
                    return true;
                }
            }
        }
        false
    }

    /// Returns whether bumps are so fine that rules along chords of the cell, and across them, know too little
    /// of them: more than `most` cells of the noise from the middle to the corners.
    pub(crate) fn has_finer_bumps(&self, scene: &InCamera<'_>, cell: &Cell, most: f64) -> bool {
        self.active.iter().any(|active| {
            let roughness = &scene.world.material(active.sphere).roughness;
            let bumps = roughness
                .as_ref()
                .and_then(|roughness| roughness.bumps(active.ball.radius, active.sphere));
            let Some(bumps) = bumps else { return false };
            if active.ball.outside <= 0.0 {
                return false;
            }
            let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
            let length = 0.5 * (patch.ends[1] - patch.ends[0]).length() + patch.around;
            length * bumps.cells() > most * active.ball.radius
        })
    }
}

/// The same for a point light, from which a cone is seen.
fn hides_all_near(ball: &Ball, cone: &Cone, radius: f64) -> bool {
    /// Of the length of the axis, more than rounding.
    const ALIKE: f64 = 1e-12;
    let own = ball.center - cone.apex;
    let [far, near] = [own.length(), cone.axis.length()];
    far > near
        && (own * near - cone.axis * far).length() <= ALIKE * far * near
        && (ball.radius * near - radius * far).abs() <= ALIKE * far * near
}

/// A bound of the width of a sphere's silhouette on the retina at distance 1; infinite where the sphere comes
/// near the eye's plane.
///
/// Along an axis the silhouette is 2 r √(c_x² + c_z² − r²) / (c_z² − r²) wide; through parallel rays 2 r.
fn silhouette_width(ball: &Ball) -> f64 {
    if ball.is_parallel() {
        return 2.0 * ball.radius;
    }
    let product = (ball.center.z - ball.radius) * (ball.center.z + ball.radius);
    if ball.center.z > 2.0 * ball.radius {
        2.0 * ball.radius * ball.center.length() / product
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests;
