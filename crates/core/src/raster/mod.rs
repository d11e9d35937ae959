//! Crowds of small spheres, rasterized: every ball of a tile is held against the samples that it covers.
//!
//! A pixel of a crowd sees several balls. To a loose tolerance a regular grid of samples knows it in less time than
//! its edges take, and neighboring samples tell how well. [`plane`] has the places of a tile's samples, with one
//! row or column of others on every side. [`depth`] finds the nearest ball of each ([`ball`]), [`shade`] its light,
//! which other balls keep from it ([`occluders`]); [`judge`] sums the samples of a pixel, and estimates what their
//! mean is off by.
//!
//! All of it computes in single precision, with one rounding an operation and in an order that nothing but the tile
//! decides. Samples that this cannot decide are marked, and their pixels left to others. What it does not know, it
//! leaves to others, too: tiles with balls that are large, smaller than the distance of samples, or around the eye,
//! or with too many.

mod ball;
mod depth;
mod diagonals;
mod judge;
mod lit;
mod occluders;
mod plane;
mod samples;
mod shade;
#[cfg(test)]
mod tests;

use fearless_simd::{Level, dispatch};

use self::ball::RasterBall;
pub(crate) use self::judge::Judged;
use self::lit::Sun;
use self::occluders::Occluders;
use self::plane::Plane;
use self::samples::Samples;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::light_unit::LightUnit;
use crate::model::material::Material;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::image::Channels;
use crate::picture::tile::Tile;
use crate::search::light_grid::Asked;
use crate::search::view_index::ViewIndex;

/// The pixels of a tile.
const PIXELS: usize = (Tile::SIDE * Tile::SIDE) as usize;

/// The balls of which fewer in a tile are no crowd. Not tuned finely.
const FEWEST: usize = 16;

/// The balls of a tile of which more are left to what counts the work on them.
const MOST: usize = 2048;

/// More than roundings move the light of a sample by, in contrasts.
const ROUNDING: f64 = 1e-6;

/// A view of a world whose crowds can be rasterized.
#[derive(Clone, Debug)]
pub(crate) struct Raster<'scene> {
    index: ViewIndex<'scene>,
    world: &'scene World,
    view: View,
    channels: Channels,
    suns: Vec<Sun>,
    /// The light of rays that meet nothing, and that from everywhere, in units.
    background: Color,
    ambient: Color,
    has_alpha: bool,
    /// The albedo of all spheres, if they have no others.
    albedo: Option<Color>,
    /// The unit of light.
    unit: f64,
    /// The largest difference between what two rays may see, in units.
    contrast: f64,
    level: Level,
}

/// Memory to work in, for one world under any lights.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    balls: Vec<RasterBall>,
    samples: Samples,
    occluders: Occluders,
}

impl<'scene> Raster<'scene> {
    /// The raster of a view, if it [serves](Self::serves) there.
    pub(crate) fn new(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        alpha: bool,
    ) -> Option<Self> {
        let lights = index.visibility.lights();
        if !Self::serves(world, view, lights) {
            return None;
        }
        let sky = index.visibility.sky();
        let LightUnit { unit, .. } = LightUnit::new(world, index.visibility.all_lights(), sky);
        let background = if alpha { Color::ZERO } else { world.background };
        let [dark, bright] = world.range_of_light((lights, sky), background);
        let contrast = (bright - dark)
            .max_element()
            .max(if alpha { unit } else { 0.0 });
        Some(Self {
            index: index.clone(),
            world,
            view: *view,
            channels: Channels::of(world, alpha),
            suns: Sun::all(lights, unit, view, &index.visibility, world.shadows),
            background: background / unit,
            ambient: world.ambient / unit,
            has_alpha: alpha,
            albedo: world.only_albedo(),
            unit,
            contrast: contrast / unit,
            level: Level::new(),
        })
    }

    /// True if it knows all that a world has under these lights: suns, matte materials, and a central lens.
    pub(crate) fn serves(world: &World, view: &View, lights: &[Light]) -> bool {
        let is_sun = |light: &Light| matches!(light, Light::Directional(_));
        world.spheres().len() >= FEWEST
            && world.materials().iter().all(is_matte)
            && view.lens.projection() == Projection::Central
            && lights.iter().all(is_sun)
    }

    /// Makes ready for many tiles: most spheres that are seen are asked about.
    pub(crate) fn prepare(&self) {
        let spheres = self.world.spheres().len();
        self.index.visibility.expect_rows(spheres as u64);
    }

    /// The largest difference between what two rays may see.
    pub(crate) fn contrast(&self) -> f64 {
        self.contrast * self.unit
    }

