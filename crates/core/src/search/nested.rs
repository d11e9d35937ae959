//! Spheres that lie inside of others, in worlds that have many.
//!
//! An eye outside of the outer one sees nothing of them, and they shade nothing that it sees: the ray from a light that
//! meets the inner sphere meets the outer one before, or ends at it. The world's own numbers decide, with a margin for
//! rounding, so that both have no point in common.

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::hierarchy::boxes::Boxes;
use super::hierarchy::order::WIDTH;
use super::hierarchy::{BoxTest, Hierarchy, is_sphere};
use crate::model::camera::Projection;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// The nested spheres of a world.
#[derive(Clone, Debug)]
pub(super) struct Nested {
    /// One for each sphere of the world.
    pub(super) is_nested: Vec<bool>,
    /// The outermost of the spheres around them.
    around: Vec<Sphere>,
}

impl Nested {
    /// The spheres that lie inside of others, if they are many. A few may be missing, which only a long search would
    /// find.
    pub(super) fn find(spheres: &[Sphere], hierarchy: &Hierarchy) -> Option<Self> {
        /// Enough for a thread to begin with. Not tuned.
        const FEWEST_TO_SHARE: usize = 256;
        if !are_many(spheres, hierarchy) {
            return None;
        }
        let around = (0..spheres.len()).into_par_iter();
        let around = around.with_min_len(FEWEST_TO_SHARE);
        let around: Vec<Option<u32>> = around
            .map(|sphere| sphere_around(spheres, hierarchy, sphere))
            .collect();
        let is_nested: Vec<bool> = around.iter().map(Option::is_some).collect();
        let mut outermost: Vec<u32> = around.into_iter().flatten().collect();
        outermost.sort_unstable();
        outermost.dedup();
        outermost.retain(|&sphere| !is_nested[sphere as usize]);
        let around = outermost.iter().map(|&sphere| spheres[sphere as usize]);
        Some(Self {
            around: around.collect(),
            is_nested,
        })
    }

    /// Returns whether nothing of them is seen: all rays of the view begin outside of the spheres around them.
    pub(super) fn are_hidden_from(&self, view: &View) -> bool {
        let (eye, forward) = (view.camera.position, view.camera.forward());
        let is_outside = |sphere: &Sphere| match view.lens.projection() {
            Projection::Central => sphere.outside(eye) > 0.0,
            // Parallel rays begin in a plane.
            Projection::Parallel => {
                let ahead = (sphere.center() - eye).dot(forward);
                let size = (sphere.center() - eye).length() + eye.length() + sphere.radius();
                ahead - sphere.radius() > SLACK * size
            }
        };
        self.around.iter().all(is_outside)
    }
}

/// More than rounding, relatively.
const SLACK: f64 = 32.0 * UNIT_ROUNDOFF;

/// Returns whether a sphere lies inside another one, and does not touch it.
fn is_inside(inner: &Sphere, outer: &Sphere) -> bool {
    let apart = (inner.center() - outer.center()).length();
    (apart + inner.radius()) * (1.0 + SLACK) < outer.radius()
}

/// Returns whether many of the spheres lie inside of others: of some groups, whose spheres are neighbors, an eighth. An
/// estimate that decides about time alone.
fn are_many(spheres: &[Sphere], hierarchy: &Hierarchy) -> bool {
    const GROUPS: u32 = 64;
    const SHARE: usize = 8;
    let count = hierarchy.group_count();
    let (mut nested, mut all) = (0, 0);
    for group in (0..count).step_by(count.div_ceil(GROUPS).max(1) as usize) {
        let group = hierarchy.indices(group).iter();
        let group = group.filter(|&&index| is_sphere(index));
        let group = group.map(|&index| &spheres[index as usize]);
        all += group.clone().count();
        let is_nested = |inner: &&Sphere| group.clone().any(|outer| is_inside(inner, outer));
        nested += group.clone().filter(is_nested).count();
    }
    nested > 0 && nested * SHARE >= all
}

/// A sphere around another one, if it is found soon: of the boxes that hold that one, the larger are looked at first.
fn sphere_around(spheres: &[Sphere], hierarchy: &Hierarchy, sphere: usize) -> Option<u32> {
    /// Nodes and groups that are looked at. Not tuned: some hundred spheres are asked.
    const MOST: u32 = 96;
    let inner = &spheres[sphere];
    let (low, high) = (
        (inner.center() - inner.radius()).to_array(),
        (inner.center() + inner.radius()).to_array(),
    );
    let (mut nodes, mut groups) = (0, 0);
    let mut found = None;
    hierarchy.any(
        |boxes| {
            nodes += 1;
            let may = if nodes > MOST {
                0
            } else {
                boxes_around(boxes, low, high)
            };
            BoxTest {
                may,
                keys: std::array::from_fn(|place| {
                    f64::from(boxes.low[0][place]) - f64::from(boxes.high[0][place])
                }),
            }
        },
        |group| {
            groups += 1;
            let indices = hierarchy.indices(group).iter().copied();
            let mut indices = indices.filter(|&index| is_sphere(index));
            found = indices.find(|&index| is_inside(inner, &spheres[index as usize]));
            found.is_some() || groups > MOST
        },
    );
    found
}

/// The boxes that hold what lies between two corners, as bits.
fn boxes_around(boxes: &Boxes, low: [f64; 3], high: [f64; 3]) -> u8 {
    let mut may = 0;
    for place in 0..WIDTH {
        let holds = |axis: usize| {
            f64::from(boxes.low[axis][place]) <= low[axis]
                && f64::from(boxes.high[axis][place]) >= high[axis]
        };
        may |= u8::from((0..3).all(holds)) << place;
    }
    may & boxes.filled()
}

#[cfg(test)]
mod tests;
