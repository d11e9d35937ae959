//! Names of files as messages show them.

use std::path::Path;

use marbles_scene::harmless;

/// Names that messages can show.
pub(crate) trait Shown {
    /// The name, with nothing in it that does something to a terminal, or ends the line.
    fn shown(&self) -> String;
}

impl Shown for Path {
    fn shown(&self) -> String {
        harmless(&self.to_string_lossy())
    }
}
