//! Compares pixels of the renderer with the tests' own integrator: single ones, whole pictures, and random scenes.
//!
//! `cargo truth --help` prints the usage, `cargo truth COMMAND --help` that of one command.

mod files;
mod hunt;
mod judge;
mod table;
mod whole;

use std::io::{self, Write};
use std::process::ExitCode;

/// A command: its name, and its usage.
type Command = (&'static str, &'static str);

const COMMANDS: [Command; 9] = [
    (
        "judge",
        "\
cargo truth judge SCENE [--tolerance 1e-4] [--pixels 2000] [--seed 1] [--size WIDTHxHEIGHT] [--edges] [--single]
    Renders SCENE, and compares random pixels and their claimed errors with the exact values.
    --edges    take only pixels in which a few points see different things
    --single   render every pixel as a picture of its own
",
    ),
    (
        "doubt",
        "\
cargo truth doubt SCENE [--pixels 2000] [--seed 1] [--size WIDTHxHEIGHT]
    Checks the integrator: compares the exact values of random pixels with those of their quarters.
",
    ),
    (
        "pixel",
        "\
cargo truth pixel SCENE COL ROW [--size WIDTHxHEIGHT]
    Prints the exact value of a pixel, and its value and claimed error at several tolerances.
",
    ),
    (
        "hunt",
        "\
cargo truth hunt [--scenes 160] [--seed 1] [--family NAME] [--tolerances 1e-2,1e-3,1e-4,1e-5,1e-6]
                 [--write FOLDER] [--page docs/hunt.md] [--rows 10] [--only SCENE] [--limits FILE]
    Renders random scenes of every family at all tolerances, and counts broken pixels: those over a tolerance that
    are not reported as such, and those with a larger error than they claim. Also prints the median ratio of true and
    claimed errors. Renders every scene again with a radius an ulp larger: pixels that change by more than they claim
    are broken, too.
    --rows     the number of scenes for each row of the family \"together\", whose rows combine any three features
    --write    simplify the scenes of broken pixels, and write them to FOLDER
    --page     write the tables into a page
    --only     take only the scene with this number in each family
    --limits   fail if more pixels are over the tolerance than FILE allows
",
    ),
    (
        "laws",
        "\
cargo truth laws [--scenes 160] [--seed 1] [--family NAME] [--tolerances 1e-2,...] [--rows 10] [--only SCENE]
    Renders the scenes of a hunt in other units of length and of light. Values, claims and the amount of work must be the
    same to the bit.
",
    ),
    (
        "whole",
        "\
cargo truth whole [SCENE ...] [--size own|WIDTHxHEIGHT] [--tolerances 1e-2,1e-3,1e-4,5e-5,1e-5]
    Renders the scenes, or all of scenes/, in their own size and in two odd sizes, and compares every pixel with a picture
    of 3 x 3 as many pixels at 1e-7.
",
    ),
    (
        "write",
        "\
cargo truth write [NAME]
    Computes and writes the exact pixels of the scenes in tests/truth/promise, or of those whose names contain NAME.
",
    ),
    (
        "check",
        "\
cargo truth check [NAME]
    Computes these pixels again, and compares them with the files.
",
    ),
    (
        "promise",
        "\
cargo truth promise [NAME] [--whole]
    Prints the measurements of the test of the promise for these scenes as a table.
    --whole    render whole pictures instead of single pixels
",
    ),
];

/// The usage of one command, or of all of them if there is no command with this name.
fn usage(name: &str) -> String {
    let own = COMMANDS.iter().find(|(command, _)| *command == name);
    match own {
        Some((_, usage)) => (*usage).to_owned(),
        None => COMMANDS.map(|(_, usage)| usage).concat(),
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            // If stderr is closed, there is nobody to tell.
            let _ = writeln!(io::stderr(), "{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(), String> {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let first = arguments.first().copied().unwrap_or_default();
    if arguments
        .iter()
        .any(|word| matches!(*word, "--help" | "-h"))
    {
        return print(&usage(first));
    }
    let report = match arguments.as_slice() {
        ["judge", scene, options @ ..] => judge::judge(scene, options)?,
        ["doubt", scene, options @ ..] => judge::doubt(scene, options)?,
        ["pixel", scene, col, row, options @ ..] => judge::pixel(scene, col, row, options)?,
        ["hunt", options @ ..] => hunt::hunt(options)?,
        ["laws", options @ ..] => hunt::laws(options)?,
        ["whole", options @ ..] => whole::whole(options)?,
        ["write"] => files::write("")?,
        ["write", part] => files::write(part)?,
        ["check"] => files::check("")?,
        ["check", part] => files::check(part)?,
        ["promise"] => table::table("", false),
        ["promise", "--whole"] => table::table("", true),
        ["promise", part] => table::table(part, false),
        ["promise", part, "--whole"] => table::table(part, true),
        _ => return Err(usage(first)),
    };
    print(&report)
}

fn print(text: &str) -> Result<(), String> {
    write!(io::stdout(), "{text}").map_err(|error| error.to_string())
}
