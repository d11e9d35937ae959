//! The spheres in a cone of directions, seen from a point, or in a ball.

use glam::DVec3;

use super::hierarchy::boxes::Boxes;
use super::hierarchy::order::WIDTH;
use super::hierarchy::{BoxTest, Hierarchy, is_sphere};
use crate::model::sphere::Sphere;

/// Directions from a point, and from all points within some distance of it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Beyond {
    /// Within a ball.
    Ball { center: DVec3, radius: f64 },
    /// Within a ball, but not all of it within the inner one.
    Shell {
        center: DVec3,
        inner: f64,
        outer: f64,
    },
    /// Within the angle of this sine and cosine, at most a right one, of a unit vector.
    Cone {
        apex: DVec3,
        around: f64,
        axis: DVec3,
        sine: f64,
        cosine: f64,
    },
}

/// What rounding may move a sphere by, in parts of its distance.
const SLACK: f64 = 1e-12;

impl Beyond {
    /// True if a sphere may reach into these directions.
    pub(crate) fn is_reached_by(&self, center: DVec3, radius: f64) -> bool {
        match *self {
            Self::Ball {
                center: middle,
                radius: around,
            } => {
                let slack = SLACK * (center.abs().max_element() + middle.abs().max_element());
                (center - middle).length() <= radius + around + slack
            }
            Self::Shell {
                center: middle,
                inner,
                outer,
            } => {
                let slack = SLACK * (center.abs().max_element() + middle.abs().max_element());
                let distance = (center - middle).length();
                distance <= radius + outer + slack && distance + radius + slack >= inner
            }
            Self::Cone {
                apex,
                around,
                axis,
                sine,
                cosine,
            } => {
                let to_center = center - apex;
                let along = to_center.dot(axis);
                let aside = (to_center - axis * along).length();
                let slack = SLACK * (to_center.abs().max_element() + apex.abs().max_element());
                let reach = radius + around + slack;
                // Behind the apex the nearest point of the cone is the apex.
                if along * cosine + aside * sine < 0.0 {
                    to_center.length_squared() <= reach * reach
                } else {
                    aside * cosine - along * sine <= reach
                }
            }
        }
    }

    fn boxes(&self, boxes: &Boxes) -> BoxTest {
        let mut tested = BoxTest {
            may: 0,
            keys: [0.0; WIDTH],
        };
        for place in 0..WIDTH {
            let corner = |of: &[[f32; WIDTH]; 3]| {
                DVec3::new(
                    of[0][place].into(),
                    of[1][place].into(),
                    of[2][place].into(),
                )
            };
            let (low, high) = (corner(&boxes.low), corner(&boxes.high));
            let (center, half) = (0.5 * (low + high), 0.5 * (high - low));
            let may = self.is_reached_by(center, half.length());
            tested.may |= u8::from(may) << place;
        }
        tested
    }
}

impl Hierarchy {
    /// Calls `visit` with all spheres that may reach into some directions.
    pub(crate) fn for_each_beyond(
        &self,
        spheres: &[Sphere],
        beyond: &Beyond,
        visit: &mut dyn FnMut(usize),
    ) {
        self.any_beyond(spheres, beyond, &mut |index| {
            visit(index);
            false
        });
    }

    /// Says whether something holds for any of them; none is asked after one for which it holds.
    pub(crate) fn any_beyond(
        &self,
        spheres: &[Sphere],
        beyond: &Beyond,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        self.any(
            |boxes| beyond.boxes(boxes),
            |group| {
                for &index in self
                    .indices(group)
                    .iter()
                    .filter(|&&index| is_sphere(index))
                {
                    let sphere = &spheres[index as usize];
                    let is_reached = beyond.is_reached_by(sphere.center(), sphere.radius());
                    if is_reached && holds(index as usize) {
                        return true;
                    }
                }
                false
            },
        )
    }
}

#[cfg(test)]
mod tests;
