//! The tables with the results of a hunt.

use std::fmt::Write;
use std::path::Path;

use marbles_tests::promise::honesty::Honesty;

use super::{Found, limits};

/// The tables, family by family.
pub(super) struct Report<'a> {
    tolerances: &'a [f64],
    /// The counts of pixels with errors larger than allowed.
    counts: String,
    /// The medians of true over claimed errors.
    medians: String,
    /// The number of pixels reported as over their tolerance, per million.
    given_up: String,
    /// The ratios of all families, for each tolerance.
    honesty: Vec<Honesty>,
    unjudged: u64,
    skipped: u64,
    /// The number of pixels reported as over their tolerance, for each family.
    counts_given_up: Vec<(String, Vec<u64>)>,
}

impl<'a> Report<'a> {
    pub(super) fn new(tolerances: &'a [f64]) -> Self {
        let names: String = tolerances.iter().map(|it| format!(" {it:e} |")).collect();
        let rules = "--:|".repeat(tolerances.len());
        Self {
            tolerances,
            counts: format!(
                "| family | scenes | pixels |{names} beyond claim | false claims | moved by an ulp |\n\
                 |---|--:|--:|{rules}--:|--:|--:|\n"
            ),
            medians: format!("| true / claimed error |{names}\n|---|{rules}\n"),
            given_up: format!("| given up, per million |{names}\n|---|{rules}\n"),
            honesty: vec![Honesty::default(); tolerances.len()],
            unjudged: 0,
            skipped: 0,
            counts_given_up: Vec::new(),
        }
    }

    /// Adds the results of the scenes of a family.
    pub(super) fn add(&mut self, family: &str, scenes: u64, sum: &Found) {
        self.unjudged += sum.unjudged;
        self.skipped += sum.skipped;
        // Writing to a string does not fail.
        let _ = writeln!(
            self.counts,
            "| {family} | {scenes} | {} |{}",
            sum.pixels,
            counts(self.tolerances, sum)
        );
        self.medians.push_str(&medians(family, &sum.honesty));
        let of_each = sum.rendered as f64 / self.tolerances.len() as f64;
        let share = |&count: &u64| format!(" {:.0} |", 1e6 * count as f64 / of_each);
        let shares: String = sum.given_up.iter().map(share).collect();
        let _ = writeln!(self.given_up, "| {family} |{shares}");
        self.counts_given_up
            .push((family.to_owned(), sum.given_up.clone()));
        for (all, honesty) in self.honesty.iter_mut().zip(&sum.honesty) {
            all.add(honesty);
        }
    }

    /// The families with more pixels over the tolerance than a file allows; see [`limits::exceeded`].
    pub(super) fn exceeded(&self, path: &Path) -> Result<String, String> {
        limits::exceeded(path, &self.counts_given_up)
    }

    /// The text of all tables.
    pub(super) fn text(self) -> String {
        let all = medians("all", &self.honesty);
        let mut text = format!("{}\n{}{all}\n{}", self.counts, self.medians, self.given_up);
        if self.unjudged > 0 {
            let _ = writeln!(
                text,
                "\n{} pixels of fine bumps or under soft light could not be judged.",
                self.unjudged
            );
        }
        if self.skipped > 0 {
            let _ = writeln!(
                text,
                "\n{} scenes were left out: their pictures take too long.",
                self.skipped
            );
        }
        text
    }
}

/// The cells of a family with the counts of pixels with errors larger than allowed.
fn counts(tolerances: &[f64], sum: &Found) -> String {
    let mut text = String::new();
    for &tolerance in tolerances {
        let broken = sum.broken.iter();
        let broken = broken.filter(|broken| !broken.is_confessed && broken.tolerance == tolerance);
        let _ = write!(text, " {} |", broken.count());
    }
    let beyond = sum.broken.iter().filter(|broken| broken.is_confessed);
    let _ = write!(
        text,
        " {} | {} | {} |",
        beyond.count(),
        sum.false_claims.len(),
        sum.moved.len()
    );
    text
}

/// The line that a hunt prints after each family.
pub(super) fn line(family: &str, scenes: u64, tolerances: &[f64], sum: &Found) -> String {
    format!(
        "{family}: {scenes} scenes, {} pixels, fell short |{} given up {:?}, unjudged {}, skipped {}",
        sum.pixels,
        counts(tolerances, sum),
        sum.given_up,
        sum.unjudged,
        sum.skipped
    )
}

/// A row of medians.
fn medians(name: &str, honesty: &[Honesty]) -> String {
    let cell = |honesty: &Honesty| match honesty.median() {
        Some(median @ 0.001..) => format!(" {median:.3} |"),
        Some(median) => format!(" {median:.1e} |"),
        None => " - |".to_owned(),
    };
    let cells: String = honesty.iter().map(cell).collect();
    format!("| {name} |{cells}\n")
}
