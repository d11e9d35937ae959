//! The options of a picture's format.

use super::args::{PerLight, RenderArguments};
use crate::base::failure::Failure;
use crate::formats::encoding::{
    AnimationFormat, Encoding, ExrOptions, Format, NpyOptions, PngOptions, TiffOptions,
};

/// The options of the format. Refuses options of other formats.
pub(crate) fn encoding(arguments: &RenderArguments, format: Format) -> Result<Encoding, Failure> {
    let output = match format {
        Format::Png | Format::Animation(AnimationFormat::Apng) => "PNG",
        Format::Animation(AnimationFormat::Gif) => "GIF",
        Format::Animation(AnimationFormat::Webp) => "WebP",
        Format::Exr => "EXR",
        Format::Npy => "NPY",
        Format::Npz => "NPZ",
        Format::Tiff => "TIFF",
    };
    for (is_given, option, formats) in [
        (arguments.bits.is_some(), "--bits", &["PNG"][..]),
        (arguments.rgb, "--rgb", &["PNG", "TIFF"]),
        (arguments.linear, "--linear", &["PNG"]),
        (
            arguments.exposure.is_some(),
            "--exposure",
            &["PNG", "TIFF", "GIF", "WebP"],
        ),
        (arguments.float, "--float", &["EXR", "TIFF"]),
        (arguments.half, "--half", &["EXR"]),
        (
            arguments.error_channel,
            "--error-channel",
            &["EXR", "NPY", "NPZ"],
        ),
        (
            !arguments.channels.is_empty(),
            "--channels",
            &["EXR", "NPY", "NPZ"],
        ),
        (
            arguments.per_light == Some(PerLight::Layers),
            "--per-light=layers",
            &["EXR"],
        ),
    ] {
        if is_given && !formats.contains(&output) {
            let formats = match formats {
                [others @ .., last] if !others.is_empty() => {
                    format!("{} and {last}", others.join(", "))
                }
                _ => formats.concat(),
            };
            let message = format!("{option} is for {formats} files, but the output is {output}");
            return Err(Failure::Usage(message));
        }
    }
    if arguments.exposure.is_some() && arguments.float {
        let message = "--exposure is for codes, but --float writes the light itself";
        return Err(Failure::Usage(message.to_owned()));
    }
    if arguments.linear && arguments.bits == Some(8) {
        let message = "--linear writes 16 bits, but --bits asks for 8";
        return Err(Failure::Usage(message.to_owned()));
    }
    for (is_given, option) in [
        (arguments.skip_existing, "--skip-existing"),
        (arguments.sidecar, "--sidecar"),
        (arguments.per_light.is_some(), "--per-light"),
    ] {
        if is_given && matches!(format, Format::Animation(_)) {
            let message =
                format!("{option} needs one file per frame, but this output contains all frames");
            return Err(Failure::Usage(message));
        }
    }
    let gain = libm::exp2(arguments.exposure.unwrap_or(0.0));
    let png = PngOptions {
        deep: arguments.bits == Some(16),
        rgb: arguments.rgb,
        linear: arguments.linear,
        gain,
    };
    Ok(match format {
        Format::Png => Encoding::Png(png),
        Format::Animation(format) => Encoding::Animation(format, png),
        Format::Exr => Encoding::Exr(ExrOptions {
            // Many readers convert all channels to the type of the first.
            float: arguments.float || !arguments.channels.is_empty() && !arguments.half,
            error: arguments.error_channel,
        }),
        Format::Npy | Format::Npz => Encoding::Npy(NpyOptions {
            error: arguments.error_channel,
            archive: format == Format::Npz,
            evidence: false,
        }),
        Format::Tiff => Encoding::Tiff(TiffOptions {
            float: arguments.float,
            rgb: arguments.rgb,
            gain,
        }),
    })
}
