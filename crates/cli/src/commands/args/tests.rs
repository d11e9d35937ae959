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
