//! The light of a sun in one pixel.

use std::cell::RefCell;

use glam::{DMat3, DVec2};

use super::candidate::Candidate;
use super::curve::Curve;
use super::doubt::{
    Extent, most_hidden, of_bumps, of_exponent, of_highlight, of_penumbra, of_speck, of_terminator,
    shadow_half_width,
};
use super::edges::{Break, Edge, KNOTS, MOST_KNOTS, Sought, add_breaks};
use super::light::sun_light;
use super::point::SurfacePoint;
use super::rectangle::{Along, Cell, Contents, Light, Lit};
use super::rule::integral_along;
use super::sun::Sun;
use super::visible::Hidden;
use crate::light::shading_normal::ShadingNormal;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::NoiseCells;
use crate::model::world::World;

/// What a thread keeps for suns.
#[derive(Debug, Default)]
pub(crate) struct SunMemory {
    /// For each candidate of a cell.
    edges: Vec<Vec<Edge>>,
    noise: RefCell<Option<Box<NoiseCells>>>,
}

/// The light of a sun in one pixel, in the camera's frame.
pub(crate) struct OfSun<'a> {
    pub(crate) world: &'a World,
    pub(crate) sun: &'a Sun,
    pub(crate) world_from_camera: &'a DMat3,
    pub(crate) projection: Projection,
    pub(crate) key: PixelKey,
    /// For each candidate of the tile what may hide the sun from it.
    pub(crate) casters: &'a [Vec<Edge>],
    pub(crate) memory: &'a mut SunMemory,
    pub(crate) hidden: &'a mut Hidden,
}

/// The strength of the strongest highlight, 0 without any.
pub(crate) fn strongest_highlight(world: &World) -> f64 {
    let strengths = world.materials().iter().filter_map(|one| one.highlight);
    strengths.fold(0.0, |most, one| most.max(one.strength))
}

/// Half of a penumbra's width, in parts of the size of a cell, below which its edges are looked for.
const NARROW: f64 = 3.0;

/// Points of a curve are taken to be no further from its middle than so many times the furthest knot. Not proved.
const REACH: f64 = 1.25;

/// A curve is long if a knot is further from its middle, in parts of the sphere's radius. Not tuned.
const LONG: f64 = 0.4;

impl OfSun<'_> {
    fn place(&self, candidate: &Candidate, shading: &ShadingNormal, at: DVec2) -> SurfacePoint {
        let mut place = candidate.surface_point(at.x, at.y, self.projection);
        if !shading.is_smooth() {
            let normal = *self.world_from_camera * place.normal;
            let rough = shading.of(normal, &mut self.memory.noise.borrow_mut());
            place.shading = self.world_from_camera.transpose() * rough;
        }
        place
    }

    fn shading(&self, candidate: &Candidate) -> ShadingNormal {
        ShadingNormal::new(self.world, candidate.sphere, self.key)
    }

    fn light(&mut self, place: &SurfacePoint, number: usize) -> Color {
        let received = self
            .sun
            .received(place, &self.memory.edges[number], self.hidden);
        sun_light(self.sun, place, received, self.world)
    }

    /// Finds what may hide a part of the sun from what a cell sees of a candidate; returns false if all of it is hidden.
    fn find_edges(&mut self, candidate: &Candidate, extent: &Extent, number: usize) -> bool {
        let shading = self.shading(candidate);
        let disc = &self.sun.disc;
        if self.memory.edges.len() <= number {
            self.memory.edges.resize_with(number + 1, Vec::new);
        }
        let edges = &mut self.memory.edges[number];
        edges.clear();
        let turn = extent.turn.min(4.0);
        let rough_turn = turn * shading.slope_bound();
        let height = extent.normal.dot(disc.axis);
        if height <= -(disc.sine + turn) {
            return false;
        }
        if height - turn.max(rough_turn) - shading.most_tilt() < disc.sine {
            let has_highlight = self.world.material(candidate.sphere).highlight.is_some();
            edges.push(Edge::Horizon { has_highlight });
        }
        let middle = extent.point(candidate.sphere);
        for caster in &self.casters[candidate.number] {
            let height = caster.height(&middle, disc);
            if height.inner < -extent.around {
                return false;
            }
            if height.outer <= extent.around {
                edges.push(*caster);
            }
        }
        true
    }
}

