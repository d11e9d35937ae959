//! Frames one after the other: while one is rendered, the one before is encoded and written.

mod animation;

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::panic;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use marbles_core::{Renderer, Settings, Summary, View, Window};
use marbles_scene::Scene;
use rayon::ThreadPool;

use crate::args::Size;
use crate::belt::Belt;
use crate::digest::{Digests, Shot};
use crate::failure::Failure;
use crate::film::{Film, Gathered};
use crate::frames::FrameList;
use crate::input::finished::{self, Content};
use crate::interrupt;
use crate::memory::{self, Form};
use crate::messages;
use crate::output::temporary::{LeftOver, TemporaryFile};
use crate::output::{self, Coder, Encoding, Facts, Piece, Pieces, Unwritten};
use crate::pattern::Pattern;
use crate::progress::Progress;
use crate::region::{self, Region};
use crate::tally::{Failures, Tally};

/// Pictures that wait to be written while another one is. If more waited, it would not help: in the
/// long run the slower of rendering and writing sets the pace.
const WAITING_PICTURES: usize = 1;

/// What is rendered, and where it goes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sequence<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) frames: &'a FrameList,
    /// In place of the scene's.
    pub(crate) size: Option<Size>,
    /// The part of the picture that is wanted, if not all of it.
    pub(crate) window: Option<Window>,
    pub(crate) frames_per_second: Option<f64>,
    pub(crate) settings: Settings,
    pub(crate) pattern: &'a Pattern,
    pub(crate) encoding: Encoding,
    pub(crate) persistence: Persistence,
}

/// What is done about files that are there, and about frames that fail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Persistence {
    /// Whether frames are left out whose files are there.
    pub(crate) skip_existing: bool,
    /// Whether the first failure ends the work.
    pub(crate) fail_fast: bool,
}

/// A picture that is on its way to its file.
struct Order {
    facts: Facts,
    path: PathBuf,
    /// None where all frames are one file.
    file: Option<TemporaryFile>,
    /// The number of the first piece on the belt that belongs to the next picture.
    end: u64,
    /// What became of it; nothing where it was not finished.
    ending: Receiver<Ending>,
    /// Set by the writer when the rest of the picture is not wanted.
    is_lost: Arc<AtomicBool>,
}

/// A picture all of whose strips were rendered.
struct Ending {
    gathered: Gathered,
    time: Duration,
}

/// What the thread that renders and the one that writes have in common.
struct Ways {
    form: Form,
    coder: Coder,
    belt: Belt,
    failures: Failures,
    /// Frames whose files were there.
    skipped: AtomicU64,
}

/// What is done about a frame.
enum Turn {
    Render(Option<TemporaryFile>),
    /// Its file is there.
    Skip,
    /// Somebody else is writing its file.
    Wait,
}

