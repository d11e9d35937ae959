//! Integrals over the directions that no sphere hides.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::arcs::CoveredArcs;
use super::cap::{Cap, Cover};

/// The caps that hide directions from a point, and memory to work in.
#[derive(Debug, Default)]
pub(crate) struct Hidden {
    caps: Vec<Cap>,
    arcs: CoveredArcs,
}

impl Hidden {
    pub(crate) fn clear(&mut self) {
        self.caps.clear();
    }

    pub(crate) fn add(&mut self, cap: Cap) {
        self.caps.push(cap);
    }

    pub(crate) fn len(&self) -> usize {
        self.caps.len()
    }

    /// Forgets the caps after the first `count`.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.caps.truncate(count);
    }

    /// Leaves out all caps that another one contains.
    pub(crate) fn leave_out_contained(&mut self) {
        let widest_first = |one: &Cap, other: &Cap| other.versine.total_cmp(&one.versine);
        self.caps.sort_unstable_by(widest_first);
        let mut kept = 0;
        for index in 0..self.caps.len() {
            let cap = self.caps[index];
            if !self.caps[..kept]
                .iter()
                .any(|wider| wider.contains(&cap, false))
            {
                self.caps[kept] = cap;
                kept += 1;
            }
        }
        self.caps.truncate(kept);
    }

    /// The integral of the directions ω, as vectors, over all that are not hidden. Its product with a normal n is the
    /// integral of n·ω.
    ///
    /// By Stokes' theorem the integral over a region of the sphere is ½ ∮ r × dr along its border. An arc from P to Q of the
    /// circle around a cap with the axis a contributes ½ P × Q and the segment between the arc and its chord, ½ s² (φ − sin φ) a,
    /// with the sine s of the cap's angle and the angle φ of the arc.
    pub(crate) fn seen(&mut self) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for index in 0..self.caps.len() {
            sum -= self.along(index, None, DVec3::ZERO);
        }
        sum
    }

    /// The same integral over the directions within a disc.
    ///
    /// # Accuracy
    /// Points of the border are measured from the middle of the disc, so that small discs lose no digits.
    pub(crate) fn seen_of(&mut self, disc: &Cap) -> DVec3 {
        let mut sum = self.along_disc(disc);
        for index in 0..self.caps.len() {
            sum -= self.along(index, Some(disc), disc.axis);
        }
        sum
    }

    /// The integral along the arcs of a cap's circle that no other cap hides, and that lie in a disc, if there is one.
    fn along(&mut self, index: usize, disc: Option<&Cap>, origin: DVec3) -> DVec3 {
        let cap = self.caps[index];
        let frame = cap.frame();
        self.arcs.clear();
        if let Some(disc) = disc {
            match cap.covered(&frame, disc, false) {
                Cover::Nothing => self.arcs.cover_all(),
                Cover::All => {}
                Cover::Arc([begin, end]) => self.arcs.cover([end, begin]),
            }
        }
        for (number, other) in self.caps.iter().enumerate() {
            if self.arcs.is_whole() {
                return DVec3::ZERO;
            }
            if number != index {
                cover(&mut self.arcs, cap.covered(&frame, other, index < number));
            }
        }
        integral(&mut self.arcs, &cap, origin)
    }

    /// The integral along the arcs of a disc's circle that no cap hides.
    fn along_disc(&mut self, disc: &Cap) -> DVec3 {
        let frame = disc.frame();
        self.arcs.clear();
        for cap in &self.caps {
            cover(&mut self.arcs, disc.covered(&frame, cap, false));
            if self.arcs.is_whole() {
                return DVec3::ZERO;
            }
        }
        integral(&mut self.arcs, disc, disc.axis)
    }
}

fn cover(arcs: &mut CoveredArcs, cover: Cover) {
    match cover {
        Cover::Nothing => {}
        Cover::All => arcs.cover_all(),
        Cover::Arc(points) => arcs.cover(points),
    }
}

/// ½ ∮ (r − o) × dr along the arcs of a circle that are not covered, counterclockwise.
fn integral(arcs: &mut CoveredArcs, cap: &Cap, origin: DVec3) -> DVec3 {
    let frame = cap.frame();
    let (mut sum, mut segments) = (DVec3::ZERO, 0.0);
    arcs.for_each_exposed(|ends| match ends {
        None => segments += TAU,
        Some(ends) => {
            let [begin, end] = ends.map(|at| cap.point(&frame, at, origin));
            sum += begin.cross(end);
            segments += segment(angle(ends));
        }
    });
    0.5 * (sum + cap.axis * (cap.sine * cap.sine * segments))
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
