//! Spheres are listed in the cells of a light.
//!
//! A counting sort by layers writes here and there. Layers side by side share a bucket, which is sorted alone: that fits into
//! near memory, and several threads share the buckets.

use super::{Block, LightGrid};
use crate::model::sphere::Sphere;
use crate::numeric::lanes::LANES;

/// Not tuned: as many places as a processor writes to side by side without waiting for memory, by and large.
const BUCKETS: usize = 256;

/// The layer of a sphere that is in no cell.
const NOWHERE: u32 = u32::MAX;

/// Fewer spheres are not worth another thread.
const FEWEST_TO_SHARE: usize = 1 << 14;

/// Places in which no sphere lies are lower than all.
const NO_SPHERES: Block = [
    [0.0; LANES],
    [0.0; LANES],
    [f32::NEG_INFINITY; LANES],
    [0.0; LANES],
];

/// A sphere, where it belongs, and the numbers of its block.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    layer: u32,
    index: u32,
    numbers: [f32; 4],
}

/// Some buckets, and what they are listed in.
struct Buckets<'a> {
    /// Their ends among all entries.
    ends: &'a [usize],
    /// The layers of each.
    layers: usize,
    /// The first layer, and the number of entries and of places before.
    first: usize,
    before: usize,
    place: usize,
    entries: &'a [Entry],
    starts: &'a mut [u32],
    blocks: &'a mut [Block],
    indices: &'a mut [u32],
}

impl LightGrid {
    /// Lists the spheres up to a radius cell by cell, and the others one by one.
    pub(super) fn fill(&mut self, spheres: &[Sphere], reach: f64) {
        let mut entries = vec![Entry::default(); spheres.len()];
        self.place_all((spheres, 0), reach, &mut entries);
        let layers = self.starts.len() - 1;
        let of_bucket = layers.div_ceil(BUCKETS);
        let bucket = |entry: &Entry| entry.layer as usize / of_bucket;
        // How many there are; then where each bucket begins, which moves up to its end.
        let mut ends = [0_usize; BUCKETS];
        for entry in &entries {
            if entry.layer == NOWHERE {
                self.large.push(entry.index);
            } else {
                ends[bucket(entry)] += 1;
            }
        }
        let (mut sum, mut places) = (0, 0);
        for end in &mut ends {
            let count = *end;
            *end = sum;
            sum += count;
            places += count.next_multiple_of(LANES);
        }
        let mut sorted = vec![Entry::default(); sum];
        for entry in &entries {
            if entry.layer != NOWHERE {
                let end = &mut ends[bucket(entry)];
                sorted[*end] = *entry;
                *end += 1;
            }
        }
        drop(entries);
        self.indices.resize(places, 0);
        self.blocks.resize(places / LANES, NO_SPHERES);
        self.starts[layers] = places as u32;
        let buckets = Buckets {
            ends: &ends,
            layers: of_bucket,
            first: 0,
            before: 0,
            place: 0,
            entries: &sorted,
            starts: &mut self.starts[..layers],
            blocks: &mut self.blocks,
            indices: &mut self.indices,
        };
        buckets.fill();
    }

    /// Finds out where spheres up to a radius belong, the first of which has this index.
    fn place_all(&self, (spheres, first): (&[Sphere], u32), reach: f64, entries: &mut [Entry]) {
        if spheres.len() > FEWEST_TO_SHARE {
            let middle = spheres.len() / 2;
            let (low, high) = entries.split_at_mut(middle);
            rayon::join(
                || self.place_all((&spheres[..middle], first), reach, low),
                || self.place_all((&spheres[middle..], first + middle as u32), reach, high),
            );
            return;
        }
        for (number, (sphere, entry)) in spheres.iter().zip(entries).enumerate() {
            entry.index = first + number as u32;
            if sphere.radius() > reach {
                entry.layer = NOWHERE;
                continue;
            }
            let place = self.place(sphere.center());
            let column = (place.x / self.side) as usize;
            let row = (place.y / self.side) as usize;
            let cell = row * self.columns + column;
            entry.layer = (cell * self.layers + self.layer(place.z)) as u32;
            entry.numbers = [
                (place.x - column as f64 * self.side) as f32,
                (place.y - row as f64 * self.side) as f32,
                place.z as f32,
                sphere.radius() as f32,
            ];
        }
    }
}

impl Buckets<'_> {
    /// Lists the entries of all.
    fn fill(self) {
        if let [_] = self.ends {
            self.fill_one();
            return;
        }
        let middle = self.ends.len() / 2;
        let (low, high) = self.ends.split_at(middle);
        let (mut places, mut before) = (0, self.before);
        for &end in low {
            places += (end - before).next_multiple_of(LANES);
            before = end;
        }
        let layers = (middle * self.layers).min(self.starts.len());
        let entries = self.entries.split_at(before - self.before);
        let starts = self.starts.split_at_mut(layers);
        let blocks = self.blocks.split_at_mut(places / LANES);
        let indices = self.indices.split_at_mut(places);
        let low = Buckets {
            ends: low,
            entries: entries.0,
            starts: starts.0,
            blocks: blocks.0,
            indices: indices.0,
            ..self
        };
        let high = Buckets {
            ends: high,
            first: self.first + layers,
            before,
            place: self.place + places,
            entries: entries.1,
            starts: starts.1,
            blocks: blocks.1,
            indices: indices.1,
            ..self
        };
        if low.entries.len() + high.entries.len() > FEWEST_TO_SHARE {
            rayon::join(|| low.fill(), || high.fill());
        } else {
            low.fill();
            high.fill();
        }
    }

    /// Lists the entries of one.
    fn fill_one(self) {
        for entry in self.entries {
            self.starts[entry.layer as usize - self.first] += 1;
        }
        // How many there are becomes where each layer begins, which moves up to its end; then ends are begins again.
        let mut sum = self.place as u32;
        for start in self.starts.iter_mut() {
            let count = *start;
            *start = sum;
            sum += count;
        }
        for entry in self.entries {
            let next = &mut self.starts[entry.layer as usize - self.first];
            let place = *next as usize - self.place;
            *next += 1;
            self.indices[place] = entry.index;
            let block = &mut self.blocks[place / LANES];
            for (numbers, number) in block.iter_mut().zip(entry.numbers) {
                numbers[place % LANES] = number;
            }
        }
        if let Some(last) = self.starts.len().checked_sub(1) {
            self.starts.copy_within(..last, 1);
            self.starts[0] = self.place as u32;
        }
    }
}
