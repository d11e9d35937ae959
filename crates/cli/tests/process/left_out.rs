//! Contents of tables that no sphere shows: every command says them with their places, and `--strict` ends with an error.

use std::fs;

use crate::folder::{Folder, code, text};

const ATOM: &str =
    "ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.00           N\n";

fn folder(files: &[(&str, String)], cloud: &str) -> Folder {
    let folder = Folder::new();
    for (name, contents) in files {
        fs::write(folder.path(name), contents).unwrap();
    }
    let scene = format!(
        "(image: (width: 30, height: 20), lens: Fov(40), camera: Free(position: (11, 6, -9)),
          lights: [Directional(toward: (1, 1, -1))], clouds: [({cloud})])"
    );
    fs::write(folder.path("a.ron"), scene).unwrap();
    folder
}

#[test]
fn what_a_table_has_beside_its_spheres_is_told_by_every_command() {
    let cif = "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
    for (name, contents, told) in [
        (
            "a.xyz",
            "1\n\nN 11 6 1\nO 12 6 1\n".to_owned(),
            "a.xyz:4: no frame follows the first one here: ",
        ),
        (
            "a.csv",
            "x (mm),y (mm),z (mm),r (m)\n11,6,1,0.5\n".to_owned(),
            "a.csv: the columns `x (mm)` and `r (m)` have different units",
        ),
        (
            "a.cif",
            format!("{cif}N 11 6 1\n#\n{cif}O 11 6 2\n#\n"),
            "a.cif: the first frame of several is shown",
        ),
    ] {
        let folder = folder(&[(name, contents)], &format!("file: \"{name}\""));
        for command in [
            "check a.ron",
            "check --json a.ron",
            "render a.ron -o a.png",
            "spheres a.ron -o a.csv.out",
        ] {
            let output = folder.run(command);
            let errors = text(&output.stderr);
            assert_eq!(code(&output), 0, "{command}: {errors}");
            assert!(errors.contains(told), "{command}: {errors}");
            if command.contains("--json") {
                let json = text(&output.stdout);
                assert!(
                    json.contains("\"warnings\"") && json.contains(told),
                    "{json}"
                );
            }
            if !command.starts_with("spheres") {
                let strict = folder.run(&format!("{command} --strict"));
                assert_eq!(code(&strict), 2, "{}", text(&strict.stderr));
            }
        }
    }
}

/// A file that is read while others are rendered.
#[test]
fn what_later_files_have_is_told_at_the_end() {
    let whole = format!("{ATOM}END\n");
    let files = [
        ("a1.pdb", whole.clone()),
        ("a2.pdb", format!("{ATOM}END\n{ATOM}END\n")),
        ("a3.pdb", whole),
    ];
    let folder = folder(&files, "file: \"a#.pdb\"");
    let output = folder.run("render a.ron -o o#.png");
    let errors = text(&output.stderr);
    assert_eq!(code(&output), 0, "{errors}");
    assert!(
        errors.contains("a2.pdb: the first frame of several is shown"),
        "{errors}"
    );
    let strict = folder.run("render a.ron -o o#.png --strict");
    assert_eq!(code(&strict), 1, "{}", text(&strict.stderr));
    assert_eq!(
        code(&folder.run("render a.ron -o o#.png --strict --frames 3")),
        0
    );
}
