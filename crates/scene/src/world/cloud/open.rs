//! A cloud whose steps are known and can be read.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use glam::DVec3;
use marbles_core::{Albedos, Sphere};

use super::coloring::{Learned, Scale};
use super::explain::{explain, no_steps, without_frames};
use super::observed::Observed;
use super::pattern;
use super::remarked::LateRemarks;
use super::settings::Cloud;
use super::step::Step;
use super::steps::{self, Steps};
use super::{CloudError, Progress};
use crate::bounds::Bounds;
use crate::table::{Frames, Remarks, Rows, TableBytes, TableError, Tables};
use crate::text::{Fault, harmless, quoted};

/// A cloud whose steps are known and can be read.
#[derive(Debug)]
pub(crate) struct OpenCloud {
    pub(crate) cloud: Cloud,
    pub(super) folder: PathBuf,
    /// Tables in memory, which may have this one.
    tables: Tables,
    pub(super) steps: Steps,
    learned: Learned,
    /// Doubts and guesses in all steps, if all were read, and the step that has the first place.
    pub(super) remarks: (Remarks, usize),
    pub(super) late: Mutex<LateRemarks>,
    /// The file of frames, ready for one of them.
    pub(super) open: Mutex<Option<Frames<'static>>>,
    pub(super) observed: Observed,
}

/// The warning about a table with z up whose axes the scene leaves open, and whose format is left-handed.
const MIRRORED: &str = "with `up: Z`, the axes are usually right-handed, and without `right_handed: true` the picture is then \
                        a mirror image; write `right_handed: true`, or `false` if they are left-handed";

/// The warning about a file whose first frame alone is shown.
pub(crate) const FIRST_OF_SEVERAL: &str =
    "the first frame of several is shown (`frames: All` shows them one after another)";

/// Progress that nobody watches.
pub(super) const UNWATCHED: &(dyn Fn(u64, u64) + Sync) = &|_, _| {};

impl OpenCloud {
    /// Finds the steps of a cloud whose table is one of `tables`, or else a file.
    pub(crate) fn new(cloud: Cloud, folder: &Path, tables: &Tables) -> Result<Self, CloudError> {
        let path = folder.join(&cloud.name);
        let mut open = Self {
            cloud,
            folder: folder.to_owned(),
            tables: tables.clone(),
            steps: Steps::One,
            learned: Learned::default(),
            remarks: (Remarks::default(), 0),
            late: Mutex::default(),
            open: Mutex::new(None),
            observed: Observed::default(),
        };
        let numbered = pattern::files(folder, &open.cloud.name);
        let numbered = numbered.map_err(|error| open.refuse_table(&path, error.into()))?;
        if let (Some(_), Some((_, place))) = (&numbered, &open.cloud.time) {
            let message = "expected one file for `time`, found a numbered series, each of whose files is a step";
            return Err(CloudError::Scene(Fault::new(place.clone(), message)));
        }
        if let Some(numbered) = numbered {
            let numbers = numbered.files.iter().map(|file| file.0);
            let chosen = open.choose(numbers.clone());
            let chosen = chosen.map_err(|error| numbered.explain(error))?;
            let file = |place: usize| numbered.files[place].1.clone();
            open.steps = Steps::Files(chosen.into_iter().map(file).collect());
            let in_range: Vec<i64> = open.cloud.timeline.in_range(numbers).collect();
            let name = harmless(&open.cloud.name);
            open.observed.warn(numbered.warnings(&name, &in_range));
            if let Some((path, doubts)) = open.steps.doubts_of_last(open.cloud.skip_lines) {
                open.observed.note_doubts(&open.name_of(&path), doubts);
            }
        } else if let Some((column, _)) = open.cloud.time.clone() {
            let times = open.times(&path, &column);
            let times = times.map_err(|error| open.refuse_table(&path, error))?;
            let chosen = open.choose(1..=times.len() as i64)?;
            let times = chosen.into_iter().map(|place| times[place]).collect();
            open.steps = Steps::Times(column, times);
        } else if open.cloud.takes_all {
            let refused = |error| open.refuse_table(&path, error);
            let mut frames = open.open_file(&path, UNWATCHED).map_err(refused)?;
            if !frames.may_be_several() {
                let name = quoted(&open.cloud.name);
                return Err(open.refused(without_frames(&name, frames.format())));
            }
            open.observed.check(&path, &frames).map_err(refused)?;
            let all = steps::index(&mut frames).map_err(refused)?;
            open.observed.note_others(&mut frames).map_err(refused)?;
            frames.finish().map_err(refused)?;
            open.note_doubts(&path, &mut frames);
            let chosen = open.choose(1..=all.len() as i64)?;
            open.steps = Steps::Frames(chosen.into_iter().map(|place| all[place]).collect());
        }
        Ok(open)
    }

