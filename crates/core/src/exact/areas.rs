//! The areas of pictures in which spheres are seen.

mod in_vain;

use fearless_simd::{Level, Simd, dispatch};

use self::in_vain::InVain;
use super::budget::{Allowance, CellWork, MOST};
use super::classify::contents::Contents;
use super::classify::magnitude::{is_ball_moderate, is_view_moderate};
use super::classify::occluder_cache::OccluderCache;
use super::classify::row::{Coverage, Sight, classify_row, sight};
use super::context::Context;
use super::crowd::{CrowdWork, UnitsOfTile};
use super::edged::boxes::Boxes;
use super::edged::boxes::areas::Shares;
use super::scene::InCamera;
use crate::edges::cell::{Ball, Cell};
use crate::model::color::Color;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::image::Channels;
use crate::picture::tile::Tile;
use crate::search::view_index::ViewIndex;
use crate::search::visibility::Visibility;

/// The area in which a sphere is seen, in pixels.
///
/// # Example
/// ```
/// use std::f64::consts::PI;
/// use std::ops::ControlFlow;
///
/// use marbles_core::glam::{DVec2, DVec3};
/// use marbles_core::{Camera, Lens, Material, Renderer, Sphere, View, World};
///
/// let mut world = World::new();
/// let white = world.add_material(Material::default());
/// world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 2.0)?, white);
/// // Parallel rays, 4 pixels in each unit of length: the ball is a disc with a radius of 8 pixels.
/// let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 32, 32);
/// let go_on = |_| ControlFlow::Continue(());
/// let seen = Renderer::new(&world).visible_areas(&view, 1e-6, &go_on)?[0];
/// assert!(seen.error < 1e-3);
/// assert!((seen.area - 64.0 * PI).abs() <= seen.error);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct VisibleArea {
    /// The area.
    pub area: f64,
    /// An estimate of its error.
    pub error: f64,
}

/// Measures visible areas, tile by tile.
#[derive(Clone, Debug)]
pub(crate) struct Areas<'scene> {
    index: ViewIndex<'scene>,
    is_moderate: bool,
    context: Context<'scene>,
    level: Level,
}

/// Memory for a thread.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    balls: Vec<Ball>,
    coverages: Vec<Coverage>,
    spheres: Vec<(usize, Ball)>,
    contents: Contents,
    boxes: Boxes,
    shares: Shares,
}

/// The depth to which pixels are quartered where boxes do not meet the tolerance: what is left of an edge is less than
/// 1e-3 of a pixel.
const DEEPEST: u32 = 10;

/// Between which x and y the quarters of a cell lie.
const QUARTERS: [[[f64; 2]; 2]; 4] = [
    [[-0.5, 0.0], [-0.5, 0.0]],
    [[0.0, 0.5], [-0.5, 0.0]],
    [[-0.5, 0.0], [0.0, 0.5]],
    [[0.0, 0.5], [0.0, 0.5]],
];

impl<'scene> Areas<'scene> {
    /// Prepares a view, whose pixels may each be off by `tolerance`, all spheres together.
    pub(crate) fn new(
        world: &'scene World,
        visibility: &Visibility<'scene>,
        view: &View,
        index: ViewIndex<'scene>,
        tolerance: f64,
    ) -> Self {
        // Without lights.
        let scene = InCamera::without_lights(world, visibility, view, Channels::Grey);
        Self {
            index,
            is_moderate: is_view_moderate(view),
            context: Context {
                normals: None,
                scene,
                view: *view,
                tolerance,
                is_proved: false,
                has_alpha: false,
                of_coverage: 1.0,
                background: Color::ZERO,
                contrast: 1.0,
                allowance: Allowance::still(1),
                of_crowds: UnitsOfTile::ALL,
            },
            level: Level::new(),
        }
    }

    /// Adds what a tile sees of each sphere to a list, sphere by sphere in the order of their numbers.
    pub(crate) fn add_tile(
        &self,
        tile: Tile,
        scratch: &mut Scratch,
        areas: &mut Vec<(usize, VisibleArea)>,
    ) {
        let candidates = self.index.indices(tile);
        let mut sorted = candidates.clone();
        sorted.sort_unstable();
        let Some(&first) = sorted.first() else {
            return;
        };
        let mut sums = vec![(first, VisibleArea::default()); sorted.len()];
        for (sum, &candidate) in sums.iter_mut().zip(&sorted) {
            sum.0 = candidate;
        }
        let mut sums = Sums(sums);
        if !self.measure_all(tile, &candidates, scratch, &mut sums) {
            // Nothing is known.
            for (_, sum) in &mut sums.0 {
                sum.error = tile.count() as f64;
            }
        }
        let Sums(sums) = sums;
        areas.extend(
            sums.into_iter()
                .filter(|(_, sum)| sum.area > 0.0 || sum.error > 0.0),
        );
    }

