//! The source of pictures: chooses the next frame, and prepares everything for it.

use std::collections::VecDeque;
use std::iter::Peekable;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{SyncSender, channel};

use blake3::Hash;
use marbles_core::{Exposure, Renderer, Rendering, Sink};
use self_cell::self_cell;

use super::digest;
use super::messages;
use super::pipeline::{Order, Pipeline};
use super::steps::{Step, Steps};
use super::strip_encoder::{LayerEncoder, OpenStrip, PictureEncoder};
use super::workers::SharedWork;
use crate::base::failure::Failure;
use crate::base::region::Region;
use crate::files::save;
use crate::files::temporary::{LeftOver, TemporaryFile};
use crate::formats::encoding::Encoding;
use crate::formats::facts::Facts;
use crate::formats::{load, sidecar};

/// Prepares pictures for rendering, and orders their writing.
pub(super) struct Source<'a> {
    pipeline: &'a Pipeline<'a>,
    steps: Steps<'a>,
    writer: SyncSender<Order>,
    shots: Peekable<Box<dyn Iterator<Item = Shot> + Send + 'a>>,
    /// Pictures that another process is rendering.
    postponed: VecDeque<Shot>,
    left_over: LeftOver,
    /// The number of pictures that have been started.
    begun: u64,
}

/// A picture to be rendered.
#[derive(Clone, Copy, Debug)]
struct Shot {
    frame: i32,
    /// The number of this picture among the frame's pictures.
    part: usize,
}

/// Pictures of a frame that threads render together.
pub(super) struct InFlight<'a> {
    rendering: RenderingOfStep<'a>,
    pictures: Vec<PictureEncoder<'a>>,
    pipeline: &'a Pipeline<'a>,
}

/// A world and the exposure of a frame.
struct Seen<'a> {
    step: Arc<Step>,
    exposure: Exposure<'a>,
}

self_cell!(
    struct RenderingOfStep<'a> {
        owner: Seen<'a>,
        #[not_covariant]
        dependent: Rendering,
    }
);

/// The decision about a picture.
enum Decision {
    Render(Box<Wanted>),
    /// Its file exists.
    Skip,
    /// Another process is writing its file.
    Wait,
}

/// A picture that is needed.
struct Wanted {
    step: Arc<Step>,
    facts: Facts,
    part: usize,
    path: PathBuf,
    /// The file to write; `None` if all frames go into one file, or into none.
    file: Option<TemporaryFile>,
}

impl<'a> Source<'a> {
    /// The source before the first frame. Orders are sent to `writer`.
    pub(super) fn new(
        pipeline: &'a Pipeline<'a>,
        steps: Steps<'a>,
        writer: SyncSender<Order>,
    ) -> Self {
        let request = pipeline.request;
        let parts = request.parts.len();
        let shots = request
            .frames
            .iter()
            .flat_map(move |frame| (0..parts).map(move |part| Shot { frame, part }));
        let shots: Box<dyn Iterator<Item = Shot> + Send + 'a> = Box::new(shots);
        Self {
            pipeline,
            steps,
            writer,
            shots: shots.peekable(),
            postponed: VecDeque::new(),
            left_over: LeftOver::default(),
            begun: 0,
        }
    }

