//! Light of a sky that all threads and frames have in common.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::light::NodeLight;
use super::patch::Patch;
use super::square::{Node, Square};

/// Parts that threads may use at a time.
const SHARDS: usize = 64;

/// What a part knows at most: it forgets all of it then. That is some 700 MiB of all parts. Not tuned.
const MOST: usize = 1 << 14;

/// What is known of the light of a world's sky. Each node and each patch is what its place says, whoever makes it, and when.
#[derive(Debug)]
pub(crate) struct Patches {
    /// A number that no others have, from 1.
    name: u64,
    shards: [Mutex<Known>; SHARDS],
}

/// By squares, which may stand for nodes, and what is known of them.
type Known = HashMap<(Square, Kind), Light>;

#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
enum Kind {
    Node,
    Patch,
    List,
}

/// The light at a node, or on a square; or the spheres that may hide light from a square.
#[derive(Clone, Debug)]
enum Light {
    Node(Arc<NodeLight>),
    Patch(Arc<Patch>),
    List(Arc<Vec<u32>>),
}

impl Default for Patches {
    fn default() -> Self {
        static NEXT_NAME: AtomicU64 = AtomicU64::new(1);
        Self {
            name: NEXT_NAME.fetch_add(1, Ordering::Relaxed),
            shards: std::array::from_fn(|_| Mutex::default()),
        }
    }
}

impl Patches {
    /// A number that tells the world from others: whatever is known of its spheres may be kept with it.
    pub(crate) fn name(&self) -> u64 {
        self.name
    }

    fn shard(&self, hash: u64) -> MutexGuard<'_, Known> {
        let shard = &self.shards[(hash >> 32) as usize % SHARDS];
        shard.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn get(&self, key: &(Square, Kind), hash: u64) -> Option<Light> {
        self.shard(hash).get(key).cloned()
    }

    fn keep(&self, key: (Square, Kind), hash: u64, light: Light) {
        let mut known = self.shard(hash);
        if known.len() >= MOST {
            known.clear();
        }
        known.insert(key, light);
    }

    /// The light at a node, made if it is not known yet. Two threads may make the same.
    pub(crate) fn node(&self, node: &Node, make: impl FnOnce() -> NodeLight) -> NodeLight {
        let (key, hash) = ((node.corner(), Kind::Node), node.corner().hash());
        if let Some(Light::Node(light)) = self.get(&key, hash) {
            return *light;
        }
        let light = make();
        self.keep(key, hash, Light::Node(Arc::new(light)));
        light
    }

    /// The patch of a square, made if it is not known yet. Two threads may make the same.
    pub(crate) fn patch(&self, square: &Square, make: impl FnOnce() -> Patch) -> Arc<Patch> {
        let (key, hash) = ((*square, Kind::Patch), square.hash());
        if let Some(Light::Patch(patch)) = self.get(&key, hash) {
            return patch;
        }
        let patch = Arc::new(make());
        self.keep(key, hash, Light::Patch(Arc::clone(&patch)));
        patch
    }

    /// The spheres that may hide light from a square, found if they are not known yet. Two threads may find the same.
    pub(crate) fn list(&self, square: &Square, find: impl FnOnce() -> Vec<u32>) -> Arc<Vec<u32>> {
        let (key, hash) = ((*square, Kind::List), square.hash());
        if let Some(Light::List(list)) = self.get(&key, hash) {
            return list;
        }
        let list = Arc::new(find());
        self.keep(key, hash, Light::List(Arc::clone(&list)));
        list
    }
}
