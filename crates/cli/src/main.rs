//! The binary `marbles`: a thin wrapper around the library.

fn main() -> std::process::ExitCode {
    marbles_cli::run(std::env::args_os())
}
