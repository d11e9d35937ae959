//! Frames one after the other: while one is rendered, the one before is encoded and written.

mod animation;

use std::ops::ControlFlow;
use std::panic;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use marbles_core::{Renderer, Settings, Summary, View};
use marbles_scene::Scene;
use rayon::ThreadPool;

use crate::args::Size;
use crate::belt::Belt;
use crate::failure::Failure;
use crate::film::{Film, Gathered};
use crate::frames::FrameList;
use crate::interrupt;
use crate::memory::{self, Form};
use crate::messages;
use crate::output::{Coder, Encoding, Facts, Piece, Pieces, Unwritten};
use crate::pattern::Pattern;
use crate::progress::Progress;

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
    pub(crate) settings: Settings,
    pub(crate) pattern: &'a Pattern,
    pub(crate) encoding: Encoding,
}

/// What became of a sequence.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Frames that were asked for.
    pub(crate) frames: u64,
    /// Frames whose files are complete.
    pub(crate) written: u64,
    /// Whether some frame could not be rendered or written.
    pub(crate) failed: bool,
    /// What the written frames together achieved.
    pub(crate) total: Option<Summary>,
    /// What rendering the written frames took.
    pub(crate) time: Duration,
    /// Whether the user ended the work.
    pub(crate) interrupted: bool,
}

impl Tally {
    /// Counts a frame that was written.
    fn add(&mut self, summary: Summary, time: Duration) {
        self.written += 1;
        self.time += time;
        self.total = Some(self.total.map_or(summary, |total| total.and(&summary)));
    }

    /// Whether some pixel of a written frame did not meet the tolerance.
    pub(crate) fn is_over_tolerance(&self) -> bool {
        self.total.is_some_and(|total| total.over_tolerance > 0)
    }
}

/// A picture that is on its way to its file.
struct Order {
    facts: Facts,
    path: PathBuf,
    /// What became of it; nothing where it was not finished.
    ending: Receiver<Ending>,
}

/// A picture all of whose strips were rendered.
struct Ending {
    gathered: Gathered,
    time: Duration,
}

/// What the thread that renders and the one that writes have in common.
struct Ways {
    coder: Coder,
    belt: Belt,
    write_failed: AtomicBool,
}

