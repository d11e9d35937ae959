//! The atoms of trajectories, as other tables tell them.

use super::trajectories::{FEW, WATER_DCD, WATER_XTC, xtc};
use super::*;

/// The first frame of the water, as MDAnalysis writes it.
const WATER_GRO: &str = include_str!("../../../../../tests/seeds/tables/water.gro");

/// A scene with a cloud of a trajectory, beside the table of its atoms.
fn with_topology(
    name: &str,
    bytes: &[u8],
    topology: (&str, &str),
    fields: &str,
) -> Result<Scene, String> {
    let folder = Folder::new();
    fs::write(folder.0.join(name), bytes).unwrap();
    let (atoms, text) = topology;
    fs::write(folder.0.join(atoms), text).unwrap();
    let text = format!(
        "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),\nclouds: [(file: \"{name}\", topology: \"{atoms}\", right_handed: false, {fields})])"
    );
    Scene::parse(&text, &folder.0.join("scene.ron")).map_err(|error| {
        let folder = format!("{}{}", folder.0.display(), std::path::MAIN_SEPARATOR);
        let message = error.to_string().replace(&folder, "");
        message.lines().next().unwrap().to_owned()
    })
}

#[test]
fn a_topology_tells_all_but_the_positions() {
    let pdb = "ATOM      1  OW  SOL A   1       0.000   0.000   0.000  1.00  0.00           O\n\
               ATOM      2  HW1 SOL A   1       1.000   0.000   0.000  1.00  0.00           H\n";
    let pdb = pdb.to_owned() + &pdb.replace("A   1", "B   2").replace("HW1", "HW2") + "END\n";
    let few = &xtc(
        &[
            [0.1, 0.2, 0.3],
            [0.4, 0.5, 0.6],
            [0.7, 0.8, 0.9],
            [1.0, 1.1, 1.2],
        ],
        1,
    );
    let scene = |fields: &str| with_topology("a.xtc", few, ("atoms.pdb", &pdb), fields).unwrap();
    let all = spheres(&scene(""));
    let as_single = |numbers: [f64; 3]| numbers.map(|number| f64::from(number as f32));
    let [x, y, z] = as_single([0.4, 0.5, 0.6]);
    // Radii of 1.52 and 1.1 ångströms, in nanometers.
    assert!(
        (all[0][3] - 0.152).abs() < 1e-12 && (all[1][3] - 0.11).abs() < 1e-12,
        "{all:?}"
    );
    assert_eq!(all[1][..3], [x, y, z]);
    let colors = albedos(&scene(""));
    assert_eq!(
        colors,
        ["0xff0d0d", "0xffffff", "0xff0d0d", "0xffffff"]
            .map(|color| { from_srgb(u32::from_str_radix(&color[2..], 16).unwrap()) })
    );
    // Conditions on what it tells, on positions, and on both, and columns by their numbers.
    let centers = |fields: &str| -> Vec<f64> {
        spheres(&scene(fields))
            .iter()
            .map(|sphere| sphere[0])
            .collect()
    };
    let [second, third, fourth] = [0.4_f32, 0.7, 1.0].map(f64::from);
    for (fields, expected) in [
        ("keep: [(\"chain\", Is(\"B\"))]", vec![third, fourth]),
        ("keep: [(\"element\", Is(\"H\"))]", vec![second, fourth]),
        ("keep: [(\"y\", Between(0.4, 1.0))]", vec![second, third]),
        (
            "keep: [(\"z\", Between(0, 1)), (\"name\", Is(\"HW1\"))]",
            vec![second],
        ),
        (
            "columns: (x: \"z\", z: 0.0)",
            vec![0.3_f32, 0.6, 0.9, 1.2]
                .into_iter()
                .map(f64::from)
                .collect(),
        ),
        ("keep: [(8, Between(0.6, 9))]", vec![third, fourth]),
    ] {
        assert_eq!(centers(fields), expected, "{fields}");
    }
    assert_eq!(spheres(&scene("columns: (x: \"z\", z: 0.0)"))[2][2], 0.0);
    // A radius of the scene is in the trajectory's unit already.
    assert_eq!(spheres(&scene("radius: 0.25"))[0][3], 0.25);
    // Positions have colors of their own, of the frame.
    let scale = scene("value: \"z\", colormap: Grey");
    let grey = |index: usize| albedos(&scale)[index].x;
    assert!(
        grey(0) < grey(1) && grey(2) < grey(3),
        "{:?}",
        albedos(&scale)
    );
    let colors = &scale.clouds()[0].colors;
    assert!(
        format!("{colors:?}").contains("low: 0.30000001192092896"),
        "{colors:?}"
    );
    let columns = scale.columns(0);
    assert!(columns.is_err(), "the files are gone");
}

