//! The renderer's promise, held against the tests' own integrator at any scale.
//!
//! `cargo truth` prints how it is used.

mod files;
mod hunt;
mod judge;
mod table;
mod whole;

use std::io::{self, Write};
use std::process::ExitCode;

const USAGE: &str = "\
cargo truth judge SCENE [--tolerance 1e-4] [--pixels 2000] [--seed 1] [--size WIDTHxHEIGHT] [--edges] [--single]
    renders SCENE and compares random pixels, and how far they are off with what they claim;
    --edges takes only pixels in which a few points differ in what they see,
    --single renders every pixel as a picture of its own
cargo truth doubt SCENE [--pixels 2000] [--seed 1] [--size WIDTHxHEIGHT]
    compares the truth of random pixels with that of their quarters
cargo truth pixel SCENE COL ROW [--size WIDTHxHEIGHT]
    what is known of one pixel
cargo truth hunt [--scenes 160] [--seed 1] [--family NAME] [--tolerances 1e-2,1e-3,1e-4,1e-5,1e-6]
                 [--write FOLDER] [--page docs/hunt.md] [--rows 10] [--only SCENE] [--limits FILE]
    renders random scenes of every family to all tolerances, counts pixels that are over them without
    saying so, and pixels that are over what they say, and tells the medians of true over claimed errors;
    every scene is rendered again with a radius an ulp larger: pixels that move by more than they claim are broken;
    the scenes of the family \"together\" go through the rows of an array of features, any three of which occur together:
    --rows tells how many scenes each row has;
    --write reduces scenes of such pixels and writes them, --page writes the tables into a page,
    --only takes a single scene of each family, --limits refuses to give up more pixels than a file allows
cargo truth laws [--scenes 160] [--seed 1] [--family NAME] [--tolerances 1e-2,...] [--rows 10] [--only SCENE]
    renders the scenes of a hunt with other units of length and of light: values, claims and counts of work
    are to be the same bits
cargo truth whole [SCENE ...] [--size own|WIDTHxHEIGHT] [--tolerances 1e-2,1e-3,1e-4,5e-5,1e-5]
    renders the scenes, or all of scenes/, in their own size and in two odd ones, and holds every pixel against the
    same picture with 3 x 3 as many pixels at 1e-7
cargo truth write [NAME]
cargo truth check [NAME]
    write, or compute again, the exact pixels of the scenes in tests/truth/promise, or of those
    whose names contain NAME
cargo truth promise [NAME] [--whole]
    what the test of the promise measures on these scenes, as a table; --whole renders whole
    pictures instead of single pixels
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            // Nothing is left to do when even this fails.
            let _ = writeln!(io::stderr(), "{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(), String> {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
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
        _ => return Err(USAGE.to_owned()),
    };
    write!(io::stdout(), "{report}").map_err(|error| error.to_string())
}
