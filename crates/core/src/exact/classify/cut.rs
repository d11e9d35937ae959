//! Spheres that the plane cuts in which parallel rays begin.

use super::active::{Active, Terminators};
use super::contents::{Contents, NARROWEST, ROUNDINGS};
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::exact::scene::{InCamera, Light};
use crate::numeric::rounding::GEOMETRY_SLACK;

/// Where the parallel rays of a cell begin, as a sphere sees it that the plane of their beginnings cuts.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Begin {
    Inside,
    Outside,
    /// Some inside, or that is not known.
    Either,
}

impl Begin {
    fn of(cell: &Cell, ball: &Ball) -> Self {
        let z = ball.center.z;
        let mut inside = silhouette(cell, ball);
        let (at_center, spread) = (inside.one, inside.spread());
        inside.one -= z * z;
        let size = cell.extent() + ball.outline_scale(cell);
        let slack = GEOMETRY_SLACK * (spread + at_center.abs() + z * z)
            + 4.0 * ROUNDINGS * size * (ball.radius + z.abs());
        if inside.one + spread + slack < 0.0 {
            Self::Outside
        } else if inside.one - spread - slack > 0.0 {
            Self::Inside
        } else {
            Self::Either
        }
    }
}

/// Returns whether all parallel rays of a cell begin inside of a sphere: of other spheres they see what is inside of it too,
/// where no light gets that is outside.
pub(super) fn begins_inside(cell: &Cell, ball: &Ball) -> bool {
    ball.is_cut() && Begin::of(cell, ball) == Begin::Inside
}

/// Returns whether all rays of a cell that see an outer side begin inside of all spheres around a point light.
fn is_inside_with(scene: &InCamera<'_>, cell: &Cell, light: &Light) -> bool {
    let around = scene.visibility.point_light(light.index);
    let around = around.map_or(&[][..], |occluders| occluders.enclosing());
    around.iter().all(|&sphere| {
        // Where some rays begin outside, those that begin inside see the inner side alone.
        begins_inside(cell, &scene.ball(sphere))
    })
}

impl Contents {
    /// Takes in a sphere that the plane cuts. As the cell sees it the ball is then one that all rays begin outside of, or
    /// inside; returns false where it is not seen, or not known yet.
    pub(super) fn take_cut(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        (sphere, ball): (usize, &mut Ball),
    ) -> bool {
        match Begin::of(cell, ball) {
            // Rays meet its outer side, or pass it.
            Begin::Outside => {
                ball.outside = ball.center.z;
                ball.center.z > 0.0
            }
            Begin::Inside => {
                self.is_enclosed |= scene.world.shadows;
                true
            }
            Begin::Either => {
                self.cut.push((sphere, *ball));
                false
            }
        }
    }

    /// The lights, as bits, that reach outer sides in the cell, as far as spheres around the beginnings of its rays and
    /// around the lights tell.
    pub(super) fn lights_that_reach(&self, scene: &InCamera<'_>, cell: &Cell) -> u64 {
        let reaches = |light: &Light| match light.near {
            None => !light.is_shut_off && !self.is_enclosed,
            Some(_) if !light.is_shut_off => true,
            Some(_) => cell.is_parallel() && is_inside_with(scene, cell, light),
        };
        let lights = scene.lights.iter().enumerate();
        lights.fold(0, |bits, (index, light)| {
            bits | u64::from(reaches(light)) << index
        })
    }

    /// Adds the spheres of which some rays of the cell begin inside: there, where nothing else lies inside of one, its
    /// inner side is what a dark ball before all else would be, behind whose outline its outer side is seen.
    pub(super) fn add_caps(&mut self, scene: &InCamera<'_>, cell: &Cell) {
        let [(sphere, ball)] = self.cut[..] else {
            self.is_mixed = !self.cut.is_empty();
            return;
        };
        let reaches_in = |active: &Active| {
            let apart = (active.ball.center - ball.center).length();
            apart < (active.ball.radius + ball.radius) * (1.0 + GEOMETRY_SLACK)
        };
        if self.active.iter().any(reaches_in) || self.is_enclosed {
            self.is_mixed = true;
            return;
        }
        let z = ball.center.z;
        let radius = ((ball.radius - z) * (ball.radius + z)).max(0.0).sqrt();
        let size = cell.size[0].min(cell.size[1]);
        // Rounding moves the outline of a thin cap by more than the plane.
        let moved = ROUNDINGS * (ball.center.length() + ball.radius) * ball.radius;
        self.rounding = self.rounding.max(moved / (radius.max(moved.sqrt()) * size));
        let outer = Ball { outside: z, ..ball };
        let center = ball.center.with_z(-(2.0 * ball.radius + radius));
        let cap = Ball {
            center,
            radius,
            outside: f64::MIN_POSITIVE,
            power: center.length_squared() - radius * radius,
            ..ball
        };
        let width = 2.0 * radius / size;
        let is_resolved = width > NARROWEST;
        if !is_resolved {
            self.rounding += width * width;
        }
        for (ball, is_dark) in [(outer, false), (cap, true)] {
            let is_seen = if is_dark { is_resolved } else { z > 0.0 };
            if is_seen {
                self.active.push(Active {
                    sphere,
                    ball,
                    discriminant: silhouette(cell, &ball),
                    along: cell.along(ball.center),
                    terminators: if is_dark {
                        Terminators::Plain
                    } else {
                        Terminators::of(scene, sphere, self.pixel)
                    },
                    is_dark,
                });
            }
        }
    }
}
