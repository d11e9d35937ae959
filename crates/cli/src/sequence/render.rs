//! Renders a sequence with rendering threads, a writer thread, and a thread that reads clouds that change over time.

use std::ops::ControlFlow;
use std::panic;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;

use marbles_core::parallel;
use rayon::ThreadPool;

use super::collector::{self, Collected};
use super::outcome::Outcome;
use super::pipeline::{Order, Pipeline};
use super::request::Request;
use super::source::Source;
use super::steps::Steps;
use super::{workers, writer};
use crate::base::failure::Failure;
use crate::base::threads::start_one;
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

/// Renders and writes all frames in order. Frames that another process is rendering come last, unless they are complete
/// by then.
///
/// A frame that cannot be rendered or written is reported and skipped.
pub(crate) fn render(
    request: &Request,
    threads: &ThreadPool,
    progress: &Progress<'_>,
) -> Result<Outcome, Failure> {
    render_to(request, threads, progress, |orders, pipeline| {
        if request.is_animation() {
            writer::write_animation(orders, pipeline)
        } else {
            writer::write_files(orders, pipeline)
        }
    })
}

/// Renders all frames in order, and passes each picture to `take` until that returns that no more are wanted.
pub(crate) fn render_in_memory(
    request: &Request,
    threads: &ThreadPool,
    progress: &Progress<'_>,
    take: impl FnMut(Collected) -> ControlFlow<()> + Send,
) -> Result<Outcome, Failure> {
    render_to(request, threads, progress, |orders, pipeline| {
        collector::collect(orders, pipeline, take)
    })
}

/// Renders all frames in order; `write` writes them on a thread of its own.
fn render_to(
    request: &Request,
    threads: &ThreadPool,
    progress: &Progress<'_>,
    write: impl FnOnce(Receiver<Order>, &Pipeline<'_>) -> Outcome + Send,
) -> Result<Outcome, Failure> {
    let pipeline = Pipeline::new(request, threads.current_num_threads(), progress)?;
    let (sender, receiver) = sync_channel(pipeline.waiting());
    let render = |steps| {
        parallel::install(threads, || {
            let _closing = pipeline.buffer.closing();
            let mut source = Source::new(&pipeline, steps, sender);
            workers::run(|| source.next());
        });
    };
    let written = if pipeline.holds_all() {
        // To start a thread and to wake it takes as long as to render a small picture.
        render(Steps::new(request).0);
        write(receiver, &pipeline)
    } else {
        thread::scope(|scope| -> Result<Outcome, Failure> {
            let (steps, reading) = Steps::new(request);
            if let Some(task) = reading {
                start_one(scope, "reads", || task.run(&request.scene))?;
            }
            // The last that may fail: a writer waits for pictures.
            let writer = start_one(scope, "writes", || write(receiver, &pipeline))?;
            render(steps);
            let written = writer.join();
            Ok(written.unwrap_or_else(|panic| panic::resume_unwind(panic)))
        })?
    };
    let (pictures, skipped) = (request.pictures(), pipeline.skipped.into_inner());
    let (failed, failure) = pipeline.failures.into_frames();
    Ok(Outcome {
        pictures,
        skipped,
        failed,
        failure,
        interrupted: interrupt::requested() && written.written + skipped < pictures,
        ..written
    })
}
