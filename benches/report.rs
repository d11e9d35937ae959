//! Measures the cost of a smaller error, with tolerances and with supersampling.
//!
//! Runs `marbles report` on two scenes. With `-- --write`, the plots and the output become the measured parts of
//! docs/report.md.

use std::process::ExitCode;

use marbles_benches::page::Page;
use marbles_benches::process::{main as run, marbles};
use marbles_benches::{in_repository, is_to_write};

/// A scene that is measured.
struct Subject {
    /// The name of its part of the page, and of its plot.
    name: &'static str,
    path: &'static str,
    /// The alternative text of the plot.
    plot: &'static str,
    /// The time for all of its runs, in seconds.
    seconds: &'static str,
}

const SUBJECTS: [Subject; 2] = [
    Subject {
        name: "sphere1",
        path: "scenes/original/sphere1.ron",
        plot: "Time against RMSE for one ball",
        seconds: "10",
    },
    Subject {
        name: "cloud1k",
        path: "tests/truth/pixels/cloud1k.ron",
        plot: "Time against RMSE for a cloud of a thousand balls",
        seconds: "40",
    },
];

fn main() -> ExitCode {
    run(|| {
        let names = SUBJECTS.each_ref().map(|subject| subject.name);
        let mut page = is_to_write().then(|| Page::open("docs/report.md", &names));
        for subject in &SUBJECTS {
            measure(subject, page.as_mut());
        }
    })
}

/// Measures a scene; prints the result, or writes it and the plot.
#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn measure(subject: &Subject, page: Option<&mut Page>) {
    let &Subject {
        name,
        path,
        seconds,
        plot,
    } = subject;
    let mut words = vec!["report", path, "--size", "600x600", "--threads", "1"];
    words.extend(["--runs", "3", "--seconds", seconds]);
    let file = format!("docs/report/{name}.svg");
    if page.is_some() {
        words.extend(["--plot", &file]);
    }
    let report = marbles(&in_repository(""), &words);
    let (facts, rest) = report.split_once("\n\n").expect("facts, then a table");
    let (table, notes) = rest.split_once("\n\n").unwrap_or((rest, ""));
    assert!(table.contains("| tolerance 1e-6"), "{table}");
    let Some(page) = page else {
        println!("{report}");
        return;
    };
    // A note that begins with an asterisk would be an item of a list.
    let notes = notes.replace("* ", "\\* ").replace('\n', "\n\n");
    let command = words.join(" ");
    page.write(
        name,
        &format!(
            "```sh\nmarbles {command}\n```\n\n![{plot}](report/{name}.svg)\n\n\
             ```text\n{facts}\n```\n\n{table}\n\n{notes}"
        ),
    );
}
