//! Light of a sky that all threads and frames have in common.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use super::patch::{Patch, Shares};
use super::square::{Node, Square};

/// Parts that threads may use at a time.
const SHARDS: usize = 64;

/// What a part knows at most: it forgets all of it then. That is some 300 MiB of all parts. Not tuned.
const MOST: usize = 1 << 14;

/// What is known of the light of a world's sky. Each node and each patch is what its place says, whoever makes it, and when.
#[derive(Debug, Default)]
pub(crate) struct Patches {
    pub(crate) nodes: Known<Node, Shares>,
    pub(crate) patches: Known<Square, Arc<Patch>>,
}

/// What is known.
#[derive(Debug)]
pub(crate) struct Known<K, V> {
    shards: [Mutex<HashMap<K, V>>; SHARDS],
}

impl<K, V> Default for Known<K, V> {
    fn default() -> Self {
        Self {
            shards: std::array::from_fn(|_| Mutex::default()),
        }
    }
}

impl<K: Eq + Hash + Copy, V: Clone> Known<K, V> {
    /// What belongs to a key, made if it is not known yet. Two threads may make the same, and that of one is kept.
    pub(crate) fn of(&self, key: &K, hash: u64, make: impl FnOnce() -> V) -> V {
        let shard = &self.shards[(hash >> 32) as usize % SHARDS];
        let lock = || shard.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(key) {
            return known.clone();
        }
        let made = make();
        let mut known = lock();
        if known.len() >= MOST {
            known.clear();
        }
        known.entry(*key).or_insert(made).clone()
    }
}
