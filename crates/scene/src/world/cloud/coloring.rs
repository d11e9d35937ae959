//! The colors of a cloud's spheres.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use glam::DVec3;
use marbles_core::{Albedos, parallel};

use crate::file::{self, ColorScale, OTHERS_COLOR};
use crate::table::{self, Categories, Colormap, Missing, Paint, ValueRange};
use crate::text::{optional, refuse};
use crate::values::{Flag, from_srgb};

/// The way from the numbers of a table to colors.
#[derive(Clone, Debug)]
pub(crate) struct Scale {
    pub(crate) colormap: Colormap,
    pub(crate) kind: ScaleKind,
    pub(crate) is_reversed: bool,
    range: Option<ValueRange>,
    /// The colors of categories or elements that the scene file gives, in its order.
    palette: Vec<(String, DVec3)>,
    /// The place of the palette, in bytes of the scene file.
    pub(super) palette_place: Range<usize>,
    /// The color of what is no element.
    other_color: DVec3,
}

/// The way in which the colors of a scale follow numbers.
///
/// # Example
/// ```
/// use marbles_scene::{ColorMeaning, ScaleKind, Scene};
///
/// # let folder = std::env::temp_dir().join(format!("marbles ScaleKind {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `balls.csv`: two balls, with the masses 1 and 100
/// # std::fs::write(folder.join("balls.csv"), "x,y,z,radius,mass\n0,0,0,1,1\n3,0,0,1,100\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Frame(),
///     clouds: [(file: "balls.csv", color: Value, value: "mass", color_scale: Log)])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// # std::fs::remove_dir_all(&folder)?;
/// // …
/// let colors = scene.clouds()[0].colors.as_ref().expect("the scene asks for colors");
/// assert!(matches!(colors.meaning, ColorMeaning::Scale { kind: ScaleKind::Log, .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScaleKind {
    /// Equal steps of numbers are equal steps of colors.
    Linear,
    /// Equal factors of numbers are equal steps of colors.
    Log,
    /// This number has the middle color, and both sides have one scale.
    Diverging(f64),
}

/// The numbers and categories of all steps, as far as they are known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Learned {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) categories: BTreeSet<String>,
    /// The categories are elements.
    pub(crate) are_elements: bool,
}

impl Default for Learned {
    fn default() -> Self {
        Self {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            categories: BTreeSet::new(),
            are_elements: false,
        }
    }
}

impl Scale {
    /// The scale that the file describes; `None` where a fault was reported.
    pub(super) fn new(cloud: &file::Cloud, other_color: Option<DVec3>) -> Option<Self> {
        let kind = match &cloud.color_scale {
            None => ScaleKind::Linear,
            Some(scale) => match scale.value.as_ref()? {
                ColorScale::Linear => ScaleKind::Linear,
                ColorScale::Log => ScaleKind::Log,
                ColorScale::Diverging(middle) => ScaleKind::Diverging(middle.get()?.0),
            },
        };
        let range = optional(&cloud.range, |range| Some(*range))?;
        if let (ScaleKind::Log, Some(ValueRange::Fixed(low, _))) = (kind, range)
            && low <= 0.0
            && let Some(place) = cloud.range.as_ref().map(|range| range.place.clone())
        {
            let message =
                format!("expected numbers greater than 0 for `color_scale: Log`, found {low}");
            return refuse(place, message);
        }
        let usual = match kind {
            ScaleKind::Diverging(_) => Colormap::CoolWarm,
            _ => Colormap::default(),
        };
        let palette = optional(&cloud.palette, |palette| palette.once("category"))?;
        let palette = palette.unwrap_or_default().into_iter();
        let palette: Vec<_> = palette.map(|(name, color)| (name, color.0)).collect();
        let place = cloud.palette.as_ref().map(|palette| palette.place.clone());
        let place = place.unwrap_or_default();
        if palette.len() > MOST_COLORS {
            let found = palette.len();
            let message = format!("expected at most {MOST_COLORS} colors, found {found}");
            return refuse(place, message);
        }
        Some(Self {
            colormap: optional(&cloud.colormap, |colormap| Some(*colormap))?.unwrap_or(usual),
            kind,
            is_reversed: cloud.reversed.get().map(|Flag(flag)| flag)?,
            range,
            palette,
            palette_place: place,
            other_color: other_color.unwrap_or_else(|| from_srgb(OTHERS_COLOR)),
        })
    }

