//! Tests of `colormap.rs`.

use super::*;

#[test]
fn colormaps_are_those_that_others_show() {
    for (map, at, expected) in [
        (Colormap::Viridis, 0, 0x440154),
        (Colormap::Viridis, 128, 0x21918c),
        (Colormap::Viridis, 255, 0xfde725),
        (Colormap::Inferno, 0, 0x000004),
        (Colormap::Inferno, 255, 0xfcffa4),
        (Colormap::Magma, 255, 0xfcfdbf),
        (Colormap::Plasma, 0, 0x0d0887),
        (Colormap::Plasma, 255, 0xf0f921),
        (Colormap::Cividis, 0, 0x00224e),
        (Colormap::CoolWarm, 0, 0x3b4cc0),
        (Colormap::CoolWarm, 255, 0xb40426),
        (Colormap::Grey, 100, 0x646464),
    ] {
        let colors = map.colors();
        assert_eq!(colors.len(), 256, "{map:?}");
        assert_eq!(colors[at], from_srgb(expected), "{map:?}");
    }
}

#[test]
fn numbers_are_spread_over_the_colors() {
    assert_eq!(index(0.0, 0.0, 1.0), 0);
    assert_eq!(index(0.5, 0.0, 1.0), 128);
    assert_eq!(index(1.0, 0.0, 1.0), 255);
    assert_eq!((index(-9.0, 0.0, 1.0), index(9.0, 0.0, 1.0)), (0, 255));
    assert_eq!(index(3.0, 3.0, 3.0), 128);
    assert_eq!(index(f64::MAX, -f64::MAX, f64::MAX), 255);
    assert_eq!(index(0.0, -f64::MAX, f64::MAX), 128);
}
