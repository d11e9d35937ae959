//! Checks every scene under `scenes`: it is valid, explained, rendered, and looks as before.
//!
//! `golden/NAME.png` is the first frame of a scene in a small size. With `MARBLES_BLESS=1` the pictures are written
//! again, and the run fails so that somebody looks at them.

use std::env;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use marbles_core::Image;
use marbles_scene::Scene;

use crate::studio::{picture, pixels};

/// Width of the golden pictures, in pixels.
const WIDTH: u32 = 96;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All scene files below `scenes`, sorted.
fn scene_files() -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![repository().join("scenes")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "ron") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn name(file: &Path) -> &str {
    file.file_stem().unwrap().to_str().unwrap()
}

fn small_height(scene: &Scene) -> u32 {
    let view = scene.view(1).unwrap();
    (WIDTH * view.height).div_ceil(view.width)
}

/// Runs the program as a user would, for one frame of a scene.
fn render_to(output: &Path, file: &Path, frame: i32, height: u32) -> ExitCode {
    let size = format!("{WIDTH}x{height}");
    let frame = frame.to_string();
    let words = [
        "--samples",
        "4",
        "--size",
        &size,
        "--frames",
        &frame,
        "--quiet",
    ];
    let mut arguments = vec!["marbles".into(), "render".into(), file.into()];
    arguments.extend(["-o".into(), output.into()]);
    arguments.extend(words.map(Into::into));
    marbles_cli::run(arguments)
}

/// The 8-bit samples of a PNG, and the number of samples per pixel.
fn decode(file: &Path) -> (Vec<u8>, usize) {
    let decoder = png::Decoder::new(BufReader::new(File::open(file).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut samples).unwrap();
    assert_eq!(info.bit_depth, png::BitDepth::Eight);
    (samples, info.color_type.samples())
}

/// The linear light of an sRGB code, which may be fractional, after IEC 61966-2-1.
fn decode_srgb(code: f64) -> f64 {
    let value = (code / 255.0).clamp(0.0, 1.0);
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// Pixels of the picture that differ from the reference picture by more than both claimed errors and the rounding to 8
/// bits.
fn strangers(image: &Image, golden: &Path) -> usize {
    let (samples, channels) = decode(golden);
    assert_eq!(
        samples.len(),
        channels * (image.width() * image.height()) as usize
    );
    let is_strange = |(col, row): &(u32, u32)| {
        let error = 2.0 * image.error(*col, *row) + 1e-9;
        let start = channels * (row * image.width() + col) as usize;
        let codes = &samples[start..start + channels];
        codes
            .iter()
            .zip(image.rgba(*col, *row))
            .any(|(&code, light)| {
                let code = f64::from(code);
                let light = light.min(1.0);
                light < decode_srgb(code - 0.5) - error || light > decode_srgb(code + 0.5) + error
            })
    };
    pixels(image).filter(is_strange).count()
}

#[test]
fn every_example_renders_as_it_was_last_looked_at() {
    let bless = env::var_os("MARBLES_BLESS").is_some();
    let golden_folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let rendered_folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("examples");
    let files = scene_files();
    assert!(files.len() >= 20);
    for file in &files {
        let scene = Scene::load(file).unwrap_or_else(|error| panic!("{error}"));
        let height = small_height(&scene);
        let first = scene.frames().map_or(1, |frames| *frames.start());
        let golden = golden_folder.join(format!("{}.png", name(file)));
        if bless {
            assert_eq!(render_to(&golden, file, first, height), ExitCode::SUCCESS);
            continue;
        }
        let rendered = rendered_folder.join(format!("{}.png", name(file)));
        assert_eq!(render_to(&rendered, file, first, height), ExitCode::SUCCESS);
        let mut view = scene.view(first).unwrap();
        (view.width, view.height) = (WIDTH, height);
        let image = picture(&scene.world_at(first).unwrap(), &view, 4, false);
        for file in [&rendered, &golden] {
            let strangers = strangers(&image, file);
            assert_eq!(
                strangers,
                0,
                "{}: compare with {}",
                file.display(),
                rendered.display()
            );
        }
    }
    assert!(!bless, "the pictures were written: look at them");
    let golden = fs::read_dir(golden_folder).unwrap().count();
    assert_eq!(golden, files.len(), "a golden picture has no scene");
}

#[test]
fn every_example_says_what_it_shows() {
    for file in scene_files() {
        let text = fs::read_to_string(&file).unwrap();
        assert!(
            text.starts_with("// "),
            "{} has no head comment",
            file.display()
        );
    }
}

/// The middle and the end of animations, and pictures with alpha.
#[test]
fn animations_render_to_their_last_frame() {
    for file in scene_files() {
        let scene = Scene::load(&file).unwrap();
        let Some(frames) = scene.frames() else {
            continue;
        };
        let (first, last) = frames.into_inner();
        for frame in [first + (last - first) / 2, last] {
            let mut view = scene.view(frame).unwrap();
            (view.width, view.height) = (WIDTH / 2, small_height(&scene) / 2);
            let image = picture(&scene.world_at(frame).unwrap(), &view, 2, true);
            let covered = pixels(&image).filter(|&(col, row)| image.rgba(col, row)[3] > 0.0);
            assert!(
                covered.count() > 50,
                "{} shows nothing in frame {frame}",
                file.display()
            );
        }
    }
}

/// The scenes in the code blocks of a document.
fn fenced_scenes(document: &str) -> Vec<String> {
    let text = fs::read_to_string(repository().join(document)).unwrap();
    let blocks = text.split("```ron\n").skip(1);
    blocks
        .map(|block| block.split("```").next().unwrap().to_owned())
        .collect()
}

#[test]
fn scenes_in_the_documents_are_valid() {
    for document in ["README.md", "docs/scenes.md"] {
        let scenes = fenced_scenes(document);
        assert!(!scenes.is_empty());
        for scene in scenes {
            Scene::parse(&scene, Path::new(document)).unwrap_or_else(|error| panic!("{error}"));
        }
    }
    let shown = fs::read_to_string(repository().join("scenes/snowman.ron")).unwrap();
    assert!(
        shown.ends_with(&fenced_scenes("README.md")[0]),
        "the README shows another scene"
    );
}

#[test]
fn pictures_of_the_gallery_are_wide_enough() {
    const LEAST: u32 = 480;
    let gallery = repository().join("docs/gallery");
    for folder in [gallery.join("original"), gallery] {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "png") {
                let decoder = png::Decoder::new(BufReader::new(File::open(&path).unwrap()));
                let width = decoder.read_info().unwrap().info().width;
                assert!(width >= LEAST, "{} is {width} wide", path.display());
            }
        }
    }
}
