//! Tests of `turntable.rs`.

use super::*;

#[test]
fn whole_turns_loop_to_the_bit() {
    for turns in [1.0, -1.0, 3.0, 0.0, 7.0, 1e300, -123_456_789.0] {
        for frames in [1, 2, 7, 120, i32::MAX] {
            let turntable = Turntable { frames, turns };
            for frame in [1, 2, 5, 100, -3, 0] {
                let other = i64::from(frame) + i64::from(frames);
                let Ok(other) = i32::try_from(other) else {
                    continue;
                };
                assert_eq!(
                    turntable.azimuth_degrees(frame).to_bits(),
                    turntable.azimuth_degrees(other).to_bits()
                );
                for later in [-0.5, -0.123, 0.0, 0.3, 0.5] {
                    assert_eq!(
                        turntable.azimuth_degrees_at(frame, later).to_bits(),
                        turntable.azimuth_degrees_at(other, later).to_bits()
                    );
                }
                assert_eq!(turntable.looped(frame), turntable.looped(other));
            }
        }
    }
}

#[test]
fn a_turn_is_divided_evenly() {
    let turntable = Turntable {
        frames: 8,
        turns: 1.0,
    };
    let azimuths: Vec<f64> = (1..=8).map(|f| turntable.azimuth_degrees(f)).collect();
    assert_eq!(
        azimuths,
        [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]
    );
    let back = Turntable {
        frames: 8,
        turns: -1.0,
    };
    assert_eq!(back.azimuth_degrees(2), 315.0);
    assert_eq!(turntable.azimuth_degrees_at(2, 0.5), 67.5);
    assert_eq!(turntable.azimuth_degrees_at(1, -0.25), -11.25);
    assert_eq!(back.azimuth_degrees_at(2, 0.5), 292.5);
    assert_eq!(back.looped(9), 1);
}

#[test]
fn part_of_a_turn_does_not_loop() {
    let turntable = Turntable {
        frames: 4,
        turns: 0.5,
    };
    assert_eq!(turntable.azimuth_degrees(3), 90.0);
    assert_eq!(turntable.azimuth_degrees(5), 180.0);
    assert_eq!(turntable.looped(5), 5);
    for frame in [i32::MIN, i32::MAX] {
        assert!(turntable.azimuth_degrees(frame).is_finite());
    }
}
