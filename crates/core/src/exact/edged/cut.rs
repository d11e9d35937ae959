//! Lines cut where something happens on them.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use crate::edges::cell::Cell;
use crate::edges::shadow::Arcs;
use crate::exact::classify::contents::{Contents, Kind, Reach};
use crate::exact::points::Points;
use crate::exact::scene::InCamera;
use crate::numeric::vectors::Vectors;

/// Changes on a line that can be told apart.
pub(crate) const MOST_CHANGES: usize = 14;

/// What is seen on a line, from one end to the other; lines with the same are alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Signature {
    /// Number of changes.
    pub(crate) changes: usize,
    /// The branch of an edge at each change; see [`branch_of_conic`] and [`branch_of_shadow`].
    pub(crate) branches: [u16; MOST_CHANGES],
    /// What is seen before, between and after the changes: [`NOTHING`], or a sphere and its lights.
    pub(crate) views: [u64; MOST_CHANGES + 1],
}

impl Signature {
    /// Nothing all along.
    pub(crate) const EMPTY: Self = Self {
        changes: 0,
        branches: [0; MOST_CHANGES],
        views: [NOTHING; MOST_CHANGES + 1],
    };
}

impl Default for Signature {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// No sphere.
pub(crate) const NOTHING: u64 = 0;

/// The position of the active sphere of a view.
pub(crate) fn sphere_of(view: u64) -> Option<usize> {
    ((view & 0xffff_ffff) as usize).checked_sub(1)
}

/// Whether a light reaches what is seen.
pub(crate) fn is_lit(view: u64, light: usize) -> bool {
    view >> (32 + light) & 1 == 1
}

/// Numbers of branches: two for each conic, then four for each caster.
pub(crate) fn branch_of_conic(conic: usize, falls: bool) -> u16 {
    (2 * conic + usize::from(falls)) as u16
}

pub(crate) fn branch_of_shadow(conics: usize, caster: usize, falls: usize, ordinal: usize) -> u16 {
    (2 * conics + 4 * caster + 2 * falls + ordinal) as u16
}

/// More happens on a line than a signature has room for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crowded;

/// Places and branches on eight lines, in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cuts {
    places: Vec<[f64; 8]>,
    branches: Vec<[u16; 8]>,
    counts: [usize; 8],
    /// Of the lines that were looked at last.
    signatures: [Signature; 8],
    /// Which of the places the changes of the signatures are.
    changes: [[usize; MOST_CHANGES]; 8],
    scratch: Vec<f64>,
    has_dropped: bool,
}

impl Cuts {
    /// Whether something narrow was left out since this was asked the last time.
    pub(crate) fn has_dropped(&mut self) -> bool {
        std::mem::take(&mut self.has_dropped)
    }

