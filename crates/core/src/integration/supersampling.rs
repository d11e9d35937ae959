//! Plain supersampling: the yardstick for everything cleverer.

use std::num::NonZeroU32;

use super::{Integrator, Pixel, Status};
use crate::Tile;
use crate::roughness::PixelKey;
use crate::shading::shade;
use crate::visibility::{Candidate, Seen};
use crate::{Radiance, View, World};

/// The mean over the midpoints of a regular N × N division of every pixel.
///
/// # Accuracy
/// An estimate: the spread of the samples over 2N, which is what one straight edge along the
/// grid costs at the worst. An edge that passes between the samples and the pixel's border is not
/// in it, which happens in one edge pixel of five, and then costs less than 1/(2N) too; the largest
/// estimate of a picture covers its largest error. `tests/src/truth.rs` measures all three. One
/// sample alone says nothing: its error is infinite.
#[derive(Clone, Debug)]
pub(crate) struct Supersampling<'scene> {
    world: &'scene World,
    view: &'scene View,
    seen: &'scene Seen<'scene>,
    samples: NonZeroU32,
    alpha: bool,
}

impl<'scene> Supersampling<'scene> {
    /// Prepares `samples` × `samples` points in every pixel; with `alpha` the background sends
    /// no light.
    pub(crate) fn new(
        world: &'scene World,
        view: &'scene View,
        seen: &'scene Seen<'scene>,
        samples: NonZeroU32,
        alpha: bool,
    ) -> Self {
        Self {
            world,
            view,
            seen,
            samples,
            alpha,
        }
    }

    fn pixel<C: Radiance>(&self, candidates: &[Candidate], col: u32, row: u32) -> Pixel<C> {
        let side = self.samples.get();
        let key = PixelKey {
            col,
            row,
            frame: self.view.frame,
        };
        let background = if self.alpha {
            C::ZERO
        } else {
            C::from_color(self.world.background)
        };
        let cells = |pixel: u32| {
            let first = u64::from(pixel) * u64::from(side);
            first..first + u64::from(side)
        };
        let mut sum = C::ZERO;
        let mut covered = 0_u64;
        let mut range: Option<(C, C)> = None;
        for cell_row in cells(row) {
            for cell_col in cells(col) {
                let ray = self
                    .view
                    .ray(self.view.cell_center(cell_col, cell_row, side));
                let light = match self.seen.nearest(candidates, ray.direction) {
                    Some((sphere, hit)) => {
                        covered += 1;
                        shade(self.world, self.seen.visibility, &ray, sphere, &hit, key)
                    }
                    None => background,
                };
                sum += light;
                range = Some(range.map_or((light, light), |(low, high)| {
                    (low.min(light), high.max(light))
                }));
            }
        }
        let count = u64::from(side) * u64::from(side);
        let partly_covered = self.alpha && covered > 0 && covered < count;
        Pixel {
            value: sum * (1.0 / count as f64),
            alpha: covered as f64 / count as f64,
            error: error_estimate(side, range, partly_covered),
            status: Status::NoTolerance,
        }
    }
}

impl Supersampling<'_> {
    /// A pixel for which a tolerance was asked that cannot be met.
    pub(crate) fn pixel_of_last_resort<C: Radiance>(&self, key: PixelKey) -> Pixel<C> {
        let PixelKey { col, row, .. } = key;
        let (width, height) = (1, 1);
        let candidates = self.seen.candidates(Tile {
            col,
            row,
            width,
            height,
        });
        Pixel {
            status: Status::OutOfBudget,
            ..self.pixel(&candidates, col, row)
        }
    }
}

impl<C: Radiance> Integrator<C> for Supersampling<'_> {
    fn integrate(&self, tile: Tile, pixels: &mut Vec<Pixel<C>>) {
        let candidates = self.seen.candidates(tile);
        pixels.extend(
            tile.pixels()
                .map(|(col, row)| self.pixel(&candidates, col, row)),
        );
    }
}

/// The spread of the samples, alpha being one more channel, over twice the samples a side.
fn error_estimate<C: Radiance>(side: u32, range: Option<(C, C)>, partly_covered: bool) -> f64 {
    if side == 1 {
        return f64::INFINITY;
    }
    let coverage_spread = if partly_covered { 1.0 } else { 0.0 };
    let spread = range.map_or(0.0, |(low, high)| {
        let differences = high
            .channels()
            .iter()
            .zip(low.channels())
            .map(|(high, low)| high - low);
        differences.fold(coverage_spread, f64::max)
    });
    spread / (2.0 * f64::from(side))
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::visibility::Visibility;
    use crate::{Angle, Camera, Color, Lens, Material, Sphere};

    /// A 2 × 1 picture whose right pixel is covered but for its left quarter, by a sphere so
    /// large that its outline is straight there.
    fn scene() -> (World, View) {
        let mut world = World::new();
        let white = world.add_material(Material::MATTE_WHITE);
        let radius = 1e6;
        let touched = DVec3::new(0.25, 0.0, 1.0);
        let across = DVec3::new(1.0, 0.0, -0.25).normalize();
        world.add_sphere(
            Sphere::new(touched + radius * across, radius).unwrap(),
            white,
        );
        world.ambient = Color::splat(0.5);
        world.background = Color::splat(0.1);
        let view = View {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens {
                width: 2.0,
                distance: 1.0,
                shift: DVec2::ZERO,
            },
            zoom: 1.0,
            width: 2,
            height: 1,
            frame: 1,
        };
        (world, view)
    }

    fn pixels<C: Radiance>(samples: u32, alpha: bool) -> Vec<Pixel<C>> {
        let (world, view) = scene();
        let visibility = Visibility::new(&world);
        let seen = Seen::new(&visibility, &view, 8);
        let samples = NonZeroU32::new(samples).unwrap();
        let tile = Tile {
            col: 0,
            row: 0,
            width: 2,
            height: 1,
        };
        let mut pixels = Vec::new();
        Supersampling::new(&world, &view, &seen, samples, alpha).integrate(tile, &mut pixels);
        pixels
    }

    #[test]
    fn value_is_the_mean_over_the_grid() {
        let [left, right] = pixels::<f64>(4, false)[..] else {
            panic!("two pixels")
        };
        assert!((left.value - 0.1).abs() < 1e-15 && left.alpha == 0.0 && left.error == 0.0);
        assert!((right.value - 0.4).abs() < 1e-15 && right.alpha == 0.75);
        assert_eq!(right.error, (0.5 - 0.1) / 8.0);
    }

    #[test]
    fn alpha_leaves_the_background_out_and_counts_in_the_error() {
        let [left, right] = pixels::<Color>(4, true)[..] else {
            panic!("two pixels")
        };
        assert_eq!(
            (left.value, left.alpha, left.error),
            (Color::ZERO, 0.0, 0.0)
        );
        assert_eq!((right.value, right.alpha), (Color::splat(0.375), 0.75));
        assert_eq!(right.error, 1.0 / 8.0);
    }

    #[test]
    fn one_sample_claims_nothing() {
        assert!(
            pixels::<f64>(1, false)
                .iter()
                .all(|pixel| pixel.error == f64::INFINITY)
        );
    }
}
