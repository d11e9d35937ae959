//! `marbles completions`: the files by which shells complete the command line.

use clap::CommandFactory;

use super::args::{Arguments, CompletionsArguments};
use crate::base::failure::Failure;
use crate::base::status;
use crate::terminal::console::Console;

pub(crate) fn run(arguments: &CompletionsArguments, console: &Console) -> Result<u8, Failure> {
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, name, &mut script);
    console.print(&String::from_utf8_lossy(&script));
    Ok(status::SUCCESS)
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;
    use clap_complete::Shell;

    use crate::tests::run_here;

    #[test]
    fn every_shell_learns_every_command_and_option() {
        let mut scripts = Vec::new();
        for shell in Shell::value_variants() {
            let (code, script, err) = run_here(&["completions", &shell.to_string()]);
            assert_eq!((code, &*err), (0, ""));
            // Each in its own language.
            assert!(!scripts.contains(&script), "{shell}");
            scripts.push(script.clone());
            // Fish leaves the dashes out.
            for word in ["marbles", "render", "compare", "error-channel", "tolerance"] {
                assert!(script.contains(word), "{shell}: {word}");
            }
        }
    }

    #[test]
    fn unknown_shells_are_refused() {
        let (code, out, err) = run_here(&["completions", "tcsh"]);
        assert_eq!((code, &*out), (2, ""));
        assert!(err.contains("tcsh") && err.contains("fish"), "{err}");
    }
}
