//! The tables that tell what a hunt found.

use std::fmt::Write;

use marbles_tests::promise::honesty::Honesty;

use super::Found;

/// The tables, family by family.
pub(super) struct Report<'a> {
    tolerances: &'a [f64],
    /// Pixels that fell short.
    counts: String,
    /// The medians of true over claimed errors.
    medians: String,
    /// Of all families, for each tolerance.
    honesty: Vec<Honesty>,
    unjudged: u64,
}

impl<'a> Report<'a> {
    pub(super) fn new(tolerances: &'a [f64]) -> Self {
        let names: String = tolerances.iter().map(|it| format!(" {it:e} |")).collect();
        let rules = "--:|".repeat(tolerances.len());
        Self {
            tolerances,
            counts: format!(
                "| family | scenes | pixels |{names} beyond claim | false claims |\n|---|--:|--:|{rules}--:|--:|\n"
            ),
            medians: format!("| true / claimed error |{names}\n|---|{rules}\n"),
            honesty: vec![Honesty::default(); tolerances.len()],
            unjudged: 0,
        }
    }

    /// Adds what was found in the scenes of a family.
    pub(super) fn add<'found>(
        &mut self,
        family: &str,
        scenes: u64,
        found: impl Iterator<Item = &'found Found>,
    ) {
        let mut sum = Found::new(self.tolerances);
        for found in found {
            sum.add(found);
        }
        self.unjudged += sum.unjudged;
        let pixels = sum.pixels;
        // Writing to a string does not fail.
        let _ = write!(self.counts, "| {family} | {scenes} | {pixels} ");
        for &tolerance in self.tolerances {
            let broken = sum.broken.iter();
            let broken =
                broken.filter(|broken| !broken.is_confessed && broken.tolerance == tolerance);
            let _ = write!(self.counts, "| {} ", broken.count());
        }
        let beyond = sum.broken.iter().filter(|broken| broken.is_confessed);
        let false_claims = sum.false_claims.len();
        let _ = writeln!(self.counts, "| {} | {false_claims} |", beyond.count());
        self.medians.push_str(&medians(family, &sum.honesty));
        for (all, honesty) in self.honesty.iter_mut().zip(&sum.honesty) {
            all.add(honesty);
        }
    }

    /// The text of both tables.
    pub(super) fn text(self) -> String {
        let all = medians("all", &self.honesty);
        let mut text = format!("{}\n{}{all}", self.counts, self.medians);
        if self.unjudged > 0 {
            let _ = writeln!(
                text,
                "\n{} pixels of fine bumps could not be judged.",
                self.unjudged
            );
        }
        text
    }
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
