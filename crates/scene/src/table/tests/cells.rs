//! The cells of periodic tables: repeats, and spheres that are moved or shown at several faces.

use super::*;

/// Two atoms in a tilted cell away from the origin.
pub(super) const TILTED: &str = "2\nLattice=\"4 0 0 1 5 0 -1 0.5 6\" Origin=\"10 20 30\" Properties=species:S:1:pos:R:3\n\
                      O 10 20 30\nH 11 22 33\n";

/// The centers of all spheres.
pub(super) fn centers(scene: &Scene) -> Vec<[f64; 3]> {
    let spheres = scene.world().spheres().iter();
    spheres.map(|sphere| sphere.center().to_array()).collect()
}

fn is_near(found: &[[f64; 3]], expected: &[[f64; 3]]) -> bool {
    let near = |(a, b): (&[f64; 3], &[f64; 3])| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    found.len() == expected.len() && found.iter().zip(expected).all(near)
}

fn sorted(mut centers: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    centers.sort_by(|a, b| a.partial_cmp(b).unwrap());
    centers
}

/// The edges and the corner of a table's cell.
fn cell(name: &str, text: &str) -> Option<([[f64; 3]; 3], [f64; 3])> {
    let scene = scene(name, text, "radius: 1");
    let cell = scene.clouds()[0].cell.clone()?;
    Some((
        cell.edges.map(|edge| edge.to_array()),
        cell.origin.to_array(),
    ))
}

/// A dump whose box has these kinds and bounds.
pub(super) fn dump(kinds: &str, bounds: &str, columns: &str, atoms: &[&str]) -> String {
    let count = atoms.len();
    let atoms = atoms.join("\n");
    format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS {kinds}\n{bounds}\nITEM: ATOMS {columns}\n{atoms}\n"
    )
}

#[test]
fn every_format_with_a_cell_tells_it() {
    let tilted = [[4.0, 0.0, 0.0], [1.0, 5.0, 0.0], [-1.0, 0.5, 6.0]];
    let right = [[4.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 6.0]];
    let oblique = [
        [4.0, 0.0, 0.0],
        [-2.5, 0.75_f64.sqrt() * 5.0, 0.0],
        [0.0, 0.0, 6.0],
    ];
    let (zero, corner) = ([0.0; 3], [10.0, 20.0, 30.0]);
    let atom = ["C 1 2 3"];
    let pdb =
        "HETATM    1  C   LIG A   1       1.000   2.000   3.000  1.00  0.00           C\nEND\n";
    let cif = "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n1 2 3\n#\n";
    let angles = "_cell.angle_alpha 90\n_cell.angle_beta 90.0\n_cell.angle_gamma\n120\n";
    for (name, text, expected) in [
        ("a.xyz", TILTED.to_owned(), (tilted, corner)),
        (
            "a.xyz",
            "1\nlattice = '4 0 0 0 5 0 0 0 6' pbc=\"T T F\"\nC 1 2 3\n".to_owned(),
            (right, zero),
        ),
        (
            "a.dump",
            dump(
                "pp pp pp",
                "10 14\n20 25\n30 36",
                "type x y z",
                &["1 1 2 3"],
            ),
            (right, corner),
        ),
        // The bounds are those of the box around the tilted one.
        (
            "a.dump",
            dump(
                "xy xz yz pp pp pp",
                "9 15 1\n20 25.5 -1\n30 36 .5",
                "type x y z",
                &["1 1 2 3"],
            ),
            (tilted, corner),
        ),
        (
            "a.dump",
            dump(
                "abc origin pp pp pp",
                "4 0 0 10\n1 5 0 20\n-1 .5 6 30",
                "type x y z",
                &["1 1 2 3"],
            ),
            (tilted, corner),
        ),
        (
            "a.gro",
            "t\n1\n    1LIG      C    1   1.000   2.000   3.000\n 4 5 6\n".to_owned(),
            (right, zero),
        ),
        (
            "a.gro",
            "t\n1\n    1LIG      C    1   1.000   2.000   3.000\n 4 5 6 0 0 1 0 -1 0.5\n"
                .to_owned(),
            (tilted, zero),
        ),
        (
            "a.pdb",
            format!(
                "CRYST1    4.000    5.000    6.000  90.00  90.00 120.00 P 1           1\n{pdb}"
            ),
            (oblique, zero),
        ),
        (
            "a.pdb",
            format!("CRYST1 4 5 6 90 90 120\n{pdb}"),
            (oblique, zero),
        ),
        (
            "a.cif",
            format!(
                "data_a\n_cell.length_a 4\n_cell.length_b 5.0(1)\n_cell.length_c '6'\n{angles}loop_\n{cif}"
            ),
            (oblique, zero),
        ),
        (
            "a.vasp",
            format!(
                "C\n1\n4 0 0\n1 5 0\n-1 .5 6\nC\n1\nCartesian\n{}\n",
                &atom[0][2..]
            ),
            (tilted, zero),
        ),
    ] {
        let (edges, origin) =
            cell(name, &text).unwrap_or_else(|| panic!("{name} has a cell: {text}"));
        assert!(is_near(&edges, &expected.0), "{name}: {edges:?} of {text}");
        assert!(is_near(&[origin], &[expected.1]), "{name}: {origin:?}");
    }
    let no_cell = "CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1           1\n";
    for (name, text) in [
        ("a.xyz", "1\n\nC 1 2 3\n".to_owned()),
        ("a.pdb", pdb.to_owned()),
        ("a.pdb", format!("{no_cell}{pdb}")),
        ("a.cif", format!("data_a\n_cell.length_a ?\nloop_\n{cif}")),
        (
            "a.gro",
            "t\n1\n    1LIG      C    1   1.000   2.000   3.000\n 0 0 0\n".to_owned(),
        ),
    ] {
        assert_eq!(cell(name, &text), None, "{name}: {text}");
    }
}

