//! The rate of change of light over a cell, which rules along its lines may be unable to follow.

use fearless_simd::Simd;
use glam::DVec3;

use super::active::Terminators;
use super::contents::Contents;
use super::patch::Patch;
use super::reach::Reach;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::exact::points::Points;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::light::lobe::Lobe;
use crate::numeric::lanes::f64x8;
use crate::numeric::pair::both;
use crate::numeric::vectors::Vectors;

/// The length of a patch of a surface, over its distance from a point light, up to which rules follow its light.
const NEAREST: f64 = 0.5;

/// Returns whether the light of a point light turns too much over a patch for rules to follow it.
///
/// A patch of a large ball at its horizon is many times as long as it is far from anything; light is smooth there in the
/// reciprocal of the distance from the eye, which is linear on the retina. So what counts is how far the direction to the
/// light turns.
fn is_near(ball: &Ball, patch: &Patch, light: DVec3) -> bool {
    let [start, end] = patch.ends;
    if ball.is_apart() || ball.is_parallel() {
        let length = (end - start).length() + 2.0 * patch.around;
        return length > NEAREST * patch.distance_from(light);
    }
    let farthest = end.length();
    let around = |place: DVec3| {
        let distance = (place - light).length();
        2.0 * patch.around * place.length() / (farthest * distance)
    };
    let turn = ((start - light).normalize() - (end - light).normalize()).length();
    let turn = turn + around(start).max(around(end));
    // What is not a number is near.
    turn > NEAREST || turn.is_nan()
}

/// The fall of a highlight over half a cell, in powers of e, that rules along lines still follow.
const FOLLOWED: f64 = 4.0;

impl Contents {
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
            if active.ball.outside <= 0.0 || active.is_dark {
                continue;
            }
            // The patch is no longer than this.
            let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
            let length = (patch.ends[1] - patch.ends[0]).length() + 2.0 * patch.around;
            let [by_x, by_y] = cell.turn();
            let turn = 0.5 * length / active.ball.radius + by_x.max(by_y);
            let finish = Finish::new(scene, active.sphere, self.pixel);
            // On bumps rules are at most a quarter of a cell of the noise from the middles of their parts.
            let cells = finish.shading_normal.cells();
            let usual = turn.min(0.25 / cells) * finish.usual_slope();
            for light in 0..lights {
                // The way to a point light turns and shortens: rules follow it from farther than the patch is long.
                if let (Some(near), Reach::Past(_)) = (
                    &scene.lights[light].near,
                    &self.reach[position * lights + light],
                ) && (is_near(&active.ball, &patch, near.position)
                    || self.is_narrow_beam(scene, (position, light), &patch, negligible))
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

    /// Returns whether the light of a lamp falls too fast, in directions beside the one that it faces, for rules over a
    /// patch of an active sphere: to exp(−2 · [`FOLLOWED`]) of the highest, which is not negligible.
    fn is_narrow_beam(
        &self,
        scene: &InCamera<'_>,
        (position, light): (usize, usize),
        patch: &Patch,
        negligible: f64,
    ) -> bool {
        let light = &scene.lights[light];
        let Some(near) = &light.near else {
            return false;
        };
        let Some(lobe) = near.lobe.filter(Lobe::is_narrow) else {
            return false;
        };
        let [lowest, highest] = patch.cosines_from(near.position, lobe.direction);
        let active = &self.active[position];
        let [diffuse, specular] = Finish::new(scene, active.sphere, self.pixel)
            .reflectance
            .brightest(light.intensity);
        let most = (diffuse + specular) * light.most_on(&active.ball, patch);
        let fall = 1.0 - libm::exp(-2.0 * FOLLOWED / lobe.mu());
        highest - lowest > fall * highest && most * libm::pow(highest, lobe.mu()) > negligible
    }

    /// The axis, 0 for x, along which halves of a cell of parallel rays see much shorter patches than halves along the other
    /// one do.
    ///
    /// A level floor's horizon may lie within a cell: what is seen of it is as deep however narrow the cell is.
    pub(crate) fn long_side(&self, cell: &Cell) -> Option<usize> {
        /// The lengths of both halves along the one side, over those along the other. Where all depth is along one side, it is
        /// a half. Not tuned.
        const SHORTER: f64 = 0.75;
        if !cell.is_parallel() {
            return None;
        }
        let longest = |cell: Cell| {
            let seen = self.active.iter();
            let seen = seen.filter(|active| active.ball.outside > 0.0 && !active.is_dark);
            let seen = seen.map(|active| &active.ball);
            let lengths = seen
                .chain(self.cut.iter().map(|(_, ball)| ball))
                .map(|ball| {
                    let along = cell.along(ball.center);
                    let patch = Patch::new(&cell, ball, &silhouette(&cell, ball), &along);
                    (patch.ends[1] - patch.ends[0]).length() + 2.0 * patch.around
                });
            lengths.fold(0.0, f64::max)
        };
        let halves = [[-0.5, 0.0], [0.0, 0.5]];
        let whole = [-0.5, 0.5];
        let across = both(halves, |half| longest(cell.part(half, whole)));
        let along = both(halves, |half| longest(cell.part(whole, half)));
        let [x, y] = both([across, along], |[low, high]| low + high);
        if x < SHORTER * y {
            Some(0)
        } else if y < SHORTER * x {
            Some(1)
        } else {
            None
        }
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
