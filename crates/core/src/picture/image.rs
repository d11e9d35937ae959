//! Pictures in linear light.

use std::ops::Range;

use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

use super::band::Band;
use super::pixel::{Evidence, Status, Work};
use super::plane::Plane;
use super::srgb;
use super::summary::Summary;
use super::tile::Tile;
use super::window::Window;
use crate::model::world::World;

/// The numbers that a picture holds for each pixel.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Channels, World};
///
/// let mut world = World::new();
/// assert_eq!(Channels::of(&world, false), Channels::Grey);
/// world.background = DVec3::new(0.25, 0.25, 0.5);
/// assert_eq!(Channels::of(&world, false), Channels::Rgb);
/// // An alpha channel takes the place of the background.
/// assert_eq!(Channels::of(&world, true), Channels::Grey);
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Channels {
    /// One: the picture has no color.
    Grey,
    /// Red, green, blue.
    Rgb,
}

impl Channels {
    /// The channels of a world's pictures, with or without an alpha channel in place of the background.
    pub fn of(world: &World, alpha: bool) -> Self {
        let is_grey = if alpha {
            world.has_grey_spheres()
        } else {
            world.is_grey()
        };
        if is_grey { Self::Grey } else { Self::Rgb }
    }

    /// Number of the channels.
    pub(crate) fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::Rgb => 3,
        }
    }
}

/// A picture: linear light, premultiplied by coverage if it has an alpha channel, and for
/// every pixel the error of these numbers.
///
/// Row 0 is the top row, column 0 the left one. Two pictures are equal if the values, errors, evidence and statuses of
/// their pixels are; their work does not count.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Channels, Evidence, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// world.ambient = DVec3::splat(0.5);
/// let image = Renderer::new(&world).render(&view, &Settings::default());
/// assert_eq!((image.width(), image.height()), (16, 16));
/// assert_eq!(image.channels(), Channels::Grey);
/// assert_eq!(image.rgba(8, 8), [0.5, 0.5, 0.5, 1.0]);
/// assert_eq!(image.evidence(8, 8), Evidence::Bound);
/// assert!(image.error(8, 8) < 1e-15);
/// let codes = image.to_srgb8();
/// assert_eq!(codes.len(), 4 * 16 * 16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Image {
    width: u32,
    height: u32,
    channels: Channels,
    alpha: bool,
    /// Row by row, the channels and then the alpha of each pixel.
    values: Vec<f64>,
    errors: Plane<f64>,
    evidence: Plane<Evidence>,
    statuses: Plane<Status>,
    /// Values and errors are 0 where nothing was written.
    is_blank: bool,
    work: Work,
}

/// A picture without its pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// Columns and rows.
    pub(crate) size: (u32, u32),
    pub(crate) channels: Channels,
    pub(crate) alpha: bool,
    pub(crate) uniform: Uniform,
}

/// Numbers that are the same in all pixels of a picture, and known before these are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Uniform {
    /// The error of all pixels, where it is the same.
    pub(crate) error: Option<f64>,
    /// Evidence and status of all pixels, where they are the same.
    pub(crate) outcome: Option<(Evidence, Status)>,
}

impl Image {
    /// A picture to be written, in the memory of another one where that suffices.
    pub(crate) fn new(layout: Layout, spent: Option<Self>) -> Self {
        let Layout {
            size: (width, height),
            channels,
            alpha,
            uniform: Uniform { error, outcome },
        } = layout;
        let pixels = width as usize * height as usize;
        let numbers = pixels * (channels.count() + usize::from(alpha));
        let (evidence, status) = outcome.unzip();
        let spent = spent.filter(|spent| spent.values.capacity() >= numbers);
        let is_blank = spent.is_none();
        let (values, planes) = match spent {
            Some(mut spent) => {
                spent.values.resize(numbers, 0.0);
                let planes = (spent.errors, (spent.evidence, spent.statuses));
                (spent.values, Some(planes))
            }
            // Memory that the system clears, page by page where it is written.
            None => (vec![0.0; numbers], None),
        };
        let (errors, planes) = planes.unzip();
        let (known, statuses) = planes.unzip();
        Self {
            width,
            height,
            channels,
            alpha,
            values,
            errors: Plane::new(pixels, error, 0.0, errors),
            evidence: Plane::new(pixels, evidence, Evidence::Bound, known),
            statuses: Plane::new(pixels, status, Status::NoTolerance, statuses),
            is_blank,
            work: Work::default(),
        }
    }

