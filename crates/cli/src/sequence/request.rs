//! The request for a sequence of pictures.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use marbles_core::{Settings, View, Window};
use marbles_scene::Scene;

use super::frames::FrameList;
use super::layers::LightLayer;
use super::parts::PicturePart;
use super::pattern::Pattern;
use crate::base::failure::Failure;
use crate::base::region::{Region, shown};
use crate::base::size::Size;
use crate::formats::center_channels::CenterChannels;
use crate::formats::encoding::Encoding;
use crate::formats::form::Form;

/// The requested pictures, and their files.
pub(crate) struct Request {
    pub(crate) scene: Arc<Scene>,
    /// The scene file.
    pub(crate) scene_path: PathBuf,
    pub(crate) frames: FrameList,
    /// A size instead of the scene's.
    pub(crate) size: Option<Size>,
    /// The requested part of the picture, if it is not the whole.
    pub(crate) window: Option<Window>,
    pub(crate) frames_per_second: Option<f64>,
    pub(crate) settings: Settings,
    /// The factor for errors in the results: the factor on the light of a data set's pictures, else 1.
    pub(crate) error_scale: f64,
    /// The pictures of each frame, at least one.
    pub(crate) parts: Vec<PicturePart>,
    /// The additional layers of each file.
    pub(crate) layers: Vec<LightLayer>,
    pub(crate) pattern: Pattern,
    pub(crate) encoding: Encoding,
    /// The additional channels of the files.
    pub(crate) centers: Option<CenterChannels>,
    /// Whether each picture has a sidecar.
    pub(crate) sidecar: bool,
    /// Whether frames with existing files are skipped.
    pub(crate) skip_existing: bool,
    /// Whether the first failure ends the work.
    pub(crate) fail_fast: bool,
    /// Where the pictures go.
    pub(crate) destination: Destination,
}

/// Where pictures go.
pub(crate) enum Destination {
    /// To their files.
    Files,
    /// To another part of the process, which sets this when it wants no more of them.
    Memory(Arc<AtomicBool>),
}

impl Request {
    /// Refuses a frame without a view, or whose picture does not contain the requested part.
    pub(crate) fn check(&self, frame: i32) -> Result<(), Failure> {
        let view = self.scene.view(frame);
        let view = view.map_err(|error| Failure::unusable(&self.scene_path, &error.to_string()))?;
        self.region(Size::of(&self.resized(view))).map(drop)
    }

    /// Returns whether all frames go into one file.
    pub(crate) fn is_animation(&self) -> bool {
        matches!(self.encoding, Encoding::Animation(..))
    }

    /// Returns whether no files are written.
    pub(super) fn is_in_memory(&self) -> bool {
        matches!(self.destination, Destination::Memory(_))
    }

    /// Returns whether no more pictures are wanted.
    pub(super) fn is_cancelled(&self) -> bool {
        match &self.destination {
            Destination::Files => false,
            Destination::Memory(cancelled) => cancelled.load(Ordering::Relaxed),
        }
    }

    /// The view of a frame, in the requested size.
    pub(crate) fn view(&self, frame: i32) -> Result<View, Failure> {
        let view = self.scene.view(frame);
        let view = view.map_err(|error| Failure::at(&self.scene_path, &error.to_string()))?;
        Ok(self.resized(view))
    }

    fn resized(&self, view: View) -> View {
        self.size.map_or(view, |size| size.resize(view))
    }

    /// The number of pictures.
    pub(crate) fn pictures(&self) -> u64 {
        self.frames.count() * self.parts.len() as u64
    }

    /// The names of the layers.
    pub(super) fn layer_names(&self) -> Vec<String> {
        self.layers.iter().map(|layer| layer.name.clone()).collect()
    }

    /// The file of a picture of a frame.
    pub(crate) fn path(&self, frame: i32, part: usize) -> PathBuf {
        self.parts[part].path(self.pattern.path(frame))
    }

    /// The forms of the pictures of a frame, the same for all frames; `None` if no frame has a view.
    pub(super) fn forms(&self) -> Result<Option<Vec<Form>>, Failure> {
        let views = self.frames.iter();
        let mut views = views.filter_map(|frame| self.scene.view(frame).ok());
        // All frames have the same size.
        let Some(view) = views.next() else {
            return Ok(None);
        };
        let region = self.region(Size::of(&self.resized(view)))?;
        let form = |part: &PicturePart| {
            let centers = self.centers.filter(|_| part.has_centers());
            let world = part.of(self.scene.world());
            Form::new(region, &world, self.settings.alpha, centers)
        };
        Ok(Some(self.parts.iter().map(form).collect()))
    }

    /// The rendered part of a picture of this size.
    fn region(&self, whole: Size) -> Result<Region, Failure> {
        let Some(window) = self.window else {
            return Ok(Region::all(whole));
        };
        Region::new(window, whole).ok_or_else(|| {
            let Size { width, height } = whole;
            let window = shown(&window);
            let message =
                format!("expected a region inside {width} x {height} pixels, found {window}");
            Failure::Usage(message)
        })
    }
}
