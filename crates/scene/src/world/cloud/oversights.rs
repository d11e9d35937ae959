//! What the colors and radii of a cloud leave out, or show alike.

use std::collections::HashMap;

use super::coloring::{Learned, Scale};
use crate::table;
use crate::text::{did_you_mean, list, quoted};

/// The most names that a warning lists.
const MOST_LISTED: usize = 6;
/// More categories than anybody tells apart by their colors.
const MANY: usize = 24;

impl Scale {
    /// What of the palette matches nothing, and categories that share colors.
    pub(super) fn oversights(&self, learned: &Learned, column: Option<&str>) -> Vec<String> {
        let column = column.map_or_else(|| String::from("the table"), quoted);
        let names = self.categories(learned);
        let mut told = Vec::new();
        let unmatched = self.palette_names().into_iter().filter(|own| {
            let number = table::of_plain_symbol(own.as_bytes()).filter(|_| learned.are_elements);
            let is_same = |name: &str| {
                name == own || number.is_some() && table::of_plain_symbol(name.as_bytes()) == number
            };
            !names.iter().any(|(name, _)| is_same(name))
        });
        let unmatched: Vec<String> = unmatched.collect();
        if let Some(first) = unmatched.first() {
            let known = names.iter().map(|(name, _)| name.as_str());
            let what = if learned.are_elements {
                "elements"
            } else {
                "categories"
            };
            told.push(format!(
                "`palette` has colors for {}, which no row of {column} is called: its {what} are {}{}",
                listed(&unmatched),
                listed(&known.clone().map(str::to_owned).collect::<Vec<_>>()),
                did_you_mean(first, known, quoted),
            ));
        }
        if !learned.are_elements {
            told.extend(self.shared(&names, &column));
        }
        told
    }

    /// Categories that have the color of another one, though no palette says so.
    fn shared(&self, names: &[(String, glam::DVec3)], column: &str) -> Option<String> {
        let mut counts: HashMap<[u64; 3], usize> = HashMap::new();
        for (_, color) in names {
            *counts
                .entry(color.to_array().map(f64::to_bits))
                .or_default() += 1;
        }
        let own: Vec<String> = self.palette_names();
        let own: std::collections::HashSet<&str> = own.iter().map(String::as_str).collect();
        let shares = |(name, color): &&(String, glam::DVec3)| {
            !own.contains(name.as_str()) && counts[&color.to_array().map(f64::to_bits)] > 1
        };
        let shared = names.iter().filter(shares).count();
        if shared == 0 {
            return None;
        }
        let are_numbers = names.iter().all(|(name, _)| name.parse::<f64>().is_ok());
        let hint = match (are_numbers, names.len() > MANY) {
            (true, _) => "numbers that are no categories have colors by `color: Value`",
            (false, true) => "`keep` or another column leaves fewer",
            (false, false) => "`palette` gives each a color of its own",
        };
        Some(format!(
            "{column} has {} categories and {} colors: {shared} of them share colors ({hint})",
            names.len(),
            counts.len(),
        ))
    }
}

/// The names of `radii` that no row has, as a warning tells them.
pub(super) fn unused_radii(names: &[String]) -> Option<String> {
    (!names.is_empty()).then(|| {
        format!(
            "`radii` has radii for {}, which no row has: it is called otherwise, or its radius is that of `radius` or of a \
             column",
            listed(names)
        )
    })
}

/// Some of these names, in quotation marks.
fn listed(names: &[String]) -> String {
    let mut shown: Vec<String> = names
        .iter()
        .take(MOST_LISTED)
        .map(|name| quoted(name))
        .collect();
    if names.len() > MOST_LISTED {
        shown.push(format!("{} more", names.len() - MOST_LISTED));
    }
    list(&shown).replace(" or ", " and ")
}
