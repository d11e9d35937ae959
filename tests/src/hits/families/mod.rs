//! Rays and spheres of many kinds, difficult and ordinary.

mod extremes;
mod grazing;
mod near;
mod ordinary;
mod random;
mod tangent;
mod tuned;

use glam::DVec3;
use marbles_core::{Ray, Sphere};

pub use random::Random;

/// Cases of one kind.
pub struct Family {
    /// The name in tables.
    pub name: &'static str,
    draw: fn(&mut Random) -> Draft,
}

/// A ray and a sphere, which may be invalid because the radius under- or overflowed.
#[derive(Clone, Copy)]
struct Draft {
    origin: DVec3,
    direction: DVec3,
    center: DVec3,
    radius: f64,
}

/// Every family.
pub const FAMILIES: [Family; 46] = [
    Family::new("generic", ordinary::generic),
    Family::new("inside", ordinary::inside),
    Family::new("behind", ordinary::behind),
    Family::new("through the center", ordinary::through_center),
    Family::new("far and small", ordinary::far_and_small),
    Family::new("offset by 1e8", ordinary::offset),
    Family::new("directions × 1e±150", ordinary::scaled_direction),
    Family::new("scenes × 1e±150", ordinary::scaled_scene),
    Family::new("small whole numbers", ordinary::lattice),
    Family::new("t near powers of two", ordinary::binade),
    Family::new("graze along an axis", grazing::along_axis),
    Family::new("graze obliquely", grazing::oblique),
    Family::new("graze, turned ray", grazing::turned),
    Family::new("graze, mixed", grazing::mixed),
    Family::new("graze, rounded", grazing::rounded),
    Family::new("graze by whole numbers", grazing::by_whole_numbers),
    Family::new("graze at any scale", grazing::at_any_scale),
    Family::new("graze, tuned", tuned::grazing),
    Family::new("tangent along an axis", tangent::along_axis),
    Family::new("tangent obliquely", tangent::oblique),
    Family::new("tangent, scaled", tangent::scaled),
    Family::new("neighbors of tangents", tangent::neighbors),
    Family::new("tangent at the origin", tangent::at_origin),
    Family::new("huge and near", near::huge),
    Family::new("on the surface", near::on_surface),
    Family::new("surface, neighbors", near::on_surface_neighbors),
    Family::new("surface, to rounding", near::rounded_surface),
    Family::new("surface, tuned", tuned::near_surface),
    Family::new("along, tuned", tuned::both),
    Family::new("along the surface", near::along_surface),
    Family::new("cancellation", near::cancellation),
    Family::new("near-equal shells", near::concentric),
    Family::new("nearly touching", near::touching),
    Family::new("orthogonal", near::orthogonal),
    Family::new("denormal scene", extremes::denormal_scene),
    Family::new("denormal direction", extremes::denormal_direction),
    Family::new("all denormal", extremes::all_denormal),
    Family::new("wild direction", extremes::wild_direction),
    Family::new("wild position", extremes::wild_position),
    Family::new("huge coordinates", extremes::huge_coordinates),
    Family::new("radius, huge or tiny", extremes::extreme_radius),
    Family::new("distance overflows", extremes::overflowing_distance),
    Family::new("distance underflows", extremes::underflowing_distance),
    Family::new("squares near 2^±256", extremes::limits_of_moderation),
    Family::new("any exponents", extremes::any_exponents),
    Family::new("any bits", extremes::any_bits),
];

impl Family {
    const fn new(name: &'static str, draw: fn(&mut Random) -> Draft) -> Self {
        Self { name, draw }
    }

    /// The case with this number; the same on every machine.
    pub fn case(&self, number: u64) -> (Sphere, Ray) {
        let name = self.name.bytes().fold(number, |seed, byte| {
            Random::new(seed ^ u64::from(byte) << 56).bits()
        });
        let mut random = Random::new(name);
        loop {
            let draft = (self.draw)(&mut random);
            let finite = draft.origin.is_finite() && draft.direction.is_finite();
            let Ok(sphere) = Sphere::new(draft.center, draft.radius) else {
                continue;
            };
            if finite && draft.direction != DVec3::ZERO {
                let (origin, direction) = (draft.origin, draft.direction);
                return (sphere, Ray { origin, direction });
            }
        }
    }
}

impl Draft {
    /// Multiplies the scene, without the direction, by a factor.
    fn scaled(self, factor: f64) -> Self {
        Self {
            origin: self.origin * factor,
            center: self.center * factor,
            radius: self.radius * factor,
            ..self
        }
    }

    fn moved(self, by: DVec3) -> Self {
        Self {
            origin: self.origin + by,
            center: self.center + by,
            ..self
        }
    }

    /// Multiplies the direction by a factor.
    fn stretched(self, factor: f64) -> Self {
        Self {
            direction: self.direction * factor,
            ..self
        }
    }

    /// Replaces one of the ten numbers by a neighbor that is up to `reach` doubles away.
    fn nudged(mut self, random: &mut Random, reach: i64) -> Self {
        let index = random.integer(0, 9) as usize;
        let number = match index {
            0..3 => &mut self.origin[index],
            3..6 => &mut self.direction[index - 3],
            6..9 => &mut self.center[index - 6],
            _ => &mut self.radius,
        };
        let up = random.one_in(2);
        for _ in 0..random.integer(1, reach) {
            *number = if up {
                number.next_up()
            } else {
                number.next_down()
            };
        }
        self
    }

    /// Permutes and reverses the axes, which rounds nothing.
    fn shuffled(mut self, random: &mut Random) -> Self {
        let turns = random.integer(0, 2);
        let signs = DVec3::new(random.sign(), random.sign(), random.sign());
        for vector in [&mut self.origin, &mut self.direction, &mut self.center] {
            for _ in 0..turns {
                *vector = DVec3::new(vector.y, vector.z, vector.x);
            }
            *vector *= signs;
        }
        self
    }
}
