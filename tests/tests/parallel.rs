//! Parallel lenses: closed forms, and comparisons with distant pinhole cameras.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use marbles_core::{Angle, Camera, Color, Image, Lens, Method, Renderer, Settings, View, World};
use marbles_tests::reference::Reference;

use crate::studio::world_of;

const SIDE: u32 = 64;

/// A view along +z from a position, with a width in scene units.
fn view(position: DVec3, width: f64) -> View {
    View {
        camera: Camera::free(position, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens::parallel(width, DVec2::ZERO),
        zoom: 1.0,
        width: SIDE,
        height: SIDE,
        frame: 1,
    }
}

fn render(world: &World, view: &View, tolerance: f64) -> Image {
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: true,
    };
    let go = |_| std::ops::ControlFlow::Continue(());
    Renderer::new(world)
        .render_with_progress(view, &settings, &go)
        .unwrap()
}

/// A world of white balls under a light of intensity 1.
fn world(spheres: &[(DVec3, f64)], toward: DVec3) -> World {
    let balls: Vec<_> = spheres
        .iter()
        .map(|&(center, radius)| (center, radius, Color::ONE))
        .collect();
    world_of(&balls, &[toward])
}

/// Sums of a picture and of its claims, in scene units squared: light and coverage.
fn sums(image: &Image, view: &View) -> (f64, f64, f64) {
    let area = view.pixel_size().element_product();
    let (mut light, mut covered, mut claimed) = (0.0, 0.0, 0.0);
    for row in 0..SIDE {
        for col in 0..SIDE {
            let [red, _, _, alpha] = image.rgba(col, row);
            light += red * area;
            covered += alpha * area;
            claimed += image.error(col, row) * area;
        }
    }
    (light, covered, claimed)
}

/// With the angle α between the light and the viewpoint, as seen from the ball: ⅔ (sin α + (π − α) cos α) r².
#[test]
fn the_light_of_a_ball_follows_lamberts_phase_law() {
    let radius = 1.3;
    let center = DVec3::new(0.21, -0.17, 5.0);
    let view = view(DVec3::ZERO, 3.1);
    for step in 0..=12 {
        let alpha = PI * f64::from(step) / 12.0;
        // Turned about the view axis as well, so that nothing is aligned with rows.
        let aside = DVec3::new(0.8, 0.6, 0.0);
        let toward = aside * alpha.sin() - DVec3::Z * alpha.cos();
        let world = world(&[(center, radius)], toward);
        let expected = 2.0 / 3.0 * (alpha.sin() + (PI - alpha) * alpha.cos()) * radius * radius;
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-5] {
            let image = render(&world, &view, tolerance);
            assert_eq!(image.summary().over_tolerance, 0, "{step} at {tolerance}");
            let (light, covered, claimed) = sums(&image, &view);
            let off = (light - expected).abs();
            assert!(
                off <= claimed + 1e-12,
                "{step} at {tolerance}: {light} instead of {expected}, claimed {claimed:e}"
            );
            let off = (covered - PI * radius * radius).abs();
            assert!(off <= claimed + 1e-12, "{step} at {tolerance}: {off:e}");
        }
    }
}

/// A ball that is cut by the plane shows its inner side within the circle of the cut, and its outer side around it.
#[test]
fn a_ball_that_the_plane_cuts_shows_its_inner_side() {
    let radius: f64 = 1.5;
    for depth in [0.9, 0.0, -0.7] {
        let mut world = world(&[(DVec3::new(0.1, 0.05, depth), radius)], -DVec3::Z);
        world.ambient = Color::splat(0.25);
        let view = view(DVec3::ZERO, 4.0);
        let cut_sq = radius * radius - depth * depth;
        // Outside of the cut ∫ √(r² − ρ²) / r dA of the light at the eye, and of the ambient light.
        let seen_sq = if depth > 0.0 { radius * radius } else { cut_sq };
        let lit = |square: f64| (radius * radius - square).max(0.0).powf(1.5);
        let light = 2.0 / 3.0 * PI / radius * (lit(cut_sq) - lit(seen_sq));
        let expected = light + 0.25 * PI * seen_sq;
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let image = render(&world, &view, tolerance);
            assert_eq!(image.summary().over_tolerance, 0, "{depth} at {tolerance}");
            let (light, covered, claimed) = sums(&image, &view);
            let off = (light - expected).abs();
            assert!(off <= claimed + 1e-12, "{depth} at {tolerance}: {off:e}");
            let off = (covered - PI * seen_sq).abs();
            assert!(off <= claimed + 1e-12, "{depth} at {tolerance}: {off:e}");
        }
    }
}