    /// Notes what is in doubt in the file at `path`.
    pub(super) fn note_doubts(&self, path: &Path, frames: &mut Frames<'_>) {
        let doubts = frames.take_doubts();
        self.observed.note_doubts(&self.name_of(path), doubts);
    }

    /// The name of a file in messages.
    pub(super) fn name_of(&self, path: &Path) -> String {
        match self.steps {
            Steps::Files(_) => path.display().to_string(),
            Steps::One | Steps::Frames(_) | Steps::Times(..) => self.cloud.name.clone(),
        }
    }

    /// Takes the warnings of everything left out or in doubt, as far as it is known.
    pub(crate) fn take_warnings(&self) -> Vec<String> {
        self.observed.take_warnings()
    }

    /// The steps of the cloud's timeline.
    fn choose(
        &self,
        numbers: impl DoubleEndedIterator<Item = i64> + Clone,
    ) -> Result<Vec<usize>, CloudError> {
        let chosen = self.cloud.timeline.choose(numbers.clone());
        if !chosen.is_empty() {
            return Ok(chosen);
        }
        let ends = numbers.clone().next().zip(numbers.clone().next_back());
        let range = self.cloud.timeline.range.as_ref();
        Err(self.refused(no_steps(&quoted(&self.cloud.name), range, ends)))
    }

    /// The number of steps; `None` of a cloud that does not change.
    pub(crate) fn steps(&self) -> Option<usize> {
        match &self.steps {
            Steps::One => None,
            Steps::Files(files) => Some(files.len()),
            Steps::Frames(places) => Some(places.len()),
            Steps::Times(_, times) => Some(times.len()),
        }
    }