#[test]
fn units_of_topologies_are_those_of_the_trajectory() {
    for (name, bytes, radius) in [("a.xtc", WATER_XTC, 0.152), ("a.dcd", WATER_DCD, 1.52)] {
        let scene = with_topology(name, bytes, ("water.gro", WATER_GRO), "").unwrap();
        let found = spheres(&scene);
        assert_eq!(found.len(), 18);
        assert!(
            (found[15][3] - radius).abs() < 1e-12,
            "{name}: {:?}",
            found[15]
        );
        assert_eq!(
            warnings(&scene),
            format!(
                "{name}: the first frame of several is shown (`frames: All` shows them one after another)"
            )
        );
    }
}

#[test]
fn topologies_that_do_not_fit_are_refused() {
    let refused = |topology: (&str, &str), fields: &str| {
        let scene = with_topology("a.xtc", FEW, topology, fields);
        scene.map(|_| ()).unwrap_err()
    };
    let four = "4\n\nC 0 0 0\nC 0 0 1\nC 0 0 2\nC 0 0 3\n";
    let six = "6\n\n".to_owned() + &"C 0 0 0\n".repeat(6);
    let six = six.as_str();
    for (topology, fields, expected) in [
        (
            ("a.xyz", four),
            "",
            "a.xtc: expected as many atoms as in the topology \"a.xyz\", 4, found 6 in frame 1",
        ),
        (
            ("a.xyz", "4\n\nC 0 0 0\n"),
            "",
            "a.xyz:4:1: expected 4 atoms, according to the first line (1 read), found the end of the file",
        ),
        (("a.psf", "PSF\n"), "", "scene.ron:2:36: expected a table"),
        (
            ("a.xyz", six),
            "unwrap: true",
            "scene.ron:2:74: expected a table with image flags for `unwrap`, found a trajectory, which has none",
        ),
        (
            ("a.xyz", six),
            "value: Length(\"x\", \"y\", \"z\")",
            "scene.ron:2:36: expected columns of the topology in `Length`, found the positions of a trajectory",
        ),
        (
            ("a.xyz", six),
            "value: \"x\", color: Category",
            "scene.ron:2:36: expected `color: Value` for the positions of a trajectory, found another coloring",
        ),
        (
            ("a.xyz", six),
            "columns: (x: \"element\")",
            "scene.ron:2:36: expected `x`, `y`, `z` or constants for the positions of a trajectory, found another column",
        ),
        (
            ("a.xyz", six),
            "time: \"x\"",
            "scene.ron:2:72: expected `topology` or `time`, found both: the frames of a trajectory are its steps",
        ),
    ] {
        let message = refused(topology, fields);
        assert!(message.starts_with(expected), "{message}");
    }
    let not_one = with_topology("a.xyz", six.as_bytes(), ("b.xyz", six), "")
        .map(|_| ())
        .unwrap_err();
    assert_eq!(
        not_one,
        "scene.ron:2:36: expected a trajectory (XTC or DCD) for `topology`, found \"a.xyz\", whose format is XYZ"
    );
    let missing = load("a.xtc", FEW, "topology: \"b.gro\"")
        .map(|_| ())
        .unwrap_err();
    assert!(
        missing.starts_with("scene.ron:2:36: expected a table, found no file \"b.gro\""),
        "{missing}"
    );
    let alone = refusal("a.xtc", FEW, "");
    assert!(alone.contains("expected a column `radius`, or else `radius: …` in the scene, found `x`, `y`, `z` (`topology:"), "{alone}");
}
