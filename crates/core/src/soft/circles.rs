//! The circles around many caps, side by side.
//!
//! Single precision tells which caps may touch another; only those are compared in double precision, eight at a time. So what a
//! circle has in common with others does not depend on how near ones are found.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::arcs::{Arcs, Covered, NONE};
use super::cap::{Cap, Frame, Meeting, NEARLY_OPPOSITE};
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f32x8, f64x8};

/// The caps that a direction may be hidden by, in single precision: that tells which ones are close to another.
#[derive(Clone, Debug)]
pub(crate) struct Circles {
    groups: Vec<Group>,
    count: usize,
    /// The numbers of those that are close.
    near: Vec<u32>,
    /// The instructions that the processor has.
    level: Level,
}

/// Eight caps: the axes by component, the cosines and the sines.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct Group([[f32; LANES]; 5]);

/// More than twice what rounding to single precision moves the sum of five products of numbers up to 1 by.
const SLACK: f32 = 4e-6;

impl Default for Circles {
    fn default() -> Self {
        Self {
            groups: Vec::new(),
            count: 0,
            near: Vec::new(),
            level: Level::new(),
        }
    }
}

fn singles(cap: &Cap) -> [f32; 5] {
    let DVec3 { x, y, z } = cap.axis;
    [
        x as f32,
        y as f32,
        z as f32,
        cap.cosine as f32,
        cap.sine as f32,
    ]
}

impl Circles {
    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.count = 0;
    }

    pub(crate) fn push(&mut self, cap: &Cap) {
        let lane = self.count % LANES;
        if lane == 0 {
            // Caps of no sine at all are close to nothing.
            let [none, sine] = [[0.0; LANES], [f32::NEG_INFINITY; LANES]];
            self.groups.push(Group([none, none, none, none, sine]));
        }
        if let Some(last) = self.groups.last_mut() {
            for (lanes, number) in last.0.iter_mut().zip(singles(cap)) {
                lanes[lane] = number;
            }
        }
        self.count += 1;
    }

    /// True only if one of the caps is larger than another and contains it.
    pub(crate) fn contain(&self, cap: &Cap) -> bool {
        dispatch!(self.level, simd => is_contained(simd, &self.groups, cap))
    }

    /// Adds what the caps leave of the circle around a cap to arcs, of which some may be covered; false if they leave
    /// nothing. `caps` are these caps, and `index` the number of the cap among them, if it is one.
    pub(crate) fn expose(
        &mut self,
        circle: (&Cap, &Frame),
        caps: &[Cap],
        index: Option<usize>,
        arcs: &mut Arcs,
    ) -> bool {
        let Self { groups, near, .. } = self;
        near.clear();
        dispatch!(self.level, simd => {
            find_near(simd, groups, circle.0, near);
            cover_all(simd, circle, (caps, near, index), arcs) && arcs.expose(simd)
        })
    }
}

impl Group {
    /// The cosines of the angles between axes, less those at which caps touch from outside; with the negative sine, at which they
    /// touch from inside.
    #[inline(always)]
    fn apart<S: Simd>(&self, simd: S, [x, y, z, cosine, sine]: [f32; 5]) -> f32x8<S> {
        self.times(simd, 0, x)
            + self.times(simd, 1, y)
            + self.times(simd, 2, z)
            + self.times(simd, 3, -cosine)
            + self.times(simd, 4, sine)
    }

    /// One of the numbers of each cap, times a factor.
    #[inline(always)]
    fn times<S: Simd>(&self, simd: S, number: usize, factor: f32) -> f32x8<S> {
        f32x8::from_array(simd, self.0[number]) * f32x8::splat(simd, factor)
    }
}

#[inline(always)]
fn is_contained<S: Simd>(simd: S, groups: &[Group], cap: &Cap) -> bool {
    let [x, y, z, cosine, sine] = singles(cap);
    for group in groups {
        let apart = group.apart(simd, [x, y, z, cosine, -sine]);
        let larger = f32x8::from_array(simd, group.0[4]).simd_gt(f32x8::splat(simd, sine));
        let contain = apart.simd_gt(f32x8::splat(simd, SLACK));
        if (larger & contain).any_true() {
            return true;
        }
    }
    false
}

/// The numbers of the caps that another cap may touch.
#[inline(always)]
fn find_near<S: Simd>(simd: S, groups: &[Group], cap: &Cap, near: &mut Vec<u32>) {
    let of = singles(cap);
    for (number, groups) in groups.chunks(LANES).enumerate() {
        let mut near_ones = 0_u64;
        for (number, group) in groups.iter().enumerate() {
            let touch = group.apart(simd, of).simd_gt(f32x8::splat(simd, -SLACK));
            near_ones |= touch.to_bitmask() << (number * LANES);
        }
        for place in set_bits(near_ones) {
            near.push((number * LANES * LANES + place) as u32);
        }
    }
}

