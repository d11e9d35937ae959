//! The order in which neighbors in space are neighbors in a list.

use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

use crate::model::sphere::Sphere;
use crate::numeric::lanes::LANES;
use crate::numeric::order::sort_by_number;

/// Children of a node, and spheres of a group: as many as are computed side by side.
pub(crate) const WIDTH: usize = LANES;

/// A place in the order, and the sphere there; without one its index is [`NO_SPHERE`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// Rounded to the nearest that is finite.
    pub(super) center: [f32; 3],
    /// Rounded up.
    pub(super) radius: f32,
    pub(super) index: u32,
}

/// The index of no sphere.
pub(super) const NO_SPHERE: u32 = u32::MAX;

const EMPTY: Entry = Entry {
    center: [0.0; 3],
    radius: 0.0,
    index: NO_SPHERE,
};

/// Spheres whose radii differ by a factor of more than 2 to the power of this are kept apart: one
/// floor among a million grains would make every box above it as large as itself. They are counted from the largest
/// radius down, so that the order does not depend on the unit of length.
const OCTAVES: i32 = 3;

/// Fewer are not worth another thread.
const FEWEST_TO_SHARE: usize = 1 << 13;

/// All spheres so that every group of eight, and every group of eight such groups and so on, lies
/// close together. Some places are left over.
///
/// If more than eight spheres are equal, most are left out, but never the first: the others are not seen.
/// The spheres that are marked as `left_out` are, too.
pub(super) fn order(spheres: &[Sphere], left_out: Option<&[bool]>) -> Vec<Entry> {
    let mut entries: Vec<Entry> = spheres
        .par_iter()
        .enumerate()
        .with_min_len(FEWEST_TO_SHARE)
        .map(|(index, sphere)| Entry::new(index as u32, sphere))
        .collect();
    if let Some(left_out) = left_out {
        entries.retain(|entry| !left_out[entry.index as usize]);
    }
    let largest = largest_exponent(spheres);
    let classes = classes(&entries, largest);
    if classes.len() <= 1 {
        split(&mut entries, spheres);
        entries.resize(entries.len().next_multiple_of(WIDTH), EMPTY);
        return entries;
    }
    let mut order = Vec::with_capacity(entries.len() + WIDTH * classes.len());
    for &(wanted, _) in &classes {
        let first = order.len();
        order.extend(
            entries
                .iter()
                .filter(|entry| entry.class(largest) == wanted),
        );
        split(&mut order[first..], spheres);
        order.resize(order.len().next_multiple_of(WIDTH), EMPTY);
    }
    order
}

impl Entry {
    fn new(index: u32, sphere: &Sphere) -> Self {
        let radius = sphere.radius() as f32;
        let is_below = f64::from(radius) < sphere.radius();
        Self {
            // What is beyond single precision reaches to infinity as a box.
            center: sphere
                .center()
                .to_array()
                .map(|center| (center as f32).clamp(f32::MIN, f32::MAX)),
            radius: if is_below { radius.next_up() } else { radius },
            index,
        }
    }

    /// The class of its radius, where this is the exponent of the largest one.
    fn class(&self, largest: i32) -> i32 {
        (largest - self.exponent()) / OCTAVES
    }

    /// That of its radius; one that is beyond single precision has the next.
    fn exponent(&self) -> i32 {
        libm::ilogbf(self.radius).min(f32::MAX_EXP)
    }
}

/// The most bytes that the order of some spheres takes while it is made.
pub(super) fn most_bytes(spheres: &[Sphere]) -> u64 {
    let largest = largest_exponent(spheres);
    // Single precision has no more than 93 classes.
    let class = |sphere: &Sphere| 1_u128 << Entry::new(0, sphere).class(largest);
    let classes = spheres.par_iter().with_min_len(FEWEST_TO_SHARE).map(class);
    let classes = classes.reduce(|| 0, |one, other| one | other).count_ones();
    // Spheres of several classes are copied class by class.
    let copies = if classes > 1 { 2 } else { 1 };
    let places = spheres.len() + WIDTH * classes as usize;
    copies * places as u64 * size_of::<Entry>() as u64
}

