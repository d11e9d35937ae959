//! The outlines of what eight rays see.

use fearless_simd::Simd;

use super::groups::{Group, Groups};
use super::light::{Light, Shading};
use super::trace::Sight;
use crate::model::camera::Projection;
use crate::numeric::lanes::{f64x8, mask64x8};

impl Shading<'_> {
    /// Puts the outlines of spheres in the place of light.
    ///
    /// A ray in the direction d passes the smaller sphere of radius s where it meets the larger one, of radius r, with
    /// (n · d)² < d² (r − s) (r + s) / r².
    #[cold]
    #[inline(never)]
    pub(super) fn add_outlines<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        sight: &Sight<S>,
        groups: &Groups<'_>,
        mut light: Light<S, CHANNELS>,
    ) -> Light<S, CHANNELS> {
        let Some((view, camera_from_world)) = self.outlines else {
            return light;
        };
        for Group { ball, lanes } in groups.as_slice() {
            let (index, lanes) = (ball.index(), lanes & !sight.inner);
            let (Some(outline), 1..) = (self.world.material(index).outline, lanes) else {
                continue;
            };
            let sphere = &self.world.spheres()[index];
            let (center, radius) = (sphere.center() - self.viewpoint, sphere.radius());
            let center = camera_from_world * center;
            // The plane in which parallel rays begin cuts it.
            if view.projection == Projection::Parallel && center.z < radius {
                continue;
            }
            let inner = outline.width.inner_radius(view, center, radius);
            let limit = (radius - inner) * (radius + inner) / (radius * radius);
            simd.vectorize(
                #[inline(always)]
                || {
                    let along = sight.normal.dot(&sight.direction);
                    let is_outline = (along * along).simd_lt(sight.length_sq * limit);
                    let mask = is_outline & mask64x8::from_bitmask(simd, lanes);
                    for (channel, light) in light.iter_mut().enumerate() {
                        let color = f64x8::splat(simd, outline.color[channel]);
                        *light = mask.select(color, *light);
                    }
                },
            );
        }
        light
    }
}
