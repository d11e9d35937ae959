//! The clouds of a scene: what they add to it, and the camera that frames them.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use marbles_core::Lens;

use super::refused::explain;
use super::{CellDescription, CloudDescription, ColorDescription, ColorMeaning, Scene};
use crate::bounds::Bounds;
use crate::file::FrameOver;
use crate::motion::Framed;
use crate::report::{SceneError, in_a_line, locate};
use crate::table;
use crate::text::{Fault, harmless};
use crate::world::{
    CloudError, FIRST_OF_SEVERAL, Learned, OpenCloud, Oversight, Progress, Scale, Step,
};

/// The most frames whose steps are framed one by one.
const MOST_FRAMES: i64 = 100_000;

/// The most warnings about steps read after the first that are told one by one.
const MOST_LATE_WARNINGS: usize = 20;

impl Scene {
    /// Reads the first step of a cloud, behind so many spheres, and describes it.
    pub(super) fn add_cloud(
        &mut self,
        cloud: &mut OpenCloud,
        count: &mut usize,
        (path, text): (&Path, &str),
        watch: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Step, CloudError> {
        if cloud.has_to_learn() {
            cloud.learn()?;
        }
        let step = cloud.read(0, watch)?;
        let file = PathBuf::from(&cloud.cloud.name);
        if step.has_more {
            let name = harmless(&cloud.cloud.name);
            self.warnings.push(format!("{name}: {FIRST_OF_SEVERAL}"));
        }
        let told = cloud.oversights(&step).into_iter();
        let told = told.map(|oversight| told_in_a_line(oversight, path, text));
        self.warnings.extend(told);
        let end = *count + step.spheres.len();
        self.clouds.push(CloudDescription {
            file,
            spheres: *count..end,
            rows: step.rows,
            kept: step.kept,
            cell: step.cell.map(|cell| CellDescription {
                edges: [cell.edges.x_axis, cell.edges.y_axis, cell.edges.z_axis],
                origin: cell.origin,
                lengths: cell.lengths(),
                angles: cell.angles(),
                repeat: cloud.cloud.request.periodic.repeat,
            }),
            is_right_handed: step.is_right_handed,
            steps: cloud.steps(),
            colors: colors(cloud.scale(), &step),
        });
        *count = end;
        Ok(step)
    }

    /// Returns possible oversights in steps read after the first, one line each, that were not handed over yet; of very many
    /// the first, and how many there are.
    pub fn take_late_warnings(&self) -> Vec<String> {
        let Some(series) = &self.series else {
            return Vec::new();
        };
        let (path, text) = &series.source;
        let late = series.changing().flat_map(OpenCloud::take_late_oversights);
        let late = late.map(|oversight| told_in_a_line(oversight, path, text));
        let of_files = series.changing().flat_map(OpenCloud::take_warnings);
        let mut all: Vec<String> = late.chain(of_files).collect();
        if all.len() > MOST_LATE_WARNINGS {
            let more = all.len() - MOST_LATE_WARNINGS;
            all.truncate(MOST_LATE_WARNINGS);
            all.push(format!("{more} more warnings about later steps"));
        }
        all
    }

    /// Places the camera where it has spheres in its picture; `None` where there are none.
    pub(super) fn place_camera(
        &mut self,
        fill: f64,
        over: FrameOver,
    ) -> Result<Option<()>, SceneError> {
        let picture = self.picture(fill);
        let Some(series) = self.series.clone() else {
            let spheres = self.world.spheres();
            let framed = Framed {
                bounds: Bounds::of(spheres),
                largest: &mut |find| find(spheres),
            };
            let scale = self.motion.frame(framed, &picture);
            return Ok(scale.map(|scale| scale_lens(&mut self.lens, scale)));
        };
        let refused = |error| explain(&series, error);
        if over == FrameOver::Series {
            let mut failed = None;
            let framed = Framed {
                bounds: series.bounds().map_err(refused)?,
                largest: &mut |find| {
                    let mut largest: Option<f64> = None;
                    let all = series.for_each(&mut |spheres| {
                        let found = find(spheres);
                        largest = match (largest, found) {
                            (Some(one), Some(other)) => Some(one.max(other)),
                            (one, other) => one.or(other),
                        };
                    });
                    failed = failed.take().or(all.err());
                    largest
                },
            };
            let scale = self.motion.frame(framed, &picture);
            if let Some(failed) = failed {
                return Err(explain(&series, failed));
            }
            return Ok(scale.map(|scale| scale_lens(&mut self.lens, scale)));
        }
        let mut is_framed = None;
        // Frames behind the animation show steps, too, that it may not reach.
        let (first, last) = self.frames().unwrap_or(1..=1).into_inner();
        let longest = series.changing().filter_map(|cloud| cloud.frames()).max();
        let last = last.max(first.saturating_add(longest.unwrap_or(1) - 1));
        let count = i64::from(last) - i64::from(first) + 1;
        if count > MOST_FRAMES {
            let message = format!(
                "expected at most {MOST_FRAMES} frames for `frame_over: Step`, found {count}"
            );
            let place = series
                .changing()
                .next()
                .map(|cloud| cloud.cloud.place.clone());
            let place = place.unwrap_or_default();
            let fault = Fault::new(place.clone(), message);
            return Err(refused((place, CloudError::Scene(fault))));
        }
        let mut known = HashSet::new();
        for frame in first..=last {
            let key = series.key(frame);
            if !known.insert(key.clone()) {
                continue;
            }
            let world = series.world(&key).map_err(refused)?;
            let framed = Framed {
                bounds: Bounds::of(world.spheres()),
                largest: &mut |find| find(world.spheres()),
            };
            let (mut motion, mut lens) = (self.motion.clone(), self.lens);
            // Where nothing is shown, the camera stays where it was.
            match motion.frame(framed, &picture) {
                Some(scale) => {
                    is_framed = Some(());
                    scale_lens(&mut lens, scale);
                }
                None => {
                    if let Some((_, last, last_lens)) = self.framed.last() {
                        (motion, lens) = (last.clone(), *last_lens);
                    }
                }
            }
            self.framed.push((key, motion, lens));
        }
        Ok(is_framed)
    }
}

/// An oversight with its place, in the scene file at `path` or in a table.
fn told_in_a_line(oversight: Oversight, path: &Path, text: &str) -> String {
    match oversight {
        Oversight::Scene(fault) => in_a_line(path, &locate(text, fault)),
        Oversight::Table(table, fault) => in_a_line(&table, &fault),
    }
}

fn scale_lens(lens: &mut Lens, scale: f64) {
    lens.width *= scale;
    lens.shift *= scale;
}

/// The meaning of the colors of a step.
fn colors(scale: &Scale, step: &Step) -> Option<ColorDescription> {
    let Learned {
        low, categories, ..
    } = &step.learned;
    let meaning = if !categories.is_empty() {
        ColorMeaning::Categories(scale.categories(&step.learned))
    } else if low.is_finite() {
        let (low, high) = scale.range(&step.learned);
        ColorMeaning::Scale {
            low,
            high,
            kind: scale.kind,
            colors: scale.colors(),
            are_times: step.has_times,
        }
    } else {
        return None;
    };
    let unit = step.value_name.as_deref().and_then(table::unit);
    Some(ColorDescription {
        column: step.value_name.clone(),
        unit: unit.map(str::to_owned),
        meaning,
    })
}
