//! The header of an EXR file: its channels, its colors, and the camera.

use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, Chromaticities, LineOrder, SampleType};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::prelude::{AttributeValue, Compression, SmallVec, Text, Vec2};
use glam::DVec3;
use marbles_core::{Camera, Method, Summary, View};

use crate::base::size::Size;
use crate::formats::facts::{Facts, SOFTWARE};
use crate::formats::frame_rate;

/// The attribute with the digest.
pub(super) const DIGEST_ATTRIBUTE: &str = "digest";

/// The attributes with the results: the largest error of any pixel, the number of pixels whose error is a bound, and
/// the number of pixels over the tolerance.
const ERROR_ATTRIBUTE: &str = "error";
const BOUNDED_ATTRIBUTE: &str = "bounded_pixels";
const OVER_ATTRIBUTE: &str = "over";

/// CIE xy of the primaries and the white of Rec. 709.
pub(in crate::formats) const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.3, 0.6),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.329),
};

/// The header of a file with these channels, sorted by name.
pub(super) fn header_of(size: Size, channels: Vec<(&str, SampleType)>) -> Header {
    let channel = |(name, kind)| ChannelDescription::named(name, kind);
    let size = Vec2(size.width as usize, size.height as usize);
    let shared = ImageAttributes {
        chromaticities: Some(REC_709),
        ..ImageAttributes::with_size(size)
    };
    let channels: SmallVec<[ChannelDescription; 5]> = channels.into_iter().map(channel).collect();
    Header::new(Text::default(), size, channels)
        .with_encoding(
            Compression::ZIP16,
            BlockDescription::ScanLines,
            LineOrder::Increasing,
        )
        .with_shared_attributes(shared)
        .with_attributes(LayerAttributes::default())
}

/// The name of linear light with Rec. 709 primaries, in the list of the Color Interop Forum.
const COLORS: &str = "lin_rec709_scene";

/// The attributes with the metadata of a picture.
pub(super) fn attributes(facts: &Facts) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        frames_per_second: facts.frames_per_second.and_then(frame_rate::nearest),
        world_to_camera: Some(world_to_camera(&facts.view.camera)),
        software_name: Some(Text::from(SOFTWARE)),
        ..LayerAttributes::default()
    };
    let mut custom = |name: &str, value| attributes.other.insert(Text::from(name), value);
    custom("frame", AttributeValue::I32(facts.frame));
    let colors = AttributeValue::Text(Text::from(COLORS));
    custom("colorInteropID", colors);
    let digest = Text::from(&*facts.digest.to_hex());
    custom(DIGEST_ATTRIBUTE, AttributeValue::Text(digest));
    // They are known when the blocks are.
    for name in [ERROR_ATTRIBUTE, BOUNDED_ATTRIBUTE, OVER_ATTRIBUTE] {
        custom(name, AttributeValue::F64(0.0));
    }
    match facts.method {
        // The command line keeps the number far below this limit.
        Method::Tolerance(tolerance) => custom("tolerance", AttributeValue::F32(tolerance as f32)),
        Method::Samples(samples) => custom(
            "samples",
            AttributeValue::I32(i32::try_from(samples.get()).unwrap_or(i32::MAX)),
        ),
    };
    (
        attributes.screen_window_center,
        attributes.screen_window_width,
    ) = screen_window(&facts.view);
    attributes
}

/// The names and the values of the attributes with the results. A double can hold any number of pixels.
pub(super) fn achieved(summary: &Summary) -> [(&'static str, f64); 3] {
    [
        (ERROR_ATTRIBUTE, summary.largest_error),
        (BOUNDED_ATTRIBUTE, summary.bounds as f64),
        (OVER_ATTRIBUTE, summary.over_tolerance as f64),
    ]
}

/// Combines the results of two parts of a picture.
pub(crate) fn add_achieved(one: &mut LayerAttributes, other: &LayerAttributes) {
    for name in [ERROR_ATTRIBUTE, BOUNDED_ATTRIBUTE, OVER_ATTRIBUTE] {
        let value = one.other.get_mut(name.as_bytes());
        let other = other.other.get(name.as_bytes());
        if let (Some(AttributeValue::F64(value)), Some(AttributeValue::F64(other))) = (value, other)
        {
            *value = match name {
                ERROR_ATTRIBUTE => value.max(*other),
                _ => *value + other,
            };
        }
    }
}

/// The width of a pixel over its height.
pub(super) fn pixel_aspect(view: &View) -> f32 {
    view.lens.pixel_aspect as f32
}

/// The center and the width of the screen window.
///
/// In OpenEXR's technical introduction, x points to the left. In its standard attributes, which use RenderMan's
/// coordinates, it points to the right. We follow the attributes, as in `worldToCamera`.
fn screen_window(view: &View) -> (Vec2<f32>, f32) {
    let (center, size) = view.screen_window();
    let float = |number: f64| number.clamp(f32::MIN.into(), f32::MAX.into()) as f32;
    (Vec2(float(center.x), float(center.y)), float(size.x))
}

/// The matrix M of p_camera = p_world · M, row by row: points are row vectors, as everywhere in OpenEXR.
///
/// The camera looks along +z with x to the right and y up, like ours.
fn world_to_camera(camera: &Camera) -> [f32; 16] {
    let world_from_camera = camera.world_from_camera;
    // The rows of M are the images of the world's axes: those of a rotation's transpose, which
    // are the rows of the rotation.
    let [x, y, z] = [0, 1, 2].map(|row| world_from_camera.row(row));
    let translation = -(world_from_camera.transpose() * camera.position);
    let row = |v: DVec3, w: f32| [v.x as f32, v.y as f32, v.z as f32, w];
    let rows = [row(x, 0.0), row(y, 0.0), row(z, 0.0), row(translation, 1.0)];
    let mut matrix = [0.0; 16];
    matrix.copy_from_slice(rows.as_flattened());
    // A negative zero says nothing, and two ways to write 0 would be one too many.
    matrix.map(|number| number + 0.0)
}
