//! Edges in boxes, and what they may hide from each other.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

/// Edges in boxes: the sum and the largest of what they may hide from the others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edges<S: Simd> {
    pub(super) sum: f64x8<S>,
    pub(super) most: f64x8<S>,
    /// What edges that are no lines make wrong.
    pub(super) doubt: f64x8<S>,
}

impl<S: Simd> Edges<S> {
    #[inline(always)]
    pub(super) fn none(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        Self {
            sum: zero,
            most: zero,
            doubt: zero,
        }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, ambiguity: f64x8<S>, doubt: f64x8<S>) {
        self.sum += ambiguity;
        self.most = self.most.max(ambiguity);
        self.doubt += doubt;
    }
}
