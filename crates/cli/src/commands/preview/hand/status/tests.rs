//! Tests of `status.rs`.

use marbles_scene::OrbitCenter;

use super::*;

#[test]
fn the_line_is_as_long_as_fits() {
    let camera = OrbitCamera {
        center: OrbitCenter::Framed,
        azimuth: -1.0 / 3.0,
        elevation: 15.0,
        roll: 0.0,
        zoom: 1.0,
    };
    for (columns, expected) in [
        (
            200,
            "azimuth -0.3333, elevation 15 | arrows turn  + - zoom  r R roll  Home back  w write  p print  q quit",
        ),
        (
            99,
            "azimuth -0.3333, elevation 15 | arrows turn  + - zoom  r roll  Home  w write  p print  q quit",
        ),
        (
            80,
            "azimuth -0.3333, elevation 15 | arrows + - r Home  w write  p print  q quit",
        ),
        (
            74,
            "arrows turn  + - zoom  r R roll  Home back  w write  p print  q quit",
        ),
        (60, "arrows + - r Home  w write  p print  q quit"),
        (40, "arrows + - r Home w p q"),
        (10, "q quits"),
        (3, "q quits"),
    ] {
        assert_eq!(of_camera(&camera, columns), expected, "{columns}");
    }
    let turned = OrbitCamera {
        roll: 2.5,
        zoom: 1.189,
        ..camera
    };
    let start = "azimuth -0.3333, elevation 15, roll 2.5, zoom 1.189 | arrows";
    assert!(of_camera(&turned, 200).starts_with(start));
}

#[test]
fn the_line_says_why_the_camera_stays() {
    let reason = "the keys of the animation move the camera";
    assert_eq!(
        of_still(reason, 71),
        format!("it cannot be turned: {reason}; q quits")
    );
    assert_eq!(of_still(reason, 70), format!("q quits; {reason}"));
    assert_eq!(of_still(reason, 20), format!("q quits; {reason}"));
}
