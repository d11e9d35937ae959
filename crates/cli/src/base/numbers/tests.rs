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
fn degrees_are_those_that_were_written() {
    for written in [0.53, 3.0, 0.1, 179.9, 1e-9, 1.0 / 3.0] {
        let found = degrees(f64::to_radians(written));
        assert!((found - written).abs() <= f64::EPSILON * written, "{found}");
    }
    for written in [0.53, 3.0, 0.1, 179.9, 1e-9] {
        assert_eq!(degrees(f64::to_radians(written)), written);
    }
    assert_eq!(degrees(0.0), 0.0);
}

#[test]
fn measured_numbers_have_the_digits_that_count() {
    let times = [
        0.0123456, 1.23456, 123.456, 9.996e-4, 4.5e-7, 0.9999, 1234.5,
    ];
    let texts = [
        "12.3 ms",
        "1.23 s",
        "123 s",
        "1.00 ms",
        "0.450 µs",
        "1.00 s",
        "1230 s",
    ];
    assert_eq!(times.map(duration), texts.map(str::to_owned));
    let ratios = [
        0.0, 0.123, 0.999, 5.26, 52.6, 526.0, 5263.0, 123_456.0, 1.0, 4.66e7,
    ];
    let texts = [
        "0", "0.12", "1.0", "5.3", "53", "530", "5260", "123,000", "1.0", "4.7e7",
    ];
    assert_eq!(ratios.map(factor), texts.map(str::to_owned));
    let parts = [0.0, 0.5, 0.001_234, 1.234e-7, f64::INFINITY];
    let texts = ["0", "0.50", "0.0012", "1.2e-7", "inf"];
    assert_eq!(parts.map(fraction), texts.map(str::to_owned));
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
