//! Memory that is asked for before it is needed, so that an error tells what it was for. Where smaller pieces cannot be had,
//! `terminal/abort.rs` ends the process.

use marbles_core::{Renderer, World};

use super::failure::Failure;

/// An empty vector with room for `count` values.
pub(crate) fn reserve<T>(count: usize) -> Result<Vec<T>, String> {
    let mut values = Vec::new();
    match values.try_reserve_exact(count) {
        Ok(()) => Ok(values),
        Err(_) => Err(format!(
            "there is not enough memory for {:.1} MB",
            count as f64 * size_of::<T>() as f64 / 1e6
        )),
    }
}

/// Refuses a world that cannot be prepared for want of memory.
pub(crate) fn require_for(world: &World) -> Result<(), Failure> {
    let work = format!("preparing {} spheres needs", world.spheres().len());
    require(Renderer::memory_to_prepare(world), &work)
}

/// Returns whether so many bytes can be had in one piece.
///
/// Systems that promise more memory than they have still refuse a piece that is larger than all of it.
pub(crate) fn is_available(bytes: u64) -> bool {
    usize::try_from(bytes).is_ok_and(|bytes| reserve::<u8>(bytes).is_ok())
}

/// Refuses what certainly needs more memory than there is, so many bytes and all that is small beside
/// them; `work` is the subject of the message and its verb.
pub(crate) fn require(bytes: u64, work: &str) -> Result<(), Failure> {
    /// Threads and other small things: glibc reserves this many addresses for a thread that
    /// allocates, though it uses few of them.
    const OTHERS: u64 = 1 << 27;
    let bytes = bytes.saturating_add(OTHERS);
    if is_available(bytes) {
        return Ok(());
    }
    let gigabytes = bytes as f64 / 1e9;
    let message = format!("{work} {gigabytes:.1} GB of memory, more than is available");
    Err(Failure::Work(message))
}
