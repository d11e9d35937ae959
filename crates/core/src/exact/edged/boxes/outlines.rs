//! Outlines in boxes: a sphere with an outline is two contours, one of all of it and one of its face.
//!
//! With the area A of all that is seen of a sphere, the area F of its face and the light L of that, and the color C of
//! the outline, the sum is A C + F (L − C). Hidden and cut by others are both in the same way.

/// The outline of a contour.
#[derive(Clone, Copy, Debug)]
pub(super) enum Line {
    /// None is seen.
    None,
    /// Nothing else is seen.
    All,
    /// It is seen beside a face, which follows, in some of the boxes, bit by bit.
    Beside(u8),
    /// The contour is that of a face.
    Face,
}

impl Line {
    #[inline(always)]
    pub(super) fn is_face(self) -> bool {
        matches!(self, Self::Face)
    }

    /// Whether an edge of an outline is within the contour, or is the contour.
    #[inline(always)]
    pub(super) fn divides(self) -> bool {
        matches!(self, Self::Beside(_) | Self::Face)
    }

    /// Whether the contour is that of a sphere with an outline.
    #[inline(always)]
    pub(super) fn is_outline(self) -> bool {
        matches!(self, Self::All | Self::Beside(_))
    }
}
