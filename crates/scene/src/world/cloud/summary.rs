//! The contents of the columns of a table.

use glam::DVec3;

use super::CloudError;
use super::open::{OpenCloud, UNWATCHED};
use super::step_rows::gone;
use super::steps::Steps;
use crate::table::{
    Coloring, ColumnRef, Columns, Missing, Paint, Periodic, Request, TableError, Value, unit,
};

/// The most columns that are summed up: each is read on its own.
const MOST_SUMMARIES: usize = 64;

/// A column of a table.
///
/// # Example
/// ```
/// use marbles_scene::Scene;
///
/// # let folder = std::env::temp_dir().join(format!("marbles ColumnSummary {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `balls.csv`: two balls, with the masses 2.5 and 7.5
/// # std::fs::write(folder.join("balls.csv"), "x,y,z,radius,mass\n0,0,0,1,2.5\n3,0,0,1,7.5\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Frame(),
///     clouds: [(file: "balls.csv")])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// // …
/// let columns = scene.columns(0)?;
/// let names: Vec<_> = columns.iter().map(|column| column.name.as_str()).collect();
/// assert_eq!(names, ["x", "y", "z", "radius", "mass"]);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnSummary {
    /// The name, or the number from 1 if the table has no names.
    pub name: String,
    /// The unit that the table states after the name.
    pub unit: Option<String>,
    /// Its contents.
    pub contents: ColumnContents,
}

/// The contents of a column.
///
/// # Example
/// ```
/// use marbles_scene::{ColumnContents, Scene};
///
/// # let folder = std::env::temp_dir().join(format!("marbles ColumnContents {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `balls.csv`: two balls, with the masses 2.5 and 7.5
/// # std::fs::write(folder.join("balls.csv"), "x,y,z,radius,mass\n0,0,0,1,2.5\n3,0,0,1,7.5\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Frame(),
///     clouds: [(file: "balls.csv")])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// // …
/// match scene.columns(0)?[4].contents {
///     ColumnContents::Numbers { low, high, missing, .. } => {
///         assert_eq!((low, high, missing), (2.5, 7.5, 0));
///     }
///     ref other => panic!("masses are numbers, found {other:?}"),
/// }
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnContents {
    /// Numbers.
    Numbers {
        /// The smallest number; infinite if there are none.
        low: f64,
        /// The largest number; minus infinity if there are none.
        high: f64,
        /// The number of rows without a number.
        missing: usize,
        /// True if they are times, in seconds since the start of 1970.
        are_times: bool,
    },
    /// Texts.
    Texts {
        /// The number of different texts.
        count: usize,
        /// Some of them, in the order of the table.
        examples: Vec<String>,
    },
    /// Bytes that are neither.
    Other,
}

impl ColumnContents {
    fn of_numbers(values: &[f64], are_times: bool) -> Self {
        let present = || values.iter().copied().filter(|value| !value.is_nan());
        Self::Numbers {
            low: present().fold(f64::INFINITY, f64::min),
            high: present().fold(f64::NEG_INFINITY, f64::max),
            missing: values.len() - present().count(),
            are_times,
        }
    }

    fn of_texts(paint: &Paint) -> Self {
        const EXAMPLES: usize = 4;
        match paint {
            Paint::Categories(categories) => Self::Texts {
                count: categories.names.len(),
                examples: categories.names.iter().take(EXAMPLES).cloned().collect(),
            },
            _ => Self::Other,
        }
    }
}

impl OpenCloud {
    /// The contents of each column of the first step.
    pub(crate) fn columns(&self) -> Result<Vec<ColumnSummary>, CloudError> {
        let request = |column: usize, coloring| Request {
            radius: Some(1.0),
            value: Some(Value::Column(ColumnRef::Number(column + 1))),
            coloring: Some(coloring),
            missing: Missing::Color(DVec3::ZERO),
            keep: Vec::new(),
            periodic: Periodic::default(),
            // Of other columns nothing is looked at.
            columns: Columns {
                position: [(); 3].map(|()| Some(ColumnRef::Constant(0.0))),
                ..self.cloud.request.columns.clone()
            },
            ..self.cloud.request.clone()
        };
        let path = self.path(0);
        let refused = |error| self.refuse_table(&path, error);
        let first = |request: &Request| {
            let mut frames = self.open_file(&path, UNWATCHED)?;
            self.observed.check(&path, &frames)?;
            if let Steps::Frames(places) = &self.steps {
                frames.go_to(places[0])?;
            }
            frames.read(request)?.ok_or_else(gone)
        };
        let (rows, _) = self.rows(0, UNWATCHED)?;
        let names = rows.columns.iter().enumerate().take(MOST_SUMMARIES);
        let summary = |(column, name): (usize, &String)| {
            let unit = unit(name).map(str::to_owned);
            let name = name.clone();
            let is_element = rows.element_column == Some(column);
            let coloring = match is_element {
                true => Coloring::Category,
                false => Coloring::Value,
            };
            let found = first(&request(column, coloring));
            let contents = match found.map(|rows| (rows.paint, rows.has_times)) {
                Ok((paint @ Paint::Categories(_), _)) => ColumnContents::of_texts(&paint),
                Ok((Paint::Values(values), are_times)) => {
                    ColumnContents::of_numbers(&values, are_times)
                }
                Ok(_) => ColumnContents::Other,
                Err(TableError::Fault(_)) => match first(&request(column, Coloring::Category)) {
                    Ok(rows) => ColumnContents::of_texts(&rows.paint),
                    // Bytes that are neither.
                    Err(TableError::Fault(_)) => ColumnContents::Other,
                    Err(error) => return Err(error),
                },
                Err(error) => return Err(error),
            };
            Ok(ColumnSummary {
                name,
                unit,
                contents,
            })
        };
        names
            .map(summary)
            .collect::<Result<_, _>>()
            .map_err(refused)
    }
}
