//! A hunt for pixels that break their promise, or claim too little.
//!
//! Each scene is rendered to every tolerance, and held against the same picture of 3 × 3 as many pixels at
//! 1e-6: a cheap filter. The tests' own integrator decides about what disagrees.

mod draft;
mod families;
mod page;
mod random;
mod reduce;
mod scenes;

use std::fmt::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;

use glam::{DVec3, DVec4};
use marbles_core::{Image, Method, Renderer, Settings, View};
use marbles_scene::Scene;
use marbles_tests::reference::Reference;
use rayon::prelude::*;

use self::draft::{Draft, MOMENTS, SIDE};
use self::families::{FAMILIES, Family};
use crate::numbers::Numbers;

const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// The division of pixels that finds suspects, and its tolerance.
const FINER: u32 = 3;
const FINEST: f64 = 1e-6;

/// How many times its tolerance a pixel of the finer picture may seem off before the truth is asked: what
/// both pictures claim is below that.
const SUSPECT: f64 = 0.9;

/// A pixel that fell short.
#[derive(Clone, Copy, Debug)]
pub(super) struct Broken {
    pub(super) col: u32,
    pub(super) row: u32,
    pub(super) tolerance: f64,
    pub(super) error: f64,
    pub(super) claimed: f64,
    /// True if it says that it is over, and is by more than it says.
    pub(super) is_confessed: bool,
}

impl fmt::Display for Broken {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            col,
            row,
            tolerance,
            error,
            claimed,
            is_confessed,
        } = self;
        let says = if *is_confessed {
            "says so, but claims"
        } else {
            "claims"
        };
        write!(
            formatter,
            "column {col}, row {row} at {tolerance:e}: off by {error:.2e}, {says} {claimed:.2e}"
        )
    }
}

/// What a scene came to.
#[derive(Clone, Debug, Default)]
struct Found {
    pixels: u64,
    /// Pixels whose truth is not known well enough to judge a tolerance.
    unjudged: u64,
    broken: Vec<Broken>,
}

/// What is asked of a hunt.
#[derive(Clone, Debug)]
struct Options {
    scenes: u64,
    seed: u64,
    family: String,
    folder: Option<String>,
    page: Option<String>,
}

impl Options {
    fn parse(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            scenes: 160,
            seed: 1,
            family: String::new(),
            folder: None,
            page: None,
        };
        for pair in arguments.chunks(2) {
            let [name, value] = pair else {
                return Err(format!("{} needs a value", pair[0]));
            };
            let number = || {
                value
                    .parse()
                    .map_err(|_| format!("{value} is not a number"))
            };
            match *name {
                "--scenes" => options.scenes = number()?,
                "--seed" => options.seed = number()?,
                "--family" => options.family = (*value).to_owned(),
                "--write" => options.folder = Some((*value).to_owned()),
                "--page" => options.page = Some((*value).to_owned()),
                _ => return Err(format!("unknown option {name}")),
            }
        }
        Ok(options)
    }
}

