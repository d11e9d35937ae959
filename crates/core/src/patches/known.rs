//! Light of a sky that all threads and frames have in common.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::patch::{Patch, Shares};
use super::square::{Node, Square};

/// Parts that threads may use at a time.
const SHARDS: usize = 64;

/// What a part knows at most: it forgets all of it then. That is some 300 MiB of all parts. Not tuned.
const MOST: usize = 1 << 15;

/// What is known of the light of a world's sky. Each node and each patch is what its place says, whoever makes it, and when.
#[derive(Debug)]
pub(crate) struct Patches {
    shards: [Mutex<Known>; SHARDS],
}

/// By squares, and by those that stand for nodes.
type Known = HashMap<(Square, bool), Light>;

/// The light at a node, or on a square.
#[derive(Clone, Debug)]
enum Light {
    Node(Shares),
    Patch(Arc<Patch>),
}

impl Default for Patches {
    fn default() -> Self {
        Self {
            shards: std::array::from_fn(|_| Mutex::default()),
        }
    }
}

impl Patches {
    fn shard(&self, hash: u64) -> MutexGuard<'_, Known> {
        let shard = &self.shards[(hash >> 32) as usize % SHARDS];
        shard.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn get(&self, key: &(Square, bool), hash: u64) -> Option<Light> {
        self.shard(hash).get(key).cloned()
    }

    fn keep(&self, key: (Square, bool), hash: u64, light: Light) {
        let mut known = self.shard(hash);
        if known.len() >= MOST {
            known.clear();
        }
        known.insert(key, light);
    }

    /// The light at a node, made if it is not known yet. Two threads may make the same.
    pub(crate) fn node(&self, node: &Node, make: impl FnOnce() -> Shares) -> Shares {
        let (key, hash) = ((node.corner(), true), node.corner().hash());
        if let Some(Light::Node(shares)) = self.get(&key, hash) {
            return shares;
        }
        let shares = make();
        self.keep(key, hash, Light::Node(shares));
        shares
    }

    /// The patch of a square, made if it is not known yet. Two threads may make the same.
    pub(crate) fn patch(&self, square: &Square, make: impl FnOnce() -> Patch) -> Arc<Patch> {
        let (key, hash) = ((*square, false), square.hash());
        if let Some(Light::Patch(patch)) = self.get(&key, hash) {
            return patch;
        }
        let patch = Arc::new(make());
        self.keep(key, hash, Light::Patch(Arc::clone(&patch)));
        patch
    }
}
