//! The digest of everything that a picture depends on: two files with the same digest show the same picture.
//!
//! It covers the input of the renderer: the meaning of a scene and its tables, but not their wording or their paths. It
//! does not depend on threads or on the time.

use blake3::{Hash, Hasher};
use glam::{DMat3, DVec2, DVec3};
use marbles_core::{
    Camera, Exposure, Grain, Highlight, Lens, Light, LightFalloff, Material, Method, Outline,
    OutlineWidth, Pose, Roughness, Settings, Sky, View, World, parallel,
};

use crate::formats::center_channels::{CenterChannels, name_of};
use crate::formats::encoding::{Encoding, ExrOptions, NpyOptions, PngOptions, TiffOptions};

/// The context of the hash. It must change whenever the hashed data changes its meaning, or the same scene makes
/// different pictures.
const PURPOSE: &str = "marbles 2026-11-25.1 digest of a picture";

/// The number of spheres that are hashed at a time. The digest depends on it.
const SPHERES: usize = 1 << 14;

/// The digest of the worlds and the settings that a sequence's pictures share, whatever their format.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    shared: Feed,
}

/// The digests of a sequence's pictures.
#[derive(Clone, Debug)]
pub(crate) struct Digests {
    /// The digest of what all pictures share.
    shared: Feed,
}

/// The part of a picture's input that differs within a sequence, in contrast to the world, the settings and the format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shot<'a> {
    /// Its view, and the motion of the camera while the shutter is open.
    pub(crate) exposure: &'a Exposure<'a>,
    /// The frame number for the user, which may be beyond the full turn of the view's number.
    pub(crate) frame: i32,
    pub(crate) frames_per_second: Option<f64>,
}

impl Input {
    /// The input of the pictures of a world whose spheres have these hashes.
    pub(super) fn new(world: &World, spheres: &[Hash], settings: &Settings) -> Self {
        let mut shared = Feed(Hasher::new_derive_key(PURPOSE));
        shared.world(world, spheres);
        shared.settings(settings);
        Self { shared }
    }

    /// The digests of the pictures in this format.
    pub(crate) fn digests(&self, encoding: Encoding, centers: Option<&CenterChannels>) -> Digests {
        let mut shared = self.shared.clone();
        shared.encoding(encoding);
        // Files without them have the digests that they had before there were any.
        if let Some(centers) = centers {
            shared.centers(centers);
        }
        Digests { shared }
    }
}

impl Digests {
    /// The same for lights with names, which are part of sidecars. Without names, nothing changes.
    pub(crate) fn with_names(mut self, names: &[Option<String>]) -> Self {
        if names.iter().any(Option::is_some) {
            for name in names {
                self.shared.maybe(name.as_ref(), |feed, name| {
                    feed.count(name.len());
                    feed.0.update(name.as_bytes());
                });
            }
        }
        self
    }

    /// The same for files with additional layers. Without layers, nothing changes.
    pub(super) fn with_layers(mut self, names: &[String]) -> Self {
        if !names.is_empty() {
            self.shared.count(names.len());
            for name in names {
                self.shared.count(name.len());
                self.shared.0.update(name.as_bytes());
            }
        }
        self
    }

    /// The digest of one picture.
    pub(crate) fn of(&self, shot: &Shot<'_>) -> Hash {
        let Shot {
            exposure,
            frame,
            frames_per_second,
        } = *shot;
        let mut feed = self.shared.clone();
        feed.view(exposure.view());
        feed.integer(i64::from(frame));
        feed.maybe(frames_per_second, Feed::number);
        // None where the shutter is open for a moment only.
        for Pose { camera, zoom } in exposure.poses() {
            feed.camera(&camera);
            feed.number(zoom);
        }
        // None where the world's are those of all frames.
        if let Some(lights) = exposure.lights() {
            lights.iter().for_each(|light| feed.light(light));
        }
        if let Some(sky) = exposure.sky() {
            feed.sky(&sky);
        }
        feed.0.finalize()
    }
}

/// A hasher for numbers.
///
/// Structures are destructured field by field, so that the compiler reports a new field that is missing here.
#[derive(Clone, Debug)]
struct Feed(Hasher);

impl Feed {
    fn number(&mut self, number: f64) {
        self.0.update(&number.to_le_bytes());
    }

    fn integer(&mut self, number: impl Into<i64>) {
        self.0.update(&number.into().to_le_bytes());
    }

    fn count(&mut self, count: usize) {
        self.0.update(&(count as u64).to_le_bytes());
    }

    fn vector(&mut self, vector: DVec3) {
        for number in vector.to_array() {
            self.number(number);
        }
    }

    /// An optional value.
    fn maybe<T>(&mut self, value: Option<T>, feed: impl FnOnce(&mut Self, T)) {
        self.integer(value.is_some());
        if let Some(value) = value {
            feed(self, value);
        }
    }

    fn world(&mut self, world: &World, spheres: &[Hash]) {
        self.vector(world.ambient);
        self.vector(world.background);
        // Worlds without a sky have the digests that they had before there were any.
        if let Some(sky) = world.sky {
            self.sky(&sky);
        }
        self.integer(world.shadows);
        self.count(world.lights.len());
        world.lights.iter().for_each(|light| self.light(light));
        self.count(world.materials().len());
        let materials = world.materials().iter();
        materials.for_each(|material| self.material(material));
        self.count(world.spheres().len());
        for hash in spheres {
            self.0.update(hash.as_bytes());
        }
    }

    fn sky(&mut self, sky: &Sky) {
        self.0.update(b"sky");
        for vector in [sky.above(), sky.below(), sky.up()] {
            self.vector(vector);
        }
    }