/// Hunts, and reports by families; an error, with the report, if a pixel is broken.
pub(crate) fn hunt(arguments: &[&str]) -> Result<String, String> {
    let options = Options::parse(arguments)?;
    let families: Vec<&Family> = FAMILIES
        .iter()
        .filter(|family| family.name.contains(&options.family))
        .collect();
    if families.is_empty() {
        return Err(format!("no family is called {}", options.family));
    }
    let shares = families.iter().map(|family| 1.0 / family.rarity as f64);
    let most = (options.scenes as f64 / shares.sum::<f64>()).ceil() as u64;
    let mut text = String::from(
        "| family | scenes | pixels | 1e-2 | 1e-3 | 1e-4 | 1e-5 | 1e-6 | beyond claim |\n",
    );
    text.push_str("|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    let mut examples = String::new();
    let mut unjudged = 0;
    for family in families {
        let each = most.div_ceil(family.rarity);
        let found: Vec<(u64, Draft, Found)> = (0..each)
            .into_par_iter()
            .map(|index| {
                let seed = options.seed.wrapping_mul(1_000_003).wrapping_add(index);
                let draft = (family.draft)(&mut Numbers(seed));
                let found = Subject::of(&draft).map(|subject| judge(&subject));
                (index, draft, found)
            })
            .map(|(index, draft, found)| Ok((index, draft, found?)))
            .collect::<Result<_, String>>()?;
        let pixels: u64 = found.iter().map(|(_, _, found)| found.pixels).sum();
        unjudged += found
            .iter()
            .map(|(_, _, found)| found.unjudged)
            .sum::<u64>();
        // Writing to a string does not fail.
        let _ = write!(text, "| {} | {each} | {pixels} ", family.name);
        for tolerance in TOLERANCES {
            let broken = found.iter().flat_map(|(_, _, found)| &found.broken);
            let broken =
                broken.filter(|broken| !broken.is_confessed && broken.tolerance == tolerance);
            let _ = write!(text, "| {} ", broken.count());
        }
        let broken = found.iter().flat_map(|(_, _, found)| &found.broken);
        let _ = writeln!(
            text,
            "| {} |",
            broken.filter(|broken| broken.is_confessed).count()
        );
        for (index, draft, found) in &found {
            let worst = |broken: &&Broken| broken.error / broken.tolerance;
            let worst = found
                .broken
                .iter()
                .max_by(|a, b| worst(a).total_cmp(&worst(b)));
            let Some(worst) = worst else { continue };
            let _ = writeln!(examples, "{} {index}: {worst}", family.name);
            if let Some(folder) = &options.folder {
                let name = format!("{}-{}-{index}", family.name.replace(' ', "_"), options.seed);
                reduce::write(Path::new(folder), &name, draft, worst)?;
            }
        }
    }
    if unjudged > 0 {
        let _ = writeln!(
            text,
            "\n{unjudged} pixels of fine bumps could not be judged."
        );
    }
    if let Some(page) = &options.page {
        page::write(Path::new(page), &options, &text)?;
    }
    if examples.is_empty() {
        Ok(text)
    } else {
        Err(format!("pixels are broken\n{text}\n{examples}"))
    }
}

/// A scene, and the same with many frames for one, where its shutter is open.
struct Subject {
    scene: Scene,
    moments: Option<Scene>,
}

impl Subject {
    fn of(draft: &Draft) -> Result<Self, String> {
        let scene = draft.scene()?;
        let moments = draft.moments();
        Ok(Self { scene, moments })
    }

    fn view(&self) -> Option<View> {
        let frame = if self.moments.is_some() { 2 } else { 1 };
        self.scene.view(frame).ok()
    }

    /// The light of a pixel with its background, and what that may be off by.
    fn truth(&self, col: u32, row: u32, fine: f64) -> Option<(DVec3, f64)> {
        match &self.moments {
            None => Some(truth(&self.scene, &self.view()?, col, row)),
            Some(moments) => over_time(moments, col, row, fine),
        }
    }
}

fn truth(scene: &Scene, view: &View, col: u32, row: u32) -> (DVec3, f64) {
    let truth = Reference::new(scene.world(), view).pixel(col, row);
    let background = scene.world().background * (1.0 - truth.value.w);
    (truth.value.truncate() + background, truth.error + 1e-13)
}

/// The mean over the midpoints of equal parts of the time, twice as many as long as that changes it by more than
/// a little. Light goes with time without jumps, so that the mean converges with the square of their number:
/// it is said to be off by twice the last change.
fn over_time(moments: &Scene, col: u32, row: u32, fine: f64) -> Option<(DVec3, f64)> {
    const FIRST: i32 = 32;
    const LAST: i32 = 1024;
    let mean = |count: i32| {
        let step = MOMENTS / count;
        let mut sum = (DVec3::ZERO, 0.0);
        for part in 0..count {
            let frame = 2 * MOMENTS - MOMENTS / 2 + part * step + step / 2;
            let view = moments.view(frame).ok()?;
            let (light, error) = truth(moments, &view, col, row);
            sum.0 += light / f64::from(count);
            sum.1 += error / f64::from(count);
        }
        Some(sum)
    };
    let (mut count, mut known) = (FIRST, mean(FIRST)?);
    loop {
        count *= 2;
        let better = mean(count)?;
        let change = (better.0 - known.0).abs().max_element();
        known = better;
        if change < fine || count == LAST {
            return Some((known.0, known.1 + 2.0 * change));
        }
    }
}

fn render(scene: &Scene, view: &View, tolerance: f64) -> Option<Image> {
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: false,
    };
    let go = |_| ControlFlow::Continue(());
    Renderer::new(scene.world())
        .render(scene.exposure(view), &settings, &go)
        .ok()
}

/// The pixels of a scene that fall short, at all tolerances.
fn judge(subject: &Subject) -> Found {
    let mut found = Found::default();
    let scene = &subject.scene;
    let Some(view) = subject.view() else {
        return found;
    };
    if random::is_fine(scene) {
        return random::judge(scene, &view);
    }
    let finer = View {
        width: view.width * FINER,
        height: view.height * FINER,
        ..view
    };
    let Some(finer) = render(scene, &finer, FINEST) else {
        return found;
    };
    for tolerance in TOLERANCES {
        let Some(image) = render(scene, &view, tolerance) else {
            continue;
        };
        for row in 0..SIDE {
            for col in 0..SIDE {
                found.pixels += 1;
                let claimed = image.error(col, row);
                let is_over = image.status(col, row).is_over_tolerance();
                let allowed = if is_over { claimed } else { tolerance };
                let value = DVec4::from_array(image.rgba(col, row));
                let apart = (value - mean(&finer, col, row)).abs().max_element();
                if apart <= SUSPECT * allowed {
                    continue;
                }
                let Some((error, uncertain)) = subject.error_of(col, row, value, allowed) else {
                    continue;
                };
                if error > allowed + uncertain {
                    found.broken.push(Broken {
                        col,
                        row,
                        tolerance,
                        error,
                        claimed,
                        is_confessed: is_over,
                    });
                }
            }
        }
    }
    found
}

/// The mean of a pixel's parts.
fn mean(finer: &Image, col: u32, row: u32) -> DVec4 {
    let mut sum = DVec4::ZERO;
    for part in 0..FINER * FINER {
        let place = (col * FINER + part % FINER, row * FINER + part / FINER);
        sum += DVec4::from_array(finer.rgba(place.0, place.1));
    }
    sum / f64::from(FINER * FINER)
}

impl Subject {
    /// How far a pixel's light is from the truth, and what that may be off by.
    fn error_of(&self, col: u32, row: u32, value: DVec4, allowed: f64) -> Option<(f64, f64)> {
        /// Of what is allowed.
        const FINE: f64 = 0.02;
        let (exact, uncertain) = self.truth(col, row, FINE * allowed)?;
        Some(((value.truncate() - exact).abs().max_element(), uncertain))
    }

    /// The error of one pixel at a tolerance, where it is over it without saying so, or over its claim.
    fn shortfall(&self, broken: &Broken) -> Option<f64> {
        let (col, row) = (broken.col, broken.row);
        let image = render(&self.scene, &self.view()?, broken.tolerance)?;
        let value = DVec4::from_array(image.rgba(col, row));
        let allowed = if image.status(col, row).is_over_tolerance() {
            image.error(col, row)
        } else {
            broken.tolerance
        };
        let (error, uncertain) = self.error_of(col, row, value, allowed)?;
        (error > allowed + uncertain).then_some(error)
    }
}
