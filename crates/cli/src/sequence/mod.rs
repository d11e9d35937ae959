//! Frames one after the other: while one is rendered, the one before is encoded and written, and the
//! next one begins as soon as threads have nothing else to do.

mod animation;
pub(crate) mod digest;
pub(crate) mod frames;
pub(crate) mod messages;
pub(crate) mod outcome;
pub(crate) mod pattern;
pub(crate) mod reorder_buffer;
mod source;
pub(crate) mod strip_encoder;
mod workers;

use std::panic;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

use marbles_core::{Settings, Summary, View, Window};
use marbles_scene::Scene;
use rayon::ThreadPool;

use self::source::Source;
use crate::base::failure::Failure;
use crate::base::memory::{self, Form};
use crate::base::region::{self, Region};
use crate::commands::args::Size;
use crate::files::temporary::TemporaryFile;
use crate::formats::{Coder, Encoding, Facts, Piece, Pieces, Unwritten};
use crate::sequence::frames::FrameList;
use crate::sequence::outcome::{Failures, Tally};
use crate::sequence::pattern::Pattern;
use crate::sequence::reorder_buffer::Belt;
use crate::sequence::strip_encoder::{Clock, Ending};
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

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

/// What the threads that render and the one that writes have in common.
struct Ways {
    form: Form,
    coder: Coder,
    belt: Belt,
    clock: Clock,
    failures: Failures,
    /// Frames whose files were there.
    skipped: AtomicU64,
}

impl Ways {
    /// Whether nothing more is wanted.
    fn stop(&self) -> bool {
        interrupt::requested() || self.failures.stop()
    }
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
        let renderer = OnceLock::new();
        let mut source = Source::new(self, &renderer, ways, progress, writer);
        workers::run(|| source.next());
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
                    // In this order: who gives up a piece may not be missed.
                    ways.belt.skip_to(end);
                    is_lost.store(true, Ordering::Release);
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
            clock: Clock::new(threads.current_num_threads()),
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
