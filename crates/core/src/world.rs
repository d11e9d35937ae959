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
        }
    }

    /// Adds a material that spheres of this world may have.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        let id = MaterialId(self.materials.len() as u32);
        self.materials.push(material);
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

    /// Whether nothing in the world has a colour, so that one channel tells all.
    pub fn is_grey(&self) -> bool {
        let grey = |color: Color| color.x == color.y && color.y == color.z;
        grey(self.ambient)
            && grey(self.background)
            && self.lights.iter().all(|light| grey(light.intensity()))
            && self.materials.iter().all(|material| grey(material.albedo))
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}