    /// True if balls keep light from each other.
    pub(crate) fn has_shadows(&self) -> bool {
        self.world.shadows
    }

    /// The pixels of one of the tiles that pictures are divided into, in the order of [`Tile::pixels`], by `side` ×
    /// `side` samples each; none if they can not be known so.
    pub(crate) fn pixels(
        &self,
        tile: Tile,
        side: u32,
        scratch: &mut Scratch,
    ) -> Option<[Judged; PIXELS]> {
        let Scratch {
            balls,
            samples,
            occluders,
        } = scratch;
        let plane = Plane::new(&self.view, tile, side);
        if !plane.is_moderate() || !self.gather(tile, &plane, balls) {
            return None;
        }
        let layers = self.channels.count() + usize::from(self.has_alpha);
        let background = self.background.extend(0.0).as_vec4().to_array();
        samples.reset(&plane, balls.len(), &background[..layers]);
        dispatch!(self.level, simd => {
            depth::find_nearest(simd, &plane, balls, samples);
        });
        occluders.reset();
        for (number, ball) in balls.iter().enumerate() {
            if !samples.sees(number) {
                continue;
            }
            if !occluders.find(&self.suns, &self.index.visibility, ball) {
                return None;
            }
            dispatch!(self.level, simd => {
                self.shade(simd, &plane, (number as f32, ball), occluders, samples);
            });
        }
        let weights = self.weights(side, balls, samples);
        let mut pixels = judge::pixels(self.level, samples, &weights);
        for pixel in &mut pixels {
            pixel.value *= self.unit;
            pixel.error = (pixel.error + ROUNDING * self.contrast) * self.unit;
        }
        Some(pixels)
    }

    /// The number of different balls that the samples of each pixel of the last tile see.
    pub(crate) fn balls_seen(side: u32, scratch: &Scratch) -> [usize; PIXELS] {
        const SIDE: usize = Tile::SIDE as usize;
        let mut seen = [0; PIXELS];
        for (place, seen) in seen.iter_mut().enumerate() {
            let (column, row) = (place % SIDE, place / SIDE);
            *seen = scratch.samples.balls_of_pixel(side as usize, column, row);
        }
        seen
    }

    /// Gathers the balls of a tile; false if some are not for a raster.
    fn gather(&self, tile: Tile, plane: &Plane, balls: &mut Vec<RasterBall>) -> bool {
        balls.clear();
        let from_world = self.view.camera.world_from_camera.transpose();
        let unit = libm::scalbn(1.0, self.index.length_exponent());
        let mut beginning = None;
        for ball in self.index.balls(tile) {
            let center = from_world * ball.to_center;
            let beginning = *beginning.get_or_insert(center.z);
            let raster_ball = RasterBall::new(ball, center, beginning, plane);
            let Some(raster_ball) = raster_ball.filter(|_| balls.len() < MOST) else {
                return false;
            };
            balls.push(RasterBall {
                in_world: Asked {
                    center: self.view.camera.position + ball.to_center * unit,
                    radius: ball.radius * unit,
                    index: ball.index,
                },
                albedo: self
                    .albedo
                    .unwrap_or_else(|| self.world.albedo(ball.index as usize)),
                ..raster_ball
            });
        }
        balls.len() >= FEWEST
    }

    fn weights(&self, side: u32, balls: &[RasterBall], samples: &Samples) -> judge::Weights {
        judge::Weights {
            side: side as usize,
            channels: self.channels,
            of_spheres: self.contrast,
            of_background: self.background.max_element(),
            brightest: judge::brightest(self.level, samples),
            of_albedos: ratio_of_albedos(balls, samples),
        }
    }
}

/// The ratio of the albedos of the brightest and the darkest ball that samples see; a large one if that is black.
fn ratio_of_albedos(balls: &[RasterBall], samples: &Samples) -> f32 {
    let seen = balls.iter().enumerate();
    let seen = seen.filter(|(number, _)| samples.sees(*number));
    let albedos = seen.map(|(_, ball)| ball.albedo.max_element());
    let [darkest, brightest] = albedos.fold([f64::INFINITY, 0.0], |[least, most], albedo| {
        [least.min(albedo), most.max(albedo)]
    });
    if brightest > 0.0 {
        (brightest / darkest).min(f64::from(f32::MAX)) as f32
    } else {
        1.0
    }
}

/// Returns whether a material scatters light evenly and has no detail of its own.
fn is_matte(material: &Material) -> bool {
    material.exponent == 1.0
        && material.highlight.is_none()
        && material.roughness.is_none()
        && material.outline.is_none()
}
