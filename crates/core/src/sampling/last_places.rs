//! The geometry that center rays see, to the last places of doubles.

use fearless_simd::Simd;
use glam::{DVec2, DVec3};

use super::groups::{Group, Groups};
use super::rays::Place;
use super::trace::{Sight, Tracer};
use crate::hit::crossings::{Crossings, Targets};
use crate::model::camera::Projection;
use crate::model::view::View;
use crate::numeric::bits::set_bits;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::fused::is_fused;
use crate::numeric::lanes::{LANES, f64x8, mask64x8};
use crate::numeric::vectors::Vectors;
use crate::picture::geometry::RowGeometry;
use crate::picture::quantities::{Axes, Depth, GeometrySettings, Quantity};

/// Tells depths, positions and geometric normals to their last places.
#[derive(Clone, Debug)]
pub(super) struct LastPlaces {
    pub(super) settings: GeometrySettings,
    pub(super) viewpoint: DVec3,
    /// Unit vectors of the axes, in the world frame.
    pub(super) axes: [DVec3; 3],
    /// The factors of retina points that make them points in the camera's axes; none for the world's.
    pub(super) signs: Option<DVec3>,
}

/// Eight rays, and what they see.
pub(super) struct Seen<'a, 'tile, S: Simd> {
    pub(super) sight: &'a Sight<S>,
    pub(super) groups: &'a Groups<'tile>,
    pub(super) place: Place,
    /// Their places on the retina, to the right.
    pub(super) across: f64x8<S>,
}

impl LastPlaces {
    pub(super) fn new(view: &View, settings: GeometrySettings) -> Self {
        let signs = match settings.axes {
            Axes::World => None,
            Axes::CameraOpenCv => Some(DVec3::new(1.0, -1.0, 1.0)),
            Axes::CameraOpenGl => Some(DVec3::new(1.0, 1.0, -1.0)),
        };
        let camera = &view.camera.world_from_camera;
        let axes = signs.map_or([DVec3::X, DVec3::Y, DVec3::Z], |signs| {
            [
                camera.x_axis * signs.x,
                camera.y_axis * signs.y,
                camera.z_axis * signs.z,
            ]
        });
        Self {
            settings,
            viewpoint: view.camera.position,
            axes,
            signs,
        }
    }

    #[inline(always)]
    pub(super) fn wants(&self, quantity: Quantity) -> bool {
        self.settings.quantities.has(quantity)
    }

    #[inline(always)]
    pub(super) fn put<S: Simd>(
        &self,
        row: &mut RowGeometry,
        place: (Quantity, usize),
        values: f64x8<S>,
    ) {
        row.put(self.settings.precision, place, values.into());
    }

    /// Writes what eight rays see; returns the lanes that have to be computed alone.
    #[inline(never)]
    pub(super) fn place<S: Simd>(
        &self,
        simd: S,
        seen: &Seen<'_, '_, S>,
        tracer: &Tracer<'_>,
        row: &mut RowGeometry,
    ) -> u64 {
        simd.vectorize(
            #[inline(always)]
            || match is_fused(simd) {
                true => self.cross::<S, true>(simd, seen, tracer, row),
                false => self.cross::<S, false>(simd, seen, tracer, row),
            },
        )
    }

