//! The world that is rendered.

use std::sync::Arc;

use glam::DVec3;

use super::albedos::Albedos;
use super::color::Color;
use super::light::Light;
use super::material::Material;
use super::material_ids::MaterialIds;
use super::sky::Sky;
use super::sphere::Sphere;
use crate::model::color::is_grey;
use crate::numeric::pair::three;

/// Everything that a camera may see, and its light.
///
/// Copies share the spheres until one of them gets more.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Light, Material, Sphere, World};
///
/// let mut world = World::new();
/// let white = world.add_material(Material::default());
/// for x in [-1.0, 0.0, 1.0] {
///     world.add_sphere(Sphere::new(DVec3::new(x, 0.0, 5.0), 0.4)?, white);
/// }
/// world.lights.push(Light::directional(DVec3::new(-1.0, 1.0, -1.0), DVec3::ONE)?);
/// world.ambient = DVec3::splat(0.1);
/// assert_eq!(world.spheres().len(), 3);
/// assert_eq!(world.albedo(2), DVec3::ONE);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct World {
    /// The lights, unless a picture has its own; none leaves only the ambient light.
    pub lights: Vec<Light>,
    /// Light from everywhere, which no shadow stops.
    pub ambient: Color,
    /// Light from everywhere, as far as no sphere hides it.
    pub sky: Option<Sky>,
    /// Radiance where no sphere is seen.
    pub background: Color,
    /// Whether spheres cast shadows on each other.
    pub shadows: bool,
    expects_colored_lights: bool,
    expects_colored_spheres: bool,
    surfaces: Arc<Surfaces>,
    materials: Arc<Vec<Material>>,
    /// The spheres that have albedos of their own.
    painted: Arc<Vec<Painted>>,
}

/// The spheres of a world, each with its material's number.
#[derive(Clone, Debug, Default)]
struct Surfaces {
    spheres: Vec<Sphere>,
    material_ids: MaterialIds,
    /// The materials that some sphere has.
    is_used: Vec<bool>,
}

/// Spheres that have albedos of their own, instead of their material's.
#[derive(Clone, Debug)]
struct Painted {
    /// The index of the first.
    first: usize,
    albedos: Albedos,
    is_grey: bool,
}

/// A part of a world's light: the sum of the pictures under all parts is the picture.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Light, LightPart, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// world.lights.push(Light::directional(DVec3::NEG_Z, DVec3::ONE)?);
/// world.ambient = DVec3::splat(0.25);
/// let renderer = Renderer::new(&world);
/// let middle = |renderer: &Renderer<'_>| {
///     let image = renderer.render(&view, &Settings::default());
///     image.rgba(8, 8)[0]
/// };
/// let parts = [LightPart::Light(0), LightPart::Ambient];
/// let sum: f64 = parts.iter().map(|&part| middle(&renderer.under(part))).sum();
/// // Each picture is within 1e-3 of the light.
/// assert!((sum - middle(&renderer)).abs() <= 3e-3);
/// assert_eq!(middle(&renderer.under(LightPart::Ambient)), 0.25);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum LightPart {
    /// The ambient light, and the background.
    Ambient,
    /// The light with this index, and its shadows.
    Light(usize),
    /// The sky.
    Sky,
}

/// One of a world's materials.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Material, Sphere, World};
///
/// let mut world = World::new();
/// let white = world.add_material(Material::default());
/// let red = world.add_material(Material { albedo: DVec3::X, ..Material::default() });
/// world.add_sphere(Sphere::new(DVec3::ZERO, 1.0)?, red);
/// assert_ne!(white, red);
/// assert_eq!(world.material(0).albedo, DVec3::X);
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct MaterialId(u32);

impl World {
    /// A world without spheres and lights: black, shadows on.
    pub fn new() -> Self {
        Self {
            lights: Vec::new(),
            expects_colored_lights: false,
            expects_colored_spheres: false,
            ambient: Color::ZERO,
            sky: None,
            background: Color::ZERO,
            shadows: true,
            surfaces: Arc::default(),
            materials: Arc::default(),
            painted: Arc::default(),
        }
    }

    /// The parts of the light: each of the lights, the sky if there is one, then what is left without them.
    pub fn light_parts(&self) -> impl Iterator<Item = LightPart> + use<> {
        let lights = (0..self.lights.len()).map(LightPart::Light);
        let sky = self.sky.map(|_| LightPart::Sky);
        lights.chain(sky).chain([LightPart::Ambient])
    }

