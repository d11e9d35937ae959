//! The part of a patch's surroundings from which occluders together keep a light.

use fearless_simd::{Level, Simd, dispatch};

use super::mask;
use super::occluders::Occluder;
use super::patch::Patch;
use crate::exact::scene::Light;
use crate::numeric::lanes::f64x8;
use crate::numeric::rounding::{GEOMETRY_SLACK, WIDER};

/// A margin in squares, more than rounding: discs that cover squares are taken to be narrower by it, and
/// those that touch them wider.
const INSET: f64 = 1e-9;

/// The squares of the box around a patch, as a light sees it, that occluders cover: a bit each.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadeMask {
    level: Level,
    low: [f64; 2],
    step: [f64; 2],
    /// The greatest height of the patch toward the light.
    top: f64,
    covered: u64,
}

impl ShadeMask {
    pub(super) fn new(level: Level, patch: &Patch, light: &Light) -> Self {
        let mut places = [[0.0; 2]; 3];
        for (place, axis) in places.iter_mut().zip([light.right, light.up, light.toward]) {
            *place = patch.ends.map(|end| end.dot(axis));
        }
        let most = places
            .iter()
            .flatten()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        let around = patch.around + GEOMETRY_SLACK * most;
        let [x, y, height] = places;
        let low = [x[0].min(x[1]) - around, y[0].min(y[1]) - around];
        let high = [x[0].max(x[1]) + around, y[0].max(y[1]) + around];
        Self {
            level,
            low,
            step: [
                (high[0] - low[0]) / mask::SIDE as f64,
                (high[1] - low[1]) / mask::SIDE as f64,
            ],
            top: height[0].max(height[1]) + around,
            covered: 0,
        }
    }

    pub(super) fn is_full(&self) -> bool {
        self.covered == mask::ALL
    }

    /// Covers the squares whose corners lie in the disc of an occluder that is wholly above the patch.
    pub(super) fn add(&mut self, occluder: &Occluder) {
        let radius = occluder.radius - occluder.slack;
        if radius > 0.0 && occluder.height - occluder.slack > self.top {
            self.covered |= mask::between(self.lines(occluder, 0.0, radius, INSET));
        }
    }

    /// Returns whether all squares that the disc of an occluder may touch are covered.
    pub(super) fn hides(&self, occluder: &Occluder) -> bool {
        if self.covered == 0 {
            return false;
        }
        // A square is touched where its middle is no farther than half its diagonal.
        let [x, y] = self.step;
        let reach = occluder.radius + occluder.slack + 0.5 * (x * x + y * y).sqrt() * WIDER;
        self.lines(occluder, 0.5, reach, -INSET) & mask::ALL & !self.covered == 0
    }

    /// The corners of squares that lie in a circle around an occluder's middle: a byte for each of eight
    /// lines, which are shifted by `shift` squares. The circle is narrower by `margin` squares at both ends
    /// of each line.
    fn lines(&self, occluder: &Occluder, shift: f64, radius: f64, margin: f64) -> u64 {
        dispatch!(self.level, simd => self.lines_of(simd, occluder, shift, radius, margin))
    }

    #[inline(always)]
    fn lines_of<S: Simd>(
        &self,
        simd: S,
        occluder: &Occluder,
        shift: f64,
        radius: f64,
        margin: f64,
    ) -> u64 {
        let lines: [f64; 8] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let lines: f64x8<S> = f64x8::from_array(simd, lines);
        let y = (lines + shift) * self.step[1] + (self.low[1] - occluder.y);
        let rest = y * y * -1.0 + radius * radius;
        let half = rest.max(f64x8::splat(simd, 0.0)).sqrt() * (1.0 / self.step[0]);
        let middle = (occluder.x - self.low[0]) / self.step[0] - shift;
        let (first, last): ([f64; 8], [f64; 8]) = (
            (middle - half + margin).into(),
            (half + (middle - margin)).into(),
        );
        let inside = rest.simd_gt(0.0).to_bitmask();
        let mut bits = 0;
        for line in 0..8 {
            let first = first[line].ceil().clamp(0.0, 8.0) as u32;
            let end = (last[line].floor() + 1.0).clamp(0.0, 8.0) as u32;
            if inside >> line & 1 == 1 && first < end {
                let row = (1_u64 << end) - (1 << first);
                bits |= row << (8 * line);
            }
        }
        bits
    }
}
