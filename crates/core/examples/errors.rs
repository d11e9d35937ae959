//! Renders two balls, prints what is known of the error, and writes the error of each pixel as `errors.pgm`: black is 1e-7,
//! white is the tolerance.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use std::error::Error;
use std::fs;

use marbles_core::glam::DVec3;
use marbles_core::{
    Angle, Camera, Evidence, Lens, Light, Material, Method, Renderer, Settings, Sphere, View, World,
};

const TOLERANCE: f64 = 1e-3;
const SIDE: u32 = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let mut world = World::new();
    let white = world.add_material(Material::default());
    world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
    world.add_sphere(Sphere::new(DVec3::new(-0.6, 0.5, 3.9), 0.25)?, white);
    let sun = Light::directional(DVec3::new(-1.0, 1.0, -1.0), DVec3::ONE)?;
    world.lights.push(sun);
    let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
    let view = View::new(Camera::default(), lens, SIDE, SIDE);
    let settings = Settings {
        method: Method::Tolerance(TOLERANCE),
        ..Settings::default()
    };
    let image = Renderer::new(&world).render(&view, &settings);

    let summary = image.summary();
    println!(
        "{} pixels, {} of them bounds",
        summary.pixels, summary.bounds
    );
    println!(
        "largest error {:.1e}, {} over",
        summary.largest_error, summary.over_tolerance
    );
    let middle = image.rgba(SIDE / 2, SIDE / 2)[0];
    let is_proved = image.evidence(SIDE / 2, SIDE / 2) == Evidence::Bound;
    println!("in the middle {middle:.6}, proved: {is_proved}");

    let mut file = format!("P5 {SIDE} {SIDE} 255\n").into_bytes();
    for (row, col) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |col| (row, col))) {
        let decades = (image.error(col, row).max(1e-7) / 1e-7).log10();
        // The cast saturates.
        file.push((255.0 * decades / (TOLERANCE / 1e-7).log10()) as u8);
    }
    fs::write("errors.pgm", file)?;
    Ok(())
}
