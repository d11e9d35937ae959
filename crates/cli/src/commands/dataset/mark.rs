//! The mark that identifies a data set written by marbles.
//!
//! Most files of a data set have no room for a mark. The mask has, and is written before all others. If it is not
//! marked, all files of the folder belong to somebody else.

use std::path::{Path, PathBuf};

use crate::base::failure::Failure;
use crate::formats::png::stored::text;
use crate::formats::png::write::Text;

/// The file that is marked.
pub(super) const MASK: &str = "mask.png";

/// The keyword of the mark. Its text is the name of the layout.
const KEYWORD: &str = "Data set of marbles";

/// The mark of a layout.
pub(super) fn of(layout: &str) -> Text {
    (KEYWORD, layout.to_owned())
}

/// Refuses to replace any of `files`, unless the folder contains a data set of this layout written by marbles.
pub(super) fn refuse_files_of_others(
    folder: &Path,
    layout: &str,
    files: impl IntoIterator<Item = PathBuf>,
) -> Result<(), Failure> {
    let found = text(&folder.join(MASK), KEYWORD);
    if found.as_deref() == Some(layout) {
        return Ok(());
    }
    let mut files = files.into_iter();
    let Some(file) = files.find(|file| file.symlink_metadata().is_ok()) else {
        return Ok(());
    };
    let owner = match found {
        Some(other) => format!("which belongs to a data set of the layout {other}"),
        None => "which `marbles dataset` did not write".to_owned(),
    };
    let why = format!(
        "the data set would replace this file, {owner}: expected a folder without such a file, or with a data set \
         of the layout {layout} written by `marbles dataset`"
    );
    Err(Failure::unusable(&file, &why))
}
