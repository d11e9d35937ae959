//! Rendering frame by frame, on threads of its own.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

use marbles_scene::Scene;
use rayon::ThreadPool;

use super::error::Error;
use super::options::Options;
use super::picture::Picture;
use super::pool::Pool;
use crate::commands::render::view_warnings;
use crate::sequence::collector::Collected;
use crate::sequence::render::render_in_memory;
use crate::sequence::request::Request;
use crate::terminal::console::Console;
use crate::terminal::progress::Progress;

/// The number of frames that wait to be taken while the next ones are rendered.
const WAITING: usize = 1;

/// The rendering of some frames of a scene, which goes on while finished pictures are taken. At most a few pictures
/// wait to be taken. Dropping it ends the work.
pub struct Rendering {
    /// Closed when the work has ended.
    pictures: Option<Receiver<Result<Picture, Error>>>,
    cancelled: Arc<AtomicBool>,
    warnings: Vec<String>,
    /// The process whose threads do the work.
    process: u32,
}

/// What happened while a picture was waited for.
pub enum Next {
    /// The next frame is complete.
    Picture(Box<Picture>),
    /// The time has passed.
    Waiting,
    /// There are no more frames.
    End,
}

impl Rendering {
    /// Begins to render a scene, the one at `path`.
    ///
    /// # Errors
    /// Refuses options that `marbles render` refuses, and frames without a view.
    pub fn begin(scene: &Arc<Scene>, path: &Path, options: &Options) -> Result<Self, Error> {
        let cancelled = Arc::new(AtomicBool::new(false));
        let request = options.request(scene, path, &cancelled)?;
        let pool = Pool::take(options.threads)?;
        let warnings = view_warnings(&request, &pool);
        let (sender, pictures) = sync_channel(WAITING);
        let shows_progress = options.progress;
        let pool = Arc::new(pool);
        let own = Arc::clone(&pool);
        pool.spawn(move || {
            let work = AssertUnwindSafe(|| run(&request, &own, shows_progress, &sender));
            if catch_unwind(work).is_err() {
                let message = "marbles has a fault: a thread panicked";
                let _ = sender.send(Err(Error::Work(message.to_owned())));
            }
            // They go back before whoever waits for the end goes on.
            drop((request, own));
            drop(sender);
        });
        Ok(Self {
            pictures: Some(pictures),
            cancelled,
            warnings,
            process: process::id(),
        })
    }

    /// The warnings about mistakes in the first frame, such as a camera that sees no sphere.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Waits for the next frame, but no longer than `time`.
    ///
    /// # Errors
    /// If the frame could not be rendered. None follows.
    pub fn next(&mut self, time: Duration) -> Result<Next, Error> {
        let Some(pictures) = &self.pictures else {
            return Ok(Next::End);
        };
        match pictures.recv_timeout(time) {
            Ok(Ok(picture)) => Ok(Next::Picture(Box::new(picture))),
            Ok(Err(error)) => {
                self.stop();
                Err(error)
            }
            Err(RecvTimeoutError::Timeout) => Ok(Next::Waiting),
            Err(RecvTimeoutError::Disconnected) => {
                self.pictures = None;
                Ok(Next::End)
            }
        }
    }

    /// Ends the work, and waits until it has ended: a few milliseconds, or the time that a tile takes. A process that was
    /// forked from the one that began the work leaves it alone.
    pub fn stop(&mut self) {
        if self.process != process::id() {
            // The threads that would close it are the parent's.
            std::mem::forget(self.pictures.take());
            return;
        }
        self.cancelled.store(true, Ordering::Relaxed);
        if let Some(pictures) = self.pictures.take() {
            // Pictures that nobody takes: the end comes behind them.
            while pictures.recv().is_ok() {}
        }
    }
}

impl Drop for Rendering {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Renders all frames, and passes them on.
fn run(
    request: &Request,
    pool: &ThreadPool,
    shows_progress: bool,
    sender: &SyncSender<Result<Picture, Error>>,
) {
    let console = match shows_progress {
        true => Console::of_process(),
        false => Console::to(std::io::sink(), std::io::sink()),
    };
    let progress = Progress::new(&console, None, !shows_progress, request.frames.count());
    let mut of_frame: Vec<Collected> = Vec::new();
    let (scene, path): (Arc<Scene>, PathBuf) =
        (Arc::clone(&request.scene), request.scene_path.clone());
    let parts = request.parts.clone();
    let outcome = render_in_memory(request, pool, &progress, |collected| {
        of_frame.push(collected);
        if of_frame.len() < parts.len() {
            return ControlFlow::Continue(());
        }
        let picture = Picture::of_frame(&scene, &path, &parts, std::mem::take(&mut of_frame));
        match sender.send(picture) {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    });
    progress.finish();
    let failure = match outcome {
        Ok(outcome) => outcome.failure.map(Error::Work),
        Err(failure) => Some(failure.into()),
    };
    if let Some(failure) = failure {
        let _ = sender.send(Err(failure));
    }
}
