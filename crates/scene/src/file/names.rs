//! The names of the structures in messages.

use serde::{Deserialize, Deserializer};

use super::camera::{Animation, Axes, Camera, Ease, FrameOver, Key, Turned};
use super::{
    Attached, Cloud, ColorScale, Columns, End, Falloff, File, Grain, Highlight, Image, Keep, Lens,
    Light, Material, Others, Outline, Palette, RadiusLaw, Rough, Sphere, TakenFrames, Test, Up,
};
use crate::table::{Coloring, Colormap, Radii};
use crate::text::{Names, Read, Slice, note_failure, read_file, read_structure};

/// Gives structures the names that messages call them by.
macro_rules! structures {
    ($($type:ident: $noun:literal, $form:literal;)*) => {$(
        impl<'t> Read<'t> for $type {
            fn read(slice: Slice<'t>) -> Option<Self> {
                read_structure(slice, Names { noun: $noun, form: $form })
            }

            fn read_strictly<D: Deserializer<'t>>(deserializer: D) -> Result<Option<Self>, D::Error> {
                Self::deserialize(deserializer)
                    .inspect_err(|_| note_failure(Names { noun: $noun, form: $form }))
                    .map(Some)
            }
        }
    )*};
}

structures! {
    Image: "image", "an image `(width: …, height: …)`";
    Lens: "lens", "a lens: `Retina(width: …, distance: …)`, `Fov(…)`, `Matrix(fx: …, fy: …, cx: …, cy: …)` or `Parallel(width: …)`";
    Camera: "camera", "a camera: `Free(…)`, `LookAt(…)`, `Orbit(…)`, `Frame(…)` or `Pose(…)`";
    Axes: "axes", "axes: `OpenCV`";
    Light: "light", "a light: `Directional(toward: …)` or `Point(position: …)`";
    Falloff: "falloff", "a falloff: `InverseSquare` or `None`";
    Attached: "place of a light", "the place that a light is attached to: `Camera`";
    Material: "material", "a material `(albedo: …)`";
    Highlight: "highlight", "a highlight `(strength: …, shininess: …)`";
    Rough: "rough surface", "a rough surface `(amplitude: …, grain: …, seed: …)`";
    Grain: "grain", "a grain: `Surface(…)` or `Pixel`";
    Outline: "outline", "an outline `(width: …, color: …)`";
    Sphere: "sphere", "a sphere `(center: …, radius: …)`";
    Cloud: "cloud", "a cloud `(file: …)`";
    Radii: "kind of radii", "a kind of radii: `VanDerWaals`, `Covalent`, or `{\"…\": …}` of elements by name";
    Coloring: "coloring", "a coloring: `Material`, `Table`, `Element`, `Value` or `Category`";
    Colormap: "colormap", "a colormap: `Viridis`, `Inferno`, `Magma`, `Plasma`, `Cividis`, `CoolWarm` or `Grey`";
    RadiusLaw: "law of radii", "a law of radii: `Linear`, `Power(…)` or `Exponential(…)`";
    ColorScale: "color scale", "a color scale: `Linear`, `Log` or `Diverging(…)`";
    Palette: "palette", "a palette `{\"…\": …}` of colors by name";
    Others: "choice for others", "the radius and the color of other elements `(radius: …, color: …)`";
    Columns: "choice of columns", "columns `(x: …, y: …, z: …)`";
    Keep: "condition", "a condition `(column, Is(…))`, with `Is`, `Between` or `Every`";
    Test: "condition", "a condition: `Is(…)`, `Between(…, …)` or `Every(…)`";
    TakenFrames: "choice of frames", "a choice of frames: `First` or `All`";
    Up: "axis", "an axis that points up: `X`, `Y` or `Z`";
    End: "end", "an end: `Hold`, `Loop` or `Hide`";
    FrameOver: "framed part", "the framed part: `Series` or `Step`";
    Animation: "animation", "an animation: `Keyframes(…)` or `Turntable(…)`";
    Turned: "moving part of a turntable", "the moving part of a turntable: `Camera` or `Lights`";
    Key: "key", "a key `(frame: …)`";
    Ease: "ease", "an ease: `Smooth`, `Linear` or `Hold`";
}

impl<'t> Read<'t> for File {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let form = "a scene `(image: …, lens: …, camera: …)`";
        let noun = "scene";
        read_file(slice, Names { noun, form })
    }
}