#[test]
fn cells_are_repeated_along_their_edges() {
    let scene = scene("a.xyz", TILTED, "repeat: (2, 1, 3)");
    let images = [
        [0., 0., 0.],
        [-1., 0.5, 6.],
        [-2., 1., 12.],
        [4., 0., 0.],
        [3., 0.5, 6.],
        [2., 1., 12.],
    ];
    let atoms = [[10., 20., 30.], [11., 22., 33.]];
    let all = images
        .iter()
        .flat_map(|image| atoms.map(|atom| [0, 1, 2].map(|axis| atom[axis] + image[axis])));
    assert!(
        is_near(&centers(&scene), &all.collect::<Vec<_>>()),
        "{:?}",
        centers(&scene)
    );
    // Colors and radii go with their atoms.
    let spheres = spheres(&scene);
    let albedos = albedos(&scene);
    for (place, sphere) in spheres.iter().enumerate() {
        assert_eq!(
            (sphere[3], albedos[place]),
            (spheres[place % 2][3], albedos[place % 2])
        );
    }
    assert_ne!(albedos[0], albedos[1]);
    let cloud = &scene.clouds()[0];
    assert_eq!((cloud.rows, cloud.kept, cloud.spheres.len()), (2, 2, 12));
}

/// What is kept, colored by numbers or by columns of colors, is repeated so.
#[test]
fn repeats_keep_selections_and_colors() {
    let text = "3\nLattice=\"2 0 0 0 2 0 0 0 2\" Properties=species:S:1:pos:R:3:q:R:1:color:R:3\n\
                C 0 0 0 1 1 0 0\nN 1 0 0 2 0 1 0\nC 0 1 0 3 0 0 1\n";
    let kept = "keep: [(\"species\", Is(\"C\"))], repeat: (1, 2, 1)";
    let by_table = scene("a.xyz", text, kept);
    let [red, blue] = [Color::new(1.0, 0.0, 0.0), Color::new(0.0, 0.0, 1.0)];
    assert_eq!(albedos(&by_table), [red, blue, red, blue]);
    assert_eq!(
        (by_table.clouds()[0].rows, by_table.clouds()[0].kept),
        (3, 2)
    );
    for coloring in [
        "color: Value, value: \"q\"",
        "color: Category, value: \"q\"",
        "color: Element",
    ] {
        let one = albedos(&scene("a.xyz", text, coloring));
        let two = albedos(&scene(
            "a.xyz",
            text,
            &format!("{coloring}, repeat: (1, 2, 1)"),
        ));
        assert_eq!(two, [&one[..], &one[..]].concat(), "{coloring}");
    }
}

