//! The writer thread: pictures become files in the order of their rendering.

use std::cell::Cell;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::sync::mpsc::Receiver;
use std::time::Duration;

use marbles_core::Summary;

use super::messages;
use super::outcome::Outcome;
use super::pipeline::{Order, Pipeline};
use super::strip_encoder::Finished;
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::files::save::{Fault, Unwritten, write_bytes};
use crate::formats::facts::Facts;
use crate::formats::sidecar::{self, Sidecar};
use crate::terminal::lines::Frame;

/// Writes pictures as they arrive, each to its file.
pub(super) fn write_files(orders: Receiver<Order>, pipeline: &Pipeline<'_>) -> Outcome {
    let _closing = pipeline.buffer.closing();
    let mut outcome = Outcome::default();
    for order in orders {
        let (frame, path, end) = (order.facts.frame, order.path.clone(), order.end);
        match write_file(order, pipeline) {
            Ok((summary, clipped, time)) => {
                outcome.add(summary, clipped, time);
                let skipped = pipeline.skipped.load(Ordering::Relaxed);
                let written = Frame {
                    number: frame,
                    path: &path,
                    time,
                    summary: &summary,
                };
                let progress = &pipeline.progress;
                progress.written(&written, outcome.written, skipped);
            }
            Err(Unwritten::Stopped) => break,
            Err(Unwritten::Failed(failure)) => {
                pipeline.fail(frame, &path, &failure);
                if pipeline.failures.stop() {
                    // Neither are those wanted that were rendered meanwhile.
                    break;
                }
                pipeline.buffer.skip_to(end);
            }
        }
    }
    outcome
}

/// Writes a picture and reports it; returns its results, the number of pixels that are too bright for a PNG, and the
/// time.
fn write_file(
    order: Order,
    pipeline: &Pipeline<'_>,
) -> Result<(Summary, u64, Duration), Unwritten> {
    let Order {
        facts,
        part,
        path,
        file,
        finished,
        ..
    } = order;
    let Pipeline {
        request,
        progress,
        encoders,
        buffer,
        ..
    } = pipeline;
    let encoder = &encoders[part];
    let file = file.ok_or(Unwritten::Stopped)?;
    let end: Cell<Option<Finished>> = Cell::new(None);
    let summary = || {
        if end.get().is_none() {
            end.set(finished.recv().ok());
        }
        end.get().and_then(|end| end.results.summary)
    };
    let complete = || {
        let summary = summary().ok_or(Fault::Stopped)?;
        if request.sidecar {
            // Where the picture is there, its sidecar is.
            write_sidecar(&facts, part, &path, &summary, pipeline).map_err(Fault::Failed)?;
        }
        Ok(())
    };
    encoder.write(&facts, &path, file, || buffer.take(), summary, complete)?;
    let Finished { results, time } = end.into_inner().ok_or(Unwritten::Stopped)?;
    let summary = results.summary.ok_or(Unwritten::Stopped)?;
    let summary = Summary {
        largest_error: summary.largest_error * request.error_scale,
        ..summary
    };
    let shown = path.shown();
    let (clipped, too_large) = match request.encoding.has_white() {
        true => (results.clipped, 0),
        false => (0, results.clipped),
    };
    progress.result(&messages::result(&shown, &summary, clipped, time));
    if too_large > 0 {
        progress.warn(&messages::clipped(&shown, too_large, request.encoding));
    }
    if summary.over_tolerance > 0 {
        let count = summary.over_tolerance;
        let worst = results.worst.map(|worst| worst.scaled(request.error_scale));
        progress.warn(&messages::over_tolerance(&shown, count, worst));
    }
    Ok((summary, clipped, time))
}

/// Writes the sidecar of the picture at `path`.
fn write_sidecar(
    facts: &Facts,
    part: usize,
    path: &Path,
    summary: &Summary,
    pipeline: &Pipeline<'_>,
) -> Result<(), Failure> {
    let Pipeline {
        request, encoders, ..
    } = pipeline;
    let view = request.view(facts.frame)?;
    let mut sidecar = Sidecar::of(&request.scene, &request.scene_path, facts.frame, &view);
    if let Some(light) = request.parts[part].light {
        sidecar = sidecar.under(light);
    }
    let region = &encoders[part].form.region;
    let sidecar = sidecar.with_results(region, facts.method, summary, &facts.digest);
    let path = sidecar::beside(path);
    let text = sidecar.text().map_err(|error| Failure::at(&path, &error))?;
    write_bytes(text.as_bytes(), &path)
}

/// Writes pictures as they arrive, all to one file. Unless all of them arrive there is no file, and no picture counts
/// as written.
pub(super) fn write_animation(orders: Receiver<Order>, pipeline: &Pipeline<'_>) -> Outcome {
    let Pipeline {
        request,
        progress,
        encoders,
        buffer,
        ..
    } = pipeline;
    // Its frames have one picture each.
    let encoder = &encoders[0];
    let _closing = buffer.closing();
    let mut outcome = Outcome::default();
    let path = request.pattern.path(request.frames.first());
    let shown = path.shown();
    // There are fewer, or the list of frames would have been refused.
    let frames = u32::try_from(request.frames.count()).unwrap_or(u32::MAX);
    let mut warnings = Vec::new();
    let take = || buffer.take();
    let rate = request.frames_per_second;
    let written = encoder.write_animation(&path, frames, rate, take, || {
        let order = orders.recv().ok()?;
        let frame = order.facts.frame;
        let Finished { results, time } = order.finished.recv().ok()?;
        let summary = results.summary?;
        outcome.add(summary, results.clipped, time);
        let written = Frame {
            number: frame,
            path: &path,
            time,
            summary: &summary,
        };
        progress.written(&written, outcome.written, 0);
        if summary.over_tolerance > 0 {
            let shown = format!("{shown}: frame {frame}");
            let count = summary.over_tolerance;
            warnings.push(messages::over_tolerance(&shown, count, results.worst));
        }
        Some(())
    });
    match (written, &outcome.total) {
        (Ok(()), Some(total)) => {
            let line = messages::result(&shown, total, outcome.clipped, outcome.time);
            progress.result(&line);
            for warning in warnings {
                progress.warn(&warning);
            }
            return outcome;
        }
        (Err(Unwritten::Failed(failure)), _) => {
            // Whichever was being written, all are lost.
            for frame in request.frames.iter() {
                pipeline.fail(frame, &path, &failure);
            }
        }
        (Err(Unwritten::Stopped), _) | (Ok(()), None) => {}
    }
    Outcome::default()
}