    /// The names to which the scene file gives colors.
    pub(super) fn palette_names(&self) -> Vec<String> {
        self.palette.iter().map(|(name, _)| name.clone()).collect()
    }

    /// The color that the scene file gives to a category.
    fn own_color(&self, name: &str) -> Option<DVec3> {
        let mut palette = self.palette.iter();
        palette.find(|own| own.0 == name).map(|own| own.1)
    }

    /// True where the range of numbers depends on those of the table.
    pub(super) fn has_open_range(&self) -> bool {
        !matches!(self.range, Some(ValueRange::Fixed(..)))
    }

    /// Takes in the numbers or categories of a step.
    ///
    /// The least of the low ends, and the greatest of the high ones, are the ends of all steps.
    pub(super) fn learn(&self, paint: &Paint, learned: &mut Learned) {
        match paint {
            Paint::Values(values) => {
                if let Some((low, high)) = self.ends(values) {
                    learned.low = learned.low.min(low);
                    learned.high = learned.high.max(high);
                }
            }
            Paint::Categories(categories) => {
                learned.categories.extend(categories.names.iter().cloned());
            }
            Paint::Elements(colors) => {
                let mut is_used = [false; 256];
                colors
                    .iter()
                    .for_each(|color| is_used[usize::from(*color)] = true);
                let names = table::color_names(&self.palette_names()).into_iter();
                let used = names.zip(is_used).filter(|(_, is_used)| *is_used);
                learned.categories.extend(used.map(|(name, _)| name));
                learned.are_elements = true;
            }
            Paint::Material | Paint::Colors(_) | Paint::Distinct(_) | Paint::Contents(_) => {}
        }
    }

    /// The numbers of the first and the last color for these alone; `None` for none.
    fn ends(&self, values: &[f64]) -> Option<(f64, f64)> {
        let present = || values.iter().copied().filter(|value| !value.is_nan());
        let (low, high) = match self.range {
            Some(ValueRange::Fixed(low, high)) => (low, high),
            None => (
                present().fold(f64::INFINITY, f64::min),
                present().fold(f64::NEG_INFINITY, f64::max),
            ),
            Some(ValueRange::Percentile(low, high)) => {
                let mut sorted: Vec<f64> = present().collect();
                let last = sorted.len().checked_sub(1)?;
                let mut at = |percent: f64| {
                    let place = libm::round(percent / 100.0 * last as f64) as usize;
                    *sorted
                        .select_nth_unstable_by(place.min(last), f64::total_cmp)
                        .1
                };
                (at(low), at(high))
            }
        };
        (low <= high).then_some((low, high))
    }

    /// The numbers that have the first and the last color, as far as the scale allows for them.
    pub(crate) fn range(&self, learned: &Learned) -> (f64, f64) {
        let (low, high) = match self.range {
            Some(ValueRange::Fixed(low, high)) => (low, high),
            _ => (learned.low, learned.high),
        };
        match self.kind {
            ScaleKind::Diverging(middle) => {
                let half = (high - middle).max(middle - low);
                (middle - half, middle + half)
            }
            _ => (low, high),
        }
    }

    /// The colors of the spheres; `None` for those that have their material's.
    ///
    /// # Errors
    /// Returns the message that says which numbers have no place on the scale.
    pub(super) fn albedos(
        &self,
        paint: Paint,
        missing: Missing,
        learned: &Learned,
    ) -> Result<Option<Albedos>, String> {
        Ok(match paint {
            Paint::Material | Paint::Distinct(_) | Paint::Contents(_) => None,
            Paint::Colors(colors) => Some(Albedos::Each(colors)),
            Paint::Elements(indices) => Some(Albedos::Palette {
                colors: self.element_colors(),
                indices,
            }),
            Paint::Categories(categories) => Some(self.of_categories(&categories, learned)),
            Paint::Values(values) => Some(self.of_values(&values, missing, learned)?),
        })
    }

