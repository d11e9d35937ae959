//! Loops in GIF and WebP, read by other decoders.

use std::fs::{self, File};
use std::io::{BufReader, Cursor};

use gif::{ColorOutput, DecodeOptions, DisposalMethod, Repeat};
use image::codecs::webp::WebPDecoder;
use image::{AnimationDecoder, ImageDecoder, metadata::LoopCount};

use crate::folder::{Folder, code, text};

const TURN: &str = "(
    image: (width: 41, height: 30),
    lens: Fov(50),
    camera: Orbit(target: (0, 0, 0), radius: 5, elevation: 10),
    background: \"#203040\",
    lights: [Directional(toward: (-1, 1, -1), intensity: (1, 0.8, 0.5))],
    spheres: [(center: (0, 0, 0), radius: 1), (center: (1.5, 0, 0), radius: 0.5)],
    animation: Turntable(frames: 7, fps: 30),
)
";

/// A folder with the scene.
fn folder() -> Folder {
    let folder = Folder::new();
    fs::write(folder.path("turn.ron"), TURN).unwrap();
    folder
}

/// Runs a command that must succeed, and returns its messages.
fn run(folder: &Folder, arguments: &str) -> String {
    let output = folder.run(arguments);
    assert_eq!(code(&output), 0, "{arguments}: {}", text(&output.stderr));
    text(&output.stderr)
}

/// A picture: red, green, blue and alpha of each pixel.
type Picture = Vec<u8>;

/// The picture in a PNG with 8 bits.
fn png(folder: &Folder, name: &str) -> Picture {
    let file = BufReader::new(File::open(folder.path(name)).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut codes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut codes).unwrap();
    let channels = info.color_type.samples();
    let pixels = codes.chunks_exact(channels);
    pixels
        .flat_map(|pixel| match *pixel {
            [grey] => [grey, grey, grey, 255],
            [red, green, blue] => [red, green, blue, 255],
            [red, green, blue, alpha] => [red, green, blue, alpha],
            _ => panic!("unexpected channels"),
        })
        .collect()
}

/// The pictures of a GIF with their durations, and how often they are shown.
struct Gif {
    pictures: Vec<(Picture, u16)>,
    repeat: Repeat,
    disposal: DisposalMethod,
}

fn gif(bytes: &[u8]) -> Gif {
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let (width, height) = (decoder.width(), decoder.height());
    let (mut pictures, mut disposal) = (Vec::new(), DisposalMethod::Any);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!((frame.left, frame.top), (0, 0));
        assert_eq!((frame.width, frame.height), (width, height));
        disposal = frame.dispose;
        pictures.push((frame.buffer.to_vec(), frame.delay));
    }
    Gif {
        pictures,
        repeat: decoder.repeat(),
        disposal,
    }
}

/// The pictures of a WebP with their durations in thousandths of a second, and whether they repeat forever.
fn webp(bytes: &[u8]) -> (Vec<(Picture, u32)>, bool) {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).unwrap();
    assert!(decoder.has_animation());
    let repeats = AnimationDecoder::loop_count(&decoder);
    let is_for_ever = matches!(repeats, LoopCount::Infinite);
    let frames = decoder.into_frames().collect_frames().unwrap();
    let pictures = frames.into_iter().map(|frame| {
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        assert_eq!(denominator, 1);
        (frame.into_buffer().into_raw(), numerator)
    });
    (pictures.collect(), is_for_ever)
}

#[test]
fn a_webp_has_the_pictures_of_the_files() {
    let folder = folder();
    for (name, options) in [("plain", ""), ("alpha", "--alpha")] {
        run(
            &folder,
            &format!("render turn.ron -o {name}.#.png {options}"),
        );
        run(
            &folder,
            &format!("render turn.ron -o {name}.webp {options}"),
        );
        let (pictures, is_for_ever) = webp(&folder.read(&format!("{name}.webp")));
        assert!(is_for_ever);
        let (pictures, durations): (Vec<Picture>, Vec<u32>) = pictures.into_iter().unzip();
        // 33⅓, rounded such that each picture begins at the right time, to half a thousandth of a second.
        assert_eq!(durations, [33, 34, 33, 33, 34, 33, 33]);
        let files = (1..=7).map(|frame| png(&folder, &format!("{name}.{frame}.png")));
        assert!(files.eq(pictures), "{name}");
    }
}

#[test]
fn a_gif_has_the_pictures_of_the_files_in_fewer_colors() {
    /// The largest difference of a code in any pixel.
    const MOST: u8 = 12;
    let folder = folder();
    run(&folder, "render turn.ron -o a.#.png");
    run(&folder, "render turn.ron -o a.gif");
    let found = gif(&folder.read("a.gif"));
    assert_eq!(found.repeat, Repeat::Infinite);
    let durations: Vec<u16> = found
        .pictures
        .iter()
        .map(|(_, duration)| *duration)
        .collect();
    assert_eq!(durations, [3, 4, 3, 3, 4, 3, 3]);
    let mut sum = 0;
    for (frame, (picture, _)) in (1..).zip(&found.pictures) {
        let file = png(&folder, &format!("a.{frame}.png"));
        for (expected, found) in file.chunks_exact(4).zip(picture.chunks_exact(4)) {
            let background = [0x20, 0x30, 0x40, 0xff];
            let allowed = if expected == background { 0 } else { MOST };
            for (&expected, &found) in expected.iter().zip(found) {
                assert!(expected.abs_diff(found) <= allowed, "{expected} {found}");
                sum += u64::from(expected.abs_diff(found));
            }
        }
    }
    // On average a quarter of a code.
    assert!(4 * sum < 7 * 41 * 30 * 3, "{sum}");
}

