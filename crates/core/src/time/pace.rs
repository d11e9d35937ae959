//! How finely the time is divided before pixels are trusted that look the same at all moments.
//!
//! What crosses a pixel between two moments is missed. So no moments are farther apart than what is
//! seen near a pixel moves by less than a part of one. The world stands still and the camera moves:
//! what is seen, edges of shadows too, moves as the surfaces do on which it is; but highlights do as
//! mirror images behind them.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

use super::panel::{DEEPEST, FASTEST, LONGEST_GAP};
use crate::model::exposure::Motion;
use crate::model::exposure::{HALVES, view_at};
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;

/// How a pixel begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// The level of its first panels.
    pub(super) level: u32,
    /// What may be missed between their moments, as a part of the largest difference of light.
    pub(super) missed: f64,
    /// Whether that is little enough.
    pub(super) is_paced: bool,
}

/// How pixels begin, by cells of the picture.
#[derive(Debug)]
pub(super) struct Pace {
    /// Pixels of a cell's side.
    side: u32,
    columns: u32,
    starts: Vec<Start>,
}

/// A picture has no more cells than this along a side.
const MOST_CELLS: u32 = 64;

/// Moments of half of the time, from its start to its end: a jump between the halves moves nothing.
const MOMENTS: usize = HALVES[0].len();

/// What may be missed, of the tolerance.
const SHARE: f64 = 0.4;

/// A sphere this much nearer than its radius to the eye's plane may be seen anywhere.
const CLEAR: f64 = 1.0 + 1.0 / 64.0;

impl Pace {
    /// For a picture of a world to a tolerance, which is a part of the largest difference of light.
    pub(super) fn new(world: &World, view: &View, motion: &dyn Motion, tolerance: f64) -> Self {
        let side = view.width.max(view.height).div_ceil(MOST_CELLS).max(8);
        let (columns, rows) = (view.width.div_ceil(side), view.height.div_ceil(side));
        let ways = (0..columns * rows).map(|_| AtomicU64::new(0));
        let sweep = Sweep {
            side,
            columns,
            ways: ways.collect(),
        };
        let halves = HALVES.map(|times| times.map(|time| view_at(view, motion, time)));
        let spheres = world.spheres().par_iter().enumerate();
        spheres.for_each(|(index, sphere)| {
            let body = Body {
                sphere,
                is_shiny: world.material(index).highlight.is_some(),
            };
            for views in &halves {
                sweep.add(&body, views);
            }
        });
        let lowest = u32::from(!motion.is_smooth());
        let ways = sweep.ways.into_iter().map(AtomicU64::into_inner);
        let starts = ways.map(|way| Start::new(f64::from_bits(way), tolerance, lowest));
        Self {
            side,
            columns,
            starts: starts.collect(),
        }
    }

    /// How a pixel begins.
    pub(super) fn start(&self, col: u32, row: u32) -> Start {
        let cell = row / self.side * self.columns + col / self.side;
        self.starts[cell as usize]
    }
}

impl Start {
    /// With panels so short that nothing is missed that matters, where something goes a way of so many
    /// pixels in the whole time.
    fn new(way: f64, tolerance: f64, lowest: u32) -> Self {
        let mut level = lowest;
        while level < FASTEST && missed(way, level) > SHARE * tolerance {
            level += 1;
        }
        let missed = missed(way, level);
        Self {
            level,
            missed,
            is_paced: missed <= SHARE * tolerance,
        }
    }
}

/// What may be missed between the moments of panels of a level, of the light on a way of so many pixels.
///
/// What is convex, and comes into a pixel and leaves it again on a way of g, has come in by a corner,
/// covers no more than g²/4 of the pixel, and less than a half of that on average: g³/8 in all. With
/// gaps nearly as long as a pixel anything may be missed.
fn missed(way: f64, level: u32) -> f64 {
    const LONGEST: f64 = 0.9;
    let gap = LONGEST_GAP * way / f64::from(1_u32 << level);
    if way == 0.0 {
        0.0
    } else if gap < LONGEST {
        gap * gap * gap / (8.0 * way)
    } else {
        1.0
    }
}

/// Cells while spheres sweep over them.
struct Sweep {
    side: u32,
    columns: u32,
    /// How far what is seen in a cell goes in the whole time, in pixels: bits of numbers that are not
    /// negative, which are ordered as these are.
    ways: Vec<AtomicU64>,
}

/// A sphere, and whether it has a highlight.
struct Body<'world> {
    sphere: &'world Sphere,
    is_shiny: bool,
}

