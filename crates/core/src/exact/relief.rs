//! Normals of rough surfaces, eight at a time.

use fearless_simd::prelude::*;
use glam::{DMat3, DVec3};

use super::scene::InCamera;
use crate::model::roughness::noise::NoiseCells;
use crate::model::roughness::{Bumps, unit};
use crate::numeric::vectors::Vectors;

/// What turns the normals of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Relief {
    Smooth,
    Bumpy(Bumps),
    /// Factors of the components, in the world's frame.
    Factors(DVec3),
}

impl Relief {
    /// Turns normals of a rough surface.
    #[inline(never)]
    pub(crate) fn turn<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        normals: &mut [Vectors<S>],
        noise: &mut Option<Box<NoiseCells>>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let to_world = &scene.world_from_camera;
                let from_world = &to_world.transpose();
                match self {
                    Self::Smooth => {}
                    Self::Bumpy(bumps) => {
                        let noise = noise.get_or_insert_with(|| Box::new(NoiseCells::new()));
                        for normal in &mut *normals {
                            let Vectors { x, y, z } = turned(normal, to_world);
                            let [x, y, z] = bumps.scale_lanes([x, y, z], noise);
                            *normal = Vectors { x, y, z };
                        }
                    }
                    Self::Factors(factors) => {
                        for normal in &mut *normals {
                            let mut rough = turned(normal, to_world);
                            rough.x *= factors.x;
                            rough.y *= factors.y;
                            rough.z *= factors.z;
                            *normal = rough;
                        }
                    }
                }
                for normal in normals {
                    let [x, y, z] = unit([normal.x, normal.y, normal.z]);
                    *normal = turned(&Vectors { x, y, z }, from_world);
                }
            },
        )
    }
}

/// The vectors in another frame.
#[inline(always)]
fn turned<S: Simd>(vectors: &Vectors<S>, matrix: &DMat3) -> Vectors<S> {
    let rows = matrix.transpose();
    Vectors {
        x: vectors.dot_one(rows.x_axis),
        y: vectors.dot_one(rows.y_axis),
        z: vectors.dot_one(rows.z_axis),
    }
}
