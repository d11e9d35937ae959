//! The geometry that the rays through the centers of pixels see.

use fearless_simd::Simd;

use super::groups::{Group, Groups};
use super::last_places::{LastPlaces, Seen};
use super::light::{Looks, Shading};
use super::trace::{DISTANCE_ERROR, Sight, Tracer};
use crate::model::camera::Projection;
use crate::model::view::View;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f64x8, mask64x8};
use crate::numeric::vectors::Vectors;
use crate::picture::geometry::{Geometry, RowGeometry};
use crate::picture::quantities::{Depth, GeometrySettings, Precision, Quantity};

/// The relative error of a number that is rounded to a float of 32 bits: with the rounding, one unit in the
/// last place at most.
const SINGLE: f64 = 1.0 / (1_u64 << 25) as f64;

/// Tells what the center rays see.
#[derive(Clone, Debug)]
pub(super) struct Centers {
    places: LastPlaces,
}

impl Centers {
    pub(super) fn new(view: &View, settings: GeometrySettings) -> Self {
        Self {
            places: LastPlaces::new(view, settings),
        }
    }

    /// Writes down what eight rays see.
    #[inline(never)]
    pub(super) fn record<S: Simd>(
        &self,
        simd: S,
        seen: &Seen<'_, '_, S>,
        tracer: &Tracer<'_>,
        shading: &Shading<'_>,
        looks: &mut Looks<'_>,
        row: &mut RowGeometry,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                row.sees_any = true;
                let (inverse_radius, albedos) = self.look_up(simd, seen.groups, shading, row);
                if self.places.wants(Quantity::Albedo) {
                    for (axis, albedo) in albedos.into_iter().enumerate() {
                        self.places.put(row, (Quantity::Albedo, axis), albedo);
                    }
                }
                let doubtful = self.place(simd, seen, tracer, inverse_radius, row);
                if doubtful != 0 {
                    self.places.place_alone(seen, tracer, doubtful, row);
                }
                if self.places.wants(Quantity::Normal) {
                    self.tilt(simd, seen, shading, looks, row);
                }
            },
        );
    }

    /// The numbers of the spheres that are seen: indices, to the row; 1 / r; and albedos.
    #[inline(always)]
    fn look_up<S: Simd>(
        &self,
        simd: S,
        groups: &Groups<'_>,
        shading: &Shading<'_>,
        row: &mut RowGeometry,
    ) -> (f64x8<S>, [f64x8<S>; 3]) {
        let zero = f64x8::splat(simd, 0.0);
        let (mut inverse_radius, mut albedos) = (zero, [zero; 3]);
        row.ids = [Geometry::NOTHING; LANES];
        for Group { ball, lanes } in groups.as_slice() {
            let mask = mask64x8::from_bitmask(simd, *lanes);
            let own = f64x8::splat(simd, ball.inverse_radius);
            inverse_radius = mask.select(own, inverse_radius);
            for (lane, id) in row.ids.iter_mut().enumerate() {
                let is_own = lanes >> lane & 1 == 1;
                *id = if is_own { ball.index() as u32 } else { *id };
            }
            if self.places.wants(Quantity::Albedo) {
                let own = shading.world.albedo(ball.index());
                for (axis, albedo) in albedos.iter_mut().enumerate() {
                    *albedo = mask.select(f64x8::splat(simd, own[axis]), *albedo);
                }
            }
        }
        (inverse_radius, albedos)
    }

    /// Depths, positions and geometric normals; returns the lanes that have to be computed alone.
    ///
    /// # Accuracy
    /// The point relative to the viewpoint is off by [`DISTANCE_ERROR`], each component by as much of itself;
    /// the normal (p − f) / r by that of p / r and by some roundings of its own. Where these are less than
    /// 2⁻²⁵ of a component, it serves a float. Doubles take it for a start.
    #[inline(always)]
    fn place<S: Simd>(
        &self,
        simd: S,
        seen: &Seen<'_, '_, S>,
        tracer: &Tracer<'_>,
        inverse_radius: f64x8<S>,
        row: &mut RowGeometry,
    ) -> u64 {
        let &Seen {
            sight,
            place,
            across,
            ..
        } = seen;
        let covered = mask64x8::from_bitmask(simd, sight.covered);
        let precision = self.places.settings.precision;
        let is_parallel = tracer.rays.projection() == Projection::Parallel;
        if precision == Precision::Double || is_parallel || sight.inner != 0 {
            return self.places.place(simd, seen, tracer, row);
        }
        let mut unproved = 0;
        let length = libm::scalbn(1.0, tracer.index.length_exponent());
        // p·d = t d·d, and no term is negative.
        let t = sight.point.dot(&sight.direction) / sight.length_sq;
        let scale = libm::scalbn(1.0, -tracer.rays.exponent());
        if self.places.wants(Quantity::Depth) {
            let depth = match self.places.settings.depth {
                Depth::Axis => t * (tracer.rays.magnification() * scale),
                Depth::Ray => t * sight.length_sq.sqrt(),
            };
            let never = f64x8::splat(simd, f64::INFINITY);
            self.places.put(
                row,
                (Quantity::Depth, 0),
                covered.select(depth * length, never),
            );
        }
        if self.places.wants(Quantity::Position) {
            let position = match self.places.signs {
                None => {
                    let way = sight.point.times(f64x8::splat(simd, length));
                    let position = way.plus(&Vectors::splat(simd, self.places.viewpoint));
                    let factor = f64x8::splat(simd, 2.0 * DISTANCE_ERROR);
                    let proved = is_small(simd, way.times(factor), position);
                    unproved |= !proved.to_bitmask();
                    position
                }
                Some(signs) => {
                    let upward = f64x8::splat(simd, tracer.rays.upward(place) * scale);
                    let forward = f64x8::splat(simd, tracer.rays.magnification() * scale);
                    let retina = [
                        across * scale * signs.x,
                        upward * signs.y,
                        forward * signs.z,
                    ];
                    Vectors::from_array(retina)
                        .times(t)
                        .times(f64x8::splat(simd, length))
                }
            };
            self.places
                .put_vectors(simd, row, Quantity::Position, covered, &position);
        }
        if self.places.wants(Quantity::Normal) || self.places.wants(Quantity::GeometricNormal) {
            let (normal, proved) = self.normals(simd, sight, inverse_radius);
            unproved |= !proved.to_bitmask();
            self.places
                .put_vectors(simd, row, Quantity::GeometricNormal, covered, &normal);
        }
        (unproved & sight.covered) | sight.alone
    }

    /// The geometric normals along the axes, and where they are proved.
    #[inline(always)]
    fn normals<S: Simd>(
        &self,
        simd: S,
        sight: &Sight<S>,
        inverse_radius: f64x8<S>,
    ) -> (Vectors<S>, mask64x8<S>) {
        let normal = sight.normal;
        let factor = inverse_radius * (2.0 * DISTANCE_ERROR);
        let error = sight.point.times(factor);
        if self.places.signs.is_none() {
            return (normal, is_small(simd, error, normal));
        }
        // Products and their sums add less than a half of DISTANCE_ERROR of the components.
        let slack = f64x8::splat(simd, DISTANCE_ERROR);
        let size = error.sizes().plus(&normal.sizes().times(slack));
        let [x, y, z] = self.places.axes;
        let turned = [normal.dot_one(x), normal.dot_one(y), normal.dot_one(z)];
        let error = [
            size.dot_one(x.abs()),
            size.dot_one(y.abs()),
            size.dot_one(z.abs()),
        ];
        let turned = Vectors::from_array(turned);
        (turned, is_small(simd, Vectors::from_array(error), turned))
    }

    /// The shading normals: the geometric ones, tilted where there are bumps.
    #[inline(always)]
    fn tilt<S: Simd>(
        &self,
        simd: S,
        seen: &Seen<'_, '_, S>,
        shading: &Shading<'_>,
        looks: &mut Looks<'_>,
        row: &mut RowGeometry,
    ) {
        row.copy_geometric_normals(self.places.settings.precision);
        if shading.is_smooth {
            return;
        }
        let mut rough = 0;
        for Group { ball, lanes } in seen.groups.as_slice() {
            if shading.world.material(ball.index()).roughness.is_some() {
                rough |= lanes & !seen.sight.inner;
            }
        }
        if rough == 0 {
            return;
        }
        let (sight, groups) = (seen.sight, seen.groups);
        let normal = shading.shading_normals(simd, sight, groups, seen.place, &mut looks.noise);
        for lane in set_bits(rough) {
            let normal = normal.lane(lane);
            for (number, axis) in self.places.axes.iter().enumerate() {
                row.put_one((Quantity::Normal, number), lane, axis.dot(normal));
            }
        }
    }
}

/// The lanes in which every component is known to [`SINGLE`], from errors of any sign.
#[inline(always)]
fn is_small<S: Simd>(simd: S, error: Vectors<S>, vector: Vectors<S>) -> mask64x8<S> {
    let (error, size) = (error.sizes(), vector.sizes());
    let most = size.times(f64x8::splat(simd, SINGLE));
    error.x.simd_le(most.x) & error.y.simd_le(most.y) & error.z.simd_le(most.z)
}
