//! Scenes that are easy to reduce.

use std::path::Path;

use marbles_scene::Scene;

use super::units::scaled;
use marbles_tests::numbers::Numbers;

/// A scene file in parts, and the settings for rendering it.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    /// Fields of the scene.
    pub(super) head: Vec<String>,
    pub(super) material: String,
    /// Further materials, each after a comma.
    pub(super) more_materials: String,
    pub(super) lights: Vec<String>,
    pub(super) spheres: Vec<String>,
    /// Spheres whose effect is too small to detect, so that reference pictures leave them out.
    pub(super) doubles: Vec<String>,
    /// The camera for reference pictures. It shows the same, from a distance at which doubles are precise enough.
    pub(super) near_camera: Option<String>,
    /// The units of light and of length. Reference pictures use 1.
    pub(super) light: f64,
    pub(super) length: f64,
    /// The size of a pixel at the distance of the spheres.
    pub(super) pixel: f64,
    /// Whether pictures have alpha instead of a background.
    pub(super) alpha: bool,
    /// Whether the picture shows only the first light.
    pub(super) per_light: bool,
    /// The kind of the scene, within its family.
    pub(super) kind: String,
}

impl Draft {
    /// A scene without spheres: a camera at the origin that looks along z, with a random lens of about this distance in
    /// pixels, and some lights.
    pub(super) fn new(numbers: &mut Numbers, distance: f64, lights: usize) -> Self {
        let distance = distance * numbers.between(0.5, 2.0);
        let mut draft = Self {
            head: vec![
                format!("image: (width: {SIDE}, height: {SIDE})"),
                format!("lens: Retina(width: {SIDE}, distance: {distance})"),
                "camera: Free(position: (0, 0, 0))".to_owned(),
                format!(
                    "background: {}",
                    numbers.either(&["0", "0.3", "(0.1, 0.2, 0.5)"])
                ),
                format!("ambient: {}", numbers.either(&["0", "0.1"])),
                format!("shadows: {}", numbers.either(&["true", "true", "false"])),
            ],
            material: "albedo: 1".to_owned(),
            ..Self::empty()
        };
        for _ in 0..lights {
            let toward = [
                numbers.between(-1.0, 1.0),
                numbers.between(-1.0, 1.0),
                numbers.between(-1.2, 0.4),
            ];
            let share = 1.0 / lights as f64;
            draft.light(toward, numbers.between(0.3, 1.0) * share);
        }
        draft
    }

    /// An empty scene.
    pub(super) fn empty() -> Self {
        Self {
            head: Vec::new(),
            material: String::new(),
            more_materials: String::new(),
            lights: Vec::new(),
            spheres: Vec::new(),
            doubles: Vec::new(),
            near_camera: None,
            light: 1.0,
            length: 1.0,
            pixel: 1.0,
            alpha: false,
            per_light: false,
            kind: String::new(),
        }
    }

    pub(super) fn light(&mut self, [x, y, z]: [f64; 3], intensity: f64) {
        let light = format!("Directional(toward: ({x}, {y}, {z}), intensity: {intensity})");
        self.lights.push(light);
    }

    /// Moves the camera away from a point 100 units in front of it, and moves the retina away from the camera by the
    /// same factor: things at this point keep their size.
    pub(super) fn step_back(&mut self, times: f64) {
        let distance = self.head[1].trim_end_matches(')').rsplit(' ').next();
        let distance: f64 = distance.and_then(|it| it.parse().ok()).unwrap_or(f64::NAN);
        self.head[1] = format!(
            "lens: Retina(width: {SIDE}, distance: {})",
            distance * times
        );
        self.head[2] = format!("camera: Free(position: (0, 0, {}))", 100.0 * (1.0 - times));
    }

    /// A point light that is as bright, at this distance, as a directional light of this intensity.
    pub(super) fn point_light(
        &mut self,
        [x, y, z]: [f64; 3],
        intensity: f64,
        reference: Option<f64>,
    ) {
        let falloff = match reference {
            Some(reference) => format!("reference: {reference}"),
            None => "falloff: None".to_owned(),
        };
        let light = format!("Point(position: ({x}, {y}, {z}), intensity: {intensity}, {falloff})");
        self.lights.push(light);
    }

