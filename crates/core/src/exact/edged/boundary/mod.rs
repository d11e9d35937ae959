//! The integral over a cell along the edges in it.
//!
//! With F the integral of the light L along lines up to a place, the integral of L over a region is
//! that of F dy around it (Green). So edges are all that is integrated along, between the places where
//! they cross others, and only where they are seen.

mod arcs;
mod clip;
mod curve;
mod events;
mod lit;
mod primitive;
mod quadrature;

use fearless_simd::f64x8;
use fearless_simd::prelude::*;
use glam::DVec2;

use self::curve::{Circle, Piece, Shape};
use self::quadrature::total;
use super::cell::Goal;
use crate::edges::cell::Cell;
use crate::exact::classify::contents::{Contents, Kind, Reach};
use crate::exact::classify::patch::Patch;
use crate::exact::part::Part;
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
    /// For every active sphere the parameter of chords at which light begins to be summed up.
    references: Vec<f64>,
    /// Points at which light was computed.
    pub(crate) samples: u64,
    /// Into how many parts pieces are cut; with one, events of what is hidden are not looked for.
    pub(crate) parts: usize,
}

/// What does not change in a cell.
#[derive(Clone, Copy)]
struct Setting<'a, 'scene> {
    scene: &'a InCamera<'scene>,
    cell: &'a Cell,
    contents: &'a Contents,
    goal: &'a Goal,
    finishes: &'a [Finish],
}

/// What arcs contribute so far, by nodes of the rule.
#[derive(Clone, Copy)]
struct Sum<S: Simd> {
    value: [f64x8<S>; 3],
    empty: f64x8<S>,
    error: f64,
}

impl Boundary {
    /// The integral over a cell; nothing where a sphere is rough, or its outline no ellipse.
    #[inline(always)]
    pub(crate) fn integrate<'scene, S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'scene>,
        cell: &Cell,
        contents: &Contents,
        goal: &Goal,
    ) -> Option<Part> {
        let pixel = contents.pixel;
        let actives = &contents.active;
        let finishes: Vec<Finish> = actives
            .iter()
            .map(|active| Finish::new(scene, active.sphere, pixel))
            .collect();
        self.references.clear();
        for active in actives {
            let q = &active.discriminant;
            let is_ahead = active.ball.center.z > active.ball.radius;
            if !is_ahead || !active.is_smooth || q.xx >= 0.0 {
                return None;
            }
            let half = 0.5 * q.x;
            let middle = -half / q.xx;
            let width_sq = (half * half - q.xx * q.one) / (q.xx * q.xx);
            let reference = if width_sq > 0.0 {
                let sine = (-middle / width_sq.sqrt()).clamp(-1.0, 1.0);
                sine / (1.0 + (1.0 - sine * sine).sqrt())
            } else {
                0.0
            };
            self.references.push(reference);
        }
        self.regions.clear();
        let setting = Setting {
            scene,
            cell,
            contents,
            goal,
            finishes: &finishes,
        };
        let zero = f64x8::splat(simd, 0.0);
        let mut sum = Sum {
            value: [zero; 3],
            empty: zero,
            error: 0.0,
        };
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
                    let toward = scene.lights[light].toward;
                    let circle = Circle::terminator(&actives[one].ball, toward);
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
                for caster in casters.clone() {
                    let curve = Curve {
                        shape: Shape::shadow(&active.ball, &contents.occluders[caster], toward),
                        edge: Edge::Shadow(light, caster),
                        own,
                    };
                    self.pieces.clear();
                    clip::of_shadow(&curve.shape, near, around, &mut self.pieces);
                    self.add(simd, &setting, &curve, &mut sum);
                }
            }
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
        Some(Part {
            value,
            covered: 1.0 - total(sum.empty),
            error: sum.error + goal.contrast * defect + rounding,
            along: 0.0,
            rounding,
        })
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
                clip::split(&mut self.pieces, self.parts);
                for index in 0..self.pieces.len() {
                    let piece = self.pieces[index];
                    self.find_arcs(simd, setting, curve, &piece);
                    self.light_arcs(simd, setting, curve, &piece);
                    for index in 0..self.lit_arcs.len() {
                        let arc = self.lit_arcs[index];
                        self.add_arc(simd, setting, curve, &piece, &arc, 0, sum);
                    }
                }
            },
        );
    }
}
