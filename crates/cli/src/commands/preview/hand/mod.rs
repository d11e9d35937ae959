//! The camera by hand: keys move it, and the picture follows.

mod file;
mod motion;
mod quick;
mod status;

use std::time::{Duration, Instant};

use marbles_core::{Renderer, View};
use marbles_scene::Scene;

use self::file::CameraFile;
use self::motion::{Change, Hand, Motion};
use self::quick::{Pace, Stage};
use super::picture::render_until;
use super::screen::{Area, Screen};
use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::base::status as codes;
use crate::commands::args::PreviewArguments;
use crate::commands::scene;
use crate::sequence::frames::frames_of;
use crate::terminal::alternate_screen::AlternateScreen;
use crate::terminal::console::Console;
use crate::terminal::interrupt;
use crate::terminal::keyboard::{Keyboard, is_end};
use crate::terminal::keys::{Key, Keys};

/// The line below the picture.
const STATUS_LINES: u32 = 1;
/// The time without keys after which the picture is refined.
const REST: Duration = Duration::from_millis(80);
/// The time between two looks at the size of the screen.
const INTERVAL: Duration = Duration::from_millis(100);

/// Shows the picture, and moves the camera by keys, until the user quits; on the threads of the current pool.
pub(super) fn run(
    arguments: &PreviewArguments,
    screen: &Screen,
    console: &Console,
) -> Result<u8, Failure> {
    let path = &arguments.scene;
    let options = &arguments.options;
    let scene = scene::load(path, options, console, false)?;
    let file = CameraFile::of(path, &options.set)?;
    scene::view(&scene, path, arguments.frame)?;
    let world = scene::world(&scene, arguments.frame)?;
    interrupt::listen(console);
    let frame = arguments.frame.unwrap_or(*frames_of(&scene).start());
    let hand = scene.orbit_camera(frame).map(Hand::new);
    let mut session = Session {
        arguments,
        screen,
        console,
        file,
        hand: hand.map_err(|reason| reason.to_string()),
        renderer: Renderer::new(&world),
        scene,
        message: None,
        last: None,
    };
    let end = {
        let (_keyboard, keys) = Keyboard::read();
        let alternate = AlternateScreen::enter(console);
        session.run(keys, &alternate)?
    };
    match (end, &session.hand) {
        (End::Interrupted, _) => return Ok(codes::INTERRUPTED),
        (End::Print, Ok(hand)) => console.result(&session.file.lines(hand)?),
        (End::Print | End::Quit, _) => {}
    }
    Ok(codes::SUCCESS)
}

/// The end of a session.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum End {
    Quit,
    /// With the camera printed.
    Print,
    Interrupted,
}

/// A scene in the terminal, and its camera in a hand.
struct Session<'a> {
    arguments: &'a PreviewArguments,
    screen: &'a Screen,
    console: &'a Console,
    scene: Scene,
    renderer: Renderer<'a>,
    /// The camera, or the reason for which it cannot be moved.
    hand: Result<Hand, String>,
    file: CameraFile<'a>,
    /// An answer to the last key.
    message: Option<String>,
    /// The room, and in it the size of the picture, that are on the screen.
    last: Option<(Area, Size)>,
}

