//! The world that a scene file describes.

use glam::DVec3;
use marbles_core::{Sky, Sphere, World};

use super::cloud::Cloud;
use super::materials::Materials;
use crate::file::{self, File};
use crate::text::{Placed, optional};

/// The world of the file without its lights and clouds, and these; `None` where a fault was reported.
pub(crate) fn world(file: &File) -> Option<(World, Vec<Cloud>)> {
    // Everything is looked at before anything is missed, so that all faults are reported.
    let mut world = World::new();
    let mut materials = Materials::new(&file.materials, &mut world);
    let spheres = spheres(file, &mut materials, &mut world);
    let cloud = |cloud: &Placed<file::Cloud>| {
        let cloud = cloud.value.as_ref()?;
        let material = materials.find(cloud.material.as_ref(), &mut world);
        Cloud::new(cloud, material?)
    };
    let clouds: Vec<_> = file.clouds.iter().map(cloud).collect();
    let sky = optional(&file.sky, sky);
    world.ambient = file.ambient.get()?.0;
    world.background = file.background.get()?.0;
    world.shadows = file.shadows.get()?.0;
    world.sky = sky?;
    spheres?;
    let clouds = clouds.into_iter().collect::<Option<_>>()?;
    Some((world, clouds))
}

fn spheres(file: &File, materials: &mut Materials<'_>, world: &mut World) -> Option<()> {
    let mut all = Some(());
    for sphere in &file.spheres {
        let added = sphere.value.as_ref().and_then(|sphere| {
            let material = materials.find(sphere.material.as_ref(), world);
            let (center, radius) = (sphere.center.get()?.0, sphere.radius.get()?.0);
            let sphere = Sphere::new(center, radius).ok()?;
            world.add_sphere(sphere, material?);
            Some(())
        });
        all = all.and(added);
    }
    all
}

/// The sky of the file; `None` where a fault was reported.
fn sky(sky: &file::Sky) -> Option<Sky> {
    match sky {
        file::Sky::Uniform(radiance) => Some(Sky::uniform(radiance.0)),
        file::Sky::Halves(halves) => {
            let [above, below] = [&halves.above, &halves.below].map(Placed::get);
            let up = match &halves.up {
                Some(up) => up.direction()?,
                None => DVec3::Y,
            };
            Sky::in_halves(above?.0, below?.0, up).ok()
        }
    }
}
