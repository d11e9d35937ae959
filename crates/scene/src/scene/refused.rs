//! The errors of clouds.

use std::ops::Range;
use std::path::Path;

use crate::report::SceneError;
use crate::world::{CloudError, Series};

/// The error of a cloud of a series.
pub(super) fn explain(series: &Series, (place, error): (Range<usize>, CloudError)) -> SceneError {
    let (path, text) = &series.source;
    refused(path, text, (place, error))
}

/// The error of the cloud at this place of a scene file.
pub(super) fn refused(
    path: &Path,
    text: &str,
    (place, error): (Range<usize>, CloudError),
) -> SceneError {
    match error {
        CloudError::Scene(fault) => SceneError::refused(path, text, vec![fault]),
        CloudError::Changed(fault) => {
            SceneError::refused(path, text, vec![fault]).of_changed_table()
        }
        CloudError::Table(table, fault) => {
            SceneError::in_table(&table, fault, (path, text, &place))
        }
    }
}
