//! The ladder: all ways to average a pixel to a tolerance, from the cheapest.
//!
//! Eight pixels of a row climb the first rungs together, and a pixel with edges climbs alone ([`climb`]). A rung answers, or
//! it gives up and says why ([`GiveUp`]); then the next one begins. ARCHITECTURE.md has the same table, which a test holds
//! against this one.
//!
//! | pixels, or method | files, in `exact` or `core` | answer | passed on to the next method |
//! |---|---|---|---|
//! | the whole picture, if the tolerance is at least half of the contrast, or a fifth in crowds | `render/approach.rs` | 1, 4, 9 or 36 samples: a bound from the whole contrast on, below it an estimate | below the whole contrast: open shutters, spheres that fit between samples; below half: crowds that the raster knows |
//! | crowds, if the tolerance is at least a hundredth of the contrast | `integrator/crowd_samples.rs`, `raster` | a regular grid of samples: an estimate | all that the raster does not know, such as highlights, bumps, outlines, point lights, parallel lenses and large spheres; claims above the tolerance |
//! | no sphere | `classify/row.rs` | the background: a bound | pixels in which a sphere may be visible |
//! | one sphere, unlit | `interior/fill.rs` | ambient light: a bound | pixels that a light reaches |
//! | one sphere; each light reaches the whole pixel or none of it | `interior/average.rs`, `estimate.rs`, `remainder.rs` | 1, 5, 9 or 17 samples: a bound or an estimate | edges; light with too much curvature |
//! | one sphere without bumps, one light | `interior/plain.rs`, `edged/mean_normals.rs` | the mean normal times the direction of the light; a linear ramp at a terminator: bounds, or estimates in `mean_normals.rs` | other edges |
//! | bumps | `interior/parts.rs`, `strata.rs` | subdivision, the worst part first; random samples if the bumps are fine | claims above the tolerance |
//! | boxes with straight edges | `edged/boxes` | areas of half-planes in closed form, in 8 boxes or more: an estimate | small tolerances; fine bumps; claims above the tolerance |
//! | along edges | `edged/boundary` | Green's theorem: an estimate | narrow highlights; claims above the tolerance |
//! | subdivision | `edged/parts.rs` | quarters of the pixel, or halves across a horizon, the worst first | pixels that cost too much |
//! | random samples | `integrator/scattered.rs`, `sampling/scattered.rs` | two random samples in each stratum of the pixel, up to 512 × 512 strata, fewer under many lights: an estimate that holds with high probability | pixels that would still be over the tolerance |
//! | samples | `integrator.rs` | 8 × 8 samples, or one or none in crowds; the claim is at most the contrast that the pixel may show (half of it without samples): a bound | nothing |
//!
//! Pixels under point lights begin with the rung along edges: those above know directional lights alone.
//!
//! [`budget`](super::budget) limits what a pixel may cost. A pixel that ends over its tolerance says so.

use fearless_simd::Simd;

use super::budget::MOST_SPHERES;
use super::classify::occluder_cache::OccluderCache;
use super::context::Context;
use super::edged::cell::{EdgedPixel, Workspace};
use super::part::{GiveUp, Part};
use crate::edges::cell::Ball;
use crate::picture::pixel::Pixel;
use crate::picture::tile::Tile;

/// A rung for pixels that climb alone.
struct Rung<S> {
    /// Whether it knows everything that the pixel sees.
    knows: fn(&Workspace, &EdgedPixel<'_, '_>) -> bool,
    average: Average<S>,
}

/// The average over a pixel, or the reason for which the next rung begins. The last argument is the reason for which this one
/// does.
type Average<S> =
    fn(&mut Workspace, S, &EdgedPixel<'_, '_>, &mut OccluderCache, GiveUp) -> Result<Part, GiveUp>;

/// The rungs for pixels that climb alone, from the cheapest.
fn rungs<S: Simd>() -> [Rung<S>; 4] {
    let rung = |knows, average| Rung { knows, average };
    [
        rung(Workspace::knows_boxes, Workspace::by_boxes),
        rung(Workspace::knows_mean_normals, Workspace::by_mean_normals),
        rung(|_, _| true, Workspace::along_edges),
        rung(|_, _| true, Workspace::by_parts),
    ]
}

/// A pixel with edges, or with light that is too hard for the rungs of rows.
pub(super) fn climb<S: Simd>(
    simd: S,
    context: &Context<'_>,
    pixel: Tile,
    spheres: &[(usize, Ball)],
    cache: &mut OccluderCache,
    workspace: &mut Workspace,
) -> Result<Pixel, GiveUp> {
    let pixel = EdgedPixel {
        context,
        cell: context.cell(pixel),
        key: context.key(pixel, 0),
        spheres,
    };
    // Of a crowd all are asked before anything is known.
    let least = if workspace.is_crowd {
        spheres.len() as u64
    } else {
        1
    };
    let is_exhausted = workspace.left_by_tile < least && spheres.len() > 1 || cache.is_exhausted();
    if spheres.len() > MOST_SPHERES || is_exhausted {
        workspace.leave_crowd(&pixel);
        return Err(GiveUp::Unknown);
    }
    workspace.begin(simd, &pixel, cache);
    let mut rungs = &rungs()[..];
    if workspace.budget.is_nothing() {
        // Parts end before they cost anything.
        rungs = &rungs[rungs.len() - 1..];
    }
    let mut why = GiveUp::Unknown;
    for Rung { knows, average } in rungs {
        if knows(workspace, &pixel) {
            match average(workspace, simd, &pixel, cache, why) {
                Ok(part) => return Ok(context.pixel_of(&part)),
                Err(reason) => why = reason,
            }
        }
    }
    Err(why)
}
