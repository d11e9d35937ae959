//! What is rendered.

use crate::{Color, DirectionalLight, Material, Sphere};

/// Everything that a camera may see, and its light.
#[derive(Clone, Debug)]
pub struct World {
    /// The lights; none leaves only the ambient light.
    pub lights: Vec<DirectionalLight>,
    /// Light from everywhere, which no shadow stops.
    pub ambient: Color,
    /// Radiance where no sphere is seen.
    pub background: Color,
    /// Whether spheres keep the light from each other.
    pub shadows: bool,
    spheres: Vec<Sphere>,
    material_ids: Vec<MaterialId>,
    materials: Vec<Material>,
    /// Which materials some sphere has.
    is_used: Vec<bool>,
}

/// One of a world's materials.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct MaterialId(u32);

impl World {
    /// A world without spheres and lights: black, shadows on.
    pub fn new() -> Self {
        Self {
            lights: Vec::new(),
            ambient: Color::ZERO,
            background: Color::ZERO,
            shadows: true,
            spheres: Vec::new(),
            material_ids: Vec::new(),
            materials: Vec::new(),
            is_used: Vec::new(),
        }
    }

    /// Adds a material that spheres of this world may have.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        let id = MaterialId(self.materials.len() as u32);
        self.materials.push(material);
        self.is_used.push(false);
        id
    }

    /// Adds a sphere; where surfaces coincide, the one added first is seen.
    ///
    /// # Panics
    /// When `material` is not of this world.
    pub fn add_sphere(&mut self, sphere: Sphere, material: MaterialId) {
        assert!(
            (material.0 as usize) < self.materials.len(),
            "the material of another world"
        );
        self.is_used[material.0 as usize] = true;
        self.spheres.push(sphere);
        self.material_ids.push(material);
    }

    /// The spheres in the order in which they were added.
    pub fn spheres(&self) -> &[Sphere] {
        &self.spheres
    }

    /// The material of the sphere with this index.
    pub fn material(&self, sphere: usize) -> &Material {
        &self.materials[self.material_ids[sphere].0 as usize]
    }

    /// The materials in the order in which they were added.
    pub(crate) fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The place of a sphere's material among the materials.
    pub(crate) fn material_index(&self, sphere: usize) -> u32 {
        self.material_ids[sphere].0
    }

    /// Whether nothing that can be seen has a color, so that one channel tells all.
    pub fn is_grey(&self) -> bool {
        is_grey(self.background) && self.has_grey_spheres()
    }

    /// Whether the spheres' light has no color, whatever the background has.
    pub fn has_grey_spheres(&self) -> bool {
        let used = self
            .materials
            .iter()
            .zip(&self.is_used)
            .filter(|(_, used)| **used);
        is_grey(self.ambient)
            && self.lights.iter().all(|light| is_grey(light.intensity()))
            && used
                .into_iter()
                .all(|(material, _)| is_grey(material.albedo))
    }
}

fn is_grey(color: Color) -> bool {
    color.x == color.y && color.y == color.z
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}
