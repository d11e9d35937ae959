//! The sides of spheres that the plane cuts in which parallel rays begin.

/// The view of a cell in which some rays begin inside of a sphere.
///
/// It is the sum of what rays see that begin outside, and of what those see that begin inside. Both may be integrated
/// over the whole cell, as if all of its rays did, if the cap within which rays begin inside hides the first, and if
/// the second less what it is behind that cap is left. Of rays that miss the sphere, whose contour may lie in the cell, the
/// latter two see the same, which cancels.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum CutSide {
    /// The view of rays that begin outside, behind the cap.
    OuterBehindCap,
    /// The view of rays that begin inside, wherever they are in the cell.
    Inner,
    /// The same where the cap does not hide it, and the cap.
    InnerBehindCap,
}

impl CutSide {
    pub(super) fn is_inner(self) -> bool {
        self != Self::OuterBehindCap
    }
}
