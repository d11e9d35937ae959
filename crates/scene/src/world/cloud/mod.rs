//! Clouds: the spheres of tables.

mod coloring;
mod explain;
mod observed;
mod open;
mod oversights;
mod pattern;
mod remarked;
mod settings;
mod step;
mod step_rows;
mod steps;
mod summary;
mod times;

use std::path::{Path, PathBuf};

pub use coloring::ScaleKind;
pub(crate) use coloring::{Learned, Scale};
pub(crate) use open::{FIRST_OF_SEVERAL, OpenCloud};
pub(crate) use remarked::Oversight;
pub(crate) use settings::Cloud;
pub(crate) use step::Step;
pub use summary::{ColumnContents, ColumnSummary};

use crate::text::{Fault, LocatedFault};

/// The reason for which a table was refused.
#[derive(Debug)]
pub(crate) enum CloudError {
    /// Something is wrong in what the scene file says of it.
    Scene(Fault),
    /// Something is wrong in the table with this path.
    Table(PathBuf, LocatedFault),
    /// A table is not the one any more that was read before.
    Changed(Fault),
}

impl CloudError {
    /// The message without the place.
    pub(crate) fn message(&self) -> String {
        match self {
            Self::Scene(fault) | Self::Changed(fault) => fault.message.clone(),
            Self::Table(_, fault) => fault.message.clone(),
        }
    }
}

/// The state of reading a table.
///
/// # Example
/// ```
/// use std::sync::atomic::{AtomicU64, Ordering};
///
/// use marbles_scene::{Progress, Scene};
///
/// # let folder = std::env::temp_dir().join(format!("marbles Progress {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let file = folder.join("scene.ron");
/// # std::fs::write(&file, r#"(image: (width: 64, height: 48), lens: Fov(40), camera: Free(),
/// #     clouds: [(file: "balls.csv")])"#)?;
/// # let rows = "0,0,5,1\n".repeat(1_000_000);
/// # std::fs::write(folder.join("balls.csv"), format!("x,y,z,radius\n{rows}"))?;
/// // A scene with a table of 8 MB.
/// let most = AtomicU64::new(0);
/// let watch = |progress: Progress<'_>| {
///     assert!(progress.read <= progress.size);
///     most.fetch_max(progress.read, Ordering::Relaxed);
/// };
/// let scene = Scene::load_with(&file, &[], &watch)?;
/// assert!(most.into_inner() > 1_000_000);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Progress<'scene> {
    /// The table as the scene file names it, or the file of one of its steps.
    pub table: &'scene Path,
    /// Bytes that were read.
    pub read: u64,
    /// Bytes of the whole file; 0 if this is not known.
    pub size: u64,
}
