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
fn tables_are_told_from_scenes() {
    let pdb = "HETATM    1 CA    CA B   2       0.000   0.000   0.000  1.00 30.00\nEND\n";
    let rows = b"0 0 0\n1 2 3\n";
    for (name, bytes, is_table) in [
        ("a.pdb", pdb.as_bytes(), true),
        ("b", pdb.as_bytes(), true),
        ("c.ron", pdb.as_bytes(), true),
        ("d.npy", b"\x93NUMPY\x01\0", true),
        ("e.csv", b"x,y,z\n", true),
        ("f.xyz", b"2\n\nC 0 0 0\nC 1 1 1\n", true),
        ("g.dump.gz", b"\x1f\x8b\x08\0", true),
        ("h.gz", b"\x1f\x8b\x08\0", true),
        ("h.zst", b"(\xb5\x2f\xfd\x04\0", true),
        ("h.csv.xz", b"\xfd7zXZ\0\0\x04", true),
        ("h", b"BZh91AY&SY", true),
        ("i", rows, true),
        // A title in parentheses.
        ("k.lmp", b"(by hand)\n\n2 atoms\n1 atom types\n", true),
        (
            "k",
            b"(by hand)\n\n\n  1  0  0  0  0  0  0  0  0  0999 V2000\n",
            true,
        ),
        (
            "k.gro",
            b"(by hand)\n1\n    1LIG      C    1   5.000   5.000   5.000\n 9 9 9\n",
            true,
        ),
        (
            "k",
            b"(by hand)\n1\n    1LIG      C    1   5.000   5.000   5.000\n 9 9 9\n",
            true,
        ),
        (
            "POSCAR",
            b"(by hand)\n1\n9 0 0\n0 9 0\n0 0 9\nC\n1\nCartesian\n1 2 3\n",
            true,
        ),
        (
            "k.ron",
            b"(by hand)\n1\n    1LIG      C    1   5.000   5.000   5.000\n 9 9 9\n",
            false,
        ),
        ("k.ron", b"(by hand)\n\n2 atoms\n1 atom types\n", false),
        ("i.ron", b"(image: 0 0 0)", false),
        ("j", b"image: 0 0 0", false),
    ] {
        let path = env::temp_dir().join(format!("marbles-kind-{}-{name}", process::id()));
        fs::write(&path, bytes).unwrap();
        assert_eq!(Scene::is_table(&path).unwrap(), is_table, "{name}");
        fs::remove_file(&path).unwrap();
    }
}

#[test]
fn other_files_are_named() {
    let message = refusal("a.cml", "<molecule/>\n");
    assert!(
        message
            .starts_with("expected a scene or a table of particles, found a molecule in CML: save"),
        "{message}"
    );
    // All that a text has comes before its first byte of 0.
    let mut archive = b"a.pdb".to_vec();
    archive.resize(257, 0);
    archive.extend(b"ustar  \0");
    let message = refusal("a.pdb.bz2", archive);
    assert!(message.contains("found an archive: unpack it"), "{message}");
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
