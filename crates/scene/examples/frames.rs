//! Renders the frames of a scene file, and prints the error of each: `cargo run --example frames -- scenes/helix.ron`.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use std::error::Error;
use std::path::PathBuf;

use marbles_core::{Renderer, Settings};
use marbles_scene::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map(PathBuf::from);
    let scene = Scene::load(&path.ok_or("expected the path of a scene file")?)?;
    for frame in scene.frames().unwrap_or(1..=1) {
        // It is the same in every frame, unless tables change over time.
        let world = scene.world_at(frame)?;
        let view = scene.view(frame)?;
        let image = Renderer::new(&world).render(scene.exposure(&view), &Settings::default());
        println!(
            "frame {frame}: error <= {:.1e}",
            image.summary().largest_error
        );
    }
    Ok(())
}
