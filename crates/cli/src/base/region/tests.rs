//! Tests of `region.rs`.

use super::*;

#[test]
fn regions_are_read_as_they_are_shown() {
    for text in [
        "0,0,1,1 of 1x1",
        "32,0,16,8 of 600x400",
        "599,0,1,400 of 600x400",
    ] {
        assert_eq!(text.parse::<Region>().unwrap().to_string(), text);
    }
    for wrong in [
        "",
        "0,0,1 of 1x1",
        "0,0,0,1 of 1x1",
        "0,0,2,1 of 1x1",
        "0,1,1,1 of 1x1",
        "4294967295,0,2,1 of 9x9",
        "-1,0,1,1 of 9x9",
        "+1,0,1,1 of 9x9",
        "0,0,1,1,1 of 9x9",
        "0,0,1,1",
        " 0,0,1,1 of 9x9",
    ] {
        assert!(wrong.parse::<Region>().is_err(), "{wrong}");
    }
    assert!("0,0,9,8 of 9x8".parse::<Region>().unwrap().is_all());
    assert!(!"0,0,8,8 of 9x8".parse::<Region>().unwrap().is_all());
}
