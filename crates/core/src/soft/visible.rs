//! Integrals over the directions that no sphere hides.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::arcs::CoveredArcs;
use super::bodies::Bodies;
use super::cap::{Cap, Cover, Frame, Meeting};
use super::circles::{BLOCK, Circles};
use super::hemisphere::Hemisphere;
use super::point::SurfacePoint;
use crate::numeric::bits::set_bits;
use crate::numeric::pair::both;

/// The caps that hide directions from a point, and memory to work in.
#[derive(Debug, Default)]
pub(crate) struct Hidden {
    caps: Vec<Cap>,
    found: Vec<Cap>,
    /// The caps that were left, side by side.
    circles: Circles,
    arcs: CoveredArcs,
    /// How the last integral over all directions changes with the cosines of the caps whose circles are visible.
    slopes: Vec<(u32, DVec3)>,
}

/// What happens to the integral over visible directions if a cap changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Border {
    /// The part of the integral that its arcs contribute.
    part: DVec3,
    /// The derivative of the integral by the cosine of its angle.
    by_cosine: DVec3,
}

impl Hidden {
    pub(crate) fn clear(&mut self) {
        self.caps.clear();
    }

    pub(crate) fn add(&mut self, cap: Cap) {
        self.caps.push(cap);
    }

    /// Adds the caps of some spheres seen from a point, but for those of which it is known that others hide them. The sooner
    /// large ones come, the fewer are added.
    pub(crate) fn add_bodies(&mut self, bodies: &Bodies, point: &SurfacePoint) {
        let mut caps = std::mem::take(&mut self.found);
        caps.clear();
        bodies.caps(point.position, point.normal, &mut caps);
        let mut above = Hemisphere::new(point.normal, 0.0);
        self.circles.clear();
        for cap in &caps {
            if self.caps.len() < BLOCK {
                self.circles.push(cap);
            } else if self.circles.block(cap, 0).around != 0 {
                continue;
            }
            if !above.is_hidden(cap) && cap.axis.dot(point.shading) > -cap.sine {
                above.hide(cap);
                self.caps.push(*cap);
            }
        }
        self.found = caps;
    }

    pub(crate) fn len(&self) -> usize {
        self.caps.len()
    }

    /// Forgets the caps after the first `count`.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.caps.truncate(count);
    }

    /// Puts the caps side by side.
    fn arrange(&mut self) {
        self.circles.clear();
        for cap in &self.caps {
            self.circles.push(cap);
        }
    }

    /// The integral of the directions ω, as vectors, over all that are not hidden. Its product with a normal n is the
    /// integral of n·ω.
    ///
    /// By Stokes' theorem the integral over a region of the sphere is ½ ∮ r × dr along its border. An arc from P to Q of the
    /// circle around a cap with the axis a contributes ½ P × Q and the segment between the arc and its chord, ½ s² (φ − sin φ) a,
    /// with the sine s of the cap's angle and the angle φ of the arc.
    pub(crate) fn seen(&mut self) -> DVec3 {
        self.arrange();
        self.slopes.clear();
        let mut sum = DVec3::ZERO;
        for index in 0..self.caps.len() {
            if let Some(border) = self.along(index, None, DVec3::ZERO) {
                sum -= border.part;
                self.slopes
                    .push((self.caps[index].sphere, border.by_cosine));
            }
        }
        sum
    }

    /// The spheres whose circles are visible, with the derivatives of the last [`seen`](Self::seen) by the cosines of their caps.
    pub(crate) fn slopes(&self) -> &[(u32, DVec3)] {
        &self.slopes
    }

    /// The same integral over the directions within a disc.
    ///
    /// # Accuracy
    /// Points of the border are measured from the middle of the disc, so that small discs lose no digits.
    pub(crate) fn seen_of(&mut self, disc: &Cap) -> DVec3 {
        self.arrange();
        let mut sum = self.along_disc(disc);
        for index in 0..self.caps.len() {
            if let Some(border) = self.along(index, Some(disc), disc.axis) {
                sum -= border.part;
            }
        }
        sum
    }

    /// What the arcs of a cap's circle that no other cap hides, and that lie in a disc, if there is one, contribute; none if
    /// there are no such arcs.
    fn along(&mut self, index: usize, disc: Option<&Cap>, origin: DVec3) -> Option<Border> {
        let Self {
            caps,
            circles,
            arcs,
            ..
        } = self;
        let cap = caps[index];
        let frame = cap.frame();
        arcs.clear();
        if let Some(disc) = disc {
            match cap.covered(&frame, disc, false) {
                Cover::Nothing => return None,
                Cover::All => {}
                Cover::Arc([begin, end]) => arcs.cover([end, begin]),
            }
        }
        for block in 0..circles.blocks() {
            let found = circles.block(&cap, block);
            if found.around != 0 {
                return None;
            }
            for bit in set_bits(found.unsure) {
                let number = block * BLOCK + bit;
                if number == index {
                    continue;
                }
                match cap.meeting(&caps[number], index < number) {
                    Meeting::Apart => {}
                    Meeting::Inside => return None,
                    Meeting::Crossing(crossing) => {
                        arcs.cover(crossing.ends(&frame));
                        if arcs.is_whole() {
                            return None;
                        }
                    }
                }
            }
        }
        Some(integral(arcs, &cap, &frame, origin))
    }

    /// The integral along the arcs of a disc's circle that no cap hides.
    fn along_disc(&mut self, disc: &Cap) -> DVec3 {
        let frame = disc.frame();
        self.arcs.clear();
        for cap in &self.caps {
            match disc.covered(&frame, cap, false) {
                Cover::Nothing => {}
                Cover::All => return DVec3::ZERO,
                Cover::Arc(points) => self.arcs.cover(points),
            }
            if self.arcs.is_whole() {
                return DVec3::ZERO;
            }
        }
        integral(&self.arcs, disc, &frame, disc.axis).part
    }
}

