//! Scenes that combine several features, according to the rows of a covering array of strength three.

use glam::DVec3;

use super::draft::{Draft, OPEN, SIDE};
use super::extremes::power_of_ten;
use super::pose::Pose;
use marbles_tests::features::{Feature, Row, row};
use marbles_tests::numbers::Numbers;

/// The distance of far things, in units of the scene. Near things are closer by the factor by which the viewpoint is
/// near the surface.
const FAR: f64 = 100.0;

/// Columns and rows of pictures with bumps, of pictures with an open shutter, and of those with both, whose pixels take
/// minutes to judge: more scenes find more than more pixels of a scene.
const SIDE_OF_BUMPS: u32 = 6;
const SIDE_OVER_TIME: u32 = 5;
const SIDE_OF_BUMPS_OVER_TIME: u32 = 3;

/// A random scene for a row.
pub(super) fn together(numbers: &mut Numbers, index: u64) -> Draft {
    let row = row(index);
    let lens = Sight::of(&row, numbers);
    let mut draft = Draft::empty();
    draft.head = vec![
        format!("image: (width: {0}, height: {0})", lens.side),
        lens.text(),
        lens.pose.camera(),
        format!(
            "background: {}",
            numbers.either(&["0", "0.3", "(0.1, 0.2, 0.5)"])
        ),
        format!("ambient: {}", numbers.either(&["0", "0.1"])),
        format!("shadows: {}", row.has(Feature::Shadows, "yes")),
    ];
    draft.kind = row.to_string();
    draft.pixel = lens.pixel(FAR);
    add_spheres(&mut draft, &row, &lens, numbers);
    add_lights(&mut draft, &row, &lens, numbers);
    draft.material = material(&row, draft.pixel, numbers);
    if row.has(Feature::Shutter, "open") {
        draft.head.push(animation(&lens, numbers));
    }
    draft.alpha = row.has(Feature::Alpha, "yes");
    draft.per_light = row.has(Feature::PerLight, "yes");
    draft.light = match row.value(Feature::Brightness) {
        "dim" => power_of_ten(numbers, -6.0, -1.0),
        "bright" => power_of_ten(numbers, 1.0, 6.0),
        _ => 1.0,
    };
    let exponent = numbers.below(31) as i32 + 10;
    draft.length = match row.value(Feature::Length) {
        "small" => libm::scalbn(1.0, -exponent),
        "large" => libm::scalbn(1.0, exponent),
        _ => 1.0,
    };
    draft
}

/// The lens and the camera of a scene.
struct Sight {
    pose: Pose,
    /// Columns and rows.
    side: u32,
    /// The distance of the retina, in pixels; `None` for a parallel lens.
    distance: Option<f64>,
    /// The shift, in pixels.
    shift: [f64; 2],
    /// The size of a pixel of a parallel lens.
    size: f64,
    /// The factor on all distances, compared with other scenes.
    near: f64,
    /// The distance and the radius of the surface near the viewpoint.
    wall: Option<[f64; 2]>,
}

impl Sight {
    fn of(row: &Row<'_>, numbers: &mut Numbers) -> Self {
        let radius = power_of_ten(numbers, 0.0, 4.0);
        let height = radius * power_of_ten(numbers, -9.0, -1.0);
        let wall = row.has(Feature::Eye, "near").then_some([height, radius]);
        let near = wall.map_or(1.0, |_| 10.0 * height / FAR);
        let ordinary = 50.0 * numbers.between(0.5, 2.0);
        let is_smooth = row.has(Feature::Surface, "smooth");
        let side = match (row.has(Feature::Shutter, "open"), is_smooth) {
            (true, true) => SIDE_OVER_TIME,
            (true, false) => SIDE_OF_BUMPS_OVER_TIME,
            (false, true) => SIDE,
            (false, false) => SIDE_OF_BUMPS,
        };
        let half_angle = numbers.between(60.0, 87.5_f64).to_radians();
        let wide = 0.5 * f64::from(side) / libm::tan(half_angle);
        let shift = [(); 2].map(|()| numbers.between(-40.0, 40.0));
        Self {
            side,
            pose: Pose::random(numbers, if wall.is_some() { radius } else { 50.0 }),
            distance: match row.value(Feature::Lens) {
                "parallel" => None,
                "wide" => Some(wide),
                _ => Some(ordinary),
            },
            shift: match row.value(Feature::Lens) {
                "shifted" => shift,
                _ => [0.0; 2],
            },
            size: near * numbers.between(1.0, 3.0),
            near,
            wall,
        }
    }

