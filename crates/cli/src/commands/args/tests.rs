//! Tests of `mod.rs`.

use clap::CommandFactory;

use super::*;

#[test]
fn the_command_line_is_consistent() {
    Arguments::command().debug_assert();
}

#[test]
fn frames_may_begin_with_a_minus() {
    for list in ["-5", "-10--5", "-5-5", "1-4"] {
        let arguments = Arguments::try_parse_from(["marbles", "render", "a", "--frames", list]);
        let Ok(Arguments {
            command: Command::Render(render),
        }) = arguments
        else {
            panic!("{list}: {arguments:?}");
        };
        assert_eq!(render.frames, list.parse().ok());
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    for option in [
        "--samples=0",
        "--samples=1001",
        "--threads=0",
        "--threads=-1",
        "--bits=12",
    ] {
        let arguments = Arguments::try_parse_from(["marbles", "render", "a", option]);
        assert_eq!(arguments.unwrap_err().exit_code(), 2, "{option}");
    }
}

#[test]
fn help_fits_the_terminal() {
    let mut commands = vec![vec![]];
    let all = Arguments::command();
    for command in all.get_subcommands() {
        commands.push(vec![command.get_name()]);
        let its = command.get_subcommands();
        commands.extend(its.map(|its| vec![command.get_name(), its.get_name()]));
    }
    for (columns, command) in [100, 80, 46].into_iter().flat_map(|columns| {
        let commands = commands.iter();
        commands.map(move |command| (columns, command))
    }) {
        let words = ["marbles"].iter().chain(command).chain(&["--help"]);
        let help = Arguments::of(words.map(OsString::from), columns).unwrap_err();
        let help = help.render().to_string();
        assert!(help.contains("Usage: "), "{help}");
        // clap does not break the line of the usage, and nobody breaks words.
        let broken = |line: &&str| !line.starts_with("Usage: ") && line.trim().contains(' ');
        for line in help.lines().filter(broken) {
            assert!(
                line.chars().count() <= columns,
                "{columns} {command:?}: {line}"
            );
        }
    }
}
