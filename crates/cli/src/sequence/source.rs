//! Which frame comes next, and what is made ready for it.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{SyncSender, channel};
use std::sync::{Arc, OnceLock};

use marbles_core::{Exposure, Renderer, Rendering, Window};

use super::workers::Shared;
use super::{Order, Sequence, Ways};
use crate::base::failure::Failure;
use crate::files::place;
use crate::files::temporary::{LeftOver, TemporaryFile};
use crate::formats::contents::{self, Content};
use crate::formats::{Encoding, Facts};
use crate::sequence::digest::{Digests, Shot};
use crate::sequence::messages;
use crate::sequence::strip_encoder::Film;
use crate::terminal::progress::Progress;

/// Gives pictures to render, and orders to write them.
pub(super) struct Source<'a> {
    sequence: &'a Sequence<'a>,
    /// Ready as soon as a frame is.
    renderer: &'a OnceLock<Renderer<'a>>,
    ways: &'a Ways,
    progress: &'a Progress<'a>,
    writer: SyncSender<Order>,
    frames: Box<dyn Iterator<Item = i32> + Send + 'a>,
    /// Frames that somebody else is at.
    postponed: VecDeque<i32>,
    digests: Digests,
    left_over: LeftOver,
    /// How many pictures were begun.
    begun: u64,
    /// The number of the next picture's first piece.
    first_piece: u64,
}

/// A picture that threads render together.
pub(super) struct InFlight<'a> {
    rendering: Rendering<'a>,
    film: Film<'a>,
    ways: &'a Ways,
    progress: &'a Progress<'a>,
    /// Set by the writer when the rest of the picture is not wanted.
    is_lost: Arc<AtomicBool>,
}

/// What is done about a frame.
enum Turn {
    Render(Option<TemporaryFile>),
    /// Its file is there.
    Skip,
    /// Somebody else is writing its file.
    Wait,
}

/// A frame that is wanted, and the part of its file that is there.
struct Wanted<'a> {
    exposure: Exposure<'a>,
    facts: Facts,
    file: Option<TemporaryFile>,
}

impl<'a> Source<'a> {
    /// Begins before the first frame. Orders go to `writer`.
    pub(super) fn new(
        sequence: &'a Sequence<'a>,
        renderer: &'a OnceLock<Renderer<'a>>,
        ways: &'a Ways,
        progress: &'a Progress<'a>,
        writer: SyncSender<Order>,
    ) -> Self {
        let world = sequence.scene.world();
        Self {
            sequence,
            renderer,
            ways,
            progress,
            writer,
            frames: Box::new(sequence.frames.iter()),
            postponed: VecDeque::new(),
            digests: Digests::new(world, &sequence.settings, sequence.encoding),
            left_over: LeftOver::default(),
            begun: 0,
            first_piece: 0,
        }
    }

