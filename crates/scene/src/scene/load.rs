//! The way from a scene file to a scene.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::oversights;
use super::own_camera::AsWritten;
use super::refused::refused;
use super::setting::Setting;
use super::source_text::{TextOf, as_ron, text_of, without_byte_order_mark};
use super::{Description, Scene};
use crate::figure::Figure;
use crate::file::{Camera, File, Materials};
use crate::motion::{CameraMotion, Lights, SkyMotion};
use crate::report::SceneError;
use crate::table::Tables;
use crate::text::{Fault, Placed, Read, Slice, collect, optional, set, token};
use crate::values::{MOST_FRAMES, MaterialName};
use crate::world::{self, Cloud, OpenCloud, Part, Progress, Series, Step};

impl Scene {
    /// Reads and checks the scene file at `path`, and the tables that it names; or the scene in the standard input if the path
    /// is [`STANDARD_INPUT`](crate::STANDARD_INPUT), whose tables are in the current folder.
    ///
    /// Tables are read on the threads of the current rayon pool.
    ///
    /// # Errors
    /// Refuses what is not a readable file of at most 1 GiB, and everything that the format and
    /// those of the tables do not allow.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::load_with(path, &[], &|_| {})
    }

    /// Loads as [`Self::load`] does with the values of `settings` in place of the file's own, and calls `watch` each
    /// time that some megabytes of a table were read.
    ///
    /// # Errors
    /// As [`Self::load`]; places in messages are those of the file with the settings. Refuses settings of what the
    /// file does not have.
    pub fn load_with(
        path: &Path,
        settings: &[Setting],
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        Self::load_figure(path, &Figure::default(), settings, watch)
    }

    /// Loads a scene file as [`Self::load_with`] does, with the values that `figure` replaces; or loads the figure of a
    /// table of particles.
    ///
    /// # Errors
    /// As [`Self::load_with`].
    pub fn load_figure(
        path: &Path,
        figure: &Figure,
        settings: &[Setting],
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        let TextOf {
            text,
            path: own_path,
            is_of_table,
        } = text_of(path, figure)?;
        if is_of_table {
            let scene = Self::parse_with(&text, &own_path, settings, watch);
            return scene.map_err(SceneError::of_table_alone);
        }
        let own = figure.settings().into_iter();
        let own = own.map(|(path, value)| Setting::new(path, &value));
        let settings: Vec<Setting> = own.chain(settings.iter().cloned()).collect();
        Self::parse_with(&text, path, &settings, watch)
    }

    /// Checks a scene file's text; `path` is named in messages, and its folder is where tables are.
    ///
    /// A byte order mark at the start is skipped.
    ///
    /// # Errors
    /// Refuses everything that the format does not allow.
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneError> {
        Self::parse_with_tables(text, path, &Tables::default())
    }

    /// Checks a scene file's text as [`Self::parse`] does, with tables in memory in place of files of their names.
    ///
    /// # Errors
    /// Refuses everything that the format and those of the tables do not allow.
    pub fn parse_with_tables(text: &str, path: &Path, tables: &Tables) -> Result<Self, SceneError> {
        let shown = without_byte_order_mark(text);
        let ron = as_ron(shown, path)?;
        Self::parse_watched(&ron, shown, (path, tables), &|_| {})
    }

    /// Checks a scene file's text with the values of `settings` in place of its own.
    fn parse_with(
        text: &str,
        path: &Path,
        settings: &[Setting],
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        let shown = without_byte_order_mark(text);
        let ron = as_ron(shown, path)?;
        let files = Tables::default();
        if settings.is_empty() {
            return Self::parse_watched(&ron, shown, (path, &files), watch);
        }
        let mut text = ron.into_owned();
        for Setting { path: at, value } in settings {
            text = set(&text, at, value).map_err(|message| {
                let message = format!("--set {at}: {message}");
                SceneError::unreadable(path, &message)
            })?;
        }
        Self::parse_watched(&text, &text, (path, &files), watch)
    }

    /// Checks a text in RON; messages show another one, with the same places.
    fn parse_watched(
        text: &str,
        shown: &str,
        (path, tables): (&Path, &Tables),
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Self, SceneError> {
        let (draft, faults) = collect(text, || {
            let start = token::skip_trivia(text, 0);
            let file = File::read(Slice::of_text_being_read(&text[start..]))?;
            Draft::new(&file, text)
        });
        match draft {
            Some(draft) if faults.is_empty() => draft.finish(shown, (path, tables), watch),
            _ => Err(SceneError::refused(path, shown, faults)),
        }
    }
}

/// A scene whose tables are not yet read.
struct Draft {
    scene: Scene,
    clouds: Vec<Cloud>,
    /// The place of the camera in the text.
    camera: Range<usize>,
}

