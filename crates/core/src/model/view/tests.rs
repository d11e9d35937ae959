//! Rays, and the places of points in a picture.

use super::*;
use crate::numeric::angle::Angle;

fn view() -> View {
    View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 8.0,
            distance: 10.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 4,
        height: 3,
        frame: 1,
    }
}

#[test]
fn pixel_centers_lie_on_the_retina_from_the_top_left() {
    assert_eq!(view().cell_center(0, 0, 1), DVec2::new(-3.0, 2.0));
    assert_eq!(view().cell_center(3, 2, 1), DVec2::new(3.0, -2.0));
    assert_eq!(view().cell_center(0, 0, 2), DVec2::new(-3.5, 2.5));
}

/// Pixels 2 wide and 5 high.
#[test]
fn pixels_may_be_rectangles() {
    let mut view = view();
    view.lens.pixel_aspect = 0.4;
    assert_eq!(view.pixel_size(), DVec2::new(2.0, 5.0));
    assert_eq!(view.cell_center(0, 0, 1), DVec2::new(-3.0, 5.0));
    assert_eq!(view.cell_center(3, 2, 1), DVec2::new(3.0, -5.0));
    assert_eq!(view.cell_center(0, 0, 2), DVec2::new(-3.5, 6.25));
    assert_eq!(view.pixels_per_unit(), DVec2::new(5.0, 2.0));
    let (_, size) = view.screen_window();
    assert!((size - DVec2::new(0.8, 1.5)).length() < 1e-15, "{size}");
    // 5 to the right and 2 up on the retina: 2.5 columns, 0.4 rows.
    let seen = view.project(DVec3::new(1.0, 0.4, 2.0)).unwrap();
    assert!(
        (seen - DVec2::new(2.0 + 2.5, 1.5 - 0.4)).length() < 1e-15,
        "{seen}"
    );
}

#[test]
fn shift_moves_the_retina_and_zoom_its_distance() {
    let mut view = view();
    view.lens.shift = DVec2::new(5.0, -1.0);
    view.zoom = 3.0;
    let ray = view.ray(view.cell_center(0, 0, 1));
    assert_eq!(ray.direction, DVec3::new(2.0, 1.0, 30.0));
}

#[test]
fn the_screen_window_is_what_rays_span_at_distance_1() {
    let mut view = view();
    view.lens.shift = DVec2::new(5.0, -1.0);
    view.zoom = 3.0;
    let (center, size) = view.screen_window();
    assert_eq!(
        (center.x, center.y, size),
        (5.0 / 30.0, -1.0 / 30.0, DVec2::new(8.0 / 30.0, size.y))
    );
    let at_distance_1 = |u: f64, v: f64| {
        let ray = view.ray(view.lens.shift + DVec2::new(u, v));
        ray.direction.truncate() / ray.direction.z
    };
    let left = at_distance_1(-4.0, 0.0);
    let right = at_distance_1(4.0, 0.0);
    assert!((0.5 * (left + right) - center).length() < 1e-15);
    assert!((right.x - left.x - size.x).abs() < 1e-15);
    assert!((size.y - 0.2).abs() < 1e-15);
}

#[test]
fn projection_inverts_the_rays() {
    let angle = Angle::from_degrees;
    let mut view = view();
    view.camera = Camera::free(
        DVec3::new(3.0, 1.0, 4.0),
        angle(20.0),
        angle(-50.0),
        angle(70.0),
    );
    view.lens.shift = DVec2::new(0.3, 0.7);
    let pixel = view
        .project(view.ray(view.cell_center(1, 2, 1)).at(7.0))
        .unwrap();
    assert!((pixel - DVec2::new(1.5, 2.5)).length() < 1e-14);
    assert_eq!(view.project(view.ray(DVec2::ZERO).at(-1.0)), None);
}

#[test]
fn mirrored_cells_mirror_to_the_bit() {
    let mut view = view();
    view.lens.width = 0.7;
    view.width = 601;
    for col in 0..3 * 601 {
        let left = view.cell_center(col, 0, 3).x;
        assert_eq!(left, -view.cell_center(3 * 601 - 1 - col, 0, 3).x);
    }
}
