//! A picture, and the settings that reach a given error of it.

use std::fmt::Write as _;
use std::num::NonZeroU32;
use std::time::Instant;

use marbles_benches::{Case, Timed, medians, places, render, seconds};
use marbles_core::{Image, Method, Renderer, View};

use super::{GOALS, LISTED};

/// The tolerances to try, the loosest first.
pub(crate) const TOLERANCES: [f64; 18] = [
    5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5,
    1e-5,
];

/// The tolerance of references. Pixels in which a reference claims more are excluded.
const REFERENCE: f64 = 1e-6;

/// The smallest share of a picture that the reference must determine.
const KNOWN: f64 = 0.99;

/// The numbers of samples on a side of a pixel to try.
pub(crate) const SAMPLES: [u32; 18] = [
    1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256,
];

/// The largest time of a run, in seconds. More samples are extrapolated instead.
const LONGEST: f64 = 12.0;

/// The number of last settings that determine the slope for extrapolation.
const SLOPE: usize = 4;

/// The kinds of settings.
const BY_TOLERANCE: usize = 0;

const BY_SAMPLES: usize = 1;

/// The smallest number of runs of each setting of the first table.
const ROUNDS: usize = 3;

/// The time for the runs of a picture for each table, in seconds, unless the smallest number of runs takes longer.
const SECONDS: u64 = 3;

/// A picture that is measured, and its reference.
pub(crate) struct Picture<'scene> {
    name: &'scene str,
    renderer: &'scene Renderer<'scene>,
    view: &'scene View,
    reference: Image,
    /// The runs of each kind so far, in the order of the settings.
    tried: [Vec<Run>; 2],
    /// The worst pixel of each setting with pixels whose error is larger than allowed.
    pub(crate) broken: Vec<String>,
}

/// A setting, run once.
#[derive(Clone, Copy)]
pub(crate) struct Run {
    pub(crate) method: Method,
    seconds: f64,
    rmse: f64,
}

/// The setting that reaches the error, or the best one that was tried.
pub(crate) struct Choice {
    pub(crate) run: Run,
    /// If no setting that was tried reaches the error: the factors on the samples per side and on the time.
    beyond: Option<[f64; 2]>,
}

impl<'scene> Picture<'scene> {
    pub(crate) fn new(
        name: &'scene str,
        renderer: &'scene Renderer<'scene>,
        view: &'scene View,
    ) -> Self {
        let reference = render(renderer, view, Method::Tolerance(REFERENCE), None);
        let known = places(&reference).filter(|&(col, row)| is_known(&reference, col, row));
        let share = known.count() as f64 / f64::from(view.width * view.height);
        assert!(share > KNOWN, "{name}: {share} are known");
        Self {
            name,
            renderer,
            view,
            reference,
            tried: [Vec::new(), Vec::new()],
            broken: Vec::new(),
        }
    }

    /// Adds the row of the first table; returns the ratios.
    pub(crate) fn compare(&mut self, table: &mut String) -> [f64; GOALS.len()] {
        let choices = GOALS.map(|(goal, _)| self.choices(goal));
        let mut methods: Vec<Method> = Vec::new();
        for choice in choices.iter().flatten() {
            if !methods.contains(&choice.run.method) {
                methods.push(choice.run.method);
            }
        }
        let timed = self.timed(ROUNDS, &methods);
        let seconds_of = |choice: &Choice| {
            let at = methods
                .iter()
                .position(|&method| method == choice.run.method);
            let measured = timed[at.expect("it was measured")].median;
            choice
                .beyond
                .map_or(measured, |[_, longer]| longer * measured)
        };
        let _ = write!(table, "| {} |", self.name);
        let rows = choices.iter().zip(GOALS).map(|(choices, (_, largest))| {
            let [tolerance, samples] = choices.each_ref().map(seconds_of);
            let ratio = tolerance / samples;
            let bold = if ratio > largest { "**" } else { "" };
            for (choice, time) in choices.iter().zip([tolerance, samples]) {
                let _ = write!(table, " {} ({}) |", seconds(time), choice.name());
            }
            let _ = write!(table, " {bold}{ratio:.2}{bold} |");
            ratio
        });
        let ratios: Vec<f64> = rows.collect();
        table.push('\n');
        ratios.try_into().expect("one for each goal")
    }

    /// Adds the row of the second table.
    pub(crate) fn list(&mut self, table: &mut String) {
        let methods = LISTED.map(Method::Tolerance);
        let timed = self.timed(1, &methods);
        for (timed, method) in timed.iter().zip(methods) {
            self.judge(&timed.result, method);
        }
        let cells: Vec<_> = timed.iter().map(|timed| seconds(timed.median)).collect();
        // Writing into a string cannot fail.
        let _ = writeln!(table, "| {} | {} |", self.name, cells.join(" | "));
    }

    /// Measures settings, which take turns.
    fn timed(&self, rounds: usize, methods: &[Method]) -> Vec<Timed<Image>> {
        let case = |&method: &Method| Case {
            name: String::new(),
            millions: 0.0,
            run: Box::new(move |spent| render(self.renderer, self.view, method, spent)),
        };
        let cases: Vec<_> = methods.iter().map(case).collect();
        medians(rounds, SECONDS, &cases).1
    }

    /// The loosest tolerance and the smallest number of samples that reach an error.
    pub(crate) fn choices(&mut self, goal: f64) -> [Choice; 2] {
        let tolerances = TOLERANCES.map(Method::Tolerance);
        let samples = SAMPLES.map(by);
        [
            (BY_TOLERANCE, tolerances.as_slice()),
            (BY_SAMPLES, samples.as_slice()),
        ]
        .map(|(kind, methods)| {
            let found = self.first(kind, methods, goal);
            let beyond = found.is_none().then(|| {
                assert_eq!(
                    kind, BY_SAMPLES,
                    "{}: no tolerance reaches {goal:e}",
                    self.name
                );
                extrapolated(&self.tried[kind], goal)
            });
            let last = || *self.tried[kind].last().expect("one was tried");
            let run = found.unwrap_or_else(last);
            Choice { run, beyond }
        })
    }

