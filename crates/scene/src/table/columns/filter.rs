//! The rows that are kept.

use crate::text::show;

/// A condition on a value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Test {
    /// It is this number.
    Is(f64),
    /// It is this text, in upper or lower case as it stands there.
    IsText(String),
    /// It lies between these, or is one of them.
    Between(f64, f64),
    /// It is a multiple of this.
    Every(f64),
}

impl Test {
    /// Says whether a number meets the condition; none meets one on a text.
    #[inline(always)]
    pub(crate) fn holds(&self, number: f64) -> bool {
        match self {
            Self::Is(wanted) => number == *wanted,
            Self::IsText(_) => false,
            Self::Between(low, high) => (*low..=*high).contains(&number),
            Self::Every(step) => number % step == 0.0,
        }
    }

    /// The text that is wanted, if it is one.
    #[inline(always)]
    pub(crate) fn text(&self) -> Option<&str> {
        match self {
            Self::IsText(text) => Some(text),
            _ => None,
        }
    }

    /// The condition as the scene file writes it.
    pub(crate) fn written(&self) -> String {
        match self {
            Self::Is(number) => format!("Is({number})"),
            Self::IsText(text) => format!("Is({})", show(&format!("{text:?}"))),
            Self::Between(low, high) => format!("Between({low}, {high})"),
            Self::Every(step) => format!("Every({step})"),
        }
    }
}
