//! Spheres that may keep a light from others, as the light sees them.

use fearless_simd::Simd;
use glam::DVec3;

use crate::exact::scene::Light;
use crate::numeric::lanes::f64x8;
use crate::numeric::rounding::GEOMETRY_SLACK;

/// A sphere as a light sees it: a disc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Occluder {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// The center's place along the direction toward the light.
    pub(crate) height: f64,
    pub(crate) radius: f64,
    /// A bound of what rounding moves the disc by.
    pub(crate) slack: f64,
}

impl Occluder {
    pub(super) fn new(center: DVec3, radius: f64, light: &Light) -> Self {
        Self {
            x: center.dot(light.right),
            y: center.dot(light.up),
            height: center.dot(light.toward),
            radius,
            slack: 2.0 * GEOMETRY_SLACK * center.abs().max_element(),
        }
    }
}

/// Occluders in rows of numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Occluders {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) height: Vec<f64>,
    pub(super) radius: Vec<f64>,
    pub(super) slack: Vec<f64>,
}

impl Occluders {
    pub(super) fn get(&self, index: usize) -> Occluder {
        Occluder {
            x: self.x[index],
            y: self.y[index],
            height: self.height[index],
            radius: self.radius[index],
            slack: self.slack[index],
        }
    }

    pub(super) fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.height.clear();
        self.radius.clear();
        self.slack.clear();
    }

    pub(super) fn push(&mut self, occluder: &Occluder) {
        self.x.push(occluder.x);
        self.y.push(occluder.y);
        self.height.push(occluder.height);
        self.radius.push(occluder.radius);
        self.slack.push(occluder.slack);
    }
}

/// Eight numbers from an index on; zeros where there are none.
#[inline(always)]
pub(super) fn eight<S: Simd>(simd: S, numbers: &[f64], first: usize) -> f64x8<S> {
    let mut eight = [0.0; 8];
    let rest = &numbers[first..];
    let count = rest.len().min(8);
    eight[..count].copy_from_slice(&rest[..count]);
    f64x8::from_array(simd, eight)
}
