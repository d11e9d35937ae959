//! Small pictures, and the files that they become.

use std::io::Cursor;
use std::num::NonZeroU32;
use std::ops::ControlFlow;

use blake3::Hash;
use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Camera, Image, Lens, Light, Material, Method, Settings, Sphere, View, World,
};

use super::encoder::{Encoder, Layout, block, samples};
use super::encoding::{Encoding, ExrOptions, PngOptions, TiffOptions};
use super::exr::write::write_blocks;
use super::facts::Facts;
use super::form::Form;
use super::npy::stamp::Stamp;
use super::png::write::{compress, texts};
use super::tiff;
use crate::base::region::Region;
use crate::base::size::Size;

/// sRGB codes with 8 bits, gray if the picture is gray.
pub(crate) const PNG: PngOptions = PngOptions {
    deep: false,
    rgb: false,
    linear: false,
    gain: 1.0,
};

/// The digest stored in the pictures.
pub(super) const DIGEST: Hash = Hash::from_bytes([0x5a; 32]);

/// The bytes of a PNG file.
pub(super) fn png_bytes(image: &Image, options: PngOptions) -> Vec<u8> {
    encode(image, Encoding::Png(options), &facts()).0
}

/// The bytes of a TIFF file.
pub(super) fn tiff_bytes(image: &Image, float: bool) -> Vec<u8> {
    let options = TiffOptions {
        float,
        rgb: false,
        gain: 1.0,
    };
    encode(image, Encoding::Tiff(options), &facts()).0
}

/// The bytes of an EXR file.
pub(super) fn exr_bytes(image: &Image, options: ExrOptions) -> Vec<u8> {
    encode(image, Encoding::Exr(options), &facts()).0
}

pub(super) fn facts() -> Facts {
    Facts {
        view: view(),
        frame: 1,
        frames_per_second: None,
        method: Method::Samples(NonZeroU32::MIN),
        digest: DIGEST,
    }
}

/// The size of a picture.
pub(super) fn size(image: &Image) -> Size {
    let (width, height) = (image.width(), image.height());
    Size { width, height }
}

/// The bytes of a file, and how many numbers were too large.
pub(super) fn encode(image: &Image, encoding: Encoding, facts: &Facts) -> (Vec<u8>, u64) {
    let form = Form {
        region: Region::all(size(image)),
        channels: image.channels(),
        alpha: image.has_alpha(),
        centers: None,
    };
    let encoder = Encoder::new(encoding, form, &[]);
    let mut clipped = 0;
    let mut pieces = (0..encoder.pieces()).map(|index| {
        let first = index * encoder.rows();
        let rows = first..image.height().min(first + encoder.rows());
        let mut samples = vec![0; encoder.sample_bytes(index)];
        clipped += encoder.encode(0, &mut samples, 0, image, rows);
        encoder.piece(index, samples)
    });
    let mut file = Cursor::new(Vec::new());
    match &encoder.layout {
        Layout::Png { shape, .. } => {
            let texts = texts(&facts.digest, &form.region);
            let has_grown = compress(&mut file, *shape, &texts, |stream| {
                for piece in pieces {
                    stream.write_all(&samples(Some(piece))?)?;
                }
                Ok(())
            });
            assert!(!has_grown.unwrap());
        }
        Layout::Exr(blocks) => {
            let next = || block(pieces.next());
            write_blocks(&mut file, blocks, facts, next, || Some(image.summary())).unwrap();
        }
        Layout::Tiff(strips) => {
            let stamp = Stamp {
                digest: facts.digest,
                region: form.region,
            };
            let next = || samples(pieces.next());
            tiff::write::write(&mut file, strips.shape, encoder.rows(), &stamp, next).unwrap();
        }
        Layout::Npy(_) => panic!("these are several files"),
    }
    (file.into_inner(), clipped)
}

/// Light on a ball.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Scene {
    Grey,
    Color,
    /// More light than a half can hold.
    Bright,
}

/// The view of the small pictures.
pub(crate) fn view() -> View {
    View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 0.6,
            distance: 1.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 23,
        height: 19,
        frame: 1,
    }
}

/// A small picture of a ball in front of a background.
pub(crate) fn render(scene: Scene, alpha: bool) -> Image {
    let (albedo, background, intensity) = match scene {
        Scene::Grey => (DVec3::ONE, DVec3::splat(0.25), 1.0),
        Scene::Color => (DVec3::new(1.0, 0.5, 0.001), DVec3::new(0.0, 0.2, 0.4), 1.5),
        Scene::Bright => (DVec3::ONE, DVec3::ZERO, 1e5),
    };
    let mut world = World::new();
    let material = world.add_material(Material {
        albedo,
        ..Material::MATTE_WHITE
    });
    world.add_sphere(Sphere::new(4.0 * DVec3::Z, 1.0).unwrap(), material);
    world.background = background;
    let toward = DVec3::new(-1.0, 1.0, -1.0);
    let light = Light::directional(toward, DVec3::splat(intensity)).unwrap();
    world.lights.push(light);
    let settings = Settings {
        method: Method::Samples(NonZeroU32::new(3).unwrap()),
        alpha,
    };
    marbles_core::Renderer::new(&world)
        .render_with_progress(&view(), &settings, &|_| ControlFlow::Continue(()))
        .unwrap()
}
