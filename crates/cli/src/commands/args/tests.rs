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
    const OTHERS: [&str; 15] = [
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
        "turntable",
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

#[test]
fn the_default_tolerance_is_the_one_that_help_tells() {
    let words = ["marbles", "render", "a.ron"].map(OsString::from);
    let Command::Render(arguments) = Arguments::of(words, 80).unwrap().command else {
        panic!("another command");
    };
    assert_eq!(arguments.tolerance, DEFAULT_TOLERANCE);
}

/// A word of the command line is repeated in a message, where it does nothing to a terminal.
#[test]
fn words_do_nothing_to_a_terminal() {
    for word in [
        "a\u{1b}[31mb",
        "a\u{9b}31mb",
        "a\nb",
        "a\u{202e}b",
        "a\u{7f}b",
    ] {
        for words in [
            vec![format!("fly{word}")],
            vec!["render".to_owned(), format!("--fly{word}")],
            vec![
                "render".to_owned(),
                "a.ron".to_owned(),
                format!("--tolerance={word}"),
            ],
            vec![
                "render".to_owned(),
                "a.ron".to_owned(),
                format!("--size={word}"),
            ],
            vec![
                "render".to_owned(),
                "a.ron".to_owned(),
                format!("--frames={word}"),
            ],
            vec![
                "render".to_owned(),
                "a.ron".to_owned(),
                format!("--progress={word}"),
            ],
            vec![
                "render".to_owned(),
                "a.ron".to_owned(),
                format!("--channels=id,{word}"),
            ],
            vec!["check".to_owned(), "a.ron".to_owned(), word.to_owned()],
        ] {
            let words = ["marbles".to_owned()].into_iter().chain(words);
            let error = Arguments::of(words.map(OsString::from), 1000).unwrap_err();
            // Its own styles are those of clap.
            let text = error.render().ansi().to_string();
            assert!(!text.contains(word), "{text:?}");
            assert!(text.contains(&marbles_scene::harmless(word)), "{text:?}");
        }
    }
}

#[test]
fn options_that_do_not_exist_get_a_tip_of_what_to_write() {
    let message = |words: &[&str]| {
        let words = ["marbles"].iter().chain(words);
        let words = words.map(|word| OsString::from(*word));
        let refused = Arguments::of(words, 200).expect_err("it is no option");
        refused.to_string()
    };
    for (words, tip) in [
        (
            &["render", "a.ron", "--background", "white"][..],
            "write `--white`, `--transparent` or `--set background=0.5` of `marbles render`",
        ),
        (&["render", "a.ron", "--background=white"], "`--white`"),
        (
            &["render", "a.ron", "--width", "300"],
            "write `--size 1200x900`",
        ),
        (
            &["render", "a.ron", "--camera", "top"],
            "write `--view top`",
        ),
        (
            &["preview", "a.ron", "--transparent"],
            "`--transparent` is an option of `marbles render`",
        ),
        (&["check", "a.ron", "--white"], "`--white` is an option of"),
        // Slips keep the tips that clap has for them.
        (&["render", "a.ron", "--tolerence", "1"], "'--tolerance'"),
        (&["render", "a.ron", "--size", "3000"], "such as 3000x1875"),
    ] {
        let message = message(words);
        assert!(message.contains(tip), "{words:?}: {message}");
        assert!(!message.contains("as a value"), "{message}");
        assert!(!message.contains("'--scale-bar'"), "{message}");
    }
}
