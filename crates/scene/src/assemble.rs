//! From the file's structures to what core renders; checks what concerns more than one value.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3};
use marbles_core::{
    DirectionalLight, Grain, Highlight, Lens, Material, MaterialId, Roughness, Sphere, World,
};

use crate::cloud::Cloud;
use crate::fault::{Fault, report, show};
use crate::file::{self, File};
use crate::placed::Placed;
use crate::suggest::{closest, list};

/// The world of the file without its clouds, and these; `None` where a fault was reported.
pub(crate) fn world(file: &File) -> Option<(World, Vec<Cloud>)> {
    let mut world = World::new();
    let names = materials(file, &mut world);
    let lights: Vec<_> = file.lights.iter().map(light).collect();
    let mut names = Names {
        ids: names,
        unknown: UnknownNames::new(file),
        white: None,
    };
    let spheres = spheres(file, &mut names, &mut world);
    let clouds: Vec<_> = file
        .clouds
        .iter()
        .map(|cloud| {
            let cloud = cloud.value.as_ref()?;
            let material = names.material(cloud.material.as_ref(), &mut world);
            Cloud::new(cloud, material?)
        })
        .collect();
    world.lights = lights.into_iter().collect::<Option<_>>()?;
    world.ambient = file.ambient.get()?.0;
    world.background = file.background.get()?.0;
    world.shadows = file.shadows.get()?.0;
    spheres?;
    let clouds = clouds.into_iter().collect::<Option<_>>()?;
    Some((world, clouds))
}

/// The lens; `None` where a fault was reported.
pub(crate) fn lens(lens: &Placed<file::Lens>) -> Option<Lens> {
    match lens.value.as_ref()? {
        file::Lens::Retina {
            width,
            distance,
            shift,
        } => Some(Lens {
            width: width.get()?.0,
            distance: distance.get()?.0,
            shift: shift.get()?.0,
        }),
        file::Lens::Fov(degrees) => {
            let lens = Lens::from_field_of_view(degrees.get()?.0.to_radians());
            // The smallest angles vanish in radians.
            let width = lens.width.max(f64::MIN_POSITIVE);
            Some(Lens { width, ..lens })
        }
    }
}

/// The lens as the file writes it.
pub(crate) fn lens_as_written(lens: &Placed<file::Lens>) -> Option<String> {
    Some(match lens.value.as_ref()? {
        file::Lens::Retina {
            width,
            distance,
            shift,
        } => {
            let (width, distance, shift) = (width.get()?.0, distance.get()?.0, shift.get()?.0);
            if shift == DVec2::ZERO {
                format!("Retina(width: {width}, distance: {distance})")
            } else {
                let DVec2 { x, y } = shift;
                format!("Retina(width: {width}, distance: {distance}, shift: ({x}, {y}))")
            }
        }
        file::Lens::Fov(degrees) => format!("Fov({})", degrees.get()?.0),
    })
}

/// The materials of the file by name, added to the world; a name's value is `None` where the
/// material is refused.
fn materials<'f>(file: &'f File, world: &mut World) -> HashMap<&'f str, Option<MaterialId>> {
    let mut names = HashMap::new();
    for (name, material) in &file.materials.0 {
        let Some(file::MaterialName(text)) = &name.value else {
            continue;
        };
        let id = self::material(material).map(|material| world.add_material(material));
        if names.insert(text.as_str(), id).is_some() {
            report(Fault::new(
                name.place.clone(),
                format!(
                    "expected every material once, found {} a second time",
                    quoted(text)
                ),
            ));
        }
    }
    names
}

fn material(material: &Placed<file::Material>) -> Option<Material> {
    let material = material.value.as_ref()?;
    let highlight = match &material.highlight {
        Some(highlight) => {
            let highlight = highlight.value.as_ref()?;
            Some(Highlight {
                strength: highlight.strength.get()?.0,
                shininess: highlight.shininess.get()?.0,
            })
        }
        None => None,
    };
    let roughness = match &material.rough {
        Some(rough) => {
            let rough = rough.value.as_ref()?;
            Some(Roughness {
                amplitude: rough.amplitude.get()?.0,
                grain: match rough.grain.value.as_ref()? {
                    file::Grain::Surface(size) => Grain::Surface(size.get()?.0),
                    file::Grain::Pixel => Grain::Pixel,
                },
                seed: rough.seed.get()?.0,
            })
        }
        None => None,
    };
    Some(Material {
        albedo: material.albedo.get()?.0,
        exponent: material.exponent.get()?.0,
        highlight,
        roughness,
    })
}