/// Positions by ASE 3.29.0: `Atoms(…, cell=…, pbc=…).wrap()`.
#[test]
fn centers_are_wrapped_into_the_cell() {
    let atoms = "C -0.5 0.2 0.1\nC 4.2 5.6 6.3\nC 100 -70 33\nC 1e-9 -1e-9 0\nC 3.9999 2 3\n";
    let wrapped = |pbc: &str| {
        let text = format!(
            "5\nLattice=\"4 0 0 1 5 0 -1 0.5 6\" Properties=species:S:1:pos:R:3{pbc}\n{atoms}"
        );
        centers(&scene("a.xyz", text, "wrap: true"))
    };
    let all = [
        [3.5, 0.2, 0.1],
        [0.2, 0.1, 0.3],
        [0.0, 2.5, 3.0],
        [1e-9, -1e-9, 0.0],
        [-1e-4, 2.0, 3.0],
    ];
    assert!(is_near(&wrapped(""), &all), "{:?}", wrapped(""));
    assert_eq!(wrapped(" pbc=\"T T T\""), wrapped(""));
    let two = [
        [3.5, 0.2, 0.1],
        [1.2, 5.1, 0.3],
        [-15.0, -72.5, 3.0],
        [1e-9, -1e-9, 0.0],
        [-1e-4, 2.0, 3.0],
    ];
    assert!(
        is_near(&wrapped(" pbc=\"T F T\""), &two),
        "{:?}",
        wrapped(" pbc=\"T F T\"")
    );
}

#[test]
fn boundaries_of_dumps_tell_along_which_edges_cells_repeat() {
    for (kinds, expected) in [
        ("pp pp pp", [1.0, 1.0, 1.0]),
        ("pp ff ss", [1.0, 11.0, 11.0]),
        ("", [1.0; 3]),
    ] {
        let text = dump(kinds, "0 10\n0 10\n0 10", "type x y z", &["1 11 11 11"]);
        assert_eq!(
            centers(&scene("a.dump", text, "radius: 1, wrap: true")),
            [expected],
            "{kinds}"
        );
    }
}

#[test]
fn image_flags_bring_particles_back_out_of_the_cell() {
    let atoms = ["1 1 2 3 0 0 0", "1 1 2 3 1 -2 3"];
    let columns = "type x y z ix iy iz";
    for (kinds, bounds, expected) in [
        ("pp pp pp", "0 4\n0 5\n0 6", [5.0, -8.0, 21.0]),
        (
            "xy xz yz pp pp pp",
            "-1 5 1\n0 5.5 -1\n0 6 .5",
            [1. + 4. - 2. - 3., 2. - 10. + 1.5, 3. + 18.],
        ),
    ] {
        let text = dump(kinds, bounds, columns, &atoms);
        let found = centers(&scene("a.dump", text, "radius: 1, unwrap: true"));
        assert!(is_near(&found, &[[1.0, 2.0, 3.0], expected]), "{found:?}");
    }
    // Fractions of the cell, and XYZ.
    let text = dump(
        "pp pp pp",
        "0 4\n0 5\n0 6",
        "type xs ys zs ix iy iz",
        &["1 .5 .5 .5 0 1 0"],
    );
    assert_eq!(
        centers(&scene("a.dump", text, "radius: 1, unwrap: true")),
        [[2.0, 7.5, 3.0]]
    );
    let text = "1\nLattice=\"4 0 0 0 5 0 0 0 6\" Properties=species:S:1:pos:R:3:ix:I:1:iy:I:1:iz:I:1\nC 1 2 3 -1 0 0\n";
    assert_eq!(
        centers(&scene("a.xyz", text, "unwrap: true")),
        [[-3.0, 2.0, 3.0]]
    );
    // What is unwrapped already stays as it is.
    let text = dump(
        "pp pp pp",
        "0 4\n0 5\n0 6",
        "type xu yu zu ix iy iz",
        &["1 9 9 9 2 1 1"],
    );
    assert_eq!(
        centers(&scene("a.dump", text, "radius: 1, unwrap: true")),
        [[9.0; 3]]
    );
}

