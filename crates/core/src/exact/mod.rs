//! The integral over a pixel, to a tolerance.
//!
//! Most pixels see one sphere and no edge: a rule of Gauss's does. In the others all edges are
//! known as curves, between whose events the light is smooth.

mod classify;
mod context;
mod costs;
mod edged;
mod interior;
mod pixel;
mod points;
mod scene;
mod surface;
mod tile;

use std::num::NonZeroU32;

use fearless_simd::{Level, dispatch};

use self::classify::magnitude::is_view_moderate;
use self::context::Context;
use self::edged::cell::Workspace;
use self::scene::{InCamera, MOST_LIGHTS};
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::band::Band;
use crate::picture::image::Channels;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::tile::Tile;
use crate::sampling::Supersampling;
use crate::search::view_index::ViewIndex;

/// Averages to a tolerance.
#[derive(Clone, Debug)]
pub(crate) struct Exact<'scene> {
    context: Context<'scene>,
    seen: ViewIndex<'scene>,
    /// Whether doubles can be trusted with the view.
    is_view_moderate: bool,
    /// For pixels that cannot be integrated.
    fallback: Supersampling<'scene>,
    /// The other groups.
    others: Vec<Self>,
    level: Level,
}

/// Samples on a side of a pixel that cannot be integrated.
const FALLBACK_SAMPLES: NonZeroU32 = NonZeroU32::new(8).unwrap();

impl<'scene> Exact<'scene> {
    pub(crate) fn new(
        world: &'scene World,
        view: &View,
        seen: &ViewIndex<'scene>,
        tolerance: f64,
        alpha: bool,
    ) -> Self {
        let groups = world.lights.len().div_ceil(MOST_LIGHTS).max(1);
        let tolerance = tolerance / groups as f64;
        let of_group = |group| Self::of_group(world, view, seen, tolerance, alpha, group);
        Self {
            others: (1..groups).map(of_group).collect(),
            ..of_group(0)
        }
    }

    fn of_group(
        world: &'scene World,
        view: &View,
        seen: &ViewIndex<'scene>,
        tolerance: f64,
        alpha: bool,
        group: usize,
    ) -> Self {
        let channels = Channels::of(world, alpha);
        let scene = InCamera::new(world, seen.visibility, view, channels, group);
        let lights = world
            .lights
            .iter()
            .map(|light| light.intensity().max_element());
        let contrast = 1.0
            + world.ambient.max_element()
            + world.background.max_element()
            + lights.sum::<f64>();
        Self {
            is_view_moderate: is_view_moderate(view),
            context: Context {
                scene,
                view: *view,
                tolerance,
                background: if alpha || group > 0 {
                    Color::ZERO
                } else {
                    world.background
                },
                contrast,
            },
            seen: seen.clone(),
            fallback: Supersampling::new(world, view, seen, FALLBACK_SAMPLES, alpha),
            others: Vec::new(),
            level: Level::new(),
        }
    }
}

/// Memory to work in, and what is remembered of the noise.
#[derive(Debug, Default)]
pub(crate) struct Room {
    own: Workspace,
    /// For further lights.
    others: Vec<Workspace>,
}

impl Pixel {
    /// What is given up, until samples take its place.
    const LOST: Self = Self {
        value: Color::ZERO,
        alpha: 0.0,
        error: f64::NAN,
        evidence: Evidence::Estimate,
        status: Status::OutOfBudget,
    };

    /// Adds what further lights contribute.
    fn add(&mut self, more: &Self) {
        self.value += more.value;
        self.error += more.error;
        self.evidence = self.evidence.min(more.evidence);
        if self.status == Status::Met || more.status == Status::OutOfBudget {
            self.status = more.status;
        }
    }
}

impl Exact<'_> {
    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`]; returns what they cost.
    pub(crate) fn integrate(&self, tile: Tile, room: &mut Room, pixels: &mut Vec<Pixel>) -> Work {
        let candidates = self.seen.indices(tile);
        let first = pixels.len();
        let Room { own, others } = room;
        let mut work =
            dispatch!(self.level, simd => self.tile(simd, tile, &candidates, own, pixels));
        others.resize_with(self.others.len(), Workspace::default);
        let mut of_group = Vec::new();
        for (other, workspace) in self.others.iter().zip(others) {
            of_group.clear();
            work += dispatch!(self.level, simd => {
                other.tile(simd, tile, &candidates, workspace, &mut of_group)
            });
            for (pixel, more) in pixels[first..].iter_mut().zip(&of_group) {
                pixel.add(more);
            }
        }
        for ((col, row), pixel) in tile.pixels().zip(&mut pixels[first..]) {
            if pixel.error.is_nan() {
                let frame = self.context.view.frame;
                *pixel = self
                    .fallback
                    .pixel_of_last_resort(PixelKey { col, row, frame });
            }
        }
        work
    }

    /// Writes the tile's pixels into the band of a picture that contains it; returns what they cost.
    pub(crate) fn paint(&self, tile: Tile, room: &mut Room, band: &mut Band<'_>) -> Work {
        if self.seen.balls(tile).next().is_some() {
            let mut pixels = Vec::with_capacity((tile.width * tile.height) as usize);
            let work = self.integrate(tile, room, &mut pixels);
            band.write(tile, &pixels);
            return work;
        }
        // Most pictures have empty tiles.
        let mut pixel: Pixel = self.empty();
        for other in &self.others {
            pixel.add(&other.empty());
        }
        band.write_same(tile, &pixel);
        Work::default()
    }
}

#[cfg(test)]
mod tests;
