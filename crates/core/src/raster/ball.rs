//! A ball, prepared for the samples of a tile.

use std::ops::Range;

use glam::DVec3;

use super::plane::Plane;
use crate::hit::ball::Ball;
use crate::model::color::Color;
use crate::numeric::lanes::LANES;
use crate::numeric::pair::both;
use crate::search::light_grid::Asked;

/// The largest radius on the screen, in samples. Larger balls have few edges in a tile, and single precision knows
/// them less.
const LARGEST: f64 = 1024.0;

/// The least one. What is smaller may lie between the samples.
const SMALLEST: f64 = 1.0;

/// The least distance of the center, along the axis of view, in radii: the silhouettes of nearer balls are drawn
/// out. Not tuned.
const NEAREST: f64 = 1.5;

/// A ball as the samples of a tile see it.
///
/// With the center (x, y, z) in the camera's frame, p = (x, y) / z and a sample at (X, Y), the numbers U = (X −
/// p.x) z / r and V = (Y − p.y) z / r tell how far it is from the center, in radii, and with a = 1 + X² + Y² the
/// ray meets the ball if D = a − U² − V² − (p.x V − p.y U)² > 0, at the depth z − r (X U + Y V + √D) / a. Nothing
/// cancels: all lengths are measured from the ball's own center.
#[derive(Clone, Copy, Debug)]
pub(super) struct RasterBall {
    /// The sphere in the world.
    pub(super) in_world: Asked,
    pub(super) radius: f32,
    /// p.
    pub(super) at: [f32; 2],
    /// z / r, and what it is multiplied by p from the plane's middle.
    pub(super) scale: f32,
    pub(super) offset: [f32; 2],
    /// z, from where the tile's first ball begins.
    pub(super) depth: f32,
    /// Keys that differ by less may be in another order.
    pub(super) blur: f32,
    /// All its keys are beyond this by more.
    pub(super) least: f32,
    /// The columns and rows of the samples that may see it.
    pub(super) columns: (u32, u32),
    pub(super) rows: (u32, u32),
    pub(super) albedo: Color,
}

impl RasterBall {
    /// A ball whose center lies there in the camera's frame, if it is neither too large nor too small, and lies ahead. Its
    /// color and its place in the world are missing.
    pub(super) fn new(ball: &Ball, center: DVec3, beginning: f64, plane: &Plane) -> Option<Self> {
        /// More than roundings move a key by, relatively.
        const BLUR: f64 = 4e-6;
        let radius = ball.radius;
        let least = radius / (center.z * plane.step.abs().max_element());
        let largest = radius / (center.z * plane.step.abs().min_element());
        let is_known = !ball.is_odd()
            && center.z > NEAREST * radius
            && least >= SMALLEST
            && largest <= LARGEST;
        if !is_known {
            return None;
        }
        let (x, y) = (center.x / center.z, center.y / center.z);
        let scale = center.z / radius;
        let product = (center.z - radius) * (center.z + radius);
        let ends = |along: f64| {
            let half = radius * (along * along + product).sqrt();
            [
                (along * center.z - half) / product,
                (along * center.z + half) / product,
            ]
        };
        let across = both(ends(center.x), |end| (end - plane.first.x) / plane.step.x);
        let down = both(ends(center.y), |end| (end - plane.first.y) / plane.step.y);
        let depth = center.z - beginning;
        let blur = BLUR * (depth.abs() + radius) * (1.0 + x * x + y * y);
        let begin = depth - radius;
        let [least, most] = plane.square;
        let nearest = begin * if begin < 0.0 { most } else { least };
        Some(Self {
            in_world: Asked {
                center: DVec3::ZERO,
                radius,
                index: ball.index,
            },
            radius: radius as f32,
            at: [x as f32, y as f32],
            scale: scale as f32,
            offset: [
                ((x - plane.middle.x) * scale) as f32,
                ((y - plane.middle.y) * scale) as f32,
            ],
            depth: depth as f32,
            blur: blur as f32,
            least: (nearest - 2.0 * blur) as f32,
            columns: covered(across[0]..across[1], plane.count),
            rows: covered(down[1]..down[0], plane.count),
            albedo: Color::ZERO,
        })
    }

    /// The groups of [`LANES`] columns of samples that may see it.
    pub(super) fn groups(&self) -> Range<usize> {
        self.columns.0 as usize / LANES..(self.columns.1 as usize).div_ceil(LANES)
    }

    /// The rows of samples that may see it.
    pub(super) fn rows(&self) -> Range<usize> {
        self.rows.0 as usize..self.rows.1 as usize
    }
}

/// The first line of some in a range, and the one after the last, with one more on either side.
fn covered(range: Range<f64>, count: usize) -> (u32, u32) {
    let count = count as f64;
    let first = (range.start.floor() - 1.0).clamp(0.0, count);
    let end = (range.end.ceil() + 2.0).clamp(first, count);
    (first as u32, end as u32)
}
