//! The rules that concern a camera, lights and the animation together.

use std::collections::{HashMap, HashSet};

use crate::file::{Animation, Camera, Channel, File, Key, Light, Turned};
use crate::text::{Placed, did_you_mean, either, list, quoted, refuse, show, token};
use crate::values::LightName;

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
        (Some(Animation::Keyframes { keys, .. }), _) => {
            check_keys(keys, camera, &file.lights, text);
            if file.sky.is_none() {
                refuse_keys_of_sky(keys, text);
            }
        }
        (Some(Animation::Turntable { what, .. }), Some(camera))
            if what.get() == Some(Turned::Camera) =>
        {
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

/// Refuses keys out of order, and channels that the camera or a light lacks.
fn check_keys(keys: &[Placed<Key>], camera: Option<&Camera>, lights: &[Placed<Light>], text: &str) {
    // The camera's, then those of lights by their names.
    let mut before: HashMap<Option<&str>, i32> = HashMap::new();
    for placed in keys {
        let Some(key) = &placed.value else { continue };
        let name = key.light.as_ref().map(|name| name.value.as_ref());
        let Some(name) = name.map_or(Some(None), |name| name.map(|name| Some(name.0.as_str())))
        else {
            continue;
        };
        if let Some(frame) = key.frame.get() {
            if let Some(before) = before.get(&name)
                && frame.0 <= *before
            {
                let expected = format!("a frame after {before}, the frame of the previous key");
                let message = format!("expected {expected}, found {}", frame.0);
                refuse::<()>(key.frame.place.clone(), message);
            }
            before.insert(name, frame.0);
        }
        let start = placed.place.start;
        if let Some(name) = &key.light {
            check_light_key(start, key, name, lights, text);
        } else if let Some(camera) = camera {
            let owner = format!("`{}` camera", camera.kind());
            // The sky is no part of the camera, but in its keys.
            let named = key
                .channels()
                .into_iter()
                .filter(|(name, _)| *name != "sky");
            check_channels((start, named), &owner, camera.channels(), text);
        }
    }
}

/// Refuses keys of a sky that the scene does not have.
fn refuse_keys_of_sky(keys: &[Placed<Key>], text: &str) {
    for placed in keys {
        let key = placed.value.as_ref().filter(|key| key.light.is_none());
        if let Some(sky) = key.and_then(|key| key.sky.as_ref()) {
            let place = token::field_name(text, placed.place.start, sky.place.start);
            let message =
                "expected a scene with a `sky`, which keys may change, found one without it";
            refuse::<()>(place, message);
        }
    }
}

/// Refuses a key of a light that does not exist, or lacks a channel.
fn check_light_key(
    key_start: usize,
    key: &Key,
    name: &Placed<LightName>,
    lights: &[Placed<Light>],
    text: &str,
) {
    let Some(LightName(of_key)) = &name.value else {
        return;
    };
    let known = || lights.iter().filter_map(|light| light.value.as_ref());
    let names = || known().filter_map(Light::name);
    let Some(light) = known().find(|light| light.name() == Some(of_key)) else {
        let meant = did_you_mean(of_key, names(), quoted);
        let all: Vec<String> = names().map(quoted).collect();
        let known = match all.len() {
            _ if !meant.is_empty() => String::new(),
            0 => String::from(" (no light of the scene has one)"),
            1..=LONGEST_LIST => format!(" ({})", list(&all)),
            _ => String::new(),
        };
        let found = quoted(of_key);
        let of_sky = match of_key == "sky" {
            true => "; a key without `light` changes the sky: `sky: 0.5`",
            false => "",
        };
        let message = format!("expected the name of a light{known}, found {found}{meant}{of_sky}");
        return refuse(name.place.clone(), message).unwrap_or(());
    };
    let owner = format!("light {}", quoted(of_key));
    check_channels((key_start, key.channels()), &owner, light.channels(), text);
}

/// Names of lights that a message lists.
const LONGEST_LIST: usize = 6;

/// Refuses what a key that starts somewhere names and its owner lacks.
fn check_channels(
    (key_start, named): (usize, impl IntoIterator<Item = Channel>),
    owner: &str,
    channels: &[&str],
    text: &str,
) {
    let known = || channels.iter().copied();
    for (name, value) in named {
        if let Some(value) = value
            && !channels.contains(&name)
        {
            let list = either(known());
            let meant = did_you_mean(name, known(), show);
            let place = token::field_name(text, key_start, value.start);
            refuse::<()>(
                place,
                format!("expected a channel of the {owner} ({list}), found `{name}`{meant}"),
            );
        }
    }
}

/// Reports lights with the same name, and lights that may move while the shutter is open.
pub(super) fn check_lights(file: &File) {
    let mut known = HashSet::new();
    for light in file.lights.iter().filter_map(|light| light.value.as_ref()) {
        if let Some(name) = light.placed_name()
            && let Some(LightName(text)) = &name.value
            && !known.insert(text)
        {
            let found = quoted(text);
            let message = format!("expected every name of a light once, found {found} again");
            refuse::<()>(name.place.clone(), message);
        }
    }
    let animation = file.animation.as_ref();
    let (shutter, reason) = match animation.and_then(|animation| animation.value.as_ref()) {
        Some(Animation::Keyframes { shutter, keys, .. }) => {
            let mut keys = keys.iter().filter_map(|key| key.value.as_ref());
            let reason = keys.find_map(|key| match (&key.light, &key.sky) {
                (Some(_), _) => Some("keys of lights"),
                (None, Some(_)) => Some("keys of the sky"),
                (None, None) => None,
            });
            (shutter, reason)
        }
        Some(Animation::Turntable { shutter, what, .. }) => {
            let turns_lights = what.get() == Some(Turned::Lights);
            (shutter, turns_lights.then_some("lights that turn"))
        }
        None => return,
    };
    let mut lights = file.lights.iter().filter_map(|light| light.value.as_ref());
    let is_attached = lights.any(Light::is_attached);
    let reason = reason.or(is_attached.then_some("a light that is attached to the camera"));
    if let (Some(shutter), Some(reason)) = (shutter, reason) {
        let expected = "expected lights that do not move while the shutter is open";
        refuse::<()>(shutter.place.clone(), format!("{expected}, found {reason}"));
    }
}
