//! Eight pixels of a row: the spheres that each of them may see, and those that fill it.

use fearless_simd::Simd;

use super::discriminant::{Discriminant, bend};
use super::patch::{Patch, Side};
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::exact::budget::MOST_SPHERES;
use crate::exact::context::{Context, Sides};
use crate::exact::crowd::{CrowdWork, FEWEST};
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::rounding::{GEOMETRY_SLACK, UNIT_ROUNDOFF};
use crate::numeric::vectors::Vectors;
use crate::picture::tile::Tile;

/// A sphere as eight pixels of a row see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coverage {
    pub(crate) sphere: usize,
    pub(crate) ball: Ball,
    /// Bit by bit, pixels in which the sphere may be seen.
    pub(crate) touched: u64,
    /// Pixels that the sphere fills, but for what is in front of it.
    pub(crate) covered: u64,
    /// Pixels that would see nothing of its outline, if it has one.
    pub(crate) within: u64,
    /// The distances at which it begins and, in pixels that it fills, ends; in multiples of the rays.
    pub(crate) nearest: [f64; 8],
    pub(crate) farthest: [f64; 8],
}

/// The same as [`Coverage`], in lanes.
#[derive(Clone, Copy, Debug)]
struct Extent<S: Simd> {
    touched: mask64x8<S>,
    covered: mask64x8<S>,
    nearest: f64x8<S>,
    farthest: f64x8<S>,
}

/// Finds out how up to eight pixels of a row see the `candidates`, whose balls are `balls`: those that
/// any of them may see are added to `coverages`, which must be empty.
#[inline(always)]
pub(crate) fn classify_row<S: Simd>(
    simd: S,
    context: &Context<'_>,
    row: Tile,
    (candidates, balls): (&[usize], &[Ball]),
    coverages: &mut Vec<Coverage>,
) {
    let (ray, sides) = context.rays(simd, Tile { width: 1, ..row });
    let all = (1_u64 << row.width) - 1;
    let mut end = f64x8::splat(simd, f64::INFINITY);
    for (&sphere, ball) in candidates.iter().zip(balls) {
        let extent = extent(simd, &ray, &sides, ball);
        // What begins behind what fills a pixel is not seen there.
        let is_open = !extent.nearest.simd_gt(end);
        let touched = extent.touched.to_bitmask() & all;
        if touched & is_open.to_bitmask() == 0 {
            continue;
        }
        end = extent.covered.select(end.min(extent.farthest), end);
        coverages.push(Coverage {
            sphere,
            ball: *ball,
            touched,
            covered: extent.covered.to_bitmask() & all,
            within: within_outline(simd, context, (&ray, &sides), sphere, ball),
            nearest: extent.nearest.into(),
            farthest: extent.farthest.into(),
        });
    }
    let end: [f64; 8] = end.into();
    for coverage in &mut *coverages {
        for (lane, &end) in end.iter().enumerate() {
            if coverage.nearest[lane] > end {
                coverage.touched &= !(1 << lane);
                coverage.covered &= !(1 << lane);
            }
        }
    }
    coverages.retain(|coverage| coverage.touched != 0);
}

/// The pixels, bit by bit, that lie inside of the outline of a sphere; all, where it has none.
#[inline(always)]
fn within_outline<S: Simd>(
    simd: S,
    context: &Context<'_>,
    (ray, sides): (&Vectors<S>, &Sides),
    sphere: usize,
    ball: &Ball,
) -> u64 {
    if !context.scene.has_outlines() {
        return !0;
    }
    match context.scene.inside_outline(sphere, ball) {
        None => !0,
        Some(inside) => extent(simd, ray, sides, &inside).covered.to_bitmask(),
    }
}