fn light(light: &Placed<file::Light>) -> Option<DirectionalLight> {
    let file::Light::Directional { toward, intensity } = light.value.as_ref()?;
    let radiance = intensity.get();
    let light = DirectionalLight::new(
        toward.get()?.0,
        radiance.map_or(DVec3::ONE, |color| color.0),
    );
    if light.is_none() {
        report(Fault::new(
            toward.place.clone(),
            String::from("expected a direction `(x, y, z)`, found the zero vector"),
        ));
    }
    radiance.and(light)
}

fn spheres(file: &File, names: &mut Names<'_>, world: &mut World) -> Option<()> {
    let mut all = Some(());
    for sphere in &file.spheres {
        let Some(sphere) = &sphere.value else {
            all = None;
            continue;
        };
        let material = names.material(sphere.material.as_ref(), world);
        let solid = match (sphere.center.get(), sphere.radius.get()) {
            (Some(center), Some(radius)) => Sphere::new(center.0, radius.0).ok(),
            _ => None,
        };
        match (solid, material) {
            (Some(solid), Some(material)) => world.add_sphere(solid, material),
            _ => all = None,
        }
    }
    all
}

/// The materials by name.
struct Names<'f> {
    /// `None` for materials that are refused.
    ids: HashMap<&'f str, Option<MaterialId>>,
    unknown: UnknownNames<'f>,
    /// The material of what has none.
    white: Option<MaterialId>,
}

impl Names<'_> {
    /// The material of this name; `None` where a fault was reported.
    fn material(
        &mut self,
        name: Option<&Placed<file::MaterialName>>,
        world: &mut World,
    ) -> Option<MaterialId> {
        let Some(name) = name else {
            let white = || world.add_material(Material::MATTE_WHITE);
            return Some(*self.white.get_or_insert_with(white));
        };
        let file::MaterialName(text) = name.value.as_ref()?;
        match self.ids.get(text.as_str()) {
            Some(id) => *id,
            None => self.unknown.report(name.place.clone(), text),
        }
    }
}

/// Reports names of materials that do not exist, and what does.
struct UnknownNames<'f> {
    known: Vec<&'f str>,
    reported: usize,
}

impl<'f> UnknownNames<'f> {
    fn new(file: &'f File) -> Self {
        let names = file.materials.0.iter();
        let mut seen = HashSet::new();
        Self {
            known: names
                .filter_map(|(name, _)| name.value.as_ref().map(|name| name.0.as_str()))
                .filter(|&name| seen.insert(name))
                .collect(),
            reported: 0,
        }
    }

    fn report<T>(&mut self, place: std::ops::Range<usize>, name: &str) -> Option<T> {
        // Comparing every name of a large file with every other would take too long, and only the
        // first few faults are shown.
        const MOST_COMPARED: usize = 20;
        const LONGEST_LIST: usize = 6;
        self.reported += 1;
        let known = || self.known.iter().copied();
        let close = (self.reported <= MOST_COMPARED).then(|| closest(name, known()));
        let close = close.flatten();
        let mut message = String::from("expected the name of a material");
        match (close, self.known.len()) {
            (None, 0) => message += " (the scene has no materials)",
            (None, 1..=LONGEST_LIST) => {
                let names: Vec<String> = known().map(quoted).collect();
                message += &format!(" ({})", list(&names));
            }
            _ => {}
        }
        message += &format!(", found {}", quoted(name));
        if let Some(close) = close {
            message += &format!(", did you mean {}?", quoted(close));
        }
        report(Fault::new(place, message));
        None
    }
}

/// A name in quotation marks, as a message shows it.
pub(crate) fn quoted(name: &str) -> String {
    show(&format!("\"{name}\""))
}
