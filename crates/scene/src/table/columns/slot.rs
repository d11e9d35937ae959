//! The purposes that columns have.

/// The purpose of a column.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Slot {
    X,
    Y,
    Z,
    Radius,
    Red,
    Green,
    Blue,
    Value,
    Element,
    /// A component of the vector whose length is the value.
    Vector(u8),
    /// The cells by which a particle has left the first one, along an edge.
    Image(u8),
    /// Some condition is on it.
    Filter(u8),
    /// Its contents are looked at; it is this column.
    Contents(u8),
}

/// The numbers that are allowed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Allowed {
    /// Values may be missing: they are NaN.
    pub(crate) may_miss: bool,
    /// Colors are sRGB values from 0 to 255.
    pub(crate) is_encoded: bool,
    /// Radii are not the numbers of a column, but follow from them.
    pub(crate) has_radius_law: bool,
}

/// The most conditions on rows.
pub(crate) const MOST_FILTERS: usize = 16;

impl Slot {
    /// The number of purposes for which a row holds a number.
    pub(crate) const COUNT: usize = 15;

    /// The place of the number among those of a row.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
            Self::Radius => 3,
            Self::Red => 4,
            Self::Green => 5,
            Self::Blue => 6,
            Self::Value => 7,
            // No number of these is held.
            Self::Element | Self::Filter(_) | Self::Contents(_) => 8,
            Self::Vector(component) => 9 + usize::from(component) % 3,
            Self::Image(axis) => 12 + usize::from(axis) % 3,
        }
    }

    /// The name that a column for this has, or one of the others.
    pub(crate) fn names(self) -> &'static [&'static str] {
        match self {
            Self::X => &[
                "x",
                "xu",
                "xs",
                "xsu",
                "cartn_x",
                "model_cartn_x",
                "fract_x",
            ],
            Self::Y => &[
                "y",
                "yu",
                "ys",
                "ysu",
                "cartn_y",
                "model_cartn_y",
                "fract_y",
            ],
            Self::Z => &[
                "z",
                "zu",
                "zs",
                "zsu",
                "cartn_z",
                "model_cartn_z",
                "fract_z",
            ],
            Self::Radius => &["radius", "r", "particle radius", "particle_radius", "radii"],
            Self::Red => &["red", "r"],
            Self::Green => &["green", "g"],
            Self::Blue => &["blue", "b"],
            Self::Value => &["value"],
            Self::Element => &["element", "species", "symbol", "type_symbol"],
            Self::Image(0) => &["ix"],
            Self::Image(1) => &["iy"],
            Self::Image(_) => &["iz"],
            Self::Vector(_) | Self::Filter(_) | Self::Contents(_) => &[],
        }
    }

    /// The expected thing instead of this number; `None` where it is allowed.
    #[inline(always)]
    pub(crate) fn refusal(self, number: f64, allowed: Allowed) -> Option<&'static str> {
        match self {
            Self::Value | Self::Vector(_) if allowed.may_miss && number.is_nan() => None,
            Self::Filter(_) | Self::Element | Self::Contents(_) => None,
            Self::Image(_) => (number.fract() != 0.0).then_some("a whole number of cells"),
            _ if !number.is_finite() => Some("a finite number"),
            Self::Radius if number <= 0.0 && !allowed.has_radius_law => {
                Some("a radius greater than 0")
            }
            Self::Red | Self::Green | Self::Blue => {
                if allowed.is_encoded {
                    let is_byte = (0.0..=255.0).contains(&number) && number.fract() == 0.0;
                    (!is_byte).then_some("a whole number from 0 to 255")
                } else {
                    let most = f64::from(f32::MAX);
                    (!(0.0..=most).contains(&number)).then_some("a color channel of at least 0")
                }
            }
            _ => None,
        }
    }
}
