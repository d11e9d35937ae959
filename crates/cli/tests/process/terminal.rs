//! Tests of the output on a terminal while the work continues.

use std::fs;
use std::process::{Command, Stdio};

use crate::folder::{BALL, Folder, code, text};

/// The output of `marbles` on a terminal of this width; `None` if no terminal is available.
fn run_on_terminal(folder: &Folder, columns: usize, arguments: &str) -> Option<String> {
    end_on_terminal(folder, columns, arguments, 0)
}

/// The same for a run with this exit code.
fn end_on_terminal(
    folder: &Folder,
    columns: usize,
    arguments: &str,
    expected: i32,
) -> Option<String> {
    let marbles = folder.marbles(arguments);
    let program = marbles.get_program().to_str().unwrap();
    // A shell reads them, in which `#` begins a comment.
    let words = arguments.split_whitespace();
    let words: String = words.map(|word| format!(" '{word}'")).collect();
    let command = format!("stty cols {columns} rows 24 && '{program}'{words}");
    let output = Command::new("script")
        .args(["-qec", &command, "/dev/null"])
        .current_dir(&folder.0)
        .env("TERM", "xterm")
        .stdin(Stdio::null())
        .output();
    match output {
        Ok(output) => {
            let shown = text(&output.stdout);
            assert_eq!(code(&output), expected, "{arguments}: {shown}");
            Some(shown)
        }
        Err(_) => {
            eprintln!("skipped: this test needs the program `script`");
            None
        }
    }
}

/// The visible text from the start of a line, without control sequences.
fn visible_lines(shown: &str) -> Vec<String> {
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
    lines.collect()
}

/// The widest of the lines that are `wanted`.
fn widest(lines: &[String], wanted: impl Fn(&str) -> bool) -> usize {
    let lines = lines.iter().filter(|line| wanted(line));
    let widths = lines.map(|line| line.chars().count());
    widths.max().expect("there is such a line")
}

