//! The purposes of a column, of which it may have several.

use super::slot::Slot;

/// The purposes of a column.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum Uses {
    /// It is passed over.
    #[default]
    None,
    One(Slot),
    Several(Vec<Slot>),
}

impl Uses {
    /// The purposes, one after another.
    #[inline(always)]
    pub(crate) fn slots(&self) -> &[Slot] {
        match self {
            Self::None => &[],
            Self::One(slot) => std::slice::from_ref(slot),
            Self::Several(slots) => slots,
        }
    }
}
