//! Pictures that go to the standard output.

use super::args::{PerLight, RenderArguments};
use super::figures::is_inside;
use crate::base::failure::Failure;
use crate::files::standard_output;
use crate::formats::encoding::{Encoding, Format};
use crate::sequence::frames::FrameList;
use crate::sequence::pattern::Pattern;

/// Refuses what needs more than one file, or a name, if the picture goes to the standard output.
pub(super) fn check(
    arguments: &RenderArguments,
    pattern: &Pattern,
    frames: &FrameList,
    encoding: Encoding,
) -> Result<(), Failure> {
    if !pattern.is_standard_output() {
        return Ok(());
    }
    let path = standard_output::path();
    if standard_output::is_terminal() {
        let why = "the standard output is a terminal, which cannot show the bytes of a picture: send them to a file or \
                   to a program, or look at `marbles preview`";
        return Err(Failure::unusable(&path, why));
    }
    let count = frames.count();
    if count > 1 && !matches!(pattern.format(), Format::Animation(_)) {
        let why = format!(
            "{count} frames do not fit on the standard output: choose one with --frames, or a format that contains all \
             frames, such as `-o webp:-`"
        );
        return Err(Failure::unusable(&path, &why));
    }
    let drawings = [&arguments.legend, &arguments.scale_bar];
    let has_inside = drawings.into_iter().flatten().any(|path| is_inside(path));
    let is_npy = matches!(encoding, Encoding::Npy(options) if !options.archive);
    for (is_given, option) in [
        (arguments.skip_existing, "--skip-existing"),
        (arguments.sidecar, "--sidecar"),
        (
            arguments.per_light == Some(PerLight::Files),
            "--per-light=files",
        ),
        (has_inside, "`inside`"),
        (
            is_npy && arguments.error_channel,
            "--error-channel of NPY (not of NPZ)",
        ),
        (
            is_npy && !arguments.channels.is_empty(),
            "--channels of NPY (not of NPZ)",
        ),
    ] {
        if is_given {
            let why = format!("{option} needs names of files, which the standard output has not");
            return Err(Failure::unusable(&path, &why));
        }
    }
    Ok(())
}
