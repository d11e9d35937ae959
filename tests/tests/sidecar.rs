//! Sidecars: points computed by other programs match the picture, and the data leads back to the same picture.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;
use marbles_scene::Scene;

use crate::python;
use crate::studio::picture;

/// Lenses, cameras and zooms: shifted, panned, tilted, rolled, with rectangular pixels.
const CAMERAS: [[&str; 3]; 4] = [
    [
        "Retina(width: 3, distance: 4, shift: (0.3, -0.2))",
        "Free(position: (1, 2, -3), pan: 25, tilt: -17, roll: 40)",
        "1.25",
    ],
    [
        "Fov(50)",
        "LookAt(position: (-7, 5, 6), target: (1, 0, 2), roll: -100)",
        "1",
    ],
    [
        "Fov(20)",
        "Orbit(target: (0, 1, 0), radius: 40, azimuth: 200, elevation: 35)",
        "0.5",
    ],
    // Pixels that are not square.
    [
        "Matrix(fx: 520.5, fy: 468.25, cx: 150.25, cy: 131)",
        "Free(position: (1, 2, -3), pan: 25, tilt: -17, roll: 40)",
        "1",
    ],
];

/// A temporary folder.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("sidecar-{}-{count}", std::process::id());
        let folder = Self(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
        fs::create_dir_all(&folder.0).unwrap();
        folder
    }

    /// Writes a scene and renders its picture, with a sidecar; returns the paths of both.
    fn render(&self, scene: &str, options: &str) -> [PathBuf; 2] {
        let [source, image, sidecar] = ["a.ron", "a.png", "a.json"].map(|name| self.0.join(name));
        fs::write(&source, scene).unwrap();
        let mut arguments = vec!["marbles".into(), "render".into(), source.into()];
        arguments.extend(["-o".into(), image.clone().into()]);
        arguments.extend(options.split(' ').map(Into::into));
        arguments.extend(["--sidecar", "--quiet"].map(Into::into));
        assert_eq!(marbles_cli::run(arguments), ExitCode::SUCCESS);
        [image, sidecar]
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn scene([lens, camera, zoom]: [&str; 3], rest: &str) -> String {
    format!(
        "(image: (width: 320, height: 240), lens: {lens}, camera: {camera}, zoom: {zoom}, {rest})"
    )
}

fn parse(text: &str) -> Scene {
    Scene::parse(text, Path::new("a.ron")).unwrap_or_else(|error| panic!("{error}"))
}

/// The numbers of a member of the sidecar, as text.
fn numbers(sidecar: &str, name: &str) -> Vec<String> {
    let mut lines = sidecar.lines().map(str::trim_start);
    let values = lines.find_map(|line| line.strip_prefix(&format!("\"{name}\": ")));
    let values = values.expect("the member").replace(['[', ']', ' '], "");
    let values = values.split(',').filter(|value| !value.is_empty());
    values.map(str::to_owned).collect()
}

#[test]
fn opencv_projects_spheres_to_where_the_picture_has_them() {
    /// In scene units.
    const DISTANCES: [f64; 3] = [9.0, 14.0, 30.0];
    /// In pixels, near the axis.
    const RADIUS: f64 = 20.0;
    /// Cells of a pixel's side; spheres are at their centers.
    const CELLS: u32 = 7;
    for camera in CAMERAS {
        let folder = Folder::new();
        let view = parse(&scene(camera, "")).view(1).unwrap();
        let [mut spheres, mut table] = [String::new(), String::from("x,y,z,radius\n")];
        for (index, distance) in (0..12_u32).zip(DISTANCES.into_iter().cycle()) {
            // Off the middle of pixels, and each at another place of its pixel.
            let col = CELLS * (42 + 78 * (index % 4)) + index % 5;
            let row = CELLS * (42 + 77 * (index / 4)) + index % 3;
            let ray = view.ray(view.cell_center(col.into(), row.into(), CELLS));
            let point = ray.at(distance / ray.direction.length());
            let [x, y, z] = point.to_array();
            let radius = RADIUS * distance * view.pixel_size().x / (view.lens.distance * view.zoom);
            spheres.push_str(&format!("(center: ({x}, {y}, {z}), radius: {radius}), "));
            table.push_str(&format!("{x},{y},{z},{radius}\n"));
        }
        let white = format!("ambient: 1, spheres: [{spheres}]");
        let options = "--bits 16 --tolerance 1e-6";
        let [image, sidecar] = folder.render(&scene(camera, &white), options);
        let spheres = folder.0.join("spheres.csv");
        fs::write(&spheres, table).unwrap();
        let packages = ["numpy", "opencv-python-headless"];
        let arguments = [&*sidecar, &*image, &*spheres];
        python::run("sidecar/project_points.py", &packages, &arguments);
    }
}

#[test]
fn a_scene_with_matrix_and_pose_of_a_sidecar_has_the_same_picture() {
    let rest = r#"ambient: 0.1, background: 0.3, lights: [Directional(toward: (-1, 1, -1))],
        materials: {"m": (albedo: (1, 0.5, 0.2), highlight: ())},
        spheres: [(center: (0, -100, 0), radius: 100), (center: (0, 1, 1), radius: 1.5, material: "m"),
                  (center: (2, 1, 4), radius: 1), (center: (4, 2, 5), radius: 1.2, material: "m")]"#;
    for camera in CAMERAS {
        let folder = Folder::new();
        let first = scene(camera, rest);
        let [_, sidecar] = folder.render(&first, "--samples 1 --size 320x240");
        let sidecar = fs::read_to_string(sidecar).unwrap();
        let member = |name| numbers(&sidecar, name);
        let matrix = member("K");
        let [fx, cx, fy, cy] = [0, 2, 4, 5].map(|index| &matrix[index]);
        let lens = format!("Matrix(fx: {fx}, fy: {fy}, cx: {cx}, cy: {cy})");
        let (rotation, translation) = (member("R").join(", "), member("t").join(", "));
        let pose =
            format!("Pose(rotation: [{rotation}], translation: ({translation}), axes: OpenCV)");
        let second = scene([&lens, &pose, "1"], rest);

        let [first, second] = [first, second].map(|text| parse(&text));
        let [one, other] = [&first, &second].map(|scene| scene.view(1).unwrap());
        assert_eq!(one.camera.world_from_camera, other.camera.world_from_camera);
        let distance = (one.camera.position - other.camera.position).length();
        assert!(distance < 1e-13, "{distance}");
        let [one, other] = [(&first, one), (&second, other)]
            .map(|(scene, view)| picture(scene.world(), &view, 3, false));
        let values = (0..240).flat_map(|row| one.row(row).iter().zip(other.row(row)));
        let largest = values.fold(0.0, |most: f64, (one, other)| most.max((one - other).abs()));
        assert!(largest < 1e-9, "{largest}");
    }
}

/// A parallel camera has no K: a point appears at `pixels_per_unit` · (x, y) + `principal_point`.
#[test]
fn a_parallel_sidecar_tells_where_points_are_seen() {
    let camera = [
        "Parallel(width: 8, shift: (0.5, -0.25))",
        "Free(position: (1, 2, 3), pan: 20, tilt: -10, roll: 5)",
        "2",
    ];
    let folder = Folder::new();
    let text = scene(camera, "ambient: 1");
    let [_, sidecar] = folder.render(&text, "--samples 1");
    let sidecar = fs::read_to_string(sidecar).unwrap();
    assert!(sidecar.contains("\"kind\": \"parallel\""), "{sidecar}");
    assert!(!sidecar.contains("\"K\""), "{sidecar}");
    let member = |name| -> Vec<f64> {
        let values = numbers(&sidecar, name);
        values.iter().map(|value| value.parse().unwrap()).collect()
    };
    let (scale, middle) = (member("pixels_per_unit")[0], member("principal_point"));
    let (rotation, translation) = (member("R"), member("t"));
    assert_eq!(scale, 80.0);
    let view = parse(&text).view(1).unwrap();
    for point in [DVec3::new(1.5, 2.5, 9.0), DVec3::new(0.0, 1.0, 5.0)] {
        let right_handed = [point.x, point.y, -point.z];
        let along = |row: usize| {
            let terms = (0..3).map(|axis| rotation[3 * row + axis] * right_handed[axis]);
            terms.sum::<f64>() + translation[row]
        };
        let expected = view.project(point).unwrap() - 0.5;
        assert!((scale * along(0) + middle[0] - expected.x).abs() < 1e-9);
        assert!((scale * along(1) + middle[1] - expected.y).abs() < 1e-9);
    }
}
