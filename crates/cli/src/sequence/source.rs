//! The source of pictures: which frame comes next, and all that is made ready for it.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{SyncSender, channel};

use blake3::Hash;
use marbles_core::{Exposure, Renderer, Rendering};

use super::digest::{Digests, Shot};
use super::messages;
use super::pipeline::{Order, Pipeline};
use super::strip_encoder::PictureEncoder;
use super::workers::SharedWork;
use crate::base::failure::Failure;
use crate::base::region::Region;
use crate::files::save;
use crate::files::temporary::{LeftOver, TemporaryFile};
use crate::formats::encoding::Encoding;
use crate::formats::facts::Facts;
use crate::formats::{load, sidecar};

/// Gives pictures to render, and orders to write them.
pub(super) struct Source<'a> {
    pipeline: &'a Pipeline<'a>,
    /// Ready as soon as a frame is.
    renderer: &'a OnceLock<Renderer<'a>>,
    writer: SyncSender<Order>,
    frames: Box<dyn Iterator<Item = i32> + Send + 'a>,
    /// Frames that another process is rendering.
    postponed: VecDeque<i32>,
    digests: Digests,
    left_over: LeftOver,
    /// The number of pictures that were begun.
    begun: u64,
}

/// A picture that threads render together.
pub(super) struct InFlight<'a> {
    rendering: Rendering<'a>,
    picture: PictureEncoder<'a>,
    pipeline: &'a Pipeline<'a>,
}

/// The decision about a frame.
enum Decision<'a> {
    Render(Box<Wanted<'a>>),
    /// Its file is there.
    Skip,
    /// Another process is writing its file.
    Wait,
}

/// A frame that is wanted.
struct Wanted<'a> {
    exposure: Exposure<'a>,
    facts: Facts,
    /// The file to write; `None` where all frames are one file.
    file: Option<TemporaryFile>,
}

impl<'a> Source<'a> {
    /// Begins before the first frame. Orders go to `writer`.
    pub(super) fn new(
        pipeline: &'a Pipeline<'a>,
        renderer: &'a OnceLock<Renderer<'a>>,
        writer: SyncSender<Order>,
    ) -> Self {
        let request = pipeline.request;
        let world = request.scene.world();
        Self {
            pipeline,
            renderer,
            writer,
            frames: Box::new(request.frames.iter()),
            postponed: VecDeque::new(),
            digests: Digests::new(
                world,
                &request.settings,
                request.encoding,
                request.centers.as_ref(),
            )
            .with_names(&request.scene.description().lights),
            left_over: LeftOver::default(),
            begun: 0,
        }
    }

