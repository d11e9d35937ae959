//! The runs: a reference, then every setting in turn, repeatedly.

use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use marbles_core::{Cancelled, Exposure, Image, Method, Renderer, Settings, Summary, Work};

use super::accuracy::{Accuracy, LARGEST_UNKNOWN, is_known, median, places};
use super::progress::Progress;
use crate::base::size::Size;
use crate::terminal::interrupt;

/// The tolerances that are measured.
const TOLERANCES: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
/// The tolerance of a reference.
const REFERENCE_TOLERANCE: f64 = LARGEST_UNKNOWN;
/// The tolerances of better references, which may take too long.
const BETTER_TOLERANCES: [f64; 2] = [1e-8, 1e-9];
/// The largest number of samples per side that is measured in any case: fewer settings would not give a slope.
const FEWEST_SIDES: u32 = 4;
/// The largest number of samples per side at all: the largest power of two that `render` accepts.
const MOST_SIDES: u32 = 512;
/// The fraction of the time that is planned; the rest is for runs that take longer than the first.
const PLANNED: f64 = 0.75;
const TWO: NonZeroU32 = NonZeroU32::new(2).unwrap();

/// The plan of measuring: the picture, and the time.
pub(super) struct Plan<'a> {
    pub(super) renderer: &'a Renderer<'a>,
    pub(super) exposure: &'a Exposure<'a>,
    pub(super) runs: usize,
    /// The time for all runs without the reference, and for each better reference.
    pub(super) seconds: f64,
    pub(super) progress: &'a Progress<'a>,
}

/// The results of measuring.
pub(super) struct Measurement {
    pub(super) reference: Reference,
    /// Tolerances, then samples.
    pub(super) settings: Vec<Setting>,
    /// The number of requested runs.
    pub(super) runs_planned: usize,
}

impl Measurement {
    /// The number of runs of every setting.
    pub(super) fn runs(&self) -> usize {
        self.settings.first().map_or(0, |first| first.times.len())
    }
}

/// The picture with which the others are compared.
pub(super) struct Reference {
    pub(super) tolerance: f64,
    pub(super) image: Image,
    pub(super) time: Duration,
    /// The number of pixels that are accurate enough.
    pub(super) known: u64,
}

/// A way to render, and its results.
#[derive(Clone, Debug)]
pub(super) struct Setting {
    pub(super) method: Method,
    /// The time of each run.
    pub(super) times: Vec<Duration>,
    pub(super) accuracy: Accuracy,
    pub(super) summary: Summary,
    pub(super) work: Work,
}

impl Setting {
    pub(super) fn tolerance(&self) -> Option<f64> {
        tolerance_of(self.method)
    }

    /// The median time.
    pub(super) fn seconds(&self) -> f64 {
        let mut times: Vec<f64> = self.times.iter().map(Duration::as_secs_f64).collect();
        median(&mut times).unwrap_or(0.0)
    }
}