impl Sequence<'_> {
    /// Renders and writes all frames in order.
    ///
    /// A frame that cannot be rendered is reported and left out; a file that cannot be written
    /// ends the work, as the next would fare no better.
    pub(crate) fn render(&self, threads: &ThreadPool, progress: &Progress) -> Tally {
        let frames = self.frames.count();
        let ways = match self.ways(threads) {
            Ok(ways) => ways,
            Err(failure) => {
                progress.failure(&failure);
                return Tally {
                    frames,
                    failed: true,
                    ..Tally::default()
                };
            }
        };
        let (sender, receiver) = sync_channel(WAITING_PICTURES);
        let (left_out, written) = thread::scope(|scope| {
            let writer = scope.spawn(|| match self.encoding {
                Encoding::Apng(_) => self.write_loop(receiver, &ways, progress),
                Encoding::Png(_) | Encoding::Exr(_) => self.write_all(receiver, &ways, progress),
            });
            let left_out = threads.install(|| self.render_all(sender, &ways, progress));
            let written = writer.join();
            (
                left_out,
                written.unwrap_or_else(|panic| panic::resume_unwind(panic)),
            )
        });
        Tally {
            frames,
            failed: left_out || ways.write_failed.into_inner(),
            interrupted: interrupt::requested() && written.written < frames,
            ..written
        }
    }

    /// Sends pictures to the writer until there are no more, or somebody wants to stop. Whether
    /// some frame was left out.
    fn render_all(&self, writer: SyncSender<Order>, ways: &Ways, progress: &Progress) -> bool {
        let _closing = ways.belt.closing();
        let stop = || interrupt::requested() || ways.write_failed.load(Ordering::Relaxed);
        let world = self.scene.world();
        let prepare = || Renderer::new(world);
        let renderer = progress.while_preparing(world.spheres().len(), prepare);
        let mut left_out = false;
        let mut first_piece = 0;
        for (index, frame) in self.frames.iter().enumerate() {
            if stop() {
                break;
            }
            let view = match self.scene.view(frame) {
                Ok(view) => self.resized(view),
                Err(error) => {
                    progress.failure(&Failure::Work(error.to_string()));
                    progress.leave_out();
                    left_out = true;
                    if let Encoding::Apng(_) = self.encoding {
                        // Without it there is no loop.
                        break;
                    }
                    continue;
                }
            };
            progress.begin(index as u64, u64::from(view.width) * u64::from(view.height));
            let (finish, ending) = channel();
            let order = Order {
                facts: Facts {
                    camera: view.camera,
                    frame,
                    frames_per_second: self.scene.frames_per_second(),
                    method: self.settings.method,
                },
                path: self.pattern.path(frame),
                ending,
            };
            if writer.send(order).is_err() {
                break;
            }
            let film = Film::new(&ways.coder, &ways.belt, first_piece);
            first_piece += u64::from(ways.coder.pieces());
            let started = Instant::now();
            let rendered = renderer.render_strips(&view, &self.settings, &film, &|pixels| {
                progress.advance(pixels);
                if stop() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            if rendered.is_err() {
                break;
            }
            let elapsed = started.elapsed();
            let (gathered, aside) = film.finish(rayon::current_num_threads());
            let time = elapsed.saturating_sub(aside);
            // The writer has gone if it could not write.
            let _ = finish.send(Ending { gathered, time });
        }
        left_out
    }

    /// Writes pictures as they come, until one cannot be written.
    fn write_all(&self, orders: Receiver<Order>, ways: &Ways, progress: &Progress) -> Tally {
        let _closing = ways.belt.closing();
        let mut tally = Tally::default();
        for order in orders {
            let frame = order.facts.frame;
            match self.write(order, ways, progress) {
                Ok((summary, time)) => {
                    tally.add(summary, time);
                    progress.written(frame, tally.written);
                }
                Err(Unwritten::Stopped) => break,
                Err(Unwritten::Failed(failure)) => {
                    ways.write_failed.store(true, Ordering::Relaxed);
                    progress.failure(&failure);
                    break;
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
            ending,
        } = order;
        ways.coder.write(&facts, &path, &mut &ways.belt)?;
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

    /// Makes ready what all frames share, if there is memory for it.
    fn ways(&self, threads: &ThreadPool) -> Result<Ways, Failure> {
        // All frames have the same size.
        let view = self.frames.iter();
        let view = view.filter_map(|frame| self.scene.view(frame).ok()).next();
        let view = view.map(|view| self.resized(view));
        let form = view.map_or(Form::EMPTY, |view| {
            Form::of(&view, self.scene.world(), self.settings.alpha)
        });
        let coder = Coder::new(self.encoding, form);
        let strips = memory::strips_at_a_time(&form, &coder, threads.current_num_threads())?;
        Ok(Ways {
            coder,
            belt: Belt::new(strips),
            write_failed: AtomicBool::new(false),
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

#[cfg(test)]
mod tests {
    use marbles_core::Evidence;

    use super::*;

    #[test]
    fn a_sequence_is_as_good_as_its_worst_frame() {
        let summary = |largest_error, evidence, over_tolerance| Summary {
            pixels: 100,
            largest_error,
            evidence,
            over_tolerance,
        };
        let mut tally = Tally::default();
        assert!(!tally.is_over_tolerance());
        let time = Duration::from_millis(5);
        tally.add(summary(1e-4, Evidence::Bound, 0), time);
        assert_eq!(tally.total, Some(summary(1e-4, Evidence::Bound, 0)));
        assert!(!tally.is_over_tolerance());
        tally.add(summary(3e-4, Evidence::Estimate, 2), time);
        tally.add(summary(2e-4, Evidence::Bound, 1), time);
        let total = Summary {
            pixels: 300,
            ..summary(3e-4, Evidence::Estimate, 3)
        };
        assert_eq!(tally.total, Some(total));
        assert_eq!((tally.written, tally.time), (3, 3 * time));
        assert!(tally.is_over_tolerance());
    }
}
