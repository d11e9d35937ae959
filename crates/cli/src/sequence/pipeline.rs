//! The state that the rendering threads and the writer thread share.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::Receiver;

use marbles_core::Channels;

use super::clock::Clock;
use super::digest::Input;
use super::outcome::Failures;
use super::reorder_buffer::ReorderBuffer;
use super::request::Request;
use super::strip_encoder::Finished;
use crate::base::failure::Failure;
use crate::base::memory;
use crate::base::region::Region;
use crate::base::size::Size;
use crate::files::temporary::TemporaryFile;
use crate::formats::encoder::Encoder;
use crate::formats::facts::Facts;
use crate::formats::form::Form;
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

/// The memory for strips that are rendered and not yet written, unless two strips need more. It keeps many threads busy
/// with wide pictures, and is enough for whole pictures of common sizes.
const STRIPS_BYTES: u64 = 1 << 27;

/// The number of pictures that wait to be written while another one is. More would not help: in the long run the slower
/// one of rendering and writing determines the speed.
const WAITING_PICTURES: usize = 1;

/// The state that the rendering threads and the writer thread share.
pub(super) struct Pipeline<'a> {
    pub(super) request: &'a Request,
    pub(super) progress: &'a Progress<'a>,
    /// One for each picture of a frame.
    pub(super) encoders: Vec<Encoder>,
    /// The largest number of pictures of a frame that are rendered together.
    pub(super) together: usize,
    pub(super) buffer: ReorderBuffer,
    pub(super) clock: Clock,
    pub(super) failures: Failures,
    /// The number of frames whose files existed.
    pub(super) skipped: AtomicU64,
}

/// A picture that is to be written.
pub(super) struct Order {
    pub(super) facts: Facts,
    /// The number of this picture among the frame's pictures.
    pub(super) part: usize,
    pub(super) path: PathBuf,
    pub(super) input: Input,
    /// The file to write; `None` if all frames go into one file, or into none.
    pub(super) file: Option<TemporaryFile>,
    /// The number of the first piece in the buffer that belongs to the next picture.
    pub(super) end: u64,
    /// The results; nothing is sent if the picture was not finished.
    pub(super) finished: Receiver<Finished>,
}

impl<'a> Pipeline<'a> {
    /// The state before the first frame, if there is enough memory for the strips.
    pub(super) fn new(
        request: &'a Request,
        threads: usize,
        progress: &'a Progress<'a>,
    ) -> Result<Self, Failure> {
        let nothing = || {
            let form = Form {
                region: Region::all(Size {
                    width: 1,
                    height: 1,
                }),
                channels: Channels::Grey,
                alpha: false,
                centers: None,
            };
            vec![form; request.parts.len()]
        };
        let forms = request.forms()?.unwrap_or_else(nothing).into_iter();
        let layers = request.layer_names();
        let encoders = forms.map(|form| Encoder::new(request.encoding, form, &layers));
        let encoders: Vec<Encoder> = encoders.collect();
        let largest = encoders.iter().max_by_key(|encoder| encoder.strip_bytes());
        let mut capacity = largest.map_or(Ok(1), capacity)?;
        let together = largest.map_or(1, |encoder| together(encoder, encoders.len()));
        if together > 1 {
            // Of all of them strips come at a time, and those after them shall not wait.
            let pieces = u64::from(encoders[0].pieces());
            capacity = capacity.max(2 * together as u64 * pieces);
        }
        // Without all of its frames there is no animation.
        let is_fatal = request.fail_fast || request.is_animation() || request.is_in_memory();
        Ok(Self {
            request,
            progress,
            encoders,
            together,
            buffer: ReorderBuffer::new(capacity),
            clock: Clock::new(threads),
            failures: Failures::new(is_fatal),
            skipped: AtomicU64::new(0),
        })
    }

    /// The number of pictures that wait to be written while others are.
    pub(super) fn waiting(&self) -> usize {
        WAITING_PICTURES * self.together
    }

    /// Returns whether all pictures stay in memory, are rendered together, and may wait there until they are complete.
    pub(super) fn holds_all(&self) -> bool {
        let pieces = self
            .encoders
            .iter()
            .map(|encoder| u64::from(encoder.pieces()));
        self.request.is_in_memory()
            && !self.request.scene.has_steps()
            && self.request.pictures() <= self.waiting() as u64
            && self.buffer.holds(pieces.sum())
    }

    /// Returns whether the work should end.
    pub(super) fn stop(&self) -> bool {
        interrupt::requested() || self.failures.stop() || self.request.is_cancelled()
    }

    /// Counts and reports a frame that could not be rendered or written.
    pub(super) fn fail(&self, frame: i32, path: &Path, failure: &Failure) {
        self.failures.add(frame, path, failure, self.progress);
    }
}

/// The number of pictures of a frame that are rendered together, so that visibility is computed once for them. Their
/// strips must fit into the memory twice.
fn together(encoder: &Encoder, parts: usize) -> usize {
    /// Larger numbers save hardly any time, and the files of all these pictures are open.
    const MOST: usize = 12;
    const BYTES: u64 = 1 << 29;
    let picture = encoder.strip_bytes() * u64::from(encoder.pieces());
    let fitting = BYTES / (2 * picture).max(1);
    usize::try_from(fitting)
        .unwrap_or(MOST)
        .min(MOST)
        .clamp(1, parts.max(1))
}

/// The number of strips that may be rendered and not yet written, at least 2. Refuses pictures that are too wide even
/// for two.
fn capacity(encoder: &Encoder) -> Result<u64, Failure> {
    const LEAST: u64 = 2;
    let strip = encoder.strip_bytes();
    let Size { width, height } = encoder.form.region.size();
    let work = format!("rendering and writing a picture of {width} x {height} pixels needs");
    memory::require(strip.saturating_mul(LEAST), &work)?;
    Ok((STRIPS_BYTES / strip.max(1)).max(LEAST))
}

#[cfg(test)]
mod tests;
