pub(crate) mod console;
pub(crate) mod interrupt;
pub(crate) mod progress;