    /// The files of all steps, and those that are read besides them.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let mut files = match &self.steps {
            Steps::Files(files) => files.clone(),
            _ if self.in_memory().is_some() => Vec::new(),
            Steps::One | Steps::Frames(_) | Steps::Times(..) => vec![self.path(0)],
        };
        files.extend(self.observed.others());
        files
    }

    /// The table, if it is in memory.
    pub(super) fn in_memory(&self) -> Option<TableBytes> {
        self.tables.get(&self.cloud.name)
    }

    /// The way from numbers to colors.
    pub(crate) fn scale(&self) -> &Scale {
        &self.cloud.scale
    }

    /// The number of frames in which all steps are shown once.
    pub(crate) fn frames(&self) -> Option<i32> {
        Some(self.cloud.timeline.frames(self.steps()?))
    }

    /// The step that is shown so many frames behind the first one; `None` for nothing.
    pub(crate) fn step_at(&self, frames: i64) -> Option<usize> {
        match self.steps() {
            None => Some(0),
            Some(count) => self.cloud.timeline.at(frames, count),
        }
    }

    /// True where something has to be learned of all steps before one can be shown as one of them.
    pub(crate) fn has_to_learn(&self) -> bool {
        let Cloud {
            request,
            scale,
            placement,
            ..
        } = &self.cloud;
        let is_colored =
            request.value.is_some() || request.coloring.is_some() || !request.palette.is_empty();
        let has_own_radii = !request.own_radii.is_empty();
        self.steps().is_some()
            && (placement.is_centered || has_own_radii || is_colored && scale.has_open_range())
    }

    /// Reads all steps for what has to be the same in all of them.
    pub(crate) fn learn(&mut self) -> Result<(), CloudError> {
        let mut bounds = Bounds::NONE;
        let mut learned = Learned::default();
        let mut remarks = (Remarks::new(self.cloud.request.own_radii.len()), 0);
        for step in 0..self.steps().unwrap_or(1) {
            let (rows, _) = self.rows(step, UNWATCHED)?;
            if !remarks.0.has_place() {
                remarks.1 = step;
            }
            remarks.0.append(rows.remarks);
            self.cloud.scale.learn(&rows.paint, &mut learned);
            bounds = bounds.around(Bounds::of(&rows.spheres));
        }
        self.learned = learned;
        self.remarks = remarks;
        self.cloud.placement.middle = Some(bounds.middle().unwrap_or(DVec3::ZERO));
        Ok(())
    }

    /// Reads a step; of a cloud that does not change there is step 0.
    pub(crate) fn read(
        &self,
        step: usize,
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Step, CloudError> {
        let table = self.path(step);
        let table = match self.steps {
            Steps::Files(_) => table.as_path(),
            _ => Path::new(&self.cloud.name),
        };
        let watch = |read, size| watch(Progress { table, read, size });
        let (rows, has_more) = self.rows(step, &watch)?;
        let Rows {
            mut spheres,
            paint,
            read: rows,
            value_name,
            is_right_handed,
            remarks,
            has_times,
            kept,
            cell,
            ..
        } = rows;
        let kept = kept.unwrap_or(spheres.len() as u64);
        let is_right_handed = self.place(&mut spheres, is_right_handed)?;
        self.note(step, &remarks);
        let mut learned = self.learned.clone();
        if !self.has_to_learn() {
            self.cloud.scale.learn(&paint, &mut learned);
        }
        let albedos = self.albedos(paint, &learned);
        Ok(Step {
            spheres,
            albedos: albedos.map_err(|message| self.refused(message))?,
            rows,
            value_name,
            learned,
            has_more,
            is_right_handed,
            remarks,
            has_times,
            kept,
            cell: cell.and_then(Result::ok),
        })
    }

    /// The spheres of a step alone.
    pub(crate) fn spheres(&self, step: usize) -> Result<Vec<Sphere>, CloudError> {
        let (rows, _) = self.rows(step, UNWATCHED)?;
        let mut spheres = rows.spheres;
        self.place(&mut spheres, rows.is_right_handed)?;
        Ok(spheres)
    }

    /// Puts spheres to their place in the world; returns whether the axes of the table are right-handed, which its
    /// format says unless the scene does.
    fn place(&self, spheres: &mut [Sphere], by_format: bool) -> Result<bool, CloudError> {
        let placement = &self.cloud.placement;
        if placement.may_be_mirrored(by_format) {
            let name = harmless(&self.cloud.name);
            self.observed.warn([format!("{name}: {MIRRORED}")]);
        }
        let is_right_handed = placement.is_right_handed(by_format);
        if placement.place(spheres, is_right_handed) {
            return Ok(is_right_handed);
        }
        let message = "expected finite spheres with radii greater than 0 after `scale`, \
                       `rotate_degrees` and `position`, found others";
        Err(self.refused(message.to_owned()))
    }

    fn albedos(
        &self,
        paint: crate::table::Paint,
        learned: &Learned,
    ) -> Result<Option<Albedos>, String> {
        let missing = self.cloud.request.missing;
        self.cloud.scale.albedos(paint, missing, learned)
    }

    /// The file of a step.
    pub(super) fn path(&self, step: usize) -> PathBuf {
        match &self.steps {
            Steps::Files(files) => files[step].clone(),
            Steps::One | Steps::Frames(_) | Steps::Times(..) => self.folder.join(&self.cloud.name),
        }
    }

    fn refused(&self, message: String) -> CloudError {
        CloudError::Scene(Fault::new(self.cloud.place.clone(), message))
    }

    pub(super) fn refuse_table(&self, path: &Path, error: TableError) -> CloudError {
        let (name, path, error) = match error {
            TableError::InOther(other, error) => (other.name, other.path, *error),
            error => (self.name_of(path), path.to_owned(), error),
        };
        match error {
            TableError::Fault(fault) => CloudError::Table(path, fault),
            error => {
                let message = explain(&name, &path, &error);
                let topology = self.cloud.topology.as_ref();
                let topology = topology.filter(|(other, _)| *other == name).or_else(|| {
                    let concerns_it = matches!(
                        error,
                        TableError::InTopology(_) | TableError::NoTrajectory(_)
                    );
                    topology.filter(|_| concerns_it)
                });
                let place = match (&error, topology) {
                    (_, Some((_, place))) => place,
                    (TableError::NoCell(_) | TableError::InScene(_), None) => {
                        &self.cloud.periodic_place
                    }
                    _ => &self.cloud.place,
                };
                let fault = Fault::new(place.clone(), message);
                match error {
                    TableError::Changed => CloudError::Changed(fault),
                    _ => CloudError::Scene(fault),
                }
            }
        }
    }
}