    /// Makes the last light, a point light, face a direction, with a power of the cosine of the angle to it.
    pub(super) fn face(&mut self, [x, y, z]: [f64; 3], mu: f64) {
        if let Some(light) = self.lights.last_mut()
            && light.starts_with("Point")
            && light.pop() == Some(')')
        {
            light.push_str(&format!(", direction: ({x}, {y}, {z}), mu: {mu})"));
        }
    }

    pub(super) fn sphere(&mut self, center: [f64; 3], radius: f64) {
        self.spheres.push(sphere(center, radius));
    }

    /// The scene file.
    pub(super) fn text(&self) -> String {
        let spheres = [&self.spheres[..], &self.doubles].concat();
        scaled(&self.unscaled(&spheres), self.light, self.length)
    }

    /// The file of an equivalent scene for reference pictures.
    fn plain_text(&self) -> String {
        let mut plain = self.clone();
        if let (Some(near), Some(camera)) = (&self.near_camera, plain.head.get_mut(2)) {
            camera.clone_from(near);
        }
        plain.unscaled(&self.spheres)
    }

    fn unscaled(&self, spheres: &[String]) -> String {
        let lines = |list: &[String]| {
            list.iter()
                .map(|item| format!("\n        {item},"))
                .collect::<String>()
        };
        let head: String = self
            .head
            .iter()
            .map(|field| format!("    {field},\n"))
            .collect();
        format!(
            "(\n{head}    lights: [{}\n    ],\n    materials: {{ \"m\": ({}){} }},\n    spheres: [{}\n    ],\n)\n",
            lines(&self.lights),
            self.material,
            self.more_materials,
            lines(spheres)
        )
    }

    pub(super) fn scene(&self) -> Result<Scene, String> {
        parsed(&self.text())
    }

    /// The scene for reference pictures.
    pub(super) fn plain(&self) -> Result<Scene, String> {
        parsed(&self.plain_text())
    }

    /// The scene for reference pictures with many frames instead of one, if the shutter is open from frame 1.5 to 2.5.
    pub(super) fn moments(&self) -> Option<Scene> {
        let text = self.plain_text();
        if !text.contains(OPEN) {
            return None;
        }
        let text = text
            .replace(OPEN, &format!("frames: (1, {})", 4 * MOMENTS))
            .replace("(frame: 1,", &format!("(frame: {MOMENTS},"))
            .replace("(frame: 3,", &format!("(frame: {},", 3 * MOMENTS));
        Scene::parse(&text, Path::new("hunt.ron")).ok()
    }

    /// The scene without one of its spheres or lights.
    pub(super) fn without(&self, index: usize) -> Option<Self> {
        let mut less = self.clone();
        if index < less.spheres.len() {
            less.spheres.remove(index);
        } else if index - less.spheres.len() < less.lights.len() {
            less.lights.remove(index - self.spheres.len());
        } else {
            return None;
        }
        Some(less)
    }

    /// The scene without the parts that reference pictures leave out.
    pub(super) fn without_doubles(&self) -> Option<Self> {
        (!self.doubles.is_empty()).then(|| Self {
            doubles: Vec::new(),
            ..self.clone()
        })
    }

    /// The scene with the radius of one sphere an ulp larger.
    pub(super) fn grown(&self, index: usize) -> Option<Self> {
        let (before, radius, after) = around_radius(self.spheres.get(index)?)?;
        let mut grown = self.clone();
        grown.spheres[index] = format!("{before}{:e}{after}", radius.next_up());
        Some(grown)
    }
}

/// A sphere in the syntax of the file.
pub(super) fn sphere([x, y, z]: [f64; 3], radius: f64) -> String {
    format!("(center: ({x}, {y}, {z}), radius: {radius}, material: \"m\")")
}

/// The radius of a sphere of the file, and the text before and after it.
fn around_radius(sphere: &str) -> Option<(&str, f64, &str)> {
    const NAME: &str = "radius: ";
    let (before, rest) = sphere.split_at(sphere.find(NAME)? + NAME.len());
    let (radius, after) = rest.split_at(rest.find([',', ')'])?);
    Some((before, radius.parse().ok()?, after))
}

fn parsed(text: &str) -> Result<Scene, String> {
    Scene::parse(text, Path::new("hunt.ron")).map_err(|error| error.to_string())
}

/// Columns and rows of the pictures.
pub(super) const SIDE: u32 = 32;

/// The frames of scenes with an open shutter, and the number of frames that replace one of them.
pub(super) const OPEN: &str = "frames: (1, 3), shutter: 1";
pub(super) const MOMENTS: i32 = 4096;
