//! Tests of `motion.rs`.

use marbles_core::glam::DVec3;
use marbles_scene::OrbitCenter;

use super::*;

fn camera(azimuth: f64, elevation: f64, roll: f64, zoom: f64) -> OrbitCamera {
    OrbitCamera {
        center: OrbitCenter::At {
            target: DVec3::ONE,
            radius: 3.0,
        },
        azimuth,
        elevation,
        roll,
        zoom,
    }
}

/// Azimuth, elevation, roll and zoom after some keys.
fn after(start: OrbitCamera, keys: &[Key]) -> [f64; 4] {
    let mut hand = Hand::new(start);
    let motions = keys.iter().filter_map(|&key| Motion::of(key));
    motions.for_each(|motion| hand.apply(motion));
    let camera = hand.camera();
    assert_eq!(camera.center, start.center);
    [camera.azimuth, camera.elevation, camera.roll, camera.zoom]
}

fn arrow(to: Direction, shift: bool) -> Key {
    Key::Arrow { to, shift }
}

const RIGHT: Key = Key::Arrow {
    to: Direction::Right,
    shift: false,
};

#[test]
fn keys_turn_and_zoom() {
    let start = camera(10.0, 20.0, 0.0, 2.0);
    for (key, expected) in [
        (RIGHT, [5.0, 20.0, 0.0, 2.0]),
        (arrow(Direction::Left, false), [15.0, 20.0, 0.0, 2.0]),
        (arrow(Direction::Left, true), [11.0, 20.0, 0.0, 2.0]),
        (arrow(Direction::Up, false), [10.0, 25.0, 0.0, 2.0]),
        (arrow(Direction::Down, true), [10.0, 19.0, 0.0, 2.0]),
        (Key::Letter(b'r'), [10.0, 20.0, 5.0, 2.0]),
        (Key::Letter(b'R'), [10.0, 20.0, -5.0, 2.0]),
        // 2 times the fourth root of 2, which is 1.189207.
        (Key::Letter(b'+'), [10.0, 20.0, 0.0, 2.378]),
        (Key::Letter(b'-'), [10.0, 20.0, 0.0, 1.682]),
        (Key::Letter(b'x'), [10.0, 20.0, 0.0, 2.0]),
    ] {
        assert_eq!(after(start, &[key]), expected, "{key:?}");
    }
    assert_eq!(after(start, &[Key::Letter(b'='); 4])[3], 4.0);
    let both = [[Key::Letter(b'+'); 9], [Key::Letter(b'_'); 9]].concat();
    assert_eq!(after(start, &both)[3], 2.0);
}

#[test]
fn the_camera_stops_at_the_poles() {
    let up = arrow(Direction::Up, false);
    let down = arrow(Direction::Down, false);
    assert_eq!(after(camera(0.0, 83.0, 0.0, 1.0), &[up; 2])[1], 90.0);
    assert_eq!(
        after(camera(0.0, 83.0, 0.0, 1.0), &[up, up, up, down])[1],
        85.0
    );
    assert_eq!(after(camera(0.0, -83.0, 0.0, 1.0), &[down; 9])[1], -90.0);
    // Where a file has it, it may stay.
    assert_eq!(after(camera(0.0, 120.0, 0.0, 1.0), &[up])[1], 120.0);
    assert_eq!(after(camera(0.0, 120.0, 0.0, 1.0), &[down])[1], 115.0);
}

#[test]
fn a_whole_turn_is_none() {
    assert_eq!(after(camera(10.0, 0.0, 0.0, 1.0), &[RIGHT; 72])[0], 10.0);
    assert_eq!(after(camera(-175.0, 0.0, 0.0, 1.0), &[RIGHT])[0], 180.0);
    assert_eq!(after(camera(-178.0, 0.0, 0.0, 1.0), &[RIGHT])[0], 177.0);
    assert_eq!(after(camera(0.1, 0.0, 0.0, 1.0), &[RIGHT; 3])[0], -14.9);
    assert_eq!(
        after(camera(0.0, 0.0, 178.0, 1.0), &[Key::Letter(b'r')])[2],
        -177.0
    );
    // The same angle as in the file, in its words.
    assert_eq!(after(camera(725.0, 0.0, 0.0, 1.0), &[])[0], 725.0);
}

#[test]
fn home_is_the_camera_of_the_file() {
    let start = camera(1.0 / 3.0, -725.0, 1e-7, 0.1 + 0.2);
    let mut hand = Hand::new(start);
    assert_eq!(hand.change(), Change::None);
    for key in [
        RIGHT,
        arrow(Direction::Up, true),
        Key::Letter(b'r'),
        Key::Letter(b'+'),
    ] {
        hand.apply(Motion::of(key).unwrap());
    }
    assert_eq!(hand.change(), Change::Turn(hand.camera()));
    hand.apply(Motion::Home);
    assert_eq!(hand, Hand::new(start));
    assert_eq!(hand.camera(), start);
    hand.apply(Motion::Zoom(1));
    assert_eq!(hand.change(), Change::Zoom(hand.camera()));
    // Once it is written, the file has it.
    hand.is_written();
    let written = hand.camera();
    assert_eq!(hand.change(), Change::None);
    hand.apply(Motion::Zoom(1));
    hand.apply(Motion::Home);
    assert_eq!(hand.camera(), written);
}
