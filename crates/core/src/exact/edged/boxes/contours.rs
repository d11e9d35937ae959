//! The shares of boxes in which spheres are seen.

use fearless_simd::Simd;

use super::depth::{Depth, Function};
use super::eight_boxes::{Eight, EightBoxes};
use super::half_plane::{HalfPlane, StoredHalfPlane};
use super::orders::{Order, Orders};
use super::region::{Region, Share};
use super::wedge::part_beside;
use crate::exact::classify::active::Active;
use crate::numeric::lanes::{f64x8, mask64x8};

/// A sphere as eight boxes see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contour {
    /// Its position among the active spheres.
    pub(super) position: usize,
    /// Whether it fills all boxes.
    fills: bool,
    /// The part inside of its silhouette.
    inside: StoredHalfPlane,
    /// The steps along both axes, in sides, from the middle of the visible part to a point where the root of
    /// the discriminant is the average.
    inward: [Eight; 2],
    /// The position of its depth among those that are known, if it intersects another sphere.
    depth: usize,
}

/// The spheres that eight boxes see.
#[derive(Clone, Debug, Default)]
pub(super) struct Contours {
    pub(super) spheres: Vec<Contour>,
    /// The depths of those that intersect others.
    depths: Vec<Depth>,
}

/// The visible part of a sphere in eight boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visible<S: Simd> {
    pub(super) position: usize,
    pub(super) region: Region<S>,
    pub(super) share: Share<S>,
    pub(super) middle: [f64x8<S>; 2],
    /// The error of its share because its edges are no lines.
    pub(super) doubt: f64x8<S>,
    /// From the middle of what is seen to the point whose light is about the average, in sides.
    pub(super) inward: [f64x8<S>; 2],
    /// The boxes that the silhouette cuts, and those in which some of the sphere may be seen.
    pub(super) is_cut: mask64x8<S>,
    pub(super) is_possible: mask64x8<S>,
}

impl<S: Simd> Visible<S> {
    /// The shares of boxes in which the sphere is seen, and how much they may be off.
    #[inline(always)]
    pub(super) fn share_and_error(&self) -> [Eight; 2] {
        let error = (self.doubt + self.share.ambiguity).min(self.region.most);
        [self.share.area.into(), error.into()]
    }
}

/// The factor on the doubt of an edge behind which another ends, and of a seam that ends: two things lie behind it, each
/// on a part of its way. A parabola and its line leave areas on half of the way that differ by 0.13 heights, of which the
/// doubt is 0.08; what is more is caution.
const OF_ENDS: f64 = 2.4;

/// The share of a depth from an edge at which a root of it is its average: (2/3)², over a half.
const OF_ROOT: f64 = 8.0 / 9.0;

impl Contours {
    pub(super) fn clear(&mut self) {
        self.spheres.clear();
        self.depths.clear();
    }

    /// Adds a sphere that fills all boxes.
    #[inline(always)]
    pub(super) fn add_filling<S: Simd>(
        &mut self,
        simd: S,
        boxes: &EightBoxes<S>,
        (position, active): (usize, &Active),
        has_depth: bool,
    ) {
        let depth = self.depths.len();
        if has_depth {
            let function = Function::new(simd, boxes, &active.discriminant);
            self.depths.push(Depth::new(simd, boxes, active, &function));
        }
        self.spheres.push(Contour {
            position,
            fills: true,
            inside: StoredHalfPlane::new(&HalfPlane::whole(simd)),
            inward: [[0.0; 8]; 2],
            depth,
        });
    }

    /// Adds a sphere if any of the boxes see it, and takes it from what is outside of all of them.
    #[inline(always)]
    pub(super) fn add<S: Simd>(
        &mut self,
        simd: S,
        boxes: &EightBoxes<S>,
        (position, active): (usize, &Active),
        has_depth: bool,
        outside: &mut Region<S>,
    ) {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let function = Function::new(simd, boxes, &active.discriminant);
        let Function {
            value,
            across,
            bends,
        } = function;
        // Most boxes of a crowd are far from most silhouettes.
        let most = (across[0].abs() + across[1].abs()) * 0.5 + bends.most();
        if (value + most).simd_gt(zero).to_bitmask() == 0 {
            return;
        }
        if (value - most).simd_lt(zero).to_bitmask() == 0 {
            outside.darken(simd, one.simd_gt(zero));
            self.add_filling(simd, boxes, (position, active), has_depth);
            return;
        }
        let part = HalfPlane::of_second_degree(simd, value, across, &bends, None);
        if part.share.simd_gt(zero).to_bitmask() == 0 && part.doubt.simd_gt(zero).to_bitmask() == 0
        {
            return;
        }
        outside.cut(simd, &part.other_side(simd));
        let is_cut = part.share.simd_lt(one) & part.share.simd_gt(zero);
        let by_share = one / part.share.max(f64x8::splat(simd, f64::MIN_POSITIVE));
        let middle = [part.moments[0] * by_share, part.moments[1] * by_share];
        let [to_x, to_y] = function.toward_mean(middle, OF_ROOT);
        let inward = [is_cut.select(to_x, zero), is_cut.select(to_y, zero)];
        let depth = self.depths.len();
        if has_depth {
            self.depths.push(Depth::new(simd, boxes, active, &function));
        }
        self.spheres.push(Contour {
            position,
            fills: false,
            inside: StoredHalfPlane::new(&part),
            inward: [inward[0].into(), inward[1].into()],
            depth,
        });
    }
}

