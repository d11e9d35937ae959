pub(crate) mod failure;
pub(crate) mod memory;
pub(crate) mod numbers;
pub(crate) mod region;
pub(crate) mod status;
pub(crate) mod threads;
