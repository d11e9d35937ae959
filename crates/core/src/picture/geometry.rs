//! What is seen through the centers of pixels: distances, normals, positions, albedos, spheres.

use std::ops::Range;

use super::tile::Tile;
use super::window::Window;

/// What a [`Geometry`] tells, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeometrySettings {
    /// The quantities that are wanted; which sphere is seen is always told.
    pub quantities: Quantities,
    /// The meaning of [`Quantity::Depth`].
    pub depth: Depth,
    /// The axes of normals and positions.
    pub axes: Axes,
    /// The last places that are right.
    pub precision: Precision,
}

/// A quantity that a pixel's center ray has where it meets a sphere.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Quantity {
    /// The distance: one number, above 0; infinite where nothing is seen.
    Depth,
    /// The shading normal: unit, three numbers. Without bumps it is the geometric one; the inner side of
    /// a sphere, which no light reaches, has no bumps.
    Normal,
    /// The unit *outward* normal of the sphere: three numbers. It points away from a viewpoint inside.
    GeometricNormal,
    /// The point: three numbers.
    Position,
    /// The albedo of the sphere: red, green, blue.
    Albedo,
}

impl Quantity {
    /// All of them, in the order in which files have them.
    pub const ALL: [Self; 5] = [
        Self::Depth,
        Self::Normal,
        Self::GeometricNormal,
        Self::Position,
        Self::Albedo,
    ];

    /// The number of its components.
    pub const fn components(self) -> usize {
        match self {
            Self::Depth => 1,
            _ => 3,
        }
    }

    /// The value of its components where nothing is seen.
    pub const fn of_nothing(self) -> f64 {
        match self {
            Self::Depth => f64::INFINITY,
            _ => 0.0,
        }
    }
}

/// A set of quantities.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Quantities(u8);

impl Quantities {
    /// The set with one more.
    #[must_use]
    pub const fn with(self, quantity: Quantity) -> Self {
        Self(self.0 | 1 << quantity as u8)
    }

    /// True if it is among them.
    pub const fn has(self, quantity: Quantity) -> bool {
        self.0 >> quantity as u8 & 1 == 1
    }
}

/// The set of some quantities.
impl FromIterator<Quantity> for Quantities {
    fn from_iter<I: IntoIterator<Item = Quantity>>(quantities: I) -> Self {
        let mut set = Self::default();
        for quantity in quantities {
            set = set.with(quantity);
        }
        set
    }
}

/// The meaning of a depth.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Depth {
    /// The distance along the axis of view: t times the retina's distance, as the ray's direction goes that
    /// far.
    #[default]
    Axis,
    /// The distance from the viewpoint.
    Ray,
}

/// The axes of normals and positions.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Axes {
    /// The world's, which are left-handed: x right, y up, z forward.
    #[default]
    World,
    /// The camera's, from the viewpoint: x right, y down, z forward, as in OpenCV.
    CameraOpenCv,
    /// The camera's, from the viewpoint: x right, y up, z toward the viewer, as in OpenGL.
    CameraOpenGl,
}

/// The type of number that a geometry is meant for.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Precision {
    /// Floats of 32 bits; costs the least.
    #[default]
    Single,
    /// Doubles.
    Double,
}

/// What the rays through the centers of a picture's pixels see.
///
/// The ray of a pixel is [`View::ray`](crate::View::ray) through
/// [`View::cell_center`](crate::View::cell_center) with one division, in the doubles that these return. It is
/// the ray of one sample a pixel, and the same code decides which sphere it sees: exactly. Of coincident
/// surfaces the sphere that was added first is seen; a viewpoint inside a sphere sees its inner side. Where
/// the camera moves, it is the view in the middle of the time. No value is an average.
///
/// Row 0 is the top row, column 0 the left one. A normal of the world is told as what it is; in a camera's
/// axes it is the product with the transposed rotation of the [`Camera`](crate::Camera), and a position is
/// t times the point (u, v, distance) of the retina, both with the signs of the [`Axes`].
///
/// # Accuracy
/// A bound for depths, positions and geometric normals, each component of its own however small: rounded to
/// the type that [`Precision`] names it is within 2 units in the last place of the exact number.
/// `tests/tests/geometry.rs` holds it against rational arithmetic. Shading normals with bumps are those that
/// the picture is shaded with.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    width: u32,
    height: u32,
    quantities: Quantities,
    /// Component by component of each quantity, row by row.
    values: Vec<f64>,
    ids: Vec<u32>,
}

impl Geometry {
    /// The id where no sphere is seen.
    pub const NOTHING: u32 = u32::MAX;

