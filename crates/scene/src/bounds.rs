//! The box around spheres.

use glam::DVec3;
use marbles_core::{Sphere, parallel};

/// The box around spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    /// The box around none.
    pub(crate) const NONE: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    /// The box around these.
    pub(crate) fn of(spheres: &[Sphere]) -> Self {
        let of_sphere = |sphere: &Sphere| {
            let reach = DVec3::splat(sphere.radius());
            Self {
                low: sphere.center() - reach,
                high: sphere.center() + reach,
            }
        };
        let around = |boxes: Self, sphere: &Sphere| boxes.around(of_sphere(sphere));
        let boxes = parallel::map_pieces(spheres, |piece| piece.iter().fold(Self::NONE, around));
        boxes.into_iter().fold(Self::NONE, Self::around)
    }

    /// The box around both.
    pub(crate) fn around(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The middle, `None` of the box around none.
    pub(crate) fn middle(self) -> Option<DVec3> {
        // Halved, no sum overflows.
        (self.low.x <= self.high.x).then(|| 0.5 * self.low + 0.5 * self.high)
    }
}
