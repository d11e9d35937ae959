//! The light of the point that is seen in the middle of a pixel.

use glam::{DVec2, DVec3};

use super::point::Seen;
use crate::reference::Reference;
use crate::reference::light::Spot;
use crate::reference::patch::{Candidate, Patch};

/// The goal of a patch whose points are as precise as doubles allow.
const GOAL: f64 = 1e-10;

/// The light of suns and the sky in the middle of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Center {
    /// Red, green and blue.
    pub value: DVec3,
    /// The effect that rounding may have on soft light, in any program that computes with doubles.
    pub error: f64,
    /// Whether there is a sphere, and rounding cannot decide which one is seen.
    pub is_known: bool,
    /// Whether a part of a soft light is hidden, by other spheres or the own one.
    pub is_partial: bool,
}

impl Reference<'_> {
    /// The light of suns and the sky that the surface in the middle of a pixel reflects.
    pub fn center(&self, col: u32, row: u32) -> Center {
        let patch = Patch::of_pixel(&self.stage, col, row, GOAL);
        let direction = patch.direction(DVec2::ZERO);
        let mut center = Center {
            value: DVec3::ZERO,
            error: 0.0,
            is_known: false,
            is_partial: false,
        };
        let Some((index, t)) = patch.front(direction) else {
            return center;
        };
        let candidate = &patch.candidates[index];
        if candidate.ball.begins_inside(direction) {
            return center;
        }
        let t = candidate.ball.refined_hit(direction, t);
        let spot = patch.spot(candidate, direction, t);
        let ray = self.stage.forward.unwrap_or_else(|| direction.normalize());
        let slope = candidate.ball.normal(spot.point).dot(ray).abs();
        center.value = patch.soft_light(candidate, &spot, direction);
        let (error, is_partial) = patch.soft_error(candidate, &spot);
        center.error = error / slope;
        center.is_known = !patch.is_near_edge(slope, index, t);
        center.is_partial = is_partial;
        center
    }
}

impl Patch<'_> {
    /// The effect of rounding on soft light, and whether a part of it is hidden.
    fn soft_error(&self, candidate: &Candidate, spot: &Spot) -> (f64, bool) {
        let world = self.stage.world;
        let material = world.material(candidate.sphere);
        let albedo = world.albedo(candidate.sphere).max_element();
        let strength = material
            .highlight
            .map_or(0.0, |it| it.strength * it.shininess.max(1.0));
        let exponent = material.exponent;
        let mut is_partial = false;
        let of_suns = self.stage.softness.suns.iter().enumerate();
        let of_suns = of_suns.filter_map(|(number, sun)| {
            let casters = (candidate, &candidate.casters[number][..]);
            let seen = self.of_sun(sun.as_ref()?, casters, spot);
            if seen.whole <= 0.0 {
                return None;
            }
            is_partial |= seen.is_partial;
            let Seen { whole, error, .. } = seen;
            let slope = (exponent * libm::pow(whole, exponent - 1.0))
                .max(libm::pow(whole, exponent) / whole);
            let brightest = world.lights[number].intensity().max_element();
            Some(brightest * error * (albedo * slope + strength / whole))
        });
        let of_sky = self.stage.softness.sky.map(|sky| {
            let brightest = sky.above().max(sky.below()).max_element();
            let seen = self.of_sky(&sky, candidate, spot);
            (albedo * brightest * seen.error, seen.is_partial)
        });
        let of_suns: f64 = of_suns.sum();
        let (of_sky, is_sky_partial) = of_sky.unwrap_or_default();
        (of_suns + of_sky, is_partial || is_sky_partial)
    }

    /// Returns whether rounding may decide what is seen: a ray that grazes a surface, or meets two at once.
    fn is_near_edge(&self, slope: f64, index: usize, t: f64) -> bool {
        const GRAZES: f64 = 1e-3;
        const TOGETHER: f64 = 1e-9;
        let direction = self.direction(DVec2::ZERO);
        let others = self.candidates.iter().enumerate();
        let mut others = others.filter(|(other, _)| *other != index);
        slope < GRAZES
            || others.any(|(_, other)| {
                let near = other
                    .ball
                    .hit(direction)
                    .is_some_and(|other| (other - t).abs() < TOGETHER * t);
                let chord = other.ball.chord_sq(direction).abs();
                near || chord < TOGETHER * other.ball.radius * other.ball.radius
            })
    }
}
