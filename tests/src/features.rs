//! Features of scenes, and rows that combine every three of them.

use std::fmt;
use std::sync::OnceLock;

use crate::covering::{Choice, rows};

/// The features in which scenes differ.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Feature {
    /// The lens.
    Lens,
    /// The kind of light.
    Light,
    /// Bumps.
    Surface,
    /// The contrast exponent.
    Exponent,
    /// The shininess.
    Highlight,
    /// Lines along outlines.
    Outline,
    /// Whether spheres block light.
    Shadows,
    /// Whether the camera moves while the shutter is open.
    Shutter,
    /// Alpha instead of the background.
    Alpha,
    /// The picture of one light.
    PerLight,
    /// A huge sphere below.
    Floor,
    /// The position of the camera.
    Eye,
    /// The unit of light.
    Brightness,
    /// The unit of length.
    Length,
}

use Feature::{
    Alpha, Brightness, Exponent, Eye, Floor, Highlight, Length, Lens, Light, Outline, PerLight,
    Shadows, Shutter, Surface,
};

/// All features with their values, in the order of [`Feature`].
pub const FEATURES: [(Feature, &[&str]); 14] = [
    (Lens, &["pinhole", "wide", "shifted", "parallel"]),
    (
        Light,
        &[
            "sun",
            "lamp with falloff",
            "lamp without",
            "lamp near balls",
            "attached",
        ],
    ),
    (
        Surface,
        &[
            "smooth",
            "bumps coarse",
            "bumps like pixels",
            "bumps fine",
            "grain",
        ],
    ),
    (Exponent, &["1", "below 1", "above 1"]),
    (Highlight, &["none", "wide", "narrow"]),
    (Outline, &["no", "yes"]),
    (Shadows, &["yes", "no"]),
    (Shutter, &["closed", "open"]),
    (Alpha, &["no", "yes"]),
    (PerLight, &["no", "yes"]),
    (Floor, &["no", "yes"]),
    (Eye, &["far", "near", "inside"]),
    (Brightness, &["1", "dim", "bright"]),
    (Length, &["1", "small", "large"]),
];

/// The names of a row's values.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a>(&'a [usize]);

impl Row<'_> {
    /// The value of a feature.
    pub fn value(&self, feature: Feature) -> &'static str {
        let index = feature as usize;
        FEATURES[index].1[self.0[index]]
    }

    /// Whether a feature has a value.
    pub fn has(&self, feature: Feature, value: &str) -> bool {
        self.value(feature) == value
    }
}

impl fmt::Display for Row<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, (feature, values)) in FEATURES.iter().enumerate() {
            let separator = if index == 0 { "" } else { ", " };
            write!(
                formatter,
                "{separator}{feature:?} {}",
                values[self.0[index]]
            )?;
        }
        Ok(())
    }
}

/// The number of rows.
pub fn count() -> u64 {
    table().len() as u64
}

/// A row; the numbers continue with the first row after the last.
pub fn row(index: u64) -> Row<'static> {
    let table = table();
    Row(&table[(index % table.len() as u64) as usize])
}

fn table() -> &'static [Vec<usize>] {
    static TABLE: OnceLock<Vec<Vec<usize>>> = OnceLock::new();
    TABLE.get_or_init(|| rows(&levels(), contradict))
}

fn levels() -> Vec<usize> {
    FEATURES.iter().map(|(_, values)| values.len()).collect()
}

/// Lights that are attached to the camera are refused if its shutter is open.
fn contradict(one: Choice, other: Choice) -> bool {
    let is = |(feature, value): Choice, of: Feature, name: &str| {
        feature == of as usize && FEATURES[feature].1[value] == name
    };
    let both = |one, other| is(one, Light, "attached") && is(other, Shutter, "open");
    both(one, other) || both(other, one)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_are_in_their_order() {
        for (index, (feature, _)) in FEATURES.iter().enumerate() {
            assert_eq!(*feature as usize, index);
        }
    }

    /// Counted without the code that makes the array.
    #[test]
    fn every_three_values_of_features_that_may_be_are_together_in_some_row() {
        let (levels, table) = (levels(), table());
        let mut count = 0;
        for c in 0..levels.len() {
            for b in 0..c {
                for a in 0..b {
                    let mut seen = vec![false; levels[a] * levels[b] * levels[c]];
                    for row in table {
                        seen[(row[a] * levels[b] + row[b]) * levels[c] + row[c]] = true;
                    }
                    for (index, seen) in seen.into_iter().enumerate() {
                        let values = [
                            (a, index / levels[c] / levels[b]),
                            (b, index / levels[c] % levels[b]),
                            (c, index % levels[c]),
                        ];
                        let refused = (0..3).any(|k| contradict(values[k], values[(k + 1) % 3]));
                        assert!(seen != refused, "{values:?}");
                        count += 1;
                    }
                }
            }
        }
        assert!(count > 8000, "{count}");
    }

    /// The three features with the most values have a hundred combinations, and each needs a row.
    #[test]
    fn rows_are_few() {
        assert!((100..=130).contains(&table().len()), "{}", table().len());
    }
}
