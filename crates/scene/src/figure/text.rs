//! The text of a scene that shows a table.

use glam::DVec2;
use marbles_core::Sphere;

use super::angle;
use super::contents::Contents;
use super::view::ViewAngle;
use crate::bounds::Bounds;
use crate::motion::axes_of_orbit;

/// The width of a figure, in pixels.
const WIDTH: u32 = 1600;
/// The height of a figure whose spheres are not known.
const USUAL_HEIGHT: u32 = 1200;
/// The least and the largest height of a figure, and the number whose multiple it is.
const HEIGHTS: (u32, u32) = (640, 1800);
const HEIGHT_STEP: u32 = 20;
/// The width of outlines, as a share of the typical radius.
const OUTLINE: f64 = 0.06;
/// The width of the widest outlines, in pixels.
const WIDEST_OUTLINE: f64 = 4.0;
/// Spheres whose typical radius is smaller, in pixels, have no outlines: these would be all that is seen.
const LEAST_OUTLINED: f64 = 8.0;
/// The share of the picture that a camera fills by default.
const FILL: f64 = 0.9;
/// The color of spheres that the table gives none.
const PLAIN: &str = "#7fb2dd";

/// The most spheres that are shown in soft light, which takes longer than hard light: they take a few seconds.
const MOST_IN_SOFT_LIGHT: usize = 200;
/// The light of a figure of few spheres. White surfaces are not brighter than white.
const SOFT_LIGHT: &str = "    // Light from a sky, and from a lamp as large as a window, which moves with the camera: x is right, y up, z forward.
    ambient: 0.1, // light that nothing hides
    sky: 0.5, // little of it reaches crevices
    shadows: true, // with `false`, spheres hide no light from each other
    lights: [
        Directional(name: \"key\", toward: (-0.8, 1, -1.3), diameter: 10, attached: Camera, intensity: 0.4),
    ],
";
/// The light of other figures.
const HARD_LIGHT: &str = "    // Light from everywhere, and two lights that move with the camera: x is right, y up, z forward.
    ambient: 0.35,
    shadows: false, // `true` darkens what other spheres hide from the lights
    // sky: 0.5, // with `shadows: true` and less of other light: little of it reaches crevices; takes longer
    lights: [
        Directional(name: \"key\", toward: (-1, 1.2, -1.2), attached: Camera, intensity: 0.5),
        Directional(name: \"fill\", toward: (1, 0.3, -1), attached: Camera, intensity: 0.15),
    ],
";

/// The camera of a scene that looks from there.
pub(super) fn camera(view: ViewAngle) -> String {
    let ViewAngle { azimuth, elevation } = view;
    format!("Frame(azimuth: {azimuth}, elevation: {elevation})")
}

/// The animation of a scene in which the camera goes around once.
pub(super) fn turntable(frames: u32) -> String {
    format!("Turntable(frames: {frames})")
}

/// The text of a scene that shows a table with these contents, and calls it `name`. The number of frames in which the
/// camera goes around may be chosen, and the size in pixels.
pub(super) fn scene(
    contents: &Contents,
    name: &str,
    view: Option<ViewAngle>,
    frames: Option<u32>,
    size: Option<(u32, u32)>,
) -> String {
    let is_turntable = frames.is_some();
    let view = view.unwrap_or_else(|| angle::of(&contents.spheres, is_turntable));
    let half = half_size(&contents.spheres, view, is_turntable);
    let (width, height) = size.unwrap_or_else(|| (WIDTH, height(half)));
    let camera = camera(view);
    let animation = match frames {
        Some(frames) => format!("    animation: {},\n", turntable(frames)),
        None => {
            "    // animation: Turntable(frames: 120), // the camera goes around once\n".to_owned()
        }
    };
    let is_soft = (1..=MOST_IN_SOFT_LIGHT).contains(&contents.spheres.len()) && !is_turntable;
    let light = if is_soft { SOFT_LIGHT } else { HARD_LIGHT };
    let material = material(contents, half, (width, height));
    let cloud = cloud(contents, name);
    format!(
        "(
    image: (width: {width}, height: {height}),
    lens: Fov(30), // degrees; `Parallel(width: 1)` shows far spheres as large as near ones
    camera: {camera}, // degrees; everything is in the picture
    background: 1, // white; `marbles render --transparent` leaves it out

{light}    materials: {{
        {material}
    }},
    clouds: [(
{cloud}    )],
{animation})
"
    )
}

/// The fields of the cloud, one in a line.
fn cloud(contents: &Contents, name: &str) -> String {
    let mut text = format!("        file: {name:?},\n        material: \"particles\",\n");
    let mut line = |field: &str| text += &format!("        {field}\n");
    if contents.is_trajectory {
        line(
            "// topology: \"atoms.gro\", // a table of the same atoms, which tells their elements",
        );
    }
    if let Some(columns) = contents.columns {
        line(&format!(
            "columns: ({columns}), // the names of the columns do not tell them"
        ));
    }
    if let Some(radius) = contents.radius {
        let radius = rounded(radius);
        line(&format!(
            "radius: {radius}, // the table has no radii: nearly half of the usual distance to a neighbor"
        ));
    }
    if let Some(colors) = &contents.colors {
        let fields = colors.fields.join(", ");
        line(&format!("{fields}, // {}", colors.comment));
    }
    if contents.is_crystal {
        line("radii: Covalent, // `VanDerWaals` fills the space between the atoms");
        line("edges: true, // atoms on a face of the cell are shown on the opposite one, too");
    }
    if contents.has_cell {
        line("// repeat: (2, 2, 2), // shows so many cells along each edge");
    }
    if contents.has_z_up {
        line("up: Z, // z of the table points up");
    }
    if !contents.is_right_handed && !contents.spheres.is_empty() {
        line("// right_handed: true, // if the table has right-handed axes, as most programs have");
    }
    if contents.has_more {
        line("// frames: All, // shows all frames of the file, one after another");
    }
    text
}

/// The material of all spheres, with outlines if the spheres are large enough in a picture of this size.
fn material(contents: &Contents, half: Option<DVec2>, (width, height): (u32, u32)) -> String {
    let radius = contents.typical_radius().unwrap_or(0.0);
    let pixels = half.map_or(0.0, |half| {
        let of_side = |side: u32, half: f64| 0.5 * FILL * f64::from(side) / half;
        radius * of_side(width, half.x).min(of_side(height, half.y))
    });
    let is_colored = contents.is_colored || contents.colors.is_some();
    let mut fields = Vec::new();
    if !is_colored {
        fields.push(format!("albedo: \"{PLAIN}\""));
    }
    if pixels >= LEAST_OUTLINED {
        let line = rounded(radius * OUTLINE.min(WIDEST_OUTLINE / pixels));
        fields.push(format!("outline: (width: Units({line}), color: 0.02)"));
    }
    let fields = fields.join(", ");
    format!("\"particles\": ({fields}),")
}

/// The height of a picture around a figure of this half width and height.
fn height(half: Option<DVec2>) -> u32 {
    let Some(half) = half else {
        return USUAL_HEIGHT;
    };
    let height = libm::round(f64::from(WIDTH / HEIGHT_STEP) * half.y / half.x);
    // A number that is too large, or none, becomes one of the ends.
    let steps = height.clamp(0.0, f64::from(HEIGHTS.1)) as u32;
    (steps * HEIGHT_STEP).clamp(HEIGHTS.0, HEIGHTS.1)
}

/// Half of the width and the height of what a camera sees that looks at the middle of the spheres; on a turntable
/// from all sides. `None` if nothing is known.
fn half_size(spheres: &[Sphere], view: ViewAngle, is_turntable: bool) -> Option<DVec2> {
    let middle = Bounds::of(spheres).middle()?;
    let axes = axes_of_orbit([view.azimuth, view.elevation, 0.0]);
    let elevation = view.elevation.to_radians();
    let (sine, cosine) = (libm::sin(elevation).abs(), libm::cos(elevation).abs());
    let reach = |sphere: &Sphere| {
        let from_middle = sphere.center() - middle;
        let of_center = if is_turntable {
            let around = (from_middle.x * from_middle.x + from_middle.z * from_middle.z).sqrt();
            DVec2::new(around, from_middle.y.abs() * cosine + around * sine)
        } else {
            DVec2::new(
                from_middle.dot(axes.x_axis).abs(),
                from_middle.dot(axes.y_axis).abs(),
            )
        };
        of_center + sphere.radius()
    };
    let half = spheres.iter().map(reach).fold(DVec2::ZERO, DVec2::max);
    (half.is_finite() && half.x > 0.0).then_some(half)
}

/// A number with three digits, as a scene file writes it.
fn rounded(number: f64) -> String {
    let short = format!("{number:.2e}");
    match short.parse::<f64>() {
        Ok(value) if (1e-4..1e6).contains(&value) => value.to_string(),
        _ => short,
    }
}
