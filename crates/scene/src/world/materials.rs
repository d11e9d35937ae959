//! The materials of a scene file.

use std::collections::HashMap;
use std::ops::Range;

use marbles_core::{
    Grain, Highlight, Material, MaterialId, Outline, OutlineWidth, Roughness, World,
};

use crate::file;
use crate::text::{Placed, did_you_mean, list, optional, quoted, refuse};
use crate::values::MaterialName;

/// The materials by name.
pub(super) struct Materials<'f> {
    /// `None` for materials that are refused.
    ids: HashMap<&'f str, Option<MaterialId>>,
    /// The names in the order of the file.
    names: Vec<&'f str>,
    /// The number of unknown names that were reported.
    unknown: usize,
    /// The material of what has none.
    white: Option<MaterialId>,
}

impl<'f> Materials<'f> {
    /// The materials of the file, added to the world.
    pub(super) fn new(materials: &'f file::Materials, world: &mut World) -> Self {
        let mut all = Self {
            ids: HashMap::new(),
            names: Vec::new(),
            unknown: 0,
            white: None,
        };
        for (name, material) in &materials.0 {
            let Some(MaterialName(text)) = &name.value else {
                continue;
            };
            let id = self::material(material).map(|material| world.add_material(material));
            if all.ids.insert(text, id).is_none() {
                all.names.push(text);
                continue;
            }
            let found = quoted(text);
            let message = format!("expected every material once, found {found} a second time");
            refuse::<()>(name.place.clone(), message);
        }
        all
    }

    /// The material of this name; `None` where a fault was reported.
    pub(super) fn find(
        &mut self,
        name: Option<&Placed<MaterialName>>,
        world: &mut World,
    ) -> Option<MaterialId> {
        let Some(name) = name else {
            let white = || world.add_material(Material::MATTE_WHITE);
            return Some(*self.white.get_or_insert_with(white));
        };
        let MaterialName(text) = name.value.as_ref()?;
        match self.ids.get(text.as_str()) {
            Some(id) => *id,
            None => self.refuse_unknown(name.place.clone(), text),
        }
    }

    /// Reports the name of a material that does not exist, and the names that do.
    fn refuse_unknown<T>(&mut self, place: Range<usize>, name: &str) -> Option<T> {
        // Comparing every name of a large file with every other would take too long, and only the
        // first few faults are shown.
        const MOST_COMPARED: usize = 20;
        const LONGEST_LIST: usize = 6;
        self.unknown += 1;
        let compared = if self.unknown <= MOST_COMPARED {
            &self.names[..]
        } else {
            &[]
        };
        let meant = did_you_mean(name, compared.iter().copied(), quoted);
        let known = match self.names.len() {
            _ if !meant.is_empty() => String::new(),
            0 => String::from(" (the scene has no materials)"),
            1..=LONGEST_LIST => {
                let names: Vec<String> = self.names.iter().map(|name| quoted(name)).collect();
                format!(" ({})", list(&names))
            }
            _ => String::new(),
        };
        let found = quoted(name);
        let message = format!("expected the name of a material{known}, found {found}{meant}");
        refuse(place, message)
    }
}

fn material(material: &Placed<file::Material>) -> Option<Material> {
    let material = material.value.as_ref()?;
    Some(Material {
        albedo: material.albedo.get()?.0,
        exponent: material.exponent.get()?.0,
        highlight: optional(&material.highlight, highlight)?,
        roughness: optional(&material.rough, roughness)?,
        outline: optional(&material.outline, outline)?,
    })
}

fn highlight(highlight: &file::Highlight) -> Option<Highlight> {
    Some(Highlight {
        strength: highlight.strength.get()?.0,
        shininess: highlight.shininess.get()?.0,
    })
}

fn outline(outline: &file::Outline) -> Option<Outline> {
    Some(Outline {
        width: match *outline.width.value.as_ref()? {
            file::Width::Pixels(width) => OutlineWidth::Pixels(width),
            file::Width::Units(width) => OutlineWidth::Units(width),
        },
        color: outline.color.get()?.0,
    })
}

fn roughness(rough: &file::Rough) -> Option<Roughness> {
    Some(Roughness {
        amplitude: rough.amplitude.get()?.0,
        grain: match rough.grain.value.as_ref()? {
            file::Grain::Surface(size) => Grain::Surface(size.get()?.0),
            file::Grain::Pixel => Grain::Pixel,
        },
        seed: rough.seed.get()?.0,
    })
}