impl Contour {
    /// The part of it that others do not hide; `None` where they hide it in all boxes.
    #[inline(always)]
    pub(super) fn visible<S: Simd>(
        &self,
        simd: S,
        all: &Contours,
        orders: &Orders,
    ) -> Option<Visible<S>> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let inside = self.inside.load(simd);
        let mut region = Region::whole(simd);
        let mut in_doubt = zero;
        let mut open = one;
        let mut by_ends = one;
        for other in &all.spheres {
            if other.position == self.position {
                continue;
            }
            match orders.of(self.position, other.position) {
                Order::Front => {
                    if !other.fills && !self.fills {
                        by_ends = other.may_cut(simd).select(one * OF_ENDS, by_ends);
                    }
                }
                Order::Behind if other.fills => return None,
                Order::Behind => {
                    let outside = other.outside(simd);
                    if !self.fills {
                        open = open.min(open_edge(simd, &inside, &outside));
                    }
                    region.cut(simd, &outside);
                    if region.most.simd_gt(zero).to_bitmask() == 0 {
                        return None;
                    }
                }
                Order::ByDepth => {
                    let theirs = other.inside.load(simd);
                    let depth = &all.depths[self.depth];
                    let both = inside.share.min(theirs.share) + inside.doubt + theirs.doubt;
                    let before = depth.behind(simd, &all.depths[other.depth], both.simd_gt(zero));
                    // They have at most the smaller share in common: slivers along their silhouettes may be nested. The
                    // seam ends there, and most of its way may lie in it.
                    let common = inside.share.min(theirs.share);
                    let ends = common.simd_lt(one).select(one * OF_ENDS, one);
                    in_doubt += before.doubt * (common * 2.0).min(one) * ends;
                    region.cut_by_both(simd, &theirs, &before);
                }
            }
        }
        // Both spheres of a seam are in doubt there: each counts half.
        let doubt = (inside.doubt * open * by_ends + in_doubt * 0.5).min(region.most);
        if !self.fills {
            region.cut(simd, &inside);
        }
        let share = region.share(simd);
        let middle = share.middle(simd);
        let mut inward = [zero; 2];
        if !self.fills {
            // Where others hide what lies deep inside, what is left lies nearer to the silhouette.
            let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
            let [x, y] = inside.across;
            let all = (inside.value * inside.share + x * inside.moments[0] + y * inside.moments[1])
                / inside.share.max(tiny);
            let left = inside.value + x * middle[0] + y * middle[1];
            let nearer = (left / all.max(tiny)).max(zero).min(one);
            inward = self
                .inward
                .map(|eight| f64x8::from_array(simd, eight) * nearer);
        }
        let is_possible = region.most.simd_gt(zero);
        (is_possible.to_bitmask() != 0).then_some(Visible {
            position: self.position,
            region,
            share,
            middle,
            doubt,
            inward,
            is_cut: inside.share.simd_lt(one),
            is_possible,
        })
    }

    /// The boxes that its silhouette may cut.
    #[inline(always)]
    fn may_cut<S: Simd>(&self, simd: S) -> mask64x8<S> {
        f64x8::from_array(simd, self.inside.doubt).simd_gt(0.0)
    }

    /// The boxes outside of the sphere.
    #[inline(always)]
    fn outside<S: Simd>(&self, simd: S) -> HalfPlane<S> {
        self.inside.load(simd).other_side(simd)
    }
}

/// The share of an edge's doubt that counts where another contour hides it: all of it, but where the edge is
/// nearly hidden.
///
/// The line leaves the area that the curve does, on the whole way through a box. On a part of the way they may be apart
/// more than that: at an end of the way by two thirds of the curve's height, which are eight times what the line is taken to
/// be off. So the curve may also run where the line only comes near. Both constants have some caution.
#[inline(always)]
fn open_edge<S: Simd>(simd: S, inside: &HalfPlane<S>, outside: &HalfPlane<S>) -> f64x8<S> {
    const OF_END: f64 = 16.0;
    const APART: f64 = 12.0;
    let one = f64x8::splat(simd, 1.0);
    let zero = f64x8::splat(simd, 0.0);
    let is_open = outside.share.simd_gt(zero);
    let is_cut = is_open & outside.share.simd_lt(one) & inside.doubt.simd_gt(zero);
    let open = is_open.select(one, zero);
    if is_cut.to_bitmask() == 0 {
        return open;
    }
    let part = part_beside(simd, inside, &outside.grown(inside.bend(simd) * APART));
    is_cut.select((part * OF_END).min(one), open)
}
