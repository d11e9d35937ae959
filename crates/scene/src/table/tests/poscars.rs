//! Structures and trajectories of VASP.

use super::crystals::{atoms, check};
use super::*;

/// Against ASE 3.29.0, whose cells of 2 x 2 x 2 are frozen in `crystals`.
#[test]
fn eight_cells_of_a_structure_are_those_of_ase() {
    let fields = "radii: Covalent, repeat: (2, 2, 2)";
    let blende = scene("blende.vasp", include_str!("crystals/blende.vasp"), fields);
    check(
        &atoms(&blende, &[(1.22, "Zn"), (1.05, "S")]),
        include_str!("crystals/blende.txt"),
    );
}

#[test]
fn structures_have_many_forms() {
    let expected = [[0.0, 0.0, 0.0, 1.66], [2.0, 1.5, 1.0, 1.02]];
    let plain = "salt\n1\n4 0 0\n0 3 0\n0 0 2\nNa Cl\n1 1\nDirect\n0 0 0\n.5 .5 .5\n";
    for text in [
        plain.to_owned(),
        plain
            .replace("\n1\n4", "\n 2.0 scale\n4")
            .replace("4 0 0\n0 3 0\n0 0 2", "2 0 0\n0 1.5 0\n0 0 1"),
        plain
            .replace("\n1\n4", "\n-24\n4")
            .replace("4 0 0\n0 3 0\n0 0 2", "8 0 0\n0 6 0\n0 0 4"),
        plain.replace("\n1\n4 0 0\n0 3 0\n0 0 2", "\n4 3 2\n1 0 0\n0 1 0\n0 0 1"),
        plain.replace("Direct\n0 0 0\n.5 .5 .5", "Cartesian\n0 0 0\n2 1.5 1"),
        plain.replace(
            "Direct\n0 0 0\n.5 .5 .5",
            "K\n0 0 0 Na\n2 1.5 1 Cl # by hand",
        ),
        plain
            .replace("\n1\n4 0 0\n0 3 0\n0 0 2", "\n2\n2 0 0\n0 1.5 0\n0 0 1")
            .replace("Direct\n0 0 0\n.5 .5 .5", "cart\n0 0 0\n1 .75 .5"),
        plain.replace(
            "Direct\n0 0 0\n.5 .5 .5",
            "Selective dynamics\nDirect\n0 0 0 T T T\n.5 .5 .5 F F F",
        ),
        plain.replace("Na Cl", "Na_pv Cl/0a1b2c"),
        plain
            .replace("salt", "Na Cl by hand")
            .replace("Na Cl\n1 1", "1 1"),
        plain.replace('\n', "\r\n"),
        // Velocities, and what molecular dynamics needs.
        plain.to_owned() + "\n 0.1 0.2 0.3\n 0.1 0.2 0.3\n",
        plain.to_owned() + "Cartesian\n 0.1 0.2 0.3\n 0.1 0.2 0.3\n",
    ] {
        for name in ["POSCAR", "a.vasp", "a.poscar", "POSCAR.1", "a"] {
            let scene = scene(name, &text, "radii: Covalent");
            let found = spheres(&scene);
            let near = |(a, b): (&[f64; 4], &[f64; 4])| {
                a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
            };
            assert!(
                found.len() == 2 && found.iter().zip(&expected).all(near),
                "{found:?} of {text}"
            );
            assert_eq!(warnings(&scene), "", "{text}");
        }
    }
    let kept = scene("POSCAR", plain, "keep: [(\"element\", Is(\"Cl\"))]");
    assert_eq!(spheres(&kept).len(), 1);
    let by_height = scene("POSCAR", plain, "keep: [(\"z\", Between(0, 0.2))]");
    assert_eq!(spheres(&by_height).len(), 1);
}

/// Kinds without names have numbers, which `radii` may name.
#[test]
fn kinds_without_names_are_numbered() {
    let text = "a title\n1\n4 0 0\n0 3 0\n0 0 2\n1 2\nDirect\n0 0 0\n.5 .5 .5\n.5 0 0\n";
    let named = scene(
        "POSCAR",
        text,
        "radii: {\"1\": 0.5, \"2\": 0.25}, palette: {\"2\": 1}",
    );
    let radii: Vec<f64> = spheres(&named).iter().map(|sphere| sphere[3]).collect();
    assert_eq!(radii, [0.5, 0.25, 0.25]);
    let unnamed = warnings(&scene("POSCAR", text, ""));
    assert!(unnamed.contains("`1` (1 row), `2` (2 rows)"), "{unnamed}");
}

