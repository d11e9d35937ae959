//! The ways of lights to what a cell sees: the spheres that may be in them.

use glam::DVec3;

use super::active::Active;
use super::coincidence::{
    ALIKE, FARTHER, has_same_shadow, hides_all, is_at_eye, is_nearer, nesting,
};
use super::contents::{Contents, PAIRS_OF_A_TEST, ROUNDINGS, WAYS_OF_A_TEST};
use super::no_shade::{is_above, is_behind};
use super::occluder_cache::{OccluderCache, Shade};
use super::patch::Patch;
use super::reach::Reach;
use crate::edges::cell::{Ball, Cell};
use crate::edges::shadow::{Caster, Cone};
use crate::exact::budget::{OF_A_CROWD, is_beyond_a_crowd};
use crate::exact::scene::{InCamera, Light};
use crate::light::near_light::NearLight;
use crate::model::camera::Projection;
use crate::search::point_occluders::Beam;

/// The time in which a shadow edge is held against the others of its patch, in that of a test.
const TESTS_OF_AN_EDGE: u64 = 2;

impl Contents {
    /// The way of a light to a sphere that the eye is outside of, past others where there is a patch of it that they
    /// may shade.
    pub(super) fn reach_of(
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
            if cache.is_exhausted() {
                return self.of_exhausted_tile();
            }
            let Some(range) = cache.occluders(scene, active.sphere, light) else {
                return Reach::Nowhere;
            };
            cache.tests += range.len() as u64;
            self.tests += (range.len() / PAIRS_OF_A_TEST) as u64;
            self.count_edges(cache);
            if is_beyond_a_crowd(self.tests) {
                self.is_crowded = true;
                return Reach::Past(first..first);
            }
            let found = match cache.shade(patch, in_camera, range) {
                Shade::Everything => return Reach::Nowhere,
                Shade::Nothing => &[],
                Shade::Edges(found) => found,
                Shade::Crowd => {
                    self.is_crowded = true;
                    return Reach::Past(first..first);
                }
            };
            let extent = |center: DVec3, radius: f64| center.length() + radius;
            let ends = ends(cell, &active.ball, patch);
            let hides_itself = cell.is_parallel() && is_at_eye(in_camera.toward);
            for &sphere in found {
                if self.has_too_many_curves() {
                    self.is_crowded = true;
                    break;
                }
                let (center, radius) = scene.center(sphere as usize);
                let is_inside = || nesting(scene, sphere as usize, active.sphere) == Some(true);
                if hides_itself && center.z >= radius || is_inside() {
                    continue;
                }
                if hides_all(&active.ball, center, radius, in_camera.toward) {
                    return Reach::Nowhere;
                }
                let roundings = self.cast(first, in_camera.caster(center, radius), in_camera);
                for End { scale, size, .. } in ends {
                    let largest = scale.max(extent(center, radius));
                    self.rounding = self.rounding.max(roundings * largest / size);
                }
            }
        }
        Reach::Past(first..self.occluders.len())
    }

    /// Adds a caster to those from `first` on, of casters with the same shadow only the one nearest to the light. Returns
    /// by how many roundoffs of the numbers that it is computed from its edge may be off.
    fn cast(&mut self, first: usize, caster: Caster, light: &Light) -> f64 {
        self.tests += ((self.occluders.len() - first) / PAIRS_OF_A_TEST) as u64;
        let mut known = self.occluders[first..].iter_mut();
        let Some(known) = known.find(|known| has_same_shadow(known, &caster)) else {
            self.occluders.push(caster);
            return ROUNDINGS;
        };
        if is_nearer(&caster, known, light) {
            *known = caster;
        }
        ALIKE
    }

    /// The way of a light of which nothing is known any more, whatever parts of the pixel are looked at.
    fn of_exhausted_tile(&mut self) -> Reach {
        self.is_crowded = true;
        self.tests += OF_A_CROWD;
        let first = self.occluders.len();
        Reach::Past(first..first)
    }

    /// Counts the shadow edges that were held against each other.
    pub(super) fn count_edges(&mut self, cache: &mut OccluderCache) {
        self.tests += TESTS_OF_AN_EDGE * std::mem::take(&mut cache.compared);
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
            let ends = ends(cell, &active.ball, patch);
            let (middle, around) = patch.ball();
            let beam = Beam::new(near.position, middle, around);
            if cache.is_exhausted() {
                return self.of_exhausted_tile();
            }
            let range = cache.occluders_of_near(scene, active.sphere, light);
            cache.tests += range.len() as u64;
            let tests = (range.len() / WAYS_OF_A_TEST) as u64;
            self.tests += tests;
            // As if there were as many for each of the spheres. The parts of the cell have as many, too.
            if is_beyond_a_crowd(self.tests + tests * self.active.len() as u64) {
                self.is_crowded = true;
                return Reach::Past(first..first);
            }
            for index in range {
                if self.has_too_many_curves() || is_beyond_a_crowd(self.tests) {
                    self.is_crowded = true;
                    break;
                }
                let sphere = cache.sphere(index);
                let (center, radius) = scene.center(sphere);
                let is_inside = || nesting(scene, sphere, active.sphere) == Some(true);
                if !beam.is_reached_by(center, radius) || is_inside() {
                    continue;
                }
                let ball = scene.ball(sphere);
                // What rays that begin inside of it see lies inside, too.
                let begins_outside = self.begins_outside(cell, (sphere, &ball));
                if begins_outside && is_above(&ball, near.position, (middle, around)) {
                    continue;
                }
                if self.begins_inside(cell, (sphere, &ball)) {
                    return Reach::Nowhere;
                }
                if begins_outside && is_behind(center, near.position, (middle, around)) {
                    continue;
                }
                let caster = in_camera.caster(center, radius);
                let Some(cone) = caster.cone else { continue };
                if cone.contains(middle, around) || hides_all_near(&active.ball, &cone, radius) {
                    return Reach::Nowhere;
                }
                let roundings = self.cast(first, caster, in_camera);
                // What rounding turns the edges of the cone by grows toward its apex, and where it is flat.
                let distance = cone.axis.length();
                let largest = near.position.length() + center.length() + radius;
                let turned = largest / distance.min(cone.power.max(0.0).sqrt());
                for End { place, scale, size } in ends {
                    let apart = (place - near.position).length() + patch.around;
                    let moved = roundings * (largest + scale + turned * apart);
                    // Squares of distances nearly cancel in the functions of the cone and of the way to the ball.
                    let mut cancelled = ROUNDINGS * apart * distance / radius;
                    if active.ball.is_apart() {
                        cancelled += ROUNDINGS * apart * apart / active.ball.radius;
                    }
                    self.rounding = self.rounding.max((moved + cancelled) / size);
                }
            }
        }
        Reach::Past(first..self.occluders.len())
    }
}