impl Sweep {
    /// Adds what a sphere does in half of the time.
    fn add(&self, body: &Body<'_>, views: &[View; MOMENTS]) {
        let sphere = body.sphere;
        let outside = views.iter().map(|view| outside(sphere, view));
        if outside.fold(!0, |all, outside| all & outside) != 0 {
            return;
        }
        let mut around: Option<(DVec2, DVec2)> = None;
        let mut before: Option<(DVec2, DVec2)> = None;
        let mut step: f64 = 0.0;
        for view in views {
            let Some((low, high)) = outline(sphere, view) else {
                // It may come from anywhere.
                let size = DVec2::new(f64::from(view.width), f64::from(view.height));
                for moment in 0..MOMENTS {
                    self.add_within((DVec2::ZERO, size), body, views, moment);
                }
                return;
            };
            if let Some(before) = before {
                step = step.max((low - before.0).length());
                step = step.max((high - before.1).length());
            }
            before = Some((low, high));
            let all = around.unwrap_or((low, high));
            around = Some((all.0.min(low), all.1.max(high)));
        }
        if let Some((low, high)) = around {
            // Between moments the way is not straight.
            let margin = 1.0 + 0.25 * step;
            self.add_within((low - margin, high + margin), body, views, MOMENTS / 2);
        }
    }

    /// Adds what a sphere does in cells that it sweeps over, as they see it at one of the moments.
    fn add_within(
        &self,
        (low, high): (DVec2, DVec2),
        body: &Body<'_>,
        views: &[View; MOMENTS],
        moment: usize,
    ) {
        let view = &views[moment];
        let side = f64::from(self.side);
        let rows = self.ways.len() as u32 / self.columns;
        // Casts saturate.
        let first = (low / side).floor();
        let last = (high / side).floor();
        if last.x < 0.0 || last.y < 0.0 {
            return;
        }
        for row in first.y as u32..=(last.y as u32).min(rows - 1) {
            for column in first.x as u32..=(last.x as u32).min(self.columns - 1) {
                let middle = (DVec2::new(f64::from(column), f64::from(row)) + 0.5) * side;
                let Some(travel) = self.travel(body, views, (view, middle)) else {
                    continue;
                };
                let way = if travel.is_finite() {
                    2.0 * travel
                } else {
                    f64::INFINITY
                };
                let cell = row * self.columns + column;
                self.ways[cell as usize].fetch_max(way.to_bits(), Ordering::Relaxed);
            }
        }
    }

    /// How far in pixels that point of a sphere travels in half of the time that a cell around `middle`
    /// sees, or that comes nearest to it; nothing where it does not come near.
    ///
    /// A highlight is a mirror image of a light that is far away: it moves as something does that lies
    /// up to half of the radius behind the surface, farther where the surface turns away.
    fn travel(
        &self,
        body: &Body<'_>,
        views: &[View; MOMENTS],
        (view, middle): (&View, DVec2),
    ) -> Option<f64> {
        let half_size = 0.5 * DVec2::new(f64::from(view.width), f64::from(view.height));
        let from_middle = (middle - half_size) * view.pixel_size();
        let on_retina = DVec2::new(from_middle.x, -from_middle.y) + view.lens.shift;
        let Ray { origin, direction } = view.ray(on_retina);
        let direction = direction.normalize();
        let sphere = body.sphere;
        let from_center = origin - sphere.center();
        let nearest = -from_center.dot(direction);
        let aside = from_center + direction * nearest;
        let distance = aside.length();
        let radius = sphere.radius();
        let is_hit = distance <= radius;
        let half = ((radius - distance) * (radius + distance)).max(0.0).sqrt();
        let point = if is_hit {
            let t = if nearest > half {
                nearest - half
            } else {
                nearest + half
            };
            if t <= 0.0 {
                return None;
            }
            origin + direction * t
        } else if nearest > 0.0 {
            sphere.center() + aside * (radius / distance)
        } else {
            return None;
        };
        /// Of the cosine of the angle at which a surface is seen: nearer to its outline images are
        /// lines.
        const LEAST_COSINE: f64 = 0.1;
        let depth = 0.5 * radius * radius / half.max(LEAST_COSINE * radius);
        let image = body.is_shiny.then(|| point + direction * depth);
        let mut longest: f64 = 0.0;
        for point in [Some(point), image].into_iter().flatten() {
            let mut before = None;
            for view in views {
                let Some(place) = view.project(point) else {
                    return Some(f64::INFINITY);
                };
                let step = before.map_or(0.0, |before: DVec2| (place - before).length());
                longest = longest.max(step);
                before = Some(place);
            }
        }
        let travel = longest * (MOMENTS - 1) as f64;
        if !is_hit {
            let half_diagonal = 0.71 * f64::from(self.side);
            let away = (view.project(point)? - middle).length();
            if away > half_diagonal + travel + 1.0 {
                return None;
            }
        }
        Some(travel)
    }
}

