//! The shares of boxes in which spheres are seen.

use fearless_simd::Simd;

use super::depth::{Depth, Function};
use super::eight_boxes::{Eight, EightBoxes};
use super::half_plane::{HalfPlane, StoredHalfPlane};
use super::orders::{Order, Orders};
use super::outlines::Line;
use super::region::{Region, Share};
use super::wedge::part_beside;
use crate::exact::classify::active::Active;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::polynomial::Quadratic;

/// A sphere as eight boxes see it, or its face, which is what its outline leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contour {
    /// Its position among the active spheres.
    pub(super) position: usize,
    /// The outline of the sphere, or that this is the face.
    pub(super) line: Line,
    /// Whether it fills all boxes.
    fills: bool,
    /// The part inside of its silhouette, or of the edge of the outline.
    inside: StoredHalfPlane,
    /// The steps along both axes, in sides, from the middle of the visible part to a point where the root of
    /// the discriminant is the average.
    inward: [Eight; 2],
    /// The position of its depth among those that are known, if it intersects another sphere.
    depth: usize,
}

/// The spheres that eight boxes see, each with an outline followed by its face.
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

    /// Adds a sphere if any of the boxes see it, and takes it from what is outside of all of them; or the face of the
    /// one that was added last, inside of this contour.
    #[inline(always)]
    pub(super) fn add<S: Simd>(
        &mut self,
        simd: S,
        boxes: &EightBoxes<S>,
        (position, active, face): (usize, &Active, Option<&Quadratic>),
        (has_silhouette, has_depth): (bool, bool),
        outside: &mut Region<S>,
    ) {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let has_edge = has_silhouette || face.is_some();
        let function = Function::new(simd, boxes, face.unwrap_or(&active.discriminant));
        let Function {
            value,
            across,
            bends,
        } = function;
        // Most boxes of a crowd are far from most silhouettes.
        let most = (across[0].abs() + across[1].abs()) * 0.5 + bends.most();
        if has_edge && (value + most).simd_gt(zero).to_bitmask() == 0 {
            if face.is_some() {
                self.set_line(Line::All);
            }
            return;
        }
        let fills = !has_edge || (value - most).simd_lt(zero).to_bitmask() == 0;
        if fills && face.is_some() {
            return;
        }
        let mut part = HalfPlane::whole(simd);
        let mut inward = [zero; 2];
        if !fills {
            part = HalfPlane::of_second_degree(simd, value, across, &bends, None);
            let is_cut = part.share.simd_lt(one) & part.share.simd_gt(zero);
            let by_share = one / part.share.max(f64x8::splat(simd, f64::MIN_POSITIVE));
            let middle = [part.moments[0] * by_share, part.moments[1] * by_share];
            let toward = function.toward_mean(middle, OF_ROOT);
            inward = toward.map(|step| is_cut.select(step, zero));
        }
        let mut depth = self.depths.len();
        let mut line = Line::None;
        if face.is_some() {
            (depth, line) = (self.divide(&part), Line::Face);
        } else {
            if fills {
                outside.darken(simd, one.simd_gt(zero));
            } else {
                let may_be = part.share.simd_gt(zero) | part.doubt.simd_gt(zero);
                if may_be.to_bitmask() == 0 {
                    return;
                }
                outside.cut(simd, &part.other_side(simd));
            }
            if has_depth {
                self.depths.push(Depth::new(simd, boxes, active, &function));
            }
        }
        self.spheres.push(Contour {
            position,
            line,
            fills,
            inside: StoredHalfPlane::new(&part),
            inward: [inward[0].into(), inward[1].into()],
            depth,
        });
    }

    /// Notes what outline the sphere has that was added last.
    #[inline(always)]
    pub(super) fn set_line(&mut self, line: Line) {
        if let Some(sphere) = self.spheres.last_mut() {
            sphere.line = line;
        }
    }

    /// Notes that the sphere that was added last has this face beside its outline; returns the position of its depth.
    #[inline(always)]
    fn divide<S: Simd>(&mut self, face: &HalfPlane<S>) -> usize {
        let fills = face.share.simd_ge(1.0) & face.doubt.simd_le(0.0);
        self.set_line(Line::Beside(!(fills.to_bitmask() as u8)));
        self.spheres.last().map_or(0, |sphere| sphere.depth)
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
            let order = orders.of(self.position, other.position);
            if order == Order::Front {
                if !other.fills && !self.fills {
                    by_ends = other.may_cut(simd).select(one * OF_ENDS, by_ends);
                }
                continue;
            }
            // What hides is the whole sphere.
            if other.line.is_face() {
                continue;
            }
            let is_behind = order == Order::Behind;
            if is_behind && other.fills {
                return None;
            }
            let theirs = other.inside.load(simd);
            let mut left = theirs.other_side(simd);
            let mut before = None;
            if is_behind {
                if !self.fills {
                    open = open.min(open_edge(simd, &inside, &left));
                }
            } else {
                let depth = &all.depths[self.depth];
                let both = inside.share.min(theirs.share) + inside.doubt + theirs.doubt;
                let seam = depth.behind(simd, &all.depths[other.depth], both.simd_gt(zero));
                // They have at most the smaller share in common: slivers along their silhouettes may be nested. The
                // seam ends there, and most of its way may lie in it.
                let common = inside.share.min(theirs.share);
                let mut ends = common.simd_lt(one).select(one * OF_ENDS, one);
                if self.line.divides() || other.line.divides() {
                    ends = one * OF_ENDS;
                }
                in_doubt += seam.doubt * (common * 2.0).min(one) * ends;
                left = theirs.left_by_both(simd, &seam);
                before = Some(seam);
            }
            region.cut(simd, &left);
            match &before {
                Some(before) => region.leave_of_both(simd, &theirs, before),
                None if region.most.simd_gt(zero).to_bitmask() == 0 => return None,
                None => {}
            }
        }
        if self.line.is_face() {
            // The whole sphere counts it.
            in_doubt = zero;
        }
        // Both spheres of a seam are in doubt there: each counts half.
        let doubt = (inside.doubt * open * by_ends + in_doubt * 0.5).min(region.most);
        if !self.fills {
            region.cut(simd, &inside);
        }
        let share = region.share(simd);
        let middle = share.middle(simd);
        let mut inward = [zero; 2];
        if !self.fills && !self.line.is_face() {
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
            // The silhouette is at least as far from a face as the outline is wide.
            is_cut: if self.line.is_face() {
                zero.simd_lt(zero)
            } else {
                inside.share.simd_lt(one)
            },
            is_possible,
        })
    }

    /// The boxes that its line may cut.
    #[inline(always)]
    fn may_cut<S: Simd>(&self, simd: S) -> mask64x8<S> {
        f64x8::from_array(simd, self.inside.doubt).simd_gt(0.0)
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
