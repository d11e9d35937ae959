//! The unit of light.
//!
//! Pixels are integrated in units of a power of two near the contrast of their world, so that nothing depends on how
//! bright it is: goals, gates and claims are multiples of it, and no bit changes with it.

use super::color::Color;
use super::light::Light;
use super::sky::Sky;
use super::world::World;

/// The contrast of a world, and its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightUnit {
    /// About the largest difference of light that an edge may make, highlights left out, in units.
    pub(crate) contrast: f64,
    /// The power of two not below it, in the world's light; 1 in a world without any.
    ///
    /// Alpha has the unit 1: an error of it counts as this much light.
    pub(crate) unit: f64,
}

impl LightUnit {
    /// The contrast and the unit of a world under some lights and a sky.
    pub(crate) fn new(world: &World, lights: &[Light], sky: Option<Sky>) -> Self {
        let lights = lights.iter().map(|light| light.intensity().max_element());
        let outlines = world.outline_colors().map(Color::max_element);
        let contrast = world.ambient.max_element()
            + world.background.max_element()
            + lights.sum::<f64>()
            + sky.map_or(0.0, |sky| sky.brightest().max_element())
            + outlines.fold(0.0, f64::max);
        let unit = power_of_two_from(contrast);
        Self {
            contrast: contrast / unit,
            unit,
        }
    }
}

/// Light, in units, below which there is none: numbers that are so small would be rounded otherwise in other units.
pub(crate) const NOTHING: f64 = 1e-200;

/// Light in the world's unit, of light in its own. What is next to nothing is nothing.
pub(crate) fn in_world(light: Color, unit: f64) -> Color {
    Color::select(light.abs().cmplt(Color::splat(NOTHING)), Color::ZERO, light) * unit
}

/// The least power of two that is not below a number; 1 for what has none.
fn power_of_two_from(number: f64) -> f64 {
    if !(number > 0.0 && number.is_finite()) {
        return 1.0;
    }
    let (share, exponent) = libm::frexp(number);
    let exponent = if share == 0.5 { exponent - 1 } else { exponent };
    let power = libm::scalbn(1.0, exponent);
    if power.is_normal() { power } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_the_least_that_are_not_below() {
        for (number, power) in [
            (1.0, 1.0),
            (1.0 + f64::EPSILON, 2.0),
            (1.0 - f64::EPSILON, 1.0),
            (0.3, 0.5),
            (1e-300, libm::scalbn(1.0, -996)),
            (0.0, 1.0),
            (f64::INFINITY, 1.0),
            (f64::MAX, 1.0),
        ] {
            assert_eq!(power_of_two_from(number), power, "{number:e}");
        }
    }
}
