//! The world that a scene file describes.

use glam::DVec3;
use marbles_core::{DirectionalLight, Sphere, World};

use super::cloud::Cloud;
use super::materials::Materials;
use crate::file::{self, File};
use crate::text::{Placed, refuse};

/// The world of the file without its clouds, and these; `None` where a fault was reported.
pub(crate) fn world(file: &File) -> Option<(World, Vec<Cloud>)> {
    // Everything is looked at before anything is missed, so that all faults are reported.
    let mut world = World::new();
    let mut materials = Materials::new(&file.materials, &mut world);
    let lights: Vec<_> = file.lights.iter().map(light).collect();
    let spheres = spheres(file, &mut materials, &mut world);
    let cloud = |cloud: &Placed<file::Cloud>| {
        let cloud = cloud.value.as_ref()?;
        let material = materials.find(cloud.material.as_ref(), &mut world);
        Cloud::new(cloud, material?)
    };
    let clouds: Vec<_> = file.clouds.iter().map(cloud).collect();
    world.lights = lights.into_iter().collect::<Option<_>>()?;
    world.ambient = file.ambient.get()?.0;
    world.background = file.background.get()?.0;
    world.shadows = file.shadows.get()?.0;
    spheres?;
    let clouds = clouds.into_iter().collect::<Option<_>>()?;
    Some((world, clouds))
}

fn light(light: &Placed<file::Light>) -> Option<DirectionalLight> {
    let file::Light::Directional { toward, intensity } = light.value.as_ref()?;
    let direction = toward.get()?.0;
    let radiance = intensity.get();
    let light = DirectionalLight::new(direction, radiance.map_or(DVec3::ONE, |color| color.0));
    if light.is_none() {
        let message = "expected a direction `(x, y, z)`, found the zero vector";
        return refuse(toward.place.clone(), message);
    }
    radiance.and(light)
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
