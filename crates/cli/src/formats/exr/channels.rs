//! Selects the channels of a file that form its picture, and names those with its errors.

use std::collections::BTreeSet;

use exr::meta::header::Header;

/// The channels with the light of a picture.
pub(crate) struct Chosen {
    pub(crate) part: usize,
    /// The prefix of their names: empty, or `layer.`.
    pub(crate) prefix: String,
    /// The names after the prefix.
    pub(crate) colors: &'static [&'static str],
}

/// The layer with the errors of the picture of a light, in the layer of this name, or of the whole picture, whose name is
/// empty. They are not in the layer of the light: some readers take a layer of four channels for something else than a
/// color.
pub(crate) fn error_layer(layer: &str) -> String {
    match layer {
        "" => "error".to_owned(),
        _ => format!("{layer}_error"),
    }
}

/// The channel with the error of each pixel of this layer's picture: the largest difference of any of its channels from the
/// exact average, before rounding to the format. Infinite if it is unknown.
pub(super) fn error_channel(layer: &str) -> String {
    format!("{}.V", error_layer(layer))
}

/// The first part with channels `R`, `G`, `B` or `Y`; otherwise the first part with a layer that has such channels, in
/// the order of the layer names.
pub(crate) fn choose(parts: &[Header]) -> Result<Chosen, String> {
    const COLORS: [&[&str]; 2] = [&["R", "G", "B"], &["Y"]];
    let names: Vec<BTreeSet<String>> = parts
        .iter()
        .map(|part| {
            let channels = part.channels.list.iter();
            channels.map(|channel| channel.name.to_string()).collect()
        })
        .collect();
    let prefixes = |names: &BTreeSet<String>| -> BTreeSet<String> {
        let prefix = |name: &String| name.rfind('.').map(|dot| name[..=dot].to_owned());
        names.iter().filter_map(prefix).collect()
    };
    let plain = (0..parts.len()).map(|part| (part, String::new()));
    let layers = names.iter().enumerate().flat_map(|(part, names)| {
        prefixes(names)
            .into_iter()
            .map(move |prefix| (part, prefix))
    });
    for (part, prefix) in plain.chain(layers) {
        let has = |name: &&str| names[part].contains(&format!("{prefix}{name}"));
        if has(&"RY") || has(&"BY") {
            return Err("its colors are luminance and chroma, expected R, G, B or Y".to_owned());
        }
        if let Some(colors) = COLORS.into_iter().find(|colors| colors.iter().all(has)) {
            return Ok(Chosen {
                part,
                prefix,
                colors,
            });
        }
    }
    let found: Vec<&str> = names.iter().flatten().map(String::as_str).collect();
    Err(format!(
        "expected channels R, G, B or Y, found {}",
        found.join(", ")
    ))
}
