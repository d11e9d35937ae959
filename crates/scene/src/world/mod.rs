//! The world of a scene file: materials, lights, spheres, and those of tables.

mod assemble;
mod cloud;
mod lens;
mod materials;
mod placement;
mod series;

pub(crate) use assemble::world;
pub use cloud::Progress;
pub(crate) use cloud::{
    Cloud, CloudError, FIRST_OF_SEVERAL, Learned, OpenCloud, Oversight, Scale, Step,
};
pub use cloud::{ColumnContents, ColumnSummary, ScaleKind};
pub(crate) use lens::{lens, lens_as_written};
pub use series::StepKey;
pub(crate) use series::{Part, Series};