    /// The same spheres under a part of the light, with all else off. Without ambient light the background is black, and
    /// so are outlines.
    ///
    /// # Panics
    /// When there is no light with that index.
    #[must_use]
    pub fn under(&self, part: LightPart) -> Self {
        let (lights, [ambient, background]) = match part {
            LightPart::Ambient => (Vec::new(), [self.ambient, self.background]),
            LightPart::Light(index) => (vec![self.lights[index]], [Color::ZERO; 2]),
            LightPart::Sky => (Vec::new(), [Color::ZERO; 2]),
        };
        let mut materials = Arc::clone(&self.materials);
        if part != LightPart::Ambient && self.has_outlines() {
            for material in Arc::make_mut(&mut materials) {
                if let Some(outline) = &mut material.outline {
                    outline.color = Color::ZERO;
                }
            }
        }
        Self {
            lights,
            materials,
            ambient,
            sky: self.sky.filter(|_| part == LightPart::Sky),
            background,
            expects_colored_lights: self.expects_colored_lights && part != LightPart::Ambient,
            ..self.clone()
        }
    }

    /// The same spheres, whose light is their shading normals: red, green and blue tell how far these turn toward the
    /// axes of the world times `sign`, 1 or −1, where they do. Surfaces are matte and white, without shadows.
    pub(crate) fn of_normals(&self, sign: f64) -> Self {
        let lights = three(DVec3::AXES, |axis| Light::directional(axis * sign, axis));
        let matte = self.materials.iter().map(|material| Material {
            roughness: material.roughness,
            ..Material::MATTE_WHITE
        });
        Self {
            lights: lights.into_iter().flatten().collect(),
            expects_colored_lights: false,
            expects_colored_spheres: false,
            ambient: Color::ZERO,
            sky: None,
            background: Color::ZERO,
            shadows: false,
            surfaces: Arc::clone(&self.surfaces),
            materials: Arc::new(matte.collect()),
            painted: Arc::default(),
        }
    }

