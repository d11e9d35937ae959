//! What lies around a sphere, by directions.
//!
//! Rays from the surface of a small sphere of a crowd mostly end near by. The spheres around it are sorted by the cells of a
//! cube ([`super::cube`]) in which rays from any of its points may meet them, the nearer ones first: a ray asks those of its
//! cell. Only a ray that none of them stops, and that does not leave the world before, asks the hierarchy for what is farther.

use fearless_simd::{Level, Simd, dispatch};
use glam::{Vec3, Vec4};

use super::cube::{CELLS, cell_of, for_each_within};
use crate::model::ray::Ray;
use crate::numeric::lanes::{LANES, f32x8};
use crate::numeric::pair::both;
use crate::search::beyond::Beyond;
use crate::soft::point::Occluders;

/// Larger spheres, in radii of the own one, are asked one by one: single precision does not place their surfaces well.
const LARGEST: f64 = 1024.0;

/// Spheres are gathered out to where a ray has met as many in the mean, or until they are so many: of 100,000 spheres,
/// 4,096 take less than half the time at 1e-1 that 16,384 with a depth of 5 take, and up to 1.3 times as much at 1e-2.
const DEPTH: f64 = 4.0;
const MOST: usize = 1 << 12;

/// The heights, in radii, of the first spheres, and how many times as high the next ones are. Not tuned.
const FIRST: f64 = 4.0;
const WIDER: f64 = 1.5;

/// The most shells: 10¹¹ radii.
const SHELLS: u32 = 60;

/// Spheres, seen from the center of the own one, and in its radii. Where there is none, no ray meets it.
#[derive(Clone, Copy, Debug)]
struct Group {
    center: [[f32; LANES]; 3],
    radius_square: [f32; LANES],
}

const NOTHING: Group = Group {
    center: [[0.0; LANES]; 3],
    radius_square: [-1.0; LANES],
};

/// The spheres that may keep light from one.
#[derive(Debug)]
pub(super) struct Surroundings {
    /// Those around it, cell by cell, and for each cell the end of its groups.
    groups: Vec<Group>,
    ends: Vec<u32>,
    large: Vec<u32>,
    /// The height up to which all are known, and the corners of all spheres' box.
    height: f32,
    corners: [Vec3; 2],
}

/// A ray from the surface, in radii of the sphere: its origin is the normal there.
#[derive(Clone, Copy, Debug)]
pub(super) struct FromSurface {
    pub(super) normal: Vec3,
    pub(super) direction: Vec3,
}

impl Surroundings {
    pub(super) fn new(own: usize, occluders: &Occluders<'_>) -> Self {
        let sphere = &occluders.spheres[own];
        let (center, radius) = (sphere.center(), sphere.radius());
        let corners = both(occluders.hierarchy.corners(), |corner| {
            (corner - center) / radius
        });
        let farthest = corners[0].abs().max(corners[1].abs()).max_element();
        let farthest = 4.0 + 2.0 * farthest;
        let mut near: Vec<Vec4> = Vec::new();
        // Cells, and the spheres in them.
        let mut sorted: Vec<(u16, u16)> = Vec::new();
        let mut counts = [0_u32; CELLS];
        let mut large = Vec::new();
        let (mut low, mut high, mut depth) = (f64::NEG_INFINITY, FIRST, 0.0);
        for _ in 0..SHELLS {
            let shell = Beyond::Shell {
                center,
                inner: low * radius,
                outer: high * radius,
            };
            occluders
                .hierarchy
                .for_each_beyond(occluders.spheres, &shell, &mut |index| {
                    let other = &occluders.spheres[index];
                    let to_center = (other.center() - center) / radius;
                    let (distance, size) = (to_center.length(), other.radius() / radius);
                    let height = distance - size;
                    if height < low || height >= high || !occluders.may_hide(index, own) {
                        return;
                    }
                    if size > LARGEST {
                        large.push(index as u32);
                        return;
                    }
                    depth += (0.5 * size / distance).powi(2).min(0.25);
                    if near.len() >= MOST {
                        return;
                    }
                    let sine = ((size + 1.0) / distance).min(1.0);
                    for_each_within(to_center / distance, sine, |cell| {
                        counts[cell] += 1;
                        sorted.push((cell as u16, near.len() as u16));
                    });
                    near.push(to_center.as_vec3().extend((size * size) as f32));
                });
            if near.len() >= MOST {
                break;
            }
            low = high;
            if depth >= DEPTH || high >= farthest {
                break;
            }
            high *= WIDER;
        }
        Self {
            large,
            // From the surface, not from the center.
            height: (low - 2.0) as f32,
            corners: both(corners, |corner| corner.as_vec3()),
            ..Self::sorted(&counts, &sorted, &near)
        }
    }