    /// Finds the signatures of the lines with these y, without what is narrower than `narrowest`.
    #[inline(never)]
    pub(crate) fn look<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        contents: &Contents,
        y: &[f64; 8],
        narrowest: f64,
    ) -> Result<(), Crowded> {
        simd.vectorize(
            #[inline(always)]
            || {
                let lines: f64x8<S> = (*y).simd_into(simd);
                self.counts = [0; 8];
                for (index, (_, conic)) in contents.conics.iter().enumerate() {
                    let crossings = conic.crossings(lines);
                    self.note(crossings.rising, branch_of_conic(index, false));
                    self.note(crossings.falling, branch_of_conic(index, true));
                }
                let conics = contents.conics.len();
                for (active, sphere) in contents.active.iter().enumerate() {
                    let lights = scene.lights.len();
                    let mut arcs = None;
                    for light in 0..lights {
                        let Reach::Past(casters) = &contents.reach[active * lights + light] else {
                            continue;
                        };
                        for caster in casters.clone() {
                            let arcs = match arcs {
                                Some(ref arcs) => arcs,
                                None => arcs.insert(Arcs::new(simd, cell, &sphere.ball, lines)),
                            };
                            let places = arcs.crossings(
                                simd,
                                cell,
                                &contents.occluders[caster],
                                &mut self.scratch,
                            );
                            for (falls, places) in places.iter().enumerate() {
                                for (ordinal, place) in places.iter().enumerate() {
                                    self.note(
                                        *place,
                                        branch_of_shadow(conics, caster, falls, ordinal),
                                    );
                                }
                            }
                        }
                    }
                }
                let most = self.counts.iter().copied().max().unwrap_or(0);
                self.signatures = [Signature::EMPTY; 8];
                // The branch that began what is narrower than a gap may be: the first of those in one place.
                let mut pending = [None; 8];
                let mut has_begun = [false; 8];
                for gap in 0..=most {
                    let mut middle = [0.0; 8];
                    let mut width = [0.0; 8];
                    for lane in 0..8 {
                        let count = self.counts[lane];
                        let start = if gap == 0 {
                            -0.5
                        } else {
                            self.places[gap.min(count).max(1) - 1][lane]
                        };
                        let end = if gap >= count {
                            0.5
                        } else {
                            self.places[gap][lane]
                        };
                        middle[lane] = 0.5 * (start + end);
                        width[lane] = end - start;
                    }
                    let views = views(simd, scene, cell, contents, middle.simd_into(simd), lines);
                    for lane in 0..8 {
                        if gap > self.counts[lane] {
                            continue;
                        }
                        let signature = &mut self.signatures[lane];
                        let branch: Option<u16> = (gap > 0).then(|| self.branches[gap - 1][lane]);
                        let branch = match (pending[lane], branch) {
                            (Some(one), Some(other)) => Some(u16::min(one, other)),
                            (one, other) => one.or(other),
                        };
                        let is_last_chance = gap == self.counts[lane] && !has_begun[lane];
                        if width[lane] < narrowest && !is_last_chance {
                            self.has_dropped |= !has_begun[lane]
                                || signature.views[signature.changes] != views[lane];
                            pending[lane] = branch;
                            continue;
                        }
                        pending[lane] = None;
                        if !has_begun[lane] {
                            has_begun[lane] = true;
                            signature.views[0] = views[lane];
                        } else if signature.views[signature.changes] != views[lane] {
                            if signature.changes == MOST_CHANGES {
                                return Err(Crowded);
                            }
                            signature.branches[signature.changes] = branch.unwrap_or_default();
                            self.changes[lane][signature.changes] = gap - 1;
                            signature.changes += 1;
                            signature.views[signature.changes] = views[lane];
                        }
                    }
                }
                Ok(())
            },
        )
    }

    /// Of the lines that were looked at last.
    pub(crate) fn signatures(&self) -> &[Signature; 8] {
        &self.signatures
    }

    /// Where the line in a lane of the last signatures changes.
    pub(crate) fn place(&self, lane: usize, change: usize) -> f64 {
        self.places[self.changes[lane][change]][lane]
    }

    /// A line between those of the last signatures, all alike with so many changes and at these y in
    /// order, on which an edge that is seen may cross its neighbor, and on the next back again.
    pub(crate) fn approach(&self, changes: usize, y: &[f64; 8], lanes: usize) -> Option<f64> {
        for change in 0..changes {
            for step in [0, 2] {
                // The distances to the neighbor, while it is the same.
                let mut distances = [f64::NAN; 8];
                let mut neighbor = None;
                for (lane, distance) in distances.iter_mut().enumerate().take(lanes) {
                    let here = self.changes[lane][change];
                    let Some(other) = (here + step).checked_sub(1) else {
                        break;
                    };
                    if other >= self.counts[lane] {
                        break;
                    }
                    let branch = self.branches[other][lane];
                    if *neighbor.get_or_insert(branch) != branch {
                        break;
                    }
                    *distance = (self.places[other][lane] - self.places[here][lane]).abs();
                }
                let approach = (1..lanes - 1).find_map(|lane| lowest(&distances, y, lane));
                if approach.is_some() {
                    return approach;
                }
            }
        }
        None
    }

    /// Notes where a branch crosses the lines, where it does so inside the cell.
    #[inline(always)]
    fn note<S: Simd>(&mut self, places: f64x8<S>, branch: u16) {
        let mut inside = (places.simd_gt(-0.5) & places.simd_lt(0.5)).to_bitmask();
        while inside != 0 {
            let lane = inside.trailing_zeros() as usize;
            inside &= inside - 1;
            let place = places[lane];
            let count = self.counts[lane];
            if count == self.places.len() {
                self.places.push([0.0; 8]);
                self.branches.push([0; 8]);
            }
            let mut at = count;
            while at > 0 && self.places[at - 1][lane] > place {
                self.places[at][lane] = self.places[at - 1][lane];
                self.branches[at][lane] = self.branches[at - 1][lane];
                at -= 1;
            }
            self.places[at][lane] = place;
            self.branches[at][lane] = branch;
            self.counts[lane] = count + 1;
        }
    }
}

