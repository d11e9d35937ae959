//! Numbers formatted for people.

use std::time::Duration;

/// An upper bound with two digits, rounded up: `8.3e-04`, `inf`.
pub(crate) fn bound(value: f64) -> String {
    bound_with(value, 1)
}

/// An upper bound with a given number of decimals, rounded up: `8.314e-04` with three.
pub(crate) fn bound_with(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    let digits = |value: f64| -> (f64, i32) {
        let text = format!("{value:.decimals$e}");
        let parts = text.split_once('e').map(|(mantissa, exponent)| {
            let mantissa = mantissa.parse().unwrap_or_default();
            (mantissa, exponent.parse().unwrap_or_default())
        });
        parts.unwrap_or_default()
    };
    let (mut mantissa, mut exponent) = digits(value);
    let shown = |mantissa: f64, exponent: i32| format!("{mantissa:.decimals$}e{exponent}").parse();
    if shown(mantissa, exponent).is_ok_and(|shown: f64| shown < value) {
        let step = libm::pow(10.0, -(decimals as f64));
        (mantissa, exponent) = digits(shown(mantissa + step, exponent).unwrap_or(value));
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa:.decimals$}e{sign}{:02}", exponent.abs())
}

/// A number with at most six digits, without trailing zeros.
pub(crate) fn short(value: f64) -> String {
    const DIGITS: i32 = 6;
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e9).contains(&magnitude) {
        return format!("{value:.2e}");
    }
    let before_point = magnitude.log10().floor() as i32 + 1;
    let decimals = (DIGITS - before_point).clamp(0, DIGITS) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// An angle in degrees, without the error of rounding that an angle in few digits gets from radians and back.
pub(crate) fn degrees(radians: f64) -> f64 {
    /// All shorter numbers differ as doubles.
    const DIGITS: usize = 15;
    let degrees = radians.to_degrees();
    let rounded = format!("{degrees:.0$e}", DIGITS - 1).parse();
    rounded
        .ok()
        .filter(|rounded: &f64| rounded.to_radians() == radians)
        .unwrap_or(degrees)
}

/// A measured time, with three digits: `1.23 ms`.
pub(crate) fn duration(seconds: f64) -> String {
    const UNITS: [(f64, &str); 3] = [(1.0, "s"), (1e-3, "ms"), (1e-6, "µs")];
    let unit = UNITS.iter().find(|(size, _)| seconds >= 0.9995 * size);
    let (size, unit) = unit.unwrap_or(&UNITS[2]);
    format!("{} {unit}", digits(seconds / size, 3))
}

/// A ratio, with two or three digits: `0.12`, `5.3`, `53`,
/// `5260`, `123,000`, `4.7e7`.
pub(crate) fn factor(ratio: f64) -> String {
    if ratio == 0.0 {
        return "0".to_owned();
    }
    if ratio >= 999_500.0 {
        return format!("{ratio:.1e}");
    }
    let text = digits(ratio, if ratio < 999.5 { 2 } else { 3 });
    match text.len().checked_sub(3) {
        // Four digits are read as well without a comma.
        Some(thousands) if thousands > 1 && !text.contains('.') => {
            format!("{},{}", &text[..thousands], &text[thousands..])
        }
        _ => text,
    }
}

/// A fraction of a whole, with two digits: `0.12`, `0.0012`, `1.2e-7`.
pub(crate) fn fraction(ratio: f64) -> String {
    if ratio == 0.0 {
        "0".to_owned()
    } else if ratio < 1e-4 {
        format!("{ratio:.1e}")
    } else {
        digits(ratio, 2)
    }
}

/// A number above 0 with a given number of significant digits. Digits before the decimal point are kept, possibly as
/// zeros.
fn digits(value: f64, digits: i32) -> String {
    if !value.is_finite() || value <= 0.0 {
        return value.to_string();
    }
    let round = |value: f64| -> f64 {
        let decimals = usize::try_from(digits - 1).unwrap_or_default();
        format!("{value:.decimals$e}").parse().unwrap_or(value)
    };
    let rounded = round(value);
    let before_point = libm::log10(rounded).floor() as i32 + 1;
    let decimals = usize::try_from(digits - before_point).unwrap_or_default();
    format!("{rounded:.decimals$}")
}

/// A number of pixels: `360 kpx`, `21.6 Mpx`.
pub(crate) fn pixels(pixels: u64) -> String {
    in_units(pixels, [(1e9, "Gpx"), (1e6, "Mpx"), (1e3, "kpx")], "px")
}

/// A number of bytes: `360 kB`, `21.6 MB`.
pub(crate) fn bytes(bytes: u64) -> String {
    in_units(bytes, [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")], "bytes")
}

/// A quantity, in the largest unit in which it is at least one.
fn in_units(count: u64, units: [(f64, &str); 3], one: &str) -> String {
    for (size, unit) in units {
        let count = count as f64 / size;
        if count >= 100.0 {
            return format!("{count:.0} {unit}");
        }
        if count >= 1.0 {
            return format!("{count:.1} {unit}");
        }
    }
    format!("{count} {one}")
}

/// A count with a noun: `1 pixel`, `12 pixels`.
pub(crate) fn counted(count: u64, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// A waiting time: `12 s`, `3 min 20 s`, `2 h 5 min`.
pub(crate) fn wait(time: Duration) -> String {
    let seconds = time.as_secs_f64().ceil() as u64;
    let (minutes, hours) = (seconds / 60, seconds / 3600);
    if hours > 0 {
        format!("{hours} h {} min", minutes % 60)
    } else if minutes > 0 {
        format!("{minutes} min {} s", seconds % 60)
    } else {
        format!("{seconds} s")
    }
}

/// The smallest and the largest of some numbers, as a single number if both look the same.
pub(crate) fn range(numbers: impl Iterator<Item = f64>) -> String {
    let (least, largest) = numbers.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, largest), number| (least.min(number), largest.max(number)),
    );
    let (least, largest) = (short(least), short(largest));
    if least == largest {
        least
    } else {
        format!("{least} to {largest}")
    }
}

#[cfg(test)]
mod tests;
