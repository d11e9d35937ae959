//! Contours against the rays through them, and areas against grids of points.

use glam::DVec3;

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::numeric::angle::Angle;
use crate::search::tests::Random;

/// Square pixels, wide ones and high ones.
const ASPECTS: [f64; 3] = [1.0, 2.7, 0.3];

fn view() -> View {
    let degrees = Angle::from_degrees;
    View {
        camera: Camera::free(
            DVec3::new(1.0, -2.0, 0.5),
            degrees(20.0),
            degrees(-10.0),
            degrees(35.0),
        ),
        lens: Lens {
            width: 3.0,
            distance: 2.0,
            shift: DVec2::new(0.2, -0.1),
            pixel_aspect: 1.0,
        },
        zoom: 1.3,
        width: 90,
        height: 60,
        frame: 1,
    }
}

/// The retina point of pixel coordinates: what [`View::project`] does, backward.
fn on_retina(view: &View, pixel: DVec2) -> DVec2 {
    let size = DVec2::new(f64::from(view.width), f64::from(view.height));
    let from_middle = (pixel - 0.5 * size) * view.pixel_size();
    DVec2::new(from_middle.x, -from_middle.y) + view.lens.shift
}

fn spheres_ahead(view: &View) -> Vec<Sphere> {
    let mut random = Random(8);
    let mut spheres = Vec::new();
    while spheres.len() < 200 {
        let aside = random.point() * 8.0;
        let in_camera = DVec3::new(aside.x, aside.y, 6.0 + aside.z);
        let center = view.camera.position + view.camera.world_from_camera * in_camera;
        let radius = 0.01 + 2.0 * random.number() * random.number();
        if in_camera.z > 1.02 * radius {
            spheres.push(Sphere::new(center, radius).unwrap());
        }
    }
    spheres
}

#[test]
fn rays_through_a_contour_touch_the_sphere() {
    let mut view = view();
    let spheres = spheres_ahead(&view);
    for (sphere, aspect) in ASPECTS
        .iter()
        .flat_map(|aspect| spheres.iter().map(move |sphere| (sphere, *aspect)))
    {
        view.lens.pixel_aspect = aspect;
        let contour = view.contour(sphere);
        let ellipse = contour.ellipse.unwrap();
        let [long, short] = ellipse.semi_axes;
        assert!(long >= short);
        let [low, high] = ellipse.bounds();
        let across = DVec2::new(-ellipse.along.y, ellipse.along.x);
        let mut reached = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        for step in 0..64 {
            let angle = f64::from(step) * std::f64::consts::TAU / 64.0;
            let point = ellipse.center
                + ellipse.along * (long * libm::cos(angle))
                + across * (short * libm::sin(angle));
            let ray = view.ray(on_retina(&view, point));
            let from_eye = sphere.center() - ray.origin;
            let direction = ray.direction.normalize();
            let distance = direction.cross(from_eye).length();
            let off = (distance / sphere.radius() - 1.0).abs();
            assert!(off < 1e-11 / sphere.radius(), "{off:e} {sphere:?}");
            reached = [reached[0].min(point), reached[1].max(point)];
            assert!(point.cmpge(low - 1e-9).all() && point.cmple(high + 1e-9).all());
        }
        // 64 points come as near to the sides of the box as the cosine of half a step.
        let gap = (reached[0] - low).max(high - reached[1]).max_element();
        assert!(gap < 2e-3 * long, "{gap} {long}");
        assert!(ellipse.angle_degrees() > -90.0 && ellipse.angle_degrees() <= 90.0);
        let depth = view
            .camera
            .forward()
            .dot(sphere.center() - view.camera.position);
        assert!((contour.depth - depth).abs() < 1e-12 * depth);
    }
}

#[test]
fn areas_are_those_of_points_inside() {
    const FINER: u32 = 8;
    let view = view();
    let (mut whole, mut cut) = (0, 0);
    for sphere in spheres_ahead(&view) {
        let ellipse = view.contour(&sphere).ellipse.unwrap();
        let [long, short] = ellipse.semi_axes;
        let across = DVec2::new(-ellipse.along.y, ellipse.along.x);
        let mut count = 0;
        for row in 0..view.height * FINER {
            for col in 0..view.width * FINER {
                let point = DVec2::new(f64::from(col) + 0.5, f64::from(row) + 0.5);
                let from_center = point / f64::from(FINER) - ellipse.center;
                let place = DVec2::new(
                    from_center.dot(ellipse.along) / long,
                    from_center.dot(across) / short,
                );
                count += u32::from(place.length_squared() < 1.0);
            }
        }
        let by_points = f64::from(count) / f64::from(FINER * FINER);
        let area = view.area_of(&ellipse);
        let around = 7.0 * long;
        let doubt = (around + 4.0) / f64::from(FINER);
        assert!(
            (area - by_points).abs() < doubt.min(0.02 * area + 0.6),
            "{area} {by_points}"
        );
        let full = std::f64::consts::PI * long * short;
        assert!(area <= full * (1.0 + 1e-12));
        if area > full * (1.0 - 1e-12) {
            whole += 1;
        } else if area > 0.0 {
            cut += 1;
        }
    }
    assert!(whole > 20 && cut > 20, "{whole} {cut}");
}

#[test]
fn a_sphere_that_the_plane_of_the_eye_touches_has_no_ellipse() {
    let view = view();
    let camera = &view.camera;
    for (depth, radius) in [(1.0, 1.0), (0.5, 2.0), (-3.0, 1.0), (-1.0, 5.0)] {
        let center = camera.position + camera.forward() * depth;
        let contour = view.contour(&Sphere::new(center, radius).unwrap());
        assert!(depth == radius || contour.ellipse.is_none());
        assert_eq!(contour.center.is_some(), depth > 0.0);
    }
}