/// Where the parabola through the distance in a lane and in those beside it is lowest, if that is
/// much lower than all three.
fn lowest(distances: &[f64; 8], y: &[f64; 8], lane: usize) -> Option<f64> {
    /// Nearer edges are one.
    const ONE: f64 = 1e-9;
    const MUCH: f64 = 0.3;
    let [before, here, after] = [-1, 0, 1].map(|step| distances[lane.wrapping_add_signed(step)]);
    if !(here > ONE && here <= before && here <= after) {
        return None;
    }
    let (left, right) = (y[lane] - y[lane - 1], y[lane + 1] - y[lane]);
    let (falls, rises) = ((here - before) / left, (after - here) / right);
    let curvature = (rises - falls) / (left + right);
    let slope = (falls * right + rises * left) / (left + right);
    let lowest = here - 0.25 * slope * slope / curvature;
    (lowest < MUCH * here).then(|| y[lane] - 0.5 * slope / curvature)
}

/// What is seen at eight points.
#[inline(never)]
pub(crate) fn views<S: Simd>(
    simd: S,
    scene: &InCamera<'_>,
    cell: &Cell,
    contents: &Contents,
    x: f64x8<S>,
    y: f64x8<S>,
) -> [u64; 8] {
    simd.vectorize(
        #[inline(always)]
        || {
            let ray = ray(simd, cell, x, y);
            let mut nearest = f64x8::splat(simd, f64::INFINITY);
            let mut first = f64x8::splat(simd, 0.0);
            for (position, active) in contents.active.iter().enumerate() {
                let q = &active.discriminant;
                let discriminant = (x * q.xx + y * q.xy + q.x) * x + (y * q.yy + q.y) * y + q.one;
                let along = x * active.along.x + y * active.along.y + active.along.one;
                let root = discriminant.max(f64x8::splat(simd, 0.0)).sqrt();
                let t = if active.ball.outside > 0.0 {
                    let is_seen = discriminant.simd_ge(0.0) & along.simd_gt(0.0);
                    let t = f64x8::splat(simd, active.ball.outside) / (along + root);
                    is_seen.select(t, f64x8::splat(simd, f64::INFINITY))
                } else {
                    (along + root) / ray.length_squared()
                };
                let is_nearer = t.simd_lt(nearest);
                nearest = is_nearer.select(t, nearest);
                first = is_nearer.select(f64x8::splat(simd, (position + 1) as f64), first);
            }
            let mut views = [NOTHING; 8];
            for lane in 0..8 {
                views[lane] = first[lane] as u64;
            }
            let lights = scene.lights.len();
            for (position, active) in contents.active.iter().enumerate() {
                let here = first.simd_eq((position + 1) as f64).to_bitmask();
                let reach = &contents.reach[position * lights..][..lights];
                let is_dark = reach.iter().all(|reach| matches!(reach, Reach::Nowhere));
                if here == 0 || is_dark {
                    continue;
                }
                let points = Points::new(simd, &active.ball, ray);
                for (light, reach) in reach.iter().enumerate() {
                    let Reach::Past(casters) = reach else {
                        continue;
                    };
                    let toward = scene.lights[light].toward;
                    let mut lit = here;
                    if active.is_smooth {
                        lit &= points.normal.dot_one(toward).simd_gt(0.0).to_bitmask();
                    }
                    if !casters.is_empty() && lit != 0 {
                        let place = points.place();
                        for caster in &contents.occluders[casters.clone()] {
                            let from = place.minus(&Vectors::splat(simd, caster.center));
                            let (right, up) = (from.dot_one(caster.right), from.dot_one(caster.up));
                            let is_hidden = (right * right + up * up)
                                .simd_lt(caster.radius * caster.radius)
                                & from.dot_one(toward).simd_lt(0.0);
                            lit &= !is_hidden.to_bitmask();
                        }
                    }
                    let bit = 1 << (32 + light);
                    while lit != 0 {
                        views[lit.trailing_zeros() as usize] |= bit;
                        lit &= lit - 1;
                    }
                }
            }
            views
        },
    )
}

/// The rays through eight points of a cell.
#[inline(always)]
pub(crate) fn ray<S: Simd>(simd: S, cell: &Cell, x: f64x8<S>, y: f64x8<S>) -> Vectors<S> {
    let [along, across] = cell.axes();
    Vectors::splat(simd, cell.middle)
        .moved(along, x * cell.size[0])
        .moved(across, y * cell.size[1])
}

/// Whether the integrand is a function of the root of the distance to an edge on its side where
/// the active sphere with this position is seen.
pub(crate) fn has_root_at(
    contents: &Contents,
    branch: u16,
    position: usize,
    exponent: f64,
) -> bool {
    let conic = usize::from(branch / 2);
    match contents.conics.get(conic) {
        Some((Kind::Silhouette(of), _)) => *of == position,
        Some((Kind::Terminator(of, _), _)) => *of == position && exponent.fract() != 0.0,
        _ => false,
    }
}
