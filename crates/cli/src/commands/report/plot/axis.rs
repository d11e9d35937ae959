//! Logarithmic axes.

/// An axis over whole powers of ten, from `start` to `end`; `end` is smaller if values decrease along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    /// Powers of ten, and their positions on the drawing.
    start: (i32, f64),
    end: (i32, f64),
}

/// A tick mark of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    /// The label: a power of ten, at every power or, on long axes, at every second one, and so on.
    pub(super) label: Option<i32>,
    /// Whether it is at a power of ten.
    pub(super) is_decade: bool,
}

impl Axis {
    /// The shortest axis that contains all values above 0, from `start` to `end` on the drawing; with `falls`, values
    /// decrease along it.
    pub(super) fn around(
        values: impl IntoIterator<Item = f64>,
        (start, end): (f64, f64),
        falls: bool,
    ) -> Self {
        let mut decades: Option<(i32, i32)> = None;
        for value in values {
            if value > 0.0 && value.is_finite() {
                let power = libm::log10(value);
                let (low, high) = (power.floor() as i32, power.ceil() as i32);
                decades = Some(decades.map_or((low, high), |(least, most)| {
                    (least.min(low), most.max(high))
                }));
            }
        }
        let (low, high) = decades.unwrap_or((0, 1));
        let high = high.max(low + 1);
        let (first, last) = if falls { (high, low) } else { (low, high) };
        Self {
            start: (first, start),
            end: (last, end),
        }
    }

    /// The place of a value.
    pub(super) fn place(&self, value: f64) -> f64 {
        let ((first, start), (last, end)) = (self.start, self.end);
        let along = (libm::log10(value) - f64::from(first)) / f64::from(last - first);
        start + along * (end - start)
    }

    /// The smallest and the largest value on the axis.
    pub(super) fn range(&self) -> (f64, f64) {
        let (low, high) = self.decades();
        (power_of_ten(low), power_of_ten(high))
    }

    /// The tick marks, at most `most` of them with labels.
    pub(super) fn ticks(&self, most: u32) -> Vec<Tick> {
        let (low, high) = self.decades();
        let step = (high.abs_diff(low) + 1).div_ceil(most) as i32;
        let mut ticks = Vec::new();
        for decade in low..=high {
            ticks.push(Tick {
                at: self.place(power_of_ten(decade)),
                label: (decade.rem_euclid(step) == 0).then_some(decade),
                is_decade: true,
            });
            if decade < high && step == 1 {
                ticks.extend((2..10).map(|multiple| Tick {
                    at: self.place(f64::from(multiple) * power_of_ten(decade)),
                    label: None,
                    is_decade: false,
                }));
            }
        }
        ticks
    }

    fn decades(&self) -> (i32, i32) {
        let (first, last) = (self.start.0, self.end.0);
        (first.min(last), first.max(last))
    }
}

fn power_of_ten(exponent: i32) -> f64 {
    libm::pow(10.0, f64::from(exponent))
}

#[cfg(test)]
mod tests;
