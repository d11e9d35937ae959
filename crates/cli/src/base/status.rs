//! Exit codes of the process.

/// All was done, and every pixel met the tolerance.
pub(crate) const SUCCESS: u8 = 0;
/// Something could not be done, or some pixel did not meet the tolerance, or two pictures differ.
pub(crate) const FAILURE: u8 = 1;
/// The command line, the scene file or a picture to read is wrong.
pub(crate) const REFUSED: u8 = 2;
/// The user ended the work; 128 and the number of the signal, as shells have it.
pub(crate) const INTERRUPTED: u8 = 130;
