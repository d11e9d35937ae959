//! The order in which neighbors in space are neighbors in a list.

use super::boxes::WIDTH;
use crate::Sphere;

/// A place in the order that holds no sphere.
pub(super) const NOBODY: u32 = u32::MAX;

/// A sphere to be put in order.
#[derive(Clone, Copy, Debug)]
struct Entry {
    center: [f32; 3],
    index: u32,
}

/// Spheres whose radii differ by a factor of more than 2 to the power of this are kept apart: one
/// floor among a million grains would make every box above it as large as itself.
const OCTAVES: i32 = 3;

/// The indices of all spheres so that every group of eight, and every group of eight such groups
/// and so on, lies close together. Places that are left over are [`NOBODY`]'s.
pub(super) fn order(spheres: &[Sphere]) -> Vec<u32> {
    let mut classes: Vec<(i32, usize)> = Vec::new();
    for sphere in spheres {
        let class = class(sphere);
        match classes.iter_mut().find(|(known, _)| *known == class) {
            Some((_, count)) => *count += 1,
            None => classes.push((class, 1)),
        }
    }
    // The largest class comes first: its groups are those of powers of eight.
    classes.sort_unstable_by_key(|&(class, count)| (std::cmp::Reverse(count), class));
    let mut order = Vec::with_capacity(spheres.len() + WIDTH * classes.len());
    let mut entries: Vec<Entry> = Vec::with_capacity(classes.first().map_or(0, |first| first.1));
    for &(wanted, _) in &classes {
        entries.clear();
        let of_class = spheres.iter().enumerate();
        let of_class = of_class.filter(|(_, sphere)| classes.len() == 1 || class(sphere) == wanted);
        entries.extend(of_class.map(|(index, sphere)| Entry {
            center: sphere.center().as_vec3().to_array(),
            index: index as u32,
        }));
        split(&mut entries);
        order.extend(entries.iter().map(|entry| entry.index));
        order.resize(order.len().next_multiple_of(WIDTH), NOBODY);
    }
    order
}

fn class(sphere: &Sphere) -> i32 {
    libm::ilogb(sphere.radius()).div_euclid(OCTAVES)
}

/// Orders entries by halving them across their longest extent, again and again, at places where
/// groups of powers of eight begin.
fn split(entries: &mut [Entry]) {
    /// Fewer are not worth another thread.
    const FEWEST_TO_SHARE: usize = 1 << 13;
    let count = entries.len();
    if count <= WIDTH {
        // The order within a group is that of the file, whatever the splits made of it.
        entries.sort_unstable_by_key(|entry| entry.index);
        return;
    }
    let mut unit = WIDTH;
    while unit * WIDTH < count {
        unit *= WIDTH;
    }
    let middle = unit * count.div_ceil(unit).div_ceil(2);
    let axis = longest_axis(entries);
    // Indices decide between equals: the result does not depend on how the halves are found.
    entries.select_nth_unstable_by(middle, |one, other| {
        let by_place = one.center[axis].total_cmp(&other.center[axis]);
        by_place.then(one.index.cmp(&other.index))
    });
    let (low, high) = entries.split_at_mut(middle);
    if count < FEWEST_TO_SHARE {
        split(low);
        split(high);
    } else {
        rayon::join(|| split(low), || split(high));
    }
}

fn longest_axis(entries: &[Entry]) -> usize {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for entry in entries {
        for axis in 0..3 {
            low[axis] = low[axis].min(entry.center[axis]);
            high[axis] = high[axis].max(entry.center[axis]);
        }
    }
    let extent = |axis: usize| high[axis] - low[axis];
    if extent(0) >= extent(1) && extent(0) >= extent(2) {
        0
    } else if extent(1) >= extent(2) {
        1
    } else {
        2
    }
}
