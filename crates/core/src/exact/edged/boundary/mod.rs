//! The integral over a cell along the edges in it.
//!
//! With F the integral of the light L along lines up to a place, the integral of L over a region is
//! that of F dy around it (Green). So edges are all that is integrated along, between the places where
//! they cross others, and only where they are seen.

mod arcs;
mod breaks;
mod chord;
mod clip;
mod curve;
mod events;
mod kinks;
mod lit;
mod primitive;
mod quadrature;
mod turns;

use fearless_simd::f64x8;
use fearless_simd::prelude::*;
use glam::DVec2;

use self::chord::Reference;
use self::curve::{Circle, Piece, Shape};
use self::primitive::Noise;
use self::quadrature::total;

use crate::edges::cell::Cell;
use crate::exact::classify::active::{Active, Terminators};
use crate::exact::classify::contents::{Contents, Kind, Reach};
use crate::exact::classify::patch::Patch;
use crate::exact::part::{GiveUp, Part};
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;

/// No sphere.
const NONE: usize = usize::MAX;

/// A curve on which what is seen may change.
#[derive(Clone, Copy, Debug)]
struct Curve {
    shape: Shape,
    edge: Edge,
    /// The active spheres that it lies on.
    own: [usize; 2],
}

/// What lies on both sides of a curve.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Edge {
    /// The cell, to the left.
    Right,
    Left,
    /// A sphere and what is behind it.
    Limb,
    /// Two spheres.
    Seam,
    /// What a light reaches and what it does not.
    Terminator(usize),
    /// The light, and which of the casters.
    Shadow(usize, usize),
}

/// A piece of a curve.
#[derive(Clone, Copy, Debug)]
struct Path<'a> {
    curve: &'a Curve,
    piece: &'a Piece,
}

/// A part of a piece with the same on one side, and the same on the other.
#[derive(Clone, Copy, Debug)]
struct Arc {
    start: f64,
    end: f64,
    inner: usize,
    outer: usize,
    /// Lights that reach there.
    lit: [u64; 2],
}

/// Memory to work in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boundary {
    pieces: Vec<Piece>,
    breaks: Vec<f64>,
    arcs: Vec<Arc>,
    lit_arcs: Vec<Arc>,
    /// What is seen, and how far its edges are from closing.
    regions: Vec<(usize, u64, f64)>,
    /// Where curves cross the left side of the cell, and the right one.
    crossings: [Vec<f64>; 2],
    noise: Noise,
    /// Points at which light was computed, and lines that it was summed up along.
    pub(crate) samples: u64,
    pub(crate) lines: u64,
}

/// How much is asked of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    pub(crate) tolerance: f64,
    pub(crate) background: Color,
    /// About the largest difference of light that an edge may make.
    pub(crate) contrast: f64,
    /// Into how many parts pieces of curves are cut; with one, events of what is hidden are not looked
    /// for.
    pub(crate) parts: usize,
}

/// An active sphere's surface.
#[derive(Clone, Copy, Debug)]
struct Surface {
    finish: Finish,
    /// Where chords begin.
    reference: Reference,
    /// The lights, bit by bit, whose terminators may lie in the cell.
    terminators: u64,
}

/// The share of the tolerance that the errors of all arcs may take, before they are made larger for caution:
/// a cell has about two arcs for each curve, and two for its sides, so that their sum stays within it.
const SHARE_OF_ALL: f64 = 0.15;

/// Where curves are many most arcs take less than theirs: chosen by `cargo truth promise`.
const LEAST_SHARE: f64 = 0.02;

/// What does not change in a cell.
#[derive(Clone, Copy)]
struct Setting<'a, 'scene> {
    scene: &'a InCamera<'scene>,
    cell: &'a Cell,
    contents: &'a Contents,
    goal: &'a Goal,
    /// Those of the active spheres.
    surfaces: &'a [Surface],
    /// The share of the tolerance that an arc may take before it is halved.
    share: f64,
}

/// What arcs contribute so far, by nodes of the rule.
#[derive(Clone, Copy)]
struct Sum<S: Simd> {
    value: [f64x8<S>; 3],
    empty: f64x8<S>,
    error: f64,
}

