//! Tests of `turntable.rs`.

use super::*;

const STILL: Turntable = Turntable {
    frames: 1,
    turns: 0.0,
    axis: None,
    up: Up::Y,
    swing: None,
};

#[test]
fn whole_turns_loop_to_the_bit() {
    for turns in [1.0, -1.0, 3.0, 0.0, 7.0, 1e300, -123_456_789.0] {
        for frames in [1, 2, 7, 120, i32::MAX] {
            let turntable = Turntable {
                frames,
                turns,
                ..STILL
            };
            for frame in [1, 2, 5, 100, -3, 0] {
                let other = i64::from(frame) + i64::from(frames);
                let Ok(other) = i32::try_from(other) else {
                    continue;
                };
                assert_eq!(
                    turntable.phase_degrees(frame).to_bits(),
                    turntable.phase_degrees(other).to_bits()
                );
                for later in [-0.5, -0.123, 0.0, 0.3, 0.5] {
                    assert_eq!(
                        turntable.phase_degrees_at(frame, later).to_bits(),
                        turntable.phase_degrees_at(other, later).to_bits()
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
        ..STILL
    };
    let azimuths: Vec<f64> = (1..=8).map(|f| turntable.phase_degrees(f)).collect();
    assert_eq!(
        azimuths,
        [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]
    );
    let back = Turntable {
        frames: 8,
        turns: -1.0,
        ..STILL
    };
    assert_eq!(back.phase_degrees(2), 315.0);
    assert_eq!(turntable.phase_degrees_at(2, 0.5), 67.5);
    assert_eq!(turntable.phase_degrees_at(1, -0.25), -11.25);
    assert_eq!(back.phase_degrees_at(2, 0.5), 292.5);
    assert_eq!(back.looped(9), 1);
}

#[test]
fn part_of_a_turn_does_not_loop() {
    let turntable = Turntable {
        frames: 4,
        turns: 0.5,
        ..STILL
    };
    assert_eq!(turntable.phase_degrees(3), 90.0);
    assert_eq!(turntable.phase_degrees(5), 180.0);
    assert_eq!(turntable.looped(5), 5);
    for frame in [i32::MIN, i32::MAX] {
        assert!(turntable.phase_degrees(frame).is_finite());
    }
}

#[test]
fn swings_there_and_back_by_a_sine() {
    let rocking = Turntable {
        frames: 12,
        turns: 1.0,
        swing: Some(30.0),
        ..STILL
    };
    let angles = [1, 2, 4, 6, 7, 10, 13].map(|frame| rocking.degrees_at(frame, 0.0));
    let expected = [0.0, 15.0, 30.0, 15.0, 0.0, -30.0, 0.0];
    for (angle, expected) in angles.into_iter().zip(expected) {
        assert!((angle - expected).abs() < 1e-14, "{angles:?}");
    }
    assert_eq!(
        rocking.degrees_at(2, 0.25).to_bits(),
        rocking.degrees_at(14, 0.25).to_bits()
    );
}

#[test]
fn turns_about_an_axis() {
    let about = |axis: DVec3| Turntable {
        frames: 4,
        turns: 1.0,
        axis: Some(axis),
        ..STILL
    };
    let turned = |axis: DVec3, vector: DVec3| (about(axis).rotation(2) * vector).to_array();
    assert_eq!(turned(DVec3::Z, DVec3::X), [0.0, 1.0, 0.0]);
    assert_eq!(turned(DVec3::X, DVec3::Y), [0.0, 0.0, 1.0]);
    assert_eq!(turned(-DVec3::Y, DVec3::X), [0.0, 0.0, 1.0]);
    // A third of a turn about the diagonal takes each axis to the next.
    let diagonal = Turntable {
        frames: 3,
        ..about(DVec3::ONE.normalize())
    };
    let next = diagonal.rotation(2) * DVec3::new(1.0, 2.0, 3.0);
    assert!(
        (next - DVec3::new(3.0, 1.0, 2.0)).length() < 1e-14,
        "{next}"
    );
    // The vertical is what a turntable has that names no axis.
    let vertical = Turntable {
        axis: None,
        frames: 7,
        ..about(DVec3::Y)
    };
    let named = Turntable {
        frames: 7,
        ..about(DVec3::Y)
    };
    // So are other axes that point up.
    for (up, axis) in [(Up::X, DVec3::X), (Up::Z, DVec3::Z)] {
        let upright = Turntable { up, ..vertical };
        let apart = upright.rotation(3)
            - Turntable {
                frames: 7,
                ..about(axis)
            }
            .rotation(3);
        assert!(apart.abs().to_cols_array().iter().all(|part| *part < 1e-15));
    }
    for frame in 1..=7 {
        let apart = vertical.rotation(frame) - named.rotation(frame);
        assert!(apart.abs().to_cols_array().iter().all(|part| *part < 1e-15));
    }
}
