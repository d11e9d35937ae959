//! Categories and names that the colors and radii of a cloud leave out, or show alike.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::sync::PoisonError;

use marbles_core::Albedos;

use super::coloring::{Learned, Scale};
use super::open::OpenCloud;
use super::remarked::Oversight;
use super::settings::Cloud;
use super::step::Step;
use crate::table::{self, Remarks};
use crate::text::{Fault, did_you_mean, list, quoted};

/// The most names that a warning lists.
const MOST_LISTED: usize = 6;
/// More categories than anybody tells apart by their colors.
const MANY: usize = 24;

impl OpenCloud {
    /// Takes in what is left open in a step, unless all were read before.
    pub(super) fn note(&self, step: usize, remarks: &Remarks) {
        if self.steps().is_none() || self.has_to_learn() {
            return;
        }
        let mut late = self.late.lock().unwrap_or_else(PoisonError::into_inner);
        let mut is_new = false;
        for name in remarks.unknown() {
            is_new |= late.names.insert(name.into());
        }
        if is_new && step > 0 {
            let told = remarks.told(self.cloud.request.other_radius.is_none());
            let path = self.path_of(remarks, step);
            let told = told
                .into_iter()
                .map(|fault| Oversight::Table(path.clone(), fault));
            late.oversights.extend(told);
        }
    }

    /// Hands over what was left open in steps that were read after the first, and not yet told.
    pub(crate) fn take_late_oversights(&self) -> Vec<Oversight> {
        let mut late = self.late.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut late.oversights)
    }

    /// The file in which the remarks about a step are.
    fn path_of(&self, remarks: &Remarks, step: usize) -> PathBuf {
        let other = remarks.file.as_ref();
        other.map_or_else(|| self.path(step), |other| other.to_path_buf())
    }

    /// Possible oversights about the first step, which is given, or about all that were read for it.
    pub(crate) fn oversights(&self, first: &Step) -> Vec<Oversight> {
        let Cloud { request, scale, .. } = &self.cloud;
        let (remarks, step) = match self.has_to_learn() {
            true => (&self.remarks.0, self.remarks.1),
            false => (&first.remarks, 0),
        };
        let radius = request.other_radius;
        let told = remarks.told(radius.is_none());
        let path = self.path_of(remarks, step);
        let of_table = |fault| Oversight::Table(path.clone(), fault);
        let mut all: Vec<Oversight> = told.into_iter().map(of_table).collect();
        let of_scene = |place: &std::ops::Range<usize>, message| {
            Oversight::Scene(Fault::new(place.clone(), message))
        };
        let of_colors = scale.oversights(&first.learned, first.value_name.as_deref());
        let place = match request.palette.is_empty() {
            true => &self.cloud.place,
            false => &scale.palette_place,
        };
        all.extend(of_colors.into_iter().map(|told| of_scene(place, told)));
        all.extend(look_like_bytes(first).map(|told| of_scene(&self.cloud.place, told)));
        let unused = remarks.unused_radii();
        let unused: Vec<String> = unused
            .map(|name| request.own_radii[name].0.clone())
            .collect();
        let unused = unused_radii(&unused);
        all.extend(unused.map(|told| of_scene(&self.cloud.radii_place, told)));
        all
    }
}

impl Scale {
    /// Names of the palette that match nothing, and categories that share colors.
    fn oversights(&self, learned: &Learned, column: Option<&str>) -> Vec<String> {
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
                "`palette` has colors for {}, which match no row of {column}: its {what} are {}{}",
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
        let own: HashSet<&str> = own.iter().map(String::as_str).collect();
        let shares = |(name, color): &&(String, glam::DVec3)| {
            !own.contains(name.as_str()) && counts[&color.to_array().map(f64::to_bits)] > 1
        };
        let shared = names.iter().filter(shares).count();
        if shared == 0 {
            return None;
        }
        let are_numbers = names
            .iter()
            .all(|(name, _)| name.parse::<f64>().is_ok() || table::time(name.as_bytes()).is_some());
        let hint = match (are_numbers, names.len() > MANY) {
            (true, _) => "`color: Value` gives numbers and times a color scale",
            (false, true) => "use `keep` or another column to get fewer",
            (false, false) => "use `palette` to give each its own color",
        };
        Some(format!(
            "{column} has {} categories and {} colors: {shared} of them share colors ({hint})",
            names.len(),
            counts.len(),
        ))
    }
}

/// Colors of a table above 1, as a warning tells them.
fn look_like_bytes(step: &Step) -> Option<String> {
    let Some(Albedos::Each(colors)) = &step.albedos else {
        return None;
    };
    let channels = || colors.iter().flatten();
    let most = channels().fold(0.0_f32, |most, channel| most.max(*channel));
    let are_whole = channels().all(|channel| channel.fract() == 0.0);
    match most {
        ..=1.0 => None,
        2.0..=255.0 if are_whole => Some(format!(
            "the table's colors are numbers up to {most}, which look like bytes: they are read as linear values, and 1 is white"
        )),
        _ => Some(format!(
            "the table's colors are numbers up to {most}: with an albedo above 1, a surface reflects more light than it receives"
        )),
    }
}

/// The names of `radii` that no row has, as a warning tells them.
fn unused_radii(names: &[String]) -> Option<String> {
    (!names.is_empty()).then(|| {
        format!(
            "`radii` has radii for {}, which match no row: the rows have other elements, or `radius` or a column \
             sets their radii",
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