    /// The next picture that is to be rendered, after its order; `None` when there are no more, or no
    /// more are wanted.
    pub(super) fn next(&mut self) -> Option<InFlight<'a>> {
        while !self.pipeline.stop() {
            let next = self.frames.next();
            let is_postponed = next.is_none();
            let frame = next.or_else(|| self.postponed.pop_front())?;
            let path = self.pipeline.request.pattern.path(frame);
            match self.decide(frame, &path, is_postponed) {
                Ok(Decision::Render(wanted)) => return self.begin(*wanted, path),
                Ok(Decision::Wait) => self.postponed.push_back(frame),
                Ok(Decision::Skip) => {
                    self.pipeline.skipped.fetch_add(1, Ordering::Relaxed);
                    self.pipeline.progress.result(&messages::skipped(&path));
                    self.pipeline.progress.leave_out();
                }
                Err(failure) => {
                    self.pipeline.fail(frame, &path, &failure);
                    self.pipeline.progress.leave_out();
                }
            }
        }
        None
    }

    /// Begins the file of a frame, unless it is there or another process writes it.
    ///
    /// A process that has waited once begins it all the same: another one that stands still would else
    /// keep all others from the end, and both write the same.
    fn decide(
        &mut self,
        frame: i32,
        path: &Path,
        has_waited: bool,
    ) -> Result<Decision<'a>, Failure> {
        let request = self.pipeline.request;
        let view = request.view(frame)?;
        let exposure = request.scene.exposure(&view);
        let facts = Facts {
            view,
            frame,
            frames_per_second: request.frames_per_second,
            method: request.settings.method,
            digest: self.digests.of(&Shot {
                exposure: &exposure,
                frame,
                // Other files do not tell it, and an animated one keeps no digest.
                frames_per_second: match request.encoding {
                    Encoding::Png(_) | Encoding::Apng(_) | Encoding::Npy(_) => None,
                    Encoding::Exr(_) => request.frames_per_second,
                },
            }),
        };
        let encoder = &self.pipeline.encoder;
        let files = encoder.files(path, &facts.digest);
        let sidecar = request.sidecar.then(|| sidecar::beside(path));
        for path in files.iter().map(|(path, _)| path).chain(&sidecar) {
            save::clean(path, &mut self.left_over);
        }
        let contents = (facts.digest, encoder.form.region);
        let is_there = || is_there(&files, sidecar.as_deref(), contents);
        let file = if request.is_animation() {
            None
        } else if !request.skip_existing {
            Some(save::begin(path)?)
        } else if is_there() {
            return Ok(Decision::Skip);
        } else {
            let file = match save::claim(path)? {
                None if !has_waited => return Ok(Decision::Wait),
                None => save::begin(path)?,
                Some(file) => file,
            };
            // Another process may have finished it just before it was ours.
            if is_there() {
                return Ok(Decision::Skip);
            }
            Some(file)
        };
        Ok(Decision::Render(Box::new(Wanted {
            exposure,
            facts,
            file,
        })))
    }

    /// Orders that a frame be written, and makes it ready to be rendered; `None` when the writer has
    /// ended.
    fn begin(&mut self, wanted: Wanted<'a>, path: PathBuf) -> Option<InFlight<'a>> {
        let Wanted {
            exposure,
            facts,
            file,
        } = wanted;
        let pipeline = self.pipeline;
        let Pipeline {
            request,
            progress,
            encoder,
            buffer,
            clock,
            ..
        } = pipeline;
        let first_piece = self.begun * u64::from(encoder.pieces());
        let (sender, finished) = channel();
        let order = Order {
            facts,
            path,
            file,
            end: first_piece + u64::from(encoder.pieces()),
            finished,
        };
        self.writer.send(order).ok()?;

        let world = request.scene.world();
        let renderer = self.renderer.get_or_init(|| {
            progress.prepare(world.spheres().len());
            Renderer::new(world)
        });
        let region = encoder.form.region;
        progress.begin(self.begun, region.size().pixels());
        self.begun += 1;
        Some(InFlight {
            rendering: renderer.begin_with_geometry(
                exposure,
                region.window,
                &request.settings,
                encoder.bands(),
                encoder.geometry().as_ref(),
            ),
            picture: PictureEncoder::new(encoder, buffer, first_piece, clock, sender),
            pipeline,
        })
    }
}

/// Returns whether the files of a picture are there, with these digests, and its sidecar where it is to have one.
fn is_there(
    files: &[(PathBuf, Hash)],
    sidecar: Option<&Path>,
    (digest, region): (Hash, Region),
) -> bool {
    let mut files = files.iter();
    files.all(|(path, digest)| load::contents(path) == Some((*digest, region)))
        && sidecar.is_none_or(|path| sidecar::contents(path) == Some((digest, region)))
}

impl SharedWork for InFlight<'_> {
    fn left(&self) -> u32 {
        self.rendering.strips_left()
    }

    fn help(&self) -> ControlFlow<()> {
        let stop = || self.pipeline.stop();
        let rendered = self.rendering.help(&self.picture, &|pixels| {
            self.pipeline.progress.advance(pixels);
            if stop() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        // Where the writer wants nothing more of this picture, the next one is rendered.
        if rendered.is_err() && (stop() || self.pipeline.buffer.is_closed()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