impl Light for OfSun<'_> {
    fn at(&mut self, candidate: &Candidate, at: DVec2) -> Option<Lit> {
        let shading = self.shading(candidate);
        let place = self.place(candidate, &shading, at);
        Some(Lit {
            light: self.light(&place, 0),
            error: 0.0,
        })
    }

    fn is_shared(&self, candidate: &Candidate) -> bool {
        !matches!(self.shading(candidate), ShadingNormal::Factors(_))
    }

    fn doubt(&mut self, candidate: &Candidate, cell: &Cell, spacing: f64) -> f64 {
        let extent = Extent::new(candidate, [cell.u, cell.v], self.projection);
        let shading = self.shading(candidate);
        let cell = (&extent, spacing);
        let exponent = self.world.material(candidate.sphere).exponent;
        let of_surface = of_bumps(&extent, spacing, &shading)
            .max(of_exponent(self.sun, cell, exponent, &shading))
            .max(of_highlight(
                self.sun,
                cell,
                (self.world, candidate.sphere),
                &shading,
            ));
        of_surface * self.brightest()
    }

    fn brightest(&self) -> f64 {
        self.sun.intensity.max_element() * (1.0 + strongest_highlight(self.world))
    }

    fn may_see(&self, candidate: &Candidate, cell: &Cell) -> bool {
        candidate.may_be_in(cell.u, cell.v, self.projection)
    }

    fn contents(&mut self, candidate: &Candidate, cell: &Cell, number: usize) -> Contents {
        let extent = Extent::new(candidate, [cell.u, cell.v], self.projection);
        if !self.find_edges(candidate, &extent, number) {
            return Contents::Dark;
        }
        let middle = extent.point(candidate.sphere);
        let shading = self.shading(candidate);
        let (mut doubt, mut missed) = (0.0_f64, 0.0_f64);
        let mut is_narrow = false;
        let material = self.world.material(candidate.sphere);
        // Other light may be strong where the sun is nearly hidden by the own surface.
        let is_plain = material.exponent >= 1.0 && material.highlight.is_none();
        for edge in &self.memory.edges[number] {
            match edge {
                Edge::Horizon { has_highlight } => {
                    let turn = extent.turn * shading.slope_bound();
                    is_narrow |= turn > self.sun.disc.sine / NARROW || *has_highlight;
                    let exponent = self.world.material(candidate.sphere).exponent;
                    doubt = doubt.max(of_terminator(self.sun, &extent, &shading, exponent));
                }
                Edge::Sphere { center, radius } => {
                    let height = edge.height(&middle, &self.sun.disc);
                    is_narrow |= height.wide < NARROW * extent.around;
                    let most = if is_plain {
                        most_hidden(self.sun, &extent, (*center, *radius))
                    } else {
                        1.0
                    };
                    doubt = doubt.max(of_penumbra(&height, *radius, extent.around).min(most));
                    if shadow_half_width(candidate, (*center, *radius)) < extent.across {
                        missed = missed.max(of_speck(&height, *radius, extent.around).min(most));
                    }
                }
            }
        }
        if is_narrow {
            Contents::Edges {
                doubt: missed * self.brightest(),
            }
        } else {
            Contents::Smooth {
                doubt: doubt * self.brightest(),
            }
        }
    }

    fn add_breaks(
        &mut self,
        candidate: &Candidate,
        curve: &Curve,
        number: usize,
        breaks: &mut Vec<Break>,
    ) -> bool {
        if self.memory.edges[number].is_empty() {
            return true;
        }
        let shading = self.shading(candidate);
        let disc = self.sun.disc;
        let place_at = |place: f64| self.place(candidate, &shading, curve.at(place));
        let middle = place_at(0.5);
        let mut knots = [middle; MOST_KNOTS];
        let mut find = |count: usize| {
            let mut reach: f64 = 0.0;
            for (index, knot) in knots[..count].iter_mut().enumerate() {
                *knot = place_at(index as f64 / (count - 1) as f64);
                reach = reach.max((knot.position - middle.position).length());
            }
            reach
        };
        let (mut count, mut reach) = (KNOTS, find(KNOTS));
        if reach > LONG * candidate.radius {
            count = MOST_KNOTS;
            reach = find(MOST_KNOTS);
        }
        let knots = &knots[..count];
        let reach = REACH * reach;
        // Above the horizon E₀ grows with the power 5/2 of the distance. To a small exponent this is nearly a step.
        let is_steep = self.world.material(candidate.sphere).exponent < 1.0;
        for (number, edge) in self.memory.edges[number].iter().enumerate() {
            if matches!(edge, Edge::Sphere { .. }) {
                let height = edge.height(&middle, &disc);
                if height.inner < -reach {
                    return false;
                }
                if height.outer > reach {
                    continue;
                }
            }
            let mut heights = [edge.height(&middle, &disc); MOST_KNOTS];
            for (height, place) in heights.iter_mut().zip(knots) {
                *height = edge.height(place, &disc);
            }
            add_breaks(
                &heights[..count],
                &mut |place| edge.height(&self.place(candidate, &shading, curve.at(place)), &disc),
                Sought {
                    has_highlight: matches!(
                        edge,
                        Edge::Horizon {
                            has_highlight: true
                        }
                    ),
                    is_exact: curve.is_vertical
                        || (is_steep && matches!(edge, Edge::Horizon { .. })),
                    number,
                },
                breaks,
            );
        }
        true
    }

    fn along(
        &mut self,
        (candidate, number): (&Candidate, usize),
        curve: &Curve,
        breaks: &[Break],
        limit: f64,
    ) -> Along {
        let shading = self.shading(candidate);
        let mut along = Along::default();
        let mut begin = 0.0;
        let ends = breaks.iter().map(|one| one.place);
        for end in ends.chain([1.0]) {
            let from = std::mem::replace(&mut begin, end);
            if end <= from {
                continue;
            }
            integral_along(curve, [from, end], limit, &mut along, &mut |at| {
                let place = self.place(candidate, &shading, at);
                Lit {
                    light: self.light(&place, number),
                    error: 0.0,
                }
            });
        }
        along
    }
}
