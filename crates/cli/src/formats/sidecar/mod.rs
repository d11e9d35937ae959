//! The sidecar of a picture: a JSON file with everything that measurements need.
//!
//! Its world is right-handed: the world of the scene with z negated. Its camera axes are those of OpenCV: x right, y
//! down, z forward. Pixel (0, 0) is the center of the first pixel. Numbers have up to 17 digits, as many as are needed
//! to read the same double; a number that is not finite is `null`.

mod layout;
mod stored;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use blake3::Hash;
use glam::{DMat3, DVec3};
use marbles_core::{
    Extrinsics, Intrinsics, Light as WorldLight, LightFalloff, LightPart, Method, Summary, View,
    Window, World, right_handed,
};
use marbles_scene::Scene;
use serde::Serialize;

pub(crate) use self::stored::contents;
use crate::base::numbers::degrees;
use crate::base::region::Region;

/// The contents, in the order of the file.
#[derive(Debug, Serialize)]
pub(crate) struct Sidecar<'a> {
    /// The name of the scene file, without its folder.
    scene: String,
    frame: i32,
    image: Image,
    /// The part of the whole that the picture shows; `None` if it shows all of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    region: Option<Part>,
    camera: Camera,
    lights: Vec<Light<'a>>,
    ambient: [f64; 3],
    /// `None` if there is no sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    sky: Option<Sky>,
    background: [f64; 3],
    /// The seeds of rough materials, by the names of the materials.
    seeds: BTreeMap<&'a str, u64>,
    #[serde(flatten)]
    rendered: Option<Rendered>,
    version: &'static str,
}

/// The size of the whole picture.
#[derive(Debug, Serialize)]
struct Image {
    width: u32,
    height: u32,
}

/// A part of the picture, from the pixel (`col`, `row`) on.
#[derive(Debug, Serialize)]
struct Part {
    col: u32,
    row: u32,
    width: u32,
    height: u32,
}

/// The camera: its projection, and `x_camera = R X + t`.
#[derive(Debug, Serialize)]
struct Camera {
    #[serde(flatten)]
    projection: Projection,
    /// The width of a pixel on the retina, in scene units.
    pixel_size: f64,
    /// The width of a pixel over its height, unless pixels are square.
    #[serde(skip_serializing_if = "Option::is_none")]
    pixel_aspect: Option<f64>,
    /// The factor by which the distance of the retina is multiplied, or by which the width of a parallel lens is
    /// divided. The projection includes it.
    zoom: f64,
    #[serde(rename = "R")]
    rotation: [[f64; 3]; 3],
    #[serde(rename = "t")]
    translation: [f64; 3],
    /// The viewpoint in the right-handed world.
    position: [f64; 3],
    /// The angles of an equivalent `Free` camera, in degrees.
    pan: f64,
    tilt: f64,
    roll: f64,
    axes: &'static str,
    world: &'static str,
}

#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Projection {
    Pinhole {
        #[serde(rename = "K")]
        matrix: [[f64; 3]; 3],
    },
    Parallel {
        /// The number of pixels per scene unit across the axis of view.
        pixels_per_unit: f64,
        /// The pixel that the axis of view passes through.
        principal_point: [f64; 2],
    },
}

#[derive(Debug, Serialize)]
struct Light<'a> {
    /// `null` if the light has no name.
    name: Option<&'a str>,
    #[serde(flatten)]
    place: LightPlace,
    intensity: [f64; 3],
}

/// The light of the sky: its radiance above and below a plane, and the unit vector across it in the right-handed world.
#[derive(Debug, Serialize)]
struct Sky {
    above: [f64; 3],
    below: [f64; 3],
    up: [f64; 3],
}

/// The position or direction of a light, in the right-handed world and in the axes of the camera.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum LightPlace {
    Directional {
        toward: [f64; 3],
        toward_camera: [f64; 3],
        /// The angle that its disc has across, if it has one.
        #[serde(skip_serializing_if = "Option::is_none")]
        diameter_degrees: Option<f64>,
    },
    Point {
        position: [f64; 3],
        position_camera: [f64; 3],
        falloff: &'static str,
        /// The distance at which a white surface has the radiance `intensity`.
        reference: f64,
        #[serde(flatten)]
        emission: Option<Emission>,
    },
}

/// The directions in which a lamp sends its light: the one that it faces, in the right-handed world and in the axes of the
/// camera, and the power of the cosine of the angle to it.
#[derive(Debug, Serialize)]
struct Emission {
    direction: [f64; 3],
    direction_camera: [f64; 3],
    mu: f64,
}

/// The results of rendering.
#[derive(Debug, Serialize)]
struct Rendered {
    #[serde(flatten)]
    setting: Setting,
    /// The largest claimed error of a pixel; `null` if it is unknown.
    error: Option<f64>,
    /// `bound` if all errors are bounds.
    evidence: Option<&'static str>,
    bounded_pixels: u64,
    over: u64,
    digest: String,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "lowercase")]
enum Setting {
    Tolerance(f64),
    Samples(u32),
}

/// Pan, tilt and roll of a camera in degrees; rounding errors near 0 become 0.
pub(crate) fn turns(camera: &marbles_core::Camera) -> [f64; 3] {
    const ROUNDING: f64 = 1e-12;
    camera.pan_tilt_roll().map(|angle| {
        let degrees = angle.degrees();
        if degrees.abs() < ROUNDING {
            0.0
        } else {
            degrees
        }
    })
}

/// The path of the sidecar of the picture at `path`.
pub(crate) fn beside(path: &Path) -> PathBuf {
    path.with_extension("json")
}

