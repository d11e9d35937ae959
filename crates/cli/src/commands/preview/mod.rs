//! `marbles preview`: shows a frame of a scene, or a picture, in the terminal.

mod blocks;
mod hand;
mod kitty;
mod picture;
mod screen;
mod sixel;
mod stored;
mod watch;

use std::path::Path;

use self::picture::render;
use self::screen::Screen;
use super::args::PreviewArguments;
use super::scene;
use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::base::{status, threads};
use crate::terminal::console::Console;
use crate::terminal::interrupt;
use crate::terminal::keyboard::Keyboard;
use crate::terminal::progress::Progress;
use marbles_core::parallel;
use marbles_scene::STANDARD_INPUT;

/// The number of lines left free for the shell's prompt.
const PROMPT_LINES: u32 = 2;

pub(crate) fn run(arguments: &PreviewArguments, console: &Console) -> Result<u8, Failure> {
    let screen = Screen::of(console)?;
    if stored::is_picture(&arguments.scene) {
        let picture = stored::load(arguments, &screen.area(PROMPT_LINES), console)?;
        console.print(&screen.show(&picture)?);
        return Ok(status::SUCCESS);
    }
    let threads = threads::start(None)?;
    if arguments.watch {
        if arguments.scene.as_path() == Path::new(STANDARD_INPUT) {
            let message = "--watch: expected the file of a scene, found the standard input";
            return Err(Failure::Usage(message.to_owned()));
        }
        return parallel::install(&threads, || watch::run(arguments, &screen, console));
    }
    if screen.is_terminal && !arguments.once && Keyboard::is_there() {
        return parallel::install(&threads, || hand::run(arguments, &screen, console));
    }
    let scene = parallel::install(&threads, || {
        scene::load(&arguments.scene, &arguments.options, console, false)
    })?;
    let view = scene::view(&scene, &arguments.scene, arguments.frame)?;
    let view = screen.area(PROMPT_LINES).fit(Size::of(&view)).resize(view);
    interrupt::listen(console);
    let progress = Progress::new(console, None, false, 1);
    progress.begin(0, Size::of(&view).pixels());
    let world = parallel::install(&threads, || scene::world(&scene, arguments.frame))?;
    let render = || {
        render(
            (&scene, &world),
            &view,
            arguments.tolerance,
            Some(&progress),
        )
    };
    let picture = parallel::install(&threads, render);
    progress.finish();
    let Ok(picture) = picture else {
        return Ok(status::INTERRUPTED);
    };
    console.print(&screen.show(&picture)?);
    Ok(status::SUCCESS)
}

#[cfg(test)]
mod tests;