    /// Finds the sphere that each pixel of a tile sees most of, and calls `put` with the pixel's place in the tile, where
    /// any is seen.
    pub(crate) fn see_most(
        &self,
        tile: Tile,
        scratch: &mut Scratch,
        mut put: impl FnMut(usize, usize, VisibleArea),
    ) {
        let candidates = self.index.indices(tile);
        if candidates.is_empty() {
            return;
        }
        let mut parts = Parts::default();
        if self.measure_all(tile, &candidates, scratch, &mut parts) {
            parts.most(put);
        } else {
            for place in 0..tile.count() as usize {
                let unknown = VisibleArea {
                    area: 0.0,
                    error: 1.0,
                };
                put(place, candidates[0], unknown);
            }
        }
    }

    /// Measures the pixels of a tile that may see these spheres; `false` where numbers are too extreme.
    fn measure_all(
        &self,
        tile: Tile,
        candidates: &[usize],
        scratch: &mut Scratch,
        found: &mut dyn Found,
    ) -> bool {
        let balls = candidates
            .iter()
            .map(|&sphere| self.context.scene.ball(sphere));
        scratch.balls.clear();
        scratch.balls.extend(balls);
        if !self.is_moderate || !scratch.balls.iter().all(is_ball_moderate) {
            return false;
        }
        dispatch!(self.level, simd => self.measure(simd, tile, candidates, scratch, found));
        true
    }

    /// Measures the pixels of a tile.
    #[inline(always)]
    fn measure<S: Simd>(
        &self,
        simd: S,
        tile: Tile,
        candidates: &[usize],
        scratch: &mut Scratch,
        found: &mut dyn Found,
    ) {
        let context = &self.context;
        let pixel = |col: u32, row: u32| Tile {
            col: tile.col + col,
            row: tile.row + row,
            width: 1,
            height: 1,
        };
        let [width, height] = context.cell(pixel(0, 0)).size;
        let mut cache = OccluderCache::new(context.cell(tile), width.min(height));
        let mut crowds = CrowdWork::new(u64::MAX);
        for row in 0..tile.height {
            for left in (0..tile.width).step_by(8) {
                let start = Tile {
                    width: (tile.width - left).min(8),
                    ..pixel(left, row)
                };
                scratch.coverages.clear();
                simd.vectorize(
                    #[inline(always)]
                    || {
                        let known = (candidates, &scratch.balls[..]);
                        classify_row(simd, context, start, known, &mut scratch.coverages);
                    },
                );
                for lane in 0..start.width {
                    let pixel = pixel(left + lane, row);
                    let place = (row * tile.width + left + lane) as usize;
                    let coverages = &scratch.coverages;
                    let spheres = &mut scratch.spheres;
                    match sight(
                        context,
                        pixel,
                        lane as usize,
                        coverages,
                        (spheres, &mut crowds),
                    ) {
                        Sight::Nothing => {}
                        Sight::Filled(sphere) => found.add(place, sphere, [1.0, 0.0]),
                        Sight::Edges => {
                            let cell = context.cell(pixel);
                            let memory = (&mut *scratch, &mut cache);
                            self.divide(simd, cell, memory, place, found);
                        }
                    }
                }
            }
        }
    }

