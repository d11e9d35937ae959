//! Counts of the judge's decisions.

use glam::DVec3;

use super::judge::ExactHit;

/// The results for many cases, compared with the exact ones.
#[derive(Clone, Default)]
pub struct Tally {
    /// The number of cases so far.
    pub cases: usize,
    /// The number of reported hits that are misses.
    pub false_hits: usize,
    /// The number of hits that were not found.
    pub false_misses: usize,
    /// The errors of the distances of all correctly found hits, in units in the last place.
    pub distances: Vec<f64>,
    /// The largest angle between a normal and the exact one, in 2⁻⁵³ radians.
    pub worst_angle: f64,
}

impl Tally {
    /// Counts a case; returns the errors of distance and normal for a correctly found hit.
    pub fn count(&mut self, exact: Option<&ExactHit>, found: Option<(f64, DVec3)>) -> (f64, f64) {
        self.cases += 1;
        match (exact, found) {
            (None, None) => (0.0, 0.0),
            (None, Some(_)) => {
                self.false_hits += 1;
                (f64::INFINITY, f64::INFINITY)
            }
            (Some(_), None) => {
                self.false_misses += 1;
                (f64::INFINITY, f64::INFINITY)
            }
            (Some(exact), Some((t, normal))) => {
                let (distance, angle) = (exact.ulps(t), exact.angle(normal));
                self.distances.push(distance);
                self.worst_angle = self.worst_angle.max(angle);
                (distance, angle)
            }
        }
    }

    /// Adds the counts of other cases.
    pub fn add(&mut self, other: Self) {
        self.cases += other.cases;
        self.false_hits += other.false_hits;
        self.false_misses += other.false_misses;
        self.distances.extend(other.distances);
        self.worst_angle = self.worst_angle.max(other.worst_angle);
    }

    /// The largest error of a distance, in units in the last place.
    pub fn worst_distance(&self) -> f64 {
        self.distances.iter().copied().fold(0.0, f64::max)
    }
}
