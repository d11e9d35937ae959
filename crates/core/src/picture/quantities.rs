//! The quantities that a geometry may tell of a picture's pixels.

use super::averages::AverageSettings;

/// The contents of a [`Geometry`](crate::Geometry), and their conventions.
///
/// # Example
/// ```
/// use marbles_core::{Axes, GeometrySettings, Quantity};
///
/// let settings = GeometrySettings {
///     quantities: [Quantity::Depth, Quantity::Normal].into_iter().collect(),
///     axes: Axes::CameraOpenCv,
///     ..GeometrySettings::default()
/// };
/// assert!(settings.quantities.has(Quantity::Normal));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GeometrySettings {
    /// The quantities that are wanted. The index of the sphere always comes with them.
    pub quantities: Quantities,
    /// The meaning of [`Quantity::Depth`].
    pub depth: Depth,
    /// The axes of normals and positions.
    pub axes: Axes,
    /// The type of number for which the quantities are computed.
    pub precision: Precision,
    /// The averages that are wanted besides.
    pub averages: AverageSettings,
}

/// A quantity at the point where the ray through a pixel's center meets a sphere.
///
/// # Example
/// ```
/// use marbles_core::Quantity;
///
/// let components = Quantity::ALL.map(|quantity| quantity.components());
/// assert_eq!(components, [1, 3, 3, 3, 3]);
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
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
    pub(crate) const fn of_nothing(self) -> f64 {
        match self {
            Self::Depth => f64::INFINITY,
            _ => 0.0,
        }
    }
}

/// A set of quantities.
///
/// # Example
/// ```
/// use marbles_core::{Quantities, Quantity};
///
/// let depth = Quantities::NONE.with(Quantity::Depth);
/// assert!(depth.has(Quantity::Depth) && !depth.has(Quantity::Albedo));
/// assert_eq!(depth, [Quantity::Depth].into_iter().collect());
/// ```
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
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Depth, GeometrySettings, Lens, Material, Precision};
/// # use marbles_core::{Quantity, Renderer, Sphere, View, World};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 4.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(90.0))?;
/// # let view = View::new(Camera::default(), lens, 2, 2);
/// let depth = |depth: Depth| {
///     let settings = GeometrySettings {
///         depth,
///         // …
/// #         quantities: [Quantity::Depth].into_iter().collect(),
/// #         precision: Precision::Double,
///         ..GeometrySettings::default()
///     };
///     let geometry = Renderer::new(&world).geometry(&view, &settings);
///     geometry.values(Quantity::Depth, 0, 0).and_then(|mut row| row.next())
/// };
/// // The ray through the first pixel has the direction (−½, ½, 1).
/// let (axis, ray) = (depth(Depth::Axis).unwrap(), depth(Depth::Ray).unwrap());
/// assert!((ray / axis - 1.5_f64.sqrt()).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
///
/// # Example
/// ```
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Axes, Quantity, Camera, GeometrySettings, Lens, Material, Renderer, Sphere, View, World};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let view = View::new(Camera::default(), Lens::parallel(1.0, DVec2::ZERO), 1, 1);
/// let normal_z = |axes: Axes| {
///     let settings = GeometrySettings {
///         axes,
///         quantities: [Quantity::Normal].into_iter().collect(),
///         ..GeometrySettings::default()
///     };
///     let geometry = Renderer::new(&world).geometry(&view, &settings);
///     geometry.values(Quantity::Normal, 2, 0).and_then(|mut row| row.next())
/// };
/// // The surface in the middle faces the camera, which looks along z.
/// assert_eq!(normal_z(Axes::CameraOpenCv), Some(-1.0));
/// assert_eq!(normal_z(Axes::CameraOpenGl), Some(1.0));
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
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

/// The type of number for which a geometry is computed.
///
/// # Example
/// ```
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Precision, Quantity, Camera, GeometrySettings, Lens, Material, Renderer, Sphere, View, World};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.1), 1.0)?, white);
/// # let view = View::new(Camera::default(), Lens::parallel(1.0, DVec2::ZERO), 1, 1);
/// let depth = |precision: Precision| {
///     let settings = GeometrySettings {
///         precision,
///         quantities: [Quantity::Depth].into_iter().collect(),
///         ..GeometrySettings::default()
///     };
///     let geometry = Renderer::new(&world).geometry(&view, &settings);
///     geometry.values(Quantity::Depth, 0, 0).and_then(|mut row| row.next())
/// };
/// // The nearest point of the ball is at a depth of 4.1.
/// assert_eq!(depth(Precision::Single), Some(f64::from(4.1_f32)));
/// assert!((depth(Precision::Double).unwrap() - 4.1).abs() < 1e-15);
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Precision {
    /// Floats of 32 bits; costs the least.
    #[default]
    Single,
    /// Doubles.
    Double,
}
