//! Jobs for farms, run by a shell with a renderer that only prints its arguments.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::folder::{BALL, Folder, code, text};
use crate::signals::is_ignored;

/// Names with characters that have a meaning for shells, directives and templates.
const ODD: &str = "it's \"one\" $HOME `id` \\n !x *;& #1 {é} ";
/// Prints the words of its command line.
const ECHO: &str = "#!/bin/sh\nprintf '%s\\n' \"$@\"\n";
/// Runs until it gets a signal, but not forever.
const ENDLESS: &str = "#!/bin/sh
trap 'exit 130' TERM
touch started
for turn in $(seq 1200); do sleep 0.05; done
";

/// A program with this name, which jobs find.
fn program(folder: &Folder, name: &str, script: &str) {
    let path = folder.path("bin");
    fs::create_dir_all(&path).unwrap();
    fs::write(path.join(name), script).unwrap();
    fs::set_permissions(path.join(name), fs::Permissions::from_mode(0o755)).unwrap();
}

/// `marbles farm` with these arguments, separated by spaces, and additional unchanged ones.
fn farm(folder: &Folder, arguments: &str, odd: &[&str]) -> Output {
    let mut command = folder.marbles(&format!("farm {arguments}"));
    command.args(odd).output().unwrap()
}

/// The job as a task of Slurm, with the programs in the folder.
fn task(folder: &Folder, index: u32, environment: &[(&str, &str)]) -> Command {
    let path = folder.path("bin").into_os_string().into_string().unwrap();
    let mut command = Command::new("bash");
    command
        .arg("job.sh")
        .current_dir(&folder.0)
        .env("PATH", format!("{path}:{}", std::env::var("PATH").unwrap()))
        .env("SLURM_ARRAY_JOB_ID", "7")
        .env("SLURM_ARRAY_TASK_ID", index.to_string())
        .env_remove("SLURM_CPUS_PER_TASK")
        .env_remove("SLURM_CPUS_ON_NODE")
        .env_remove("SLURM_RESTART_COUNT")
        .envs(environment.iter().copied());
    command
}

fn lines(bytes: &[u8]) -> Vec<String> {
    text(bytes).lines().map(str::to_owned).collect()
}

#[test]
fn every_task_of_an_array_renders_its_frames() {
    let folder = Folder::new();
    program(&folder, "marbles", ECHO);
    let scene = format!("{ODD}.ron");
    fs::copy(folder.path("roll.ron"), folder.path(&scene)).unwrap();
    let pattern = format!("{ODD}/it's ####.png");
    let options =
        "slurm --frames 5-1:-1,10-20x2 --chunk 4 --job job.sh --tolerance 1e-4 -q --size 9x9";
    let output = farm(&folder, options, &["-o", &pattern, "--", &scene]);
    assert_eq!((code(&output), lines(&output.stderr)), (0, vec![]));

    let script = text(&folder.read("job.sh"));
    for option in [
        "--array=0-2",
        "--requeue",
        // A task that is queued again goes on with its log.
        "--open-mode=append",
        // To the shell, in time for the renderer to end.
        "--signal=B:USR1@60",
    ] {
        let directive = format!("\n#SBATCH {option}\n");
        assert!(script.contains(&directive), "{script}");
    }
    let name = script.lines().find(|line| line.contains("--job-name"));
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "#-=_. ".contains(letter);
    assert!(name.unwrap().chars().all(plain), "{name:?}");

    for (index, frames) in ["5-2:-1", "1,10-14:2", "16-20:2"].iter().enumerate() {
        let index = index as u32;
        let environment = [("SLURM_CPUS_PER_TASK", "3"), ("SLURM_CPUS_ON_NODE", "9")];
        let output = task(&folder, index, &environment).output().unwrap();
        let expected = [
            "render".to_owned(),
            "--skip-existing".to_owned(),
            "--progress=plain".to_owned(),
            "--threads=3".to_owned(),
            format!("--frames={frames}"),
            "--tolerance=1e-4".to_owned(),
            "--size=9x9".to_owned(),
            "--quiet".to_owned(),
            format!("--output={}", folder.path(&pattern).display()),
            "--".to_owned(),
            folder.path(&scene).display().to_string(),
        ];
        assert_eq!(lines(&output.stdout), expected);
        assert_eq!((code(&output), lines(&output.stderr)), (0, vec![]));
    }
}