/// 256 colors are enough for a gray scene.
#[test]
fn a_gif_of_greys_is_exact() {
    let folder = Folder::new();
    run(&folder, "render ball.ron -o ball.png --size 64x64");
    run(&folder, "render ball.ron -o ball.gif --size 64x64");
    let found = gif(&folder.read("ball.gif"));
    assert_eq!(found.pictures, [(png(&folder, "ball.png"), 0)]);
    // One picture is a still.
    assert_eq!(found.repeat, Repeat::Finite(0));
}

#[test]
fn a_gif_leaves_out_pixels_that_are_less_than_half_covered() {
    let folder = folder();
    run(&folder, "render turn.ron -o a.#.png --alpha");
    run(&folder, "render turn.ron -o a.gif --alpha");
    let found = gif(&folder.read("a.gif"));
    // Otherwise the previous picture would be visible there.
    assert_eq!(found.disposal, DisposalMethod::Background);
    let mut partly = 0;
    for (frame, (picture, _)) in (1..).zip(&found.pictures) {
        let file = png(&folder, &format!("a.{frame}.png"));
        for (expected, found) in file.chunks_exact(4).zip(picture.chunks_exact(4)) {
            assert_eq!(found[3], if expected[3] < 128 { 0 } else { 255 });
            partly += u32::from((1..255).contains(&expected[3]));
        }
    }
    assert!(partly > 100);
}

#[test]
fn a_webp_of_one_frame_is_a_still() {
    let folder = folder();
    for (name, options) in [("a", "--frames 3"), ("b", "--frames 3 --alpha")] {
        run(&folder, &format!("render turn.ron -o {name}.png {options}"));
        run(
            &folder,
            &format!("render turn.ron -o {name}.webp {options}"),
        );
        let bytes = folder.read(&format!("{name}.webp"));
        let decoder = WebPDecoder::new(Cursor::new(&bytes)).unwrap();
        assert!(!decoder.has_animation());
        let channels = usize::from(decoder.color_type().channel_count());
        let mut codes = vec![0; decoder.total_bytes() as usize];
        decoder.read_image(&mut codes).unwrap();
        let file = png(&folder, &format!("{name}.png"));
        let file = file.chunks_exact(4).flat_map(|pixel| &pixel[..channels]);
        assert!(file.eq(&codes), "{name}");
    }
}

#[test]
fn the_bytes_do_not_depend_on_threads() {
    let folder = folder();
    for ending in ["gif", "webp"] {
        let files = [1, 2, 5].map(|threads| {
            run(
                &folder,
                &format!("render turn.ron -o a.{ending} --threads {threads}"),
            );
            folder.read(&format!("a.{ending}"))
        });
        assert!(files.iter().all(|file| *file == files[0]));
        assert_eq!(
            folder.names("."),
            [&*format!("a.{ending}"), "ball.ron", "turn.ron"]
        );
        fs::remove_file(folder.path(&format!("a.{ending}"))).unwrap();
    }
}

#[test]
fn more_frames_than_players_show_are_a_warning() {
    let folder = folder();
    let errors = run(&folder, "render turn.ron -o a.gif --fps 60");
    let warning =
        "marbles: a.gif: players show at most 50 frames per second, but this loop has 60\n";
    assert_eq!(errors, warning);
    assert!(
        gif(&folder.read("a.gif"))
            .pictures
            .iter()
            .all(|(_, duration)| *duration == 2)
    );
    let output = folder.run("render turn.ron -o b.webp --fps 100 --strict");
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("b.webp: players show at most 91 frames per second"));
    for arguments in [
        "-o c.webp --fps 90",
        "-o c.apng --fps 120",
        "-o c.gif --fps 60 --frames 1",
    ] {
        assert_eq!(run(&folder, &format!("render turn.ron {arguments}")), "");
    }
}

#[test]
fn frames_that_last_longer_than_the_format_allows_are_a_warning() {
    let folder = folder();
    for (arguments, expected) in [
        (
            "-o a.gif --fps 0.001",
            "marbles: a.gif: its format shows a frame for at most 655.35 s, but this loop has 0.001 frames per second\n",
        ),
        (
            "-o b.webp --fps 0.00005",
            "marbles: b.webp: its format shows a frame for at most 16777.215 s, but this loop has 0.00005 frames per second\n",
        ),
        (
            "-o c.apng --fps 0.00001",
            "marbles: c.apng: its format shows a frame for at most 65535 s, but this loop has 0.00001 frames per second\n",
        ),
        ("-o d.gif --fps 0.0016", ""),
        ("-o d.webp --fps 0.001", ""),
        ("-o d.apng --fps 0.001", ""),
        ("-o e.gif --fps 0.001 --frames 1", ""),
    ] {
        assert_eq!(
            run(&folder, &format!("render turn.ron {arguments}")),
            expected
        );
    }
}

#[test]
fn pictures_larger_than_the_format_has_are_refused() {
    let folder = folder();
    for (arguments, expected) in [
        (
            "-o a.gif --size 65536x1",
            "a GIF has at most 65535 columns and rows",
        ),
        (
            "-o a.webp --size 1x16385",
            "a WebP has at most 16384 columns and rows",
        ),
    ] {
        let output = folder.run(&format!("render turn.ron {arguments}"));
        assert_eq!(code(&output), 1);
        let errors = text(&output.stderr);
        let message = format!(": cannot encode the picture: {expected}\n");
        assert!(errors.contains(&message), "{errors}");
    }
    assert_eq!(folder.names("."), ["ball.ron", "turn.ron"]);
}