/// ½ ∮ (r − o) × dr and ∫ r dφ along the arcs of a circle that are not covered, counterclockwise.
fn integral(arcs: &CoveredArcs, cap: &Cap, frame: &Frame, origin: DVec3) -> Border {
    let (mut sum, mut segments, mut angles) = (DVec3::ZERO, 0.0, 0.0);
    let mut chords = DVec2::ZERO;
    arcs.for_each_exposed(|ends| match ends {
        None => {
            segments += TAU;
            angles += TAU;
        }
        Some(ends) => {
            let [begin, end] = both(ends, |at| cap.point(frame, at, origin));
            sum += begin.cross(end);
            let angle = angle(ends);
            segments += segment(angle);
            angles += angle;
            chords += ends[1] - ends[0];
        }
    });
    Border {
        part: 0.5 * (sum + cap.axis * (cap.sine * cap.sine * segments)),
        by_cosine: cap.axis * (cap.cosine * angles)
            + (frame.x * chords.y - frame.y * chords.x) * cap.sine,
    }
}

/// The angle from a unit vector counterclockwise to another, from 0 to a turn.
fn angle([begin, end]: [DVec2; 2]) -> f64 {
    let angle = libm::atan2(begin.perp_dot(end), begin.dot(end));
    if angle < 0.0 { angle + TAU } else { angle }
}

/// φ − sin φ.
fn segment(angle: f64) -> f64 {
    if angle > 0.5 {
        return angle - libm::sin(angle);
    }
    // φ³/3! − φ⁵/5! + …, to 2⁻⁶⁰ of the first term.
    let square = angle * angle;
    let mut sum = 0.0;
    for order in [15.0, 13.0, 11.0, 9.0, 7.0, 5.0] {
        sum = square / (order * (order - 1.0)) * (1.0 - sum);
    }
    square * angle / 6.0 * (1.0 - sum)
}

/// The share of a disc's light that a surface receives: the integral of max(0, n·ω) over the visible part of the disc,
/// divided by its solid angle.
pub(crate) fn share_of(seen: DVec3, normal: DVec3, disc: &Cap) -> f64 {
    (seen.dot(normal) / disc.solid_angle()).max(0.0)
}

/// The share of the light of a sky of radiance 1.
pub(crate) fn sky_share(seen: DVec3, normal: DVec3) -> f64 {
    (seen.dot(normal) / PI).max(0.0)
}

#[cfg(test)]
mod tests;
