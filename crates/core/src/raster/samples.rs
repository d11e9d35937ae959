//! The samples of a tile, number by number.

use super::plane::Plane;

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
    /// For each ball whether any sample sees it.
    seen: Vec<bool>,
}

/// No ball.
pub(super) const NONE: f32 = -1.0;

impl Samples {
    /// Makes place for the samples of a tile, which have seen nothing, with so many layers of light.
    pub(super) fn reset(&mut self, plane: &Plane, layers: usize) {
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
        self.light.resize(layers, Vec::new());
        for layer in &mut self.light {
            fill(layer, 0.0);
        }
    }

    /// Finds out which of so many balls are seen.
    pub(super) fn find_seen(&mut self, count: usize) {
        self.seen.clear();
        self.seen.resize(count, false);
        for row in self.balls.chunks_exact(self.stride) {
            for &ball in &row[..self.count] {
                if ball >= 0.0 {
                    self.seen[ball as usize] = true;
                }
            }
        }
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