    fn of_values(
        &self,
        values: &[f64],
        missing: Missing,
        learned: &Learned,
    ) -> Result<Albedos, String> {
        let (mut low, mut high) = self.range(learned);
        let is_log = self.kind == ScaleKind::Log;
        if is_log {
            if low <= 0.0 {
                return Err(format!(
                    "expected numbers greater than 0 for `color_scale: Log`, found {low}"
                ));
            }
            (low, high) = (libm::log(low), libm::log(high));
        }
        let place = |value: f64| match is_log {
            // What lies below the range has the first color.
            true if value <= 0.0 => f64::NEG_INFINITY,
            true => libm::log(value),
            false => value,
        };
        let index = |value: &f64| table::color_index(place(*value), low, high);
        let colors = self.colors();
        if let Missing::Color(missing) = missing {
            let color = |value: &f64| match value.is_nan() {
                true => missing,
                false => colors[usize::from(index(value))],
            };
            let each = parallel::map_each(values, |value| color(value).as_vec3().to_array());
            return Ok(Albedos::Each(each));
        }
        Ok(Albedos::Palette {
            colors,
            indices: parallel::map_each(values, index),
        })
    }

    /// The colors of the scale, from the lowest number's to the highest's.
    pub(crate) fn colors(&self) -> Vec<DVec3> {
        let mut colors = self.colormap.colors();
        if self.is_reversed {
            colors.reverse();
        }
        colors
    }

    /// The colors of elements: those of others, of the elements, and of names that the scene file has beside them.
    fn element_colors(&self) -> Vec<DVec3> {
        let usual = table::element_colors().into_iter().map(Some);
        let names = table::color_names(&self.palette_names()).into_iter();
        let usual = usual.chain(std::iter::repeat(None));
        names
            .zip(usual)
            .enumerate()
            .map(|(place, (name, usual))| match place {
                0 => self.other_color,
                _ => {
                    let number = table::of_plain_symbol(name.as_bytes());
                    let is_same = |own: &&(String, DVec3)| {
                        own.0 == name
                            || number.is_some()
                                && table::of_plain_symbol(own.0.as_bytes()) == number
                    };
                    let own = self.palette.iter().find(is_same).map(|own| own.1);
                    own.or(usual).unwrap_or(self.other_color)
                }
            })
            .collect()
    }

    /// The categories of all steps in their order, each with its color.
    pub(crate) fn categories(&self, learned: &Learned) -> Vec<(String, DVec3)> {
        if learned.are_elements {
            let names = table::color_names(&self.palette_names()).into_iter();
            let all = names.zip(self.element_colors());
            return all
                .filter(|(name, _)| learned.categories.contains(name))
                .collect();
        }
        let number = |name: &String| name.parse::<f64>().ok().filter(|number| number.is_finite());
        let mut names: Vec<String> = learned.categories.iter().cloned().collect();
        if names.iter().all(|name| number(name).is_some()) {
            names.sort_by(|a, b| {
                number(a)
                    .unwrap_or(0.0)
                    .total_cmp(&number(b).unwrap_or(0.0))
            });
        }
        let color = |(index, name): (usize, String)| {
            let own = self.own_color(&name);
            let color = own.unwrap_or_else(|| from_srgb(PALETTE[index % PALETTE.len()]));
            (name, color)
        };
        names.into_iter().enumerate().map(color).collect()
    }

    fn of_categories(&self, categories: &Categories, learned: &Learned) -> Albedos {
        let mut colors: Vec<DVec3> = Vec::new();
        let mut index = HashMap::new();
        for (name, color) in self.categories(learned) {
            // At most `MOST_COLORS` and those of the palette are different.
            let known = colors.iter().position(|other| *other == color);
            let place = known.unwrap_or_else(|| {
                colors.push(color);
                colors.len() - 1
            });
            index.insert(name, place as u8);
        }
        let names: Vec<u8> = categories
            .names
            .iter()
            .map(|name| index.get(name).copied().unwrap_or(0))
            .collect();
        Albedos::Palette {
            colors,
            indices: parallel::map_each(&categories.indices, |index| names[*index as usize]),
        }
    }
}

/// The most colors that a scene file gives to categories: with those of `PALETTE` no more than a byte counts.
const MOST_COLORS: usize = 240;

/// The colors of categories in their order, made to be told apart.
///
/// # Source
/// Sasha Trubetskoy, "List of 20 simple, distinct colors", 2017: twelve of them.
const PALETTE: [u32; 12] = [
    0x4363d8, 0xf58231, 0x3cb44b, 0xe6194b, 0xffe119, 0x42d4f4, 0xf032e6, 0x469990, 0xbfef45,
    0xfabed4, 0x9a6324, 0xdcbeff,
];
