//! Shadows, materials and spheres of a scene as JSON. With the camera and the lights, this is everything that another
//! renderer needs.

use marbles_core::{Grain, Material, OutlineWidth, World, right_handed};
use marbles_scene::Scene;
use serde_json::{Value, json};

use crate::base::failure::Failure;

/// The members `shadows`, `materials` and `spheres`. Only spheres of the scene file itself are listed; tables are
/// separate files.
pub(super) fn json(scene: &Scene, world: &World) -> Result<String, Failure> {
    let names = &scene.description().materials;
    let materials = names.iter().zip(world.materials());
    let materials = materials.map(|(name, material)| self::material(name, material));
    let first_of_tables = scene.clouds().first().map(|cloud| cloud.spheres.start);
    let count = first_of_tables.unwrap_or(world.spheres().len());
    let spheres = world.spheres().iter().take(count).enumerate();
    let spheres = spheres.map(|(index, sphere)| {
        let name = names.get(world.material_index(index) as usize);
        json!({
            "center": (right_handed(sphere.center()) + glam::DVec3::ZERO).to_array(),
            "radius": sphere.radius(),
            "albedo": world.albedo(index).to_array(),
            "material": name,
        })
    });
    let shadows = world.shadows;
    let (materials, spheres) = (list(materials)?, list(spheres)?);
    Ok(format!(
        "  \"shadows\": {shadows},\n  \"materials\": {materials},\n  \"spheres\": {spheres}"
    ))
}

fn material(name: &str, material: &Material) -> Value {
    let rough = material.roughness.map(|rough| {
        let size = match rough.grain {
            Grain::Surface(size) => Some(size),
            Grain::Pixel => None,
        };
        json!({"amplitude": rough.amplitude, "size": size, "seed": rough.seed})
    });
    let outline = material.outline.map(|outline| {
        let (width, unit) = match outline.width {
            OutlineWidth::Pixels(width) => (width, "pixels"),
            OutlineWidth::Units(width) => (width, "units"),
        };
        json!({"width": width, "unit": unit, "color": outline.color.to_array()})
    });
    let highlight = material
        .highlight
        .map(|highlight| json!({"strength": highlight.strength, "shininess": highlight.shininess}));
    json!({
        "name": name,
        "albedo": material.albedo.to_array(),
        "exponent": material.exponent,
        "highlight": highlight,
        "rough": rough,
        "outline": outline,
    })
}

/// A list with an item on each line.
fn list(items: impl Iterator<Item = Value>) -> Result<String, Failure> {
    let items = items.map(|item| serde_json::to_string(&item));
    let items = items.collect::<Result<Vec<String>, _>>();
    let items = items.map_err(|error| Failure::Work(error.to_string()))?;
    Ok(match items.is_empty() {
        true => "[]".to_owned(),
        false => format!("[\n    {}\n  ]", items.join(",\n    ")),
    })
}