    /// The picture with these numbers: red, green and blue of each pixel, and its alpha if `alpha`, row by row; and the error
    /// of each. Of a gray picture, red counts. Its errors are estimates, for no tolerance.
    ///
    /// # Panics
    /// If there are not as many numbers as the size needs.
    pub fn of_numbers(
        (width, height): (u32, u32),
        channels: Channels,
        alpha: bool,
        light: &[f64],
        errors: &[f64],
    ) -> Self {
        let layout = Layout {
            size: (width, height),
            channels,
            alpha,
            uniform: Uniform {
                error: None,
                outcome: Some((Evidence::Estimate, Status::NoTolerance)),
            },
        };
        let mut image = Self::new(layout, None);
        let pixels = width as usize * height as usize;
        let stride = 3 + usize::from(alpha);
        assert_eq!(light.len(), pixels * stride, "the numbers of light");
        assert_eq!(errors.len(), pixels, "the errors");
        let count = channels.count();
        let own = image.values.chunks_exact_mut(count + usize::from(alpha));
        for (own, all) in own.zip(light.chunks_exact(stride)) {
            own[..count].copy_from_slice(&all[..count]);
            own[count..].copy_from_slice(&all[3..]);
        }
        image.errors = Plane::Each(errors.to_vec());
        image.is_blank = false;
        image
    }

    /// Number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The numbers of each pixel: with color or without.
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// Returns whether the picture has an alpha channel. Its light is then premultiplied, without the background.
    pub fn has_alpha(&self) -> bool {
        self.alpha
    }

    /// Red, green, blue and alpha of a pixel; gray repeats, and alpha is 1 without its channel.
    ///
    /// # Panics
    /// Outside the picture, as for the other accessors of a pixel.
    #[inline]
    pub fn rgba(&self, col: u32, row: u32) -> [f64; 4] {
        let count = self.channels.count();
        let stride = count + usize::from(self.alpha);
        let start = self.index(col, row) * stride;
        let pixel = &self.values[start..start + stride];
        let alpha = if self.alpha { pixel[count] } else { 1.0 };
        match self.channels {
            Channels::Grey => [pixel[0], pixel[0], pixel[0], alpha],
            Channels::Rgb => [pixel[0], pixel[1], pixel[2], alpha],
        }
    }

