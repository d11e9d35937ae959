//! Whole command lines, run without a process.

use std::path::PathBuf;

use super::*;
use crate::terminal::console::tests::Text;

pub(crate) const SCENE: &str = "(
    image: (width: 600, height: 600),
    lens: Retina(width: 600, distance: 100),
    camera: Free(),
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 400), radius: 300)],
)
";

/// A path that no other test uses.
pub(crate) fn temporary(name: &str) -> PathBuf {
    let process = std::process::id();
    std::env::temp_dir().join(format!("marbles-{process}-{name}"))
}

/// The exit code, and the output on stdout and stderr.
pub(crate) fn run_here(args: &[&str]) -> (u8, String, String) {
    let (out, err) = (Text::default(), Text::default());
    let console = Console::to(out.clone(), err.clone());
    let args = ["marbles"].iter().chain(args).map(OsString::from);
    let code = run_on(args, &console);
    (code, out.read(), err.read())
}

#[test]
fn help_goes_to_stdout_and_errors_to_stderr() {
    let (code, out, err) = run_here(&["render", "--help"]);
    assert_eq!((code, &*err), (0, ""));
    assert!(out.contains("Examples:") && !out.contains('\x1b'));
    let (code, out, err) = run_here(&["render", "a.ron", "--frames", "5-1"]);
    assert_eq!((code, &*out), (2, ""));
    assert!(err.contains("expected the smaller frame first"), "{err}");
}

#[test]
fn check_tells_what_the_scene_contains() {
    let path = temporary("check.ron");
    std::fs::write(&path, SCENE).unwrap();
    let (code, out, err) = run_here(&["check", path.to_str().unwrap()]);
    std::fs::remove_file(&path).unwrap();
    assert_eq!((code, &*err), (0, ""));
    let (first, rest) = out.split_once('\n').unwrap();
    assert_eq!(first, format!("scene       {}", path.display()));
    assert_eq!(
        rest,
        "\
image       600 x 600 pixels
lens        Retina(width: 600, distance: 100): retina 600 wide at distance 100, 143.13° across
spheres     1, radius 300
  from      (-300, -300, 100)
  to        (300, 300, 700)
materials   0
lights      1
            toward (-0.57735, 0.57735, -0.57735), intensity 1
shadows     on
ambient     0
background  0
color       none: pictures have a single channel
frames      a still
camera      Free: x 0, y 0, z 0
  pan       0°
  tilt      0°
  roll      0°
"
    );
}

#[test]
fn check_tells_suns_and_the_sky_in_words() {
    let path = temporary("soft.ron");
    let told = |sky: &str| {
        let text = SCENE.replace(
            "lights: [Directional(toward: (-1, 1, -1))]",
            &format!("lights: [Directional(toward: (0, 1, 0)), Directional(toward: (0, 1, -1), diameter: 0.53)], sky: {sky}"),
        );
        std::fs::write(&path, text).unwrap();
        let (code, out, err) = run_here(&["check", path.to_str().unwrap()]);
        assert_eq!((code, &*err), (0, ""));
        out
    };
    let out = told("(above: 0.5, below: (0.2, 0.1, 0.1))");
    assert!(
        out.contains(
            "\
lights      2, 1 sun among them
            toward (0, 1, 0), intensity 1
            toward (0, 0.707107, -0.707107), intensity 1, a disc 0.53° across: soft shadows
"
        ),
        "{out}"
    );
    let sky = "
sky         0.5 from above, (0.2, 0.1, 0.1) from below; up is (0, 1, 0)
            a sky takes more time than any other light: ";
    assert!(out.contains(sky), "{out}");
    assert!(told("0.5").contains("\nsky         0.5 from everywhere\n"));
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn check_tells_the_shape_of_rectangular_pixels() {
    let path = temporary("rectangles.ron");
    let scene = "(image: (width: 64, height: 48), lens: Matrix(fx: 80, fy: 100, cx: 31.5, cy: 23.5), camera: Free())";
    std::fs::write(&path, scene).unwrap();
    let (code, out, _) = run_here(&["check", path.to_str().unwrap()]);
    std::fs::remove_file(&path).unwrap();
    assert_eq!(code, 0);
    let lens = "retina 64 wide at distance 80, 43.6028° across, pixels 1.25 times as wide as high";
    assert!(out.contains(lens), "{out}");
}

/// Seventeen lights make three groups, and their bumps are too fine. The summary counts the same pixels as the core,
/// and the exit code is 3.
#[test]
fn pixels_over_their_budget_are_counted_and_told() {
    let lights = "Directional(toward: (-1, 1, -1), intensity: 0.5),".repeat(17);
    let text = format!(
        "(image: (width: 10, height: 10), lens: Retina(width: 10, distance: 20), camera: Free(),
        lights: [{lights}],
        materials: {{ \"m\": (rough: (amplitude: 0.5, grain: Surface(1e-3))) }},
        spheres: [(center: (0, 0, 40), radius: 7, material: \"m\")])"
    );
    let (scene, image) = (temporary("budget.ron"), temporary("budget.exr"));
    std::fs::write(&scene, text).unwrap();
    let paths = [&scene, &image].map(|path| path.to_str().unwrap());
    let (code, out, err) = run_here(&["render", paths[0], "-o", paths[1]]);
    let loaded = marbles_scene::Scene::load(&scene).unwrap();
    for path in [&scene, &image] {
        std::fs::remove_file(path).unwrap();
    }
    let settings = marbles_core::Settings {
        method: marbles_core::Method::Tolerance(1e-3),
        alpha: false,
    };
    let go = |_| std::ops::ControlFlow::Continue(());
    let picture = marbles_core::Renderer::new(loaded.world())
        .render_with_progress(&loaded.view(1).unwrap(), &settings, &go)
        .unwrap();
    let over = picture.summary().over_tolerance;
    assert!(over > 20);
    assert_eq!(code, 3);
    assert!(out.contains(&format!(", {over} over, ")), "{out}");
    assert!(err.contains("over the tolerance"), "{err}");
}
