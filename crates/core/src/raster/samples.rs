//! The samples of a tile, number by number.

use super::plane::Plane;
use crate::numeric::lanes::LANES;

/// What the samples of a tile see. Rows are as far apart as the plane's stride.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub(super) count: usize,
    pub(super) stride: usize,
    /// What orders the balls on a ray.
    pub(super) keys: Vec<f32>,
    /// The number of the nearest ball in the tile; [`NONE`] where there is none.
    pub(super) balls: Vec<f32>,
    /// 1 where another ball may be nearer, else 0.
    pub(super) doubts: Vec<f32>,
    /// The light in each channel, and then alpha, if somebody asks for that.
    pub(super) light: Vec<Vec<f32>>,
    /// The light, in the brightest channel, that other balls keep from what is seen.
    pub(super) kept: Vec<f32>,
    /// A number that is the same where the same balls keep the same light.
    pub(super) occluders: Vec<f32>,
    /// For blocks of [`LANES`] × [`LANES`] samples, row by row: no key is more.
    pub(super) far: Vec<f32>,
    /// For each ball whether any sample sees it.
    pub(super) seen: Vec<bool>,
}

/// No ball.
pub(super) const NONE: f32 = -1.0;

impl Samples {
    /// Makes place for the samples of a tile, which see the background's light in each layer and none of so many balls.
    pub(super) fn reset(&mut self, plane: &Plane, balls: usize, background: &[f32]) {
        self.count = plane.count;
        self.stride = plane.stride;
        let places = plane.count * plane.stride;
        let fill = |numbers: &mut Vec<f32>, number: f32| {
            numbers.clear();
            numbers.resize(places, number);
        };
        fill(&mut self.keys, f32::INFINITY);
        fill(&mut self.balls, NONE);
        fill(&mut self.doubts, 0.0);
        fill(&mut self.kept, 0.0);
        fill(&mut self.occluders, 0.0);
        self.light.resize(background.len(), Vec::new());
        for (layer, &background) in self.light.iter_mut().zip(background) {
            fill(layer, background);
        }
        // Nothing comes before what is behind the last sample of a row.
        for row in self.keys.chunks_exact_mut(self.stride) {
            row[self.count..].fill(f32::NEG_INFINITY);
        }
        self.far.clear();
        let blocks = plane.count.div_ceil(LANES) * (plane.stride / LANES);
        self.far.resize(blocks, f32::INFINITY);
        self.seen.clear();
        self.seen.resize(balls, false);
    }

    /// The number of different balls that the samples of a pixel see.
    pub(super) fn balls_of_pixel(&self, side: usize, column: usize, row: usize) -> usize {
        let mut seen: Vec<f32> = Vec::new();
        for row in row * side + 1..=(row + 1) * side {
            let first = row * self.stride + column * side + 1;
            for &ball in &self.balls[first..first + side] {
                if ball != NONE && !seen.contains(&ball) {
                    seen.push(ball);
                }
            }
        }
        seen.len()
    }

    /// True if any sample sees a ball.
    pub(super) fn sees(&self, ball: usize) -> bool {
        self.seen[ball]
    }
}
