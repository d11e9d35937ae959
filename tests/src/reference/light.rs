//! The view along a ray: the sphere, the lights that reach it, and the reflected light.

use glam::{DVec3, DVec4};

use super::noise::bump;
use super::patch::{Candidate, Patch};
use super::soft::SoftState;

/// The properties that may jump, or change sharply, from one ray to the next.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(crate) struct Signature {
    /// The index among the patch's candidates plus one; 0 for the background.
    pub(crate) seen: usize,
    /// Whether its inner side is visible.
    is_inner: bool,
    /// Whether its outline is visible.
    is_outline: bool,
    /// The lights that reach the point, and those with a highlight there.
    lit: u64,
    shines: u64,
    /// What reaches into the discs of suns.
    soft: SoftState,
    /// The cell of the noise on the surface.
    cell: [i64; 3],
}

/// A point on the outer side of a sphere.
pub(crate) struct Spot {
    /// Relative to the viewpoint.
    pub(crate) point: DVec3,
    /// The shading normal.
    pub(crate) normal: DVec3,
    pub(crate) cell: [i64; 3],
}

impl Patch<'_> {
    /// The nearest candidate in a direction, and its distance in multiples of the direction.
    pub(crate) fn front(&self, direction: DVec3) -> Option<(usize, f64)> {
        let mut nearest: Option<(usize, f64)> = None;
        for (index, candidate) in self.candidates.iter().enumerate() {
            if let Some(t) = candidate.ball.hit(direction)
                && nearest.is_none_or(|(_, before)| t < before)
            {
                nearest = Some((index, t));
            }
        }
        nearest
    }

    /// The point of a candidate at `t` times a direction.
    pub(crate) fn spot(&self, candidate: &Candidate, direction: DVec3, t: f64) -> Spot {
        let point = candidate.ball.point(direction, t);
        let normal = candidate.ball.normal(point);
        match &self.stage.world.material(candidate.sphere).roughness {
            None => Spot {
                point,
                normal,
                cell: [0; 3],
            },
            Some(rough) => {
                let radius = candidate.ball.radius;
                let bump = bump(rough, candidate.sphere, radius, normal, self.key);
                Spot {
                    point,
                    normal: bump.normal,
                    cell: bump.cell,
                }
            }
        }
    }

    /// The half vector between a light and the direction toward the viewpoint.
    pub(crate) fn half_way(&self, light: DVec3, direction: DVec3) -> DVec3 {
        let away = self.stage.forward.unwrap_or_else(|| direction.normalize());
        (light - away).normalize_or_zero()
    }

    pub(crate) fn signature(&self, direction: DVec3) -> Signature {
        self.look(direction, false).0
    }

    /// The sphere in a direction, with its light and coverage if `is_asked`.
    pub(crate) fn look(&self, direction: DVec3, is_asked: bool) -> (Signature, DVec4) {
        let mut signature = Signature::default();
        let Some((index, t)) = self.front(direction) else {
            return (signature, DVec4::ZERO);
        };
        signature.seen = index + 1;
        let candidate = &self.candidates[index];
        let world = self.stage.world;
        let material = world.material(candidate.sphere);
        let albedo = world.albedo(candidate.sphere);
        if candidate.ball.begins_inside(direction) {
            signature.is_inner = true;
            return (signature, (albedo * world.ambient).extend(1.0));
        }
        if let (Some(outline), Some(inside)) = (&material.outline, &candidate.inside)
            && inside.chord_sq(direction) < 0.0
        {
            signature.is_outline = true;
            return (signature, outline.color.extend(1.0));
        }
        let spot = self.spot(candidate, direction, t);
        signature.cell = spot.cell;
        let (mut scattered, mut mirrored) = (world.ambient, DVec3::ZERO);
        for (number, light) in world.lights.iter().enumerate() {
            if let Some(sun) = &self.stage.softness.suns[number] {
                let state = self.state(sun, (candidate, &candidate.casters[number]), &spot);
                signature.soft = signature.soft.and(state);
                let shine = self.shine(sun, material.highlight.as_ref(), &spot, direction);
                let shines = shine > 0.0 && !state.is_dark();
                signature.shines |= u64::from(shines) << number;
                continue;
            }
            let lamp = &self.stage.lamps[number];
            let (toward, factor) = lamp.seen_from(spot.point);
            let facing = spot.normal.dot(toward);
            if facing <= 0.0
                || lamp.ahead(spot.point).is_some_and(|ahead| ahead <= 0.0)
                || lamp.is_inside(&candidate.ball)
                || self.is_shadowed(candidate, number, spot.point)
            {
                continue;
            }
            signature.lit |= 1 << number;
            if is_asked {
                scattered += light.intensity() * factor * facing.powf(material.exponent);
            }
            if let Some(highlight) = &material.highlight {
                let cosine = spot.normal.dot(self.half_way(toward, direction));
                if cosine > 0.0 {
                    signature.shines |= 1 << number;
                    if is_asked {
                        let shine = highlight.strength * cosine.powf(highlight.shininess);
                        mirrored += light.intensity() * factor * shine;
                    }
                }
            }
        }
        let mut light = albedo * scattered + mirrored;
        if is_asked && self.stage.softness.is_any() {
            light += self.soft_light(candidate, &spot, direction);
        }
        (signature, light.extend(1.0))
    }

    fn is_shadowed(&self, candidate: &Candidate, light: usize, point: DVec3) -> bool {
        let lamp = &self.stage.lamps[light];
        candidate.casters[light].iter().any(|&caster| {
            let (chord_sq, is_ahead) = lamp.shadow(&self.stage.balls[caster], point);
            is_ahead && chord_sq >= 0.0
        })
    }
}
