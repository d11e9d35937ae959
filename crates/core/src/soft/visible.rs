//! Integrals over the directions that no sphere hides.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::arcs::{Arcs, End};
use super::bodies::Bodies;
use super::cap::{Cap, Frame, Meeting};
use super::circles::Circles;
use super::lens::{left_of, segment};
use super::point::SurfacePoint;
use crate::numeric::pair::both;

/// The caps that hide directions from a point, and memory to work in.
#[derive(Debug, Default)]
pub(crate) struct Hidden {
    caps: Vec<Cap>,
    found: Vec<Cap>,
    /// The caps that were left, side by side.
    circles: Circles,
    arcs: Arcs,
    /// How the last integral over all directions changes with the caps whose circles are visible.
    slopes: Vec<CapSlope>,
}

/// How the product of the integral over visible directions with a vector changes with a cap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CapSlope {
    pub(crate) cap: Cap,
    /// The first and the second derivative by the cosine of its angle.
    pub(crate) by_cosine: f64,
    pub(crate) twice_by_cosine: f64,
    /// That by its axis, a vector across the axis.
    pub(crate) by_axis: DVec3,
}

/// The arcs of a circle that no cap covers.
#[derive(Clone, Copy, Debug, Default)]
struct Border {
    /// ½ ∮ (r − o) × dr.
    part: DVec3,
    /// The integrals of 1, of cos φ and sin φ, and of ½ cos 2 φ and ½ sin 2 φ.
    angles: f64,
    first: DVec2,
    second: DVec2,
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
        self.circles.clear();
        for cap in &caps {
            if self.circles.contain(cap) || cap.axis.dot(point.shading) <= -cap.sine {
                continue;
            }
            self.circles.push(cap);
            self.caps.push(*cap);
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
    ///
    /// [`slopes`](Self::slopes) tells how its product with `normal` changes.
    pub(crate) fn seen(&mut self, normal: DVec3) -> DVec3 {
        self.arrange();
        self.slopes.clear();
        let mut sum = DVec3::ZERO;
        for index in 0..self.caps.len() {
            if let Some(border) = self.along(index, None, DVec3::ZERO) {
                sum -= border.part;
                let mut slope = border.slope(&self.caps[index], normal);
                slope.twice_by_cosine += self.by_ends(&slope.cap, normal);
                self.slopes.push(slope);
            }
        }
        sum
    }

    /// How the integral of n·r along the last circle's arcs changes with the cosine of its cap because their ends move along the
    /// circles that cross there.
    fn by_ends(&self, cap: &Cap, normal: DVec3) -> f64 {
        /// Where circles cross under a smaller angle, ends move too fast to tell.
        const LEAST: f64 = 1e-3;
        let frame = cap.frame();
        let moved = |end: &End| {
            let point = cap.point(&frame, end.at, DVec3::ZERO);
            let other = &self.caps[end.cap];
            // Along the other circle the cosine changes by this part of a step.
            let change = cap.axis.dot(other.axis.cross(point));
            if change.abs() <= LEAST * cap.sine * other.sine {
                return 0.0;
            }
            let turn = cap.axis.dot(other.axis) - cap.cosine * other.cosine;
            normal.dot(point) * turn / (cap.sine * cap.sine * change)
        };
        let mut sum = 0.0;
        for arc in self.arcs.exposed() {
            let [begin, end] = &arc.ends;
            sum += moved(end) - moved(begin);
        }
        sum
    }

    /// The caps whose circles are visible, with the derivatives of what the last [`seen`](Self::seen) found.
    pub(crate) fn slopes(&self) -> &[CapSlope] {
        &self.slopes
    }

    /// The same integral over the directions within a disc.
    ///
    /// # Accuracy
    /// Points of the border are measured from the middle of the disc, so that small discs lose no digits.
    pub(crate) fn seen_of(&mut self, disc: &Cap) -> DVec3 {
        if let [cap] = &self.caps[..]
            && let Some(left) = left_of(disc, cap)
        {
            return left;
        }
        self.seen_by_arcs_of(disc)
    }

    /// The same, by the arcs that any number of caps leave.
    pub(super) fn seen_by_arcs_of(&mut self, disc: &Cap) -> DVec3 {
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
        let cap = self.caps[index];
        let frame = cap.frame();
        self.arcs.clear();
        if let Some(disc) = disc {
            match cap.meeting(disc, false) {
                Meeting::Apart => return None,
                Meeting::Inside => {}
                Meeting::Crossing(crossing) => self.arcs.cover_rest(&crossing, &frame, index),
            }
        }
        self.exposed(&cap, &frame, Some(index), origin)
    }

    /// The integral along the arcs of a disc's circle that no cap hides.
    fn along_disc(&mut self, disc: &Cap) -> DVec3 {
        self.arcs.clear();
        let border = self.exposed(disc, &disc.frame(), None, disc.axis);
        border.map_or(DVec3::ZERO, |border| border.part)
    }

    /// What the arcs of a circle that no cap hides contribute, of which some may be covered; none if there are none.
    fn exposed(
        &mut self,
        cap: &Cap,
        frame: &Frame,
        index: Option<usize>,
        origin: DVec3,
    ) -> Option<Border> {
        let is_exposed = self
            .circles
            .expose((cap, frame), &self.caps, index, &mut self.arcs);
        is_exposed.then(|| integral(&self.arcs, cap, frame, origin))
    }
}

/// The integrals along the arcs of a circle that are not covered, counterclockwise; r is measured from `origin`.
fn integral(arcs: &Arcs, cap: &Cap, frame: &Frame, origin: DVec3) -> Border {
    let mut border = Border::default();
    let (mut chords, mut segments) = (DVec3::ZERO, 0.0);
    for arc in arcs.exposed() {
        let ends = both(arc.ends, |end| end.at);
        let points = both(ends, |at| cap.point(frame, at, origin));
        chords += points[0].cross(points[1]);
        let angle = arc.angle();
        segments += segment(angle);
        border.angles += angle;
        let [begin, end] = ends;
        border.first += (begin - end).perp();
        border.second.x += 0.5 * (end.x * end.y - begin.x * begin.y);
        border.second.y += 0.5 * (end.y * end.y - begin.y * begin.y);
    }
    if arcs.exposed().is_empty() {
        segments = TAU;
        border.angles = TAU;
    }
    border.part = 0.5 * (chords + cap.axis * (cap.sine * cap.sine * segments));
    border
}

impl Border {
    /// What follows for the product of the integral over visible directions with a vector, while ends stay where they are.
    ///
    /// Where a cap grows by the angle δ at the angle φ of its circle, the integral loses ∫ r s δ dφ, with the sine s of its
    /// angle. Its cosine falls by s δ, and if its axis moves by a vector v, then δ is the product of v with the unit vector
    /// from the axis to the point of the circle.
    fn slope(&self, cap: &Cap, normal: DVec3) -> CapSlope {
        let frame = cap.frame();
        let up = cap.cosine * normal.dot(cap.axis);
        let DVec2 { x, y } = DVec2::new(normal.dot(frame.x), normal.dot(frame.y)) * cap.sine;
        let along = x * self.first.x + y * self.first.y;
        let half = 0.5 * self.angles;
        let DVec2 { x: twice, y: mixed } = self.second;
        let toward = self.first * up
            + DVec2::new(
                x * (half + twice) + y * mixed,
                x * mixed + y * (half - twice),
            );
        CapSlope {
            cap: *cap,
            by_cosine: up * self.angles + along,
            // The points of the circle move along the axis, and toward it.
            twice_by_cosine: normal.dot(cap.axis) * self.angles
                - along * (cap.cosine / (cap.sine * cap.sine)),
            by_axis: (frame.x * toward.x + frame.y * toward.y) * -cap.sine,
        }
    }
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