/// Frames share a cell, or tell their own.
#[test]
fn trajectories_have_frames() {
    let start = "salt\n1\n4 0 0\n0 4 0\n0 0 4\nNa Cl\n1 1\n";
    let frame =
        |number: u32, x: f64| format!("Direct configuration= {number:>5}\n{x} 0 0\n.5 .5 .5\n");
    let fixed = format!(
        "{start}{}{}{}",
        frame(1, 0.0),
        frame(2, 0.25),
        frame(3, 0.5)
    );
    let larger = start.replace('4', "8");
    let variable = format!(
        "{start}{}{larger}{}{start}{}",
        frame(1, 0.0),
        frame(2, 0.25),
        frame(3, 0.5)
    );
    for (text, expected) in [(fixed, [0.0, 1.0, 2.0]), (variable, [0.0, 2.0, 2.0])] {
        let folder = Folder::new();
        fs::write(folder.0.join("XDATCAR"), &text).unwrap();
        let scene = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
            clouds: [(file: \"XDATCAR\", frames: All, repeat: (2, 1, 1))])";
        let series = Scene::parse(scene, &folder.0.join("scene.ron")).unwrap();
        assert_eq!(series.frames(), Some(1..=3));
        for frame in [3, 1, 2] {
            let world = series.world_at(frame).unwrap();
            let spheres = world.spheres();
            assert_eq!(spheres.len(), 4);
            assert_eq!(
                spheres[0].center().x,
                expected[frame as usize - 1],
                "{frame} of {text}"
            );
        }
        let first = super::scene("XDATCAR", &text, "");
        assert!(warnings(&first).contains("the first frame of several is shown"));
    }
}

#[test]
fn damaged_structures_are_refused_with_their_lines() {
    let good = "salt\n1\n4 0 0\n0 3 0\n0 0 2\nNa Cl\n1 1\nDirect\n0 0 0\n.5 .5 .5\n";
    for (text, expected) in [
        (
            "",
            "a.vasp:1:1: expected a title, found the end of the file",
        ),
        ("salt\n", "a.vasp:2:1: expected a scaling factor"),
        (
            "salt\n0\n",
            "a.vasp:2:1: expected a scaling factor, the volume of the cell as a negative number, or three factors greater than 0, found 0",
        ),
        ("salt\nnan\n", "a.vasp:2:1: expected a scaling factor"),
        ("salt\n1 -1 1\n", "a.vasp:2:1: expected a scaling factor"),
        (
            "salt\n1\n4 0\n",
            "a.vasp:3:1: expected three numbers, an edge of the cell, found 4 0",
        ),
        (
            "salt\n1\n4 0 0\n0 3 0\n0 3 0\n",
            "a.vasp:5:1: expected a cell of three finite edges that span a volume, found one without a volume",
        ),
        (
            "salt\n1\n4 0 0\n0 nan 0\n0 3 0\n",
            "a.vasp:5:1: expected a cell of three finite edges that span a volume, found an infinite one",
        ),
        (
            "salt\n-1\n4 0 0\n0 0 0\n0 3 0\n",
            "a.vasp:5:1: expected a cell of three finite edges that span a volume",
        ),
    ] {
        let message = refusal("a.vasp", text, "");
        assert!(message.starts_with(expected), "{message}\n{text}");
    }
    for (old, new, expected) in [
        (
            "Na Cl",
            "\"Na\"",
            "a.vasp:6:1: expected the symbols of the elements, or the numbers of their atoms, found",
        ),
        (
            "1 1\nD",
            "1 x\nD",
            "a.vasp:7:1: expected 2 numbers of atoms, one for each element above, found 1 x",
        ),
        ("1 1\nD", "1\nD", "a.vasp:7:1: expected 2 numbers of atoms"),
        (
            "1 1\nD",
            "1 18446744073709551615\nD",
            "a.vasp:7:1: expected fewer than 2^64 atoms, found more",
        ),
        (
            "1 1\nD",
            "1 99999999999999\nD",
            "a.vasp:11:1: expected 100000000000000 atoms, according to the numbers above (2 read), found the end of the file",
        ),
        (
            "Direct",
            "0 0 0",
            "a.vasp:8:1: expected `Direct` or `Cartesian`, found",
        ),
        (
            ".5 .5 .5",
            ".5 .5",
            "a.vasp:10:6: expected a number for `zs`, found the end of the line",
        ),
        (
            ".5 .5 .5",
            ".5 inf .5",
            "a.vasp:10:4: expected a finite number for `ys`, found inf",
        ),
        (
            ".5 .5 .5\n",
            "",
            "a.vasp:10:1: expected 2 atoms, according to the numbers above (1 read), found the end of the file",
        ),
    ] {
        let text = good.replace(old, new);
        let message = refusal("a.vasp", &text, "");
        assert!(message.starts_with(expected), "{message}\n{text}");
    }
    let more = scene("a.vasp", good.to_owned() + ".1 .1 .1\n", "");
    let told = warnings(&more);
    assert!(
        told.contains(
            "a.vasp:11: no frame follows the first one here: expected the end of the atoms"
        ),
        "{told}"
    );
}

/// Any byte of it may be another one.
#[test]
fn damaged_bytes_of_structures_are_found_or_harmless() {
    let text = "salt\n-24\n4 0 0\n0 3 0\n0 0 2\nNa Cl\n1 1\nSelective\nDirect configuration\n0 0 0\n.5 .5 .5\nDirect configuration\n0 0 0\n.5 .5 .5\n";
    for at in 0..text.len() {
        let _ = load("a.vasp", &text[..at], "edges: true, frames: All");
        for other in [b'\n', b'-', b'9'] {
            let mut bytes = text.to_owned().into_bytes();
            bytes[at] = other;
            if let Err(message) = load("a.vasp", bytes, "edges: true, frames: All") {
                assert!(
                    message.contains("expected ") && message.contains("found "),
                    "{message}"
                );
            }
        }
    }
}
