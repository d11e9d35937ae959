//! A data set for photometric stereo, and the normals that least squares recover from it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use crate::python;

/// The other tests do not need OpenCV 5 either.
const PACKAGES: [&str; 3] = ["numpy", "scipy", "opencv-python-headless<5"];

/// Writes the data set of an example in a layout; returns its folder.
fn data_set(name: &str, layout: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/{name}.ron"));
    let mut arguments = vec!["marbles".into(), "dataset".into(), scene.into_os_string()];
    arguments.extend(["-o".into(), folder.clone().into_os_string()]);
    arguments.extend(["--layout", layout, "--quiet"].map(Into::into));
    assert_eq!(marbles_cli::run(arguments), ExitCode::SUCCESS);
    folder
}

/// The page that contains the scripts.
fn page() -> String {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(manifest.join("../docs/ground-truth.md")).unwrap()
}

/// Fails if the page does not show what a script printed.
fn page_shows(output: Option<String>) {
    let Some(output) = output else { return };
    let shown = format!("```text\n{output}```\n");
    assert!(page().contains(&shown), "the page does not show\n{output}");
}

fn least_squares_find_the_normals_of_a_data_set() {
    let folder = data_set("photometric", "diligent");
    page_shows(python::run("photometric_stereo.py", &PACKAGES, &[&folder]));
}

fn lights_normals_and_depths_predict_the_pictures_under_near_lights() {
    let folder = data_set("near_lights", "luces");
    page_shows(python::run("near_lights.py", &PACKAGES, &[&folder]));
}

/// The lines of a page of the documentation in its last block of Python.
fn last_python(page: &str) -> &str {
    let (_, rest) = page.rsplit_once("```python\n").unwrap();
    rest.split_once("```").unwrap().0
}

fn the_recipe_for_lens_noise_and_response_runs() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("recipe");
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut arguments = vec!["marbles".into(), "render".into()];
    arguments.push(repository.join("scenes/first.ron").into_os_string());
    arguments.extend(["-o".into(), folder.join("first.npy").into_os_string()]);
    arguments.extend(["--size", "240x160", "--sidecar", "--quiet"].map(Into::into));
    assert_eq!(marbles_cli::run(arguments), ExitCode::SUCCESS);
    fs::write(folder.join("recipe.py"), last_python(&page())).unwrap();
    python::run(
        "run_in_folder.py",
        &["numpy"],
        &[&folder, Path::new("recipe.py")],
    );
}

/// The scripts run one after the other, because they wait for the same packages.
#[test]
fn pictures_are_what_others_make_of_them() {
    least_squares_find_the_normals_of_a_data_set();
    lights_normals_and_depths_predict_the_pictures_under_near_lights();
    the_recipe_for_lens_noise_and_response_runs();
}

#[test]
fn the_page_shows_the_scripts_that_are_run() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = page();
    for script in ["photometric_stereo.py", "near_lights.py"] {
        let script = fs::read_to_string(tests.join("tests").join(script)).unwrap();
        assert!(page.contains(script.trim()));
    }
}