#[test]
fn what_is_asked_for_comes_before_what_slurm_says() {
    let folder = Folder::new();
    program(&folder, "marbles", ECHO);
    let words = |options: &str, environment: &[(&str, &str)]| {
        let arguments = format!("slurm ball.ron -o a.png --job job.sh {options}");
        let output = farm(&folder, &arguments, &[]);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        assert_eq!(text(&output.stdout), "job.sh: 1 frames in 1 tasks\n");
        let output = task(&folder, 0, environment).output().unwrap();
        lines(&output.stdout)[2..5].to_vec()
    };
    let plain = ["--progress=plain", "--threads=1", "--frames=1"];
    assert_eq!(words("", &[]), plain);
    let on_node = words("", &[("SLURM_CPUS_ON_NODE", "6")]);
    assert_eq!(on_node[1], "--threads=6");
    let given = words(
        "--threads 2 --progress json",
        &[("SLURM_CPUS_PER_TASK", "9")],
    );
    assert_eq!(given, ["--frames=1", "--threads=2", "--progress=json"]);
}

#[test]
fn words_without_spaces_are_quoted_as_well() {
    let folder = Folder::new();
    program(&folder, "marbles", ECHO);
    for name in ["$HOME.png", "`id`.png", "a;b&c.png", "*.png", "it's.png"] {
        let output = farm(&folder, "slurm ball.ron --job job.sh -o", &[name]);
        assert_eq!((code(&output), lines(&output.stderr)), (0, vec![]));
        let output = task(&folder, 0, &[]).output().unwrap();
        let expected = format!("--output={}", folder.path(name).display());
        assert_eq!(lines(&output.stdout)[5], expected);
    }
}

#[test]
fn scripts_end_as_the_renderer_does() {
    let folder = Folder::new();
    let output = farm(&folder, "slurm ball.ron -o a.png --job job.sh", &[]);
    assert_eq!(code(&output), 0);
    for (ending, words) in [(0, ""), (1, ""), (2, ""), (3, "all is written")] {
        program(&folder, "marbles", &format!("#!/bin/sh\nexit {ending}\n"));
        let output = task(&folder, 0, &[]).output().unwrap();
        assert_eq!(code(&output), ending);
        let errors = text(&output.stderr);
        assert!(
            errors.contains(words) && errors.is_empty() == words.is_empty(),
            "{errors}"
        );
    }
}

#[test]
fn tasks_are_queued_again_at_the_time_limit() {
    let folder = Folder::new();
    program(&folder, "marbles", ENDLESS);
    program(&folder, "scontrol", "#!/bin/sh\necho \"$@\"\n");
    let output = farm(
        &folder,
        "slurm roll.ron -o #.png --frames 1-6 --chunk 3 --job job.sh",
        &[],
    );
    assert_eq!(code(&output), 0);
    for (signal, restarts, requeued) in [
        ("USR1", "0", "requeue 7_1\n"),
        ("USR1", "2", "requeue 7_1\n"),
        ("USR1", "3", ""),
        ("TERM", "0", ""),
        ("INT", "0", ""),
    ] {
        if is_ignored(signal) {
            eprintln!("skipped: what ignores SIG{signal} from its start cannot be told to listen");
            continue;
        }
        let _ = fs::remove_file(folder.path("started"));
        let child = task(&folder, 1, &[("SLURM_RESTART_COUNT", restarts)])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let output = ended_by(signal, child, &folder);
        assert_eq!(code(&output), 130, "{signal}");
        assert_eq!(text(&output.stdout), requeued, "{signal} {restarts}");
    }
}

/// A renderer that does not handle signals yet is ended by them.
#[test]
fn tasks_are_queued_again_though_the_renderer_has_just_started() {
    let folder = Folder::new();
    let deaf = ENDLESS.replace("trap 'exit 130' TERM\n", "");
    program(&folder, "marbles", &deaf);
    program(&folder, "scontrol", "#!/bin/sh\necho \"$@\"\n");
    let output = farm(&folder, "slurm ball.ron -o a.png --job job.sh", &[]);
    assert_eq!(code(&output), 0);
    let child = task(&folder, 0, &[])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let output = ended_by("USR1", child, &folder);
    assert_eq!(
        (code(&output), text(&output.stdout)),
        (143, "requeue 7_0\n".to_owned())
    );
}

/// The output of a task that gets a signal as soon as it renders.
fn ended_by(signal: &str, child: Child, folder: &Folder) -> Output {
    let started = Instant::now();
    while !folder.path("started").exists() {
        assert!(started.elapsed() < Duration::from_secs(60));
        sleep(Duration::from_millis(5));
    }
    crate::signals::signal(signal, &child);
    child.wait_with_output().unwrap()
}