    fn sorted(counts: &[u32; CELLS], sorted: &[(u16, u16)], near: &[Vec4]) -> Self {
        let mut ends = Vec::with_capacity(CELLS);
        let mut places = [0; CELLS];
        let mut end = 0_u32;
        for (place, count) in places.iter_mut().zip(counts) {
            *place = end as usize * LANES;
            end += count.div_ceil(LANES as u32);
            ends.push(end);
        }
        let mut groups = vec![NOTHING; end as usize];
        for &(cell, number) in sorted {
            let place = &mut places[usize::from(cell)];
            let (group, lane) = (&mut groups[*place / LANES], *place % LANES);
            let sphere = near[usize::from(number)];
            for axis in 0..3 {
                group.center[axis][lane] = sphere[axis];
            }
            group.radius_square[lane] = sphere.w;
            *place += 1;
        }
        Self {
            groups,
            ends,
            large: Vec::new(),
            height: 0.0,
            corners: [Vec3::ZERO; 2],
        }
    }

    /// True if a sphere stops a ray.
    pub(super) fn stops(
        &self,
        level: Level,
        ray: &FromSurface,
        own: usize,
        occluders: &Occluders<'_>,
    ) -> bool {
        let cell = cell_of(ray.direction);
        let first = if cell == 0 { 0 } else { self.ends[cell - 1] };
        let groups = &self.groups[first as usize..self.ends[cell] as usize];
        if dispatch!(level, simd => any_met(simd, groups, ray)) {
            return true;
        }
        let leaves = self.leaves_early(ray);
        if leaves && self.large.is_empty() {
            return false;
        }
        let in_world = ray.in_world(own, occluders);
        let error = ROUNDING * in_world.origin.abs().max_element();
        let mut large = self.large.iter();
        if large.any(|&index| occluders.spheres[index as usize].is_met(&in_world, error)) {
            return true;
        }
        let along = Beyond::Cone {
            apex: in_world.origin,
            around: 0.0,
            axis: in_world.direction,
            sine: 0.0,
            cosine: 1.0,
        };
        !leaves
            && occluders
                .hierarchy
                .any_beyond(occluders.spheres, &along, &mut |index| {
                    occluders.may_hide(index, own)
                        && occluders.spheres[index].is_met(&in_world, error)
                })
    }

    /// True if a ray leaves the box of all spheres before the height up to which they are known.
    fn leaves_early(&self, ray: &FromSurface) -> bool {
        let mut end = f32::INFINITY;
        for axis in 0..3 {
            let direction = ray.direction[axis];
            let corner = self.corners[usize::from(direction > 0.0)][axis];
            // Along an axis that it does not move on it does not leave.
            if direction != 0.0 {
                end = end.min((corner - ray.normal[axis]) / direction);
            }
        }
        end < self.height
    }
}

/// What rounding moves a point by, relatively.
const ROUNDING: f64 = 1e-12;

impl FromSurface {
    fn in_world(&self, own: usize, occluders: &Occluders<'_>) -> Ray {
        let sphere = &occluders.spheres[own];
        let unit = |of: Vec3| of.as_dvec3().normalize();
        let (normal, direction) = (unit(self.normal), unit(self.direction));
        Ray {
            origin: sphere.center() + normal * sphere.radius(),
            direction,
        }
    }
}

/// True if a ray meets a sphere of some groups.
#[inline(always)]
fn any_met<S: Simd>(simd: S, groups: &[Group], ray: &FromSurface) -> bool {
    let [dx, dy, dz] = ray.direction.to_array();
    for group in groups {
        let from_origin =
            |axis: usize| f32x8::from_array(simd, group.center[axis]) - ray.normal[axis];
        let (x, y, z) = (from_origin(0), from_origin(1), from_origin(2));
        // Of the center from the ray: differences of squares would lose what is far away.
        let (a, b, c) = (y * dz - z * dy, z * dx - x * dz, x * dy - y * dx);
        let aside = a * a + b * b + c * c;
        let along = x * dx + y * dy + z * dz;
        let radius_square = f32x8::from_array(simd, group.radius_square);
        let met = aside.simd_lt(radius_square) & along.simd_gt(f32x8::splat(simd, 0.0));
        if met.any_true() {
            return true;
        }
    }
    false
}
