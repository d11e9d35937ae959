//! The settings of a cloud in a scene file.

use std::ops::Range;

use marbles_core::MaterialId;

use super::super::placement::{Placement, turn};
use super::coloring::Scale;
use super::steps::Timeline;
use crate::file::{self, ElementRadii, Keep, RadiusColumn, TakenFrames};
use crate::table::{
    Coloring, ColumnRef, Filter, MOST_FILTERS, Periodic, Radii, RadiusLaw, Request, Test,
};
use crate::text::{Placed, optional, refuse};
use crate::values::{Every, Flag, Repeat, Speed};

/// A cloud of the scene file whose table is not yet read.
#[derive(Clone, Debug)]
pub(crate) struct Cloud {
    /// The table as the file names it.
    pub(crate) name: String,
    /// The place of its name, in bytes of the scene file.
    pub(crate) place: Range<usize>,
    pub(crate) material: MaterialId,
    /// The table that tells the atoms of a trajectory, and the place of its name in bytes of the scene file.
    pub(super) topology: Option<(String, Range<usize>)>,
    /// All frames of its file are steps.
    pub(super) takes_all: bool,
    /// The column whose different numbers are steps, and its place in bytes of the scene file.
    pub(super) time: Option<(ColumnRef, Range<usize>)>,
    /// The lines before the table.
    pub(super) skip_lines: u64,
    pub(super) timeline: Timeline,
    pub(crate) request: Request,
    pub(super) scale: Scale,
    pub(super) placement: Placement,
    /// The place of `radii`, in bytes of the scene file.
    pub(super) radii_place: Range<usize>,
    /// The place of the first field about the cell of the table.
    pub(super) periodic_place: Range<usize>,
}

impl Cloud {
    /// The cloud that the file describes; `None` where a fault was reported.
    pub(crate) fn new(cloud: &file::Cloud, material: MaterialId) -> Option<Self> {
        let columns = cloud.columns.value.as_ref()?;
        let own_value = optional(&cloud.value, |value| Some(value.clone()))?;
        let value = optional(&columns.value, |value| Some(value.clone()))?;
        if let (Some(own), Some(_)) = (&cloud.value, &columns.value) {
            let message = "expected `value` in the cloud or in `columns`, found both";
            return refuse(own.place.clone(), message);
        }
        let coloring = optional(&cloud.color, |coloring| Some(*coloring))?;
        let of_scale = [
            cloud.colormap.as_ref().map(|colormap| &colormap.place),
            cloud.color_scale.as_ref().map(|scale| &scale.place),
            cloud.range.as_ref().map(|range| &range.place),
        ];
        let of_scale = of_scale.into_iter().flatten().next();
        let of_palette = cloud.palette.as_ref().map(|palette| &palette.place);
        let of_value = cloud.value.as_ref().map(|value| &value.place);
        let of_value = of_value.or(columns.value.as_ref().map(|value| &value.place));
        // Without a scale of numbers the table's columns decide.
        let implied = of_scale.map(|_| Coloring::Value);
        let place = of_scale.or(of_palette).or(of_value);
        if let (Some(place), Some(coloring)) = (place, coloring) {
            let (known, wanted): (&[Coloring], _) = match (of_scale, of_palette) {
                (Some(_), _) => (&[Coloring::Value], Coloring::Value),
                (None, Some(_)) => (&[Coloring::Category, Coloring::Element], Coloring::Category),
                (None, None) => (&[Coloring::Value, Coloring::Category], Coloring::Value),
            };
            if !known.contains(&coloring) {
                let message = format!(
                    "expected `color: {wanted:?}` together with this, found `color: {coloring:?}`"
                );
                return refuse(place.clone(), message);
            }
        }
        let (radii, own_radii) = match cloud.radii.value.as_ref()? {
            ElementRadii::Kind(kind) => (*kind, Vec::new()),
            ElementRadii::Own(own) => {
                let own = own.once("element")?;
                (
                    Radii::default(),
                    own.into_iter()
                        .map(|(name, radius)| (name, radius.0))
                        .collect(),
                )
            }
        };
        let others = optional(&cloud.others, |others| {
            Some((others.radius.get()?.0, others.color.get()?.0))
        })?;
        let (radius_column, radius_law) = radius_column(columns)?;
        let scale = Scale::new(cloud, others.map(|(_, color)| color))?;
        let column =
            |column: &Option<Placed<_>>| optional(column, |column| Some(Clone::clone(column)));
        Some(Self {
            name: cloud.file.value.as_ref()?.0.clone(),
            place: cloud.file.place.clone(),
            material,
            topology: topology(cloud)?,
            takes_all: cloud.frames.get()? == TakenFrames::All,
            time: time(cloud)?,
            skip_lines: u64::from(cloud.skip_lines.get()?.0),
            timeline: Timeline {
                range: optional(&cloud.steps, |range| Some(range.first..=range.last))?,
                every: cloud.every.get().map(|Every(every)| every)?,
                speed: cloud.speed.get().map(|Speed(speed)| speed)?,
                end: cloud.end.get()?,
            },
            request: Request {
                radius: optional(&cloud.radius, |radius| Some(radius.0))?,
                radii,
                own_radii,
                other_radius: others.map(|(radius, _)| radius),
                palette: scale.palette_names(),
                columns: crate::table::Columns {
                    position: [
                        column(&columns.x)?,
                        column(&columns.y)?,
                        column(&columns.z)?,
                    ],
                    radius: radius_column,
                    element: column(&columns.element)?,
                    radius_law,
                    radius_scale: optional(&columns.radius_scale, |scale| Some(scale.0))?,
                },
                coloring: coloring.or(implied),
                value: own_value.or(value),
                missing: cloud.missing.get()?,
                keep: filters(&cloud.keep)?,
                periodic: periodic(cloud)?,
                has_places: false,
            },
            scale,
            radii_place: cloud.radii.place.clone(),
            periodic_place: periodic_place(cloud),
            placement: Placement {
                is_centered: cloud.center.get().map(|Flag(flag)| flag)?,
                middle: None,
                is_right_handed: optional(&cloud.right_handed, |Flag(flag)| Some(*flag))?,
                up: cloud.up.get()?,
                scale: cloud.scale.get()?.0,
                turn: turn(cloud.rotate_degrees.get()?.0),
                position: cloud.position.get()?.0,
            },
        })
    }
}

