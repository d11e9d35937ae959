//! Spheres as a light sees them, eight side by side, sorted into squares across the light.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec2;

use crate::numeric::lanes::{LANES, f32x8};

/// A sphere as the light sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct HighDisc {
    /// Its center, across the light.
    pub(super) center: DVec2,
    pub(super) radius: f64,
    /// The height up to which it reaches toward the light.
    pub(super) top: f64,
    /// The sphere's index.
    pub(super) sphere: u32,
}

/// Eight discs, in single precision, by their distances from the low corner of a cell; places that are left
/// over lie below everything.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct DiscGroup {
    /// Their centers, across the light.
    x: [f32; LANES],
    y: [f32; LANES],
    /// Rounded up by more than what rounding moves the centers by.
    radius: [f32; LANES],
    /// Rounded up.
    top: [f32; LANES],
    sphere: [u32; LANES],
}

const EMPTY: DiscGroup = DiscGroup {
    x: [0.0; LANES],
    y: [0.0; LANES],
    radius: [0.0; LANES],
    top: [f32::NEG_INFINITY; LANES],
    sphere: [0; LANES],
};

/// More than rounding to single precision moves numbers by, relatively: four times as much.
const ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

/// A number in single precision that is not less; of what is no number, that.
#[inline(always)]
pub(super) fn up(number: f64) -> f32 {
    (number + number.abs() * ROUNDING) as f32
}

/// A point below a light.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointBelow {
    /// Its place across the light.
    pub(super) place: DVec2,
    /// Its place along the light.
    pub(super) height: f64,
    /// It is off by no more than this, with what rounding costs.
    pub(super) around: f64,
    /// True if it lies above the center of its own sphere for certain.
    pub(super) is_above_own: bool,
}

/// A square across the light, and where a cell above it begins. Squares of its side times [`ROUNDING`] are
/// normal numbers of single precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    pub(super) low: DVec2,
    pub(super) bottom: f64,
    pub(super) side: f64,
    /// Points inside may lie outside by so much.
    pub(super) margin: f64,
}

/// The discs that reach into a square, listed in each of its parts.
#[derive(Clone, Debug, Default)]
pub(super) struct DiscGrid {
    low: DVec2,
    bottom: f64,
    /// More than rounding to single precision moves points of the square by.
    rounding: f64,
    /// Parts on a length of 1.
    on_unit: f64,
    /// Parts on a side.
    parts: u32,
    /// Spheres reach as far as discs that are so much smaller, and their centers lie no lower than that much
    /// below those of the discs.
    excess: f64,
    /// The starts of the groups of each part; one more for the end.
    starts: Vec<u32>,
    groups: Vec<DiscGroup>,
    /// Memory to work in: what each disc reaches into.
    reached: Vec<Reached>,
}

/// Parts of a square.
#[derive(Clone, Copy, Debug)]
struct Reached {
    columns: (u8, u8),
    rows: (u8, u8),
}

impl Reached {
    /// The numbers of the parts, where so many lie side by side.
    #[inline(always)]
    fn parts(self, side: u32) -> impl Iterator<Item = usize> {
        let (first, last) = self.columns;
        (self.rows.0..=self.rows.1).flat_map(move |row| {
            (first..=last).map(move |column| row as usize * side as usize + column as usize)
        })
    }
}