impl Session<'_> {
    fn run(&mut self, keys: &Keys, alternate: &AlternateScreen) -> Result<End, Failure> {
        let mut area = self.screen.area(STATUS_LINES);
        let mut pace = Pace::new(area.fit(Size::of(&self.view()?)));
        let mut next = Some(Stage::Quick);
        loop {
            if interrupt::requested() {
                return Ok(End::Interrupted);
            }
            let pressed = keys.take();
            let before = self.hand.as_ref().ok().map(Hand::camera);
            for &key in &pressed {
                if let Some(end) = self.press(key)? {
                    return Ok(end);
                }
            }
            if self.hand.as_ref().ok().map(Hand::camera) != before {
                self.move_camera()?;
                next = Some(Stage::Quick);
            } else if !pressed.is_empty() {
                self.show_status();
            }
            let (is_empty, now) = (alternate.was_stopped(), self.screen.area(STATUS_LINES));
            if is_empty || now != area {
                (area, self.last) = (now, None);
                next = Some(Stage::Quick);
            }
            let Some(stage) = next else {
                keys.wait(INTERVAL);
                continue;
            };
            if stage != Stage::Quick {
                keys.wait(REST);
            }
            let is_over = || {
                let is_moved = || keys.is_waiting() || self.screen.area(STATUS_LINES) != area;
                interrupt::requested() || stage != Stage::Quick && is_moved()
            };
            if !is_over() && self.show(stage, &mut pace, area, &is_over)? {
                next = stage.next(pace);
            }
        }
    }

    /// Does what a key asks for.
    fn press(&mut self, key: Key) -> Result<Option<End>, Failure> {
        self.message = None;
        if is_end(key) {
            return Ok(Some(End::Quit));
        }
        if self.hand.is_ok() && matches!(key, Key::Letter(b'w' | b'W')) {
            // As the scene will be when the file is read.
            self.move_camera()?;
        }
        // The line says why there are no other keys.
        let Ok(hand) = &mut self.hand else {
            return Ok(None);
        };
        match key {
            Key::Letter(b'p' | b'P') => return Ok(Some(End::Print)),
            Key::Letter(b'w' | b'W') => {
                self.message = Some(self.file.write(hand));
                // Once it is written, Home leads back to it.
                if hand.change() == Change::None {
                    self.scene.accept_camera();
                }
            }
            _ => {
                if let Some(motion) = Motion::of(key) {
                    hand.apply(motion);
                }
            }
        }
        Ok(None)
    }

    /// Moves the camera of the scene to where the hand has it.
    fn move_camera(&mut self) -> Result<(), Failure> {
        let Ok(hand) = &self.hand else {
            return Ok(());
        };
        match hand.change() {
            Change::None => self.scene.reset_camera(),
            Change::Zoom(camera) => self.scene.set_zoom(camera.zoom),
            Change::Turn(camera) => {
                let moved = self.scene.set_orbit_camera(&camera);
                moved.map_err(|error| Failure::Scene(Box::new(error)))?;
            }
        }
        Ok(())
    }

    fn view(&self) -> Result<View, Failure> {
        scene::view(&self.scene, &self.arguments.scene, self.arguments.frame)
    }

    /// Shows a picture unless `is_over` before it is done; returns whether it is shown.
    fn show(
        &mut self,
        stage: Stage,
        pace: &mut Pace,
        area: Area,
        is_over: &(dyn Fn() -> bool + Sync),
    ) -> Result<bool, Failure> {
        let view = self.view()?;
        let full = area.fit(Size::of(&view));
        let size = match stage {
            Stage::Quick => pace.size(full),
            Stage::Sampled | Stage::Best => full,
        };
        let view = size.resize(view);
        let started = Instant::now();
        let picture = render_until(
            &self.renderer,
            self.scene.exposure(&view),
            stage.method(self.arguments.tolerance),
            &|_| is_over(),
        );
        let Ok(mut picture) = picture else {
            return Ok(false);
        };
        // Large pictures take a while to encode, and to print.
        if is_over() {
            return Ok(false);
        }
        if size != full {
            picture = picture.stretched(full);
        }
        let text = match self.last {
            Some(last) if last == (area, full) => self.screen.follow(&picture)?,
            _ => self.screen.clear() + &self.screen.follow(&picture)?,
        };
        if is_over() {
            return Ok(false);
        }
        self.last = Some((area, full));
        self.console.print(&text);
        self.show_status();
        if stage == Stage::Quick {
            pace.learn(started.elapsed());
        }
        Ok(true)
    }

    /// Shows the line below the picture.
    fn show_status(&self) {
        let columns = self.screen.cells().0 as usize;
        let text = match (&self.message, &self.hand) {
            (Some(message), _) => message.clone(),
            (None, Ok(hand)) => status::of_camera(&hand.camera(), columns),
            (None, Err(reason)) => status::of_still(reason, columns),
        };
        self.console.print(&self.screen.last_line(&text));
    }
}
