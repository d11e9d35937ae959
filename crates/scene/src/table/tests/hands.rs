//! The hands of the axes of every format, by four spheres that are not their mirror image.

use super::super::ENDINGS;
use super::formats::npz;
use super::*;
use super::{collections, gsd, trajectories};

/// A corner and its neighbors along x, y and z, at distances 1, 2 and 3.
pub(super) const CORNERS: [[f64; 3]; 4] = [
    [5.0, 5.0, 5.0],
    [6.0, 5.0, 5.0],
    [5.0, 7.0, 5.0],
    [5.0, 5.0, 8.0],
];

/// The corners as a table of this ending, and whether its axes are right-handed unless the scene says otherwise.
pub(super) fn table(ending: &str) -> (Vec<u8>, bool) {
    let lines = |line: fn(usize, [f64; 3]) -> String| -> String {
        let rows = CORNERS.iter().enumerate();
        rows.map(|(index, corner)| line(index + 1, *corner))
            .collect()
    };
    let numbers = doubles(&CORNERS.concat());
    let array = npy(
        "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3)}",
        &numbers,
    );
    let pdb = lines(|id, [x, y, z]| {
        format!("HETATM{id:>5}  C   LIG A   1    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00           C\n")
    });
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS id x y z\n";
    let loop_of_atoms =
        "data_a\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
    let words = lines(|_, [x, y, z]| format!("{x} {y} {z}\n"));
    let text = match ending {
        "csv" => format!("x,y,z\n{}", words.replace(' ', ",")),
        "tsv" => format!("x\ty\tz\n{}", words.replace(' ', "\t")),
        "txt" | "dat" => format!("x y z\n{words}"),
        "npy" => return (array, false),
        "npz" => return (npz(&[("positions", array)]), false),
        "ply" => format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n{words}"
        ),
        "xyz" | "extxyz" => format!("4\n\n{}", lines(|_, [x, y, z]| format!("C {x} {y} {z}\n"))),
        "dump" | "lammpstrj" => {
            format!(
                "{dump}{}",
                lines(|id, [x, y, z]| format!("{id} {x} {y} {z}\n"))
            )
        }
        "gro" => {
            let atoms =
                lines(|id, [x, y, z]| format!("    1LIG      C{id:>5}{x:8.3}{y:8.3}{z:8.3}\n"));
            format!("t\n4\n{atoms} 9 9 9\n")
        }
        "gsd" => return (gsd::file(&CORNERS, 1), true),
        "xtc" => return (trajectories::xtc(&CORNERS, 1), true),
        "dcd" => return (trajectories::dcd(&CORNERS, 1), true),
        "pvd" => collections::collection(&[("0", collections::CORNERS_VTU)]),
        "pdb" | "ent" | "pdbqt" => pdb,
        "pqr" => lines(|id, [x, y, z]| format!("ATOM {id} C LIG 1 {x} {y} {z} 0.5 1.7\n")),
        "cif" | "mmcif" | "pdbx" => format!("{loop_of_atoms}{words}#\n"),
        "mol2" => {
            let atoms = lines(|id, [x, y, z]| format!("{id} C{id} {x:.4} {y:.4} {z:.4} C.3\n"));
            format!(
                "@<TRIPOS>MOLECULE\nbox\n4 0\nSMALL\nNO_CHARGES\n@<TRIPOS>ATOM\n{atoms}@<TRIPOS>BOND\n"
            )
        }
        "sdf" | "sd" | "mol" | "mdl" => {
            let atoms = lines(|_, [x, y, z]| format!("{x:10.4}{y:10.4}{z:10.4} C   0  0\n"));
            format!(
                "box\n  by hand\n\n  4  0  0  0  0  0  0  0  0  0999 V2000\n{atoms}M  END\n$$$$\n"
            )
        }
        "data" | "lmp" => {
            let atoms = lines(|id, [x, y, z]| format!("{id} 1 {x} {y} {z}\n"));
            format!("box\n\n4 atoms\n1 atom types\n0 9 xlo xhi\n\nAtoms # atomic\n\n{atoms}")
        }
        "poscar" | "contcar" | "xdatcar" | "vasp" => {
            format!("C\n1\n9 0 0\n0 9 0\n0 0 9\nC\n4\nCartesian\n{words}")
        }
        "vtk" => format!(
            "# vtk DataFile Version 3.0\np\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n{words}"
        ),
        "vtu" | "vtp" => {
            let kind = match ending {
                "vtu" => "UnstructuredGrid",
                _ => "PolyData",
            };
            format!(
                "<VTKFile type=\"{kind}\"><{kind}><Piece NumberOfPoints=\"4\"><Points><DataArray type=\"Float64\" \
                 NumberOfComponents=\"3\" format=\"ascii\">\n{words}</DataArray></Points></Piece></{kind}></VTKFile>\n"
            )
        }
        other => panic!("no table of four spheres for `.{other}`: say whether it is mirrored"),
    };
    let is_plain = ["csv", "tsv", "txt", "dat"].contains(&ending);
    (text.into_bytes(), !is_plain)
}

/// The volume of the box at the corner: negative in a mirror image.
fn volume(scene: &Scene) -> f64 {
    let [corner, x, y, z] = spheres(scene)[..] else {
        panic!("four spheres")
    };
    let edge =
        |end: [f64; 4]| DVec3::new(end[0] - corner[0], end[1] - corner[1], end[2] - corner[2]);
    edge(x).dot(edge(y).cross(edge(z)))
}

