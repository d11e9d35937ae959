//! Numbers as people read them.

use std::time::Duration;

/// An upper bound with two digits, rounded up: `8.3e-04`, `inf`.
pub(crate) fn bound(value: f64) -> String {
    bound_with(value, 1)
}

/// An upper bound with so many decimals, rounded up: `8.314e-04` with three.
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

/// A number with six digits at most, without zeros that say nothing.
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

/// A number of pixels: `360 kpx`, `21.6 Mpx`.
pub(crate) fn pixels(pixels: u64) -> String {
    const UNITS: [(f64, &str); 3] = [(1e9, "Gpx"), (1e6, "Mpx"), (1e3, "kpx")];
    for (size, unit) in UNITS {
        let count = pixels as f64 / size;
        if count >= 100.0 {
            return format!("{count:.0} {unit}");
        }
        if count >= 1.0 {
            return format!("{count:.1} {unit}");
        }
    }
    format!("{pixels} px")
}

/// A time to wait: `12 s`, `3 min 20 s`, `2 h 5 min`.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_round_up() {
        assert_eq!(bound(8.3e-4), "8.3e-04");
        assert_eq!(bound(8.21e-4), "8.3e-04");
        assert_eq!(bound(9.91e-4), "1.0e-03");
        assert_eq!(bound(0.0), "0.0e+00");
        assert_eq!(bound(1.0), "1.0e+00");
        assert_eq!(bound(123.0), "1.3e+02");
        assert_eq!(bound(1e-300), "1.0e-300");
        assert_eq!(bound(f64::INFINITY), "inf");
        assert_eq!(bound_with(8.3141e-4, 3), "8.315e-04");
        assert_eq!(bound_with(9.9991e-4, 3), "1.000e-03");
        assert_eq!(bound_with(1e-3, 3), "1.000e-03");
        for exponent in -320..=300 {
            for mantissa in 10..=99 {
                let value: f64 = format!("{mantissa}e{exponent}").parse().unwrap();
                for value in [value.next_down(), value, value.next_up()] {
                    for decimals in [1, 3] {
                        let text = bound_with(value, decimals);
                        let shown: f64 = text.parse().unwrap();
                        assert!(shown >= value, "{value:e} as {text}");
                    }
                }
            }
        }
    }

    #[test]
    fn short_numbers_are_plain() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (600.0, "600"),
            (-0.577_350_269, "-0.57735"),
            (0.5, "0.5"),
            (123_456.789, "123457"),
            (1234.5, "1234.5"),
            (1e-9, "1.00e-9"),
            (6.02e23, "6.02e23"),
            (12_345_678.0, "12345678"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn waits_and_pixels_have_units() {
        assert_eq!(wait(Duration::from_millis(11_200)), "12 s");
        assert_eq!(wait(Duration::from_secs(200)), "3 min 20 s");
        assert_eq!(wait(Duration::from_secs(7500)), "2 h 5 min");
        assert_eq!(pixels(64), "64 px");
        assert_eq!(pixels(360_000), "360 kpx");
        assert_eq!(pixels(21_600_000), "21.6 Mpx");
        assert_eq!(pixels(4_294_967_296), "4.3 Gpx");
    }
}
