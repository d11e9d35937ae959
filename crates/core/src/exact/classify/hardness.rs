//! The hardness of light in a cell: the largest brightness of highlights, and the fineness of bumps.

use fearless_simd::Simd;
use glam::{DVec2, DVec3};

use super::contents::Contents;
use super::patch::Patch;
use super::reach::Reach;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::exact::points::Points;
use crate::exact::scene::{InCamera, Light};
use crate::exact::surface::Finish;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::numeric::vectors::Vectors;

/// Highlights that are no brighter than white.
const ORDINARY: f64 = 1.0;

/// More than an angle, up to 1, over the length of its chord.
const OF_CHORD: f64 = 1.05;

impl Contents {
    /// By how much more than white that all lights reach, without a highlight, what is in the cell that was seen
    /// last may send.
    #[inline(always)]
    pub(crate) fn excess<S: Simd>(&self, simd: S, scene: &InCamera<'_>, cell: &Cell) -> f64 {
        let mut highest = 0.0_f64;
        for (position, active) in self.active.iter().enumerate() {
            let near = self.excess_of_near(scene, cell, position);
            let (mut excess, lights_together) = excess_of(scene, active.sphere, near);
            if let Some(highlight) = &scene.world.material(active.sphere).highlight {
                // The tops of ordinary highlights are no reason to look closer.
                let top = highlight.strength * lights_together;
                excess += if top <= ORDINARY {
                    top
                } else {
                    let finish = Finish::new(scene, active.sphere, self.pixel);
                    self.highlight(simd, &finish, (scene, cell), position)
                };
            }
            highest = highest.max(excess);
        }
        // Of spheres that are not told apart the outer sides may be seen as well.
        let cut = self.cut.iter().filter(|_| self.is_mixed);
        for &(sphere, ball) in cut.filter(|(_, ball)| ball.center.z > 0.0) {
            let outside = ball.center.z;
            let outer = Ball { outside, ..ball };
            let along = cell.along(ball.center);
            let patch = Patch::new(cell, &outer, &silhouette(cell, &outer), &along);
            let near = scene
                .lights
                .iter()
                .map(|light| excess_on(light, &outer, &patch));
            let (excess, lights_together) = excess_of(scene, sphere, near.sum());
            let highlight = scene.world.material(sphere).highlight;
            let strength = highlight.map_or(0.0, |highlight| highlight.strength);
            highest = highest.max(excess + strength * lights_together);
        }
        highest
    }

    /// By how much more than their intensities point lights may send to an active sphere in the brightest channel,
    /// whatever the highlight's strength.
    fn excess_of_near(&self, scene: &InCamera<'_>, cell: &Cell, position: usize) -> f64 {
        let active = &self.active[position];
        if !scene.has_near_lights || active.ball.outside <= 0.0 {
            return 0.0;
        }
        let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
        let first = position * scene.lights.len();
        let lights = scene.lights.iter().zip(&self.reach[first..]);
        let reaching = lights.filter(|(_, reach)| matches!(reach, Reach::Past(_)));
        reaching
            .map(|(light, _)| excess_on(light, &active.ball, &patch))
            .sum()
    }

    /// About the number of cells of the noise of bumps side by side in the cell that was seen last, where they
    /// are finest; surfaces that recede have more.
    pub(crate) fn grains_across(&self, scene: &InCamera<'_>, cell: &Cell) -> f64 {
        let mut most = 0.0_f64;
        for active in &self.active {
            let material = scene.world.material(active.sphere);
            let is_smooth = material.roughness.is_none() || scene.lights.is_empty();
            if is_smooth || active.ball.outside <= 0.0 {
                continue;
            }
            let finish = Finish::new(scene, active.sphere, self.pixel);
            let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
            let middle = 0.5 * (patch.ends[0] + patch.ends[1]);
            let side = cell.size[0].max(cell.size[1]);
            let side = match cell.projection {
                Projection::Central => side * middle.length() / cell.middle.length(),
                Projection::Parallel => side,
            };
            most = most.max(finish.shading_normal.cells() * side / active.ball.radius);
        }
        most
    }

    /// A bound of the highlights, of all lights together, of an active sphere in the brightest channel.
    #[inline(never)]
    pub(crate) fn highlight<S: Simd>(
        &self,
        simd: S,
        finish: &Finish,
        (scene, cell): (&InCamera<'_>, &Cell),
        position: usize,
    ) -> f64 {
        let active = &self.active[position];
        let first = position * scene.lights.len();
        let mut all = 0.0;
        for (light, reach) in scene.lights.iter().zip(&self.reach[first..]) {
            if matches!(reach, Reach::Past(_)) {
                let [_, highlight] = finish.reflectance.brightest(light.intensity);
                all += match light.near {
                    None => highlight,
                    Some(_) => {
                        let (ball, along) = (&active.ball, &active.along);
                        let patch = Patch::new(cell, ball, &active.discriminant, along);
                        highlight * light.most_on(ball, &patch)
                    }
                };
            }
        }
        let is_ahead = active.ball.outside > 0.0 && active.ball.center.z > active.ball.radius;
        if all == 0.0 || finish.is_rough() || !is_ahead || scene.has_near_lights {
            return all;
        }
        simd.vectorize(
            #[inline(always)]
            || {
                let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
                let length = (patch.ends[1] - patch.ends[0]).length() + 2.0 * patch.around;
                let turn = OF_CHORD * length / active.ball.radius;
                // Rays are at least 1 long: so far may one, as a unit vector, be from the middle's.
                let view = match cell.projection {
                    Projection::Central => cell.middle * (-1.0 / cell.middle.length()),
                    Projection::Parallel => DVec3::NEG_Z,
                };
                let aside = DVec2::from_array(cell.turn()).length();
                let points = Points::new(simd, &active.ball, Vectors::splat(simd, cell.middle));
                let mut highest = 0.0;
                for (light, reach) in scene.lights.iter().zip(&self.reach[first..]) {
                    if matches!(reach, Reach::Past(_)) {
                        // Half vectors turn by that over their length before they are made unit vectors.
                        let length = (light.toward + view).length() - aside;
                        if length <= aside {
                            return all;
                        }
                        let turn = turn + OF_CHORD * aside / length;
                        highest += finish.highest_highlight(simd, &points, light, turn)[0];
                    }
                }
                highest
            },
        )
    }
}

/// By how much more than its intensity a light may send to a patch in the brightest channel.
fn excess_on(light: &Light, ball: &Ball, patch: &Patch) -> f64 {
    (light.most_on(ball, patch) - 1.0).max(0.0) * light.intensity.max_element()
}

/// By how much more a sphere may send than a white one that all lights reach, without its highlight, where point lights
/// send so much more than their intensities; and all light together.
fn excess_of(scene: &InCamera<'_>, sphere: usize, near: f64) -> (f64, f64) {
    let lights = scene.lights.iter().map(|light| light.intensity);
    let lights = lights.fold(Color::ZERO, |sum, light| sum + light);
    let white = scene.ambient + lights;
    let albedo = scene.world.albedo(sphere).max_element();
    let excess = (albedo - 1.0).max(0.0) * white.max_element() + albedo * near;
    (excess, lights.max_element() + near)
}
