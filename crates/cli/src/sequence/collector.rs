//! The collector: pictures stay in memory, and another part of the process takes them in the order of their rendering.

use std::ops::ControlFlow;
use std::sync::mpsc::Receiver;

use marbles_core::Summary;

use super::digest::Input;
use super::outcome::Outcome;
use super::pipeline::{Order, Pipeline};
use super::strip_encoder::Finished;
use crate::base::failure::Failure;
use crate::files::save::{Fault, Unwritten};
use crate::formats::facts::Facts;
use crate::formats::form::Form;
use crate::formats::npy::memory::NamedArray;
use crate::terminal::lines::Frame;

/// A picture in memory.
pub(crate) struct Collected {
    pub(crate) facts: Facts,
    pub(crate) form: Form,
    /// The number of this picture among the frame's pictures.
    pub(crate) part: usize,
    pub(crate) input: Input,
    pub(crate) arrays: Vec<NamedArray>,
    pub(crate) summary: Summary,
}

/// Passes pictures to `take` as they arrive, until it breaks.
pub(super) fn collect(
    orders: Receiver<Order>,
    pipeline: &Pipeline<'_>,
    mut take: impl FnMut(Collected) -> ControlFlow<()>,
) -> Outcome {
    let _closing = pipeline.buffer.closing();
    let mut outcome = Outcome::default();
    for order in orders {
        let (frame, path) = (order.facts.frame, order.path.clone());
        match one(order, pipeline) {
            Ok((picture, finished)) => {
                let summary = picture.summary;
                outcome.add(summary, finished.results.clipped, finished.time);
                let written = Frame {
                    number: frame,
                    path: &path,
                    time: finished.time,
                    summary: &summary,
                };
                pipeline.progress.written(&written, outcome.written, 0);
                if take(picture).is_break() {
                    break;
                }
            }
            Err(Unwritten::Stopped) => break,
            Err(Unwritten::Failed(failure)) => {
                pipeline.fail(frame, &path, &failure);
                break;
            }
        }
    }
    outcome
}

/// The next picture.
fn one(order: Order, pipeline: &Pipeline<'_>) -> Result<(Collected, Finished), Unwritten> {
    let Order {
        facts,
        part,
        input,
        finished,
        ..
    } = order;
    let encoder = &pipeline.encoders[part];
    let finish = || finished.recv().map_err(|_| Unwritten::Stopped);
    // To be woken once takes less time than to be woken for each piece.
    let early = match pipeline.buffer.holds(encoder.pieces().into()) {
        true => Some(finish()?),
        false => None,
    };
    let arrays = encoder.collect(|| pipeline.buffer.take());
    let arrays = arrays.map_err(|fault| match fault {
        Fault::Encoding(message) => Unwritten::Failed(Failure::Work(message)),
        _ => Unwritten::Stopped,
    })?;
    let finished = early.map_or_else(finish, Ok)?;
    let summary = finished.results.summary.ok_or(Unwritten::Stopped)?;
    let picture = Collected {
        facts,
        form: encoder.form,
        part,
        input,
        arrays,
        summary,
    };
    Ok((picture, finished))
}
