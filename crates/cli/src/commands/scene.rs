//! Scenes from their files, and on a terminal how far the reading is.

use std::fs;
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use marbles_scene::{Progress, Scene};

use crate::base::failure::Failure;
use crate::base::numbers;
use crate::terminal::console::Console;

/// Smaller files are read before anybody has read a line about them, in bytes.
const LARGE: u64 = 1 << 20;

/// A line that is cut where the terminal ends.
pub(crate) const LINE: &str = "{wide_msg}";

/// Loads the scene file at `path`, and the tables that it names, on the threads of the current
/// rayon pool.
pub(crate) fn load(path: &Path, console: &Console, quiet: bool) -> Result<Scene, Failure> {
    let bar = (console.is_interactive() && !quiet).then(|| ProgressBar::new(0));
    // Terminals that cannot go back to the start of a line have no bars.
    let bar = bar.filter(|bar| !bar.is_hidden());
    if let (Some(bar), Ok(style)) = (&bar, ProgressStyle::with_template(LINE)) {
        bar.set_style(style);
    }
    let show = |line: String| {
        if let Some(bar) = &bar {
            bar.set_message(line);
            bar.tick();
        }
    };
    let size = fs::metadata(path).map_or(0, |metadata| metadata.len());
    if size >= LARGE {
        show(format!(
            "reading {}: {}",
            numbers::bytes(size),
            path.display()
        ));
    }
    let scene = Scene::load_watched(path, &|progress| {
        if progress.read.max(progress.size) >= LARGE {
            show(line(&progress));
        }
    });
    if let Some(bar) = &bar {
        bar.finish_and_clear();
    }
    scene.map_err(|error| Failure::Scene(Box::new(error)))
}

/// How far the reading of a table is.
fn line(progress: &Progress<'_>) -> String {
    let Progress { table, read, size } = progress;
    let table = table.display();
    if read > size {
        // What is no ordinary file says that it is empty.
        return format!("reading, {} so far: {table}", numbers::bytes(*read));
    }
    let percent = 100.0 * *read as f64 / *size as f64;
    let size = numbers::bytes(*size);
    format!("reading {percent:>3.0}% of {size}: {table}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_say_how_much_of_what_was_read() {
        let line = |read, size| {
            let table = Path::new("salt.npy");
            line(&Progress { table, read, size })
        };
        assert_eq!(line(2 << 20, 0), "reading, 2.1 MB so far: salt.npy");
        assert_eq!(
            line(9_600_000, 320_000_000),
            "reading   3% of 320 MB: salt.npy"
        );
        assert_eq!(line(5 << 20, 5 << 20), "reading 100% of 5.2 MB: salt.npy");
    }
}
