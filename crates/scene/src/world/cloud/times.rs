//! The steps of one table whose rows tell their times.

use std::path::Path;

use super::open::{OpenCloud, UNWATCHED};
use crate::table::{Coloring, ColumnRef, Columns, Filter, Paint, Request, TableError, Test, Value};

impl OpenCloud {
    /// The different numbers in a column of the rows that are kept, in rising order.
    pub(super) fn times(&self, path: &Path, column: &ColumnRef) -> Result<Vec<f64>, TableError> {
        let request = Request {
            radius: Some(1.0),
            coloring: Some(Coloring::Distinct),
            value: Some(Value::Column(column.clone())),
            columns: Columns {
                position: [(); 3].map(|()| Some(ColumnRef::Constant(0.0))),
                ..Columns::default()
            },
            keep: self.cloud.request.keep.clone(),
            ..Request::default()
        };
        let (rows, _) = self.first_frame(path, &request, UNWATCHED)?;
        Ok(match rows.paint {
            Paint::Distinct(times) => times.sorted(),
            _ => Vec::new(),
        })
    }

    /// The request for the rows that have this number in the column of times.
    pub(super) fn request_at(&self, column: &ColumnRef, time: f64) -> Request {
        let mut request = self.cloud.request.clone();
        request.keep.push(Filter {
            column: column.clone(),
            test: Test::Is(time),
        });
        request
    }
}