/// An end of what a cell sees of a ball.
#[derive(Clone, Copy, Debug)]
struct End {
    place: DVec3,
    /// The largest number that edges on the ball are computed from there, occluders apart.
    scale: f64,
    /// The side of the cell, as long as it is there.
    size: f64,
}

/// The nearest and the farthest end. What rounding moves is to be compared with the size of the same end: at the
/// horizon of a large ball the far one is many times as far as the near one.
fn ends(cell: &Cell, ball: &Ball, patch: &Patch) -> [End; 2] {
    let side = cell.size[0].min(cell.size[1]);
    patch.ends.map(|place| End {
        place,
        scale: if ball.is_apart() {
            ball.center.length() + ball.radius
        } else {
            place.length()
        },
        size: match cell.projection {
            Projection::Central => side * place.length() / cell.middle.length(),
            Projection::Parallel => side,
        },
    })
}

/// Returns whether an occluder keeps a point light from a ball whose contour it has, seen from the light.
fn hides_all_near(ball: &Ball, cone: &Cone, radius: f64) -> bool {
    /// The relative difference of lengths that count as equal: more than rounding.
    const ALIKE: f64 = 1e-12;
    let own = ball.center - cone.apex;
    let [far, near] = [own.length(), cone.axis.length()];
    far - near > FARTHER * ball.radius
        && (own * near - cone.axis * far).length() <= ALIKE * far * near
        && (ball.radius * near - radius * far).abs() <= ALIKE * far * near
}
