//! Files that are no scenes.

use std::{env, fs, process};

use crate::Scene;

fn refusal(name: &str, bytes: impl AsRef<[u8]>) -> String {
    let path = env::temp_dir().join(format!("marbles-other-{}-{name}", process::id()));
    fs::write(&path, bytes).unwrap();
    let error = Scene::load(&path).unwrap_err();
    fs::remove_file(&path).unwrap();
    let message = error.to_string();
    message
        .split_once(&format!("{name}: "))
        .map_or(message.clone(), |parts| parts.1.to_owned())
}

#[test]
fn tables_say_how_a_scene_shows_them() {
    let pdb = "HETATM    1 CA    CA B   2       0.000   0.000   0.000  1.00 30.00\nEND\n";
    for (name, bytes, kind) in [
        ("a.pdb", pdb.as_bytes(), "PDB"),
        ("b", pdb.as_bytes(), "PDB"),
        ("c.ron", pdb.as_bytes(), "PDB"),
        ("d.npy", b"\x93NUMPY\x01\0", "NPY"),
        ("e.csv", b"x,y,z\n", "CSV"),
        ("f.xyz", b"2\n\nC 0 0 0\nC 1 1 1\n", "XYZ"),
        ("g.dump.gz", b"\x1f\x8b\x08\0", "a dump of LAMMPS"),
    ] {
        let message = refusal(name, bytes);
        let start = format!(
            "expected a scene, found a table ({kind}). A scene names the table, for example"
        );
        assert!(message.starts_with(&start), "{message}");
        // The scene that it shows is one, up to the table.
        let scene = message.split('`').nth(1).unwrap();
        let error = Scene::parse(scene, "scene.ron".as_ref()).unwrap_err();
        assert!(error.to_string().contains("found no file"), "{error}");
    }
    let message = refusal("a.mol2", "@<TRIPOS>MOLECULE\n");
    assert!(
        message.starts_with("expected a scene, found a molecule in MOL2: save"),
        "{message}"
    );
    // What looks like a scene is one.
    for (name, text) in [
        ("a.csv", "(image: )"),
        ("b.ron", "{\"image\": 3}"),
        ("c.ron", "image: 3"),
    ] {
        let message = refusal(name, text);
        assert!(
            !message.contains("found a table") && !message.contains("JSON"),
            "{message}"
        );
    }
}
