//! Spheres that a cell does not see because another one fills it.

use glam::DVec2;

use super::candidate::Candidate;
use super::rectangle::Cell;
use crate::model::camera::Projection;

/// What rounding may move a distance by, in parts of the distance of a center.
const SLACK: f64 = 1e-6;

/// Removes the spheres that lie behind one through which all rays of a cell pass.
pub(crate) fn remove_hidden(candidates: &mut Vec<Candidate>, cell: &Cell, projection: Projection) {
    if candidates.len() < 2 {
        return;
    }
    let far = candidates
        .iter()
        .filter_map(|one| farthest(one, cell, projection));
    let far = far.fold(f64::INFINITY, f64::min);
    if far.is_finite() {
        candidates.retain(|one| nearest(one, cell, projection) <= far);
    }
}

/// A bound of how far away a sphere is seen in a cell; none if not all rays of the cell meet it from outside.
///
/// That is most for the ray that passes farthest from its center, and no ray of a cell does farther than one of its corners.
fn farthest(sphere: &Candidate, cell: &Cell, projection: Projection) -> Option<f64> {
    let mut farthest: f64 = 0.0;
    for u in cell.u {
        for v in cell.v {
            let (distance, is_inside) = sphere.distance(u, v, projection)?;
            if is_inside {
                return None;
            }
            let length = match projection {
                Projection::Central => (u * u + v * v + 1.0).sqrt(),
                Projection::Parallel => 1.0,
            };
            farthest = farthest.max(distance * length);
        }
    }
    Some(farthest + SLACK * sphere.center.length())
}

/// A bound of how near a sphere may be seen in a cell.
///
/// The distance of what a ray meets grows with the angle between the ray and the direction of the center.
fn nearest(sphere: &Candidate, cell: &Cell, projection: Projection) -> f64 {
    /// What rounding may move a ray by, in parts of the distance of a center.
    const ROUNDING: f64 = 1e-14;
    if sphere.outside <= 0.0 {
        return 0.0;
    }
    let middle = cell.middle();
    let half = 0.5 * DVec2::new(cell.u[1] - cell.u[0], cell.v[1] - cell.v[0]).length();
    match projection {
        Projection::Central => {
            // A ray turns by less than its end moves.
            let ray = middle.extend(1.0).normalize();
            let (sine, cosine) = (half.min(1.0), (1.0 - half.min(1.0).powi(2)).sqrt());
            let aside = ray.cross(sphere.center).length() * cosine
                - ray.dot(sphere.center) * sine
                - ROUNDING * sphere.center.length();
            let aside = aside.clamp(0.0, sphere.radius);
            // Rounding must not make it less than that of a ray that touches the sphere.
            let to_foot = (sphere.center.length_squared() - aside * aside).max(sphere.outside);
            let root = (sphere.radius * sphere.radius - aside * aside).sqrt();
            sphere.outside / (to_foot.sqrt() + root)
        }
        Projection::Parallel => {
            let aside = (middle - sphere.center.truncate()).length()
                - half
                - ROUNDING * sphere.center.length();
            let aside = aside.clamp(0.0, sphere.radius);
            let root = (sphere.radius * sphere.radius - aside * aside).sqrt();
            (sphere.center.z - root).max(0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;
    use crate::hit::ball::Ball;
    use crate::model::sphere::Sphere;

    /// The numbers of the candidates that are left.
    fn left(spheres: &[(DVec3, f64)], projection: Projection) -> Vec<usize> {
        let spheres = spheres
            .iter()
            .map(|&(center, radius)| Sphere::new(center, radius).unwrap());
        let spheres: Vec<Sphere> = spheres.collect();
        let balls = Ball::all((0..).zip(&spheres), DVec3::ZERO, 0);
        let candidates = balls
            .iter()
            .enumerate()
            .map(|(number, ball)| Candidate::new(ball, number, &DMat3::IDENTITY, None, true));
        let mut candidates: Vec<Candidate> = candidates.collect();
        let cell = Cell {
            u: [0.0, 0.1],
            v: [0.0, 0.1],
        };
        remove_hidden(&mut candidates, &cell, projection);
        candidates.iter().map(|one| one.number).collect()
    }

    #[test]
    fn spheres_behind_one_that_fills_a_cell_are_removed() {
        let at = |z: f64| DVec3::new(0.0, 0.0, z);
        let floor = (DVec3::new(0.0, -1e4, 5.0), 1e4 - 0.1);
        for projection in [Projection::Central, Projection::Parallel] {
            let spheres = [(at(9.0), 1.0), (at(5.0), 2.0), (at(2.9), 0.01), floor];
            assert_eq!(left(&spheres, projection), [1, 2]);
            // What begins in front of the far end of another one may be seen beside it, and what is around the eye.
            let spheres = [(at(5.0), 2.0), (at(4.5), 1.498), (at(1.0), 5.0)];
            assert_eq!(left(&spheres, projection), [0, 1, 2]);
        }
        // Right above a huge floor, which is seen from the eye to its horizon.
        let eye = DVec3::new(0.0, -1e9, 0.0);
        let spheres = [(eye, 1e9 - 1e-7), (at(20.0), 8.0)];
        assert_eq!(left(&spheres, Projection::Central), [0, 1]);
        // Not all rays meet it.
        let spheres = [(at(9.0), 1.0), (at(5.0), 0.2)];
        assert_eq!(left(&spheres, Projection::Central), [0, 1]);
    }
}
