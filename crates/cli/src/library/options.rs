//! What to render, and how.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::ValueEnum;
use marbles_core::{Method, Settings, Window, World};
use marbles_scene::Scene;

use super::error::Error;
use crate::base::failure::Failure;
use crate::base::size::{LONGEST_SIDE, Size};
use crate::commands::args::DEFAULT_TOLERANCE;
use crate::commands::scene::require_frames;
use crate::formats::center_channels::{
    AxesForm, CenterChannel, CenterChannels, DepthForm, name_of,
};
use crate::formats::encoding::{Encoding, NpyOptions};
use crate::sequence::frames::FrameList;
use crate::sequence::layers::layer_name;
use crate::sequence::parts::PicturePart;
use crate::sequence::pattern::Pattern;
use crate::sequence::request::{Destination, Request};

/// What to render, and how: the options of `marbles render` with these names.
#[derive(Clone, Debug)]
pub struct Options {
    /// The frames, in order; repetitions are left out. At least one.
    pub frames: Vec<i32>,
    /// The tolerance, or the number of samples.
    pub method: Method,
    /// Whether the background is left out, and alpha stored.
    pub alpha: bool,
    /// The names of groups of channels, such as `depth`.
    pub channels: Vec<String>,
    /// The kind of depth, `axis` or `ray`.
    pub depth: String,
    /// The axes of normals and positions, such as `world`.
    pub axes: String,
    /// Columns and rows of the whole picture, instead of the scene's.
    pub size: Option<(u32, u32)>,
    /// The part of the picture to render, instead of all of it.
    pub region: Option<Window>,
    /// Whether each light is rendered alone as well.
    pub per_light: bool,
    /// The number of threads, instead of one per core.
    pub threads: Option<usize>,
    /// Whether progress is shown on the standard error.
    pub progress: bool,
}

/// The most samples on a side of a pixel, as on the command line.
const MOST_SAMPLES: u32 = 1000;

impl Options {
    /// The request for the pictures of a scene, the last part of each frame that of all light.
    pub(super) fn request(
        &self,
        scene: &Arc<Scene>,
        path: &Path,
        cancelled: &Arc<AtomicBool>,
    ) -> Result<Request, Error> {
        let refused = |message: String| Error::Value(message);
        let tolerance = match self.method {
            Method::Tolerance(tolerance) if tolerance > 0.0 && tolerance.is_finite() => tolerance,
            Method::Tolerance(tolerance) => {
                let message =
                    format!("tolerance: expected a finite number above 0, found {tolerance}");
                return Err(refused(message));
            }
            Method::Samples(samples) if samples.get() <= MOST_SAMPLES => DEFAULT_TOLERANCE,
            Method::Samples(samples) => {
                let message =
                    format!("samples: expected from 1 to {MOST_SAMPLES}, found {samples}");
                return Err(refused(message));
            }
        };
        let mut groups = Vec::new();
        for (index, name) in self.channels.iter().enumerate() {
            groups.push(of_name::<CenterChannel>(
                &format!("channels[{index}]"),
                name,
            )?);
        }
        let (depth, axes) = (
            of_name::<DepthForm>("depth", &self.depth)?,
            of_name::<AxesForm>("axes", &self.axes)?,
        );
        let has_bumps = scene.world().has_bumps();
        let centers = (!groups.is_empty())
            .then(|| CenterChannels::new(&groups, depth, axes, has_bumps, tolerance));
        let size = self.size.map(|(width, height)| Size { width, height });
        if let Some(Size { width, height }) = size
            && ![width, height]
                .iter()
                .all(|side| (1..=LONGEST_SIDE).contains(side))
        {
            let message = format!(
                "size: expected columns and rows, each from 1 to {LONGEST_SIDE}, found {width} and {height}"
            );
            return Err(refused(message));
        }
        let mut parts = Vec::new();
        if self.per_light {
            let names = &scene.description().lights;
            let each = PicturePart::each(scene.world(), names).map_err(refused)?;
            require_own_names(scene.world(), names)?;
            parts.extend(each.into_iter().map(PicturePart::without_centers));
        }
        parts.push(PicturePart::whole());
        let frames = FrameList::of(&self.frames)
            .ok_or_else(|| refused("frames: expected one at least, found none".to_owned()))?;
        require_frames(scene, frames.iter(), "frame")?;
        let request = Request {
            scene: Arc::clone(scene),
            scene_path: path.to_owned(),
            frames,
            size,
            window: self.region,
            frames_per_second: scene.frames_per_second(),
            settings: Settings {
                method: self.method,
                alpha: self.alpha,
            },
            error_scale: 1.0,
            parts,
            layers: Vec::new(),
            pattern: Pattern::named_after(&PathBuf::from("picture"), true),
            encoding: Encoding::Npy(NpyOptions {
                error: true,
                archive: true,
                evidence: true,
            }),
            centers,
            sidecar: false,
            skip_existing: false,
            fail_fast: true,
            destination: Destination::Memory(Arc::clone(cancelled)),
        };
        for frame in request.frames.iter() {
            request
                .check(frame)
                .map_err(|failure| match (self.region, failure) {
                    (Some(_), Failure::Usage(message)) => {
                        Error::Value(format!("region: {message}"))
                    }
                    (_, failure) => failure.into(),
                })?;
        }
        Ok(request)
    }
}

/// The value with this name on the command line.
fn of_name<T: ValueEnum>(path: &str, name: &str) -> Result<T, Error> {
    T::from_str(name, false).map_err(|_| {
        let names: Vec<String> = T::value_variants().iter().map(name_of).collect();
        let names = names.join(", ");
        Error::Value(format!("{path}: expected one of {names}, found {name:?}"))
    })
}

/// Refuses lights whose pictures would have the name of another one, such as `sky`.
fn require_own_names(world: &World, names: &[Option<String>]) -> Result<(), Error> {
    let mut known = HashSet::new();
    for light in world.light_parts() {
        let name = layer_name(light, world.lights.len(), names);
        if known.contains(&name) {
            let message = format!("two lights would share the picture `{name}`");
            return Err(Error::Value(message));
        }
        known.insert(name);
    }
    Ok(())
}