impl DiscGrid {
    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.parts = 1;
        self.starts.clear();
        self.starts.extend([0, 0]);
        self.groups.clear();
    }

    /// Places for discs.
    pub(super) fn len(&self) -> usize {
        self.groups.len() * LANES
    }

    /// Takes in the discs that reach into a square.
    pub(super) fn fill(&mut self, square: &Square, discs: &[HighDisc], excess: f64) {
        self.clear();
        self.low = square.low;
        self.bottom = square.bottom;
        self.rounding = square.side * ROUNDING;
        self.excess = excess;
        self.parts = parts(square, discs);
        self.on_unit = f64::from(self.parts) / square.side;
        if discs.is_empty() {
            return;
        }
        let count = (self.parts * self.parts) as usize;
        self.starts.clear();
        self.starts.resize(count + 1, 0);
        // First how many discs, one part further on; then where each list ends, by counting up.
        self.reached.clear();
        for disc in discs {
            let reached = self.reached(disc, square.margin);
            self.reached.push(reached);
            for part in reached.parts(self.parts) {
                self.starts[part + 1] += 1;
            }
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += start.next_multiple_of(LANES as u32);
            *start = sum;
        }
        self.groups.resize(sum as usize / LANES, EMPTY);
        // Each part is filled from its begin, which moves up to its end; then ends are begins again.
        for (disc, reached) in discs.iter().zip(&self.reached) {
            let center = disc.center - square.low;
            let moved = (center.x.abs() + center.y.abs()) * ROUNDING;
            let above = disc.top - square.bottom;
            let (radius, top) = (up(disc.radius + moved), up(above));
            // What the radius is larger by, the center may be off by, and the top is higher by; twice.
            let more = 2.0 * moved + 4.0 * ROUNDING * (disc.radius + moved + above.abs());
            let excess = excess + more;
            if excess > self.excess || excess.is_nan() {
                self.excess = excess;
            }
            for part in reached.parts(self.parts) {
                let place = self.starts[part] as usize;
                self.starts[part] += 1;
                let (group, lane) = (&mut self.groups[place / LANES], place % LANES);
                group.x[lane] = center.x as f32;
                group.y[lane] = center.y as f32;
                group.radius[lane] = radius;
                group.top[lane] = top;
                group.sphere[lane] = disc.sphere;
            }
        }
        for part in (0..count).rev() {
            self.starts[part + 1] = self.starts[part].div_ceil(LANES as u32);
        }
        self.starts[0] = 0;
    }

    /// The first and the last part to either side that a disc reaches into.
    #[inline(always)]
    fn reached(&self, disc: &HighDisc, margin: f64) -> Reached {
        let last = f64::from(self.parts - 1);
        let reach = disc.radius + margin;
        let low = (disc.center - reach - self.low) * self.on_unit;
        let high = (disc.center + reach - self.low) * self.on_unit;
        let cut = |place: f64| place.max(0.0).min(last) as u8;
        Reached {
            columns: (cut(low.x), cut(high.x)),
            rows: (cut(low.y), cut(high.y)),
        }
    }

    /// Says whether a sphere keeps the light from a point of the square: for certain, or because it holds for
    /// one that may.
    ///
    /// It does for certain where its center lies ahead and the ray passes nearer to that than the radius,
    /// with whatever all of it is off by.
    pub(super) fn any(
        &self,
        level: Level,
        point: &PointBelow,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        dispatch!(level, simd => self.any_lanes(simd, point, holds))
    }

    #[inline(always)]
    fn any_lanes<S: Simd>(
        &self,
        simd: S,
        point: &PointBelow,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        /// More than the rounding of a sum of squares and of a square.
        const WIDER: f32 = 1.0 + 16.0 * f32::EPSILON;
        let place = point.place - self.low;
        let part = place * self.on_unit;
        let last = self.parts - 1;
        let part = (part.y as u32).min(last) * self.parts + (part.x as u32).min(last);
        let (first, end) = (self.starts[part as usize], self.starts[part as usize + 1]);
        let zero = f32x8::splat(simd, 0.0);
        let around = point.around + self.rounding;
        let (x, y) = (place.x as f32, place.y as f32);
        let height = point.height - self.bottom;
        let lowest = -up(around - height);
        let narrower = if point.is_above_own {
            around + self.excess
        } else {
            f64::INFINITY
        };
        let (highest, narrower) = (up(height + narrower), up(narrower));
        let around = up(around);
        for group in &self.groups[first as usize..end as usize] {
            let x = f32x8::from_array(simd, group.x) - x;
            let y = f32x8::from_array(simd, group.y) - y;
            let radius = f32x8::from_array(simd, group.radius);
            let reach = (radius + around) * WIDER;
            let top = f32x8::from_array(simd, group.top);
            let distance_sq = x * x + y * y;
            let is_clear = distance_sq.simd_gt(reach * reach) | top.simd_lt(lowest);
            let mut left = !(is_clear.to_bitmask() as u8);
            if left == 0 {
                continue;
            }
            let inner = radius - narrower;
            let is_hidden = (distance_sq * WIDER).simd_lt(inner * inner)
                & inner.simd_gt(zero)
                & (top - radius).simd_gt(highest);
            if is_hidden.any_true() {
                return true;
            }
            while left != 0 {
                if holds(group.sphere[left.trailing_zeros() as usize] as usize) {
                    return true;
                }
                left &= left - 1;
            }
        }
        false
    }
}

/// The parts on a side of a square that suit its discs: few discs in each, few parts to a disc.
fn parts(square: &Square, discs: &[HighDisc]) -> u32 {
    /// Not tuned: a group of discs is looked at together.
    const DISCS_A_PART: usize = LANES;
    /// As much as bytes hold at least.
    const MOST: u32 = 16;
    /// Not tuned: where discs reach into more parts on the average, more time goes into the lists than
    /// into looking through them.
    const MOST_ACROSS: f64 = 1.5;
    let sum: f64 = discs.iter().map(|disc| disc.radius.min(square.side)).sum();
    let across = 2.0 * (sum / discs.len() as f64 + square.margin) / square.side;
    let mut parts = 1;
    while parts < MOST
        && discs.len() > DISCS_A_PART * (parts * parts) as usize
        && across * f64::from(2 * parts) + 1.0 <= MOST_ACROSS
    {
        parts *= 2;
    }
    parts
}