    /// A geometry that sees nothing yet, in the memory of another one.
    pub(crate) fn new(
        (width, height): (u32, u32),
        quantities: Quantities,
        spent: Option<Self>,
    ) -> Self {
        let pixels = width as usize * height as usize;
        let (mut values, mut ids) =
            spent.map_or_else(Default::default, |spent| (spent.values, spent.ids));
        values.clear();
        ids.clear();
        ids.resize(pixels, Self::NOTHING);
        for quantity in Quantity::ALL {
            if quantities.has(quantity) {
                let length = values.len() + pixels * quantity.components();
                values.resize(length, quantity.of_nothing());
            }
        }
        Self {
            width,
            height,
            quantities,
            values,
            ids,
        }
    }

    /// Number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The indices of the spheres that a row's pixels see, or [`Self::NOTHING`].
    ///
    /// # Panics
    /// Outside the picture.
    pub fn ids(&self, row: u32) -> &[u32] {
        &self.ids[self.row(row)]
    }

    /// A component of a quantity in a row's pixels, `None` where the quantity was not wanted.
    ///
    /// # Panics
    /// Outside the picture, and for components that the quantity does not have.
    pub fn values(&self, quantity: Quantity, component: usize, row: u32) -> Option<&[f64]> {
        assert!(component < quantity.components(), "component {component}");
        let plane = self.plane(quantity)? + component;
        let pixels = self.ids.len();
        Some(&self.values[plane * pixels..][self.row(row)])
    }

    /// The number of the first plane of a quantity, among those of one number for each pixel.
    fn plane(&self, quantity: Quantity) -> Option<usize> {
        let before = Quantity::ALL
            .into_iter()
            .take_while(|&other| other != quantity);
        let wanted = before.filter(|&other| self.quantities.has(other));
        let first = wanted.map(Quantity::components).sum();
        self.quantities.has(quantity).then_some(first)
    }

    fn row(&self, row: u32) -> Range<usize> {
        assert!(row < self.height, "row {row} is outside");
        let width = self.width as usize;
        let first = row as usize * width;
        first..first + width
    }

    /// Writes what a tile sees, where the first pixel is the one in this column and row of a larger picture.
    /// What was nothing stays so.
    pub(crate) fn write(&mut self, tile: Tile, (col, row): (u32, u32), seen: &TileGeometry) {
        let (pixels, width) = (self.ids.len(), tile.width as usize);
        let first = (tile.row - row) as usize * self.width as usize + (tile.col - col) as usize;
        for (number, seen) in seen.rows[..tile.height as usize].iter().enumerate() {
            if !seen.sees_any {
                continue;
            }
            let start = first + number * self.width as usize;
            self.ids[start..start + width].copy_from_slice(&seen.ids[..width]);
            let mut plane = start;
            for quantity in Quantity::ALL {
                if self.quantities.has(quantity) {
                    for values in seen.of(quantity) {
                        self.values[plane..plane + width].copy_from_slice(&values[..width]);
                        plane += pixels;
                    }
                }
            }
        }
    }

    /// A part of the geometry.
    pub(crate) fn cut(&self, window: Window) -> Self {
        let mut part = Self::new((window.width, window.height), self.quantities, None);
        let (columns, pixels) = (window.width as usize, part.ids.len());
        for row in 0..window.height as usize {
            let from = (window.row as usize + row) * self.width as usize + window.col as usize;
            let to = row * columns;
            part.ids[to..to + columns].copy_from_slice(&self.ids[from..from + columns]);
            let planes = self.values.chunks_exact(self.ids.len());
            for (plane, part) in planes.zip(part.values.chunks_exact_mut(pixels)) {
                part[to..to + columns].copy_from_slice(&plane[from..from + columns]);
            }
        }
        part
    }
}

/// [`Tile::SIDE`] as the length of a row.
const SIDE: usize = Tile::SIDE as usize;

/// Numbers of a row of a tile's pixels, for each component of all quantities.
const COMPONENTS: usize = 13;

/// What the pixels of a tile see.
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

/// What a row of a tile's pixels sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowGeometry {
    /// False where no sphere is seen; the numbers then mean nothing.
    pub(crate) sees_any: bool,
    pub(crate) ids: [u32; SIDE],
    values: [[f64; SIDE]; COMPONENTS],
}

/// Nothing is seen.
impl Default for RowGeometry {
    fn default() -> Self {
        Self {
            sees_any: false,
            ids: [Geometry::NOTHING; SIDE],
            values: [[0.0; SIDE]; COMPONENTS],
        }
    }
}

impl RowGeometry {
    /// Makes the shading normals the geometric ones.
    #[inline(always)]
    pub(crate) fn copy_geometric_normals(&mut self) {
        let geometric = places(Quantity::GeometricNormal);
        self.values
            .copy_within(geometric, places(Quantity::Normal).start);
    }

    /// The components of a quantity.
    #[inline(always)]
    pub(crate) fn of(&self, quantity: Quantity) -> &[[f64; SIDE]] {
        &self.values[places(quantity)]
    }

    /// The components of a quantity, to be written.
    #[inline(always)]
    pub(crate) fn of_mut(&mut self, quantity: Quantity) -> &mut [[f64; SIDE]] {
        &mut self.values[places(quantity)]
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
