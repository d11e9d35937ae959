//! Tips about options that do not exist: what to write instead.

use clap::Command;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// What somebody looks for, by other names of options, and what to write. Settings of a scene come after `--set`.
const TIPS: [(&[&str], &str); 13] = [
    (
        &["background", "bg", "bgcolor", "background-color"],
        "`--white`, `--transparent` or `--set background=0.5` of `marbles render`",
    ),
    (
        &["width", "height", "resolution", "res", "w", "h", "dpi"],
        "`--size 1200x900`",
    ),
    (
        &[
            "camera",
            "angle",
            "azimuth",
            "elevation",
            "direction",
            "rotate",
        ],
        "`--view top` or `--view 30,15`: azimuth and elevation in degrees",
    ),
    (&["zoom", "scale"], "`--set zoom=2`"),
    (&["fov"], "`--set 'lens=Fov(30)'`"),
    (&["ambient"], "`--set ambient=0.3`"),
    (
        &["shadow", "shadows", "no-shadows"],
        "`--set shadows=true` or `--set shadows=false`",
    ),
    (&["light", "lights"], "`--set 'lights[0].intensity=2'`"),
    (
        &["radius", "radii", "size-by"],
        "`--set 'clouds[0].radius=1.5'`",
    ),
    (
        &["color", "colour", "color-by", "colormap", "cmap", "value"],
        "`--set 'clouds[0].value=\"mass\"'` or `--set 'clouds[0].colormap=Inferno'`",
    ),
    (
        &[
            "gif",
            "webp",
            "apng",
            "animate",
            "animation",
            "format",
            "png",
        ],
        "`-o NAME.gif`, `-o NAME.webp` or `-o NAME.png`: the extension chooses the format",
    ),
    (
        &["mp4", "video", "movie", "film"],
        "`-o 'frames/####.png'`, and join the frames with FFmpeg",
    ),
    (&["frame"], "`--frames 7`"),
];

/// The same error, with a tip of what to write if it is about an option that does not exist. `name` is that of the
/// subcommand.
pub(super) fn with_tip(mut error: clap::Error, command: &Command, name: &str) -> clap::Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let unknown = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(text)) => text.trim_start_matches('-').to_owned(),
        _ => return error,
    };
    let unknown = unknown.split('=').next().unwrap_or_default();
    let Some(tip) = tip(command, name, unknown) else {
        return error;
    };
    for kind in [ContextKind::SuggestedArg, ContextKind::TrailingArg] {
        error.remove(kind);
    }
    error.insert(
        ContextKind::Suggested,
        ContextValue::StyledStrs(vec![tip.into()]),
    );
    error
}

fn tip(command: &Command, name: &str, unknown: &str) -> Option<String> {
    let tip = TIPS.iter().find(|(names, _)| names.contains(&unknown));
    if let Some((_, write)) = tip {
        return Some(format!("write {write}"));
    }
    // `render` has the most options.
    let others = ["render", "new", "check", "preview"].into_iter();
    let owner = others
        .filter(|other| *other != name)
        .find(|other| has_option(command, other, unknown))?;
    Some(format!("`--{unknown}` is an option of `marbles {owner}`"))
}

fn has_option(command: &Command, name: &str, option: &str) -> bool {
    let Some(command) = command.find_subcommand(name) else {
        return false;
    };
    let mut arguments = command.get_arguments();
    arguments.any(|argument| {
        let names = argument.get_long_and_visible_aliases().unwrap_or_default();
        names.contains(&option)
    })
}
