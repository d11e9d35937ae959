//! The layers of a file: pictures of single lights, next to the picture of all lights.

use std::collections::HashSet;

use marbles_core::{LightPart, World};

use super::parts::light_number;
use crate::formats::center_channels::CenterChannels;
use crate::formats::exr::channels::error_layer;

/// The picture of a part of a world's light, in a layer of the frame's file.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct LightLayer {
    pub(crate) light: LightPart,
    /// The name of the layer.
    pub(crate) name: String,
}

impl LightLayer {
    /// One layer for each part of a world's light. Its name is the name of the light, or else `light-` and its
    /// [`light_number`], `sky` for the sky and `ambient` for the rest. Some readers use the names as identifiers, so all of them begin
    /// with a letter. `has_errors` tells whether the errors of each light have a layer, too. Refuses names that other
    /// channels of the file have.
    pub(crate) fn each(
        world: &World,
        names: &[Option<String>],
        centers: Option<&CenterChannels>,
        has_errors: bool,
    ) -> Result<Vec<Self>, String> {
        let centers = centers.into_iter().flat_map(CenterChannels::list);
        let of_layer = centers.filter_map(|(name, _)| name.split_once('.'));
        let mut others: HashSet<String> = of_layer.map(|(layer, _)| layer.to_owned()).collect();
        others.extend(has_errors.then(|| error_layer("")));
        let mut keys = HashSet::new();
        let count = world.lights.len();
        let layer = |light| {
            let key = layer_name(light, count, names);
            if key.len() > LONGEST {
                return Err(format!(
                    "the name of a layer has at most {LONGEST} characters, but that of the light `{key}` is longer"
                ));
            }
            let of_errors = has_errors.then(|| error_layer(&key));
            for layer in [key.clone()].into_iter().chain(of_errors) {
                if others.contains(&layer) {
                    return Err(format!(
                        "a layer of the light `{key}` would have the name of the channels `{layer}`"
                    ));
                }
                if keys.contains(&layer) {
                    return Err(format!("two lights would share the layer `{layer}`"));
                }
                keys.insert(layer);
            }
            Ok(Self { light, name: key })
        };
        world.light_parts().map(layer).collect()
    }
}

/// The name of the layer of a part of the light, which has several lights, of which some may have names.
pub(crate) fn layer_name(light: LightPart, count: usize, names: &[Option<String>]) -> String {
    let index = match light {
        LightPart::Light(index) => index,
        LightPart::Sky => return "sky".to_owned(),
        LightPart::Ambient => return "ambient".to_owned(),
    };
    let name = names.get(index).and_then(Option::as_deref);
    let numbered = || format!("light-{}", light_number(index, count));
    name.map_or_else(numbered, layer_safe)
}

/// Names of channels have at most 255 bytes. This leaves room for the name of the channel within the layer.
const LONGEST: usize = 200;

/// The name of a light, with a dash for every character that is problematic in names of layers, including the period,
/// which separates layers, and with the prefix `light-` if it does not begin with a letter.
fn layer_safe(name: &str) -> String {
    let safe = |letter: char| match letter {
        '-' | '_' => letter,
        _ if letter.is_ascii_alphanumeric() => letter,
        _ => '-',
    };
    let name: String = name.chars().map(safe).collect();
    match name.starts_with(|first: char| first.is_ascii_alphabetic()) {
        true => name,
        false => format!("light-{name}"),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use marbles_core::{Light, Sky};

    use super::*;
    use crate::formats::center_channels::{AxesForm, CenterChannel, DepthForm};

    fn layers(names: [Option<&str>; 2], groups: &[CenterChannel]) -> Result<Vec<String>, String> {
        layers_with(names, groups, false)
    }

    fn layers_with(
        names: [Option<&str>; 2],
        groups: &[CenterChannel],
        has_errors: bool,
    ) -> Result<Vec<String>, String> {
        let mut world = World::new();
        for _ in 0..2 {
            world
                .lights
                .extend(Light::directional(DVec3::Y, DVec3::ONE));
        }
        let centers = CenterChannels::new(groups, DepthForm::Axis, AxesForm::World, false, 1e-3);
        let names = names.map(|name| name.map(str::to_owned));
        let layers = LightLayer::each(&world, &names, Some(&centers), has_errors)?;
        Ok(layers.into_iter().map(|layer| layer.name).collect())
    }

    #[test]
    fn layers_are_named_after_their_lights() {
        let found = layers([Some("key. warm\u{e9}"), None], &[]).unwrap();
        assert_eq!(found, ["key--warm-", "light-2", "ambient"]);
        let found = layers([Some("albedo"), None], &[CenterChannel::Depth]).unwrap();
        assert_eq!(found, ["albedo", "light-2", "ambient"]);
    }

    #[test]
    fn layers_begin_with_a_letter() {
        let found = layers([Some("2nd"), Some("\u{fc}ber_")], &[]).unwrap();
        assert_eq!(found, ["light-2nd", "light--ber_", "ambient"]);
    }

    #[test]
    fn no_two_pictures_share_a_layer() {
        let long = "a".repeat(201);
        for (names, group, why) in [
            (
                [Some("2"), None],
                CenterChannel::Id,
                "share the layer `light-2`",
            ),
            (
                [Some("a b"), Some("a-b")],
                CenterChannel::Id,
                "share the layer `a-b`",
            ),
            (
                [None, Some("ambient")],
                CenterChannel::Id,
                "share the layer `ambient`",
            ),
            (
                [Some("albedo"), None],
                CenterChannel::Albedo,
                "the name of the channels `albedo`",
            ),
            (
                [Some(&*long), None],
                CenterChannel::Id,
                "at most 200 characters",
            ),
        ] {
            let message = layers(names, &[group]).unwrap_err();
            assert!(message.contains(why), "{message}");
        }
    }

    #[test]
    fn the_sky_has_a_layer_of_its_name() {
        let mut world = World::new();
        let light = Light::directional(DVec3::Y, DVec3::ONE);
        world.lights.extend(light);
        world.sky = Some(Sky::uniform(DVec3::ONE));
        let layers = |name: &str| {
            LightLayer::each(&world, &[Some(name.to_owned())], None, false)
                .map(|layers| layers.into_iter().map(|layer| layer.name).collect())
        };
        let found: Vec<String> = layers("sun").unwrap();
        assert_eq!(found, ["sun", "sky", "ambient"]);
        let message = layers("sky").unwrap_err();
        assert_eq!(message, "two lights would share the layer `sky`");
    }

    #[test]
    fn layers_of_errors_are_the_only_ones_of_their_names() {
        for (names, why) in [
            ([Some("error"), None], "the name of the channels `error`"),
            (
                [Some("coverage"), None],
                "the name of the channels `coverage_error`",
            ),
            ([Some("a"), Some("a_error")], "share the layer `a_error`"),
            ([Some("a_error"), Some("a")], "share the layer `a_error`"),
        ] {
            assert!(layers(names, &[CenterChannel::CoverageId]).is_ok());
            let message = layers_with(names, &[CenterChannel::CoverageId], true).unwrap_err();
            assert!(message.contains(why), "{message}");
        }
    }
}
