//! What only the real process shows: exit codes, signals, disks, pipes.

#![allow(
    clippy::print_stderr,
    reason = "tests that this machine cannot run say so"
)]

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A ball before the camera.
const BALL: &str = "(
    image: (width: 600, height: 600),
    lens: Retina(width: 600, distance: 100),
    camera: Free(),
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 400), radius: 300)],
)
";

/// An empty folder but for `ball.ron`, removed when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("process-{}-{count}", std::process::id());
        let folder = Self(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
        fs::create_dir_all(&folder.0).unwrap();
        fs::write(folder.path("ball.ron"), BALL).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// `marbles` with these arguments, one a word, in this folder.
    fn marbles(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_marbles"));
        command.args(arguments.split_whitespace());
        command.current_dir(&self.0);
        command.stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &str) -> Output {
        self.marbles(arguments).output().unwrap()
    }

    /// The names in the folder `name`, sorted.
    fn names(&self, name: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.path(name)) else {
            return Vec::new();
        };
        let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
        let mut names: Vec<String> = entries.map(|entry| name(entry.unwrap())).collect();
        names.sort();
        names
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal ended the process")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn wait_until(what: &str, condition: impl Fn() -> bool) {
    let started = Instant::now();
    while !condition() {
        assert!(
            started.elapsed() < Duration::from_secs(60),
            "waited for {what}"
        );
        sleep(Duration::from_millis(5));
    }
}

fn is_picture(name: &str) -> bool {
    Path::new(name).extension() == Some(OsStr::new("png"))
}

fn assert_complete(path: &Path) {
    let file = BufReader::new(File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    reader.finish().unwrap();
}

/// Asks the process to end and waits: its exit code, and how long it took.
fn interrupt(child: &mut Child) -> (Option<i32>, Duration) {
    let started = Instant::now();
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let status = child.wait().unwrap();
    (status.code(), started.elapsed())
}

#[test]
fn exit_codes_tell_what_happened() {
    let folder = Folder::new();
    for (arguments, expected) in [
        ("--help", 0),
        ("--version", 0),
        ("render --help", 0),
        ("check ball.ron", 0),
        ("render ball.ron --size 9x9", 0),
        ("render ball.ron --size 9x9 -o new/folder/a.png", 0),
        ("render ball.ron --size 9x9 --frames -2--1 -o a.#.exr", 0),
        ("render ball.ron --size 9x9 -o ball.ron/a.png", 1),
        ("", 2),
        ("paint ball.ron", 2),
        ("render", 2),
        ("render ball.ron -o a.jpg", 2),
        ("render ball.ron -o a.png --frames 1-2", 2),
        ("render ball.ron --frames 2-1", 2),
        ("render ball.ron --size 0x9", 2),
        ("render missing.ron", 2),
        ("render .", 2),
        ("check missing.ron", 2),
        ("render ball.ron --threads 0", 2),
        ("render ball.ron --size 9x9 --samples 2", 0),
        ("render ball.ron --samples 2 --tolerance 1e-3", 2),
        ("render ball.ron --float", 2),
        ("render ball.ron -o a.exr --rgb", 2),
    ] {
        let output = folder.run(arguments);
        assert_eq!(code(&output), expected, "marbles {arguments}");
        let silent = output.stderr.is_empty();
        assert!(expected == 0 || !silent, "marbles {arguments}");
        assert!(
            expected == 0 || output.stdout.is_empty(),
            "marbles {arguments}"
        );
    }
    let expected = ["a.-1.exr", "a.-2.exr", "ball.png", "ball.ron", "new"];
    assert_eq!(folder.names("."), expected);
}

#[test]
fn frames_that_cannot_be_rendered_do_not_stop_the_others() {
    const THROUGH: &str = "(
    image: (width: 9, height: 9),
    lens: Fov(50),
    camera: LookAt(position: (0, 0, -2), target: (0, 0, 0)),
    animation: Keyframes(frames: (1, 3), keys: [
        (frame: 1, position: (0, 0, -2), ease: Linear),
        (frame: 3, position: (0, 0, 2)),
    ]),
)
";
    let folder = Folder::new();
    fs::write(folder.path("through.ron"), THROUGH).unwrap();
    let output = folder.run("render through.ron");
    assert_eq!(code(&output), 1);
    let pictures = ["through.0001.png", "through.0003.png"];
    let expected = [&["ball.ron"], &pictures[..], &["through.ron"]].concat();
    assert_eq!(folder.names("."), expected);
    let errors = text(&output.stderr);
    assert!(errors.starts_with("marbles: frame 2: "), "{errors}");
    assert!(
        errors.ends_with("marbles: 2 of 3 frames written\n"),
        "{errors}"
    );

    let output = folder.run("check through.ron");
    assert_eq!(code(&output), 2);
    let errors = text(&output.stderr);
    let start = "marbles: through.ron: frame 2: ";
    assert!(errors.starts_with(start), "{errors}");

    // Only the frame in the middle has no view, and there are too many to look at all.
    for (last, expected) in [(99_999, 2), (1_000_001, 0)] {
        let far = THROUGH
            .replace("frame: 3", &format!("frame: {last}"))
            .replace("(1, 3)", &format!("(1, {last})"));
        fs::write(folder.path("far.ron"), far).unwrap();
        let output = folder.run("check far.ron");
        assert_eq!(code(&output), expected, "{last} frames");
        let all = !text(&output.stdout).contains("100000 of 1000001 were looked at\n");
        assert_eq!(all, last < 100_000);
    }
}

