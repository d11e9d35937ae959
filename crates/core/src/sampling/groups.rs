//! The balls that eight rays see.

use super::tile_balls::TileBall;
use crate::numeric::lanes::LANES;

/// Rays that see the same ball, as bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group<'tile> {
    pub(super) ball: &'tile TileBall,
    pub(super) lanes: u64,
}

/// The balls that eight rays see, each once. Apart from [`Sight`], which moves.
pub(super) struct Groups<'tile> {
    pub(super) list: [Group<'tile>; LANES],
    pub(super) count: usize,
}

impl<'tile> Groups<'tile> {
    /// No groups, and a ball for their places.
    pub(super) fn new(ball: &'tile TileBall) -> Self {
        Self {
            list: [Group { ball, lanes: 0 }; LANES],
            count: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a ray that sees a ball.
    pub(super) fn add(&mut self, ball: &'tile TileBall, lane: usize) {
        let mut known = self.list[..self.count].iter_mut();
        if let Some(group) = known.find(|group| group.ball.index() == ball.index()) {
            group.lanes |= 1 << lane;
            return;
        }
        self.list[self.count] = Group {
            ball,
            lanes: 1 << lane,
        };
        self.count += 1;
    }

    pub(super) fn as_slice(&self) -> &[Group<'tile>] {
        &self.list[..self.count]
    }
}