    fn text(&self) -> String {
        let [x, y] = self.shift;
        match self.distance {
            Some(distance) => {
                format!(
                    "lens: Retina(width: {}, distance: {distance}, shift: ({x}, {y}))",
                    self.side
                )
            }
            None => format!(
                "lens: Parallel(width: {})",
                f64::from(self.side) * self.size
            ),
        }
    }

    /// The size of a pixel at a depth in the axes of the camera.
    fn pixel(&self, depth: f64) -> f64 {
        match self.distance {
            Some(distance) => depth * self.near / distance,
            None => self.size,
        }
    }

    /// A point of the picture at a depth, in the axes of the camera.
    fn place(&self, depth: f64, numbers: &mut Numbers) -> DVec3 {
        let half = 0.45 * f64::from(self.side);
        let pixel = self.pixel(depth);
        let [x, y] = self
            .shift
            .map(|shift| (shift + numbers.between(-half, half)) * pixel);
        DVec3::new(x, y, depth * self.near)
    }
}

fn add_spheres(draft: &mut Draft, row: &Row<'_>, sight: &Sight, numbers: &mut Numbers) {
    let Sight { pose, near, .. } = sight;
    let down = DVec3::new(numbers.between(-0.5, 0.5), -1.0, numbers.between(-0.2, 0.6)).normalize();
    for _ in 0..numbers.below(5) + 2 {
        let depth = FAR * numbers.between(0.6, 1.4);
        let mut center = sight.place(depth, numbers);
        let size = numbers.between(1.0, 9.0) * sight.pixel(depth);
        if let (Some([height, _]), 0) = (sight.wall, numbers.below(2)) {
            // On the surface, or cut by it.
            let raised = numbers.between(-0.9, 1.0) * size;
            center += down * (height - raised - center.dot(down));
        }
        draft.sphere(pose.place(center), size);
    }
    if let Some([height, radius]) = sight.wall {
        draft.sphere(pose.place(down * (radius + height)), radius);
    }
    if row.has(Feature::Eye, "inside") {
        let ahead = FAR * numbers.between(0.0, 1.0) * near;
        draft.sphere(
            pose.place(DVec3::Z * ahead),
            FAR * numbers.between(2.5, 4.0) * near,
        );
    }
    if row.has(Feature::Floor, "yes") {
        let radius = power_of_ten(numbers, 3.0, 9.0) * near;
        let below = numbers.between(5.0, 30.0) * near;
        draft.sphere(
            pose.place(DVec3::new(0.0, -radius - below, FAR * near)),
            radius,
        );
    }
}