    /// The numbers of a row's pixels from left to right: the channels of each pixel, then its alpha if there is one.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn row(&self, row: u32) -> &[f64] {
        let first = self.index(0, row);
        let stride = self.stride();
        &self.values[first * stride..][..self.width as usize * stride]
    }

    /// Returns the picture as a viewer wants it: red, green, blue and alpha of each pixel, row by row from the top, as 8 bit
    /// sRGB codes with straight alpha.
    ///
    /// Light above 1 becomes white. The codes are those of the PNG that `marbles render` writes.
    pub fn to_srgb8(&self) -> Vec<u8> {
        let pixels = (0..self.height).flat_map(|row| (0..self.width).map(move |col| (col, row)));
        let codes = |(col, row)| {
            let [red, green, blue, alpha] = self.rgba(col, row);
            let code =
                |light: f64| srgb::encode_8(if alpha == 1.0 { light } else { light / alpha });
            // The cast saturates.
            [
                code(red),
                code(green),
                code(blue),
                (255.0 * alpha + 0.5) as u8,
            ]
        };
        pixels.flat_map(codes).collect()
    }

    /// The largest distance of a pixel's numbers from the exact average over its area; infinite if nothing is known.
    pub fn error(&self, col: u32, row: u32) -> f64 {
        self.errors.at(self.index(col, row))
    }

    /// The status of a pixel: whether it meets the tolerance.
    pub fn status(&self, col: u32, row: u32) -> Status {
        self.statuses.at(self.index(col, row))
    }

    /// Returns whether a pixel's error is a bound or an estimate.
    pub fn evidence(&self, col: u32, row: u32) -> Evidence {
        self.evidence.at(self.index(col, row))
    }

    /// The work on the picture.
    pub fn work(&self) -> Work {
        self.work
    }

    pub(crate) fn set_work(&mut self, work: Work) {
        self.work = work;
    }

    /// The errors of the picture as a whole.
    pub fn summary(&self) -> Summary {
        let pixels = u64::from(self.width) * u64::from(self.height);
        Summary {
            pixels,
            largest_error: largest(self.errors.distinct()),
            bounds: count(&self.evidence, pixels, |evidence| {
                evidence == Evidence::Bound
            }),
            over_tolerance: count(&self.statuses, pixels, Status::is_over_tolerance),
        }
    }

    /// A part of the picture.
    pub(crate) fn cut(&self, window: Window) -> Self {
        let stride = self.stride();
        let rows = (window.row..window.row + window.height).map(|row| {
            let first = self.index(window.col, row);
            first..first + window.width as usize
        });
        let rows: Vec<Range<usize>> = rows.collect();
        let values = rows.iter().flat_map(|row| {
            let row = row.start * stride..row.end * stride;
            self.values[row].iter().copied()
        });
        Self {
            width: window.width,
            height: window.height,
            channels: self.channels,
            alpha: self.alpha,
            values: values.collect(),
            errors: self.errors.cut(&rows),
            evidence: self.evidence.cut(&rows),
            statuses: self.statuses.cut(&rows),
            is_blank: false,
            work: Work::default(),
        }
    }

    /// The picture cut into bands of at most `rows` rows, from the top.
    pub(crate) fn bands_mut(&mut self, rows: u32) -> impl IndexedParallelIterator<Item = Band<'_>> {
        let (width, height) = (self.width, self.height);
        let stride = self.stride();
        let pixels = width as usize * rows as usize;
        let is_blank = self.is_blank;
        let bands = self.height.div_ceil(rows) as usize;
        self.values
            .par_chunks_mut(pixels * stride)
            .zip(self.errors.bands_mut(pixels, bands))
            .zip(self.evidence.bands_mut(pixels, bands))
            .zip(self.statuses.bands_mut(pixels, bands))
            .enumerate()
            .map(move |(index, (((values, errors), evidence), statuses))| {
                let row = index as u32 * rows;
                let area = Tile {
                    col: 0,
                    row,
                    width,
                    height: rows.min(height - row),
                };
                Band {
                    area,
                    stride,
                    values,
                    errors,
                    evidence,
                    statuses,
                    is_blank,
                }
            })
    }

    /// Some rows of the picture as a band, where the picture's first pixel is (`col`, `row`) of a
    /// larger one.
    pub(crate) fn band_mut(&mut self, (col, row): (u32, u32), rows: Range<u32>) -> Band<'_> {
        let stride = self.stride();
        let width = self.width as usize;
        let pixels = rows.start as usize * width..rows.end as usize * width;
        Band {
            area: Tile {
                col,
                row: row + rows.start,
                width: self.width,
                height: rows.end - rows.start,
            },
            stride,
            values: &mut self.values[pixels.start * stride..pixels.end * stride],
            errors: self.errors.band_mut(pixels.clone()),
            evidence: self.evidence.band_mut(pixels.clone()),
            statuses: self.statuses.band_mut(pixels),
            is_blank: self.is_blank,
        }
    }

    /// Numbers of a pixel: its channels, and its alpha where there is one.
    fn stride(&self) -> usize {
        self.channels.count() + usize::from(self.alpha)
    }

    fn index(&self, col: u32, row: u32) -> usize {
        assert!(
            col < self.width && row < self.height,
            "pixel ({col}, {row}) is outside"
        );
        row as usize * self.width as usize + col as usize
    }
}

impl PartialEq for Image {
    fn eq(&self, other: &Self) -> bool {
        let size = |image: &Self| (image.width, image.height, image.channels, image.alpha);
        size(self) == size(other)
            && self.values == other.values
            && self.errors == other.errors
            && self.evidence == other.evidence
            && self.statuses == other.statuses
    }
}

/// The number of pixels, of so many, of which something holds.
fn count<T: Copy>(plane: &Plane<T>, pixels: u64, holds: impl Fn(T) -> bool) -> u64 {
    match plane {
        Plane::Same(value) if holds(*value) => pixels,
        Plane::Same(_) => 0,
        Plane::Each(values) => values.iter().filter(|&&value| holds(value)).count() as u64,
    }
}

/// The largest of some numbers that are not negative; they are ordered as their bits are, of which
/// processors compare many at a time.
fn largest(numbers: &[f64]) -> f64 {
    let bits = numbers.iter().map(|number| number.abs().to_bits());
    f64::from_bits(bits.max().unwrap_or(0))
}