    /// The same, with or without fused operations.
    #[inline(always)]
    fn cross<S: Simd, const FUSED: bool>(
        &self,
        simd: S,
        seen: &Seen<'_, '_, S>,
        tracer: &Tracer<'_>,
        row: &mut RowGeometry,
    ) -> u64 {
        let &Seen {
            sight,
            place,
            across,
            ..
        } = seen;
        let is_parallel = tracer.rays.projection() == Projection::Parallel;
        let shrink = libm::scalbn(1.0, -tracer.index.length_exponent());
        let viewpoint = Vectors::splat(simd, self.viewpoint);
        let (mut origins, mut way) = (viewpoint, sight.point);
        if is_parallel {
            for lane in 0..LANES {
                let pixel = lane.min(tracer.tile.width as usize - 1);
                origins.set_lane(lane, tracer.rays.ray(place, pixel).origin);
            }
            let aside = origins.minus(&viewpoint).times(f64x8::splat(simd, shrink));
            way = way.minus(&aside);
        }
        let spheres = tracer.index.visibility.spheres();
        let mut targets = None;
        for Group { ball, lanes } in seen.groups.as_slice() {
            let sphere = &spheres[ball.index()];
            let own = match is_parallel {
                true => Targets::seen_from::<FUSED>(simd, sphere, &origins, shrink),
                false => Targets::splat::<FUSED>(simd, sphere, self.viewpoint, shrink),
            };
            targets = Some(match &targets {
                None => own,
                Some(others) => own.or(mask64x8::from_bitmask(simd, *lanes), others),
            });
        }
        let Some(targets) = targets else {
            return sight.covered;
        };
        let mut t = way.dot(&sight.direction) / sight.length_sq;
        let inner = mask64x8::from_bitmask(simd, sight.inner);
        if sight.inner != 0 && !is_parallel {
            // These points are where the ray behind the viewpoint leaves the sphere.
            t = inner.select(targets.other_side(&sight.direction, t), t);
        }
        let crossings = Crossings::<S, FUSED>::new(simd, sight.direction, (t, inner), &targets);

        let covered = mask64x8::from_bitmask(simd, sight.covered);
        let length = libm::scalbn(1.0, tracer.index.length_exponent());
        let scale = libm::scalbn(1.0, -tracer.rays.exponent());
        let forward = f64x8::splat(simd, tracer.rays.magnification() * scale);
        let one = f64x8::splat(simd, 1.0);
        let mut unproved = 0;
        if self.wants(Quantity::Depth) {
            let (depth, proved) = match self.settings.depth {
                // Directions are unit vectors along the axis.
                _ if is_parallel => crossings.times(simd, one),
                Depth::Axis => crossings.times(simd, forward),
                Depth::Ray => crossings.lengths(simd),
            };
            unproved |= !proved.to_bitmask();
            let never = f64x8::splat(simd, f64::INFINITY);
            let depth = covered.select(depth * length, never);
            self.put(row, (Quantity::Depth, 0), depth);
        }
        if self.wants(Quantity::Position) {
            let (position, proved) = match self.signs {
                None => crossings.positions(&origins, length),
                Some(signs) if is_parallel => {
                    let forward = tracer.rays.magnification();
                    let upward = tracer.rays.upward(place) / forward * signs.y;
                    let x = across / f64x8::splat(simd, forward) * signs.x;
                    let (z, proved) = crossings.times(simd, one * signs.z);
                    let upward = f64x8::splat(simd, upward);
                    (Vectors::from_array([x, upward, z * length]), proved)
                }
                Some(signs) => {
                    let upward = f64x8::splat(simd, tracer.rays.upward(place) * scale);
                    let (x, proved_x) = crossings.times(simd, across * scale * signs.x);
                    let (y, proved_y) = crossings.times(simd, upward * signs.y);
                    let (z, proved_z) = crossings.times(simd, forward * signs.z);
                    let position = Vectors::from_array([x * length, y * length, z * length]);
                    (position, proved_x & proved_y & proved_z)
                }
            };
            unproved |= !proved.to_bitmask();
            self.put_vectors(simd, row, Quantity::Position, covered, &position);
        }
        if self.wants(Quantity::Normal) || self.wants(Quantity::GeometricNormal) {
            let (normal, proved) = match self.signs {
                None => crossings.normals(),
                Some(_) => crossings.normals_along(&self.axes),
            };
            unproved |= !proved.to_bitmask();
            self.put_vectors(simd, row, Quantity::GeometricNormal, covered, &normal);
        }
        // Of parallel rays each is alone, and its point right.
        let alone = if is_parallel { 0 } else { sight.alone };
        (unproved & sight.covered) | alone
    }

    /// Writes vectors where something is seen.
    #[inline(always)]
    pub(super) fn put_vectors<S: Simd>(
        &self,
        simd: S,
        row: &mut RowGeometry,
        quantity: Quantity,
        covered: mask64x8<S>,
        vectors: &Vectors<S>,
    ) {
        let zero = f64x8::splat(simd, 0.0);
        for axis in 0..3 {
            let component = covered.select(vectors.along(axis), zero);
            self.put(row, (quantity, axis), component);
        }
    }

    /// Computes single rays, each component to its own last places.
    #[cold]
    #[inline(never)]
    pub(super) fn place_alone<S: Simd>(
        &self,
        seen: &Seen<'_, '_, S>,
        tracer: &Tracer<'_>,
        lanes: u64,
        row: &mut RowGeometry,
    ) {
        let spheres = tracer.index.visibility.spheres();
        for lane in set_bits(lanes) {
            let pixel = lane.min(tracer.tile.width as usize - 1);
            let ray = tracer.rays.ray(seen.place, pixel);
            let sphere = &spheres[row.ids[lane] as usize];
            let Some(found) = sphere.hit_components(&ray, &self.axes) else {
                continue;
            };
            let forward = tracer.rays.magnification();
            let retina = DVec2::new(seen.across[lane], tracer.rays.upward(seen.place));
            let (depth, in_camera) = match tracer.rays.projection() {
                Projection::Central => {
                    let depth = match self.settings.depth {
                        Depth::Axis => found.t * forward,
                        Depth::Ray => times_length(found.t, ray.direction),
                    };
                    (depth, retina.extend(forward) * found.t)
                }
                // Directions are unit vectors along the axis.
                Projection::Parallel => (found.t, (retina / forward).extend(found.t)),
            };
            let position = self.signs.map_or(found.position, |signs| in_camera * signs);
            row.put_one((Quantity::Depth, 0), lane, depth);
            for axis in 0..3 {
                row.put_one((Quantity::Position, axis), lane, position[axis]);
                row.put_one((Quantity::GeometricNormal, axis), lane, found.normal[axis]);
            }
        }
    }
}

/// A number times the length of a vector, in twice the precision until it is rounded.
fn times_length(number: f64, vector: DVec3) -> f64 {
    let exponent = libm::ilogb(vector.abs().max_element()).clamp(-1000, 1000);
    let part = |axis: usize| {
        let part = libm::scalbn(vector[axis], -exponent);
        DoubleDouble::<false>::product(part, part)
    };
    let length = (part(0) + part(1) + part(2)).sqrt();
    libm::scalbn(number * length.high + number * length.low, exponent)
}
