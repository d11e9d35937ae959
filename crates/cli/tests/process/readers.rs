//! Other programs read the same numbers from every kind of file.
//!
//! `tests/formats.py` runs the readers. They are installed once, from the Python registry, into the build folder. The
//! test is skipped if there is no Python, or no registry.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::folder::{Folder, code, text};

/// Two balls in color, partly brighter than white, with a camera that is not aligned with any axis. The small ball is
/// alone in the right half of the picture.
const SCENE: &str = "(
    image: (width: 40, height: 30),
    lens: Retina(width: 8, distance: 10, shift: (0.5, -0.25)),
    camera: Free(position: (1, 0.5, -12), pan: 4, tilt: -3, roll: 10),
    zoom: 1.25,
    background: (0.015, 0.03, 0.05),
    ambient: 0.02,
    lights: [Directional(toward: (-1, 1, -2), intensity: 2)],
    materials: { \"paint\": (albedo: (1, 0.25, 0.0625)) },
    spheres: [(center: (-1.5, 0, 0), radius: 1.5, material: \"paint\"),
              (center: (4, 1, 1), radius: 0.25)],
)
";

/// All channels.
const ALL: &str =
    "--error-channel --channels depth,normal,position,id,albedo,mask,mean_normal,coverage_id";

/// The packages without which there is no test. OpenCV 5 and later has no OpenEXR, and OpenEXR before 3.3 has no `File`.
const PACKAGES: [&str; 5] = [
    "numpy",
    "Pillow",
    "imageio",
    "opencv-python-headless<5",
    "OpenEXR>=3.3",
];

/// More readers, whose layers are compared if the registry has them for this machine. They need the packages above only.
const MORE_PACKAGES: [&str; 2] = ["OpenImageIO>=3", "pyexr>=0.4"];

/// The folder with the packages, which are installed if necessary; or the reason why there is none.
fn packages() -> Result<PathBuf, String> {
    let version = "import sys; print(*sys.version_info[:2], sep='.')";
    let output = Command::new("python3").args(["-c", version]).output();
    let output = output.map_err(|error| format!("no python3: {error}"))?;
    let version = text(&output.stdout);
    let built = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let folder = built.join(format!("python-{}-readers", version.trim()));
    if folder.is_dir() {
        return Ok(folder);
    }
    // It gets its name when it is complete, as several processes may be at it.
    let unfinished = folder.with_extension(std::process::id().to_string());
    let pip = |more: &[&str]| {
        let mut pip = Command::new("python3");
        pip.args(["-m", "pip", "install", "--quiet", "--no-input"]);
        pip.args(["--disable-pip-version-check", "--only-binary=:all:"]);
        pip.args(["--timeout", "15", "--retries", "1", "--target"]);
        pip.arg(&unfinished).args(more);
        let output = pip.output().map_err(|error| error.to_string())?;
        match output.status.success() {
            true => Ok(()),
            false => Err(format!("pip: {}", text(&output.stderr))),
        }
    };
    if let Err(reason) = pip(&PACKAGES) {
        let _ = fs::remove_dir_all(&unfinished);
        return Err(reason);
    }
    for package in MORE_PACKAGES {
        if let Err(reason) = pip(&["--no-deps", package]) {
            eprintln!("{package}: {reason}");
        }
    }
    if fs::rename(&unfinished, &folder).is_err() {
        let _ = fs::remove_dir_all(&unfinished);
    }
    Ok(folder)
}

#[test]
fn readers_of_others_find_the_same_numbers() {
    let packages = match packages() {
        Ok(packages) => packages,
        Err(reason) => {
            eprintln!("skipped: this test needs packages of Python: {reason}");
            return;
        }
    };
    let folder = Folder::new();
    let grey = SCENE
        .replace("(0.015, 0.03, 0.05)", "0.25")
        .replace("(1, 0.25, 0.0625)", "0.9");
    for (name, scene) in [("color", SCENE), ("grey", &grey)] {
        fs::write(folder.path(&format!("{name}.ron")), scene).unwrap();
        for (name_of, alpha) in [(name.to_owned(), ""), (format!("{name}-alpha"), "--alpha")] {
            for output in [
                "8.png",
                "16.png --bits 16",
                "linear.png --linear",
                "half.exr --error-channel",
                "float.exr --float --error-channel",
                "layers.exr --float --error-channel --per-light=layers",
                "npy --error-channel",
                "npz --error-channel --channels depth,normal,id",
                &format!("all.exr {ALL} --per-light=layers"),
                &format!("all.npz {ALL}"),
                &format!("all.npz {ALL} --per-light"),
            ] {
                let render = format!("render {name}.ron --quiet -o {name_of}.{output} {alpha}");
                let output = folder.run(&render);
                assert_eq!(code(&output), 0, "{}", text(&output.stderr));
            }
        }
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/formats.py");
    let mut python = Command::new("python3");
    let python = python.arg(script).arg(&folder.0);
    let output = python.env("PYTHONPATH", packages).output().unwrap();
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let stdout = text(&output.stdout);
    eprint!("{stdout}");
    assert!(
        stdout.contains("layers of an EXR by OpenEXR: 4 of 4\n"),
        "{stdout}"
    );
    assert!(stdout.ends_with("the same numbers: 84 of 84\n"), "{stdout}");
}