    /// The first setting whose error is small enough, if it can be found in the allowed time.
    fn first(&mut self, kind: usize, methods: &[Method], goal: f64) -> Option<Run> {
        for (index, &method) in methods.iter().enumerate() {
            if index == self.tried[kind].len() {
                let takes_too_long = self.tried[kind].last().is_some_and(|last| {
                    let more = samples(method) / samples(last.method);
                    last.seconds * more * more > LONGEST
                });
                if takes_too_long && kind == BY_SAMPLES {
                    return None;
                }
                let run = self.run(method);
                self.tried[kind].push(run);
            }
            let run = self.tried[kind][index];
            if run.rmse <= goal {
                return Some(run);
            }
        }
        None
    }

    /// Runs a setting once.
    fn run(&mut self, method: Method) -> Run {
        let start = Instant::now();
        let image = render(self.renderer, self.view, method, None);
        let seconds = start.elapsed().as_secs_f64();
        self.judge(&image, method);
        let rmse = self.rmse(&image);
        Run {
            method,
            seconds,
            rmse,
        }
    }

    /// The root of the mean square error over all channels of all known pixels.
    fn rmse(&self, image: &Image) -> f64 {
        let (mut squares, mut count) = (0.0, 0_u32);
        for (col, row) in places(image) {
            if is_known(&self.reference, col, row) {
                let channels = differences(image, &self.reference, (col, row));
                squares += channels.map(|size| size * size).iter().sum::<f64>();
                count += channels.len() as u32;
            }
        }
        (squares / f64::from(count.max(1))).sqrt()
    }

    /// Records the worst pixel that is over its tolerance without a report, or over its claim.
    fn judge(&mut self, image: &Image, method: Method) {
        let Method::Tolerance(tolerance) = method else {
            return;
        };
        let beyond = |&(col, row): &(u32, u32)| {
            let says_so = image.status(col, row).is_over_tolerance();
            let claimed = image.error(col, row);
            let allowed = if says_so { claimed } else { tolerance };
            let unknown = self.reference.error(col, row);
            let differences = differences(image, &self.reference, (col, row));
            let largest = differences.into_iter().fold(0.0, f64::max);
            (largest > allowed + unknown).then_some(largest / allowed)
        };
        let over: Vec<_> = places(image)
            .filter_map(|place| Some((beyond(&place)?, place)))
            .collect();
        let worst = over
            .iter()
            .max_by(|(one, _), (other, _)| one.total_cmp(other));
        if let Some((times, (col, row))) = worst {
            let line = format!(
                "{} at {tolerance:e}: {} pixels, the worst in column {col}, row {row}: off by \
                 {times:.3} times what it may be",
                self.name,
                over.len()
            );
            if !self.broken.contains(&line) {
                self.broken.push(line);
            }
        }
    }
}

impl Choice {
    /// A short name of the setting.
    fn name(&self) -> String {
        match (self.run.method, self.beyond) {
            (Method::Tolerance(tolerance), _) if tolerance < 0.01 => format!("{tolerance:e}"),
            (Method::Tolerance(tolerance), _) => tolerance.to_string(),
            (Method::Samples(side), None) => format!("{side} × {side}"),
            (Method::Samples(side), Some([more, _])) => {
                let side = (f64::from(side.get()) * more).ceil();
                format!("{side} × {side} \\*")
            }
        }
    }
}

/// The factors on the samples per side and on the time for an error that the last run does not reach, extrapolated
/// along straight lines in log-log plots of the last runs.
fn extrapolated(runs: &[Run], goal: f64) -> [f64; 2] {
    let last = &runs[runs.len().saturating_sub(SLOPE)..];
    let mean = |number: &dyn Fn(&Run) -> f64| {
        last.iter().map(|run| number(run).ln()).sum::<f64>() / last.len() as f64
    };
    let slope = |number: &dyn Fn(&Run) -> f64| {
        let [x, y] = [mean(&|run| run.rmse), mean(number)];
        let sum = |term: &dyn Fn(f64, f64) -> f64| {
            let terms = last
                .iter()
                .map(|run| term(run.rmse.ln() - x, number(run).ln() - y));
            terms.sum::<f64>()
        };
        sum(&|x, y| x * y) / sum(&|x, _| x * x)
    };
    let beyond = goal / last[last.len() - 1].rmse;
    [
        beyond.powf(slope(&|run| samples(run.method))),
        beyond.powf(slope(&|run| run.seconds)),
    ]
}

/// The number of samples on a side of a pixel; `None` for a tolerance.
fn samples(method: Method) -> f64 {
    match method {
        Method::Samples(side) => f64::from(side.get()),
        Method::Tolerance(_) => 0.0,
    }
}

pub(crate) fn by(samples: u32) -> Method {
    Method::Samples(NonZeroU32::new(samples).expect("at least one sample"))
}

fn is_known(reference: &Image, col: u32, row: u32) -> bool {
    reference.error(col, row) <= REFERENCE
}

/// The differences of the channels of a pixel in two pictures. Gray counts three times, which does not change the mean.
fn differences(one: &Image, other: &Image, (col, row): (u32, u32)) -> [f64; 3] {
    let (one, other) = (one.rgba(col, row), other.rgba(col, row));
    [0, 1, 2].map(|channel| (one[channel] - other[channel]).abs())
}
