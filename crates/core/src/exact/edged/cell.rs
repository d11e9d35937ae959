//! The integral over a pixel with edges, or a part of one: by boxes, or along all of its edges.

use fearless_simd::Simd;

use super::boundary::{Boundary, Goal};
use super::boxes::{self, Boxes};
use super::normals::Normals;
use crate::edges::cell::{Ball, Cell};
use crate::exact::budget::{Budget, CellWork};
use crate::exact::classify::contents::Contents;
use crate::exact::classify::cut_side::CutSide;
use crate::exact::classify::occluder_cache::OccluderCache;
use crate::exact::context::Context;
use crate::exact::interior::cell::of_filled_cell;
use crate::exact::part::{GiveUp, Part};
use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::NoiseCells;
use crate::picture::pixel::Work;

/// Memory that the integral over pixels works with, kept from pixel to pixel.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) contents: Contents,
    pub(super) boundary: Boundary,
    boxes: Boxes,
    pub(crate) noise: Option<Box<NoiseCells>>,
    pub(crate) work: Work,
    /// The largest difference of light that something in the pixel may make.
    pub(super) contrast: f64,
    /// The budget of the pixel, less its cost so far.
    pub(crate) budget: Budget,
    /// Whether what its tile leaves to it limits all of its work.
    pub(crate) is_crowd: bool,
    /// The units that its tile leaves to it.
    pub(crate) left_by_tile: u64,
    /// Whether parts of the pixel are known by random samples.
    is_random: bool,
    /// The mean normals that the lights of a row of pixels have in common.
    pub(crate) normals: Normals,
}

/// A pixel with edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgedPixel<'a, 'scene> {
    pub(crate) context: &'a Context<'scene>,
    pub(crate) cell: Cell,
    pub(crate) key: PixelKey,
    /// The spheres that may be seen.
    pub(crate) spheres: &'a [(usize, Ball)],
}

/// The least claim of boxes, as a share of the contrast. Of two million pixels of colored crowds that claimed less, four
/// were off by .8 of it and no more: tips of curves that barely enter a box.
const LEAST_OF_BOXES: f64 = 1.5e-4;

/// Into how many parts pieces of curves are cut before events are looked for on them, in the whole
/// pixel and in parts of it: into more where something does not fit.
pub(super) const FINER: [&[usize]; 2] = [&[1, 2, 4], &[1, 2]];

/// The depth to which pixels are quartered: what is left of an edge in cells of the last depth is less than
/// 2⁻¹² of the contrast.
pub(super) const DEEPEST: i32 = 12;

/// From which depth on the quarters of a crowded part are thought to be crowded, too.
const CROWDED: i32 = 4;

/// Powers that no rule along a chord overlooks.
const BROAD: f64 = 60.0;

/// Cells of the noise of bumps, from the middle of a cell to a corner, up to which chords are divided finely enough
/// to see all bumps: rules that look less closely agree by chance.
const MOST_CELLS: f64 = 4.0;

/// The same up to which boxes are tried.
const MOST_CELLS_OF_BOXES: f64 = 2.0;

/// The distance by which pixels are moved aside, in their sides: planes through the eye, such as that of a terminator
/// in the middle of a picture, must not coincide with sides of cells. It is far more than rounding, and
/// costs an edge no more than the sum of both.
const ASIDE: [f64; 2] = [1.3e-10, -0.9e-10];

impl EdgedPixel<'_, '_> {
    /// The pixel, moved aside.
    pub(super) fn whole(&self) -> Cell {
        let mut cell = self.cell;
        cell.middle.x += ASIDE[0] * cell.size[0];
        cell.middle.y += ASIDE[1] * cell.size[1];
        cell
    }

    /// The error that moving the pixel aside adds, where light differs by so much.
    pub(super) fn moved(&self, contrast: f64) -> f64 {
        contrast * (ASIDE[0].abs() + ASIDE[1].abs())
    }
}