impl Draft {
    /// The scene of a file; `None` where a fault was reported.
    fn new(file: &File, text: &str) -> Option<Self> {
        // Each part is made before any is missed, so that the faults of all are told.
        let world = world::world(file);
        let motion = CameraMotion::new(file, text);
        let lights = Lights::new(file);
        let lens = world::lens(&file.lens, &file.image);
        let image = file.image.value.as_ref()?;
        let (mut world, clouds) = world?;
        let lights = lights?;
        let sky = SkyMotion::new(file, world.sky)?;
        if lights.may_have_color() || sky.as_ref().is_some_and(SkyMotion::may_have_color) {
            world.expect_colored_lights();
        }
        let camera = file.camera.value.as_ref()?;
        let fill = match camera {
            Camera::Frame {
                fill, frame_over, ..
            } => Some((fill.get()?.0, frame_over.get()?)),
            _ => None,
        };
        let lens = lens?;
        let scene = Scene {
            world,
            motion: motion?,
            lights: lights.clone(),
            sky,
            lens,
            width: image.width.get()?.0,
            height: image.height.get()?.0,
            description: Description {
                materials: names(&file.materials)?,
                lights: Vec::new(),
                camera: camera.kind(),
                animation: optional(&file.animation, |animation| Some(animation.kind()))?,
                lens: world::lens_as_written(&file.lens)?,
                unit: optional(&file.unit, |unit| Some(unit.0.clone()))?,
            },
            clouds: Vec::new(),
            warnings: oversights::warnings(file),
            hints: oversights::hints(file),
            series: None,
            framed: Vec::new(),
            as_written: AsWritten { lens, fill, lights },
            own_camera: None,
            tables: Vec::new(),
        };
        Some(Self {
            scene,
            clouds,
            camera: file.camera.place.clone(),
        })
    }

    /// Reads the tables, and places the camera where that depends on the spheres.
    fn finish(
        self,
        text: &str,
        (path, tables): (&Path, &Tables),
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Scene, SceneError> {
        let mut scene = self.scene;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut clouds = Vec::new();
        for cloud in self.clouds {
            let place = cloud.place.clone();
            let open = OpenCloud::new(cloud, folder, tables);
            clouds.push(open.map_err(|error| refused(path, text, (place, error)))?);
        }
        let longest = clouds.iter().filter_map(OpenCloud::frames).max();
        if let Some(frames) = longest {
            if frames > MOST_FRAMES {
                let slow = clouds.iter().find(|cloud| cloud.frames() == longest);
                let place = slow.map(|cloud| cloud.cloud.place.clone());
                let message = format!(
                    "expected steps for at most {MOST_FRAMES} frames, found steps for {frames}: choose a larger \
                     `speed`"
                );
                let fault = Fault::new(place.unwrap_or_default(), message);
                return Err(SceneError::refused(path, text, vec![fault]));
            }
            scene.motion.last(frames);
        }
        let first_frame = scene.frames().map_or(1, |frames| *frames.start());
        let mut parts = Vec::new();
        let mut count = scene.world.spheres().len();
        for mut cloud in clouds {
            let place = cloud.cloud.place.clone();
            let added = scene.add_cloud(&mut cloud, &mut count, (path, text), watch);
            let step = added.map_err(|error| refused(path, text, (place, error)))?;
            let material = cloud.cloud.material;
            let cloud = Arc::new(cloud);
            scene.tables.push(Arc::clone(&cloud));
            let Step {
                spheres, albedos, ..
            } = step;
            if cloud.steps().is_none() && parts.is_empty() {
                scene.world.add_spheres(spheres, material, albedos);
                continue;
            }
            // What pictures have to have room for, though these spheres are not in this world.
            scene.world.expect_spheres(material, albedos.is_some());
            parts.push(match cloud.steps() {
                Some(_) => Part::Changing(cloud),
                None => Part::Still {
                    spheres,
                    albedos,
                    material,
                },
            });
        }
        if !parts.is_empty() {
            let source = (path.to_owned(), text.to_owned());
            let series = Series::new(scene.world.clone(), parts, first_frame, source);
            scene.series = Some(Arc::new(series));
        }
        if let Some((fill, over)) = scene.as_written.fill {
            let is_framed = scene.place_camera(fill, over)?;
            if is_framed.is_none() {
                let place = self.camera.start..token::token_end(text, self.camera.start);
                let message = "expected spheres for a `Frame` camera, found none";
                let fault = Fault::new(place, message);
                return Err(SceneError::refused(path, text, vec![fault]));
            }
        }
        for table in &scene.tables {
            scene.warnings.extend(table.take_warnings());
        }
        scene.choose_references()?;
        scene.description.lights = scene.lights.names();
        scene.world.lights = scene.first_lights();
        scene.world.sky = scene.first_sky();
        Ok(scene)
    }
}

/// The names of materials that were not refused.
fn names(materials: &Materials) -> Option<Vec<String>> {
    let name = |name: &Placed<MaterialName>| Some(name.value.as_ref()?.0.clone());
    materials.0.iter().map(|(key, _)| name(key)).collect()
}
