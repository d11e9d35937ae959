//! Possible oversights in a scene file.

use std::collections::HashSet;
use std::ops::Range;

use glam::DVec3;

use crate::file::{File, Lens};
use crate::text::{harmless, list, quoted};

/// A field of view of so many degrees looks like one in radians; fewer are those of a telescope.
const LIKE_RADIANS: Range<f64> = 0.05..3.2;

/// Smaller numbers are seldom the bytes of a color: 8 is nearly black.
const LEAST_BYTE: f64 = 8.0;

/// Plain sentences, what is odd first, and then what to do.
pub(super) fn warnings(file: &File) -> Vec<String> {
    let mut warnings = Vec::new();
    for (name, material) in &file.materials.0 {
        let name = name
            .value
            .as_ref()
            .map(|name| quoted(&name.0))
            .unwrap_or_default();
        let albedo = material
            .value
            .as_ref()
            .and_then(|material| material.albedo.get());
        warnings.extend(albedo.and_then(|albedo| self::albedo(&name, albedo.0)));
    }
    warnings.extend(unused_materials(file));
    let background = file.background.get().map(|color| color.0);
    if let Some(code) = background.and_then(bytes) {
        warnings.push(format!(
            "background: numbers above 1 look like bytes: {code} is this color, and 1 is white"
        ));
    }
    warnings
}

/// Plain sentences about what is allowed and may be meant, but seldom is: nobody has to change it.
pub(super) fn hints(file: &File) -> Vec<String> {
    lens(file).into_iter().collect()
}

fn lens(file: &File) -> Option<String> {
    let Lens::Fov(angle) = file.lens.value.as_ref()? else {
        return None;
    };
    let degrees = angle.get()?.0;
    LIKE_RADIANS.contains(&degrees).then(|| {
        let meant = (10.0 * degrees.to_degrees()).round() / 10.0;
        format!(
            "lens: Fov({degrees}) means {degrees} degrees; if you meant radians, write Fov({meant})"
        )
    })
}

fn albedo(name: &str, albedo: DVec3) -> Option<String> {
    if let Some(code) = bytes(albedo) {
        return Some(format!(
            "material {name}: numbers above 1 look like bytes: {code} is this color, and 1 is white"
        ));
    }
    let most = albedo.max_element();
    (most > 1.0).then(|| {
        format!("material {name}: with an albedo of {most}, the surface reflects {most} times the light that it receives")
    })
}

/// The color whose bytes a color looks like.
fn bytes(color: DVec3) -> Option<String> {
    let channels = color.to_array();
    let is_byte = |channel: &f64| (0.0..=255.0).contains(channel) && channel.fract() == 0.0;
    let is_like_bytes = channels.iter().all(is_byte) && color.max_element() >= LEAST_BYTE;
    let [red, green, blue] = channels.map(|channel| channel as u8);
    is_like_bytes.then(|| format!("\"#{red:02x}{green:02x}{blue:02x}\""))
}

fn unused_materials(file: &File) -> Option<String> {
    let of_spheres = file
        .spheres
        .iter()
        .filter_map(|sphere| sphere.value.as_ref()?.material.as_ref());
    let of_clouds = file
        .clouds
        .iter()
        .filter_map(|cloud| cloud.value.as_ref()?.material.as_ref());
    let used = of_spheres
        .chain(of_clouds)
        .filter_map(|name| name.value.as_ref());
    let used: HashSet<&str> = used.map(|name| &*name.0).collect();
    let names = file
        .materials
        .0
        .iter()
        .filter_map(|(name, _)| name.value.as_ref());
    let unused: Vec<String> = names
        .filter(|name| !used.contains(&*name.0))
        .map(|name| harmless(&format!("{:?}", name.0)))
        .collect();
    match unused.len() {
        0 => None,
        1 => Some(format!(
            "the material {} is not used by any sphere or cloud",
            unused[0]
        )),
        2..=6 => Some(format!(
            "no sphere and no cloud uses the material {}",
            list(&unused)
        )),
        count => Some(format!(
            "no sphere and no cloud uses {count} of the materials, for example {}",
            unused[0]
        )),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::Scene;

    #[test]
    fn angles_like_radians_are_no_more_than_a_hint() {
        let of = |lens: &str| {
            let text = format!("(image: (width: 6, height: 4), lens: {lens}, camera: Free())");
            let scene = Scene::parse(&text, Path::new("scene.ron")).unwrap();
            assert!(scene.warnings().is_empty());
            scene.hints().join("; ")
        };
        assert_eq!(
            of("Fov(0.9)"),
            "lens: Fov(0.9) means 0.9 degrees; if you meant radians, write Fov(51.6)"
        );
        assert_eq!(of("Fov(50)"), "");
        assert_eq!(of("Fov(1e-9)"), "");
    }

    #[test]
    fn oversights_of_the_file_are_told() {
        let of = |lens: &str, fields: &str| {
            let text =
                format!("(image: (width: 6, height: 4), lens: {lens}, camera: Free(), {fields})");
            let scene = Scene::parse(&text, Path::new("scene.ron")).unwrap();
            scene.warnings().join("; ")
        };
        let ball = "spheres: [(center: (0, 0, 5), radius: 1, material: \"m\")]";
        for (lens, fields, expected) in [
            ("Fov(50)", "materials: {\"m\": (albedo: (1, 0.5, 0))}", ""),
            // The moon, and many a telescope.
            ("Fov(0.5)", "", ""),
            (
                "Fov(50)",
                "materials: {\"m\": (albedo: (200, 30, 0))}",
                "material \"m\": numbers above 1 look like bytes: \"#c81e00\" is this color, and 1 is white",
            ),
            (
                "Fov(50)",
                "materials: {\"m\": (albedo: 1.5)}",
                "material \"m\": with an albedo of 1.5, the surface reflects 1.5 times the light that it receives",
            ),
            (
                "Fov(50)",
                "materials: {\"m\": (albedo: 3)}",
                "material \"m\": with an albedo of 3, the surface reflects 3 times the light that it receives",
            ),
            (
                "Fov(50)",
                "materials: {\"m\": (), \"n\": ()}",
                "the material \"n\" is not used by any sphere or cloud",
            ),
            (
                "Fov(50)",
                "background: (255, 255, 255)",
                "background: numbers above 1 look like bytes: \"#ffffff\" is this color, and 1 is white",
            ),
        ] {
            let materials = if fields.contains("\"m\"") {
                ""
            } else {
                ", materials: {\"m\": ()}"
            };
            assert_eq!(
                of(
                    lens,
                    &format!("{ball}{materials}, {fields}").replace(", ,", ",")
                ),
                expected
            );
        }
    }
}
