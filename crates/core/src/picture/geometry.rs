//! Geometry seen through the centers of pixels, and averages over the visible parts of spheres.

use std::ops::Range;

use super::averages::{Average, Averages};
use super::quantities::{GeometrySettings, Precision, Quantities, Quantity};
use super::tile::Tile;
use super::window::Window;

/// The geometry that the rays through the centers of a picture's pixels see.
///
/// The ray of a pixel is [`View::ray`](crate::View::ray) through [`View::cell_center`](crate::View::cell_center) with
/// one division, in the doubles that these return. It is the ray of one sample per pixel, and the same code decides,
/// exactly, which sphere it sees. If surfaces coincide, it sees the sphere that was added first. From a viewpoint
/// inside a sphere it sees the inner side. If the camera moves, the geometry is that of the view in the middle of the
/// time. None of these values is an average; [`Average`] lists the averages that you can get as well.
///
/// Row 0 is the top row, column 0 the left one. In a camera's axes a normal is the world's normal multiplied by the
/// transposed rotation of the [`Camera`](crate::Camera), and a position is t times the point (u, v, distance) of the
/// retina, both with the signs of the [`Axes`](crate::Axes).
///
/// # Accuracy
/// A bound for depths, positions and geometric normals: each component, however small, is within 2 units in the last
/// place of the exact number, in the type that [`Precision`] names. `tests/tests/geometry` compares them with rational
/// arithmetic. Shading normals with bumps are those that the picture is shaded with.
///
/// # Example
/// ```
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Geometry, Precision, Quantity, Camera, GeometrySettings, Lens, Material, Renderer, Sphere, View, World};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// // The ball from z = 4 to z = 6, in the middle of 3 × 3 pixels.
/// # let view = View::new(Camera::default(), Lens::parallel(9.0, DVec2::ZERO), 3, 3);
/// let settings = GeometrySettings {
///     quantities: [Quantity::Depth].into_iter().collect(),
///     precision: Precision::Double,
///     ..GeometrySettings::default()
/// };
/// let geometry = Renderer::new(&world).geometry(&view, &settings);
/// let ids: Vec<u32> = geometry.ids(1).collect();
/// assert_eq!(ids, [Geometry::NOTHING, 0, Geometry::NOTHING]);
/// let depths = geometry.values(Quantity::Depth, 0, 1).expect("they were asked for");
/// assert_eq!(depths.collect::<Vec<_>>(), [f64::INFINITY, 4.0, f64::INFINITY]);
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Geometry {
    /// The part of the blocks that is told.
    window: Window,
    quantities: Quantities,
    /// Blocks side by side: eight pixels of a row.
    columns: usize,
    /// The places of the blocks, row by row; none for a block that sees nothing.
    places: Vec<u32>,
    /// The components of each quantity, block by block.
    numbers: Numbers,
    ids: Vec<[u32; SIDE]>,
    averages: Averages,
}

/// A geometry that is being written, and the column and row of its first pixel in the picture.
pub(crate) type Written<'a> = ((u32, u32), &'a mut Geometry);

/// The numbers of blocks.
#[derive(Clone, Debug)]
enum Numbers {
    Single(Vec<[f32; SIDE]>),
    Double(Vec<[f64; SIDE]>),
}

/// The place of a block that sees nothing.
const NOWHERE: u32 = u32::MAX;

impl Geometry {
    /// The id where no sphere is seen.
    pub const NOTHING: u32 = u32::MAX;

