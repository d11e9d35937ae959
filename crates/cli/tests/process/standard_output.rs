//! Pictures on the standard output.

use crate::folder::Folder;

const SMALL: &str = "--size 60x40";

#[test]
fn a_picture_on_the_standard_output_has_the_bytes_of_the_file() {
    let folder = Folder::new();
    for (output, file) in [
        ("-", "a.png"),
        ("png:-", "b.png"),
        ("EXR:-", "a.exr"),
        ("npy:-", "a.npy"),
        ("tif:-", "a.tif"),
        ("webp:-", "a.webp"),
    ] {
        let of_file = folder.run(&format!("render ball.ron -o {file} {SMALL}"));
        let piped = folder.run(&format!("render ball.ron -o {output} {SMALL}"));
        assert!(piped.status.success(), "{piped:?}");
        assert!(piped.stdout == folder.read(file), "{output}");
        // The results are still told, in the same words but for the time.
        let told = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes).into_owned();
            let (start, _) = text.rsplit_once(',').expect("results");
            let (_, results) = start.split_once(": ").expect("a name");
            results.to_owned()
        };
        assert_eq!(told(&piped.stderr), told(&of_file.stdout), "{output}");
    }
    let names = ["a.exr", "a.npy", "a.png", "a.tif", "a.webp", "b.png"];
    assert_eq!(folder.names("")[..6], names);
}

#[test]
fn programs_get_only_json_beside_a_picture() {
    let folder = Folder::new();
    let result = folder.run(&format!("render ball.ron -o - --progress json {SMALL}"));
    assert!(result.status.success(), "{result:?}");
    let text = String::from_utf8(result.stderr).unwrap();
    assert!(text.lines().all(|line| line.starts_with('{')), "{text}");
    assert!(
        text.contains(r#""event":"frame""#) && text.contains(r#""path":"-""#),
        "{text}"
    );
}

#[test]
fn the_standard_output_takes_one_file_without_a_name() {
    let folder = Folder::new();
    for (arguments, part) in [
        ("roll.ron -o -", "20110 frames do not fit"),
        ("ball.ron -o mp4:-", "found `mp4:-`"),
        ("ball.ron -o - --sidecar", "--sidecar needs names of files"),
        ("ball.ron -o - --skip-existing", "--skip-existing needs"),
        ("ball.ron -o - --per-light", "--per-light=files needs"),
        ("ball.ron -o - --scale-bar inside", "`inside` needs"),
        (
            "ball.ron -o npy:- --error-channel",
            "--error-channel of NPY",
        ),
        ("ball.ron -o npy:- --channels id", "--channels of NPY"),
        ("ball.ron roll.ron -o -", "several scenes"),
    ] {
        let result = folder.run(&format!("render {arguments}"));
        let text = String::from_utf8_lossy(&result.stderr);
        assert_eq!(result.status.code(), Some(2), "{arguments}: {text}");
        assert!(text.contains(part), "{arguments}: {text}");
        assert!(result.stdout.is_empty(), "{arguments}");
    }
    let job = folder.run("farm slurm ball.ron -o -");
    let text = String::from_utf8_lossy(&job.stderr);
    assert_eq!(job.status.code(), Some(2), "{text}");
    assert!(text.contains("expected names of files"), "{text}");
    assert_eq!(folder.names(""), ["ball.ron"]);
}

/// What is lost on its way is an error.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_the_standard_output_is_an_error() {
    let folder = Folder::new();
    let full = std::fs::File::options()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let mut command = folder.marbles(&format!("render ball.ron -o - {SMALL}"));
    let result = command.stdout(full).output().unwrap();
    let text = String::from_utf8_lossy(&result.stderr);
    assert_eq!(result.status.code(), Some(1), "{text}");
    assert!(text.contains("-: cannot write the file"), "{text}");
}