    fn light(&mut self, light: &Light) {
        match light {
            Light::Directional(light) => {
                self.vector(light.toward());
                self.vector(light.intensity());
                if light.diameter() > 0.0 {
                    self.0.update(b"diameter");
                    self.number(light.diameter());
                }
            }
            Light::Point(light) => {
                self.0.update(b"point light");
                self.vector(light.position());
                self.vector(light.intensity());
                self.integer(light.falloff() == LightFalloff::None);
                self.number(light.reference());
                if let Some(emission) = light.emission() {
                    self.0.update(b"emission");
                    self.vector(emission.direction());
                    self.number(emission.mu());
                }
            }
        }
    }

    fn material(&mut self, material: &Material) {
        let Material {
            albedo,
            exponent,
            highlight,
            roughness,
            outline,
        } = *material;
        self.vector(albedo);
        self.number(exponent);
        self.maybe(highlight, |feed, highlight| {
            let Highlight {
                strength,
                shininess,
            } = highlight;
            feed.number(strength);
            feed.number(shininess);
        });
        self.maybe(roughness, |feed, roughness| {
            let Roughness {
                amplitude,
                grain,
                seed,
            } = roughness;
            feed.number(amplitude);
            let size = match grain {
                Grain::Surface(size) => Some(size),
                Grain::Pixel => None,
            };
            feed.maybe(size, Self::number);
            feed.0.update(&seed.to_le_bytes());
        });
        self.maybe(outline, |feed, Outline { width, color }| {
            let (kind, width) = match width {
                OutlineWidth::Pixels(width) => (0, width),
                OutlineWidth::Units(width) => (1, width),
            };
            feed.integer(kind);
            feed.number(width);
            feed.vector(color);
        });
    }

    fn settings(&mut self, settings: &Settings) {
        let Settings { method, alpha } = *settings;
        self.integer(alpha);
        match method {
            Method::Samples(samples) => {
                self.integer(0);
                self.integer(samples.get());
            }
            Method::Tolerance(tolerance) => {
                self.integer(1);
                self.number(tolerance);
            }
        }
    }

    fn encoding(&mut self, encoding: Encoding) {
        match encoding {
            // An animated one keeps no digest.
            Encoding::Png(options) | Encoding::Animation(_, options) => {
                let PngOptions {
                    deep,
                    rgb,
                    linear,
                    gain,
                } = options;
                self.integer(0);
                self.integer(deep);
                self.integer(rgb);
                self.integer(linear);
                self.number(gain);
            }
            Encoding::Exr(ExrOptions { float, error }) => {
                self.integer(1);
                self.integer(float);
                // One was for errors in channels of other names.
                self.integer(if error { 2 } else { 0 });
            }
            Encoding::Npy(NpyOptions { error, archive, .. }) => {
                // Four is for archives, so that the digests of files are what they were.
                self.integer(if archive { 4 } else { 2 });
                self.integer(error);
            }
            Encoding::Tiff(TiffOptions { float, rgb, gain }) => {
                self.integer(3);
                self.integer(float);
                self.integer(rgb);
                self.number(gain);
            }
        }
    }

    fn centers(&mut self, centers: &CenterChannels) {
        let [depth, axes] = [name_of(&centers.depth), name_of(&centers.axes)];
        let names = centers.list().map(|(name, _)| name);
        for name in names.chain([&*depth, &*axes]) {
            self.count(name.len());
            self.0.update(name.as_bytes());
        }
        // Without averages their tolerance does not matter.
        if centers.has_averages() {
            self.number(centers.tolerance);
        }
    }

    fn camera(&mut self, camera: &Camera) {
        let Camera {
            position,
            on_axis,
            world_from_camera:
                DMat3 {
                    x_axis,
                    y_axis,
                    z_axis,
                },
        } = *camera;
        for vector in [position, on_axis, x_axis, y_axis, z_axis] {
            self.vector(vector);
        }
    }

    fn view(&mut self, view: &View) {
        let View {
            camera,
            lens:
                Lens {
                    width: retina_width,
                    distance,
                    shift: DVec2 { x, y },
                    pixel_aspect,
                },
            zoom,
            width,
            height,
            frame,
        } = *view;
        self.camera(&camera);
        for number in [retina_width, distance, x, y, zoom] {
            self.number(number);
        }
        // Pictures with square pixels have the digests that they had before there were others.
        if pixel_aspect != 1.0 {
            self.0.update(b"pixel aspect");
            self.number(pixel_aspect);
        }
        self.integer(width);
        self.integer(height);
        self.integer(frame);
    }
}

/// The hashes of groups of spheres, each with its material and its color, computed on the threads of the current rayon
/// pool.
pub(super) fn hashes_of_spheres(world: &World) -> Vec<Hash> {
    let spheres = world.spheres();
    parallel::map(spheres.len().div_ceil(SPHERES), |part| {
        let mut bytes = Vec::with_capacity(SPHERES * 36);
        let first = part * SPHERES;
        for (index, sphere) in (first..).zip(&spheres[first..]).take(SPHERES) {
            let DVec3 { x, y, z } = sphere.center();
            for number in [x, y, z, sphere.radius()] {
                bytes.extend_from_slice(&number.to_le_bytes());
            }
            bytes.extend_from_slice(&world.material_index(index).to_le_bytes());
            if world.has_own_albedos() {
                for number in world.albedo(index).to_array() {
                    bytes.extend_from_slice(&number.to_le_bytes());
                }
            }
        }
        blake3::hash(&bytes)
    })
}

#[cfg(test)]
mod tests;
