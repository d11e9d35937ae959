//! Failures and exit codes, sizes and parts of pictures, formatted numbers.

pub(crate) mod failure;
pub(crate) mod layout;
pub(crate) mod memory;
pub(crate) mod numbers;
pub(crate) mod region;
pub(crate) mod scene_name;
pub(crate) mod shown;
pub(crate) mod size;
pub(crate) mod status;
pub(crate) mod threads;
