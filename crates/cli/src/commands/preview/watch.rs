//! `--watch`: shows the picture again whenever its files are saved.
//!
//! Files are checked several times per second. This detects every way to save a file, by writing or by renaming, and
//! also on disks of other machines, for which the system reports no changes.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, SystemTime};

use marbles_core::Cancelled;
use marbles_scene::SceneError;

use super::picture::{Picture, render};
use super::screen::{Area, Screen};
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::base::size::Size;
use crate::base::status;
use crate::commands::args::PreviewArguments;
use crate::commands::scene;
use crate::terminal::alternate_screen::AlternateScreen;
use crate::terminal::console::Console;
use crate::terminal::interrupt;
use crate::terminal::keyboard::Keyboard;

/// The time between two checks. A file that changes between two checks is still being saved.
const INTERVAL: Duration = Duration::from_millis(100);
/// The line below the picture.
const STATUS_LINES: u32 = 1;

/// Shows the picture until the user quits, on the threads of the current pool.
pub(super) fn run(
    arguments: &PreviewArguments,
    screen: &Screen,
    console: &Console,
) -> Result<u8, Failure> {
    if !screen.is_terminal {
        return Err(Failure::Usage(
            "--watch needs a terminal, but the output is not a terminal".to_owned(),
        ));
    }
    interrupt::listen(console);
    let _keyboard = Keyboard::listen(interrupt::request);
    let alternate = AlternateScreen::enter(console);
    let mut files = Files::of(&arguments.scene);
    while !interrupt::requested() {
        let area = screen.area(STATUS_LINES);
        let shown = match look(arguments, &area, &mut files, console) {
            Ok(Ok(picture)) => screen.replace(&picture)?,
            Ok(Err(Cancelled)) => break,
            Err(failure) => screen.clear() + &message(&console.message(&failure), screen.cells()),
        };
        let scene = arguments.scene.shown();
        let status = format!("{scene}: updated when you save it; q quits");
        console.print(&(shown + &screen.last_line(&status)));
        wait(&mut files, || {
            alternate.was_stopped() || screen.area(STATUS_LINES) != area
        });
    }
    Ok(match Keyboard::was_pressed() {
        true => status::SUCCESS,
        false => status::INTERRUPTED,
    })
}

/// The picture of the current contents of the files.
fn look(
    arguments: &PreviewArguments,
    area: &Area,
    files: &mut Files,
    console: &Console,
) -> Result<Result<Picture, Cancelled>, Failure> {
    let started = SystemTime::now();
    let scene = scene::load(&arguments.scene, &arguments.options, console, true);
    match &scene {
        Ok(scene) => files.name(scene.table_files(), started),
        Err(Failure::Scene(error)) => files.add(SceneError::path(error).to_owned(), started),
        Err(_) => {}
    }
    let scene = scene?;
    let view = scene::view(&scene, &arguments.scene, arguments.frame)?;
    let view = area.fit(Size::of(&view)).resize(view);
    let world = scene::world(&scene, arguments.frame)?;
    Ok(render((&scene, &world), &view, arguments.tolerance, None))
}

/// Waits until the files have been saved completely, the size of the screen has changed, or the user quits.
fn wait(files: &mut Files, is_other: impl Fn() -> bool) {
    let mut before = files.stamps.clone();
    while !interrupt::requested() {
        thread::sleep(INTERVAL);
        let now = files.look();
        if now == before && (now != files.stamps || is_other()) {
            files.stamps = now;
            return;
        }
        before = now;
    }
}

/// The files that a picture depends on, and their states when they were read.
struct Files {
    scene: PathBuf,
    stamps: Stamps,
}

/// The states of files; `None` for a missing file.
type Stamps = BTreeMap<PathBuf, Option<Stamp>>;

/// The state of a file.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
struct Stamp {
    modified: SystemTime,
    length: u64,
}

impl Files {
    /// A scene whose tables are not known yet.
    fn of(scene: &Path) -> Self {
        Self {
            scene: scene.to_owned(),
            stamps: Stamps::from([(scene.to_owned(), stamp(scene))]),
        }
    }

    /// The states of the files now.
    fn look(&self) -> Stamps {
        let paths = self.stamps.keys();
        paths.map(|path| (path.clone(), stamp(path))).collect()
    }

    /// Replaces the tables by these, which have been read since `started`.
    fn name(&mut self, tables: Vec<PathBuf>, started: SystemTime) {
        let scene = &self.scene;
        self.stamps
            .retain(|path, _| path == scene || tables.contains(path));
        for table in tables {
            self.add(table, started);
        }
    }

    /// Replaces the scene file, which has been read since `started`, if it is a different one.
    fn add(&mut self, path: PathBuf, started: SystemTime) {
        // What was written since then may have been read before.
        let stamp = stamp(&path).filter(|stamp| stamp.modified < started);
        self.stamps.entry(path).or_insert(stamp);
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let metadata = fs::metadata(path).ok()?;
    Some(Stamp {
        modified: metadata.modified().ok()?,
        length: metadata.len(),
    })
}

/// As many lines of a message as fit, if the terminal wraps the longer ones.
fn message(text: &str, (columns, rows): (u32, u32)) -> String {
    let mut room = rows.saturating_sub(STATUS_LINES) as usize;
    let mut shown = String::new();
    for line in text.lines() {
        let width = console::measure_text_width(line);
        let lines = width.div_ceil(columns as usize).max(1);
        if lines > room {
            break;
        }
        room -= lines;
        shown.push_str(line);
        shown.push('\n');
    }
    shown
}

#[cfg(test)]
mod tests;
