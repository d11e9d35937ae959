//! Scenes and tables, read like `marbles render` reads them.

use std::ops::ControlFlow;

use marbles_core::{Method, Renderer, Settings, View};
use marbles_scene::Scene;

use super::{Input, seeds};
use crate::numbers::Numbers;

/// Reads a scene, and renders a few pixels of a small one.
pub(super) fn read_scene(input: &Input<'_>) -> bool {
    let text = String::from_utf8_lossy(input.bytes);
    let path = seeds::repository().join("scenes").join(input.name);
    match Scene::parse(&text, &path) {
        Ok(scene) => {
            render(&scene);
            true
        }
        Err(error) => {
            let _ = error.to_string();
            false
        }
    }
}

/// The largest number of spheres of a scene that is rendered.
const FEW: usize = 200;

/// Renders a few pixels of the first and of the last frame, and computes the visible area of each sphere in them.
fn render(scene: &Scene) {
    let frames = scene.frames().unwrap_or(1..=1);
    // A still has one.
    let of_last = (frames.start() != frames.end()).then_some(*frames.end());
    for frame in [*frames.start()].into_iter().chain(of_last) {
        let (Ok(view), Ok(world)) = (scene.view(frame), scene.world_at(frame)) else {
            continue;
        };
        if world.spheres().len() > FEW {
            continue;
        }
        let view = View {
            width: 6,
            height: 4,
            ..view
        };
        let go_on = |_| ControlFlow::Continue(());
        let renderer = Renderer::new(&world);
        // Nobody breaks off.
        assert!(renderer.visible_areas(&view, 1e-3, &go_on).is_ok());
        for method in [Method::Tolerance(1e-2), Method::Tolerance(1e-5)] {
            let settings = Settings {
                method,
                alpha: false,
            };
            let exposure = scene.exposure(&view);
            assert!(
                renderer
                    .render_with_progress(exposure, &settings, &go_on)
                    .is_ok()
            );
        }
    }
}

/// The files that seeds name, and a topology of their atoms.
const OTHERS: [(&str, &[u8]); 2] = [
    ("atoms.gro", include_bytes!("../../seeds/tables/water.gro")),
    (
        "corners.vtu",
        include_bytes!("../../seeds/tables/corners.vtu"),
    ),
];

/// Reads a table through a scene with various settings.
pub(super) fn read_table(input: &Input<'_>) -> bool {
    input.write();
    for (name, bytes) in OTHERS {
        let path = input.folder.join(name);
        if !path.exists() {
            std::fs::write(path, bytes).expect("a file can be written");
        }
    }
    let mut numbers = Numbers(input.numbers);
    let radius = numbers.either(&["", "", ", radius: 0.5"]);
    let more = numbers.either(&[
        "",
        "",
        ", frames: All",
        ", value: \"temp\"",
        ", value: \"kind\", palette: {}",
        ", keep: [(\"id\", Every(2))]",
        ", columns: (x: 1, y: 2, z: 3)",
        ", repeat: (2, 1, 3), edges: true, wrap: true",
        ", unwrap: true, frames: All",
        ", color: Element, radii: VanDerWaals",
        ", radii: {\"O\": 1, \"MW\": 2}, palette: {\"H\": 0.5, \"1\": 1}, up: Z",
        ", keep: [(\"element\", Is(\"O\"))], columns: (z: 0.0, radius_law: Exponential(0.1))",
        ", columns: (radius: Power(column: \"q\", exponent: 0.5, offset: 1))",
        ", time: \"id\"",
        ", skip_lines: 1",
        ", topology: \"atoms.gro\", frames: All",
        ", topology: \"atoms.gro\", keep: [(\"name\", Is(\"OW\")), (\"x\", Between(0, 30))], value: \"z\"",
    ]);
    let text = format!(
        "(image: (width: 4, height: 4), lens: Fov(40), camera: Frame(), ambient: 1, \
         clouds: [(file: {:?}{radius}{more})])",
        input.name
    );
    match Scene::parse(&text, &input.folder.join("scene.ron")) {
        Ok(scene) => {
            let _ = scene.columns(0);
            render(&scene);
            true
        }
        Err(error) => {
            let _ = error.to_string();
            false
        }
    }
}
