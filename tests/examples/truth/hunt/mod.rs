//! A hunt for pixels that break their promise, or claim too little.
//!
//! Each scene is rendered to every tolerance, and held against the same picture of 3 × 3 as many pixels at
//! 1e-6: a cheap filter. The tests' own integrator decides about what disagrees.

mod draft;
mod families;
mod random;
mod reduce;

use std::fmt::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec4;
use marbles_core::{Image, Method, Renderer, Settings, View};
use marbles_scene::Scene;
use marbles_tests::reference::Reference;
use rayon::prelude::*;

use self::draft::{Draft, SIDE};
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
}

impl Options {
    fn parse(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            scenes: 160,
            seed: 1,
            family: String::new(),
            folder: None,
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
                _ => return Err(format!("unknown option {name}")),
            }
        }
        Ok(options)
    }
}

/// Hunts, and reports by families.
pub(crate) fn hunt(arguments: &[&str]) -> Result<String, String> {
    let options = Options::parse(arguments)?;
    let families: Vec<&Family> = FAMILIES
        .iter()
        .filter(|family| family.name.contains(&options.family))
        .collect();
    if families.is_empty() {
        return Err(format!("no family is called {}", options.family));
    }
    let each = options.scenes.div_ceil(families.len() as u64);
    let mut text = String::from(
        "| family | scenes | pixels | 1e-2 | 1e-3 | 1e-4 | 1e-5 | 1e-6 | beyond claim |\n",
    );
    text.push_str("|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    let mut examples = String::new();
    let mut unjudged = 0;
    for family in families {
        let found: Vec<(u64, Draft, Found)> = (0..each)
            .into_par_iter()
            .map(|index| {
                let seed = options.seed.wrapping_mul(1_000_003).wrapping_add(index);
                let draft = (family.draft)(&mut Numbers(seed));
                let found = draft.scene().map(|scene| judge(&scene));
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
    Ok(text + "\n" + &examples)
}

fn render(scene: &Scene, view: &View, tolerance: f64) -> Option<Image> {
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: false,
    };
    let go = |_| ControlFlow::Continue(());
    Renderer::new(scene.world())
        .render(view, &settings, &go)
        .ok()
}

/// The pixels of a scene that fall short, at all tolerances.
fn judge(scene: &Scene) -> Found {
    let mut found = Found::default();
    let Ok(view) = scene.view(1) else {
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
    let reference = Reference::new(scene.world(), &view);
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
                let (error, uncertain) = error_of(scene, &reference, col, row, value);
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

/// How far a pixel's light, with its background, is from the truth, and what that may be off by.
pub(super) fn error_of(
    scene: &Scene,
    reference: &Reference<'_>,
    col: u32,
    row: u32,
    value: DVec4,
) -> (f64, f64) {
    let truth = reference.pixel(col, row);
    let background = scene.world().background * (1.0 - truth.value.w);
    let exact = truth.value.truncate() + background;
    (
        (value.truncate() - exact).abs().max_element(),
        truth.error + 1e-13,
    )
}

/// The error of one pixel of a scene at a tolerance, where it is over it without saying so, or over its
/// claim.
pub(super) fn shortfall(scene: &Scene, broken: &Broken) -> Option<f64> {
    let view = scene.view(1).ok()?;
    let image = render(scene, &view, broken.tolerance)?;
    let reference = Reference::new(scene.world(), &view);
    let value = DVec4::from_array(image.rgba(broken.col, broken.row));
    let (error, uncertain) = error_of(scene, &reference, broken.col, broken.row, value);
    let is_over = image.status(broken.col, broken.row).is_over_tolerance();
    let allowed = if is_over {
        image.error(broken.col, broken.row)
    } else {
        broken.tolerance
    };
    (error > allowed + uncertain).then_some(error)
}