#[test]
fn a_terminal_shows_what_takes_long() {
    const CLOUD: &str = "(
    image: (width: 60, height: 60),
    lens: Fov(40),
    camera: Frame(),
    ambient: 1,
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
        let lines = visible_lines(&shown);
        for (start, whole) in [
            (
                "reading",
                "reading 100% of 1.2 MB: table_with_a_long_name.csv",
            ),
            ("prepari", "preparing 40000 spheres"),
        ] {
            let mut found = lines.iter().filter(|line| line.starts_with(start));
            let widest = found.clone().map(|line| line.trim_end().len()).max();
            assert!(widest.is_some_and(|width| width <= columns), "{lines:?}");
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
fn a_terminal_gets_no_bar_where_another_form_is_asked_for() {
    let folder = Folder::new();
    let arguments = "render roll.ron -o #.png --size 9x9 --frames 1-3";
    // Lines for people begin after some seconds, those for programs at once.
    for (form, events) in [("plain", 0), ("none", 0), ("json", 6)] {
        let arguments = format!("{arguments} --progress={form}");
        let Some(shown) = run_on_terminal(&folder, 80, &arguments) else {
            return;
        };
        assert!(!shown.contains('\x1b'), "{shown:?}");
        let (lines, others): (Vec<&str>, Vec<&str>) =
            shown.lines().partition(|line| line.starts_with('{'));
        assert_eq!(others.len(), 4, "{shown:?}");
        assert!(lines.len() >= events, "{shown:?}");
        assert!(events > 0 || lines.is_empty(), "{shown:?}");
    }
    let shown = run_on_terminal(&folder, 80, arguments).unwrap();
    assert!(shown.contains('\x1b'), "{shown:?}");
}

/// Terminals print `^C` at the cursor. At the end of a line this would begin another line, and the bar would not be
/// erased.
#[test]
fn a_bar_has_room_for_the_key_that_ends_it() {
    let folder = Folder::new();
    let arguments = "render roll.ron -o #.png --size 400x400 --frames 1-4";
    for columns in [80, 46] {
        let Some(shown) = run_on_terminal(&folder, columns, arguments) else {
            return;
        };
        let lines = shown.split(['\r', '\n']);
        let bars: Vec<&str> = lines.filter(|line| line.contains("% of")).collect();
        assert!(!bars.is_empty(), "{shown:?}");
        for bar in bars {
            assert!(bar.ends_with("  \x1b[2D"), "{bar:?}");
        }
    }
}

#[test]
fn help_is_laid_out_for_the_terminal() {
    let folder = Folder::new();
    for (columns, parts) in [
        (
            46,
            [
                "
  marbles farm slurm ball.ron -o out/####.png
      --frames 1-2400 --chunk 20 > ball.sh
  sbatch --cpus-per-task=8 ball.sh
",
                "
marbles reads the scene and checks all options
before it writes the job. Paths become
absolute.",
                "
  2  the command line or the scene file is
     wrong
",
            ],
        ),
        (
            80,
            [
                "
  marbles farm slurm ball.ron -o out/####.png --frames 1-2400 --chunk 20 >
      ball.sh
  sbatch --cpus-per-task=8 ball.sh
",
                "
marbles reads the scene and checks all options before it writes the job. Paths
become absolute.",
                "
  2  the command line or the scene file is wrong
",
            ],
        ),
    ] {
        for command in ["farm slurm", "render", "merge"] {
            let arguments = format!("{command} --help");
            let Some(shown) = run_on_terminal(&folder, columns, &arguments) else {
                return;
            };
            let lines = visible_lines(&shown.replace('\r', ""));
            // clap does not break the line of the usage.
            let width = widest(&lines, |line| !line.starts_with("Usage: "));
            assert!(
                (columns - 6..=columns).contains(&width),
                "{width}: {lines:#?}"
            );
            let help = lines.join("\n");
            let is_there = |part: &&str| command != "farm slurm" || help.contains(*part);
            let missing = parts.iter().find(|part| !is_there(part));
            assert_eq!(missing, None, "{columns}: {help}");
        }
    }
}

/// A bar shows the progress before the tables appear.
#[test]
fn tables_of_a_report_fit_the_terminal() {
    /// The width of the widest cell of the tables after the first.
    const WIDEST: usize = " largest/claimed |".len();
    let folder = Folder::new();
    let arguments = "report ball.ron --size 9x9 --seconds 0 --runs 1";
    for columns in [46, 80] {
        let Some(shown) = run_on_terminal(&folder, columns, arguments) else {
            return;
        };
        let lines = visible_lines(&shown);
        let width = widest(&lines, |line| line.starts_with('|'));
        assert!(
            (columns - WIDEST..=columns).contains(&width),
            "{width}: {lines:#?}"
        );
        let is_bar =
            |line: &String| line.starts_with("reference, tolerance 1e-7") && line.contains("% of");
        assert!(columns < 80 || lines.iter().any(is_bar), "{lines:#?}");
    }
}

#[test]
fn excerpts_fit_the_terminal() {
    /// Columns that may stay empty, because the number of the line has few digits.
    const LEFT: usize = 8;
    let folder = Folder::new();
    let beside = "/* many words beside it */ ".repeat(9);
    let wrong = BALL.replace(
        "-1))],",
        &format!("-1), {beside} intensity: -1, {beside})],"),
    );
    fs::write(folder.path("wrong.ron"), wrong).unwrap();
    for columns in [46, 80] {
        let Some(shown) = end_on_terminal(&folder, columns, "check wrong.ron", 2) else {
            return;
        };
        let lines = visible_lines(&shown);
        let is_excerpt = |line: &str| line.starts_with("5 | …") && line.ends_with('…');
        let width = widest(&lines, is_excerpt);
        assert!(
            (columns - LEFT..=columns).contains(&width),
            "{width}: {lines:#?}"
        );
        let excerpt = lines.iter().find(|line| is_excerpt(line)).unwrap();
        assert!(excerpt.contains("intensity: -1,"), "{excerpt}");
    }
}