/// More than rounding makes wrong in a discriminant near its roots, as a move of the ray.
///
/// With u the roundoff, B = d · c and |d × c| are off by 4 u |d| |c|, and the squares that Q is the difference of
/// by 8 u of what they are. Where Q is about 0, B² = A K and |d × c|² = r² A, so that Q is off by no more than
/// 8 u A r (|c| + r) ≤ 20 u A r √K where K ≥ r², and 8 u A √K (|c| + √K) ≤ 20 u A r √K elsewhere. The slope of Q
/// along the retina is 2 r √K or more there: times half of the shorter side, it is a part of the spread.
const ROUNDINGS: f64 = 32.0 * UNIT_ROUNDOFF;

/// The part of a ball before their plane that eight pixels see through parallel rays: it begins at c_z − √Q⁺, and
/// ends at c_z − √Q⁻.
///
/// With u the roundoff the center is off by 8 u |c|, and the ray by 4 u of its place, which moves Q by twice the
/// radius times that where it is about 0; the slope there is 2 r, so that this is a move of the ray by as much.
#[inline(always)]
fn parallel_extent<S: Simd>(simd: S, ray: &Vectors<S>, sides: &Sides, ball: &Ball) -> Extent<S> {
    let (c, r) = (ball.center, ball.radius);
    let discriminant = Discriminant::new(ray, ray.x * 0.0 + 1.0, ball);
    let q = discriminant.value;
    let [by_u, by_v] = discriminant.half_slopes;
    let longer = sides.longer();
    let second = 0.25 * longer * longer * bend(ball);
    let aside = ray.x.abs() + ray.y.abs();
    let scale = if ball.is_apart() {
        aside * 0.0 + (c.length() + r)
    } else {
        let terms = aside * (aside + 2.0 * c.length()) + (c.z * c.z + ball.power.abs());
        terms * (0.5 / r)
    };
    let moved = (aside + scale) * ROUNDINGS;
    let slack = moved * (2.0 * r + longer) + moved * moved;
    let spread = (by_u.abs() + by_v.abs() * sides.height_by_width) * sides.width + second;
    let slack = slack + spread * GEOMETRY_SLACK + q.abs() * GEOMETRY_SLACK;
    let (lowest, highest) = (q - spread - slack, q + spread + slack);
    let zero = f64x8::splat(simd, 0.0);
    let far = GEOMETRY_SLACK * (c.length() + r);
    if ball.is_cut() {
        return cut_extent(simd, ball, [lowest, highest]);
    }
    let (low_root, high_root) = (lowest.max(zero).sqrt(), highest.max(zero).sqrt());
    Extent {
        touched: highest.simd_ge(0.0),
        covered: lowest.simd_gt(0.0),
        nearest: high_root * -1.0 + (c.z - far),
        farthest: low_root * -1.0 + (c.z + far),
    }
}

/// The same of a ball that the plane cuts, from bounds of Q: rays begin inside of it where Q > c_z², and see its
/// inner side at c_z + √Q.
#[inline(always)]
fn cut_extent<S: Simd>(simd: S, ball: &Ball, [lowest, highest]: [f64x8<S>; 2]) -> Extent<S> {
    let (z, zero) = (ball.center.z, f64x8::splat(simd, 0.0));
    let slack = GEOMETRY_SLACK * (ball.center.length() + ball.radius);
    // Behind the plane lies all of it that begins before its middle.
    let least = if z > 0.0 {
        0.0
    } else {
        (z + slack).min(0.0).powi(2)
    };
    let inside = (z.abs() + slack).powi(2);
    let covered = lowest.simd_gt(inside);
    Extent {
        touched: highest.simd_ge(least),
        covered,
        // What lies inside of it, before its wall, is dark by it.
        nearest: zero,
        farthest: highest.max(zero).sqrt() + (z + slack),
    }
}

