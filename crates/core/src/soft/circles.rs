//! The circles around many caps, side by side.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::cap::{Cap, NEARLY_OPPOSITE};
use crate::numeric::lanes::{LANES, f64x8};

/// The caps that a direction may be hidden by.
#[derive(Clone, Debug)]
pub(crate) struct Circles {
    /// Eight caps each: the axes by component, and the versines.
    groups: Vec<Group>,
    count: usize,
    /// The instructions that the processor has.
    level: Level,
}

#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Group {
    axis: [[f64; LANES]; 3],
    versine: [f64; LANES],
}

/// Groups that are looked at together.
const GROUPS: usize = 4;

/// Caps that are looked at together: their places are bits of a number.
pub(crate) const BLOCK: usize = GROUPS * LANES;

/// Which caps of a block the circle around another cap meets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Block {
    /// Larger ones that the circle is inside of.
    pub(crate) around: u64,
    /// Those that it may cross, and equal ones: [`Cap::meeting`] tells.
    pub(crate) unsure: u64,
}

impl Default for Circles {
    fn default() -> Self {
        Self {
            groups: Vec::new(),
            count: 0,
            level: Level::new(),
        }
    }
}

impl Circles {
    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.count = 0;
    }

    pub(crate) fn push(&mut self, cap: &Cap) {
        let lane = self.count % LANES;
        if lane == 0 {
            // Caps of no size at no place meet nothing.
            self.groups.push(Group {
                axis: [[0.0; LANES]; 3],
                versine: [0.0; LANES],
            });
        }
        if let Some(last) = self.groups.last_mut() {
            let DVec3 { x, y, z } = cap.axis;
            for (lanes, number) in last.axis.iter_mut().zip([x, y, z]) {
                lanes[lane] = number;
            }
            last.versine[lane] = cap.versine;
        }
        self.count += 1;
    }

    /// The number of blocks.
    pub(crate) fn blocks(&self) -> usize {
        self.count.div_ceil(BLOCK)
    }

    /// Which caps of a block the circle around a cap meets.
    pub(crate) fn block(&self, cap: &Cap, block: usize) -> Block {
        let groups = &self.groups[block * GROUPS..];
        let groups = &groups[..groups.len().min(GROUPS)];
        dispatch!(self.level, simd => meetings(simd, groups, cap))
    }
}

/// The same by the formulas of [`Cap::meeting`].
#[inline(always)]
fn meetings<S: Simd>(simd: S, groups: &[Group], cap: &Cap) -> Block {
    let [x, y, z] = cap.axis.to_array().map(|number| f64x8::splat(simd, number));
    let u = f64x8::splat(simd, cap.versine);
    let mut block = Block::default();
    for (number, group) in groups.iter().enumerate() {
        let dx = f64x8::from_array(simd, group.axis[0]) - x;
        let dy = f64x8::from_array(simd, group.axis[1]) - y;
        let dz = f64x8::from_array(simd, group.axis[2]) - z;
        let v = f64x8::from_array(simd, group.versine);
        let w = (dx * dx + dy * dy + dz * dz) * 0.5;
        let excess = w - u - v;
        let uv = u * v;
        let discriminant = uv * 4.0 - excess * excess - uv * w * 2.0;
        let may_contain = discriminant.simd_le(0.0) & (excess + uv).simd_lt(0.0);
        let may_touch = w.simd_gt(NEARLY_OPPOSITE) & (u + v).simd_ge(0.99);
        let unsure = discriminant.simd_gt(0.0) | may_touch | (may_contain & u.simd_eq(v));
        let around = may_contain & u.simd_lt(v) & w.simd_le(NEARLY_OPPOSITE);
        let shift = number * LANES;
        block.around |= around.to_bitmask() << shift;
        block.unsure |= unsure.to_bitmask() << shift;
    }
    block
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soft::cap::Meeting;

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
    fn blocks_say_what_pairs_of_caps_say() {
        let caps = caps();
        let mut circles = Circles::default();
        caps.iter().for_each(|cap| circles.push(cap));
        let mut counts = [0; 3];
        for (index, cap) in caps.iter().enumerate() {
            for (number, other) in caps.iter().enumerate() {
                let found = circles.block(cap, number / BLOCK);
                let bit = 1 << (number % BLOCK);
                match cap.meeting(other, index < number) {
                    _ if number == index => {}
                    Meeting::Apart => {
                        counts[0] += 1;
                        assert_eq!(found.around & bit, 0);
                    }
                    Meeting::Inside => {
                        counts[1] += 1;
                        assert_ne!((found.around | found.unsure) & bit, 0);
                    }
                    Meeting::Crossing(_) => {
                        counts[2] += 1;
                        assert_eq!(found.around & bit, 0);
                        assert_ne!(found.unsure & bit, 0);
                    }
                }
            }
        }
        assert!(counts.iter().all(|&count| count > 50), "{counts:?}");
    }
}
