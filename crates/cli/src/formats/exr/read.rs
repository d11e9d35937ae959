//! EXR, as it is: linear light, premultiplied.

use std::collections::BTreeSet;
use std::io::Cursor;

use exr::meta::MetaData;
use exr::prelude::f16;
use exr::prelude::{FlatSamples, Image, ReadChannels, ReadLayers};

use super::channels::choose;
use crate::base::size::Size;
use crate::formats::picture::{Picture, Samples, check_memory};

/// The numbers of a file, channel by channel.
#[derive(Debug)]
struct Numbers {
    /// The top left corner of the data window, from that of the display window.
    origin: (i64, i64),
    /// The size of the data window. Outside of it there is no light.
    size: (usize, usize),
    /// Red, green and blue, or one that stands for all three.
    colors: Vec<FlatSamples>,
    alpha: Option<FlatSamples>,
}

/// The picture in the bytes of an EXR file.
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, String> {
    let picture_size = check_sizes(bytes)?;
    let Image {
        attributes,
        layer_data: parts,
    } = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| error.to_string())?;
    let chosen = choose(&parts)?;
    let Some(part) = parts.into_iter().nth(chosen.part) else {
        return Err("it has no parts".to_owned());
    };

    let display = attributes.display_window;
    let position = part.attributes.layer_position;
    let offset = |data: i32, display: i32| i64::from(data) - i64::from(display);
    let origin = (
        offset(position.x(), display.position.x()),
        offset(position.y(), display.position.y()),
    );
    let size = (part.size.width(), part.size.height());
    let part_name = part.attributes.layer_name.map(|name| name.to_string());
    let mut channels = part.channel_data.list;
    let mut take = |name: &str| {
        let name = format!("{}{name}", chosen.prefix);
        let index = channels.iter().position(|channel| channel.name == *name)?;
        Some(channels.remove(index).sample_data)
    };
    let colors = chosen.colors.iter().filter_map(|&name| take(name));
    let colors = colors.collect();
    let alpha = take("A");
    let has_error = take("error").is_some();
    let layer = match chosen.prefix.strip_suffix('.') {
        Some(prefix) => Some(prefix.to_owned()),
        None => part_name.filter(|_| chosen.part > 0),
    };

    let numbers = Numbers {
        origin,
        size,
        colors,
        alpha,
    };
    let mut description = format!("EXR, {}, {}", numbers.kinds(), chosen.colors.concat());
    if numbers.alpha.is_some() {
        description.push('A');
    }
    if has_error {
        description.push_str(" and error");
    }
    if let Some(layer) = layer {
        description.push_str(&format!(" of layer {layer}"));
    }
    description.push_str(&numbers.data_window(picture_size));
    Ok(Picture {
        size: picture_size,
        grey: numbers.colors.len() == 1,
        alpha: numbers.alpha.is_some(),
        description,
        warning: None,
        samples: Box::new(numbers),
    })
}

/// The size of the picture; refuses what there is no memory for, before the pixels are read.
fn check_sizes(bytes: &[u8]) -> Result<Size, String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false)
        .map_err(|error| error.to_string())?;
    let mut picture = Err("it has no parts".to_owned());
    for header in &meta.headers {
        let (display, data) = (header.shared_attributes.display_window, header.layer_size);
        picture = Ok(check_memory(
            display.size.width(),
            display.size.height(),
            1,
        )?);
        check_memory(data.width(), data.height(), header.channels.bytes_per_pixel)?;
    }
    picture
}

impl Samples for Numbers {
    fn rgba(&self, col: u32, row: u32) -> [f64; 4] {
        self.of_pixel(col, row, value)
    }

    fn rounding(&self, col: u32, row: u32) -> [f64; 4] {
        let mut steps = self.of_pixel(col, row, half_step);
        if self.alpha.is_none() {
            steps[3] = 0.0;
        }
        steps
    }

    fn is_full(&self, col: u32, row: u32) -> [bool; 4] {
        let full = self.of_pixel(col, row, |samples, index| {
            let largest = match samples {
                FlatSamples::F16(_) => f16::MAX.to_f64(),
                FlatSamples::F32(_) => f32::MAX.into(),
                FlatSamples::U32(_) => u32::MAX.into(),
            };
            f64::from(u8::from(value(samples, index) == largest))
        });
        full.map(|full| full == 1.0)
    }
}

impl Numbers {
    /// The types of numbers, each once: `half`, `float + half`.
    fn kinds(&self) -> String {
        let channels = self.colors.iter().chain(&self.alpha);
        let kinds = channels.map(|samples| match samples {
            FlatSamples::F16(_) => "half",
            FlatSamples::F32(_) => "float",
            FlatSamples::U32(_) => "uint",
        });
        let kinds: BTreeSet<&str> = kinds.collect();
        kinds.into_iter().collect::<Vec<_>>().join(" + ")
    }

    /// The words about the data window where it is not the whole picture.
    fn data_window(&self, picture: Size) -> String {
        let ((col, row), (width, height)) = (self.origin, self.size);
        if (col, row) == (0, 0)
            && (width, height) == (picture.width as usize, picture.height as usize)
        {
            return String::new();
        }
        format!(", data window {width} x {height} at column {col}, row {row}")
    }

    /// The numbers that `get` finds at a pixel; outside the data window there is no light.
    fn of_pixel(&self, col: u32, row: u32, get: fn(&FlatSamples, usize) -> f64) -> [f64; 4] {
        let inside = |at: u32, origin: i64, size: usize| {
            let at = usize::try_from(i64::from(at) - origin).ok()?;
            (at < size).then_some(at)
        };
        let col = inside(col, self.origin.0, self.size.0);
        let index = col.and_then(|col| {
            let row = inside(row, self.origin.1, self.size.1)?;
            Some(row * self.size.0 + col)
        });
        let of = |samples: &FlatSamples| index.map_or(0.0, |index| get(samples, index));
        let alpha = self.alpha.as_ref().map_or(1.0, of);
        match &self.colors[..] {
            [red, green, blue] => [of(red), of(green), of(blue), alpha],
            colors => {
                let grey = colors.first().map_or(0.0, of);
                [grey, grey, grey, alpha]
            }
        }
    }
}

fn value(samples: &FlatSamples, index: usize) -> f64 {
    match samples {
        FlatSamples::F16(values) => values[index].to_f64(),
        FlatSamples::F32(values) => f64::from(values[index]),
        FlatSamples::U32(values) => f64::from(values[index]),
    }
}

/// Half the way to the next number of the same type.
fn half_step(samples: &FlatSamples, index: usize) -> f64 {
    /// Bits after the leading one, and the least exponent of numbers that have them all.
    const HALF: (i32, i32) = (10, -14);
    const FLOAT: (i32, i32) = (23, -126);
    let (bits, least) = match samples {
        FlatSamples::F16(_) => HALF,
        FlatSamples::F32(_) => FLOAT,
        FlatSamples::U32(_) => return 0.5,
    };
    let value = value(samples, index).abs();
    if !value.is_finite() {
        return 0.0;
    }
    let exponent = if value == 0.0 {
        least
    } else {
        libm::ilogb(value).max(least)
    };
    libm::ldexp(0.5, exponent - bits)
}

#[cfg(test)]
mod tests;
