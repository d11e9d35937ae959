//! The caller's say in a rendering.

use std::ops::ControlFlow;

use thiserror::Error;

/// Is told of pixels that are done, of none now and then; when it breaks the work ends.
pub(crate) type Progress<'caller> = dyn Fn(u64) -> ControlFlow<()> + Sync + 'caller;

/// The caller of a rendering asked it to stop.
#[derive(Clone, Copy, Debug, Eq, Error, PartialEq)]
#[error("the rendering was stopped")]
pub struct Cancelled;
