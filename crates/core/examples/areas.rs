//! Prints the area that each of three balls shows in a picture, in pixels, with its error.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use std::error::Error;
use std::ops::ControlFlow;

use marbles_core::glam::{DVec2, DVec3};
use marbles_core::{Camera, Lens, Material, Renderer, Sphere, View, World};

fn main() -> Result<(), Box<dyn Error>> {
    let mut world = World::new();
    let white = world.add_material(Material::default());
    // The second ball hides part of the first one, and all of the third.
    for (x, z, radius) in [(0.0, 9.0, 2.0), (1.5, 5.0, 1.0), (1.5, 9.0, 0.5)] {
        world.add_sphere(Sphere::new(DVec3::new(x, 0.0, z), radius)?, white);
    }
    // Parallel rays, 10 pixels in each unit of length.
    let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 80, 80);
    let go_on = |_| ControlFlow::Continue(());
    let areas = Renderer::new(&world).visible_areas(&view, 1e-6, &go_on)?;
    for (sphere, seen) in areas.iter().enumerate() {
        println!(
            "ball {sphere}: {:.3} pixels, error {:.0e}",
            seen.area, seen.error
        );
    }
    Ok(())
}
