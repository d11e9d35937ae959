//! The quantities that a geometry may tell of a picture's pixels.

use super::averages::AverageSettings;

/// The contents of a [`Geometry`](crate::Geometry), and their conventions.
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
    /// The averages that are wanted besides.
    pub averages: AverageSettings,
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
    /// No quantity.
    pub const NONE: Self = Self(0);

    /// The set with one more.
    #[must_use]
    pub const fn with(self, quantity: Quantity) -> Self {
        Self(self.0 | 1 << quantity as u8)
    }

    /// The number of the components of those quantities that are among them.
    pub(crate) fn components(self, quantities: impl IntoIterator<Item = Quantity>) -> usize {
        let wanted = quantities.into_iter();
        let wanted = wanted.filter(|&quantity| self.has(quantity));
        wanted.map(Quantity::components).sum()
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
