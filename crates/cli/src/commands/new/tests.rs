use super::*;
use crate::tests::{run_here, temporary};

#[test]
fn new_scenes_are_valid_and_rendered() {
    let folder = temporary("new-valid");
    for (name, option) in [("still", None), ("turn", Some("--turntable"))] {
        let scene = folder.join(format!("{name}.ron"));
        let scene = scene.to_str().unwrap();
        let made = run_here(&[&["new", scene], option.as_slice()].concat());
        assert_eq!(made, (0, format!("{scene}\n"), String::new()));
        let text = fs::read_to_string(scene).unwrap();
        assert!(text.contains(&format!("marbles preview {scene} --watch ")));
        assert!(!text.contains(NAME));
        let (code, out, err) = run_here(&["check", scene]);
        assert_eq!((code, &*err), (0, ""));
        assert_eq!(
            out.contains("frames      a still"),
            option.is_none(),
            "{out}"
        );
        let picture = folder.join(format!("{name}.png"));
        let picture = picture.to_str().unwrap();
        let (code, out, err) = run_here(&["render", scene, "--frames", "1", "-o", picture]);
        assert_eq!((code, &*err), (0, ""));
        assert!(out.contains(" 0 over, "), "{out}");
    }
    fs::remove_dir_all(folder).unwrap();
}

/// Renders the scenes in full size and at the default tolerance.
#[test]
fn new_scenes_meet_all_tolerances_of_reports() {
    let folder = temporary("new-report");
    for option in [None, Some("--turntable")] {
        let scene = folder.join(format!("scene{}.ron", option.unwrap_or_default()));
        let scene = scene.to_str().unwrap();
        let (code, ..) = run_here(&[&["new", scene], option.as_slice()].concat());
        assert_eq!(code, 0);
        let options = ["--seconds", "0", "--runs", "1", "--quiet"];
        let told = run_here(&[&["report", scene], &options[..]].concat());
        assert_eq!(told, (0, String::new(), String::new()), "{option:?}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn files_that_are_there_stay() {
    let folder = temporary("new-there");
    fs::create_dir_all(&folder).unwrap();
    let scene = folder.join("mine.ron");
    fs::write(&scene, "mine").unwrap();
    let (code, out, err) = run_here(&["new", scene.to_str().unwrap()]);
    assert_eq!((code, &*out), (1, ""));
    assert!(
        err.ends_with("mine.ron: the file already exists\n"),
        "{err}"
    );
    assert_eq!(fs::read(&scene).unwrap(), b"mine");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn other_endings_are_refused() {
    for name in ["ball", "ball.png", "ron", ".ron", "ball.ron.txt"] {
        let (code, out, err) = run_here(&["new", &format!("missing/{name}")]);
        assert_eq!((code, &*out), (2, ""), "{err}");
    }
    assert!(!Path::new("missing").exists());
}

#[test]
fn scenes_of_tables_name_them_from_their_folder() {
    let name = |scene: &str, table: &str| {
        let name = name_from(Path::new(scene), Path::new(table)).unwrap();
        name.replace('\\', "/")
    };
    assert_eq!(name("a.ron", "b.xyz"), "b.xyz");
    assert_eq!(name("a.ron", "data/b.xyz"), "data/b.xyz");
    assert_eq!(name("data/a.ron", "data/b.xyz"), "b.xyz");
    assert_eq!(name("out/deep/a.ron", "data/b.xyz"), "../../data/b.xyz");
    assert_eq!(name("/out/a.ron", "/out/b.xyz"), "b.xyz");
    // A path that is not below the current folder has no way back that is certain.
    let folder = temporary("new-named");
    fs::create_dir_all(&folder).unwrap();
    let table = folder.join("b.xyz");
    fs::write(&table, "").unwrap();
    let found = name_from(Path::new("../a.ron"), &table).unwrap();
    assert_eq!(Path::new(&found), fs::canonicalize(&table).unwrap());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn names_in_comments_can_be_pasted() {
    assert_eq!(shown(Path::new("out/ball.ron")), "out/ball.ron");
    assert_eq!(shown(Path::new("my ball.ron")), "'my ball.ron'");
    assert_eq!(shown(Path::new("a\nb.ron")), NAME);
}
