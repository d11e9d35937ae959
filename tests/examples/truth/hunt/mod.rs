//! A hunt for pixels that break the promise, or claim too little.
//!
//! Each scene is rendered at every tolerance, and compared with a picture of 3 × 3 as many pixels at 1e-6, and with
//! samples. These are cheap filters: if they disagree, the tests' own integrator decides. Each scene is rendered again
//! with a radius an ulp larger. Pixels over their tolerance are counted.

mod colors;
mod draft;
mod extremes;
mod families;
mod laws;
mod leds;
mod limits;
mod options;
mod outlines;
#[path = "../../../../benches/src/page.rs"]
#[expect(unreachable_pub, reason = "it belongs to the benchmarks' library")]
mod page;
mod parallel;
mod picture;
mod pixels;
mod point_lights;
mod pose;
mod random;
mod rectangles;
mod reduce;
mod report;
mod sampled;
mod scenes;
mod soft;
mod subject;
mod together;
mod ulp;
mod units;

use std::fmt;
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

use marbles_tests::promise::honesty::Honesty;
use rayon::prelude::*;

use self::draft::Draft;
use self::families::{FAMILIES, Family, Maker, SOFT_FAMILIES};
use self::options::Options;
use self::page::Page;
use self::reduce::Fault;
use self::report::Report;
use self::subject::Subject;
use marbles_tests::features;
use marbles_tests::numbers::Numbers;

/// A pixel whose error is larger than allowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Broken {
    pub(super) col: u32,
    pub(super) row: u32,
    pub(super) tolerance: f64,
    pub(super) error: f64,
    pub(super) claimed: f64,
    /// Whether it is reported as over its tolerance, and its error is larger than its claim.
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

/// The results of scenes.
#[derive(Clone, Debug)]
struct Found {
    /// The number of judged pixels.
    pixels: u64,
    /// The number of rendered pixels, and for each tolerance the number of those reported as over it.
    rendered: u64,
    given_up: Vec<u64>,
    /// The number of pixels whose true value is not known well enough to judge a tolerance.
    unjudged: u64,
    /// The number of scenes that were left out because their pictures take too long.
    skipped: u64,
    broken: Vec<Broken>,
    /// Pixels within their tolerance whose claim is a tiny part of their error.
    false_claims: Vec<Broken>,
    /// Pixels that change by more than they claim if a radius grows by an ulp.
    moved: Vec<Broken>,
    /// The first pixel reported as over a tolerance.
    unmet: Option<Broken>,
    /// For each tolerance, the ratios of true and claimed errors, for claims that are not negligible.
    honesty: Vec<Honesty>,
}

impl Found {
    fn new(tolerances: &[f64]) -> Self {
        Self {
            pixels: 0,
            rendered: 0,
            given_up: vec![0; tolerances.len()],
            unjudged: 0,
            skipped: 0,
            broken: Vec::new(),
            false_claims: Vec::new(),
            moved: Vec::new(),
            unmet: None,
            honesty: vec![Honesty::default(); tolerances.len()],
        }
    }

    fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.rendered += other.rendered;
        for (all, given_up) in self.given_up.iter_mut().zip(&other.given_up) {
            *all += given_up;
        }
        self.unjudged += other.unjudged;
        self.skipped += other.skipped;
        self.broken.extend(&other.broken);
        self.false_claims.extend(&other.false_claims);
        self.moved.extend(&other.moved);
        for (all, honesty) in self.honesty.iter_mut().zip(&other.honesty) {
            all.add(honesty);
        }
    }
}

/// The time from which a scene is reported as slow, in seconds.
const SLOW: f64 = 20.0;

/// A scene of a family, and the results for it.
struct Scene {
    index: u64,
    draft: Draft,
    found: Found,
}