fn add_lights(draft: &mut Draft, row: &Row<'_>, sight: &Sight, numbers: &mut Numbers) {
    let Sight { pose, near, .. } = sight;
    let far = FAR * near;
    for _ in 0..numbers.below(2) + 1 {
        let toward = DVec3::from_array(numbers.direction()) - DVec3::Z * numbers.between(0.0, 1.0);
        let beside = DVec3::Z * far + toward * (0.8 * far);
        let intensity = numbers.between(0.2, 0.7);
        match row.value(Feature::Light) {
            "lamp with falloff" => draft.point_light(pose.place(beside), intensity, Some(far)),
            "lamp without" => draft.point_light(pose.place(beside), intensity, None),
            "lamp near balls" => {
                let depth = FAR * numbers.between(0.6, 1.4);
                let place = sight.place(depth, numbers);
                let reference = numbers.either(&[None, Some(0.1 * far), Some(0.3 * far)]);
                draft.point_light(pose.place(place), intensity, reference);
            }
            "attached" => {
                let is_sun = numbers.below(2) == 0;
                let DVec3 { x, y, z } = toward * if is_sun { 1.0 } else { 0.3 * far };
                draft.lights.push(match is_sun {
                    true => format!(
                        "Directional(toward: ({x}, {y}, {z}), intensity: {intensity}, attached: Camera)"
                    ),
                    false => format!(
                        "Point(position: ({x}, {y}, {z}), intensity: {intensity}, reference: {far}, \
                         attached: Camera)"
                    ),
                });
            }
            _ => draft.light(pose.direction(toward).to_array(), intensity),
        }
    }
}

fn material(row: &Row<'_>, pixel: f64, numbers: &mut Numbers) -> String {
    let exponent = match row.value(Feature::Exponent) {
        "below 1" => numbers.between(0.2, 0.9),
        "above 1" => numbers.between(1.2, 8.0),
        _ => 1.0,
    };
    let mut text = format!("albedo: (0.9, 0.6, 0.3), exponent: {exponent}");
    let shininess = match row.value(Feature::Highlight) {
        "wide" => Some(power_of_ten(numbers, 0.0, 1.0)),
        "narrow" => Some(power_of_ten(numbers, 1.5, 4.0)),
        _ => None,
    };
    if let Some(shininess) = shininess {
        let strength = numbers.either(&[0.5, 2.0]);
        text += &format!(", highlight: (strength: {strength}, shininess: {shininess})");
    }
    let size = match row.value(Feature::Surface) {
        "bumps coarse" => Some(power_of_ten(numbers, 0.7, 1.7)),
        "bumps like pixels" => Some(power_of_ten(numbers, -0.2, 0.5)),
        "bumps fine" => Some(power_of_ten(numbers, -1.5, -0.4)),
        _ => None,
    };
    let grain = match size {
        Some(size) => Some(format!("Surface({})", size * pixel)),
        None => row
            .has(Feature::Surface, "grain")
            .then(|| "Pixel".to_owned()),
    };
    if let Some(grain) = grain {
        let amplitude = numbers.between(0.1, 0.9);
        text += &format!(", rough: (amplitude: {amplitude}, grain: {grain}, seed: 7)");
    }
    if row.has(Feature::Outline, "yes") {
        let width = power_of_ten(numbers, -1.5, 0.7) * pixel;
        text += &format!(", outline: (width: Units({width}), color: (1, 0.2, 0.1))");
    }
    text
}

/// A camera that moves by a tenth of a pixel to some pixels while the shutter is open.
fn animation(sight: &Sight, numbers: &mut Numbers) -> String {
    let Sight { pose, near, .. } = sight;
    let DVec3 { x, y, z } = pose.position;
    let [pan, tilt, roll] = pose.angles;
    let way = power_of_ten(numbers, -1.0, 0.7) * sight.pixel(FAR);
    // Near a surface the camera keeps away from it.
    let way = if sight.wall.is_some() { 0.1 * way } else { way };
    let [to_x, to_y, to_z] = pose.place(DVec3::from_array(numbers.direction()) * way);
    let turn = way / (FAR * near) * 60.0;
    let key = match numbers.below(3) {
        0 => format!("position: ({to_x}, {to_y}, {to_z})"),
        1 => format!("pan: {}, roll: {}", pan + turn, roll + turn),
        _ => format!(
            "position: ({to_x}, {to_y}, {to_z}), tilt: {}, zoom: 1.02",
            tilt + turn
        ),
    };
    format!(
        "animation: Keyframes({OPEN}, keys: [(frame: 1, position: ({x}, {y}, {z}), pan: {pan}, tilt: {tilt}, \
         roll: {roll}, zoom: 1, ease: Linear), (frame: 3, {key})])"
    )
}
