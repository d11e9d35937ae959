//! Tests of `mod.rs`.

use clap::error::ErrorKind;

use super::*;

/// `marbles`, its commands and theirs, with the names that call them.
fn commands() -> Vec<(Vec<String>, clap::Command)> {
    fn push(
        names: &[String],
        command: &clap::Command,
        all: &mut Vec<(Vec<String>, clap::Command)>,
    ) {
        all.push((names.to_vec(), command.clone()));
        for its in command.get_subcommands() {
            push(&[names, &[its.get_name().to_owned()]].concat(), its, all);
        }
    }
    let mut all = Vec::new();
    push(&[], &Arguments::command(), &mut all);
    all
}

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

/// After a space as well, so that nobody is told to write `--` before them.
#[test]
fn negative_numbers_are_values() {
    /// Options whose values are no numbers.
    const OTHERS: [&str; 14] = [
        "set",
        "output",
        "job",
        "diff",
        "csv",
        "plot",
        "legend",
        "scale-bar",
        "layout",
        "progress",
        "per-light",
        "channels",
        "depth",
        "axes",
    ];
    let mut count = 0;
    for (names, command) in commands() {
        let options = command.get_opts();
        for option in options.filter(|option| option.get_action().takes_values()) {
            let name = option.get_long().unwrap();
            // None of them has a meaning.
            let value = match name {
                _ if OTHERS.contains(&name) => continue,
                "size" => "-1x2",
                "region" => "-1,2,3,4",
                _ => "-1000.5",
            };
            let option = format!("--{name}");
            let words = names.iter().map(String::as_str);
            let words = ["marbles"]
                .into_iter()
                .chain(words)
                .chain([&*option, value]);
            let error = Arguments::try_parse_from(words).unwrap_err();
            let text = error.to_string();
            assert_eq!(error.kind(), ErrorKind::ValueValidation, "{names:?} {text}");
            let start = format!("error: invalid value '{value}' for '{option} ");
            assert!(text.starts_with(&start), "{names:?} {text}");
            assert!(!text.contains("use '--"), "{names:?} {text}");
            count += 1;
        }
    }
    assert!(count >= 35, "{count} options were tried");
}

#[test]
fn help_fits_the_terminal() {
    let commands = commands();
    for (columns, (names, command)) in [100, 80, 46].into_iter().flat_map(|columns| {
        let commands = commands.iter();
        commands.map(move |command| (columns, command))
    }) {
        let words = names.iter().map(String::as_str);
        let words = ["marbles"].into_iter().chain(words).chain(["--help"]);
        let help = Arguments::of(words.map(OsString::from), columns).unwrap_err();
        let help = help.render().to_string();
        assert!(help.contains("Usage: "), "{help}");
        // Nothing breaks the lines of its end again.
        let end = command.get_after_help().map(ToString::to_string);
        let end = end.map_or_else(String::new, |end| lay_out(&end, columns));
        assert!(
            help.trim_end().ends_with(&end),
            "{columns} {names:?}: {help}"
        );
        // clap does not break the line of the usage, and nobody breaks words.
        let broken = |line: &&str| !line.starts_with("Usage: ") && line.trim().contains(' ');
        for line in help.lines().filter(broken) {
            assert!(
                line.chars().count() <= columns,
                "{columns} {names:?}: {line}"
            );
        }
    }
}
