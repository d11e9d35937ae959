pub(crate) mod place;
pub(crate) mod temporary;