    /// The next picture that is to be rendered, after its order; `None` when there are no more, or no
    /// more are wanted.
    pub(super) fn next(&mut self) -> Option<InFlight<'a>> {
        while !self.ways.stop() {
            let next = self.frames.next();
            let is_postponed = next.is_none();
            let frame = next.or_else(|| self.postponed.pop_front())?;
            let path = self.sequence.pattern.path(frame);
            match self.wanted(frame, &path, is_postponed) {
                Ok(Some(wanted)) => return self.begin(wanted, &path),
                Ok(None) => {}
                Err(failure) => {
                    let message = failure.into_message();
                    self.ways.failures.add(frame, &path, message, self.progress);
                    self.progress.leave_out();
                }
            }
        }
        None
    }

    /// What is rendered of a frame, if it is to be rendered now.
    fn wanted(
        &mut self,
        frame: i32,
        path: &Path,
        is_postponed: bool,
    ) -> Result<Option<Wanted<'a>>, Failure> {
        let sequence = self.sequence;
        let view = sequence.scene.view(frame);
        let view = view.map_err(|error| Failure::Work(error.to_string()))?;
        let view = sequence.resized(view);
        let exposure = sequence.scene.exposure(&view);
        let facts = Facts {
            camera: view.camera,
            frame,
            frames_per_second: sequence.frames_per_second,
            method: sequence.settings.method,
            digest: self.digests.of(&Shot {
                exposure: &exposure,
                frame,
                // A PNG does not tell it, and an animated one keeps no digest.
                frames_per_second: match sequence.encoding {
                    Encoding::Png(_) | Encoding::Apng(_) => None,
                    Encoding::Exr(_) => sequence.frames_per_second,
                },
            }),
        };
        place::clean(path, &mut self.left_over);
        let content = (facts.digest, self.ways.form.part);
        match self.turn(path, content, is_postponed)? {
            Turn::Render(file) => {
                return Ok(Some(Wanted {
                    exposure,
                    facts,
                    file,
                }));
            }
            Turn::Skip => {
                self.ways.skipped.fetch_add(1, Ordering::Relaxed);
                self.progress.result(&messages::skipped(path));
                self.progress.leave_out();
            }
            Turn::Wait => self.postponed.push_back(frame),
        }
        Ok(None)
    }

    /// Begins the file of a frame, unless it is there or somebody else writes it.
    ///
    /// Who has waited once begins it all the same: somebody who stands still would else keep
    /// everybody from the end, and both write the same.
    fn turn(&self, path: &Path, content: Content, has_waited: bool) -> Result<Turn, Failure> {
        if let Encoding::Apng(_) = self.sequence.encoding {
            return Ok(Turn::Render(None));
        }
        if !self.sequence.persistence.skip_existing {
            return Ok(Turn::Render(Some(place::begin(path)?)));
        }
        let is_there = || contents::content(path) == Some(content);
        if is_there() {
            return Ok(Turn::Skip);
        }
        let file = match place::claim(path)? {
            None if !has_waited => return Ok(Turn::Wait),
            None => place::begin(path)?,
            Some(file) => file,
        };
        // Somebody may have finished it just before it was ours.
        Ok(if is_there() {
            Turn::Skip
        } else {
            Turn::Render(Some(file))
        })
    }

    /// Orders that a frame be written, and makes it ready to be rendered; `None` when nobody writes any
    /// more.
    fn begin(&mut self, wanted: Wanted<'a>, path: &Path) -> Option<InFlight<'a>> {
        let Wanted {
            exposure,
            facts,
            file,
        } = wanted;
        let (ways, progress) = (self.ways, self.progress);
        let first_piece = self.first_piece;
        self.first_piece += u64::from(ways.coder.pieces());
        let (sender, ending) = channel();
        let is_lost = Arc::new(AtomicBool::new(false));
        let order = Order {
            facts,
            path: path.to_owned(),
            file,
            end: self.first_piece,
            ending,
            is_lost: Arc::clone(&is_lost),
        };
        self.writer.send(order).ok()?;

        let world = self.sequence.scene.world();
        let prepare = || Renderer::new(world);
        let prepare = || progress.while_preparing(world.spheres().len(), prepare);
        let renderer = self.renderer.get_or_init(prepare);
        progress.begin(self.begun, ways.form.pixels());
        self.begun += 1;
        let film = Film::new(&ways.coder, &ways.belt, first_piece, &ways.clock, sender);
        let part = ways.form.part.map(|part| part.window);
        let window = part.unwrap_or(Window::whole(exposure.view()));
        let settings = &self.sequence.settings;
        Some(InFlight {
            rendering: renderer.begin(exposure, window, settings, ways.coder.bands()),
            film,
            ways,
            progress,
            is_lost,
        })
    }
}

impl Shared for InFlight<'_> {
    fn left(&self) -> u32 {
        self.rendering.strips_left()
    }

    fn help(&self) -> ControlFlow<()> {
        let rendered = self.rendering.help(&self.film, &|pixels| {
            self.progress.advance(pixels);
            if self.ways.stop() || self.is_lost.load(Ordering::Acquire) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        // Where the writer wants nothing more of this picture, the next one is rendered.
        if rendered.is_err() && (self.ways.stop() || self.ways.belt.is_closed()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
