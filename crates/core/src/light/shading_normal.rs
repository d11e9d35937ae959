//! Shading normals of rough surfaces, eight at a time.

use fearless_simd::Simd;
use glam::{DMat3, DVec3};

use crate::model::roughness::noise::NoiseCells;
use crate::model::roughness::{Bumps, PixelKey, unit};
use crate::model::world::World;
use crate::numeric::vectors::Vectors;

/// The way from a sphere's normals to those that light is computed with.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ShadingNormal {
    /// They are the same.
    Smooth,
    Bumpy(Bumps),
    /// Their components are multiplied, in the world's frame.
    Factors(DVec3),
}

impl ShadingNormal {
    /// That of a sphere as a pixel sees it.
    pub(crate) fn new(world: &World, sphere: usize, pixel: PixelKey) -> Self {
        let Some(roughness) = &world.material(sphere).roughness else {
            return Self::Smooth;
        };
        match roughness.bumps(world.spheres()[sphere].radius(), sphere) {
            Some(bumps) => Self::Bumpy(bumps),
            None => Self::Factors(roughness.pixel_factors(sphere, pixel)),
        }
    }

    /// The shading normal at a normal, in the world's frame.
    pub(crate) fn of(&self, normal: DVec3, noise: &mut Option<Box<NoiseCells>>) -> DVec3 {
        match self {
            Self::Smooth => normal,
            Self::Bumpy(bumps) => {
                let noise = noise.get_or_insert_with(|| Box::new(NoiseCells::new()));
                bumps.perturb(normal, noise)
            }
            Self::Factors(factors) => (normal * factors).normalize(),
        }
    }

    pub(crate) fn is_smooth(&self) -> bool {
        matches!(self, Self::Smooth)
    }

    /// A bound of how many times as fast as the sphere's the shading normals turn.
    pub(crate) fn slope_bound(&self) -> f64 {
        match self {
            Self::Smooth => 1.0,
            Self::Factors(factors) => factors.max_element() / factors.min_element(),
            Self::Bumpy(bumps) => bumps.slope_bound(),
        }
    }

    /// A bound of the angle between a normal of the sphere and its shading normal.
    ///
    /// Positive factors from m to M turn a vector by no more than the angle with the cosine
    /// 2 √(m M) / (m + M), whose tangent is (M − m) / (2 √(m M)).
    pub(crate) fn most_tilt(&self) -> f64 {
        match self {
            Self::Smooth => 0.0,
            Self::Factors(factors) => {
                let (least, most) = (factors.min_element(), factors.max_element());
                libm::atan((most - least) / (2.0 * (least * most).sqrt()))
            }
            Self::Bumpy(bumps) => bumps.most_tilt(),
        }
    }

    /// The number of cells of the noise that a radius spans.
    pub(crate) fn cells(&self) -> f64 {
        match self {
            Self::Smooth | Self::Factors(_) => 0.0,
            Self::Bumpy(bumps) => bumps.cells(),
        }
    }

    /// Makes normals of a rough surface, in a camera's frame, shading normals.
    #[inline(never)]
    pub(crate) fn perturb<S: Simd>(
        &self,
        simd: S,
        world_from_camera: &DMat3,
        normals: &mut [Vectors<S>],
        noise: &mut Option<Box<NoiseCells>>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let camera_from_world = &world_from_camera.transpose();
                match self {
                    Self::Smooth => {}
                    Self::Bumpy(bumps) => {
                        let noise = noise.get_or_insert_with(|| Box::new(NoiseCells::new()));
                        for normal in &mut *normals {
                            let Vectors { x, y, z } = normal.rotated(world_from_camera);
                            let [x, y, z] = bumps.tilt_lanes(simd, [x, y, z], noise);
                            *normal = Vectors { x, y, z };
                        }
                    }
                    Self::Factors(factors) => {
                        for normal in &mut *normals {
                            let mut rough = normal.rotated(world_from_camera);
                            rough.x *= factors.x;
                            rough.y *= factors.y;
                            rough.z *= factors.z;
                            *normal = rough;
                        }
                    }
                }
                for normal in normals {
                    let [x, y, z] = unit([normal.x, normal.y, normal.z]);
                    *normal = Vectors { x, y, z }.rotated(camera_from_world);
                }
            },
        )
    }
}
