//! Memory of normals that the lights of a row of pixels have in common.

use crate::exact::classify::contents::Contents;
use crate::exact::interior::mean_normals::MeanNormals;
use crate::exact::part::Part;
use crate::model::roughness::PixelKey;

/// The data that the pictures of a row of pixels, under one light each, have in common.
#[derive(Clone, Debug, Default)]
pub(crate) struct Normals {
    /// The mean normals of pixels that a sphere fills.
    pub(crate) filled: Vec<MeanNormals>,
    /// The pixels with a contour, the tolerances that were asked for, and the integrals, where there are any.
    pub(super) outlined: Vec<(PixelKey, f64, Option<Part>)>,
    pub(super) contents: Contents,
}

impl Normals {
    /// Forgets a row.
    pub(crate) fn clear(&mut self) {
        self.filled.clear();
        self.outlined.clear();
    }
}
