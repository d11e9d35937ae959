use glam::DVec3;

use super::{OutlineView, OutlineWidth};
use crate::model::camera::Projection;

const PIXEL: f64 = 0.01;

fn inner(width: OutlineWidth, projection: Projection, center: DVec3, radius: f64) -> f64 {
    let view = OutlineView {
        pixel: PIXEL,
        projection,
    };
    width.inner_radius(view, center, radius)
}

#[test]
fn a_width_in_pixels_is_seen_on_the_axis_of_view() {
    for (distance, radius) in [(10.0, 1.0), (3.0, 2.0), (1e4, 800.0)] {
        let center = DVec3::Z * distance;
        let smaller = inner(
            OutlineWidth::Pixels(1.5),
            Projection::Central,
            center,
            radius,
        );
        // The outlines of both spheres on the plane at distance 1.
        let seen = |radius: f64| radius / ((distance - radius) * (distance + radius)).sqrt();
        let width = (seen(radius) - seen(smaller)) / PIXEL;
        assert!((width - 1.5).abs() < 1e-8, "{width} at {distance}");
    }
}

#[test]
fn off_the_axis_it_counts_across_the_direction_to_it() {
    let center = DVec3::new(6.0, 0.0, 8.0);
    let smaller = inner(OutlineWidth::Pixels(2.0), Projection::Central, center, 0.01);
    // Small spheres have an outline of so many pixels at the depth of their center.
    let width = (0.01 - smaller) / (8.0 * PIXEL);
    assert_eq!(smaller, 0.0, "{width}");
    let smaller = inner(OutlineWidth::Pixels(2.0), Projection::Central, center, 0.5);
    let tangent = |radius: f64| radius / (100.0 - radius * radius).sqrt();
    let across = (tangent(0.5) - tangent(smaller)) / 0.8 / PIXEL;
    assert!((across - 2.0).abs() < 1e-9, "{across}");
}

#[test]
fn widths_in_units_and_of_parallel_rays_are_those_of_radii() {
    let center = DVec3::new(1.0, 2.0, 30.0);
    for projection in [Projection::Central, Projection::Parallel] {
        assert_eq!(
            inner(OutlineWidth::Units(0.25), projection, center, 1.0),
            0.75
        );
        assert_eq!(
            inner(OutlineWidth::Units(2.0), projection, center, 1.0),
            0.0
        );
    }
    let pixels = OutlineWidth::Pixels(25.0);
    assert_eq!(inner(pixels, Projection::Parallel, center, 1.0), 0.75);
}

#[test]
fn it_is_never_wider_than_the_sphere_nor_no_number() {
    let center = DVec3::Z * 5.0;
    let near = 5.0_f64.next_down();
    for radius in [1e-300, 1e-9, 1.0, near, 5.0] {
        let smaller = inner(
            OutlineWidth::Pixels(1e9),
            Projection::Central,
            center,
            radius,
        );
        assert!((0.0..=radius).contains(&smaller), "{smaller} of {radius}");
    }
    // Behind the eye's plane pixels have no width.
    let behind = DVec3::new(0.0, 3.0, -1.0);
    assert_eq!(
        inner(OutlineWidth::Pixels(1.0), Projection::Central, behind, 2.0),
        2.0
    );
}