/// Hunts, and reports by families. Returns an error that contains the report if a pixel is broken.
pub(crate) fn hunt(arguments: &[&str]) -> Result<String, String> {
    let mut options = Options::parse(arguments)?;
    let families = families(&options)?;
    if families
        .iter()
        .any(|(family, _)| SOFT_FAMILIES.iter().any(|soft| soft.name == family.name))
    {
        options.limit_to_soft();
    }
    let mut report = Report::new(&options.tolerances);
    let mut page = options
        .page
        .as_ref()
        .map(|path| Page::open(path, &[&options.part()]));
    let mut examples = String::new();
    for (family, each) in families {
        let start = Instant::now();
        let found = search(family, each, &options)?;
        let mut sum = Found::new(&options.tolerances);
        found.iter().for_each(|scene| sum.add(&scene.found));
        // A long hunt tells how far it is; nothing is left to do when even this fails.
        let seconds = start.elapsed().as_secs_f64();
        let _ = writeln!(
            io::stderr(),
            "{}, {seconds:.0} s",
            report::line(family.name, each, &options.tolerances, &sum)
        );
        report.add(family.name, each, &sum);
        for Scene {
            index,
            draft,
            found,
        } in &found
        {
            let seed = scene_seed(&options, *index);
            for (worst, fault) in worst_of(found, seed) {
                if fault != Fault::GivenUp {
                    let kind = if fault == Fault::Short { "" } else { " an ulp" };
                    let example = format!("{} {index}:{kind} {worst} {}", family.name, draft.kind);
                    let _ = writeln!(io::stderr(), "{example}");
                    examples += &format!("{example}\n");
                }
                if let Some(folder) = &options.folder {
                    let name = family.name.replace(' ', "_");
                    let name = format!("{name}-{}-{index}", options.seed);
                    reduce::write(Path::new(folder), &name, draft, &worst, fault)?;
                }
            }
        }
    }
    let exceeded = match &options.limits {
        Some(path) => report.exceeded(Path::new(path))?,
        None => String::new(),
    };
    let text = report.text();
    if let Some(page) = &mut page {
        page.write(
            &options.part(),
            &format!("`{}`\n\n{text}", options.command()),
        );
    }
    if examples.is_empty() && exceeded.is_empty() {
        Ok(text)
    } else {
        Err(format!("{text}\n{examples}{exceeded}"))
    }
}

/// Renders scenes in other units of light and of length. Returns an error if a picture differs.
pub(crate) fn laws(arguments: &[&str]) -> Result<String, String> {
    let options = Options::parse(arguments)?;
    let mut broken = String::new();
    let mut count = 0;
    for (family, each) in families(&options)? {
        let start = Instant::now();
        let found = laws::search(family, each, &options)?;
        let seconds = start.elapsed().as_secs_f64();
        let name = family.name;
        let differ = found.len();
        let line = format!("{name}: {each} scenes, {differ} differ, {seconds:.0} s");
        let _ = writeln!(io::stderr(), "{line}");
        count += each;
        broken += &found.concat();
    }
    match broken.is_empty() {
        true => Ok(format!(
            "{count} scenes have the same pixels in all units\n"
        )),
        false => Err(broken),
    }
}

/// The requested families: those of soft light only if no other has such a name. And the number of scenes of each.
fn families(options: &Options) -> Result<Vec<(&'static Family, u64)>, String> {
    let named = |families: &'static [Family]| -> Vec<&'static Family> {
        let families = families.iter();
        families
            .filter(|family| family.name.contains(&options.family))
            .collect()
    };
    let mut families = named(&FAMILIES);
    if families.is_empty() {
        families = named(&SOFT_FAMILIES);
    }
    if families.is_empty() {
        let names = FAMILIES.iter().chain(&SOFT_FAMILIES);
        let names = names.map(|family| family.name).collect::<Vec<_>>();
        let names = names.join(", ");
        return Err(format!(
            "expected a part of one of these names: {names}; found {}",
            options.family
        ));
    }
    let shares = families.iter().map(|family| 1.0 / family.rarity as f64);
    let most = (options.scenes as f64 / shares.sum::<f64>()).ceil() as u64;
    let counted = families.into_iter().map(|family| {
        let each = match (family.draft, options.rows) {
            (Maker::Row(_), Some(scenes)) => scenes * features::count(),
            _ => most.div_ceil(family.rarity),
        };
        (family, each)
    });
    Ok(counted.collect())
}