    /// A geometry that sees nothing yet, in the memory of another one with the same settings.
    pub(crate) fn new(
        (width, height): (u32, u32),
        settings: &GeometrySettings,
        spent: Option<Self>,
    ) -> Self {
        let columns = width.div_ceil(Tile::SIDE) as usize;
        let empty = || match settings.precision {
            Precision::Single => Numbers::Single(Vec::new()),
            Precision::Double => Numbers::Double(Vec::new()),
        };
        let spent = spent.map(|spent| (spent.places, (spent.numbers, spent.ids)));
        let (places, rest) = spent.unzip();
        let (numbers, ids) = rest.unzip();
        let mut places = places.unwrap_or_default();
        places.clear();
        places.resize(columns * height as usize, NOWHERE);
        let mut numbers = numbers.unwrap_or_else(empty);
        match &mut numbers {
            Numbers::Single(numbers) => numbers.clear(),
            Numbers::Double(numbers) => numbers.clear(),
        }
        let mut ids: Vec<[u32; SIDE]> = ids.unwrap_or_default();
        ids.clear();
        Self {
            window: Window {
                col: 0,
                row: 0,
                width,
                height,
            },
            quantities: settings.quantities,
            columns,
            places,
            numbers,
            ids,
            averages: Averages::new((width, height), &settings.averages, Self::NOTHING),
        }
    }

    /// Number of columns.
    pub fn width(&self) -> u32 {
        self.window.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.window.height
    }

    /// The indices of the spheres that a row's pixels see, from left to right, or [`Self::NOTHING`].
    ///
    /// # Panics
    /// Outside the picture.
    pub fn ids(&self, row: u32) -> impl Iterator<Item = u32> {
        let nothing = [Self::NOTHING; SIDE];
        let block = move |place: Option<usize>| place.map_or(nothing, |place| self.ids[place]);
        self.inside(self.blocks(row).flat_map(block))
    }

    /// A component of a quantity in a row's pixels, from left to right; `None` if the quantity was not
    /// wanted.
    ///
    /// # Panics
    /// Outside the picture, and for components that the quantity does not have.
    pub fn values(
        &self,
        quantity: Quantity,
        component: usize,
        row: u32,
    ) -> Option<impl Iterator<Item = f64>> {
        assert!(component < quantity.components(), "component {component}");
        let before = Quantity::ALL.into_iter();
        let before = before.take_while(|&other| other != quantity);
        let number = self.quantities.components(before) + component;
        let count = self.quantities.components(Quantity::ALL);
        let nothing = [quantity.of_nothing(); SIDE];
        let block = move |place: Option<usize>| match (place, &self.numbers) {
            (None, _) => nothing,
            (Some(place), Numbers::Single(all)) => all[place * count + number].map(f64::from),
            (Some(place), Numbers::Double(all)) => all[place * count + number],
        };
        let is_wanted = self.quantities.has(quantity);
        is_wanted.then(|| self.inside(self.blocks(row).flat_map(block)))
    }

    /// A component of an average in a row's pixels, from left to right; `None` if it was not wanted.
    ///
    /// # Panics
    /// Outside the picture, and for components that the average does not have.
    pub fn averages(
        &self,
        average: Average,
        component: usize,
        row: u32,
    ) -> Option<impl Iterator<Item = f64>> {
        assert!(component < average.components(), "component {component}");
        assert!(row < self.window.height, "row {row} is outside");
        let values = self.averages.values((average, component), self.window, row);
        values.map(Vec::into_iter)
    }

    /// The index of the sphere that most of each of a row's pixels sees, from left to right, or [`Self::NOTHING`]; the
    /// first of those that share it alike. `None` where coverage was not wanted.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn coverage_ids(&self, row: u32) -> Option<impl Iterator<Item = u32>> {
        assert!(row < self.window.height, "row {row} is outside");
        self.averages.ids(self.window, row)
    }

    /// The averages, to be written.
    pub(crate) fn averages_mut(&mut self) -> &mut Averages {
        &mut self.averages
    }

    /// The places of the blocks in a row.
    fn blocks(&self, row: u32) -> impl Iterator<Item = Option<usize>> {
        assert!(row < self.window.height, "row {row} is outside");
        let first = (self.window.row + row) as usize * self.columns;
        let places = self.places[first..first + self.columns].iter();
        places.map(|&place| (place != NOWHERE).then_some(place as usize))
    }

    /// The pixels of a row of blocks that are told.
    fn inside<T>(&self, pixels: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
        let Window { col, width, .. } = self.window;
        pixels.skip(col as usize).take(width as usize)
    }

    /// Writes what a tile sees, where the first pixel is the one in this column and row of a larger picture, in
    /// which tiles begin with it.
    pub(crate) fn write(&mut self, tile: Tile, (col, row): (u32, u32), seen: &TileGeometry) {
        let first =
            (tile.row - row) as usize * self.columns + ((tile.col - col) / Tile::SIDE) as usize;
        for (number, seen) in seen.rows[..tile.height as usize].iter().enumerate() {
            if !seen.sees_any {
                continue;
            }
            self.places[first + number * self.columns] = self.ids.len() as u32;
            self.ids.push(seen.ids);
            for quantity in Quantity::ALL {
                if self.quantities.has(quantity) {
                    let own = places(quantity);
                    match &mut self.numbers {
                        Numbers::Single(all) => all.extend_from_slice(&seen.singles[own]),
                        Numbers::Double(all) => all.extend_from_slice(&seen.doubles[own]),
                    }
                }
            }
        }
    }

    /// The geometry of a part of the pixels.
    pub(crate) fn cut(self, window: Window) -> Self {
        Self { window, ..self }
    }
}

