//! The circles in which spheres meet.

use glam::DVec3;

use super::candidate::Candidate;
use crate::model::camera::Projection;

/// The circle in which two spheres meet, in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seam {
    pub(crate) center: DVec3,
    /// The unit vector across its plane.
    pub(crate) normal: DVec3,
    pub(crate) radius_sq: f64,
}

impl Seam {
    /// That of two spheres, if they meet.
    ///
    /// From the center of the smaller one, with the radius r, its plane is (K + r²)/(2 d) away, where d is the distance of the
    /// centers and K that of the smaller center from the larger sphere, as the difference of squares. Of two formulas for K
    /// the better one is taken: relative to the eye, or to the larger center.
    pub(crate) fn new(one: &Candidate, other: &Candidate) -> Option<Self> {
        let (small, large) = if one.radius < other.radius {
            (one, other)
        } else {
            (other, one)
        };
        let between = large.center - small.center;
        let distance = between.length();
        let from_eye = large.center.length() * small.center.length();
        let apart = if from_eye < large.radius * large.radius {
            large.outside - 2.0 * large.center.dot(small.center) + small.center.length_squared()
        } else {
            (distance - large.radius) * (distance + large.radius)
        };
        let along = (apart + small.radius * small.radius) / (2.0 * distance);
        let radius_sq = (small.radius - along) * (small.radius + along);
        let normal = between / distance;
        (radius_sq > 0.0 && normal.is_finite()).then(|| Self {
            center: small.center + normal * along,
            normal,
            radius_sq,
        })
    }

    /// Finds all of a set of spheres.
    pub(crate) fn all(candidates: &[Candidate], seams: &mut Vec<Self>) {
        seams.clear();
        for (place, candidate) in candidates.iter().enumerate() {
            let others = candidates[..place].iter();
            seams.extend(others.filter_map(|other| Self::new(candidate, other)));
        }
    }

    /// The seam with rows and columns exchanged.
    pub(crate) fn transposed(&self) -> Self {
        let turned = |of: DVec3| DVec3::new(of.y, of.x, of.z);
        Self {
            center: turned(self.center),
            normal: turned(self.normal),
            ..*self
        }
    }

    /// Adds the places at which it crosses the line at the height `v`.
    ///
    /// The rays through the line are the plane of the points p with m·p = h.
    pub(crate) fn add_ends(&self, v: f64, projection: Projection, ends: &mut Vec<f64>) {
        let (m, h) = match projection {
            Projection::Central => (DVec3::new(0.0, 1.0, -v), 0.0),
            Projection::Parallel => (DVec3::Y, v),
        };
        let within = m - self.normal * m.dot(self.normal);
        let steep = within.length_squared();
        let apart = h - m.dot(self.center);
        let half_sq = self.radius_sq - apart * apart / steep;
        if half_sq.is_nan() || half_sq < 0.0 {
            return;
        }
        let nearest = self.center + within * (apart / steep);
        let half = self.normal.cross(within) * (half_sq / steep).sqrt();
        for point in [nearest - half, nearest + half] {
            ends.push(match projection {
                Projection::Central if point.z > 0.0 => point.x / point.z,
                Projection::Central => continue,
                Projection::Parallel => point.x,
            });
        }
    }
}

#[cfg(test)]
mod tests;
