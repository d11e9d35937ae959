//! Curves, arcs, and what does not change in a cell.

use fearless_simd::Simd;

use super::chord::Reference;
use super::curve::Shape;
use super::piece::Piece;
use super::power_rules::PowerRules;
use super::primitive::Noise;

use crate::edges::cell::Cell;
use crate::exact::budget::CellWork;
use crate::exact::classify::contents::Contents;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::numeric::lanes::f64x8;

/// No sphere.
pub(super) const NONE: usize = usize::MAX;

/// A curve on which what is seen may change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    pub(super) shape: Shape,
    pub(super) edge: Edge,
    /// The active spheres that it lies on.
    pub(super) own: [usize; 2],
}

impl Curve {
    /// Returns whether the curve is an upright side of the cell.
    pub(super) fn is_side(&self) -> bool {
        matches!(self.edge, Edge::Left | Edge::Right)
    }

    /// Returns whether the curve is one of light on a sphere, which is not seen on its outline.
    pub(super) fn is_within_outline(&self) -> bool {
        self.edge.light().is_some()
    }
}

/// The kind of a curve, which decides what lies on both sides of it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Edge {
    /// The cell, to the left.
    Right,
    Left,
    /// A sphere and what is behind it.
    Limb,
    /// Two spheres.
    Seam,
    /// A sphere inside of its outline, and the outline.
    Outline,
    /// Between the part that a light reaches and the part that faces away from it.
    Terminator(usize),
    /// Between the part that a lamp faces and the part that it faces away from.
    Cutoff(usize),
    /// The light, and which of the casters.
    Shadow(usize, usize),
}

impl Edge {
    /// The light whose edge it is, on a sphere.
    pub(super) fn light(self) -> Option<usize> {
        match self {
            Self::Terminator(light) | Self::Cutoff(light) | Self::Shadow(light, _) => Some(light),
            Self::Right | Self::Left | Self::Limb | Self::Seam | Self::Outline => None,
        }
    }
}

/// A piece of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path<'a> {
    pub(super) curve: &'a Curve,
    pub(super) piece: &'a Piece,
}

/// A part of a piece with the same on one side, and the same on the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub(super) start: f64,
    pub(super) end: f64,
    /// The heights of the ends in the cell.
    pub(super) y: [f64; 2],
    pub(super) inner: usize,
    pub(super) outer: usize,
    /// Whether what is seen of these are their outlines.
    pub(super) outlines: [bool; 2],
    /// Lights that reach there.
    pub(super) lit: [u64; 2],
}

impl Arc {
    /// Returns whether the same surface is seen on both sides.
    pub(super) fn has_one_surface(&self) -> bool {
        self.inner == self.outer && self.outlines[0] == self.outlines[1]
    }
}

/// The view on one side of an arc: a sphere or [`NONE`], whether it is the outline, and the lights that reach there.
pub(super) type Region = (usize, bool, u64);

/// Memory to work in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boundary {
    pub(super) pieces: Vec<Piece>,
    pub(super) breaks: Vec<f64>,
    pub(super) arcs: Vec<Arc>,
    pub(super) lit_arcs: Vec<Arc>,
    /// The regions, each with the gap that its edges leave open.
    pub(super) regions: Vec<(Region, f64)>,
    /// The heights at which curves cross the left side of the cell, and the right one.
    pub(super) crossings: [Vec<f64>; 2],
    pub(super) noise: Noise,
    /// For each active sphere, the y at which sums of light along its lines are singular.
    pub(super) levels: Vec<(usize, f64)>,
    /// The rules for powers that were met so far.
    pub(super) rules: Vec<PowerRules>,
    /// The work since it was asked for, and lines that light was summed up along.
    pub(crate) work: CellWork,
    pub(crate) lines: u64,
}

/// The accuracy asked of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    pub(crate) tolerance: f64,
    pub(crate) background: Color,
    /// About the largest difference of light that an edge may make.
    pub(crate) contrast: f64,
    /// The light that an error of the covered area counts as.
    pub(crate) of_coverage: f64,
    /// Into how many parts pieces of curves are cut; with one, events of what is hidden are not looked
    /// for.
    pub(crate) parts: usize,
    /// The units after which arcs are not halved any more.
    pub(crate) units: u64,
}

/// An active sphere's surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub(super) finish: Finish,
    /// The line on which chords begin.
    pub(super) reference: Reference,
    /// The lights, bit by bit, whose terminators may lie in the cell.
    pub(super) terminators: u64,
    /// Those whose light is singular at their cutoffs, which may lie in the cell.
    pub(super) cutoffs: u64,
    /// Those for diffuse light with a power that is not whole, where there are such terminators.
    pub(super) rules: PowerRules,
}

impl Surface {
    /// Whether sums of these lights along lines are singular at levels of the surface.
    pub(super) fn is_singular(&self, lights: u64) -> bool {
        self.terminators & lights != 0 && self.finish.has_fractional_exponent()
            || self.cutoffs & lights != 0
    }
}

/// The share of the tolerance that the errors of all arcs may take, before they are made larger for caution:
/// a cell has about two arcs for each curve, and two for its sides, so that their sum stays within it.
pub(super) const SHARE_OF_ALL: f64 = 0.15;

/// The least share for an arc among many, most of which take less than theirs: chosen by `cargo truth promise`.
pub(super) const LEAST_SHARE: f64 = 0.02;

/// The data that do not change in a cell.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a, 'scene> {
    pub(super) scene: &'a InCamera<'scene>,
    pub(super) cell: &'a Cell,
    pub(super) contents: &'a Contents,
    pub(super) goal: &'a Goal,
    /// Those of the active spheres.
    pub(super) surfaces: &'a [Surface],
    /// The share of the tolerance that an arc may take before it is halved.
    pub(super) share: f64,
    /// Whether some of the active spheres have bumps.
    pub(super) has_bumps: bool,
}

impl Setting<'_, '_> {
    /// Whether light summed up to an arc goes with a power that is not whole of the distance to its ends: rules
    /// converge slowly there, and their difference is not to be raised to a power.
    pub(super) fn is_singular(&self, arc: &Arc) -> bool {
        let sides = [(arc.inner, arc.lit[0]), (arc.outer, arc.lit[1])];
        sides
            .into_iter()
            .any(|(sphere, lit)| sphere != NONE && self.surfaces[sphere].is_singular(lit))
    }
}

/// The sum over arcs so far, by nodes of the rule.
#[derive(Clone, Copy)]
pub(super) struct Sum<S: Simd> {
    pub(super) value: [f64x8<S>; 3],
    pub(super) empty: f64x8<S>,
    pub(super) error: f64,
}
