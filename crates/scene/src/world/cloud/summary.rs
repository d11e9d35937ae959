//! The contents of the columns of a table.

use std::path::Path;
use std::sync::Arc;

use super::CloudError;
use super::open::{OpenCloud, UNWATCHED};
use super::step_rows::gone;
use super::steps::Steps;
use crate::table::{
    Coloring, ColumnRef, Columns, Contents, Paint, Periodic, Request, TableError, unit,
};

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
    fn of(contents: Contents) -> Self {
        const EXAMPLES: usize = 4;
        match contents {
            Contents::Numbers(numbers) => Self::Numbers {
                low: numbers.low,
                high: numbers.high,
                missing: usize::try_from(numbers.missing).unwrap_or(usize::MAX),
                are_times: numbers.are_times,
            },
            Contents::Texts(mut texts) => {
                let count = texts.names.len();
                texts.names.truncate(EXAMPLES);
                Self::Texts {
                    count,
                    examples: texts.names,
                }
            }
            Contents::NoNumbers | Contents::Other => Self::Other,
        }
    }
}

impl OpenCloud {
    /// The contents of each column of the first step.
    ///
    /// The table is read once, and once more if a column has texts.
    pub(crate) fn columns(&self) -> Result<Vec<ColumnSummary>, CloudError> {
        let path = self.path(0);
        let (names, contents) = match self.contents(&path) {
            // A row that is not kept may have a fault.
            Err(TableError::Fault(_)) => {
                let (rows, _) = self.rows(0, UNWATCHED)?;
                let others = vec![Contents::Other; rows.columns.len()];
                (rows.columns, others)
            }
            read => read.map_err(|error| self.refuse_table(&path, error))?,
        };
        let columns = names.iter().zip(contents);
        Ok(columns
            .map(|(name, contents)| ColumnSummary {
                name: name.clone(),
                unit: unit(name).map(str::to_owned),
                contents: ColumnContents::of(contents),
            })
            .collect())
    }

    /// The names of the columns, and what they hold.
    fn contents(&self, path: &Path) -> Result<(Arc<Vec<String>>, Vec<Contents>), TableError> {
        let (names, mut contents) = self.contents_with(path, 0)?;
        let is_text = |contents: &Contents| *contents == Contents::NoNumbers;
        let texts = (0..).zip(&contents);
        let texts = texts.filter(|(_, contents)| is_text(contents));
        let texts = texts.fold(0, |texts, (column, _)| texts | 1 << column);
        if texts != 0 {
            let (_, found) = self.contents_with(path, texts)?;
            for (contents, found) in contents.iter_mut().zip(found) {
                if is_text(contents) {
                    *contents = found;
                }
            }
        }
        Ok((names, contents))
    }

    /// The same, where columns whose bit is set in `texts` have texts.
    fn contents_with(
        &self,
        path: &Path,
        texts: u64,
    ) -> Result<(Arc<Vec<String>>, Vec<Contents>), TableError> {
        let request = Request {
            radius: Some(1.0),
            value: None,
            coloring: Some(Coloring::Contents(texts)),
            keep: Vec::new(),
            periodic: Periodic::default(),
            // Of positions nothing is looked at.
            columns: Columns {
                position: [(); 3].map(|()| Some(ColumnRef::Constant(0.0))),
                ..self.cloud.request.columns.clone()
            },
            ..self.cloud.request.clone()
        };
        let mut frames = self.open_file(path, UNWATCHED)?;
        self.observed.check(path, &frames)?;
        if let Steps::Frames(places) = &self.steps {
            frames.go_to(places[0])?;
        }
        let rows = frames.read(&request)?.ok_or_else(gone)?;
        Ok(match rows.paint {
            Paint::Contents(contents) => (rows.columns, contents),
            _ => (rows.columns, Vec::new()),
        })
    }
}
