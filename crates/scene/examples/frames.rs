//! Renders the frames of a scene file, and prints the error of each: `cargo run --example frames -- scenes/helix.ron`.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use std::error::Error;
use std::path::PathBuf;

use marbles_core::{Renderer, Settings};
use marbles_scene::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map(PathBuf::from);
    let scene = Scene::load(&path.ok_or("expected the path of a scene file")?)?;
    let renderer = Renderer::new(scene.world());
    for frame in scene.frames().unwrap_or(1..=1) {
        let view = scene.view(frame)?;
        let image = renderer.render(scene.exposure(&view), &Settings::default());
        println!(
            "frame {frame}: error <= {:.1e}",
            image.summary().largest_error
        );
    }
    Ok(())
}
