//! EXR files as pictures: linear, premultiplied light.

use std::collections::BTreeSet;
use std::ops::Range;

use exr::meta::attribute::SampleType;
use exr::prelude::f16;

use super::block_reader::meta_of;
use super::channels::{choose, error_channel};
use super::data_window::{Channel, DataWindow};
use crate::base::failure::reason;
use crate::base::size::Size;
use crate::formats::picture::{Picture, Samples, size_of};
use crate::formats::source::Source;

/// The name of the format.
pub(crate) const NAME: &str = "EXR";

/// The numbers of a row, channel by channel.
struct Numbers {
    /// Outside of it there is no light.
    window: DataWindow,
    /// Red, green and blue, or a single channel for all three.
    colors: Vec<Channel>,
    alpha: Option<Channel>,
}

/// The picture in an EXR file.
pub(crate) fn begin(source: &Source) -> Result<Picture, String> {
    let mut file = source.open().map_err(|error| reason(&error))?;
    let meta = meta_of(&mut file)?;
    let chosen = choose(&meta.headers)?;
    let part = &meta.headers[chosen.part];
    let display = part.shared_attributes.display_window.size;
    let size = size_of(display.width(), display.height())?;
    let channel = |name: &str| Channel::of(part, &format!("{}{name}", chosen.prefix));
    let colors = chosen.colors.iter().filter_map(|&name| channel(name));
    let colors = colors.collect();
    let alpha = channel("A");
    let layer = chosen.prefix.strip_suffix('.');
    // marbles once called it `error` within its layer.
    let has_error = Channel::of(part, &error_channel(layer.unwrap_or_default())).is_some()
        || channel("error").is_some();
    let part_name = part.own_attributes.layer_name.as_ref();
    let layer = match layer {
        Some(prefix) => Some(prefix.to_owned()),
        None => part_name
            .filter(|_| chosen.part > 0)
            .map(|name| name.to_string()),
    };
    let part = chosen.part;
    let numbers = Numbers {
        window: DataWindow::of_part(file, meta, part)?,
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
    description.push_str(&numbers.data_window(size));
    Ok(Picture {
        size,
        grey: numbers.colors.len() == 1,
        alpha: numbers.alpha.is_some(),
        format: NAME,
        description,
        warnings: Vec::new(),
        row: Box::new(numbers),
    })
}

impl Samples for Numbers {
    fn advance(&mut self) -> Result<(), String> {
        self.window.advance()
    }

    fn held(&self) -> Range<u32> {
        self.window.columns()
    }

    fn end_of_run(&self, col: u32) -> u32 {
        let channels = self.colors.iter().chain(&self.alpha);
        self.window.end_of_run(col, channels)
    }

    fn rgba(&self, col: u32) -> [f64; 4] {
        self.of_pixel(col, |_, value| value)
    }

    fn rounding(&self, col: u32) -> [f64; 4] {
        let mut steps = self.of_pixel(col, half_step);
        if self.alpha.is_none() {
            steps[3] = 0.0;
        }
        steps
    }

    fn is_full(&self, col: u32) -> [bool; 4] {
        let full = self.of_pixel(col, |kind, value| {
            let largest = match kind {
                SampleType::F16 => f16::MAX.to_f64(),
                SampleType::F32 => f32::MAX.into(),
                SampleType::U32 => u32::MAX.into(),
            };
            f64::from(u8::from(value == largest))
        });
        full.map(|full| full == 1.0)
    }
}

impl Numbers {
    /// The types of the numbers, without repetition: `half`, `float + half`.
    fn kinds(&self) -> String {
        let channels = self.colors.iter().chain(&self.alpha);
        let kinds = channels.map(|channel| match channel.kind {
            SampleType::F16 => "half",
            SampleType::F32 => "float",
            SampleType::U32 => "uint",
        });
        let kinds: BTreeSet<&str> = kinds.collect();
        kinds.into_iter().collect::<Vec<_>>().join(" + ")
    }

    /// The description of the data window, if it is not the whole picture.
    fn data_window(&self, picture: Size) -> String {
        let ((col, row), (width, height)) = (self.window.origin(), self.window.size());
        if (col, row) == (0, 0)
            && (width, height) == (picture.width as usize, picture.height as usize)
        {
            return String::new();
        }
        format!(", data window {width} x {height} at column {col}, row {row}")
    }

    /// Applies `of` to the numbers of a pixel; outside the data window there is no light.
    fn of_pixel(&self, col: u32, of: fn(SampleType, f64) -> f64) -> [f64; 4] {
        let place = self.window.place(col);
        let of = |channel: &Channel| {
            let value = |place| of(channel.kind, self.window.value(place, channel));
            place.map_or(0.0, value)
        };
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

/// Half the distance to the next number of the same type.
fn half_step(kind: SampleType, value: f64) -> f64 {
    /// The number of bits after the leading one, and the smallest exponent of numbers with all these bits.
    const HALF: (i32, i32) = (10, -14);
    const FLOAT: (i32, i32) = (23, -126);
    let (bits, least) = match kind {
        SampleType::F16 => HALF,
        SampleType::F32 => FLOAT,
        SampleType::U32 => return 0.5,
    };
    let value = value.abs();
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
