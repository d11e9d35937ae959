//! Checks that large amounts of memory are available before they are needed, so that an error can name the purpose. If
//! a small allocation fails, `terminal/abort.rs` ends the process.

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

/// Refuses a world if there is not enough memory to prepare it.
pub(crate) fn require_for(world: &World) -> Result<(), Failure> {
    let work = format!("preparing {} spheres needs", world.spheres().len());
    require(Renderer::memory_needed(world), &work)
}

/// Returns whether a number of bytes can be allocated in one piece.
///
/// Even systems that overcommit memory refuse a piece that is larger than all of it.
pub(crate) fn is_available(bytes: u64) -> bool {
    usize::try_from(bytes).is_ok_and(|bytes| reserve::<u8>(bytes).is_ok())
}

/// Returns an error if the memory is certainly not enough for a number of bytes and some small overhead. `work` is the
/// subject and the verb of the message.
pub(crate) fn require(bytes: u64, work: &str) -> Result<(), Failure> {
    /// For threads and other small things: glibc reserves this much address space for a thread that allocates, though
    /// the thread uses little of it.
    const OTHERS: u64 = 1 << 27;
    let bytes = bytes.saturating_add(OTHERS);
    if is_available(bytes) {
        return Ok(());
    }
    let gigabytes = bytes as f64 / 1e9;
    let message = format!("{work} {gigabytes:.1} GB of memory, more than is available");
    Err(Failure::Work(message))
}