/// [`Tile::SIDE`] as the length of a row.
const SIDE: usize = Tile::SIDE as usize;

/// Numbers of a row of a tile's pixels, for each component of all quantities.
const COMPONENTS: usize = 13;

/// The geometry that the pixels of a tile see.
#[derive(Clone, Debug, Default)]
pub(crate) struct TileGeometry {
    pub(crate) rows: [RowGeometry; SIDE],
}

impl TileGeometry {
    /// Makes it see nothing.
    pub(crate) fn clear(&mut self) {
        for row in &mut self.rows {
            row.sees_any = false;
        }
    }
}

/// The geometry that a row of a tile's pixels sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowGeometry {
    /// False where no sphere is seen; the numbers then mean nothing.
    pub(crate) sees_any: bool,
    pub(crate) ids: [u32; SIDE],
    /// The numbers of either precision, of which one is written.
    singles: [[f32; SIDE]; COMPONENTS],
    doubles: [[f64; SIDE]; COMPONENTS],
}

/// Nothing is seen.
impl Default for RowGeometry {
    fn default() -> Self {
        Self {
            sees_any: false,
            ids: [Geometry::NOTHING; SIDE],
            singles: [[0.0; SIDE]; COMPONENTS],
            doubles: [[0.0; SIDE]; COMPONENTS],
        }
    }
}

impl RowGeometry {
    /// Writes a component of a quantity.
    #[inline(always)]
    pub(crate) fn put(
        &mut self,
        precision: Precision,
        (quantity, component): (Quantity, usize),
        values: [f64; SIDE],
    ) {
        let place = places(quantity).start + component;
        match precision {
            Precision::Single => {
                for (single, value) in self.singles[place].iter_mut().zip(values) {
                    *single = value as f32;
                }
            }
            Precision::Double => self.doubles[place] = values,
        }
    }

    /// Writes a component of a quantity of one pixel.
    pub(crate) fn put_one(
        &mut self,
        (quantity, component): (Quantity, usize),
        pixel: usize,
        value: f64,
    ) {
        let place = places(quantity).start + component;
        self.singles[place][pixel] = value as f32;
        self.doubles[place][pixel] = value;
    }

    /// Makes the shading normals the geometric ones.
    #[inline(always)]
    pub(crate) fn copy_geometric_normals(&mut self, precision: Precision) {
        let (from, to) = (places(Quantity::GeometricNormal), places(Quantity::Normal));
        match precision {
            Precision::Single => self.singles.copy_within(from, to.start),
            Precision::Double => self.doubles.copy_within(from, to.start),
        }
    }
}

/// The places of a quantity's components among all.
#[inline(always)]
const fn places(quantity: Quantity) -> Range<usize> {
    match quantity {
        Quantity::Depth => 0..1,
        Quantity::Normal => 1..4,
        Quantity::GeometricNormal => 4..7,
        Quantity::Position => 7..10,
        Quantity::Albedo => 10..COMPONENTS,
    }
}

#[cfg(test)]
mod tests;