impl Plan<'_> {
    /// Measures everything, on the threads of the current pool.
    pub(super) fn measure(&self) -> Result<Measurement, Cancelled> {
        let reference = self.reference()?;
        let settings = self.settings(&reference)?;
        Ok(Measurement {
            reference,
            settings,
            runs_planned: self.runs,
        })
    }

    /// The picture at the smallest tolerance that fits into the time, as long as smaller tolerances do not make more
    /// pixels unusable.
    fn reference(&self) -> Result<Reference, Cancelled> {
        let mut reference = self.reference_at(REFERENCE_TOLERANCE, None)?;
        for tolerance in BETTER_TOLERANCES {
            match self.reference_at(tolerance, Some(self.seconds)) {
                Ok(better) if better.known >= reference.known => reference = better,
                Err(Cancelled) if interrupt::requested() => return Err(Cancelled),
                Ok(_) | Err(Cancelled) => break,
            }
        }
        Ok(reference)
    }

    /// The picture at a tolerance; cancelled after this many seconds.
    fn reference_at(&self, tolerance: f64, seconds: Option<f64>) -> Result<Reference, Cancelled> {
        let name = format!("reference, tolerance {tolerance:e}");
        let (image, time) = self.render(Method::Tolerance(tolerance), &name, seconds, None)?;
        let known = places(&image).filter(|&pixel| is_known(&image, pixel));
        let known = known.count() as u64;
        Ok(Reference {
            tolerance,
            image,
            time,
            known,
        })
    }

    /// All settings, as often as requested if the time allows it, but at least once.
    fn settings(&self, reference: &Reference) -> Result<Vec<Setting>, Cancelled> {
        let started = Instant::now();
        let mut settings = Vec::new();
        for tolerance in TOLERANCES {
            settings.push(self.first_run(Method::Tolerance(tolerance), reference)?);
        }
        // Half of the time is for samples, whatever the tolerances take.
        let planned = PLANNED * self.seconds;
        let left = planned - self.runs as f64 * seconds_of_a_round(&settings);
        let for_samples = left.max(planned / 2.0);
        settings.extend(self.samples(reference, for_samples)?);

        let round = seconds_of_a_round(&settings);
        let mut last = None;
        for run in 2..=self.runs {
            let spent = started.elapsed().as_secs_f64();
            if spent + round > self.seconds {
                break;
            }
            for setting in &mut settings {
                let name = format!("run {run} of {}, {}", self.runs, name(setting.method));
                let (image, time) = self.render(setting.method, &name, None, last.take())?;
                last = Some(image);
                setting.times.push(time);
            }
            self.progress.run_done(run, self.runs);
        }
        Ok(settings)
    }

    /// The sample counts whose runs all fit into this many seconds, each run once.
    fn samples(&self, reference: &Reference, seconds: f64) -> Result<Vec<Setting>, Cancelled> {
        // Of twice the samples a side: as many moments are averaged where a shutter is open.
        let factor = if self.exposure.poses().is_empty() {
            4.0
        } else {
            8.0
        };
        let mut settings = Vec::new();
        let mut sides = NonZeroU32::MIN;
        loop {
            let setting = self.first_run(Method::Samples(sides), reference)?;
            let next = factor * setting.seconds();
            settings.push(setting);
            let round = next + seconds_of_a_round(&settings);
            let is_affordable = self.runs as f64 * round <= seconds;
            match sides.checked_mul(TWO) {
                Some(more) if more.get() <= FEWEST_SIDES => sides = more,
                Some(more) if more.get() <= MOST_SIDES && is_affordable => sides = more,
                _ => return Ok(settings),
            }
        }
    }

    /// A setting, run once. All runs make the same picture, so only the first picture is evaluated.
    fn first_run(&self, method: Method, reference: &Reference) -> Result<Setting, Cancelled> {
        let name = format!("run 1 of {}, {}", self.runs, name(method));
        let (image, time) = self.render(method, &name, None, None)?;
        self.progress.picture_done(&name, time);
        let tolerance = tolerance_of(method);
        Ok(Setting {
            method,
            times: vec![time],
            accuracy: Accuracy::of(&image, &reference.image, tolerance),
            summary: image.summary(),
            work: image.work(),
        })
    }

    /// A picture, in the memory of another picture, and its rendering time; cancelled after `seconds`, or by the user.
    fn render(
        &self,
        method: Method,
        name: &str,
        seconds: Option<f64>,
        spent: Option<Image>,
    ) -> Result<(Image, Duration), Cancelled> {
        let size = Size::of(self.exposure.view());
        self.progress.begin(name, size.pixels());
        let settings = Settings {
            method,
            alpha: false,
        };
        let started = Instant::now();
        let image = self
            .renderer
            .render_over(spent, self.exposure, &settings, &|pixels| {
                self.progress.advance(pixels);
                let is_late = seconds.is_some_and(|most| started.elapsed().as_secs_f64() > most);
                if is_late || interrupt::requested() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })?;
        Ok((image, started.elapsed()))
    }
}

fn seconds_of_a_round(settings: &[Setting]) -> f64 {
    settings.iter().map(Setting::seconds).sum()
}

impl Reference {
    /// Returns whether all pixels are accurate enough.
    pub(super) fn is_complete(&self) -> bool {
        self.known == self.image.summary().pixels
    }

    /// The root mean square of the claims of known pixels.
    pub(super) fn claimed_rms(&self) -> f64 {
        let known = places(&self.image).filter(|&pixel| is_known(&self.image, pixel));
        let squares = known.map(|(col, row)| {
            let error = self.image.error(col, row);
            error * error
        });
        (squares.sum::<f64>() / self.known.max(1) as f64).sqrt()
    }
}

fn tolerance_of(method: Method) -> Option<f64> {
    match method {
        Method::Tolerance(tolerance) => Some(tolerance),
        Method::Samples(_) => None,
    }
}

/// A setting's name: `tolerance 1e-3`, `8 x 8 samples`.
pub(super) fn name(method: Method) -> String {
    match method {
        Method::Tolerance(tolerance) => format!("tolerance {tolerance:e}"),
        Method::Samples(sides) if sides.get() == 1 => "1 sample".to_owned(),
        Method::Samples(sides) => format!("{sides} x {sides} samples"),
    }
}