impl<'a> Sidecar<'a> {
    /// The properties of a view that are known before rendering; `path` is the path of the scene.
    pub(crate) fn of(scene: &'a Scene, path: &Path, frame: i32, view: &View) -> Self {
        let world = scene.world();
        let place = Extrinsics::of(&view.camera);
        let name = path.file_name().unwrap_or(path.as_os_str());
        let lights = scene.lights(view);
        let names = scene.description().lights.iter();
        let lights = lights.iter().zip(names);
        let lights = lights.map(|(light, name)| Light::of(light, name.as_deref(), &place));
        Self {
            scene: name.to_string_lossy().into_owned(),
            frame,
            image: Image {
                width: view.width,
                height: view.height,
            },
            region: None,
            camera: Camera::of(view, &place),
            lights: lights.collect(),
            ambient: numbers(world.ambient),
            sky: scene.sky(view).map(|sky| Sky {
                above: numbers(sky.above()),
                below: numbers(sky.below()),
                up: numbers(right_handed(sky.up())),
            }),
            background: numbers(world.background),
            seeds: seeds(world, &scene.description().materials),
            rendered: None,
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    /// The same for a picture of a part of the light.
    pub(crate) fn under(mut self, part: LightPart) -> Self {
        self.lights = match part {
            LightPart::Ambient | LightPart::Sky => Vec::new(),
            LightPart::Light(index) => self.lights.drain(..).skip(index).take(1).collect(),
        };
        if part != LightPart::Sky {
            self.sky = None;
        }
        if part != LightPart::Ambient {
            (self.ambient, self.background) = ([0.0; 3], [0.0; 3]);
        }
        self
    }

    /// The same with the results of a rendered part of the picture.
    pub(crate) fn with_results(
        mut self,
        region: &Region,
        method: Method,
        summary: &Summary,
        digest: &Hash,
    ) -> Self {
        let Window {
            col,
            row,
            width,
            height,
        } = region.window;
        let part = Part {
            col,
            row,
            width,
            height,
        };
        self.region = (!region.is_all()).then_some(part);
        let is_known = summary.largest_error.is_finite();
        let evidence = match summary.bounds == summary.pixels {
            true => "bound",
            false => "estimate",
        };
        self.rendered = Some(Rendered {
            setting: match method {
                Method::Tolerance(tolerance) => Setting::Tolerance(tolerance),
                Method::Samples(samples) => Setting::Samples(samples.get()),
            },
            error: is_known.then_some(summary.largest_error),
            evidence: is_known.then_some(evidence),
            bounded_pixels: summary.bounds,
            over: summary.over_tolerance,
            digest: digest.to_hex().to_string(),
        });
        self
    }

    /// The text of the file, including the end of the last line.
    pub(crate) fn text(&self) -> Result<String, String> {
        layout::text(self)
    }
}

impl Camera {
    fn of(view: &View, place: &Extrinsics) -> Self {
        let [pan, tilt, roll] = turns(&view.camera);
        Self {
            pan,
            tilt,
            roll,
            projection: Projection::of(view),
            pixel_size: view.pixel_size().x,
            pixel_aspect: Some(view.lens.pixel_aspect).filter(|aspect| *aspect != 1.0),
            zoom: view.zoom,
            rotation: rows(place.rotation),
            translation: numbers(place.translation),
            position: numbers(right_handed(view.camera.position)),
            axes: "opencv",
            world: "right-handed, z negated",
        }
    }
}

impl Projection {
    fn of(view: &View) -> Self {
        let intrinsics = Intrinsics::of(view);
        if view.lens.is_parallel() {
            Self::Parallel {
                // The pixels of a parallel lens are square.
                pixels_per_unit: view.pixels_per_unit().x,
                principal_point: intrinsics.principal_point.to_array(),
            }
        } else {
            Self::Pinhole {
                matrix: rows(intrinsics.matrix()),
            }
        }
    }
}

impl<'a> Light<'a> {
    fn of(light: &WorldLight, name: Option<&'a str>, place: &Extrinsics) -> Self {
        Self {
            name,
            place: match light {
                WorldLight::Directional(light) => LightPlace::Directional {
                    toward: numbers(right_handed(light.toward())),
                    toward_camera: numbers(place.direction(light.toward())),
                    diameter_degrees: Some(light.diameter())
                        .filter(|&diameter| diameter > 0.0)
                        .map(degrees),
                },
                WorldLight::Point(light) => LightPlace::Point {
                    position: numbers(right_handed(light.position())),
                    position_camera: numbers(place.point(light.position())),
                    falloff: match light.falloff() {
                        LightFalloff::InverseSquare => "inverse square",
                        LightFalloff::None => "none",
                    },
                    reference: light.reference(),
                    emission: light.emission().map(|emission| Emission {
                        direction: numbers(right_handed(emission.direction())),
                        direction_camera: numbers(place.direction(emission.direction())),
                        mu: emission.mu(),
                    }),
                },
            },
            intensity: numbers(light.intensity()),
        }
    }
}

/// The seeds of the rough materials of a world, with their names.
fn seeds<'a>(world: &World, names: &'a [String]) -> BTreeMap<&'a str, u64> {
    let materials = names.iter().zip(world.materials());
    let seeds = materials.filter_map(|(name, material)| {
        let roughness = material.roughness?;
        Some((name.as_str(), roughness.seed))
    });
    seeds.collect()
}

/// The rows of a matrix.
fn rows(matrix: DMat3) -> [[f64; 3]; 3] {
    let transposed = matrix.transpose();
    [transposed.x_axis, transposed.y_axis, transposed.z_axis].map(numbers)
}

fn numbers(vector: DVec3) -> [f64; 3] {
    // `+ 0` makes no negative zeros.
    (vector + DVec3::ZERO).to_array()
}

#[cfg(test)]
mod tests;