/// The exponent of the largest radius.
fn largest_exponent(spheres: &[Sphere]) -> i32 {
    let exponents = spheres.par_iter().with_min_len(FEWEST_TO_SHARE);
    let exponents = exponents.map(|sphere| Entry::new(0, sphere).exponent());
    exponents.max().unwrap_or(0)
}

/// The classes of sizes, the largest class first: its groups are those of powers of eight.
fn classes(entries: &[Entry], largest: i32) -> Vec<(i32, usize)> {
    let mut classes: Vec<(i32, usize)> = Vec::new();
    for entry in entries {
        let class = entry.class(largest);
        match classes.iter_mut().find(|(known, _)| *known == class) {
            Some((_, count)) => *count += 1,
            None => classes.push((class, 1)),
        }
    }
    // A class is not negative.
    let pair = |&(class, count): &(i32, usize)| (-(count as f64), class as usize);
    let mut pairs: Vec<(f64, usize)> = classes.iter().map(pair).collect();
    sort_by_number(&mut pairs);
    for (known, (count, class)) in classes.iter_mut().zip(pairs) {
        *known = (class as i32, -count as usize);
    }
    classes
}

/// Orders entries by halving them across their longest extent, again and again, at places where
/// groups of powers of eight begin.
fn split(entries: &mut [Entry], spheres: &[Sphere]) {
    let count = entries.len();
    if count <= WIDTH {
        // The order within a group is that of the file, whatever the splits made of it.
        entries.sort_unstable_by_key(|entry| entry.index);
        return;
    }
    let (axis, extent) = longest_axis(entries);
    if extent == 0.0 {
        return leave_out_equals(entries, spheres);
    }
    let mut unit = WIDTH;
    while unit * WIDTH < count {
        unit *= WIDTH;
    }
    let middle = unit * count.div_ceil(unit).div_ceil(2);
    // Indices decide between equals: the result does not depend on how the halves are found.
    entries.select_nth_unstable_by(middle, |one, other| {
        let by_place = one.center[axis].total_cmp(&other.center[axis]);
        by_place.then(one.index.cmp(&other.index))
    });
    let (low, high) = entries.split_at_mut(middle);
    if count < FEWEST_TO_SHARE {
        split(low, spheres);
        split(high, spheres);
    } else {
        rayon::join(|| split(low, spheres), || split(high, spheres));
    }
}

/// Leaves out all but the first of equal spheres: their places, the last ones, become empty. The others, whose centers
/// are the same in single precision, so that no order brings them closer, are left in that of their radii, the largest
/// first: others lie inside of these.
fn leave_out_equals(entries: &mut [Entry], spheres: &[Sphere]) {
    let key = |entry: &Entry| {
        let sphere = &spheres[entry.index as usize];
        let [x, y, z] = sphere.center().to_array();
        [x, y, z, sphere.radius()]
    };
    entries.par_sort_unstable_by(|one, other| {
        let mut numbers = key(one).into_iter().zip(key(other));
        let differing = numbers.find_map(|(one, other)| {
            let order = one.total_cmp(&other);
            order.is_ne().then_some(order)
        });
        differing.unwrap_or(one.index.cmp(&other.index))
    });
    let mut kept = 1;
    for place in 1..entries.len() {
        if key(&entries[place]) != key(&entries[kept - 1]) {
            entries[kept] = entries[place];
            kept += 1;
        }
    }
    entries[..kept].par_sort_unstable_by(|one, other| {
        let radius = |entry: &Entry| spheres[entry.index as usize].radius();
        let by_radius = radius(other).total_cmp(&radius(one));
        by_radius.then(one.index.cmp(&other.index))
    });
    entries[kept..].fill(EMPTY);
}

/// The longest axis of the box around the centers, and its length.
fn longest_axis(entries: &[Entry]) -> (usize, f32) {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for entry in entries {
        for axis in 0..3 {
            low[axis] = low[axis].min(entry.center[axis]);
            high[axis] = high[axis].max(entry.center[axis]);
        }
    }
    let extent = |axis: usize| high[axis] - low[axis];
    let axis = if extent(0) >= extent(1) && extent(0) >= extent(2) {
        0
    } else if extent(1) >= extent(2) {
        1
    } else {
        2
    };
    (axis, extent(axis))
}