#[test]
fn nothing_behind_the_plane_is_seen() {
    let spheres = [(DVec3::new(0.0, 0.0, -3.0), 1.0), (DVec3::Z * -1.0, 1.0)];
    let world = world(&spheres, DVec3::Z);
    let view = view(DVec3::ZERO, 4.0);
    let (light, covered, claimed) = sums(&render(&world, &view, 1e-3), &view);
    assert_eq!((light, covered), (0.0, 0.0));
    // Rounding leaves open whether the plane cuts the second.
    assert!(claimed < 1e-6, "{claimed}");
}

/// Zoom divides the width, and a shift moves the picture by this fraction of it.
#[test]
fn zoom_and_shift_are_those_of_other_lenses() {
    let world = world(
        &[(DVec3::new(0.3, 0.2, 7.0), 0.8)],
        DVec3::new(-1.0, 1.0, -1.0),
    );
    let wide = View {
        zoom: 2.0,
        lens: Lens::parallel(6.0, DVec2::new(0.5, -0.25)),
        ..view(DVec3::ZERO, 1.0)
    };
    let narrow = view(DVec3::new(0.25, -0.125, 0.0), 3.0);
    let [one, other] = [wide, narrow].map(|view| render(&world, &view, 1e-4));
    for row in 0..SIDE {
        for col in 0..SIDE {
            let [a, b] = [&one, &other].map(|image| image.rgba(col, row)[0]);
            let claimed = one.error(col, row) + other.error(col, row);
            assert!((a - b).abs() <= claimed + 1e-12, "{col} {row}: {a} {b}");
        }
    }
    let contour = wide.contour(&world.spheres()[0]);
    let ellipse = contour.ellipse.unwrap();
    let pixels = f64::from(SIDE) / 3.0;
    assert!((ellipse.semi_axes[0] - 0.8 * pixels).abs() < 1e-12 * pixels);
    assert_eq!(ellipse.semi_axes[0], ellipse.semi_axes[1]);
    assert_eq!(contour.center, Some(ellipse.center));
}

/// The tests' own integrator, and plain midpoints, give the same pixels.
#[test]
fn the_reference_and_midpoints_agree() {
    let spheres = [
        (DVec3::new(0.0, 0.0, 6.0), 1.5),
        (DVec3::new(0.9, 0.4, 4.6), 0.7),
        (DVec3::new(-1.1, 0.3, 5.2), 0.6),
        (DVec3::new(-0.9, -1.2, 0.3), 0.9),
    ];
    let world = world(&spheres, DVec3::new(0.7, 0.5, -1.0));
    let view = view(DVec3::ZERO, 4.4);
    let image = render(&world, &view, 1e-5);
    let reference = Reference::new(&world, &view);
    for row in (0..SIDE).step_by(5) {
        for col in (0..SIDE).step_by(3) {
            let truth = reference.pixel_to(col, row, 0.02 * image.error(col, row));
            let allowed = image.error(col, row) + truth.error + 1e-12;
            let value = image.rgba(col, row);
            let off = (value[0] - truth.value.x).abs();
            let off = off.max((value[3] - truth.value.w).abs());
            assert!(off <= allowed, "{col} {row}: off by {off:e}, {allowed:e}");
            let rough = reference.midpoints(col, row, 32);
            assert!(
                (rough - truth.value).abs().max_element() < 0.05,
                "{col} {row}"
            );
        }
    }
}