/// Of which planes a sphere is all on the outer side, as bits: the eye's, and those through it and the
/// four sides of the picture.
fn outside(sphere: &Sphere, view: &View) -> u8 {
    let center = in_camera(sphere, view);
    let scale = 1.0 / (view.lens.distance * view.zoom);
    let size = DVec2::new(f64::from(view.width), f64::from(view.height)) * view.pixel_size();
    let high = (view.lens.shift + 0.5 * size) * scale;
    let low = (view.lens.shift - 0.5 * size) * scale;
    let sides = [
        (center.x - high.x * center.z, high.x),
        (low.x * center.z - center.x, low.x),
        (center.y - high.y * center.z, high.y),
        (low.y * center.z - center.y, low.y),
    ];
    let mut bits = u8::from(center.z < -sphere.radius());
    for (side, (beyond, slope)) in sides.into_iter().enumerate() {
        let is_outside = beyond > sphere.radius() * (1.0 + slope * slope).sqrt();
        bits |= u8::from(is_outside) << (side + 1);
    }
    bits
}

/// Around a sphere in the picture of a view: the upper left and the lower right corner, in pixels;
/// none where it may be seen anywhere.
fn outline(sphere: &Sphere, view: &View) -> Option<(DVec2, DVec2)> {
    let center = in_camera(sphere, view);
    let radius = sphere.radius();
    let product = (center.z - radius) * (center.z + radius);
    let half = |along: f64| radius * (along * along + product).sqrt();
    let halves = DVec2::new(half(center.x), half(center.y));
    let middle = center.truncate() * center.z;
    let scale = view.lens.distance * view.zoom;
    let half_size = 0.5 * DVec2::new(f64::from(view.width), f64::from(view.height));
    let in_pixels = |slopes: DVec2| {
        let on_retina = slopes * scale - view.lens.shift;
        half_size + DVec2::new(on_retina.x, -on_retina.y) / view.pixel_size()
    };
    let one = in_pixels((middle - halves) / product);
    let other = in_pixels((middle + halves) / product);
    let is_known = center.z > CLEAR * radius && one.is_finite() && other.is_finite();
    is_known.then(|| (one.min(other), one.max(other)))
}

/// The center of a sphere in the camera's frame.
fn in_camera(sphere: &Sphere, view: &View) -> DVec3 {
    let from_eye = sphere.center() - view.camera.position;
    view.camera.world_from_camera.transpose() * from_eye
}

const _: () = assert!(FASTEST < DEEPEST && DEEPEST < 32);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::camera::{Camera, Lens};
    use crate::model::exposure::Pose;
    use crate::model::material::{Highlight, Material};
    use crate::numeric::angle::Angle;

    /// A camera that goes around a point which it looks at, by so many degrees.
    #[derive(Debug)]
    struct Around(f64);

    impl Motion for Around {
        fn pose(&self, time: f64) -> Option<Pose> {
            let pan = Angle::from_degrees(self.0 * time);
            let ahead = Camera::free(DVec3::ZERO, pan, Angle::ZERO, Angle::ZERO);
            let position = ahead.world_from_camera * DVec3::new(0.0, 0.0, -10.0);
            Some(Pose {
                camera: Camera { position, ..ahead },
                zoom: 1.0,
            })
        }

        fn is_smooth(&self) -> bool {
            true
        }
    }

    /// In the middle of the picture the surface stands still, and what is behind it does not.
    #[test]
    fn highlights_move_unlike_the_surface() {
        let motion = Around(6.0);
        let view = View {
            camera: motion.pose(0.0).unwrap().camera,
            lens: Lens {
                width: 1.0,
                distance: 1.0,
                shift: DVec2::ZERO,
            },
            zoom: 1.0,
            width: 320,
            height: 240,
            frame: 1,
        };
        let missed = [None, Some(0.5)].map(|strength| {
            let mut world = World::new();
            let material = world.add_material(Material {
                highlight: strength.map(|strength| Highlight {
                    strength,
                    shininess: 20.0,
                }),
                ..Material::MATTE_WHITE
            });
            let sphere = Sphere::new(DVec3::new(0.0, 0.0, 40.0), 40.0);
            world.add_sphere(sphere.unwrap(), material);
            let pace = Pace::new(&world, &view, &motion, 1e-3);
            pace.start(160, 120).level
        });
        assert!(missed[1] > missed[0] + 1, "{missed:?}");
    }

    #[test]
    fn panels_are_as_short_as_they_have_to_be() {
        for (way, lowest) in [(0.0, 0), (0.4, 0), (7.0, 0), (7.0, 1), (30.0, 0), (30.0, 1)] {
            let start = Start::new(way, 1e-3, lowest);
            assert!(start.is_paced && start.missed <= SHARE * 1e-3);
            let is_least = start.level == lowest || missed(way, start.level - 1) > SHARE * 1e-3;
            assert!(start.level >= lowest && is_least, "{start:?}");
        }
        let lost = Start::new(1e5, 1e-3, 0);
        assert!(!lost.is_paced && lost.missed == 1.0);
    }
}
