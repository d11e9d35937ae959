//! The rules that concern a camera and its animation together.

use crate::file::{Animation, Camera, File, Key};
use crate::text::{Placed, did_you_mean, either, refuse, show, token};

/// Reports the faults of the camera and the animation of the file with this text.
pub(super) fn check(file: &File, text: &str) {
    let camera = file.camera.value.as_ref();
    if let Some(camera) = camera {
        check_gaze(camera);
    }
    let Some(animation) = &file.animation else {
        return;
    };
    match (&animation.value, camera) {
        (Some(Animation::Keyframes { keys, .. }), _) => check_keys(keys, camera, text),
        (Some(Animation::Turntable { .. }), Some(camera)) => {
            check_orbit(camera, animation.place.start, text);
        }
        _ => {}
    }
}

/// Refuses a camera that looks nowhere.
fn check_gaze(camera: &Camera) {
    if let Camera::LookAt {
        position, target, ..
    } = camera
        && let (Some(from), Some(to)) = (position.get(), target.get())
        && from.0 == to.0
    {
        let message = "expected a target other than the camera's position, found the same point";
        refuse::<()>(target.place.clone(), message);
    }
}

/// Refuses a turntable, which starts at `start`, without an orbit.
fn check_orbit(camera: &Camera, start: usize, text: &str) {
    if !matches!(camera, Camera::Orbit { .. } | Camera::Frame { .. }) {
        let kind = camera.kind();
        let expected = "expected an `Orbit` or `Frame` camera for a `Turntable`";
        let message = format!("{expected}, found a `{kind}` camera");
        refuse::<()>(start..token::token_end(text, start), message);
    }
}

/// Refuses keys out of order, and channels that the camera lacks.
fn check_keys(keys: &[Placed<Key>], camera: Option<&Camera>, text: &str) {
    let mut before = None;
    for placed in keys {
        let Some(key) = &placed.value else { continue };
        if let Some(frame) = key.frame.get() {
            if let Some(before) = before
                && frame.0 <= before
            {
                let expected = format!("a frame after {before}, the frame of the key before");
                let message = format!("expected {expected}, found {}", frame.0);
                refuse::<()>(key.frame.place.clone(), message);
            }
            before = Some(frame.0);
        }
        if let Some(camera) = camera {
            check_channels(placed.place.start, key, camera, text);
        }
    }
}

fn check_channels(key_start: usize, key: &Key, camera: &Camera, text: &str) {
    let known = || camera.channels().iter().copied();
    for (name, value) in key.channels() {
        if let Some(value) = value
            && !camera.channels().contains(&name)
        {
            let (kind, list) = (camera.kind(), either(known()));
            let meant = did_you_mean(name, known(), show);
            let place = token::field_name(text, key_start, value.start);
            refuse::<()>(
                place,
                format!(
                    "expected a channel of the `{kind}` camera ({list}), found `{name}`{meant}"
                ),
            );
        }
    }
}
