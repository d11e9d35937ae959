//! Averages over what pixels see of spheres.

use super::tile::Tile;
use super::window::Window;

/// The averages that are wanted of a picture's pixels.
///
/// # Example
/// ```
/// use marbles_core::{AverageSettings, GeometrySettings};
///
/// let settings = GeometrySettings {
///     averages: AverageSettings { coverage: true, ..AverageSettings::default() },
///     ..GeometrySettings::default()
/// };
/// assert_eq!(settings.averages.tolerance, 1e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AverageSettings {
    /// True if [`Average::Normal`] is wanted.
    pub normal: bool,
    /// True if [`Average::Coverage`] is wanted, and the index of its sphere.
    pub coverage: bool,
    /// The error that is accepted in what is averaged: greater than 0.
    pub tolerance: f64,
}

/// No averages; the tolerance 1e-3 for those that are added.
impl Default for AverageSettings {
    fn default() -> Self {
        Self {
            normal: false,
            coverage: false,
            tolerance: 1e-3,
        }
    }
}

/// An average over a pixel.
///
/// # Example
/// ```
/// use std::f64::consts::PI;
///
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Average, AverageSettings, Camera, GeometrySettings, Lens, Material, Renderer, Sphere, View, World};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// // The radius of the ball is 4 pixels.
/// # let view = View::new(Camera::default(), Lens::parallel(3.0, DVec2::ZERO), 12, 12);
/// let settings = GeometrySettings {
///     averages: AverageSettings { coverage: true, ..AverageSettings::default() },
///     ..GeometrySettings::default()
/// };
/// let geometry = Renderer::new(&world).geometry(&view, &settings);
/// let shares = (0..12).filter_map(|row| geometry.averages(Average::Coverage, 0, row));
/// let area: f64 = shares.flatten().sum();
/// assert!((area - 16.0 * PI).abs() < 12.0 * 12.0 * 1e-3);
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum Average {
    /// The mean of the shading normal over the part of the pixel in which spheres are seen: x, y and z in the axes of
    /// the normals, then the error of each. The mean of a bent surface is no unit vector. The tolerance applies to the
    /// integral over the pixel: the error of the mean is at most the tolerance divided by the visible part. The error
    /// is an estimate, like those of the pictures from which the mean is computed. An inner side, which no light
    /// reaches, counts as 0. If nothing is seen, all four numbers are 0.
    Normal,
    /// The part of the pixel, from 0 to 1, in which one sphere is seen, the one that is seen in most of it; and an
    /// estimate of the error.
    Coverage,
}

impl Average {
    /// The number of its components.
    pub const fn components(self) -> usize {
        match self {
            Self::Normal => 4,
            Self::Coverage => 2,
        }
    }
}

/// The averages over the pixels of a rectangle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Averages {
    width: usize,
    normals: Vec<[f64; 4]>,
    coverages: Vec<Coverage>,
}

/// The sphere that most of a pixel sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coverage {
    /// Its index, or the one that stands for none.
    pub(crate) id: u32,
    /// The part of the pixel in which it is seen, and the error of that.
    pub(crate) share: [f64; 2],
}

impl Averages {
    /// Averages of so many columns and rows, in which nothing is seen yet; `nothing` is the index of no sphere.
    pub(crate) fn new(
        (width, height): (u32, u32),
        settings: &AverageSettings,
        nothing: u32,
    ) -> Self {
        let count = width as usize * height as usize;
        let of_nothing = Coverage {
            id: nothing,
            share: [0.0; 2],
        };
        Self {
            width: width as usize,
            normals: vec![[0.0; 4]; if settings.normal { count } else { 0 }],
            coverages: vec![of_nothing; if settings.coverage { count } else { 0 }],
        }
    }

    /// The place of a tile's pixel, where the first pixel is the one in this column and row of a larger picture.
    fn place(&self, tile: Tile, pixel: usize, (col, row): (u32, u32)) -> usize {
        let (down, right) = (pixel as u32 / tile.width, pixel as u32 % tile.width);
        (tile.row - row + down) as usize * self.width + (tile.col - col + right) as usize
    }

    /// Writes the mean normal of a tile's pixel, and its error.
    pub(crate) fn put_normal(
        &mut self,
        (tile, pixel): (Tile, usize),
        first: (u32, u32),
        normal: [f64; 4],
    ) {
        let place = self.place(tile, pixel, first);
        self.normals[place] = normal;
    }

    /// Writes which sphere covers most of a tile's pixel.
    pub(crate) fn put_coverage(
        &mut self,
        (tile, pixel): (Tile, usize),
        first: (u32, u32),
        coverage: Coverage,
    ) {
        let place = self.place(tile, pixel, first);
        self.coverages[place] = coverage;
    }

    /// The indices of the spheres that most of the pixels in a row of a window see; `None` where they were not wanted.
    pub(crate) fn ids(&self, window: Window, row: u32) -> Option<impl Iterator<Item = u32>> {
        let coverages = self.row(&self.coverages, window, row)?;
        Some(coverages.iter().map(|coverage| coverage.id))
    }

    /// A component of an average in the pixels of a row of a window; `None` where it was not wanted.
    pub(crate) fn values(
        &self,
        (average, component): (Average, usize),
        window: Window,
        row: u32,
    ) -> Option<Vec<f64>> {
        Some(match average {
            Average::Normal => {
                let normals = self.row(&self.normals, window, row)?;
                normals.iter().map(|normal| normal[component]).collect()
            }
            Average::Coverage => {
                let coverages = self.row(&self.coverages, window, row)?;
                let shares = coverages.iter().map(|coverage| coverage.share[component]);
                shares.collect()
            }
        })
    }

    /// The pixels in a row of a window.
    fn row<'a, T>(&self, all: &'a [T], window: Window, row: u32) -> Option<&'a [T]> {
        let first = (window.row + row) as usize * self.width + window.col as usize;
        all.get(first..first + window.width as usize)
    }
}
