//! Files, links and disks.

use std::fs::{self, File};
use std::process::{Command, Output};

use crate::folder::{Folder, assert_complete, code, text};

#[cfg(target_os = "linux")]
#[test]
fn results_that_cannot_be_written_are_an_error() {
    let folder = Folder::new();
    for arguments in [
        "check ball.ron",
        "render roll.ron --size 9x9 --frames 1-3 -o #.png",
        "--help",
    ] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = folder.marbles(arguments).stdout(full).output().unwrap();
        assert_eq!(code(&output), 1, "marbles {arguments}");
        let errors = text(&output.stderr);
        let expected = "marbles: cannot write the results: no space left on device\n";
        assert!(errors.ends_with(expected), "{errors}");
        assert_eq!(errors.matches("cannot").count(), 1, "{errors}");
    }
    assert_eq!(folder.names(".").len(), 4);
}

/// Runs `marbles` while a file system with these options is mounted at `out`, visible only to this command. The output
/// ends with the names in `out`; `None` if nothing can be mounted.
pub(crate) fn run_on_file_system(
    folder: &Folder,
    options: &str,
    arguments: &str,
) -> Option<Output> {
    const CANNOT_MOUNT: i32 = 77;
    fs::create_dir_all(folder.path("out")).unwrap();
    let script = format!(
        "mount -t tmpfs -o {options} none out || exit {CANNOT_MOUNT}
        \"$@\"; code=$?; ls -A out; exit $code"
    );
    let marbles = folder.marbles(arguments);
    for namespaces in ["-m", "-rm"] {
        let output = Command::new("unshare")
            .args([namespaces, "sh", "-c", &script, "sh"])
            .arg(marbles.get_program())
            .args(marbles.get_args())
            .current_dir(&folder.0)
            .output();
        match output {
            Ok(output) if text(&output.stderr).starts_with("unshare:") => {}
            Ok(output) if output.status.code() == Some(CANNOT_MOUNT) => {}
            Ok(output) => return Some(output),
            Err(_) => {}
        }
    }
    eprintln!("skipped: this test has to mount a file system, which is not allowed here");
    None
}

#[test]
fn a_full_disk_is_an_error() {
    let folder = Folder::new();
    let arguments = "render roll.ron -o out/##.exr --frames 1-60 --size 99x99 --float";
    let Some(output) = run_on_file_system(&folder, "size=128k", arguments) else {
        return;
    };
    assert_eq!(code(&output), 1);
    let errors = text(&output.stderr);
    let expected = ".exr: cannot write the file: no space left on device\n";
    assert_eq!(errors.matches(expected).count(), 1, "{errors}");
    let names = text(&output.stdout);
    let names: Vec<&str> = names.lines().filter(|line| !line.contains(' ')).collect();
    assert!((2..60).contains(&names.len()), "{names:?}");
    assert!(names.iter().all(|name| name.ends_with(".exr")), "{names:?}");
    let last = format!("marbles: {} of 60 frames written, failed: ", names.len());
    let summary = errors.lines().last().unwrap();
    assert!(summary.starts_with(&last), "{errors}");
}

#[test]
fn a_folder_without_permission_is_an_error() {
    let folder = Folder::new();
    let arguments = "render roll.ron -o out/#.png --frames 1-60";
    let Some(output) = run_on_file_system(&folder, "ro", arguments) else {
        return;
    };
    assert_eq!(code(&output), 1);
    assert_eq!(text(&output.stdout), "");
    assert_eq!(
        text(&output.stderr),
        "marbles: out/1.png: cannot create the file: read-only file system\n\
         marbles: 0 of 60 frames written, failed: 1-60\n"
    );
}

#[test]
fn a_file_in_place_of_a_folder_is_an_error() {
    let folder = Folder::new();
    fs::write(folder.path("file"), "").unwrap();
    let output = folder.run("render ball.ron -o file/a.png");
    assert_eq!(code(&output), 1);
    let errors = text(&output.stderr);
    assert!(
        errors.starts_with("marbles: file: cannot create the folder: "),
        "{errors}"
    );
    assert_eq!(errors.lines().count(), 1);

    let output = folder.run("render ball.ron -o a.png/b.png --size 9x9");
    assert_eq!(code(&output), 0);
    let output = folder.run("render ball.ron -o a.png --size 9x9");
    assert_eq!(code(&output), 1);
    let expected = "marbles: a.png: cannot write the file: a folder has this name\n";
    assert_eq!(text(&output.stderr), expected);
}