#[test]
fn tables_are_found_beside_the_scene_and_told() {
    const CLOUD: &str = "(
    image: (width: 60, height: 60),
    lens: Fov(40),
    camera: Frame(elevation: 20),
    lights: [Directional(toward: (-1, 1, -1))],
    clouds: [(file: \"tables/salt.csv\", radius: 0.5, value: \"x\", position: (1, 0, 0))],
)
";
    let folder = Folder::new();
    fs::create_dir_all(folder.path("in/tables")).unwrap();
    fs::write(folder.path("in/cloud.ron"), CLOUD).unwrap();
    let table = folder.path("in/tables/salt.csv");
    fs::write(&table, "x,y,z\n-1,-2,-3\n1,2,3\n").unwrap();
    let output = folder.run("check in/cloud.ron");
    assert_eq!(code(&output), 0);
    let lines = text(&output.stdout);
    let told = "cloud       tables/salt.csv: 2, radius 0.5
  from      (-0.5, -2.5, -3.5)
  to        (2.5, 2.5, 3.5)
  seen by   Orbit(target: (1, 0, 0), radius: 12.53";
    assert!(lines.contains(told), "{lines}");
    assert!(lines.contains("camera      Frame: x 1, y 4."), "{lines}");

    for threads in [1, 2] {
        let output = folder.run(&format!(
            "render in/cloud.ron -o {threads}.png --threads {threads}"
        ));
        assert_eq!(code(&output), 0);
    }
    let [one, two] = ["1.png", "2.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert_eq!(one, two);

    fs::write(&table, "x,y,z\n-1,-2,-3\n1,2\n").unwrap();
    let output = folder.run("render in/cloud.ron");
    assert_eq!(code(&output), 2);
    let errors = text(&output.stderr);
    let start = "in/tables/salt.csv:3:4: expected a number for `z`, found the end of the line\n";
    assert!(errors.contains(start), "{errors}");
    let end = "the table is named at in/cloud.ron:6:21\n";
    assert!(errors.ends_with(end), "{errors}");
}

/// What `marbles` prints on a terminal of this width; `None` where there is no way to have one.
#[cfg(target_os = "linux")]
fn run_on_terminal(folder: &Folder, columns: u32, arguments: &str) -> Option<String> {
    let marbles = folder.marbles(arguments);
    let program = marbles.get_program().to_str().unwrap();
    let command = format!("stty cols {columns} rows 24 && '{program}' {arguments}");
    let output = Command::new("script")
        .args(["-qec", &command, "/dev/null"])
        .current_dir(&folder.0)
        .env("TERM", "xterm")
        .stdin(Stdio::null())
        .output();
    match output {
        Ok(output) if output.status.success() => Some(text(&output.stdout)),
        _ => {
            eprintln!("skipped: this test needs the program `script`");
            None
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_shows_what_takes_long() {
    const CLOUD: &str = "(
    image: (width: 60, height: 60),
    lens: Fov(40),
    camera: Frame(),
    clouds: [(file: \"table_with_a_long_name.csv\", radius: 0.5)],
)
";
    let folder = Folder::new();
    fs::write(folder.path("cloud.ron"), CLOUD).unwrap();
    let rows = "100000.25,200000.25,300000.25\n".repeat(40_000);
    let table = "x,y,z\n".to_owned() + &rows;
    fs::write(folder.path("table_with_a_long_name.csv"), table).unwrap();
    let arguments = "render cloud.ron --size 9x9 --samples 1";
    for columns in [80, 30, 10] {
        let Some(shown) = run_on_terminal(&folder, columns, arguments) else {
            return;
        };
        let lines = shown.split(['\r', '\n']).map(|line| {
            let parts = line.split("\x1b[").enumerate();
            let visible = parts.map(|(index, part)| match index {
                0 => part,
                // Behind the letter that ends a control sequence.
                _ => part.trim_start_matches(|byte: char| !byte.is_ascii_alphabetic()),
            });
            let visible = visible.enumerate().map(|(index, part)| match index {
                0 => part,
                _ => part.get(1..).unwrap_or_default(),
            });
            visible.collect::<String>()
        });
        let lines: Vec<String> = lines.collect();
        for (start, whole) in [
            (
                "reading",
                "reading 100% of 1.2 MB: table_with_a_long_name.csv",
            ),
            ("prepari", "preparing 40000 spheres"),
        ] {
            let mut found = lines.iter().filter(|line| line.starts_with(start));
            let widest = found.clone().map(|line| line.trim_end().len()).max();
            assert!(
                widest.is_some_and(|width| width <= columns as usize),
                "{lines:?}"
            );
            assert!(
                columns < 80 || found.any(|line| line.trim_end() == whole),
                "{lines:?}"
            );
        }
    }
    let output = folder.run(arguments);
    assert_eq!(text(&output.stderr), "");
}

#[test]
fn a_line_is_printed_for_each_file() {
    let folder = Folder::new();
    let output = folder.run("render ball.ron -o out/%02d.png --frames 8-9 --size 30x20");
    assert_eq!(code(&output), 0);
    let lines = text(&output.stdout);
    let lines: Vec<&str> = lines.lines().collect();
    assert_eq!(lines.len(), 3);
    let starts = [
        "out/08.png: 600 pixels, ",
        "out/09.png: 600 pixels, ",
        "2 frames: 1200 pixels, ",
    ];
    for (line, start) in lines.iter().zip(starts) {
        let start = format!("{start}error <= ");
        let rest = line.strip_prefix(&start).unwrap();
        let (error, rest) = rest.split_once(' ').unwrap();
        // The default tolerance.
        assert!(error.parse::<f64>().unwrap() <= 1e-3);
        let (evidence, rest) = rest.split_once(", 0 over the tolerance, ").unwrap();
        assert!(["(bound)", "(estimate)"].contains(&evidence), "{line}");
        let seconds = rest.strip_suffix(" s").unwrap();
        assert!(seconds.parse::<f64>().unwrap() < 60.0);
    }
    let progress = text(&output.stderr);
    let progress: Vec<&str> = progress.lines().collect();
    assert_eq!(progress.len(), 2);
    assert!(progress[0].starts_with("frame 8: 1 of 2 done, "));
    assert!(progress[0].ends_with(" s left"));
    assert_eq!(progress[1], "frame 9: 2 of 2 done");

    let output = folder.run("render ball.ron -o a.png --size 30x20");
    assert_eq!(text(&output.stdout).lines().count(), 1);
    assert_eq!(text(&output.stderr), "");
}

#[test]
fn quiet_prints_nothing() {
    let folder = Folder::new();
    let output = folder.run("render ball.ron -o a.#.png --frames 1-3 --size 9x9 --quiet");
    assert_eq!(code(&output), 0);
    assert_eq!(text(&output.stdout), "");
    assert_eq!(text(&output.stderr), "");
    assert_eq!(folder.names(".").len(), 4);
}

#[test]
fn pictures_repeat_with_any_number_of_threads() {
    let folder = Folder::new();
    for ending in ["png", "exr"] {
        let names = ["a", "b", "1", "2", "7"];
        for name in names {
            let threads = match name.parse::<u32>() {
                Ok(threads) => format!("--threads {threads}"),
                Err(_) => String::new(),
            };
            let output = folder.run(&format!(
                "render ball.ron -o {name}.{ending} --size 101x67 {threads}"
            ));
            assert_eq!(code(&output), 0);
        }
        let first = folder.read(&format!("a.{ending}"));
        for name in names {
            let same = folder.read(&format!("{name}.{ending}")) == first;
            assert!(same, "{name}.{ending}");
        }
    }
}

#[test]
fn a_killed_process_leaves_complete_pictures() {
    let folder = Folder::new();
    let mut child = folder
        .marbles("render ball.ron -o out/####.png --frames 1-60 --size 120x120 --samples 12")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let pictures = || {
        let names = folder.names("out").into_iter();
        names
            .filter(|name| is_picture(name))
            .collect::<Vec<String>>()
    };
    wait_until("pictures", || pictures().len() >= 5);
    child.kill().unwrap();
    child.wait().unwrap();
    let pictures = pictures();
    assert!(pictures.len() < 60, "killed too late to show anything");
    for picture in pictures {
        assert_complete(&folder.path("out").join(picture));
    }
}

#[test]
fn an_interrupted_process_ends_soon_and_cleans_up() {
    let folder = Folder::new();
    // In the middle of a sequence, and of a picture that takes longer than a second.
    for (samples, least) in [(30, 2), (200, 0)] {
        let out = format!("out{samples}");
        let mut child = folder
            .marbles(&format!(
                "render ball.ron -o {out}/####.png --frames 1-60 --size 150x150 --samples {samples}"
            ))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_until("a start", || folder.path(&out).exists());
        wait_until("pictures", || folder.names(&out).len() >= least);
        sleep(Duration::from_millis(50));
        let (code, time) = interrupt(&mut child);
        assert_eq!(code, Some(130));
        assert!(time < Duration::from_secs(1), "{time:?}");

        let pictures = folder.names(&out);
        assert!(pictures.len() < 60, "interrupted too late to show anything");
        for picture in &pictures {
            assert!(is_picture(picture), "{picture}");
            assert_complete(&folder.path(&out).join(picture));
        }
        let mut messages = String::new();
        child.stderr.unwrap().read_to_string(&mut messages).unwrap();
        let last = format!("interrupted: {} of 60 frames written", pictures.len());
        assert!(messages.trim_end().ends_with(&last), "{messages}");
    }
}

#[test]
fn a_stuck_process_ends_soon_when_interrupted() {
    let folder = Folder::new();
    // Nobody reads the results, and the pipe is full long before the last frame.
    let mut child = folder
        .marbles("render ball.ron -o out/#.png --frames 1-9999 --size 1x1 --samples 1")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_until("a full pipe", || {
        let before = folder.names("out");
        sleep(Duration::from_millis(300));
        !before.is_empty() && folder.names("out") == before
    });
    let (code, time) = interrupt(&mut child);
    assert_eq!(code, Some(130));
    assert!(time < Duration::from_secs(1), "{time:?}");
    let names = folder.names("out");
    assert!(names.len() < 9999, "the pipe did not fill");
    assert!(names.iter().all(|name| is_picture(name)));
}

#[test]
fn a_closed_pipe_does_not_stop_the_work() {
    let folder = Folder::new();
    let mut child = folder
        .marbles("render ball.ron -o out/#.png --frames 1-9 --size 9x9")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(folder.names("out").len(), 9);

    for arguments in ["check ball.ron", "--help"] {
        let mut child = folder
            .marbles(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        assert_eq!(child.wait().unwrap().code(), Some(0));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn results_that_cannot_be_written_are_an_error() {
    let folder = Folder::new();
    for arguments in [
        "check ball.ron",
        "render ball.ron --size 9x9 --frames 1-3 -o #.png",
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

/// Runs `marbles` while a file system with these options is mounted at `out`, which nobody else
/// sees. The output ends with the names in `out`; `None` where nothing can be mounted.
fn run_on_file_system(folder: &Folder, options: &str, arguments: &str) -> Option<Output> {
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
    let arguments = "render ball.ron -o out/##.exr --frames 1-60 --size 99x99 --float";
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
    let last = format!("marbles: {} of 60 frames written\n", names.len());
    assert!(errors.ends_with(&last), "{errors}");
}

#[test]
fn a_folder_without_permission_is_an_error() {
    let folder = Folder::new();
    let arguments = "render ball.ron -o out/#.png --frames 1-60";
    let Some(output) = run_on_file_system(&folder, "ro", arguments) else {
        return;
    };
    assert_eq!(code(&output), 1);
    assert_eq!(text(&output.stdout), "");
    assert_eq!(
        text(&output.stderr),
        "marbles: out/1.png: cannot create the file: read-only file system\n"
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
    let expected = "marbles: a.png: cannot write the file: there is a folder\n";
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
        ("null", "cannot write the file: there is something"),
    ] {
        let output = folder.run(&format!("render ball.ron --size 9x9 -o {name}.png"));
        assert_eq!(code(&output), 1);
        let start = format!("marbles: {name}.png: {expected}");
        let errors = text(&output.stderr);
        assert!(errors.starts_with(&start), "{errors}");
    }
}

/// Address space that is not too much, of which the allocator sets aside up to 64 MiB for every
/// thread.
#[cfg(target_os = "linux")]
const KILOBYTES: u32 = 900_000;

/// Runs `marbles` with no more addresses than so many.
#[cfg(target_os = "linux")]
fn run_in_memory(folder: &Folder, kilobytes: u32, arguments: &str) -> Output {
    let marbles = folder.marbles(arguments);
    let output = Command::new("sh")
        .args(["-c", &format!("ulimit -v {kilobytes}; exec \"$@\""), "sh"])
        .arg(marbles.get_program())
        .args(marbles.get_args())
        .current_dir(&folder.0)
        .output();
    output.unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn pictures_larger_than_the_memory_are_rendered() {
    let folder = Folder::new();
    // 16.8 million pixels of three channels and an error in double precision are 537 MB.
    for name in ["a.png", "a.exr"] {
        let arguments =
            format!("render ball.ron -o {name} --rgb --samples 1 --threads 2 --size 16384x1024");
        let arguments = match name {
            "a.exr" => arguments.replace(" --rgb", ""),
            _ => arguments,
        };
        let output = run_in_memory(&folder, KILOBYTES, &arguments);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        assert!(text(&output.stdout).starts_with(&format!("{name}: 16777216 pixels, ")));
    }
    assert_complete(&folder.path("a.png"));
}

#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_is_an_error() {
    let folder = Folder::new();
    let colored = BALL.replace("lights:", "background: (0, 0, 1), lights:");
    fs::write(folder.path("ball.ron"), colored).unwrap();
    let mut codes = Vec::new();
    for kilobytes in [300_000, 400_000, 500_000, KILOBYTES] {
        for options in ["-o #.exr --float --alpha", "-o #.png --bits 16"] {
            // The widest there are.
            let arguments = format!(
                "render ball.ron {options} --samples 1 --threads 2 --size 65536x30 --frames 1-2"
            );
            let output = run_in_memory(&folder, kilobytes, &arguments);
            let errors = text(&output.stderr);
            let code = output.status.code();
            assert!(matches!(code, Some(0 | 1)), "{arguments}: {errors}");
            let refused = errors.contains(" memory");
            assert_eq!(refused, code == Some(1), "{arguments}: {errors}");
            codes.push(code);
        }
    }
    assert!(codes.contains(&Some(0)) && codes.contains(&Some(1)));
}

#[test]
fn a_tolerance_that_is_not_met_ends_with_1() {
    let folder = Folder::new();
    let met = folder.run("render ball.ron --tolerance 1e-3 --size 30x30 -o met.png");
    assert_eq!(code(&met), 0);
    assert!(text(&met.stdout).contains(" 0 over the tolerance"));
    // Lines cannot be trusted with numbers of this size.
    let huge = BALL.replace("(0, 0, 400), radius: 300", "(0, 0, 4e200), radius: 3e200");
    fs::write(folder.path("huge.ron"), huge).unwrap();
    let missed = folder.run("render huge.ron --tolerance 1e-3 --size 30x30 -o missed.png");
    assert_eq!(code(&missed), 1);
    assert!(!text(&missed.stdout).contains(" 0 over the tolerance"));
    assert!(folder.path("missed.png").exists());
    assert!(text(&missed.stderr).contains("tolerance"));
    for refused in ["0", "-1", "1e-10", "NaN", "much"] {
        let output = folder.run(&format!("render ball.ron --tolerance={refused}"));
        assert_eq!(code(&output), 2, "{refused}");
    }
}