/// The cells that are shown.
fn periodic(cloud: &file::Cloud) -> Option<Periodic> {
    let flag = |flag: &Placed<Flag>| flag.get().map(|Flag(flag)| flag);
    let periodic = Periodic {
        repeat: cloud.repeat.get()?.0,
        wraps: flag(&cloud.wrap)?,
        unwraps: flag(&cloud.unwrap)?,
        shows_edges: flag(&cloud.edges)?,
    };
    if periodic.wraps && periodic.unwraps {
        let message = "expected `wrap` or `unwrap`, found both";
        return refuse(cloud.unwrap.place.clone(), message);
    }
    Some(periodic)
}

/// The place of the first field about the cell of the table, which is empty if there is none.
fn periodic_place(cloud: &file::Cloud) -> Range<usize> {
    let flags = [&cloud.wrap, &cloud.unwrap, &cloud.edges];
    let is_on = |flag: &&&Placed<Flag>| flag.get().is_some_and(|Flag(is_on)| is_on);
    let is_repeated = cloud
        .repeat
        .get()
        .is_some_and(|Repeat(counts)| counts != [1; 3]);
    let place = match is_repeated {
        true => Some(&cloud.repeat.place),
        false => flags.iter().find(is_on).map(|flag| &flag.place),
    };
    place.cloned().unwrap_or_default()
}

/// The name of the table that tells the atoms of a trajectory, and its place.
fn topology(cloud: &file::Cloud) -> Option<Option<(String, Range<usize>)>> {
    let Some(topology) = &cloud.topology else {
        return Some(None);
    };
    if let Some(time) = &cloud.time {
        let message =
            "expected `topology` or `time`, found both: the frames of a trajectory are its steps";
        return refuse(time.place.clone(), message);
    }
    let name = topology.value.as_ref()?.0.clone();
    Some(Some((name, topology.place.clone())))
}

/// The column whose different numbers are steps, and its place.
fn time(cloud: &file::Cloud) -> Option<Option<(ColumnRef, Range<usize>)>> {
    let Some(time) = &cloud.time else {
        return Some(None);
    };
    if cloud.frames.get()? == TakenFrames::All {
        let message = "expected `frames: All` or `time`, found both";
        return refuse(time.place.clone(), message);
    }
    match time.value.clone()? {
        ColumnRef::Constant(_) => {
            let expected = "the name of a column in quotation marks, or its number from 1";
            refuse(
                time.place.clone(),
                format!("expected {expected}, found a constant"),
            )
        }
        column => Some(Some((column, time.place.clone()))),
    }
}

/// The column of radii, and the way from its numbers to them.
fn radius_column(columns: &file::Columns) -> Option<(Option<ColumnRef>, RadiusLaw)> {
    let law = optional(&columns.radius_law, |law| match law {
        file::RadiusLaw::Linear => Some(RadiusLaw::Linear),
        file::RadiusLaw::Power(power) => Some(RadiusLaw::Power {
            factor: 1.0,
            exponent: power.get()?.0,
            offset: 0.0,
        }),
        file::RadiusLaw::Exponential(factor) => Some(RadiusLaw::Exponential(factor.get()?.0)),
    })?;
    let chosen = optional(&columns.radius, |chosen| Some(chosen.clone()))?;
    match (chosen, &columns.radius_law) {
        (Some(RadiusColumn::Power { .. }), Some(law)) => {
            let message = "expected `radius: Power(…)` or `radius_law`, found both";
            refuse(law.place.clone(), message)
        }
        (
            Some(RadiusColumn::Power {
                column,
                factor,
                exponent,
                offset,
            }),
            None,
        ) => {
            let law = RadiusLaw::Power {
                factor,
                exponent,
                offset,
            };
            Some((Some(column), law))
        }
        (Some(RadiusColumn::Column(column)), _) => Some((Some(column), law.unwrap_or_default())),
        (None, _) => Some((None, law.unwrap_or_default())),
    }
}

/// The conditions on rows that are kept.
fn filters(keep: &[Placed<Keep>]) -> Option<Vec<Filter>> {
    if let Some(keep) = keep.get(MOST_FILTERS) {
        let message = format!("expected at most {MOST_FILTERS} conditions, found more");
        return refuse(keep.place.clone(), message);
    }
    keep.iter().map(filter).collect()
}

fn filter(keep: &Placed<Keep>) -> Option<Filter> {
    let Keep(column, test) = keep.value.as_ref()?;
    let place = test.place.clone();
    let test = match test.value.as_ref()? {
        file::Test::Is(wanted) => match wanted.value.as_ref()? {
            file::Wanted::Number(number) => Test::Is(*number),
            file::Wanted::Text(text) => Test::IsText(text.clone()),
        },
        file::Test::Between(low, high) => {
            let (low, high) = (low.get()?.0, high.get()?.0);
            if low > high {
                let found = format!("`Between({low}, {high})`");
                let message =
                    format!("expected a low number that is not above the high one, found {found}");
                return refuse(place, message);
            }
            Test::Between(low, high)
        }
        file::Test::Every(step) => Test::Every(step.get()?.0),
    };
    Some(Filter {
        column: column.value.clone()?,
        test,
    })
}
