//! Frames one after the other: while one is rendered, the one before is encoded and written.

use std::ops::ControlFlow;
use std::panic;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use marbles_core::{Image, Renderer, Settings, View};
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
    /// Whether some pixel of a written frame did not meet the tolerance.
    pub(crate) over_tolerance: bool,
    /// Whether the user ended the work.
    pub(crate) interrupted: bool,
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
        let (left_out, written) = thread::scope(|scope| {
            let writer = scope.spawn(|| self.write_all(receiver, &write_failed, progress));
            let left_out = threads.install(|| self.render_all(sender, &write_failed, progress));
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
            let image = renderer.render(&view, &self.settings, &|pixels| {
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
        write_failed: &AtomicBool,
        progress: &Progress,
    ) -> Tally {
        let mut tally = Tally::default();
        for picture in pictures {
            let frame = picture.facts.frame;
            match self.write(picture, progress) {
                Ok(over_tolerance) => {
                    tally.written += 1;
                    tally.over_tolerance |= over_tolerance;
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

    /// Writes a picture and says so. Whether some pixel did not meet the tolerance.
    fn write(&self, rendered: Rendered, progress: &Progress) -> Result<bool, Failure> {
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
        Ok(summary.over_tolerance > 0)
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