/// The part of a ball that eight pixels with these sides see, with these rays through their middles, whose third
/// component is 1.
///
/// In a pixel Q and B differ from their values in the middle by less than their spread. From outside, what
/// is seen of a sphere begins at K / (B⁺ + √Q⁺) and ends at K / (B⁻ + √Q⁻).
#[inline(always)]
fn extent<S: Simd>(simd: S, ray: &Vectors<S>, sides: &Sides, ball: &Ball) -> Extent<S> {
    if ball.is_parallel() {
        return parallel_extent(simd, ray, sides, ball);
    }
    let Sides {
        width,
        height_by_width,
    } = *sides;
    let longer = sides.longer();
    let (u, v) = (ray.x, ray.y);
    let ray_sq = u * u + v * v + 1.0;
    let (c, k) = (ball.center, ball.outside);
    let discriminant = Discriminant::new(ray, ray_sq, ball);
    let along_spread = 0.5 * width * (c.x.abs() + c.y.abs() * height_by_width);

    // Bounds of Q, and so of its root.
    let Discriminant {
        along, value: q, ..
    } = discriminant;
    let [by_u, by_v] = discriminant.half_slopes;
    let second = 0.25 * longer * longer * bend(ball);
    // Half of the derivatives, which are twice these.
    let spread = (by_u.abs() + by_v.abs() * height_by_width) * width + second;
    let moved = ray_sq * (ROUNDINGS / sides.shorter()) + GEOMETRY_SLACK;
    let slack = spread * moved + q.abs() * GEOMETRY_SLACK;
    let (lowest, highest) = (q - spread - slack, q + spread + slack);
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let (low_root, high_root) = (lowest.max(zero).sqrt(), highest.max(zero).sqrt());

    if k > 0.0 {
        let in_front = along + along_spread;
        Extent {
            touched: highest.simd_ge(0.0) & in_front.simd_gt(0.0),
            covered: lowest.simd_gt(0.0) & along.simd_gt(along_spread),
            nearest: one * (k * (1.0 - GEOMETRY_SLACK)) / (in_front + high_root),
            farthest: one * (k * (1.0 + GEOMETRY_SLACK)) / (along - along_spread + low_root),
        }
    } else {
        // From the inside: t = (B + √Q) / A.
        let half = (u.abs() + v.abs() * height_by_width) * width + 0.5 * longer * longer;
        let everywhere = mask64x8::splat(simd, true);
        Extent {
            touched: everywhere,
            covered: everywhere,
            nearest: (along - along_spread + low_root).max(zero) / (ray_sq + half)
                * (1.0 - GEOMETRY_SLACK),
            farthest: (along + along_spread + high_root) / (ray_sq - half).max(one)
                * (1.0 + GEOMETRY_SLACK),
        }
    }
}

/// The first view of a pixel.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Sight {
    /// It sees no sphere.
    Nothing,
    /// It sees this sphere, and nothing else.
    Filled(usize),
    /// It may see edges.
    Edges,
}

/// Finds out what the pixel with the number `lane` in its row may see: the spheres are written to
/// `spheres`. Crowds are compared as far as the work on those of their tile allows.
#[inline]
pub(crate) fn sight(
    context: &Context<'_>,
    pixel: Tile,
    lane: usize,
    coverages: &[Coverage],
    (spheres, crowds): (&mut Vec<(usize, Ball)>, &mut CrowdWork),
) -> Sight {
    let is_here = |lanes: u64| lanes >> lane & 1 == 1;
    let mut touching = coverages.iter().filter(|one| is_here(one.touched));
    let Some(one) = touching.next() else {
        return Sight::Nothing;
    };
    if touching.next().is_none() && is_here(one.covered & one.within) {
        return Sight::Filled(one.sphere);
    }
    spheres.clear();
    visible_spheres(&context.cell(pixel), lane, coverages, (spheres, crowds));
    let covers = |sphere| {
        coverages
            .iter()
            .any(|one| one.sphere == sphere && is_here(one.covered & one.within))
    };
    match spheres[..] {
        [(sphere, _)] if covers(sphere) => Sight::Filled(sphere),
        _ => Sight::Edges,
    }
}