#[test]
fn what_lies_on_a_face_is_shown_on_the_opposite_one() {
    let images = |position: &str, fields: &str| {
        let text = format!("1\nLattice=\"2 0 0 0 3 0 0 0 4\"\nC {position}\n");
        sorted(centers(&scene("a.xyz", text, fields)))
    };
    // A corner, an edge, a face, the inside.
    let corners: Vec<[f64; 3]> = (0..8)
        .map(|i| {
            [
                2.0 * f64::from(i / 4),
                3.0 * f64::from(i / 2 % 2),
                4.0 * f64::from(i % 2),
            ]
        })
        .collect();
    assert_eq!(images("0 0 0", "edges: true"), corners);
    assert_eq!(images("2 3 4", "edges: true"), corners);
    assert_eq!(
        images("1 0 0", "edges: true"),
        [[1., 0., 0.], [1., 0., 4.], [1., 3., 0.], [1., 3., 4.]]
    );
    assert_eq!(images("1 1 0", "edges: true"), [[1., 1., 0.], [1., 1., 4.]]);
    assert_eq!(images("1 1 1", "edges: true"), [[1.0, 1.0, 1.0]]);
    // Within a thousandth of the edge, and not beyond.
    assert_eq!(images("0.0019 1 1", "edges: true").len(), 2);
    assert_eq!(images("-0.0019 1 1", "edges: true").len(), 2);
    assert_eq!(images("0.0021 1 1", "edges: true").len(), 1);
    // The faces are those of the block of all cells.
    let block = images("0 1 1", "edges: true, repeat: (2, 1, 2)");
    assert_eq!(
        block,
        [
            [0., 1., 1.],
            [0., 1., 5.],
            [2., 1., 1.],
            [2., 1., 5.],
            [4., 1., 1.],
            [4., 1., 5.]
        ]
    );
    assert_eq!(images("0 0 0", "edges: true, repeat: (2, 2, 2)").len(), 27);
    // Outside of the cell there are no faces; wrapping comes first.
    assert_eq!(images("-2 1 1", "edges: true").len(), 1);
    assert_eq!(
        images("-2 1 1", "edges: true, wrap: true"),
        [[0., 1., 1.], [2., 1., 1.]]
    );
    let text = "1\nLattice=\"2 0 0 0 3 0 0 0 4\" pbc=\"F T T\"\nC 0 0 0\n";
    assert_eq!(centers(&scene("a.xyz", text, "edges: true")).len(), 4);
}

/// Each frame is repeated by its own cell, and the middle of all frames knows of the repeats.
#[test]
fn frames_have_their_own_cells() {
    let frame = |size: f64| format!("1\nLattice=\"{size} 0 0 0 {size} 0 0 0 {size}\"\nC 0 0 0\n");
    let folder = Folder::new();
    fs::write(folder.0.join("a.xyz"), frame(2.0) + &frame(3.0)).unwrap();
    let model = |number: u32| {
        format!(
            "MODEL {number:>8}\nHETATM    1  C   LIG A   1       0.000   0.000   0.000  1.00  0.00           C\nENDMDL\n"
        )
    };
    let pdb = format!(
        "CRYST1    2.000    2.000    2.000  90.00  90.00  90.00\n{}{}",
        model(1),
        model(2)
    );
    fs::write(folder.0.join("a.pdb"), pdb).unwrap();
    let at = |file: &str, center: bool, frame| {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
             clouds: [(file: \"{file}\", frames: All, radius: 1, repeat: (2, 1, 1), center: {center})])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
        let world = scene.world_at(frame).unwrap();
        let along = world.spheres().iter().map(|sphere| sphere.center().x);
        along.collect::<Vec<_>>()
    };
    assert_eq!(
        (at("a.xyz", false, 1), at("a.xyz", false, 2)),
        (vec![0.0, 2.0], vec![0.0, 3.0])
    );
    assert_eq!(
        (at("a.xyz", true, 1), at("a.xyz", true, 2)),
        (vec![-1.5, 0.5], vec![-1.5, 1.5])
    );
    // The cell before the first model is that of all.
    assert_eq!(
        (at("a.pdb", false, 2), at("a.pdb", false, 1)),
        (vec![0.0, 2.0], vec![0.0, 2.0])
    );
}

/// The camera has all repeats in its picture.
#[test]
fn cameras_frame_the_repeats() {
    let folder = Folder::new();
    fs::write(folder.0.join("a.xyz"), TILTED).unwrap();
    let distance = |repeat: &str| {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(30), camera: Frame(), clouds: [(file: \"a.xyz\", repeat: {repeat})])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
        scene.view(1).unwrap().camera.position.z.abs()
    };
    assert!(distance("(9, 9, 9)") > 4.0 * distance("(1, 1, 1)"));
}