    /// True where both have the same spheres, not merely equal ones.
    pub(crate) fn shares_spheres(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surfaces, &other.surfaces)
    }

    fn surfaces_mut(&mut self) -> &mut Surfaces {
        Arc::make_mut(&mut self.surfaces)
    }

    /// Adds a material that spheres of this world may have.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        let id = MaterialId(self.materials.len() as u32);
        Arc::make_mut(&mut self.materials).push(material);
        self.surfaces_mut().is_used.push(false);
        id
    }

    /// Prepares for pictures with colored lights of their own ([`crate::Exposure::with_lights`]): all pictures of the
    /// world then have three channels, even if its own lights have no color.
    pub fn expect_colored_lights(&mut self) {
        self.expects_colored_lights = true;
    }

    /// Prepares for copies of this world that have more spheres, of this material or, if `has_albedos`, with albedos of
    /// their own: pictures of the world then have the same channels as pictures of its copies.
    ///
    /// # Panics
    /// If `material` is not of this world.
    pub fn expect_spheres(&mut self, material: MaterialId, has_albedos: bool) {
        self.surfaces_mut().note_use(material);
        self.expects_colored_spheres |= has_albedos;
    }

    /// Adds a sphere; where surfaces coincide, the one added first is seen.
    ///
    /// # Panics
    /// When `material` is not of this world.
    pub fn add_sphere(&mut self, sphere: Sphere, material: MaterialId) {
        let surfaces = self.surfaces_mut();
        surfaces.note_use(material);
        surfaces.spheres.push(sphere);
        surfaces.material_ids.add(1, material.0);
    }

    /// Adds many spheres of one material after those that are there, and copies each sphere at most once. `albedos`, if
    /// given, has one albedo for each of them, in place of the material's.
    ///
    /// # Panics
    /// When `material` is not of this world, or the albedos are not as many as the spheres.
    pub fn add_spheres(
        &mut self,
        mut spheres: Vec<Sphere>,
        material: MaterialId,
        albedos: Option<Albedos>,
    ) {
        if spheres.is_empty() {
            return;
        }
        let first = self.spheres().len();
        let count = spheres.len();
        if let Some(albedos) = albedos {
            assert_eq!(albedos.len(), count, "an albedo for every sphere");
            Arc::make_mut(&mut self.painted).push(Painted {
                first,
                is_grey: albedos.are_grey(),
                albedos,
            });
        }
        let surfaces = self.surfaces_mut();
        surfaces.note_use(material);
        if first < count {
            // The few go before the many: there is never a second copy of the many.
            spheres.splice(0..0, surfaces.spheres.drain(..));
            surfaces.spheres = spheres;
        } else {
            surfaces.spheres.append(&mut spheres);
        }
        surfaces.material_ids.add(count, material.0);
    }

    /// The spheres in the order in which they were added.
    pub fn spheres(&self) -> &[Sphere] {
        &self.surfaces.spheres
    }

    /// The material of the sphere with this index.
    #[inline]
    pub fn material(&self, sphere: usize) -> &Material {
        &self.materials[self.surfaces.material_ids.get(sphere) as usize]
    }

    /// The albedo of the sphere with this index: its own, or its material's.
    #[inline]
    pub fn albedo(&self, sphere: usize) -> Color {
        if self.painted.is_empty() {
            self.material(sphere).albedo
        } else {
            self.own_albedo(sphere)
        }
    }

    /// The albedo of all spheres, where none can have another one.
    pub(crate) fn only_albedo(&self) -> Option<Color> {
        let [only] = &self.materials[..] else {
            return None;
        };
        self.painted.is_empty().then_some(only.albedo)
    }

    fn own_albedo(&self, sphere: usize) -> Color {
        let after = self.painted.partition_point(|some| some.first <= sphere);
        let own = self.painted[..after].last();
        own.and_then(|some| some.albedos.get(sphere - some.first))
            .unwrap_or(self.material(sphere).albedo)
    }

    /// Returns whether some spheres have albedos of their own.
    pub fn has_own_albedos(&self) -> bool {
        !self.painted.is_empty()
    }

    /// Returns whether some sphere has bumps.
    pub fn has_bumps(&self) -> bool {
        self.used_materials()
            .any(|material| material.roughness.is_some())
    }

    /// True if some sphere has a line along its contour.
    pub(crate) fn has_outlines(&self) -> bool {
        self.used_materials().any(|one| one.outline.is_some())
    }

    /// The light that outlines send, of each material that has one.
    pub(crate) fn outline_colors(&self) -> impl Iterator<Item = Color> {
        let outlines = self.used_materials().filter_map(|one| one.outline);
        outlines.map(|outline| outline.color)
    }

    /// The materials that some sphere has.
    fn used_materials(&self) -> impl Iterator<Item = &Material> {
        let materials = self.materials.iter().zip(&self.surfaces.is_used);
        materials.filter_map(|(material, used)| used.then_some(material))
    }

    /// The materials in the order in which they were added.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The index of a sphere's material in [`Self::materials`].
    pub fn material_index(&self, sphere: usize) -> u32 {
        self.surfaces.material_ids.get(sphere)
    }

    /// Bounds of the light, in each channel, of whatever may be seen before this background: in the dark, and where all
    /// of some lights, their highlights and a sky are at their highest.
    pub(crate) fn range_of_light(
        &self,
        (lights, sky): (&[Light], Option<Sky>),
        background: Color,
    ) -> [Color; 2] {
        let [mut dark, mut bright] = [background; 2];
        let lights = lights.iter().map(|light| self.brightest(light));
        let sky = sky.map_or(Color::ZERO, |sky| sky.brightest());
        let lights = lights.fold(sky, |sum, light| sum + light);
        let highlights = self.materials.iter().filter_map(|one| one.highlight);
        let strength = highlights.fold(0.0_f64, |most, one| most.max(one.strength));
        let of_materials = self.materials.iter().map(|material| material.albedo);
        let own = self.painted.iter();
        let own = own
            .flat_map(|some| (0..some.albedos.len()).filter_map(|index| some.albedos.get(index)));
        for albedo in of_materials.chain(own) {
            dark = dark.min(albedo * self.ambient);
            bright = bright.max(albedo * (self.ambient + lights) + lights * strength);
        }
        for outline in self.outline_colors() {
            dark = dark.min(outline);
            bright = bright.max(outline);
        }
        [dark, bright]
    }

    /// A bound of the radiance that a light makes of a white surface on the outer side of any sphere.
    fn brightest(&self, light: &Light) -> Color {
        if light.point().is_none() {
            return light.intensity();
        }
        let spheres = self.spheres().iter();
        spheres.fold(Color::ZERO, |most, sphere| {
            most.max(light.brightest_on(sphere))
        })
    }

    /// True where nothing that can be seen has a color, so that one channel tells all.
    pub(crate) fn is_grey(&self) -> bool {
        is_grey(self.background) && self.has_grey_spheres()
    }

    /// True where the spheres' light has no color, whatever the background has.
    pub(crate) fn has_grey_spheres(&self) -> bool {
        is_grey(self.ambient)
            && self
                .sky
                .is_none_or(|sky| is_grey(sky.above()) && is_grey(sky.below()))
            && !self.expects_colored_lights
            && !self.expects_colored_spheres
            && self.lights.iter().all(|light| is_grey(light.intensity()))
            && self.used_materials().all(|one| is_grey(one.albedo))
            && self.outline_colors().all(is_grey)
            && self.painted.iter().all(|some| some.is_grey)
    }
}

impl Surfaces {
    fn note_use(&mut self, material: MaterialId) {
        assert!(
            (material.0 as usize) < self.is_used.len(),
            "the material of another world"
        );
        self.is_used[material.0 as usize] = true;
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests;