#[test]
fn a_template_hands_words_over_as_they_are() {
    let folder = Folder::new();
    let scene = format!("{ODD}.ron");
    fs::copy(folder.path("roll.ron"), folder.path(&scene)).unwrap();
    let pattern = format!("{ODD}/it's {{frame:04}}.exr");
    let options = "openjd --frames 20-10:-2,5-1:-1 --chunk 4 --float --samples 3";
    let output = farm(&folder, options, &["-o", &pattern, "--", &scene]);
    assert_eq!((code(&output), lines(&output.stderr)), (0, vec![]));
    let template: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(template["specificationVersion"], "jobtemplate-2023-09");
    assert_eq!(template["extensions"], json!(["TASK_CHUNKING"]));
    let step = &template["steps"][0];
    let parameters = json!([{
        "name": "Frame",
        "type": "CHUNK[INT]",
        "range": "1-5,10-20:2",
        "chunks": { "defaultTaskCount": 4, "rangeConstraint": "NONCONTIGUOUS" },
    }]);
    let space = &step["parameterSpace"];
    assert_eq!(space["taskParameterDefinitions"], parameters);
    let action = &step["script"]["actions"]["onRun"];
    assert_eq!(action["command"], "marbles");
    let expected = json!([
        "render",
        "--skip-existing",
        "--progress=openjd",
        "--frames={{Task.Param.Frame}}",
        "--samples=3",
        "--float",
        format!("--output={}", folder.path(&pattern).display()),
        "--",
        folder.path(&scene).display().to_string(),
    ]);
    assert_eq!(action["args"], expected);
    // Who is told to end has more time than the renderer promises to need.
    let cancelation = &action["cancelation"];
    assert_eq!(cancelation["mode"], "NOTIFY_THEN_TERMINATE");
    assert!(cancelation["notifyPeriodInSeconds"].as_u64() > Some(1));
    let name = template["name"].as_str().unwrap();
    assert!(name.starts_with("marbles-it_s__one"), "{name}");
}

/// The specification allows 128 characters.
#[test]
fn long_names_are_cut_in_names_of_jobs() {
    let folder = Folder::new();
    let scene = format!("{}.ron", "n".repeat(200));
    fs::write(folder.path(&scene), BALL).unwrap();
    let output = farm(&folder, "openjd -o a.png", &[&scene]);
    assert_eq!((code(&output), lines(&output.stderr)), (0, vec![]));
    let template: Value = serde_json::from_slice(&output.stdout).unwrap();
    let name = format!("marbles-{}", "n".repeat(120));
    assert_eq!(template["name"], name);
}

#[test]
fn what_cannot_be_rendered_is_no_job() {
    let folder = Folder::new();
    fs::write(folder.path("bad.ron"), BALL.replace("300)]", "-300)]")).unwrap();
    let lost = BALL.replace(
        "camera: Free()",
        "camera: LookAt(position: (0, 0, -2), target: (0, 0, 0)),
    animation: Keyframes(frames: (1, 2), keys: [(frame: 1, position: (0, 0, -2)), (frame: 2, position: (0, 0, 0))])",
    );
    fs::write(folder.path("lost.ron"), lost).unwrap();
    let refusal = |arguments: &str, odd: &[&str]| {
        let output = farm(&folder, arguments, odd);
        assert_eq!(code(&output), 2, "{arguments}");
        assert_eq!(text(&output.stdout), "");
        text(&output.stderr)
    };
    for engine in ["slurm", "openjd"] {
        for (arguments, expected) in [
            ("ball.ron", "--output"),
            ("no.ron -o #.png", "no.ron"),
            ("bad.ron -o #.png", "bad.ron:6:"),
            (
                "roll.ron -o a.png --frames 1-9",
                "need the frame number in the file name",
            ),
            (
                "ball.ron -o #.png --float",
                "--float is for EXR and TIFF files",
            ),
            ("ball.ron -o #.png --tolerance 0", "tolerance"),
            ("ball.ron -o #.png --chunk 0", "--chunk"),
            (
                "ball.ron -o #.png --region 599,0,2,1",
                "region inside 600 x 600",
            ),
            ("lost.ron -o #.png", "frame 2: "),
            ("ball.ron -o #.png --frames 9-1", "smaller frame first"),
        ] {
            let message = refusal(&format!("{engine} {arguments} --job job"), &[]);
            assert!(message.contains(expected), "{message}");
        }
    }
    assert!(!folder.path("job").exists());
    let message = refusal("openjd ball.ron -o", &["{{frame}}.png"]);
    assert!(message.contains("{{"), "{message}");
    let message = refusal("openjd ball.ron -o", &["a\nb.png"]);
    assert!(message.contains("no control character"), "{message}");
    let message = refusal("openjd ball.ron -o a.png --progress=json", &[]);
    assert!(message.contains("--progress"), "{message}");
}

#[test]
fn long_arrays_are_warned_about() {
    let folder = Folder::new();
    let output = farm(&folder, "slurm roll.ron -o #.png --frames 1-20020", &[]);
    assert_eq!((code(&output), lines(&output.stderr)), (0, vec![]));
    let output = farm(&folder, "slurm roll.ron -o #.png --frames 1-20021", &[]);
    assert_eq!(code(&output), 0);
    assert!(text(&output.stderr).contains("MaxArraySize"));
}