/// Pairs of spheres of a pixel that are compared at most: of what is not compared nothing is left out.
const MOST_PAIRS: usize = 200_000;

/// Stands in place of the number of a sphere that others hide.
const HIDDEN: usize = usize::MAX;

/// Adds the spheres that the pixel with this number may see to `spheres`, which must be empty: without
/// those that are hidden by one that fills it.
///
/// A ray meets sphere j wholly before or wholly behind a point of sphere i that lies outside of j.
/// Which of the two does not change where that holds all over the pixel; and the middle of j's
/// chord, at B / A, tells.
fn visible_spheres(
    cell: &Cell,
    lane: usize,
    coverages: &[Coverage],
    (spheres, crowds): (&mut Vec<(usize, Ball)>, &mut CrowdWork),
) {
    let here = |coverage: &&Coverage| coverage.touched >> lane & 1 == 1;
    let all = coverages.iter().filter(here);
    spheres.extend(all.map(|coverage| (coverage.sphere, coverage.ball)));
    let mut pairs = 0;
    let is_crowd = spheres.len() > FEWEST;
    let most_pairs = if is_crowd {
        crowds.spend(spheres.len() as u64);
        MOST_PAIRS.min(crowds.of_pixel() as usize)
    } else {
        MOST_PAIRS
    };
    let nearest = nearest_cover(lane, coverages, spheres.len());
    for (place, one) in coverages.iter().filter(here).enumerate() {
        let ball = &one.ball;
        if one.covered >> lane & 1 == 0 || ball.outside <= 0.0 || spheres[place].0 == HIDDEN {
            continue;
        }
        if nearest.is_some_and(|nearest| one.sphere != nearest) {
            continue;
        }
        pairs += spheres.len();
        if pairs > most_pairs {
            break;
        }
        let (contour, along) = (silhouette(cell, ball), cell.along(ball.center));
        let patch = Patch::new(cell, ball, &contour, &along);
        for (other_place, other) in coverages.iter().filter(here).enumerate() {
            if other_place == place || spheres[other_place].0 == HIDDEN {
                continue;
            }
            let is_outside = other.ball.outside > 0.0;
            match patch.side_of(ball, &other.ball) {
                Some(Side::Outside) => {
                    if is_outside && nearest_middle(cell, &other.ball) > one.farthest[lane] {
                        spheres[other_place].0 = HIDDEN;
                    }
                }
                Some(Side::Inside) if other.covered >> lane & 1 == 1 && is_outside => {
                    spheres[place].0 = HIDDEN;
                    break;
                }
                Some(Side::Inside) | None => {}
            }
        }
    }
    if is_crowd {
        crowds.spend(pairs as u64);
    }
    spheres.retain(|&(sphere, _)| sphere != HIDDEN);
}

/// The sphere that fills the pixel with this number and begins nearest, where it may see so many that they are held
/// against this one alone.
fn nearest_cover(lane: usize, coverages: &[Coverage], count: usize) -> Option<usize> {
    if count <= MOST_SPHERES {
        return None;
    }
    let is_cover = |one: &&Coverage| one.covered >> lane & 1 == 1 && one.ball.outside > 0.0;
    let covers = coverages.iter().filter(is_cover);
    let nearest = covers.min_by(|one, other| one.nearest[lane].total_cmp(&other.nearest[lane]));
    nearest.map(|one| one.sphere)
}

/// The least distance of the middle of a sphere's chord along rays of a cell, in multiples of these.
fn nearest_middle(cell: &Cell, ball: &Ball) -> f64 {
    if cell.is_parallel() {
        return ball.center.z;
    }
    let along = cell.dot(ball.center);
    let ray_sq = cell.ray_sq();
    (along.one - 0.5 * (along.x.abs() + along.y.abs())) / (ray_sq.one + ray_sq.spread())
}
