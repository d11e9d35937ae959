//! Frames one after the other: while one is rendered, the one before is encoded and written.

use std::ops::ControlFlow;
use std::panic;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use marbles_core::{Image, Renderer, Settings, Summary, View};
use marbles_scene::Scene;
use rayon::ThreadPool;

use crate::args::Size;
use crate::failure::Failure;
use crate::frames::FrameList;
use crate::interrupt;
use crate::memory::{self, Form};
use crate::messages;
use crate::output::{self, Encoding, Facts};
use crate::pattern::Pattern;
use crate::progress::Progress;

/// Pictures in memory: one is rendered, one waits, one is written. If more waited, it would only
/// take memory: in the long run the slower of rendering and writing sets the pace.
const MOST_PICTURES: u64 = 3;

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
        self.total = Some(self.total.map_or(summary, |total| both(&total, &summary)));
    }

    /// Whether some pixel of a written frame did not meet the tolerance.
    pub(crate) fn is_over_tolerance(&self) -> bool {
        self.total.is_some_and(|total| total.over_tolerance > 0)
    }
}

/// What is true of two pictures together.
fn both(one: &Summary, other: &Summary) -> Summary {
    Summary {
        pixels: one.pixels + other.pixels,
        largest_error: one.largest_error.max(other.largest_error),
        evidence: one.evidence.min(other.evidence),
        over_tolerance: one.over_tolerance + other.over_tolerance,
    }
}

/// A picture on its way to its file.
struct Rendered {
    image: Image,
    facts: Facts,
    path: PathBuf,
    time: Duration,
}

impl Sequence<'_> {
    /// Renders and writes all frames in order.
    ///
    /// A frame that cannot be rendered is reported and left out; a file that cannot be written
    /// ends the work, as the next would fare no better.
    pub(crate) fn render(&self, threads: &ThreadPool, progress: &Progress) -> Tally {
        let frames = self.frames.count();
        let pictures = match self.pictures_at_a_time() {
            Ok(pictures) => pictures,
            Err(failure) => {
                progress.failure(&failure);
                return Tally {
                    frames,
                    failed: true,
                    ..Tally::default()
                };
            }
        };
        let write_failed = AtomicBool::new(false);
        let waiting = pictures.saturating_sub(2) as usize;
        let (sender, receiver) = sync_channel(waiting);
        // Pictures that are written give their memory back to the renderer.
        let (giver, spent) = channel();
        let (left_out, written) = thread::scope(|scope| {
            let writer = scope.spawn(|| self.write_all(receiver, &giver, &write_failed, progress));
            let to_files = || self.render_all(sender, spent, &write_failed, progress);
            let left_out = threads.install(to_files);
            let written = writer.join();
            (
                left_out,
                written.unwrap_or_else(|panic| panic::resume_unwind(panic)),
            )
        });
        Tally {
            frames,
            failed: left_out || write_failed.into_inner(),
            interrupted: interrupt::requested() && written.written < frames,
            ..written
        }
    }

    /// Sends pictures to the writer until there are no more, or somebody wants to stop. Whether
    /// some frame was left out.
    fn render_all(
        &self,
        writer: SyncSender<Rendered>,
        spent: Receiver<Image>,
        write_failed: &AtomicBool,
        progress: &Progress,
    ) -> bool {
        let stop = || interrupt::requested() || write_failed.load(Ordering::Relaxed);
        let renderer = Renderer::new(self.scene.world());
        let mut left_out = false;
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
                    continue;
                }
            };
            progress.begin(index as u64, u64::from(view.width) * u64::from(view.height));
            let started = Instant::now();
            let spent = spent.try_recv().ok();
            let image = renderer.render_over(spent, &view, &self.settings, &|pixels| {
                progress.advance(pixels);
                if stop() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            let Ok(image) = image else { break };
            let rendered = Rendered {
                image,
                facts: Facts {
                    camera: view.camera,
                    frame,
                    frames_per_second: self.scene.frames_per_second(),
                    method: self.settings.method,
                },
                path: self.pattern.path(frame),
                time: started.elapsed(),
            };
            if writer.send(rendered).is_err() {
                break;
            }
        }
        left_out
    }

    /// Writes pictures as they come, until one cannot be written.
    fn write_all(
        &self,
        pictures: Receiver<Rendered>,
        spent: &Sender<Image>,
        write_failed: &AtomicBool,
        progress: &Progress,
    ) -> Tally {
        let mut tally = Tally::default();
        for picture in pictures {
            let frame = picture.facts.frame;
            match self.write(picture, progress) {
                Ok((image, summary, time)) => {
                    // Nobody takes it after the last frame.
                    let _ = spent.send(image);
                    tally.add(summary, time);
                    progress.written(frame, tally.written);
                }
                Err(failure) => {
                    write_failed.store(true, Ordering::Relaxed);
                    progress.failure(&failure);
                    break;
                }
            }
        }
        tally
    }

    /// Writes a picture and says so. The picture, what it achieved, and in which time.
    fn write(
        &self,
        rendered: Rendered,
        progress: &Progress,
    ) -> Result<(Image, Summary, Duration), Failure> {
        let Rendered {
            image,
            facts,
            path,
            time,
        } = rendered;
        let shown = path.display().to_string();
        let written = output::write(&image, &facts, self.encoding, path)?;
        let summary = image.summary();
        progress.result(&messages::result(&shown, &summary, time));
        if written.clipped > 0 {
            progress.warn(&messages::clipped(&shown, written.clipped, self.encoding));
        }
        if summary.over_tolerance > 0 {
            let message = messages::over_tolerance(&shown, &image, summary.over_tolerance);
            progress.warn(&message);
        }
        Ok((image, summary, time))
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

    /// How many pictures may be in memory at a time: one that is rendered, one that is written, and
    /// as a rule one that waits in between.
    fn pictures_at_a_time(&self) -> Result<u64, Failure> {
        // All frames have the same size.
        let Some(view) = self
            .frames
            .iter()
            .find_map(|frame| self.scene.view(frame).ok())
        else {
            return Ok(1);
        };
        let is_grey = self.scene.world().is_grey();
        let form = Form::of(&self.resized(view), is_grey, self.settings.alpha);
        let (least, most) = match self.frames.count() {
            0..=1 => (1, 1),
            2 => (2, 2),
            _ => (2, MOST_PICTURES),
        };
        memory::pictures_at_a_time(&form, self.encoding, least, most)
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
