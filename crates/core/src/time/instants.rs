//! The views of a moving camera at single moments.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use crate::model::exposure::{Motion, view_at};
use crate::model::view::View;
use crate::picture::pixel::Method;
use crate::search::view_index::ViewIndex;
use crate::search::visibility::Visibility;

/// The view at a moment, and what it sees.
#[derive(Debug)]
pub(super) struct Instant<'world> {
    pub(super) view: View,
    pub(super) index: ViewIndex<'world>,
}

/// The views at the moments at which pixels are integrated, prepared when they are first needed.
///
/// As much as there is memory for is kept; the rest is found out again for each row of tiles.
#[derive(Debug)]
pub(crate) struct Instants<'world> {
    pub(super) visibility: Visibility<'world>,
    pub(super) view: View,
    pub(super) motion: Arc<dyn Motion + 'world>,
    method: Method,
    kept: Vec<OnceLock<Vec<Instant<'world>>>>,
    /// The memory that these take, in bytes.
    bytes: AtomicUsize,
}

/// The memory for what is kept, in bytes: 512 MiB. Not tuned: what is not kept is prepared anew for
/// every row of tiles.
const MOST_BYTES: usize = 1 << 29;

/// No more groups of moments are kept: as many as there are panels of the first twelve levels.
const MOST_KEPT: usize = 1 << 12;

impl<'world> Instants<'world> {
    /// For pictures of `view`, whose camera moves so, by this method.
    pub(crate) fn new(
        visibility: &Visibility<'world>,
        view: &View,
        motion: Arc<dyn Motion + 'world>,
        method: Method,
    ) -> Self {
        Self {
            visibility: visibility.clone(),
            view: *view,
            motion,
            method,
            kept: (0..MOST_KEPT).map(|_| OnceLock::new()).collect(),
            bytes: AtomicUsize::new(0),
        }
    }

    /// Has something done with the instants of the group with this number.
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
        // No thread waits for another here: that may wait for this one, which takes parts of its work.
        let instants = prepare();
        let bytes = instants.iter().map(|instant| instant.index.bytes()).sum();
        let there_were = self.bytes.fetch_add(bytes, Ordering::Relaxed);
        if there_were + bytes <= MOST_BYTES && kept.get().is_none() {
            return act(kept.get_or_init(|| instants));
        }
        self.bytes.fetch_sub(bytes, Ordering::Relaxed);
        act(&instants)
    }

    fn at(&self, time: f64) -> Instant<'world> {
        let view = view_at(&self.view, self.motion.as_ref(), time);
        let index = ViewIndex::new(&self.visibility, &view, self.method.into());
        Instant { view, index }
    }
}

/// The number of moments of a group, about.
pub(super) const GROUP: usize = 8;
