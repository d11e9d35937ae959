//! Converts pictures to buffers of the crate `image`, with the feature `image`.

use image::{ImageBuffer, Rgba, Rgba32FImage, RgbaImage};

use super::image::Image;
use crate::numeric::pair::three;

/// The codes of [`Image::to_srgb8`]: 8-bit sRGB with straight alpha, for viewers.
///
/// ```
/// use marbles_core::glam::{DVec2, DVec3};
/// use marbles_core::{Camera, Lens, Renderer, Settings, View, World};
///
/// let mut world = World::new();
/// world.background = DVec3::new(1.0, 0.0, 0.214041140482232);
/// let view = View::new(Camera::default(), Lens::parallel(1.0, DVec2::ZERO), 4, 3);
/// let picture = Renderer::new(&world).render(&view, &Settings::default());
///
/// let codes = image::RgbaImage::from(&picture);
/// assert_eq!(codes.dimensions(), (4, 3));
/// assert_eq!(codes.get_pixel(3, 2).0, [255, 0, 127, 255]);
/// assert_eq!(codes.into_raw(), picture.to_srgb8());
///
/// let light = image::Rgba32FImage::from(&picture);
/// assert_eq!(light.get_pixel(3, 2).0, [1.0, 0.0, 0.21404114, 1.0]);
/// ```
impl From<&Image> for RgbaImage {
    fn from(picture: &Image) -> Self {
        let mut codes = Self::new(picture.width(), picture.height());
        codes.copy_from_slice(&picture.to_srgb8());
        codes
    }
}

/// Linear light in single precision, with straight alpha, because `image` does not premultiply colors.
impl From<&Image> for Rgba32FImage {
    fn from(picture: &Image) -> Self {
        ImageBuffer::from_fn(picture.width(), picture.height(), |col, row| {
            let [red, green, blue, alpha] = picture.rgba(col, row);
            let straight = |light: f64| match alpha {
                1.0 => light,
                0.0 => 0.0,
                _ => light / alpha,
            };
            let [red, green, blue] = three([red, green, blue], straight);
            Rgba([red, green, blue, alpha].map(|value| value as f32))
        })
    }
}
