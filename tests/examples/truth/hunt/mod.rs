//! A hunt for pixels that break their promise, or claim too little.
//!
//! Each scene is rendered to every tolerance, and held against the same picture of 3 × 3 as many pixels at
//! 1e-6, and against samples: cheap filters. The tests' own integrator decides about what disagrees.

mod draft;
mod families;
mod options;
mod page;
mod parallel;
mod pixels;
mod point_lights;
mod random;
mod reduce;
mod report;
mod sampled;
mod scenes;
mod strokes;
mod subject;

use std::fmt::{self, Write};
use std::path::Path;

use marbles_tests::promise::honesty::Honesty;
use rayon::prelude::*;

use self::draft::Draft;
use self::families::{FAMILIES, Family};
use self::options::Options;
use self::report::Report;
use self::subject::Subject;
use marbles_tests::numbers::Numbers;

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

/// What scenes came to.
#[derive(Clone, Debug)]
struct Found {
    pixels: u64,
    /// Pixels whose truth is not known well enough to judge a tolerance.
    unjudged: u64,
    broken: Vec<Broken>,
    /// Pixels within their tolerance that claim next to nothing of what they are off by.
    false_claims: Vec<Broken>,
    /// For each tolerance, how far pixels are off whose claims are not negligible.
    honesty: Vec<Honesty>,
}

impl Found {
    fn new(tolerances: &[f64]) -> Self {
        Self {
            pixels: 0,
            unjudged: 0,
            broken: Vec::new(),
            false_claims: Vec::new(),
            honesty: vec![Honesty::default(); tolerances.len()],
        }
    }

    fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.unjudged += other.unjudged;
        self.broken.extend(&other.broken);
        self.false_claims.extend(&other.false_claims);
        for (all, honesty) in self.honesty.iter_mut().zip(&other.honesty) {
            all.add(honesty);
        }
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
    let mut report = Report::new(&options.tolerances);
    let mut examples = String::new();
    for family in families {
        let each = most.div_ceil(family.rarity);
        let found = search(family, each, &options)?;
        report.add(family.name, each, found.iter().map(|(_, found)| found));
        for (index, (draft, found)) in found.iter().enumerate() {
            let worst = |broken: &&Broken| broken.error / broken.tolerance;
            let all = found.broken.iter().chain(&found.false_claims);
            let worst = all.max_by(|a, b| worst(a).total_cmp(&worst(b)));
            let Some(worst) = worst else { continue };
            // Writing to a string does not fail.
            let _ = writeln!(examples, "{} {index}: {worst}", family.name);
            if let Some(folder) = &options.folder {
                let name = format!("{}-{}-{index}", family.name.replace(' ', "_"), options.seed);
                reduce::write(Path::new(folder), &name, draft, worst)?;
            }
        }
    }
    let text = report.text();
    if let Some(page) = &options.page {
        page::write(Path::new(page), &options, &text)?;
    }
    if examples.is_empty() {
        Ok(text)
    } else {
        Err(format!("pixels are broken\n{text}\n{examples}"))
    }
}

/// The first scenes of a family, and what was found in each.
fn search(family: &Family, scenes: u64, options: &Options) -> Result<Vec<(Draft, Found)>, String> {
    let judged = |index| {
        let seed = options.seed.wrapping_mul(1_000_003).wrapping_add(index);
        let draft = (family.draft)(&mut Numbers(seed));
        let subject = Subject::of(&draft)?;
        let found = pixels::judge(&subject, &options.tolerances);
        Ok((draft, found))
    };
    (0..scenes).into_par_iter().map(judged).collect()
}