#[test]
fn tables_of_other_programs_are_right_handed_and_plain_ones_are_the_scenes_own() {
    for (ending, _) in ENDINGS {
        let (bytes, is_right_handed) = table(ending);
        let name = format!("a.{ending}");
        for (fields, expected) in [
            ("", None),
            ("right_handed: true", Some(true)),
            ("right_handed: false", Some(false)),
        ] {
            for up in ["", "up: Y", "up: Z", "rotate_degrees: (-90, 20, 7)"] {
                let fields = format!(
                    "radius: 1, {up}{} {fields}",
                    if up.is_empty() { "" } else { "," }
                );
                let scene = load_as_it_is(&name, &bytes, &fields).unwrap();
                let is_right_handed = expected.unwrap_or(is_right_handed);
                // In the world, whose axes are left-handed, right-handed ones look like themselves with z turned around.
                let expected = if is_right_handed { -6.0 } else { 6.0 };
                let found = volume(&scene);
                assert!((found - expected).abs() < 1e-9, "{name}, {fields}: {found}");
                assert_eq!(
                    scene.clouds()[0].is_right_handed,
                    is_right_handed,
                    "{name}, {fields}"
                );
            }
        }
    }
}

/// A right-handed helix about an axis that points up: its strands in front rise to the right, whatever program wrote it.
#[test]
fn right_handed_helices_are_right_handed() {
    let turn = |step: f64| {
        let angle: f64 = 0.3 * step;
        [5.0 * libm::cos(angle), 5.0 * libm::sin(angle), 0.4 * step]
    };
    let points: Vec<[f64; 3]> = (0..40).map(|step| turn(f64::from(step))).collect();
    let count = points.len();
    let rows = |row: fn([f64; 3]) -> String| points.iter().copied().map(row).collect::<String>();
    let xyz = rows(|[x, y, z]| format!("C {x} {y} {z}\n"));
    let pdb = rows(|[x, y, z]| {
        format!("HETATM    1  C   LIG A   1    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00           C\n")
    });
    let plain = rows(|[x, y, z]| format!("{x},{y},{z}\n"));
    for (name, text, fields, is_right_handed) in [
        ("a.xyz", format!("{count}\n\n{xyz}"), "up: Z", true),
        (
            "a.xyz",
            format!("{count}\n\n{xyz}"),
            "rotate_degrees: (-90, 0, 0)",
            true,
        ),
        ("a.pdb", pdb + "END\n", "up: Z", true),
        ("a.csv", format!("x,y,z\n{plain}"), "up: Z", false),
        (
            "a.csv",
            format!("x,y,z\n{plain}"),
            "up: Z, right_handed: true",
            true,
        ),
    ] {
        let scene = load_as_it_is(name, text, &format!("radius: 1, {fields}")).unwrap();
        // Seen along z, x points to the right and y up.
        let rises = spheres(&scene)
            .windows(2)
            .filter(|pair| pair[0][2] < -4.0)
            .map(|pair| (pair[1][1] - pair[0][1]) * (pair[1][0] - pair[0][0]) > 0.0)
            .collect::<Vec<bool>>();
        assert!(rises.len() > 5, "{name}");
        assert!(
            rises.iter().all(|rises| *rises == is_right_handed),
            "{name}, {fields}: {rises:?}"
        );
    }
}

/// The scene file says what points up, of either hands.
#[test]
fn z_points_up_where_the_scene_says_so() {
    for ending in ["csv", "xyz"] {
        let (bytes, _) = table(ending);
        let scene = load_as_it_is(&format!("a.{ending}"), &bytes, "radius: 1, up: Z").unwrap();
        let spheres = spheres(&scene);
        assert_eq!(spheres[3][1] - spheres[0][1], 3.0, "{ending}");
        assert_eq!(spheres[1][0] - spheres[0][0], 1.0, "{ending}");
    }
}

/// A left-handed format whose z points up is mirrored without a word of the scene only with a warning.
#[test]
fn axes_that_are_left_open_are_a_warning() {
    for (ending, up, is_warned) in [
        ("csv", "up: Z", true),
        ("npy", "up: Z", true),
        ("csv", "up: Z, right_handed: false", false),
        ("csv", "up: Z, right_handed: true", false),
        ("csv", "up: Y", false),
        ("xyz", "up: Z", false),
        ("pdb", "up: Z", false),
    ] {
        let (bytes, _) = table(ending);
        let scene = load_as_it_is(&format!("a.{ending}"), &bytes, &format!("radius: 1, {up}"));
        let scene = scene.unwrap();
        let warnings = scene.warnings().iter();
        let count = warnings.filter(|it| it.contains("mirror image")).count();
        assert_eq!(count, usize::from(is_warned), "{ending}, {up}");
    }
}

/// All steps of a cloud have the same hands, and its middle stays where it is.
#[test]
fn steps_are_right_handed() {
    let folder = Folder::new();
    let frame = |z: f64| format!("2\n\nC 0 0 {z}\nC 0 0 {}\n", z + 1.0);
    fs::write(folder.0.join("a.xyz"), frame(1.0) + &frame(3.0)).unwrap();
    let depths = |center: bool, frame| {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
             clouds: [(file: \"a.xyz\", frames: All, radius: 1, center: {center})])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
        let world = scene.world_at(frame).unwrap();
        let depths = world.spheres().iter().map(|sphere| sphere.center().z);
        depths.collect::<Vec<_>>()
    };
    assert_eq!(
        (depths(false, 1), depths(false, 2)),
        (vec![-1.0, -2.0], vec![-3.0, -4.0])
    );
    assert_eq!(
        (depths(true, 1), depths(true, 2)),
        (vec![1.5, 0.5], vec![-0.5, -1.5])
    );
}
