//! A hierarchy of boxes around spheres.
//!
//! Its boxes are in single precision and rounded outward: they leave out what cannot matter, and
//! decide nothing.

pub(crate) mod boxes;
pub(crate) mod groups;
pub(crate) mod order;

use glam::DVec3;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use rayon::slice::ParallelSlice;

use self::boxes::Boxes;
use self::groups::{Group, NearGroup};
use self::order::{NO_SPHERE, WIDTH};
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;

/// Spheres in groups of eight, these in groups of eight, and so on: where children are found is
/// their number alone.
///
/// It takes 4 bytes a sphere for the order and 3.5 for the boxes; and 16 for what is nearly the sphere, unless spheres are very
/// many. Without that, searches read the spheres themselves, which lie far apart: a picture of ten million takes twice as long.
#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    /// The indices of the spheres, group by group.
    order: Vec<u32>,
    /// The spheres of the groups, nearly; none in a world of very many.
    groups: Vec<NearGroup>,
    /// The boxes of the groups of spheres, then those of groups of groups; the last level has one
    /// element, unless there is no sphere.
    levels: Vec<Vec<Boxes>>,
}

/// Spheres that are kept nearly as well. Not tuned.
const MOST_NEAR: usize = 1 << 24;

/// A node: eight boxes of a level.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Node {
    pub(crate) level: u32,
    pub(crate) index: u32,
}

impl Hierarchy {
    /// The hierarchy of some spheres, on the threads of the current rayon pool.
    pub(crate) fn new(spheres: &[Sphere]) -> Self {
        Self::without(spheres, None)
    }

    /// The same without the spheres that are marked.
    pub(crate) fn without(spheres: &[Sphere], left_out: Option<&[bool]>) -> Self {
        /// Enough for a thread to begin with: some 10 µs. Not tuned.
        const NODES_A_TASK: usize = 256;
        let entries = order::order(spheres, left_out);
        let mut levels = Vec::new();
        let leaves: Vec<Boxes> = entries
            .par_chunks(WIDTH * WIDTH)
            .with_min_len(NODES_A_TASK)
            .map(|groups| {
                let mut boxes = Boxes::EMPTY;
                for (place, group) in groups.chunks(WIDTH).enumerate() {
                    for entry in group.iter().filter(|entry| is_sphere(entry.index)) {
                        boxes.add(place, entry);
                    }
                }
                boxes
            })
            .collect();
        levels.push(leaves);
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            let above = last
                .par_chunks(WIDTH)
                .with_min_len(NODES_A_TASK)
                .map(|children| {
                    let mut boxes = Boxes::EMPTY;
                    for (place, child) in children.iter().enumerate() {
                        boxes.add_all(place, child);
                    }
                    boxes
                })
                .collect();
            levels.push(above);
        }
        let mut groups = Vec::new();
        if spheres.len() <= MOST_NEAR {
            let entries = entries.par_chunks(WIDTH).with_min_len(NODES_A_TASK * WIDTH);
            entries.map(NearGroup::new).collect_into_vec(&mut groups);
        }
        Self {
            groups,
            order: entries.par_iter().map(|entry| entry.index).collect(),
            levels,
        }
    }

    /// The same as of very many spheres.
    #[cfg(test)]
    pub(crate) fn without_near(&self) -> Self {
        Self {
            groups: Vec::new(),
            ..self.clone()
        }
    }

    /// About the most bytes that the hierarchy of some spheres takes while it is made.
    pub(crate) fn most_bytes(spheres: &[Sphere]) -> u64 {
        let count = spheres.len() as u64;
        let near = if spheres.len() <= MOST_NEAR { 16 } else { 0 };
        order::most_bytes(spheres) + count * (8 + near)
    }

    /// The node above all others, unless there is no sphere.
    pub(crate) fn root(&self) -> Option<Node> {
        let level = self.levels.len() - 1;
        let is_there = !self.levels[level].is_empty();
        is_there.then_some(Node {
            level: level as u32,
            index: 0,
        })
    }

    /// The corners of the box around all spheres.
    pub(crate) fn corners(&self) -> [DVec3; 2] {
        let mut corners = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        if let Some(root) = self.root() {
            let boxes = self.boxes(root);
            let corner = |of: &[[f32; WIDTH]; 3], place: usize| {
                DVec3::new(
                    of[0][place].into(),
                    of[1][place].into(),
                    of[2][place].into(),
                )
            };
            for place in 0..WIDTH {
                corners[0] = corners[0].min(corner(&boxes.low, place));
                corners[1] = corners[1].max(corner(&boxes.high, place));
            }
        }
        corners
    }

    /// The boxes of a node.
    pub(crate) fn boxes(&self, node: Node) -> &Boxes {
        &self.levels[node.level as usize][node.index as usize]
    }

    /// The spheres of a child of a node of the lowest level, at least nearly, out of those that the hierarchy is of.
    #[inline(always)]
    pub(crate) fn group(&self, index: u32, spheres: &[Sphere]) -> Group {
        match self.groups.get(index as usize) {
            Some(near) => near.group(),
            None => Group::new(self.indices(index), spheres),
        }
    }

    /// The number of groups, the empty ones included.
    pub(crate) fn group_count(&self) -> u32 {
        (self.order.len() / WIDTH) as u32
    }

    /// The indices of its spheres; [`is_sphere`] tells the places that hold one.
    pub(crate) fn indices(&self, group: u32) -> &[u32] {
        &self.order[group as usize * WIDTH..][..WIDTH]
    }

    /// Says whether something `holds` for any of the groups of spheres whose boxes, and those around
    /// them, may matter, and of others too: `test` says of the boxes of a node which ones do. Each is
    /// asked once, and none after one for which it holds. Of siblings those are asked first that come
    /// first by their keys.
    #[inline(always)]
    pub(crate) fn any(
        &self,
        mut test: impl FnMut(&Boxes) -> BoxTest,
        mut holds: impl FnMut(u32) -> bool,
    ) -> bool {
        // Seven siblings wait on each of the levels: there are at most eleven.
        let mut waiting = [Node { level: 0, index: 0 }; 96];
        let mut count = 0;
        if let Some(root) = self.root() {
            waiting[0] = root;
            count = 1;
        }
        while count > 0 {
            count -= 1;
            let node = waiting[count];
            let boxes = self.boxes(node);
            let tested = test(boxes);
            let mut places = [0; WIDTH];
            let mut known = 0;
            for place in set_bits(tested.may & boxes.filled()) {
                let mut at = known;
                while at > 0 && tested.keys[places[at - 1]] > tested.keys[place] {
                    places[at] = places[at - 1];
                    at -= 1;
                }
                places[at] = place;
                known += 1;
            }
            // What is put last among those that wait is taken first.
            let first = count;
            for &place in &places[..known] {
                let index = node.index * WIDTH as u32 + place as u32;
                if node.level > 0 {
                    waiting[count] = Node {
                        level: node.level - 1,
                        index,
                    };
                    count += 1;
                } else if holds(index) {
                    return true;
                }
            }
            waiting[first..count].reverse();
        }
        false
    }
}

/// The answer of a search about the boxes of a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxTest {
    /// The boxes that may matter, as bits.
    pub(crate) may: u8,
    /// Their order: the least is looked at first.
    pub(crate) keys: [f64; WIDTH],
}

/// True where a place in a group holds a sphere.
pub(crate) fn is_sphere(index: u32) -> bool {
    index != NO_SPHERE
}

#[cfg(test)]
mod tests;
