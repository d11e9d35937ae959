use super::*;
use crate::formats::encoding::AnimationFormat;

fn name(pattern: &str, frame: i32) -> String {
    let pattern = Pattern::parse(Path::new(pattern)).unwrap();
    pattern.path(frame).into_os_string().into_string().unwrap()
}

fn refusal(pattern: &str) -> String {
    Pattern::parse(Path::new(pattern)).unwrap_err()
}

#[test]
fn every_spelling_takes_the_frame() {
    assert_eq!(name("a.####.png", 7), "a.0007.png");
    assert_eq!(name("a#.png", 12), "a12.png");
    assert_eq!(name("out/%04d.exr", 7), "out/0007.exr");
    assert_eq!(name("%d.png", 7), "7.png");
    assert_eq!(name("{frame:04}_a.png", 7), "0007_a.png");
    assert_eq!(name("a{frame}.png", 7), "a7.png");
    assert_eq!(name("%012d.png", 7), "000000000007.png");
    assert_eq!(name("####.png", 123_456), "123456.png");
}

#[test]
fn negative_frames_are_padded_as_printf_does() {
    for pattern in ["####.png", "%04d.png", "{frame:04}.png"] {
        assert_eq!(name(pattern, -5), "-005.png");
    }
}

#[test]
fn names_without_a_number_stay() {
    let pattern = Pattern::parse(Path::new("50% {off}.png")).unwrap();
    assert!(!pattern.is_numbered());
    assert_eq!(pattern.path(3), Path::new("50% {off}.png"));
}

#[test]
fn folders_are_taken_as_written() {
    assert_eq!(name("shot#1/%d/{frame}.png", 2), "shot#1/%d/2.png");
    assert_eq!(name("/a.png/../ä#é.png", 2), "/a.png/../ä2é.png");
}

#[test]
fn endings_choose_the_format() {
    let format = |name: &str| Pattern::parse(Path::new(name)).unwrap().format();
    assert_eq!(format("a.PNG"), Format::Png);
    assert_eq!(format("a.b.Exr"), Format::Exr);
    assert_eq!(
        format("a.png.apng"),
        Format::Animation(AnimationFormat::Apng)
    );
    assert_eq!(format("a.Gif"), Format::Animation(AnimationFormat::Gif));
    assert_eq!(format("a.webp"), Format::Animation(AnimationFormat::Webp));
    assert_eq!(format("a.NPY"), Format::Npy);
    assert_eq!(format("a.npz"), Format::Npz);
    assert_eq!(format("npz:-"), Format::Npz);
    assert_eq!(format("-"), Format::Png);
    assert_eq!(format("a.tif"), Format::Tiff);
    assert_eq!(format("a.tiff"), Format::Tiff);
    for wrong in ["a.jpg", "a", "png", "out/", "out.png/", "a.png.", ".."] {
        assert!(
            refusal(wrong)
                .contains("ends in .png, .exr, .npy, .npz, .tif, .tiff, .apng, .gif or .webp"),
            "{wrong}"
        );
    }
}

#[test]
fn refuses_numbers_that_cannot_be() {
    for wrong in [
        "%4d.png",
        "{frame:4}.png",
        "{frame:x}.png",
        "{frame.png",
        "%0999d.png",
    ] {
        assert!(
            refusal(wrong).contains("####, %04d or {frame:04}"),
            "{wrong}"
        );
    }
    assert_eq!(
        refusal("#a_%04d.png"),
        "expected one place for the frame number, found `#` and `%04d`"
    );
}

#[test]
fn names_come_from_the_scene() {
    let scene = Path::new("scenes/two#balls.ron");
    let still = Pattern::named_after(scene, false);
    assert_eq!(still.path(1), Path::new("two#balls.png"));
    let sequence = Pattern::named_after(scene, true);
    assert_eq!(sequence.path(-3), Path::new("two#balls.-003.png"));
}

#[test]
fn names_of_scenes_are_taken_as_they_are() {
    let name = |pattern: &str, scene: &str| {
        let pattern = Pattern::of_scene(Path::new(pattern), OsStr::new(scene)).unwrap();
        pattern.path(7).into_os_string().into_string().unwrap()
    };
    for scene in ["a", "a####", "a%04d", "{frame}", "{scene}", "a.png"] {
        assert_eq!(name("{scene}.png", scene), format!("{scene}.png"));
        assert_eq!(
            name("o/{scene}/b_{scene}.##.exr", scene),
            format!("o/{scene}/b_{scene}.07.exr")
        );
        assert_eq!(name("#_{scene}_b.npy", scene), format!("7_{scene}_b.npy"));
    }
    assert_eq!(name("a.#.png", "b"), "a.7.png");
}

/// Names that are not UTF-8 remain distinct.
#[test]
#[cfg(unix)]
fn names_of_scenes_are_bytes() {
    use std::os::unix::ffi::OsStrExt;

    let [one, other] = [&b"a\xfe"[..], b"a\xff"].map(|scene| {
        let pattern = Pattern::of_scene(Path::new("{scene}.#.png"), OsStr::from_bytes(scene));
        pattern.unwrap().path(1)
    });
    assert_eq!(one.as_os_str().as_bytes(), b"a\xfe.1.png");
    assert_eq!(other.as_os_str().as_bytes(), b"a\xff.1.png");
    assert!(!has_place_for_scene(Path::new(OsStr::from_bytes(
        b"\xff{scene}/a.png"
    ))));
}

#[test]
fn videos_are_refused_with_what_makes_them() {
    for name in ["turn.mp4", "out/turn.MOV"] {
        let reason = Pattern::parse(Path::new(name)).unwrap_err();
        assert!(reason.contains("-o 'frames/####.png'"), "{reason}");
        let line = format!(
            "ffmpeg -framerate 24 -i frames/%04d.png -c:v libx264 -crf 16 -pix_fmt yuv420p {name}`"
        );
        assert!(reason.contains(&line), "{reason}");
    }
    let other = Pattern::parse(Path::new("turn.mp3")).unwrap_err();
    assert!(
        other.starts_with("expected a file name that ends in"),
        "{other}"
    );
}