    /// The next pictures that are rendered together, after their orders are sent. `None` if there are no more, or the
    /// work should end.
    pub(super) fn next(&mut self) -> Option<InFlight<'a>> {
        let mut wanted: Vec<Wanted> = Vec::new();
        let mut most = 1;
        while !self.pipeline.stop() && wanted.len() < most {
            let of_frame = wanted.first().map(|wanted| wanted.facts.frame);
            let Some((shot, has_waited)) = self.next_shot(of_frame) else {
                break;
            };
            let path = self.pipeline.request.path(shot.frame, shot.part);
            match self.decide(shot, &path, has_waited) {
                Ok(Decision::Render(picture)) => {
                    wanted.push(*picture);
                    most = self.together(shot.frame);
                }
                Ok(Decision::Wait) => self.postponed.push_back(shot),
                Ok(Decision::Skip) => {
                    self.pipeline.skipped.fetch_add(1, Ordering::Relaxed);
                    self.pipeline.progress.result(&messages::skipped(&path));
                    self.pipeline.progress.leave_out();
                }
                Err(failure) => {
                    self.pipeline.fail(shot.frame, &path, &failure);
                    self.pipeline.progress.leave_out();
                }
            }
        }
        match wanted.is_empty() || self.pipeline.stop() {
            true => None,
            false => self.begin(wanted),
        }
    }

    /// The next picture, of this frame if one is given, and whether it was postponed.
    fn next_shot(&mut self, of_frame: Option<i32>) -> Option<(Shot, bool)> {
        let is_of_frame = |shot: &Shot| of_frame.is_none_or(|frame| shot.frame == frame);
        if self.shots.peek().is_some() {
            return Some((self.shots.next_if(is_of_frame)?, false));
        }
        let is_next = self.postponed.front().is_some_and(is_of_frame);
        Some((self.postponed.pop_front().filter(|_| is_next)?, true))
    }

    /// The number of pictures of a frame that are rendered together. With a moving camera they are rendered one by one,
    /// because each keeps a lot of data about what is visible.
    fn together(&self, frame: i32) -> usize {
        let Pipeline {
            request, together, ..
        } = self.pipeline;
        if *together == 1 {
            return 1;
        }
        let view = request.view(frame).ok();
        let moves = view.is_some_and(|view| !request.scene.exposure(&view).poses().is_empty());
        if moves { 1 } else { *together }
    }

    /// Begins the file of a picture, unless it exists or another process is writing it.
    ///
    /// A picture for which the process has already waited once is begun anyway: otherwise a stopped process would block
    /// all others, and both write the same bytes.
    fn decide(
        &mut self,
        Shot { frame, part }: Shot,
        path: &Path,
        has_waited: bool,
    ) -> Result<Decision, Failure> {
        let request = self.pipeline.request;
        let view = request.view(frame)?;
        let step = self.steps.of(frame)?;
        let exposure = request.scene.exposure(&view);
        let facts = Facts {
            view,
            frame,
            frames_per_second: request.frames_per_second,
            method: request.settings.method,
            digest: step.digests[part].of(&digest::Shot {
                exposure: &exposure,
                frame,
                // Other files do not tell it, and an animated one keeps no digest.
                frames_per_second: match request.encoding {
                    Encoding::Exr(_) => request.frames_per_second,
                    _ => None,
                },
            }),
        };
        let encoder = &self.pipeline.encoders[part];
        let files = encoder.files(path, &facts.digest);
        let sidecar = request.sidecar.then(|| sidecar::beside(path));
        if !request.is_in_memory() {
            for path in files.iter().map(|(path, _)| path).chain(&sidecar) {
                save::clean(path, &mut self.left_over);
            }
        }
        let contents = (facts.digest, encoder.form.region);
        let is_there = || is_there(&files, sidecar.as_deref(), contents);
        let may_be_there =
            request.skip_existing && !request.is_animation() && !request.is_in_memory();
        if may_be_there && is_there() {
            return Ok(Decision::Skip);
        }
        step.require_memory()?;
        let file = if request.is_animation() || request.is_in_memory() {
            None
        } else if !request.skip_existing {
            Some(save::begin(path)?)
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
            step,
            facts,
            part,
            path: path.to_owned(),
            file,
        })))
    }

    /// Orders the writing of pictures of a frame, and prepares them for rendering. `None` if the writer has ended.
    fn begin(&mut self, wanted: Vec<Wanted>) -> Option<InFlight<'a>> {
        let pipeline = self.pipeline;
        let Pipeline {
            request, progress, ..
        } = pipeline;
        let parts: Vec<usize> = wanted.iter().map(|picture| picture.part).collect();
        let (first, last) = (*parts.first()?, *parts.last()?);
        let seen = Seen {
            step: Arc::clone(&wanted[0].step),
            exposure: request.scene.exposure(&wanted[0].facts.view),
        };
        let encoder = &pipeline.encoders[first];
        let region = encoder.form.region;
        let mut pictures = Vec::new();
        for picture in wanted {
            pictures.push(self.order(picture)?);
            progress.begin(self.begun, region.size().pixels() * encoder.layers() as u64);
            self.begun += 1;
        }
        Some(InFlight {
            rendering: RenderingOfStep::new(seen, |Seen { step, exposure }| {
                let begin = || progress.prepare(step.spheres());
                step.with_renderers(request, begin, |renderers| {
                    // Where there are layers, the frame has one picture, and they come after it.
                    let own = parts.iter().map(|&part| &renderers[part]);
                    let own = own.chain(&renderers[request.parts.len()..]);
                    let renderers: Vec<&Renderer<'_>> = own.collect();
                    Rendering::of_each(
                        &renderers,
                        exposure.clone(),
                        region.window,
                        &request.settings,
                        encoder.rows(),
                        // The part that has them is the last.
                        pipeline.encoders[last].geometry().as_ref(),
                    )
                })
            }),
            pictures,
            pipeline,
        })
    }

    /// Orders the writing of a picture; returns the encoder of its strips.
    fn order(&self, wanted: Wanted) -> Option<PictureEncoder<'a>> {
        let Pipeline {
            encoders,
            buffer,
            clock,
            ..
        } = self.pipeline;
        let Wanted {
            step,
            facts,
            part,
            path,
            file,
        } = wanted;
        let encoder = &encoders[part];
        let first_piece = self.begun * u64::from(encoder.pieces());
        let (sender, finished) = channel();
        let order = Order {
            facts,
            part,
            path,
            input: step.inputs[part].clone(),
            file,
            end: first_piece + u64::from(encoder.pieces()),
            finished,
        };
        self.writer.send(order).ok()?;
        Some(PictureEncoder::new(
            encoder,
            buffer,
            first_piece,
            clock,
            sender,
        ))
    }
}

/// Returns whether the files of a picture exist with these digests, and its sidecar if it needs one.
fn is_there(
    files: &[(PathBuf, Hash)],
    sidecar: Option<&Path>,
    (digest, region): (Hash, Region),
) -> bool {
    let mut files = files.iter();
    files.all(|(path, digest)| load::contents(path) == Ok((*digest, region)))
        && sidecar.is_none_or(|path| sidecar::contents(path) == Some((digest, region)))
}

impl SharedWork for InFlight<'_> {
    fn left(&self) -> u32 {
        self.rendering
            .with_dependent(|_, rendering| rendering.strips_left())
    }

    fn help(&self) -> ControlFlow<()> {
        let stop = || self.pipeline.stop();
        let open: Vec<OpenStrip<'_>> = self.pictures.iter().map(|_| OpenStrip::default()).collect();
        let pictures = self.pictures.iter().zip(&open);
        let layers = pictures.flat_map(|(picture, open)| picture.layers(open));
        let layers: Vec<LayerEncoder<'_, '_>> = layers.collect();
        let sinks: Vec<&dyn Sink> = layers.iter().map(|layer| layer as &dyn Sink).collect();
        let progress = |pixels| {
            self.pipeline.progress.advance(pixels);
            if stop() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let rendered = self
            .rendering
            .with_dependent(|_, rendering| rendering.help_each(&sinks, &progress));
        // Where the writer wants nothing more of these pictures, the next ones are rendered.
        if rendered.is_err() && (stop() || self.pipeline.buffer.is_closed()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