/// Covers all that some caps, the ones of these numbers, cover of a circle; false if one of them covers all of it. By the
/// formulas of [`Cap::meeting`].
#[inline(always)]
fn cover_all<S: Simd>(
    simd: S,
    (cap, frame): (&Cap, &Frame),
    (caps, near, index): (&[Cap], &[u32], Option<usize>),
    arcs: &mut Arcs,
) -> bool {
    let u = cap.versine;
    for numbers in near.chunks(LANES) {
        let mut of = [[0.0; LANES]; 4];
        for (lane, &number) in numbers.iter().enumerate() {
            let other = &caps[number as usize];
            of[0][lane] = other.axis.x;
            of[1][lane] = other.axis.y;
            of[2][lane] = other.axis.z;
            of[3][lane] = other.versine;
        }
        let x = f64x8::from_array(simd, of[0]) - cap.axis.x;
        let y = f64x8::from_array(simd, of[1]) - cap.axis.y;
        let z = f64x8::from_array(simd, of[2]) - cap.axis.z;
        let v = f64x8::from_array(simd, of[3]);
        let w = (x * x + y * y + z * z) * 0.5;
        let excess = w - u - v;
        let uv = v * u;
        let discriminant = uv * 4.0 - excess * excess - uv * w * 2.0;
        let contain = discriminant.simd_le(0.0) & (excess + uv).simd_lt(0.0);
        let is_far = w.simd_gt(NEARLY_OPPOSITE).to_bitmask();
        if (contain & v.simd_gt(u)).to_bitmask() & !is_far != 0 {
            return false;
        }
        let cross = discriminant.simd_gt(0.0);
        // Those that are equal, or on either side, are looked at one by one.
        let same = (cross & w.simd_le(0.0)) | (contain & v.simd_eq(u));
        let all = (1 << numbers.len()) - 1;
        let unsure = (same.to_bitmask() | is_far) & all;
        for lane in set_bits(unsure) {
            let number = numbers[lane] as usize;
            if Some(number) != index {
                let is_first = matches!(index, Some(index) if index < number);
                match cap.meeting(&caps[number], is_first) {
                    Meeting::Apart => {}
                    Meeting::Inside => return false,
                    Meeting::Crossing(crossing) => arcs.cover(&crossing, frame, number),
                }
            }
        }
        let sure = cross.to_bitmask() & all & !unsure;
        if sure != 0 {
            let covered = Covered {
                x: (x * frame.x.x + y * frame.x.y + z * frame.x.z).into(),
                y: (x * frame.y.x + y * frame.y.y + z * frame.y.z).into(),
                t: (v * -1.0 + u + w * (1.0 - u)).into(),
                root: discriminant.sqrt().into(),
                ..NONE
            };
            arcs.cover_lanes(sure, &covered, numbers);
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::numeric::lanes::tests::levels;

    /// Caps of all sizes, some of them equal, some nearly opposite to others.
    fn caps() -> Vec<Cap> {
        let mut state = 5_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
        };
        let mut caps: Vec<Cap> = Vec::new();
        for number in 0..150 {
            let axis = DVec3::new(next(), next(), next()).normalize();
            let angle = libm::exp(-3.0 * next().abs()) * 1.5;
            caps.push(match number % 10 {
                8 => caps[number / 2],
                9 => Cap::within(-caps[number / 2].axis, angle),
                _ => Cap::within(axis, angle),
            });
        }
        caps
    }

    #[test]
    fn circles_are_exposed_where_no_cap_is() {
        let caps = caps();
        let (mut counts, mut arcs) = ([0; 3], Arcs::default());
        for (first, cap) in caps.iter().enumerate() {
            // The cap itself is the first of some; of few ones it is more often seen.
            let some: Vec<Cap> = (0..first % 23).map(|by| caps[(first + by) % 150]).collect();
            let mut circles = Circles::default();
            some.iter().for_each(|other| circles.push(other));
            arcs.clear();
            let frame = cap.frame();
            let is_exposed = circles.expose((cap, &frame), &some, Some(0), &mut arcs);
            let exposed = arcs.exposed();
            // Narrower vectors find the same bits.
            for level in levels() {
                let mut narrow = Circles {
                    level,
                    ..circles.clone()
                };
                let mut others = Arcs::default();
                narrow.expose((cap, &frame), &some, Some(0), &mut others);
                assert_eq!(format!("{exposed:?}"), format!("{:?}", others.exposed()));
            }
            counts[usize::from(is_exposed) * (1 + usize::from(!exposed.is_empty()))] += 1;
            for angle in 0..500 {
                let (sine, cosine) = libm::sincos(f64::from(angle));
                let at = DVec2::new(cosine, sine);
                let point = cap.point(&frame, at, DVec3::ZERO);
                let inside = |other: &Cap| other.axis.dot(point) - other.cosine;
                let inside = some.iter().skip(1).map(inside);
                let inside = inside.fold(f64::NEG_INFINITY, f64::max);
                let is_between = exposed.iter().any(|arc| {
                    let [begin, end] = arc.ends;
                    let way = |to: DVec2| begin.at.angle_to(to).rem_euclid(std::f64::consts::TAU);
                    way(at) <= way(end.at)
                });
                let is_seen = is_exposed && (exposed.is_empty() || is_between);
                assert!(
                    inside.abs() < 1e-9 || is_seen == (inside < 0.0),
                    "{first}: {inside}"
                );
            }
        }
        assert!(counts.iter().all(|&count| count > 10), "{counts:?}");
    }

    #[test]
    fn caps_are_contained_only_in_caps_that_are_around_them() {
        let caps = caps();
        let (mut contained, mut missed) = (0, 0);
        for cap in &caps {
            for other in &caps {
                let mut circles = Circles::default();
                circles.push(other);
                let is_around = other.versine > cap.versine
                    && matches!(cap.meeting(other, false), Meeting::Inside);
                if circles.contain(cap) {
                    contained += 1;
                    assert!(is_around, "{cap:?} {other:?}");
                } else {
                    missed += usize::from(is_around);
                }
            }
        }
        assert!(contained > 100 && missed == 0, "{contained} {missed}");
    }
}