/// The scene of a family by its number.
fn draft(family: &Family, scenes: u64, options: &Options, index: u64) -> Draft {
    let mut numbers = Numbers(scene_seed(options, index));
    match family.draft {
        Maker::Random(draft) => draft(&mut numbers),
        // Other seeds begin with other rows.
        Maker::Row(draft) => draft(&mut numbers, options.seed.wrapping_mul(scenes) + index),
    }
}

/// The numbers of the requested scenes.
fn indices(scenes: u64, options: &Options) -> Vec<u64> {
    match options.only {
        Some(index) => vec![index],
        None => (0..scenes).collect(),
    }
}

/// The worst pixel that fell short, the worst that an ulp moves too far, and one that is given up.
fn worst_of(found: &Found, seed: u64) -> impl Iterator<Item = (Broken, Fault)> {
    let ratio = |broken: &&Broken| broken.error / broken.tolerance;
    let worst = |list: &mut dyn Iterator<Item = &Broken>| {
        list.max_by(|a, b| ratio(a).total_cmp(&ratio(b))).copied()
    };
    let short = worst(&mut found.broken.iter().chain(&found.false_claims));
    let moved = worst(&mut found.moved.iter());
    let short = short.map(|broken| (broken, Fault::Short));
    let moved = moved.map(|broken| (broken, Fault::Moved(seed)));
    let unmet = found.unmet.map(|broken| (broken, Fault::GivenUp));
    short.into_iter().chain(moved).chain(unmet)
}

/// The number from which a scene is made.
fn scene_seed(options: &Options, index: u64) -> u64 {
    options.seed.wrapping_mul(1_000_003).wrapping_add(index)
}

/// The first scenes of a family, and what was found in each.
fn search(family: &Family, scenes: u64, options: &Options) -> Result<Vec<Scene>, String> {
    let judged = |index| {
        let seed = scene_seed(options, index);
        let draft = draft(family, scenes, options, index);
        let subject = Subject::of(&draft).map_err(|error| format!("{}: {error}", family.name))?;
        if options.only.is_some() {
            let _ = writeln!(io::stderr(), "{} {index}: {}", family.name, draft.kind);
        }
        let start = Instant::now();
        let mut found = pixels::judge(&subject, &options.tolerances);
        let judging = start.elapsed().as_secs_f64();
        if found.skipped == 0 {
            ulp::judge(&mut found, &draft, &subject, seed, &options.tolerances);
        }
        let seconds = start.elapsed().as_secs_f64();
        // A search that is stopped early has told what it found.
        for broken in worst_of(&found, seed).filter_map(|(broken, fault)| {
            let is_broken = !matches!(fault, Fault::GivenUp);
            is_broken.then_some(broken)
        }) {
            let _ = writeln!(io::stderr(), "{} {index} is wrong: {broken}", family.name);
        }
        let over: u64 = found.given_up.iter().sum();
        if over > 0 && !draft.kind.is_empty() {
            let _ = writeln!(
                io::stderr(),
                "{} {index} gives up {:?}: {}",
                family.name,
                found.given_up,
                draft.kind
            );
        }
        if seconds > SLOW {
            let _ = writeln!(
                io::stderr(),
                "{} {index} took {judging:.0} and {:.0} s: {}",
                family.name,
                seconds - judging,
                draft.kind
            );
        }
        Ok(Scene {
            index,
            draft,
            found,
        })
    };
    indices(scenes, options)
        .into_par_iter()
        .map(judged)
        .collect()
}
