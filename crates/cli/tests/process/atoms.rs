//! Tables of atoms: output about their handedness, elements and colors.

use std::fs;

use crate::folder::{Folder, code, text};

/// A scene with a cloud.
fn scene(cloud: &str) -> String {
    format!(
        "(image: (width: 30, height: 20), lens: Fov(40), camera: Orbit(target: (0, 0, 0), radius: 25),
          lights: [Directional(toward: (1, 1, -1))], clouds: [({cloud})])"
    )
}

fn folder(table: &str, contents: &str, fields: &str) -> Folder {
    let folder = Folder::new();
    fs::write(folder.path(table), contents).unwrap();
    let cloud = format!("file: \"{table}\", {fields}");
    fs::write(folder.path("a.ron"), scene(&cloud)).unwrap();
    folder
}

#[test]
fn hands_and_elements_are_told() {
    let folder = folder("a.xyz", "2\n\nO 0 0 0\nH 0 0 1\n", "");
    let lines = folder.run("check a.ron");
    assert_eq!(code(&lines), 0);
    let lines = text(&lines.stdout);
    assert!(lines.contains("\n  axes      right-handed\n"), "{lines}");
    assert!(
        lines.contains("element: 2 texts: \"O\", \"H\"; 2 colors\n"),
        "{lines}"
    );
    let json = text(&folder.run("check a.ron --json").stdout);
    assert!(json.contains("\"right_handed\": true"), "{json}");
    assert!(json.contains("\"name\": \"H\""), "{json}");
    let left = folder.run("check a.ron --set clouds[0].right_handed=false");
    let left = text(&left.stdout);
    assert!(
        left.contains("\n  axes      left-handed, like the scene\n"),
        "{left}"
    );
    assert_eq!(code(&folder.run("render a.ron -o a.png --legend a.svg")), 0);
    let legend = String::from_utf8(folder.read("a.svg")).unwrap();
    assert!(
        legend.contains(">O<") && legend.contains("#ff0d0d"),
        "{legend}"
    );
}

#[test]
fn what_is_unknown_is_a_warning_and_an_error_where_these_are() {
    let folder = folder("a.xyz", "2\n\nO 0 0 0\nMW 0 0 1\n", "");
    for command in ["check a.ron", "check --json a.ron", "render a.ron -o a.png"] {
        let output = folder.run(command);
        let errors = text(&output.stderr);
        assert_eq!(code(&output), 0, "{errors}");
        assert!(errors.contains("a.xyz:4:1: expected elements"), "{errors}");
        let strict = folder.run(&format!("{command} --strict"));
        assert_eq!(code(&strict), 2, "{}", text(&strict.stderr));
    }
}

/// A step that is read while others are rendered.
#[test]
fn what_is_unknown_in_later_steps_is_told_at_the_end() {
    let steps = "1\n\nO 0 0 0\n1\n\nMW 0 0 0\n";
    let folder = folder("a.xyz", steps, "frames: All");
    let output = folder.run("render a.ron -o #.png");
    let errors = text(&output.stderr);
    assert_eq!(code(&output), 0, "{errors}");
    assert!(errors.contains("a.xyz:6:1: expected elements"), "{errors}");
    let strict = folder.run("render a.ron -o #.png --strict");
    assert_eq!(code(&strict), 1, "{}", text(&strict.stderr));
}

#[test]
fn categories_that_share_colors_are_counted() {
    let rows: String = (0..14)
        .map(|chain| format!("{chain},0,0,1,chain {chain}\n"))
        .collect();
    let table = format!("x,y,z,r,chain\n{rows}");
    let folder = folder("a.csv", &table, "value: \"chain\"");
    let output = folder.run("check a.ron");
    let lines = text(&output.stdout);
    assert!(lines.contains("; 14 categories, 12 colors\n"), "{lines}");
    let errors = text(&output.stderr);
    assert!(errors.contains("4 of them share colors"), "{errors}");
    assert_eq!(code(&folder.run("check a.ron --strict")), 2);
}