impl Boundary {
    /// The integral over a cell.
    #[inline(always)]
    pub(crate) fn integrate<'scene, S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'scene>,
        cell: &Cell,
        contents: &Contents,
        goal: &Goal,
    ) -> Result<Part, GiveUp> {
        let actives = &contents.active;
        let mut surfaces = Vec::with_capacity(actives.len());
        for active in actives {
            let finish = Finish::new(scene, active.sphere, contents.pixel);
            let reference = Reference::new(&active.discriminant, &active.along);
            surfaces.push(Surface {
                finish,
                reference,
                terminators: 0,
            });
        }
        for (kind, _) in &contents.conics {
            if let Kind::Terminator(one, light) = *kind {
                surfaces[one].terminators |= 1 << light;
            }
        }
        // Between lines on bumps more may happen than their errors tell.
        let is_bumpy = |active: &Active| active.terminators == Terminators::Anywhere;
        let share = if actives.iter().any(is_bumpy) {
            LEAST_SHARE
        } else {
            let curves = contents.conics.len() + contents.occluders.len();
            (SHARE_OF_ALL / (curves + 1) as f64).max(LEAST_SHARE)
        };
        self.regions.clear();
        self.crossings[0].clear();
        self.crossings[1].clear();
        let setting = Setting {
            scene,
            cell,
            contents,
            goal,
            surfaces: &surfaces,
            share,
        };
        let zero = f64x8::splat(simd, 0.0);
        let mut sum = Sum {
            value: [zero; 3],
            empty: zero,
            error: 0.0,
        };
        for (kind, _) in &contents.conics {
            let (circle, edge, own) = match *kind {
                Kind::Silhouette(one) => {
                    let circle = Circle::limb(&actives[one].ball);
                    (circle, Edge::Limb, [one, NONE])
                }
                Kind::Seam(one, other) => {
                    let circle = Circle::seam(&actives[one].ball, &actives[other].ball);
                    let Some(circle) = circle else { continue };
                    (circle, Edge::Seam, [one, other])
                }
                Kind::Terminator(one, light) => {
                    let Some(axis) = actives[one].terminators.axis(scene, light) else {
                        continue;
                    };
                    let circle = Circle::terminator(&actives[one].ball, axis);
                    (circle, Edge::Terminator(light), [one, NONE])
                }
            };
            self.add_circle(simd, &setting, circle, edge, own, &mut sum);
        }
        let lights = scene.lights.len();
        for (position, active) in actives.iter().enumerate() {
            for light in 0..lights {
                let Reach::Past(casters) = &contents.reach[position * lights + light] else {
                    continue;
                };
                let toward = scene.lights[light].toward;
                let own = [position, NONE];
                if casters.is_empty() {
                    continue;
                }
                let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
                let middle = 0.5 * (patch.ends[0] + patch.ends[1]) - active.ball.center;
                let near = middle - toward * middle.dot(toward);
                let around = 0.5 * (patch.ends[1] - patch.ends[0]).length() + patch.around;
                // Without bumps, light reaches only one side of the sphere.
                let sides: &[f64] = match active.terminators {
                    Terminators::Plain => &[1.0],
                    Terminators::Tilted(_) | Terminators::Anywhere => &[1.0, -1.0],
                };
                for caster in casters.clone() {
                    for &side in sides {
                        let caster_ball = &contents.occluders[caster];
                        let curve = Curve {
                            shape: Shape::shadow(&active.ball, caster_ball, toward, side),
                            edge: Edge::Shadow(light, caster),
                            own,
                        };
                        self.pieces.clear();
                        clip::of_shadow(&curve.shape, near, around, &mut self.pieces);
                        self.add(simd, &setting, &curve, &mut sum);
                    }
                }
            }
        }
        // All that crosses the sides is known now.
        for (edge, x) in [(Edge::Left, -0.5), (Edge::Right, 0.5)] {
            self.pieces.clear();
            self.pieces.push(Piece {
                ends: [DVec2::new(0.0, -0.5), DVec2::new(0.0, 0.5)],
                roots: [false; 2],
            });
            let curve = Curve {
                shape: Shape::Side(x),
                edge,
                own: [NONE; 2],
            };
            self.add(simd, &setting, &curve, &mut sum);
        }
        let mut defect = 0.0;
        for (_, _, left) in &self.regions {
            defect += left.abs();
        }
        let mut value = Color::ZERO;
        for channel in 0..scene.channels {
            value[channel] = total(sum.value[channel]);
        }
        let rounding = goal.contrast * contents.rounding;
        let part = Part {
            value,
            covered: 1.0 - total(sum.empty),
            error: sum.error + goal.contrast * defect + rounding,
            rounding,
        };
        if part.error.is_finite() && part.value.is_finite() {
            Ok(part)
        } else {
            Err(GiveUp::NotFinite)
        }
    }

    #[inline(always)]
    fn add_circle<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        circle: Circle,
        edge: Edge,
        own: [usize; 2],
        sum: &mut Sum<S>,
    ) {
        self.pieces.clear();
        clip::of_circle(setting.cell, &circle, &mut self.pieces);
        let curve = Curve {
            shape: Shape::Circle(circle),
            edge,
            own,
        };
        self.add(simd, setting, &curve, sum);
    }

    /// Adds what the pieces of a curve contribute.
    #[inline(never)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        curve: &Curve,
        sum: &mut Sum<S>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                clip::split(&mut self.pieces, setting.goal.parts);
                for index in 0..self.pieces.len() {
                    let piece = self.pieces[index];
                    self.find_arcs(simd, setting, curve, &piece);
                    self.light_arcs(simd, setting, curve, &piece);
                    for index in 0..self.lit_arcs.len() {
                        let arc = self.lit_arcs[index];
                        let path = Path {
                            curve,
                            piece: &piece,
                        };
                        self.add_arc(simd, setting, &path, &arc, 0, sum);
                    }
                }
            },
        );
    }
}
