//! The spheres that may hide light from some points, side by side.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::cap::{Cap, NO_SPHERE};
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, Lanes as _, f64x8};
use crate::numeric::pair::three;

/// Spheres that may hide light.
#[derive(Clone, Debug)]
pub(crate) struct Bodies {
    groups: Vec<Group>,
    count: usize,
    /// The instructions that the processor has.
    level: Level,
}

/// Eight spheres; those that are missing are infinitely far below any surface.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Group {
    center: [[f64; LANES]; 3],
    radius: [f64; LANES],
    number: [u32; LANES],
}

impl Default for Bodies {
    fn default() -> Self {
        Self {
            groups: Vec::new(),
            count: 0,
            level: Level::new(),
        }
    }
}

impl Bodies {
    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.count = 0;
    }

    /// Adds a sphere, and its number.
    pub(crate) fn push(&mut self, sphere: &Sphere, number: u32) {
        let lane = self.count % LANES;
        if lane == 0 {
            self.groups.push(Group {
                center: [[0.0; LANES]; 3],
                radius: [f64::NEG_INFINITY; LANES],
                number: [NO_SPHERE; LANES],
            });
        }
        if let Some(last) = self.groups.last_mut() {
            for (lanes, number) in last.center.iter_mut().zip(sphere.center().to_array()) {
                lanes[lane] = number;
            }
            last.radius[lane] = sphere.radius();
            last.number[lane] = number;
        }
        self.count += 1;
    }

    /// Adds the caps that they hide from a point above the plane across a unit normal, in their order.
    pub(crate) fn caps(&self, position: DVec3, normal: DVec3, caps: &mut Vec<Cap>) {
        dispatch!(self.level, simd => all_caps(simd, &self.groups, (position, normal), caps));
    }
}

/// The same by the formulas of [`Cap::of_sphere`].
#[inline(always)]
fn all_caps<S: Simd>(
    simd: S,
    groups: &[Group],
    (position, normal): (DVec3, DVec3),
    caps: &mut Vec<Cap>,
) {
    let from = three(position.to_array(), |number| f64x8::splat(simd, number));
    let up = three(normal.to_array(), |number| f64x8::splat(simd, number));
    let one = f64x8::splat(simd, 1.0);
    let zero = f64x8::splat(simd, 0.0);
    let least = f64x8::splat(simd, f64::MIN_POSITIVE);
    for group in groups {
        let x = f64x8::from_array(simd, group.center[0]) - from[0];
        let y = f64x8::from_array(simd, group.center[1]) - from[1];
        let z = f64x8::from_array(simd, group.center[2]) - from[2];
        let radius = f64x8::from_array(simd, group.radius);
        let height = x * up[0] + y * up[1] + z * up[2];
        let above = (height + radius).simd_gt(0.0).to_bitmask();
        if above == 0 {
            continue;
        }
        // The point may be a center: then the cap has no axis, but all numbers are finite.
        let distance = (x * x + y * y + z * z).sqrt().max(least);
        let inverse = distance.reciprocal();
        let sine = (radius * inverse).min(one);
        let apart = (distance - radius).max(zero);
        let cosine = (apart * (distance + radius)).sqrt() * inverse;
        let versine = sine * sine * (cosine + 1.0).reciprocal();
        let (x, y, z) = (x * inverse, y * inverse, z * inverse);
        for lane in set_bits(above) {
            caps.push(Cap {
                axis: DVec3::new(x[lane], y[lane], z[lane]),
                sine: sine[lane],
                cosine: cosine[lane],
                versine: versine[lane],
                sphere: group.number[lane],
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patches::light::height_and_cosine;

    #[test]
    fn nodes_at_the_center_of_a_sphere_have_finite_light() {
        let center = DVec3::new(0.0, 0.0, -1.0);
        let sphere = Sphere::new(center, 0.15).unwrap();
        let mut bodies = Bodies::default();
        bodies.push(&sphere, 7);
        let mut caps = Vec::new();
        bodies.caps(center, DVec3::NEG_Z, &mut caps);
        let [cap] = caps[..] else { panic!("{caps:?}") };
        assert!(cap.axis.is_finite(), "{cap:?}");
        assert_eq!([cap.sine, cap.cosine, cap.versine], [1.0, 0.0, 1.0]);
        assert_eq!(height_and_cosine(&sphere, center), (-0.15, 0.0));
    }
}