    /// Measures a pixel by boxes, or by its quarters and theirs: all of one size before smaller ones, as far as the work
    /// that a pixel may cost goes.
    fn divide<S: Simd>(
        &self,
        simd: S,
        cell: Cell,
        (scratch, cache): (&mut Scratch, &mut OccluderCache),
        place: usize,
        found: &mut dyn Found,
    ) {
        let mut spent = 0;
        let mut cells = vec![cell];
        let mut in_vain = InVain::default();
        for depth in 0..=DEEPEST {
            let share = 0.25_f64.powi(depth as i32);
            let units = |tests: u64| CellWork { samples: 0, tests }.units();
            let of_all = scratch.spheres.len() as u64;
            let mut quarters = Vec::new();
            let mut planned = 0;
            for cell in cells {
                let is_known = self.measure_part(simd, &cell, (scratch, cache), |sphere, part| {
                    found.add(place, sphere, part.map(|part| part * share));
                });
                let of_pairs = scratch.contents.tests;
                let of_boxes = std::mem::take(&mut scratch.shares.tests);
                spent += units(of_all + of_pairs + of_boxes);
                if is_known {
                    continue;
                }
                in_vain.add(of_boxes, share);
                // What the quarters cost, as an estimate: pairs are mostly in one of them.
                planned += QUARTERS.len() as u64 * units(of_all + of_boxes) + of_pairs;
                if depth < DEEPEST && spent + planned <= MOST && !in_vain.is_hopeless() {
                    quarters.extend(QUARTERS.map(|[x, y]| cell.part(x, y)));
                    continue;
                }
                for sphere in scratch.contents.spheres() {
                    found.add(place, sphere, [0.5 * share; 2]);
                }
            }
            in_vain.end_size();
            cells = quarters;
        }
    }

    /// Finds what a part of a pixel sees, and calls `put` with each sphere, the share that it has of the part, and its
    /// error. Returns false without calling it where that is not known.
    fn measure_part<S: Simd>(
        &self,
        simd: S,
        cell: &Cell,
        (scratch, cache): (&mut Scratch, &mut OccluderCache),
        mut put: impl FnMut(usize, [f64; 2]),
    ) -> bool {
        let scene = &self.context.scene;
        let Scratch {
            spheres,
            contents,
            boxes,
            shares,
            ..
        } = scratch;
        contents.see(scene, cell, spheres, cache);
        if contents.is_mixed || contents.is_crowded {
            return false;
        }
        match &contents.active[..] {
            [] => return true,
            [one] if contents.conics.is_empty() => {
                put(one.sphere, [1.0, 0.0]);
                return true;
            }
            _ => {}
        }
        let tolerance = self.context.tolerance;
        let is_known = boxes.shares(simd, scene, cell, contents, (tolerance, shares));
        if is_known {
            for (active, [area, error]) in contents.active.iter().zip(&shares.of_spheres) {
                put(active.sphere, [*area, error + contents.rounding]);
            }
        }
        is_known
    }
}

/// A receiver of what pixels see of spheres.
trait Found {
    /// Takes a part of the pixel at a place of the tile: the area, and its error.
    fn add(&mut self, place: usize, sphere: usize, part: [f64; 2]);
}

/// The visible areas of the candidates of a tile, in the order of their numbers.
#[derive(Debug)]
struct Sums(Vec<(usize, VisibleArea)>);

impl Found for Sums {
    fn add(&mut self, _: usize, sphere: usize, [area, error]: [f64; 2]) {
        if let Ok(place) = self.0.binary_search_by_key(&sphere, |(sphere, _)| *sphere) {
            let sum = &mut self.0[place].1;
            sum.area += area;
            sum.error += error;
        }
    }
}

/// The visible parts in the pixels of a tile: the place of the pixel, the sphere, the area and its error.
#[derive(Debug, Default)]
struct Parts(Vec<(usize, usize, [f64; 2])>);

impl Found for Parts {
    fn add(&mut self, place: usize, sphere: usize, part: [f64; 2]) {
        self.0.push((place, sphere, part));
    }
}

impl Parts {
    /// Calls `put` with each pixel's place, the sphere that most of it sees, the first of equal ones, and its area.
    fn most(mut self, mut put: impl FnMut(usize, usize, VisibleArea)) {
        // Stable: sums are in the order in which parts were found.
        self.0.sort_by_key(|(place, sphere, _)| (*place, *sphere));
        for pixel in self.0.chunk_by(|(one, ..), (other, ..)| one == other) {
            let mut most = (usize::MAX, VisibleArea::default());
            for parts in pixel.chunk_by(|(_, one, _), (_, other, _)| one == other) {
                let mut sum = VisibleArea::default();
                for (.., [area, error]) in parts {
                    sum.area += area;
                    sum.error += error;
                }
                if most.0 == usize::MAX || sum.area > most.1.area {
                    most = (parts[0].1, sum);
                }
            }
            put(pixel[0].0, most.0, most.1);
        }
    }
}

#[cfg(test)]
mod tests;
