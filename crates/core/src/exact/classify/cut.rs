//! Spheres that the plane cuts in which parallel rays begin.

use super::active::{Active, Terminators};
use super::contents::{Contents, NARROWEST, ROUNDINGS};
use super::cut_side::CutSide;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::exact::scene::{InCamera, Light};
use crate::numeric::polynomial::Quadratic;
use crate::numeric::rounding::GEOMETRY_SLACK;

/// The place where the parallel rays of a cell begin, as seen by a sphere that the plane of their beginnings cuts.
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
        let size = cell.extent() + ball.contour_scale(cell);
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

/// The part of a cell's plane that a sphere cuts out of it, as a dark ball before all else.
struct Cap {
    ball: Ball,
    discriminant: Quadratic,
    /// A bound of how far rounding moves its contour, times the radius.
    moved: f64,
}

impl Cap {
    fn of(cell: &Cell, ball: &Ball) -> Self {
        let z = ball.center.z;
        let radius = ((ball.radius - z) * (ball.radius + z)).max(0.0).sqrt();
        // All of its near side lies before the plane, and so before all that is seen; no farther than lengths beside which
        // K is known anyway.
        let ahead = z.abs() + cell.extent() + cell.size[0] + cell.size[1];
        let cap = Ball {
            center: ball.center.with_z(-ahead),
            radius,
            outside: f64::MIN_POSITIVE,
            power: ball.power + ahead * ahead,
            projection: ball.projection,
        };
        let terms = if cap.is_apart() {
            (ball.center.length() + ball.radius) * ball.radius
        } else {
            cap.contour_scale(cell) * radius
        };
        Self {
            ball: cap,
            discriminant: silhouette(cell, &cap),
            moved: ROUNDINGS * terms,
        }
    }

    /// Whether the cell may see a ball with this discriminant and the cap as well.
    fn may_be_beside(&self, discriminant: &Quadratic) -> bool {
        let may_be = |discriminant: &Quadratic| {
            let most = discriminant.one + discriminant.spread();
            let slack = GEOMETRY_SLACK * (discriminant.spread() + discriminant.one.abs());
            most + slack + 2.0 * self.moved > 0.0
        };
        may_be(discriminant) && may_be(&self.discriminant)
    }
}

impl Contents {
    /// Returns whether all parallel rays of a cell begin inside of a sphere: of other spheres they see what is inside of it
    /// too, where no light gets that is outside.
    pub(super) fn begins_inside(&self, cell: &Cell, (sphere, ball): (usize, &Ball)) -> bool {
        match self.side {
            Some((cut, side)) if cut == sphere => side.is_inner(),
            _ => ball.is_cut() && Begin::of(cell, ball) == Begin::Inside,
        }
    }

    /// Returns whether all rays of a cell begin outside of a sphere, or those that the cell is seen by.
    pub(super) fn begins_outside(&self, cell: &Cell, (sphere, ball): (usize, &Ball)) -> bool {
        match self.side {
            Some((cut, side)) if cut == sphere => !side.is_inner(),
            _ => ball.outside > 0.0 || ball.is_cut() && Begin::of(cell, ball) == Begin::Outside,
        }
    }

    /// Returns whether all rays of a cell that see an outer side begin inside of all spheres around a point light.
    fn is_inside_with(&self, scene: &InCamera<'_>, cell: &Cell, light: &Light) -> bool {
        let around = scene.visibility.point_light(light.index);
        let around = around.map_or(&[][..], |occluders| occluders.enclosing());
        around.iter().all(|&sphere| {
            // Where some rays begin outside, those that begin inside see the inner side alone.
            self.begins_inside(cell, (sphere, &scene.ball(sphere)))
        })
    }

    /// Takes in a sphere that the plane cuts. As the cell sees it the ball is then one that all rays begin outside of, or
    /// inside; returns false where it is not seen, or not known yet.
    pub(super) fn take_cut(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        (sphere, ball): (usize, &mut Ball),
    ) -> bool {
        let begin = match self.side {
            Some((cut, side)) if cut == sphere => {
                if side != CutSide::Inner {
                    self.cut.push((sphere, *ball));
                }
                match side.is_inner() {
                    true => Begin::Inside,
                    false => Begin::Outside,
                }
            }
            _ => Begin::of(cell, ball),
        };
        match begin {
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
            Some(_) => cell.is_parallel() && self.is_inside_with(scene, cell, light),
        };
        let lights = scene.lights.iter().enumerate();
        lights.fold(0, |bits, (index, light)| {
            bits | u64::from(reaches(light)) << index
        })
    }

    /// Adds the spheres of which some rays of the cell begin inside: there, where nothing else lies inside of one, its
    /// inner side is what a dark ball before all else would be, behind whose contour its outer side is seen.
    pub(super) fn add_caps(&mut self, scene: &InCamera<'_>, cell: &Cell) {
        let [(sphere, ball)] = self.cut[..] else {
            self.is_mixed = !self.cut.is_empty();
            return;
        };
        let cap = Cap::of(cell, &ball);
        if self.side.is_none() {
            let reaches_in = |active: &Active| {
                let apart = (active.ball.center - ball.center).length();
                apart < (active.ball.radius + ball.radius) * (1.0 + GEOMETRY_SLACK)
                    && cap.may_be_beside(&active.discriminant)
            };
            if self.active.iter().any(reaches_in) || self.is_enclosed {
                self.is_mixed = true;
                return;
            }
            let z = ball.center.z;
            if z > 0.0 {
                let outer = Ball { outside: z, ..ball };
                self.active.push(Active {
                    sphere,
                    ball: outer,
                    discriminant: silhouette(cell, &outer),
                    along: cell.along(ball.center),
                    terminators: Terminators::of(scene, sphere, self.pixel),
                    is_dark: false,
                });
            }
        }
        self.add_cap(cell, sphere, &cap);
    }

    fn add_cap(&mut self, cell: &Cell, sphere: usize, cap: &Cap) {
        let size = cell.size[0].min(cell.size[1]);
        let (radius, moved) = (cap.ball.radius, cap.moved);
        // Rounding moves the contour of a thin cap by more than the plane.
        self.rounding = self.rounding.max(moved / (radius.max(moved.sqrt()) * size));
        let width = 2.0 * radius / size;
        if width <= NARROWEST {
            self.rounding += width * width;
            return;
        }
        self.active.push(Active {
            sphere,
            ball: cap.ball,
            discriminant: cap.discriminant,
            along: cell.along(cap.ball.center),
            terminators: Terminators::Plain,
            is_dark: true,
        });
    }

    /// The one sphere that some rays of the cell begin inside of, and others not, unless the cell is beside it: then the cell
    /// is known by its [`CutSide`]s. Its contour may lie in the cell, so near to the cap's that no parts tell them apart.
    pub(crate) fn divided_by(&self, cell: &Cell) -> Option<usize> {
        let [(sphere, ball)] = self.cut[..] else {
            return None;
        };
        let discriminant = silhouette(cell, &ball);
        let (one, spread) = (discriminant.one, discriminant.spread());
        let moved = ROUNDINGS * ball.contour_scale(cell) * ball.radius;
        let slack = GEOMETRY_SLACK * (spread + one.abs()) + 4.0 * moved;
        let is_known = self.is_mixed && !self.is_crowded && self.side.is_none();
        (is_known && (one - spread - slack > 0.0 || discriminant.may_vanish())).then_some(sphere)
    }
}
