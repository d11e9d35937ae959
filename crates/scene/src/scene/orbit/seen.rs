//! The distance of what a camera sees.

use marbles_core::{Ray, Sphere, View, parallel};

/// The number of columns of rays in the middle of the picture.
const COLUMNS: u32 = 9;
/// The share of the picture's sides that counts as its middle.
const MIDDLE: f64 = 0.5;

/// The median distance, along the axis of view, of the surfaces in the middle of a picture; in the whole picture, if
/// nothing is seen in its middle. `None` if nothing is seen at all.
pub(super) fn distance(view: &View, spheres: &[Sphere]) -> Option<f64> {
    median(view, spheres, MIDDLE).or_else(|| median(view, spheres, 1.0))
}

/// The same for a part of the picture's sides.
fn median(view: &View, spheres: &[Sphere], part: f64) -> Option<f64> {
    let lens = &view.lens;
    let aspect = f64::from(view.height) / f64::from(view.width) / lens.pixel_aspect;
    let rows = libm::round(f64::from(COLUMNS) * aspect).clamp(1.0, f64::from(COLUMNS)) as u32;
    let side = |index: u32, count: u32| (f64::from(index) + 0.5) / f64::from(count) - 0.5;
    let points = (0..rows).flat_map(|row| (0..COLUMNS).map(move |col| (col, row)));
    let rays: Vec<Ray> = points
        .map(|(col, row)| {
            let from_middle = glam::DVec2::new(side(col, COLUMNS), side(row, rows) * aspect);
            view.ray(lens.shift + part * lens.width * from_middle)
        })
        .collect();
    let camera = &view.camera;
    let nearest = |ray: &Ray| {
        let hits = parallel::map_pieces(spheres, |piece| {
            let hits = piece.iter().filter_map(|sphere| hit(ray, sphere));
            hits.reduce(f64::min)
        });
        let nearest = hits.into_iter().flatten().reduce(f64::min)?;
        let from_camera = ray.origin + nearest * ray.direction - camera.position;
        Some(from_camera.dot(camera.forward()))
    };
    let mut distances: Vec<f64> = rays.iter().filter_map(nearest).collect();
    distances.retain(|&distance| distance > 0.0 && distance.is_finite());
    let middle = distances.len().checked_sub(1)? / 2;
    let (_, median, _) = distances.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median)
}

/// Where a ray first meets a sphere in front of its origin, in multiples of its direction; rounded, as nothing but a
/// distance depends on it.
fn hit(ray: &Ray, sphere: &Sphere) -> Option<f64> {
    let to_center = sphere.center() - ray.origin;
    let length = ray.direction.length();
    let direction = ray.direction / length;
    let along = to_center.dot(direction);
    let beside = to_center - along * direction;
    let half_chord_sq = sphere.radius() * sphere.radius() - beside.length_squared();
    if half_chord_sq < 0.0 {
        return None;
    }
    let half_chord = half_chord_sq.sqrt();
    let mut hits = [along - half_chord, along + half_chord].into_iter();
    hits.find(|&at| at > 0.0).map(|at| at / length)
}
