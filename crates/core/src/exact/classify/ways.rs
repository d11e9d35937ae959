//! The ways of lights to what a cell sees: the spheres that may be in them.

use glam::DVec3;

use super::active::Active;
use super::coincidence::{hides_all, is_at_eye};
use super::contents::{Contents, PAIRS_OF_A_TEST, ROUNDINGS};
use super::cut::begins_inside;
use super::occluder_cache::{OccluderCache, Shade};
use super::patch::Patch;
use super::reach::Reach;
use crate::edges::cell::{Ball, Cell};
use crate::edges::shadow::Cone;
use crate::exact::scene::InCamera;
use crate::light::reflection::NearLight;
use crate::model::camera::Projection;
use crate::search::point_occluders::Beam;

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
            let Some(range) = cache.occluders(scene, active.sphere, light) else {
                return Reach::Nowhere;
            };
            cache.tests += range.len() as u64;
            self.tests += (range.len() / PAIRS_OF_A_TEST) as u64;
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
                if self.has_too_many_curves() {
                    self.is_crowded = true;
                    break;
                }
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
            self.tests += (range.len() / PAIRS_OF_A_TEST) as u64;
            for index in range {
                if self.has_too_many_curves() {
                    self.is_crowded = true;
                    break;
                }
                let sphere = cache.sphere(index);
                let (center, radius) = scene.center(sphere);
                if !beam.is_reached_by(center, radius) {
                    continue;
                }
                let mut known = self.occluders[first..].iter();
                if known.any(|occluder| occluder.center == center && occluder.radius == radius) {
                    continue;
                }
                if begins_inside(cell, &scene.ball(sphere)) {
                    return Reach::Nowhere;
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
}

/// Returns whether an occluder keeps a point light from a ball whose outline it has, seen from the light.
fn hides_all_near(ball: &Ball, cone: &Cone, radius: f64) -> bool {
    /// Of the length of the axis, more than rounding.
    const ALIKE: f64 = 1e-12;
    let own = ball.center - cone.apex;
    let [far, near] = [own.length(), cone.axis.length()];
    far > near
        && (own * near - cone.axis * far).length() <= ALIKE * far * near
        && (ball.radius * near - radius * far).abs() <= ALIKE * far * near
}