impl Sequence<'_> {
    /// Renders and writes all frames in order, but for those that somebody else is at: they come
    /// last, if they are not there then.
    ///
    /// A frame that cannot be rendered or written is reported and left out.
    pub(crate) fn render(
        &self,
        threads: &ThreadPool,
        progress: &Progress,
    ) -> Result<Tally, Failure> {
        let frames = self.frames.count();
        let ways = self.ways(threads)?;
        let (sender, receiver) = sync_channel(WAITING_PICTURES);
        let written = thread::scope(|scope| {
            let writer = scope.spawn(|| match self.encoding {
                Encoding::Apng(_) => self.write_loop(receiver, &ways, progress),
                Encoding::Png(_) | Encoding::Exr(_) => self.write_all(receiver, &ways, progress),
            });
            threads.install(|| self.render_all(sender, &ways, progress));
            let written = writer.join();
            written.unwrap_or_else(|panic| panic::resume_unwind(panic))
        });
        let skipped = ways.skipped.into_inner();
        Ok(Tally {
            frames,
            skipped,
            failed: ways.failures.into_frames(),
            interrupted: interrupt::requested() && written.written + skipped < frames,
            ..written
        })
    }

    /// Sends pictures to the writer until there are no more, or somebody wants to stop.
    fn render_all(&self, writer: SyncSender<Order>, ways: &Ways, progress: &Progress) {
        let _closing = ways.belt.closing();
        let stop = || interrupt::requested() || ways.failures.stop();
        let world = self.scene.world();
        let mut renderer = None;
        let digests = Digests::new(world, &self.settings, self.encoding);
        let mut left_over = LeftOver::default();
        let mut first_piece = 0;
        let mut frames = self.frames.iter();
        let mut postponed = VecDeque::new();
        let mut index = 0;
        while !stop() {
            let next = frames.next();
            let is_postponed = next.is_none();
            let Some(frame) = next.or_else(|| postponed.pop_front()) else {
                break;
            };
            let path = self.pattern.path(frame);
            let failed = |message| {
                ways.failures.add(frame, &path, message, progress);
                progress.leave_out();
            };
            let view = match self.scene.view(frame) {
                Ok(view) => self.resized(view),
                Err(error) => {
                    failed(error.to_string());
                    continue;
                }
            };
            let exposure = self.scene.exposure(&view);
            let facts = Facts {
                camera: view.camera,
                frame,
                frames_per_second: self.frames_per_second,
                method: self.settings.method,
                digest: digests.of(&Shot {
                    exposure: &exposure,
                    frame,
                    // A PNG does not tell it, and an animated one keeps no digest.
                    frames_per_second: match self.encoding {
                        Encoding::Png(_) | Encoding::Apng(_) => None,
                        Encoding::Exr(_) => self.frames_per_second,
                    },
                }),
            };
            output::clean(&path, &mut left_over);
            let file = match self.turn(&path, (facts.digest, ways.form.part), is_postponed) {
                Ok(Turn::Render(file)) => file,
                Ok(Turn::Skip) => {
                    ways.skipped.fetch_add(1, Ordering::Relaxed);
                    progress.result(&messages::skipped(&path));
                    progress.leave_out();
                    continue;
                }
                Ok(Turn::Wait) => {
                    postponed.push_back(frame);
                    continue;
                }
                Err(failure) => {
                    failed(failure.into_message());
                    continue;
                }
            };
            let prepare = || Renderer::new(world);
            let prepare = || progress.while_preparing(world.spheres().len(), prepare);
            let renderer = renderer.get_or_insert_with(prepare);
            let Form { width, height, .. } = ways.form;
            progress.begin(index, u64::from(width) * u64::from(height));
            index += 1;
            let film = Film::new(&ways.coder, &ways.belt, first_piece);
            first_piece += u64::from(ways.coder.pieces());
            let (finish, ending) = channel();
            let is_lost = Arc::new(AtomicBool::new(false));
            let order = Order {
                facts,
                path,
                file,
                end: first_piece,
                ending,
                is_lost: Arc::clone(&is_lost),
            };
            if writer.send(order).is_err() {
                break;
            }
            let started = Instant::now();
            let part = ways.form.part.map(|part| part.window);
            let window = part.unwrap_or(Window::whole(&view));
            let settings = &self.settings;
            let rendered = renderer.render_strips(&exposure, window, settings, &film, &|pixels| {
                progress.advance(pixels);
                if stop() || is_lost.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            if rendered.is_err() {
                if stop() || !is_lost.load(Ordering::Relaxed) {
                    break;
                }
                // The writer wants nothing more of this picture, and nothing of others is on its way.
                ways.belt.resume(first_piece);
                continue;
            }
            let elapsed = started.elapsed();
            let (gathered, aside) = film.finish(rayon::current_num_threads());
            let time = elapsed.saturating_sub(aside);
            // The writer has gone on if it could not write.
            let _ = finish.send(Ending { gathered, time });
        }
    }

    /// Begins the file of a frame, unless it is there or somebody else writes it.
    ///
    /// Who has waited once begins it all the same: somebody who stands still would else keep
    /// everybody from the end, and both write the same.
    fn turn(&self, path: &Path, content: Content, has_waited: bool) -> Result<Turn, Failure> {
        if let Encoding::Apng(_) = self.encoding {
            return Ok(Turn::Render(None));
        }
        if !self.persistence.skip_existing {
            return Ok(Turn::Render(Some(output::begin(path)?)));
        }
        let is_there = || finished::content(path) == Some(content);
        if is_there() {
            return Ok(Turn::Skip);
        }
        let file = match output::claim(path)? {
            None if !has_waited => return Ok(Turn::Wait),
            None => output::begin(path)?,
            Some(file) => file,
        };
        // Somebody may have finished it just before it was ours.
        Ok(if is_there() {
            Turn::Skip
        } else {
            Turn::Render(Some(file))
        })
    }

    /// Writes pictures as they come.
    fn write_all(&self, orders: Receiver<Order>, ways: &Ways, progress: &Progress) -> Tally {
        let _closing = ways.belt.closing();
        let mut tally = Tally::default();
        for order in orders {
            let (frame, end) = (order.facts.frame, order.end);
            let (path, is_lost) = (order.path.clone(), Arc::clone(&order.is_lost));
            match self.write(order, ways, progress) {
                Ok((summary, time)) => {
                    tally.add(summary, time);
                    let skipped = ways.skipped.load(Ordering::Relaxed);
                    progress.written(frame, tally.written, skipped);
                }
                Err(Unwritten::Stopped) => break,
                Err(Unwritten::Failed(failure)) => {
                    let message = failure.into_message();
                    ways.failures.add(frame, &path, message, progress);
                    if ways.failures.stop() {
                        // Neither are those wanted that were rendered meanwhile.
                        break;
                    }
                    is_lost.store(true, Ordering::Relaxed);
                    ways.belt.discard_until(end);
                }
            }
        }
        tally
    }

    /// Writes a picture and says so; what it achieved, and in which time.
    fn write(
        &self,
        order: Order,
        ways: &Ways,
        progress: &Progress,
    ) -> Result<(Summary, Duration), Unwritten> {
        let Order {
            facts,
            path,
            file,
            ending,
            ..
        } = order;
        let file = file.ok_or(Unwritten::Stopped)?;
        ways.coder.write(&facts, &path, file, &mut &ways.belt)?;
        let Ending { gathered, time } = ending.recv().map_err(|_| Unwritten::Stopped)?;
        let summary = gathered.summary.ok_or(Unwritten::Stopped)?;
        let shown = path.display().to_string();
        progress.result(&messages::result(&shown, &summary, time));
        if gathered.clipped > 0 {
            progress.warn(&messages::clipped(&shown, gathered.clipped, self.encoding));
        }
        if summary.over_tolerance > 0 {
            let count = summary.over_tolerance;
            progress.warn(&messages::over_tolerance(&shown, count, gathered.worst));
        }
        Ok((summary, time))
    }

    /// Whether the frame has a view, and what is wanted of it lies inside.
    pub(crate) fn check(&self, frame: i32) -> Result<(), Failure> {
        let view = self.scene.view(frame);
        let view = view.map_err(|error| Failure::Frames(error.to_string()))?;
        self.region(&self.resized(view)).map(drop)
    }

    fn resized(&self, view: View) -> View {
        match self.size {
            Some(Size { width, height }) => View {
                width,
                height,
                ..view
            },
            None => view,
        }
    }

    /// What is rendered of a picture.
    fn region(&self, view: &View) -> Result<Region, Failure> {
        let (width, height) = (view.width, view.height);
        let whole = Size { width, height };
        let Some(window) = self.window else {
            return Ok(Region::all(whole));
        };
        Region::new(window, whole).ok_or_else(|| {
            let window = region::shown(&window);
            let message =
                format!("expected a region inside {width} x {height} pixels, found {window}");
            Failure::Usage(message)
        })
    }

    /// Makes ready what all frames share, if there is memory for it.
    fn ways(&self, threads: &ThreadPool) -> Result<Ways, Failure> {
        // All frames have the same size.
        let view = self.frames.iter();
        let view = view.filter_map(|frame| self.scene.view(frame).ok()).next();
        let view = view.map(|view| self.resized(view));
        let form = match view {
            None => Form::EMPTY,
            Some(view) => {
                let form = Form::of(&view, self.scene.world(), self.settings.alpha);
                form.cut(self.region(&view)?)
            }
        };
        let coder = Coder::new(self.encoding, form);
        let strips = memory::strips_at_a_time(&form, &coder, threads.current_num_threads())?;
        // Without all of its frames there is no loop.
        let is_loop = matches!(self.encoding, Encoding::Apng(_));
        Ok(Ways {
            form,
            coder,
            belt: Belt::new(strips),
            failures: Failures::new(self.persistence.fail_fast || is_loop),
            skipped: AtomicU64::new(0),
        })
    }
}

impl Pieces for &Belt {
    fn next(&mut self) -> Option<Piece> {
        self.take()
    }

    fn give_back(&mut self, samples: Vec<u8>) {
        Belt::give_back(self, samples);
    }
}