#[test]
fn pictures_replace_older_ones() {
    let folder = Folder::new();
    fs::write(folder.path("a.png"), "older").unwrap();
    let output = folder.run("render ball.ron -o a.png --size 9x9");
    assert_eq!(code(&output), 0);
    assert_complete(&folder.path("a.png"));
}

#[test]
fn the_longest_names_can_be_written() {
    let folder = Folder::new();
    // 255 bytes are the most that common file systems take; the ö has two.
    for length in [248, 251, 255] {
        let name = format!("{}ö.png", "a".repeat(length - "ö.png".len()));
        let output = folder.run(&format!("render ball.ron --size 9x9 -o {name}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        assert_complete(&folder.path(&name));
    }
    assert_eq!(folder.names(".").len(), 4);
}

#[cfg(unix)]
#[test]
fn links_are_written_through() {
    use std::os::unix::fs::symlink;

    let folder = Folder::new();
    fs::create_dir(folder.path("real")).unwrap();
    fs::write(folder.path("real/old.png"), "older").unwrap();
    symlink("real/old.png", folder.path("old.png")).unwrap();
    symlink("real/new.png", folder.path("new.png")).unwrap();
    symlink("new.png", folder.path("twice.png")).unwrap();
    for name in ["old", "twice"] {
        let output = folder.run(&format!("render ball.ron --size 9x9 -o {name}.png"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let link = fs::symlink_metadata(folder.path(&format!("{name}.png")));
        assert!(link.unwrap().is_symlink());
    }
    assert_complete(&folder.path("real/old.png"));
    assert_complete(&folder.path("real/new.png"));
    assert_eq!(folder.names("real"), ["new.png", "old.png"]);

    symlink("circle.png", folder.path("circle.png")).unwrap();
    symlink("/dev/null", folder.path("null.png")).unwrap();
    for (name, expected) in [
        ("circle", "cannot create the file: too many"),
        (
            "null",
            "cannot write the file: something that is not a file",
        ),
    ] {
        let output = folder.run(&format!("render ball.ron --size 9x9 -o {name}.png"));
        assert_eq!(code(&output), 1);
        let start = format!("marbles: {name}.png: {expected}");
        let errors = text(&output.stderr);
        assert!(errors.starts_with(&start), "{errors}");
    }
}

/// Names and contents of files cannot control a terminal.
#[test]
#[cfg(unix)]
fn names_and_contents_are_shown_harmless() {
    let folder = Folder::new();
    let evil = "\u{1b}]0;title\u{7}\n\u{9b}31m";
    let ball = fs::read_to_string(folder.path("ball.ron")).unwrap();
    fs::write(folder.path(&format!("{evil}.ron")), &ball).unwrap();
    let wrong = ball.replace("spheres:", "/* \u{9b}31m\u{1b}[1m */ sphere\u{202e}s:");
    fs::write(folder.path(&format!("{evil}wrong.ron")), wrong).unwrap();
    let table = "\u{1b}[1m\u{9b}31m.csv";
    fs::write(folder.path(table), "x,y,z\n1,2\n").unwrap();
    let cloud = format!("clouds: [(file: {table:?}, radius: 1)],");
    let cloud = ball.replace("spheres:", &format!("{cloud} spheres:"));
    fs::write(folder.path(&format!("{evil}cloud.ron")), cloud).unwrap();
    // Its line does not end in a name.
    let shown = "\\u{1b}]0;title\\u{7}\\u{a}\\u{9b}31m";
    for (arguments, expected) in [
        (["check", "E.ron", "", ""], 0),
        (["render", "E.ron", "-o", "E.png"], 0),
        (["check", "Ewrong.ron", "", ""], 2),
        (["render", "Enone.ron", "-o", "a.png"], 2),
        (["compare", "E.png", "E.ron", ""], 2),
        (["check", "Ecloud.ron", "", ""], 2),
        (["render", "Ecloud.ron", "-o", "a.png"], 2),
    ] {
        let mut marbles = folder.marbles("");
        for argument in arguments
            .into_iter()
            .filter(|argument| !argument.is_empty())
        {
            marbles.arg(argument.replace('E', evil));
        }
        let output = marbles.output().unwrap();
        let said = text(&output.stdout) + &text(&output.stderr);
        assert_eq!(code(&output), expected, "{arguments:?}: {said:?}");
        let harmful = |c: &char| c.is_control() && *c != '\n' || *c == '\u{202e}';
        assert_eq!(said.chars().find(harmful), None, "{said:?}");
        assert!(said.contains(shown), "{arguments:?}: {said:?}");
        let names_it = said.contains(&format!("\nthe table is named at {shown}cloud.ron:6:"));
        assert_eq!(names_it, arguments[1] == "Ecloud.ron", "{said:?}");
    }
}

/// Neither the scene nor its tables are replaced, whatever their names, and through whatever links they are reached.
#[test]
#[cfg(unix)]
fn no_output_replaces_an_input() {
    let folder = Folder::new();
    let cloud = "(image: (width: 9, height: 9), lens: Fov(40), camera: Frame(), clouds: [(file: \"a_id.npy\", value: \"x\")])";
    let mut array = b"\x93NUMPY\x01\x00".to_vec();
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4)}";
    array.extend((header.len() as u16).to_le_bytes());
    array.extend(header.as_bytes());
    array.extend([0.0_f64, 0.0, 5.0, 1.0].map(f64::to_le_bytes).concat());
    fs::write(folder.path("scene.png"), cloud).unwrap();
    fs::write(folder.path("a_id.npy"), &array).unwrap();
    for (link, input) in [
        ("link.1.npy", "a_id.npy"),
        ("table.svg", "a_id.npy"),
        ("scene.svg", "scene.png"),
    ] {
        std::os::unix::fs::symlink(input, folder.path(link)).unwrap();
    }
    let lit = cloud
        .replace(
            "clouds",
            "lights: [Directional(toward: (0, 0, -1))], clouds",
        )
        .replace("a_id.npy", "normal.txt");
    fs::write(folder.path("lit.ron"), lit).unwrap();
    fs::write(folder.path("normal.txt"), "x y z radius\n0 0 5 1\n").unwrap();
    for (output, is_refused) in [
        ("render scene.png -o ./scene.png", true),
        ("render scene.png -o a_id.npy", true),
        ("render scene.png -o link.#.npy --frames 1", true),
        ("render scene.png -o a.npy --channels id", true),
        ("render scene.png -o a.npy", false),
        ("render scene.png -o b.png --legend scene.svg", true),
        ("render scene.png -o b.png --legend table.svg", true),
        ("render scene.png -o b.png --legend b.svg", false),
        ("render scene.png -o b.png --scale-bar scene.svg", true),
        ("render scene.png -o b.png --scale-bar table.svg", true),
        ("render scene.png -o b.png --scale-bar b.svg", false),
        ("spheres scene.png -o scene.png", true),
        ("report scene.png --runs 1 --csv a_id.npy", true),
        ("report scene.png --runs 1 --plot scene.svg", true),
        ("farm slurm scene.png -o out.png --job scene.png", true),
        ("farm slurm scene.png -o a_id.npy --job job", true),
        ("dataset lit.ron -o set --layout diligent", false),
        ("dataset lit.ron -o . --layout diligent", true),
    ] {
        let output = (output, folder.run(output));
        let errors = text(&output.1.stderr);
        assert_eq!(
            code(&output.1),
            if is_refused { 2 } else { 0 },
            "{}: {errors}",
            output.0
        );
        assert_eq!(
            errors.contains("would replace the scene"),
            is_refused,
            "{errors}"
        );
    }
    assert_eq!(folder.read("a_id.npy"), array);
    assert_eq!(folder.read("scene.png"), cloud.as_bytes());
}

/// Messages of the system appear in our style, without their numbers.
#[test]
#[cfg(unix)]
fn links_in_a_circle_are_told() {
    let folder = Folder::new();
    for (link, target) in [("a.csv", "b.csv"), ("b.csv", "a.csv")] {
        std::os::unix::fs::symlink(target, folder.path(link)).unwrap();
    }
    let scene = "(image: (width: 9, height: 9), lens: Fov(40), camera: Frame(), clouds: [(file: \"a.csv\")])";
    fs::write(folder.path("scene.ron"), scene).unwrap();
    for arguments in ["check a.csv", "check scene.ron", "compare a.csv a.csv"] {
        let output = folder.run(arguments);
        let errors = text(&output.stderr);
        assert_eq!(code(&output), 2, "{errors}");
        assert!(
            errors.contains("too many levels of symbolic links"),
            "{errors}"
        );
        assert!(!errors.contains("os error"), "{errors}");
    }
}
