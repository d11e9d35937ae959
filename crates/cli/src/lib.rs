//! The command line of marbles.
//!
//! Every command is a file of `commands`. Frames follow each other in `sequence`; `formats` writes and
//! reads pictures, by way of `files`; `terminal` is where the user reads.

mod base;
mod commands;
mod files;
mod formats;
mod sequence;
mod terminal;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

use crate::commands::args::{Arguments, Command};
use crate::terminal::console::Console;

/// Runs the command line `args`, the program's name first, as the binary `marbles` does.
pub fn run(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::from(run_on(args, &Console::of_process()))
}

/// As [`run`], with a console to print to, and the exit code of `status`.
fn run_on(args: impl IntoIterator<Item = OsString>, console: &Console) -> u8 {
    let code = command(args, console);
    match console.lost_results() {
        Some(failure) => {
            console.failure(&failure);
            if code == base::status::SUCCESS {
                failure.exit_code()
            } else {
                code
            }
        }
        None => code,
    }
}

/// Does what the command line asks for.
fn command(args: impl IntoIterator<Item = OsString>, console: &Console) -> u8 {
    let arguments = match Arguments::try_parse_from(args) {
        Ok(arguments) => arguments,
        Err(message) => {
            console.clap(&message.render(), message.use_stderr());
            return if message.use_stderr() {
                base::status::REFUSED
            } else {
                base::status::SUCCESS
            };
        }
    };
    let result = match arguments.command {
        Command::Render(arguments) => commands::render::run(&arguments, console),
        Command::Preview(arguments) => commands::preview::run(&arguments, console),
        Command::Check(arguments) => commands::check::run(&arguments, console),
        Command::Compare(arguments) => commands::compare::run(&arguments, console),
        Command::Merge(arguments) => commands::merge::run(&arguments, console),
        Command::Report(arguments) => commands::report::run(&arguments, console),
        Command::Farm(arguments) => commands::farm::run(&arguments, console),
        Command::New(arguments) => commands::new::run(&arguments, console),
        Command::Completions(arguments) => commands::completions::run(&arguments, console),
        Command::Man(arguments) => commands::man::run(&arguments, console),
    };
    result.unwrap_or_else(|failure| {
        console.failure(&failure);
        failure.exit_code()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::console::tests::Text;

    pub(crate) const SCENE: &str = "(
    image: (width: 600, height: 600),
    lens: Retina(width: 600, distance: 100),
    camera: Free(),
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 400), radius: 300)],
)
";

    /// The exit code, and what is on stdout and stderr.
    pub(crate) fn run_here(args: &[&str]) -> (u8, String, String) {
        let (out, err) = (Text::default(), Text::default());
        let console = Console::to(out.clone(), err.clone());
        let args = ["marbles"].iter().chain(args).map(OsString::from);
        let code = run_on(args, &console);
        (code, out.read(), err.read())
    }

    #[test]
    fn help_goes_to_stdout_and_errors_to_stderr() {
        let (code, out, err) = run_here(&["render", "--help"]);
        assert_eq!((code, &*err), (0, ""));
        assert!(out.contains("Examples:") && !out.contains('\x1b'));
        let (code, out, err) = run_here(&["render", "a.ron", "--frames", "5-1"]);
        assert_eq!((code, &*out), (2, ""));
        assert!(err.contains("expected the smaller frame first"), "{err}");
    }

    #[test]
    fn check_tells_what_the_scene_contains() {
        let name = format!("marbles-{}-check.ron", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, SCENE).unwrap();
        let (code, out, err) = run_here(&["check", path.to_str().unwrap()]);
        std::fs::remove_file(&path).unwrap();
        assert_eq!((code, &*err), (0, ""));
        let (first, rest) = out.split_once('\n').unwrap();
        assert_eq!(first, format!("scene       {}", path.display()));
        assert_eq!(
            rest,
            "\
image       600 x 600 pixels
lens        Retina(width: 600, distance: 100): retina 600 wide at distance 100, 143.13° across
spheres     1, radius 300
  from      (-300, -300, 100)
  to        (300, 300, 700)
materials   0
lights      1
            toward (-0.57735, 0.57735, -0.57735), intensity 1
shadows     on
ambient     0
background  0
color       none: one channel is rendered
frames      a still
camera      Free: x 0, y 0, z 0
  pan       0°
  tilt      0°
"
        );
    }
}
