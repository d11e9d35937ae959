//! What a moving camera sees at single moments.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use crate::model::exposure::Motion;
use crate::model::exposure::view_at;
use crate::model::view::View;
use crate::picture::pixel::Method;
use crate::picture::tile::Tile;
use crate::search::Visibility;
use crate::search::seen::Seen;

/// What is seen at a moment.
#[derive(Debug)]
pub(super) struct Instant<'world> {
    pub(super) view: View,
    pub(super) seen: Seen<'world>,
}

/// What is seen at the moments at which pixels are looked at, found out when it is first needed.
///
/// As much as there is memory for is kept; the rest is found out again for each row of tiles.
#[derive(Debug)]
pub(crate) struct Instants<'world> {
    pub(super) visibility: &'world Visibility<'world>,
    pub(super) view: View,
    pub(super) motion: Arc<dyn Motion + 'world>,
    method: Method,
    kept: Vec<OnceLock<Vec<Instant<'world>>>>,
    /// The memory that these take, in bytes.
    bytes: AtomicUsize,
}

/// The memory for what is kept, in bytes.
const ROOM: usize = 1 << 29;

/// No more groups of moments are kept.
const MOST_KEPT: usize = 1 << 12;

impl<'world> Instants<'world> {
    /// For pictures of `view`, whose camera moves so, by this method.
    pub(crate) fn new(
        visibility: &'world Visibility<'world>,
        view: &View,
        motion: Arc<dyn Motion + 'world>,
        method: Method,
    ) -> Self {
        Self {
            visibility,
            view: *view,
            motion,
            method,
            kept: (0..MOST_KEPT).map(|_| OnceLock::new()).collect(),
            bytes: AtomicUsize::new(0),
        }
    }

    /// Has something done with what is seen at the moments of the group with this number.
    pub(super) fn with<T>(
        &self,
        group: usize,
        times: &[f64],
        act: impl FnOnce(&[Instant<'world>]) -> T,
    ) -> T {
        let prepare = || -> Vec<_> { times.iter().map(|&time| self.at(time)).collect() };
        let Some(kept) = self.kept.get(group) else {
            return act(&prepare());
        };
        if let Some(instants) = kept.get() {
            return act(instants);
        }
        // Nobody waits for another thread here: that may wait for this one, which takes parts of its work.
        let instants = prepare();
        let bytes = instants.iter().map(|instant| instant.seen.bytes()).sum();
        let there_were = self.bytes.fetch_add(bytes, Ordering::Relaxed);
        if there_were + bytes <= ROOM && kept.get().is_none() {
            return act(kept.get_or_init(|| instants));
        }
        self.bytes.fetch_sub(bytes, Ordering::Relaxed);
        act(&instants)
    }

    fn at(&self, time: f64) -> Instant<'world> {
        let view = view_at(&self.view, self.motion.as_ref(), time);
        let seen = match self.method {
            Method::Samples(samples) => {
                Seen::by_samples(self.visibility, &view, Tile::SIDE, samples)
            }
            Method::Tolerance(_) => Seen::new(self.visibility, &view, Tile::SIDE),
        };
        Instant { view, seen }
    }
}

/// About as many moments are in a group.
pub(super) const GROUP: usize = 8;