impl Workspace {
    /// Begins with a pixel whose spheres are too many to be told apart.
    pub(crate) fn leave_crowd(&mut self, pixel: &EdgedPixel<'_, '_>) {
        let tests = pixel.spheres.len() as u64;
        self.work.candidate_tests += tests;
        self.budget = Budget::default();
        self.budget.spend(CellWork { samples: 0, tests });
    }

    /// Begins with a pixel: finds out what it sees, and what it may cost.
    pub(crate) fn begin<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        cache: &mut OccluderCache,
    ) {
        let Context {
            scene,
            allowance,
            tolerance,
            ..
        } = pixel.context;
        let cell = pixel.whole();
        self.contents.pixel = pixel.key;
        self.contents.see(scene, &cell, pixel.spheres, cache);
        self.work.candidate_tests += pixel.spheres.len() as u64;
        let contents = &self.contents;
        self.contrast = pixel.context.contrast + contents.excess(simd, scene, &cell);
        self.budget = Budget::new(*allowance, contents.grains_across(scene, &cell), *tolerance)
            .within(self.left_by_tile, self.is_crowd);
        self.is_random = false;
    }

    /// Whether boxes know what a pixel sees: neither point lights nor fine bumps.
    pub(crate) fn knows_boxes(&self, pixel: &EdgedPixel<'_, '_>) -> bool {
        let scene = &pixel.context.scene;
        let contents = &self.contents;
        !contents.is_mixed
            && !contents.is_crowded
            && !scene.has_near_lights
            && !contents.has_finer_bumps(scene, &pixel.whole(), MOST_CELLS_OF_BOXES)
    }

    /// The average along the edges of the whole pixel.
    pub(crate) fn along_edges<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        cache: &mut OccluderCache,
        _: GiveUp,
    ) -> Result<Part, GiveUp> {
        let mut part = self.part(simd, pixel, &pixel.whole(), (0, cache))?;
        part.error += pixel.moved(self.contrast);
        if part.error <= pixel.context.tolerance || self.is_random {
            Ok(part)
        } else {
            Err(GiveUp::Claims(part))
        }
    }

    /// The average of the whole pixel by boxes, if they meet the tolerance.
    pub(crate) fn by_boxes<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        _: &mut OccluderCache,
        _: GiveUp,
    ) -> Result<Part, GiveUp> {
        let Context {
            scene,
            tolerance,
            background,
            has_alpha,
            ..
        } = pixel.context;
        let known = pixel.moved(self.contrast) + self.contrast * self.contents.rounding;
        let goal = boxes::Goal {
            tolerance: tolerance - known,
            background: *background,
            has_alpha: *has_alpha,
        };
        let cell = pixel.whole();
        let found =
            self.boxes
                .integrate(simd, scene, &cell, &self.contents, &goal, &mut self.noise);
        let work = std::mem::take(&mut self.boxes.work);
        self.work.samples += work.samples;
        self.budget.spend(work);
        let mut part = found.ok_or(GiveUp::Unknown)?;
        part.error += known;
        let has_curves = !self.contents.conics.is_empty() || !self.contents.occluders.is_empty();
        if has_curves {
            let least = LEAST_OF_BOXES * self.contrast;
            part.error = part.error.max(least.min(*tolerance));
        }
        Ok(part)
    }

    /// The average over a part of a pixel, at a depth, whose contents have been seen.
    pub(super) fn part<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        cell: &Cell,
        (depth, cache): (i32, &mut OccluderCache),
    ) -> Result<Part, GiveUp> {
        let Some(cut) = self.contents.divided_by(cell) else {
            return self.undivided_part(simd, pixel, cell, depth);
        };
        self.budget.count_looking(self.contents.tests, false);
        let mut sum = Part::NOTHING;
        for (side, sign) in [
            (CutSide::OuterBehindCap, 1.0),
            (CutSide::Inner, 1.0),
            (CutSide::InnerBehindCap, -1.0),
        ] {
            self.contents.see_side(
                &pixel.context.scene,
                cell,
                pixel.spheres,
                cache,
                Some((cut, side)),
            );
            self.work.candidate_tests += pixel.spheres.len() as u64;
            let part = self.undivided_part(simd, pixel, cell, depth)?;
            sum.value += part.value * sign;
            sum.covered += part.covered * sign;
            sum.error += part.error;
            sum.rounding += part.rounding;
        }
        Ok(sum)
    }

    /// The same where no rays begin inside of a sphere that others begin outside of.
    fn undivided_part<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        cell: &Cell,
        depth: i32,
    ) -> Result<Part, GiveUp> {
        let Context {
            scene,
            tolerance,
            background,
            ..
        } = pixel.context;
        let contents = &self.contents;
        let tests = pixel.spheres.len() as u64 + contents.tests;
        let mut work = CellWork { samples: 0, tests };
        let is_as_full = depth > 0 && 2 * contents.active.len() > pixel.spheres.len();
        let is_in_vain = contents.is_crowded && (is_as_full || depth >= CROWDED);
        self.budget.count_looking(contents.tests, is_in_vain);
        if contents.is_mixed || contents.is_crowded {
            self.budget.spend(work);
            return Err(GiveUp::Unknown);
        }
        // What rounding makes hopeless is not looked at closely.
        let is_coarse = self.contrast * contents.rounding > *tolerance;
        let units = if is_coarse { 0 } else { self.budget.of_part() };
        let negligible = 0.01 * tolerance;
        let filled = (!scene.has_near_lights).then(|| {
            of_filled_cell(
                simd,
                scene,
                cell,
                contents,
                (*tolerance, pixel.context.allowance),
                &mut self.noise,
            )
        });
        if let Some(found) = filled.flatten() {
            self.work.samples += found.samples;
            work.samples += found.samples;
            self.is_random |= found.is_random;
            if found.error <= *tolerance || found.is_random {
                self.budget.spend(work);
                return Ok(Part {
                    value: found.value,
                    covered: 1.0,
                    error: found.error,
                    rounding: 0.0,
                });
            }
        }
        let is_sharp = depth < DEEPEST
            && contents.is_narrow(scene, BROAD)
            && simd.vectorize(
                #[inline(always)]
                || contents.is_sharp(simd, scene, cell, negligible),
            );
        if is_sharp {
            self.budget.spend(work);
            return Err(GiveUp::Narrow);
        }
        if depth < DEEPEST && contents.has_finer_bumps(scene, cell, MOST_CELLS) {
            self.budget.spend(work);
            return Err(GiveUp::Bumps);
        }
        let mut best: Result<Part, GiveUp> = Err(GiveUp::NotFinite);
        for &parts in FINER[usize::from(depth > 0)] {
            let goal = Goal {
                tolerance: *tolerance,
                background: *background,
                contrast: self.contrast,
                of_coverage: pixel.context.of_coverage,
                parts,
                units,
            };
            let found = simd.vectorize(
                #[inline(always)]
                || {
                    self.boundary
                        .integrate(simd, scene, cell, &self.contents, &goal)
                },
            );
            let cost = std::mem::take(&mut self.boundary.work);
            work += cost;
            self.work.samples += cost.samples;
            self.work.lines += std::mem::take(&mut self.boundary.lines);
            if let Ok(part) = found {
                best = Ok(match best {
                    // A closer look that sees something else outvotes the claim of the first.
                    Ok(known) if known.differs_from(&part) => part.or_as_far_as(&known),
                    Ok(known) if known.error <= part.error => known,
                    _ => part,
                });
            }
            if is_coarse || best.is_ok_and(|part| part.error <= *tolerance) {
                break;
            }
        }
        self.budget.spend(work);
        best
    }
}
