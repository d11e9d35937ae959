//! Tests of what a terminal shows while the work goes on.

use std::fs;
use std::process::{Command, Stdio};

use crate::folder::{Folder, text};

/// The output of `marbles` on a terminal of this width; `None` where there is no way to have one.
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
fn a_terminal_gets_plain_lines_where_they_are_asked_for() {
    let folder = Folder::new();
    let arguments = "render roll.ron -o #.png --size 9x9 --frames 1-3";
    for (form, count) in [("plain", 7), ("none", 4)] {
        let arguments = format!("{arguments} --progress={form}");
        let Some(shown) = run_on_terminal(&folder, 80, &arguments) else {
            return;
        };
        assert!(!shown.contains('\x1b'), "{shown:?}");
        assert_eq!(shown.lines().count(), count, "{shown:?}");
    }
}

/// Terminals show `^C` where the cursor is; at the end of a line that would begin another one, and the
/// bar would stay.
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
