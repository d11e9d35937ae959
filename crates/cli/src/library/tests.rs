use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use marbles_core::Method;
use marbles_scene::Scene;

use super::*;
use crate::tests::{run_here, temporary};

const SCENE: &str = "(
    image: (width: 40, height: 27), lens: Fov(40), camera: LookAt(position: (0, 3, -10), target: (0, 0.7, 0)),
    background: \"#202838\", ambient: 0.08,
    lights: [Directional(name: \"key\", toward: (-1, 1.5, -1)), Directional(toward: (1, 1, 0), intensity: 0.3)],
    materials: { \"candy\": (albedo: \"#d02840\", highlight: (strength: 0.6, shininess: 40)) },
    spheres: [(center: (0, -1000, 0), radius: 1000), (center: (-1, 1, 0), radius: 1, material: \"candy\")],
    animation: Keyframes(frames: (1, 5), fps: 24, keys: [(frame: 1, zoom: 1), (frame: 5, zoom: 2)]),
)";

fn options(frames: &[i32]) -> Options {
    Options {
        frames: frames.to_vec(),
        method: Method::Tolerance(1e-3),
        alpha: false,
        channels: Vec::new(),
        depth: "axis".to_owned(),
        axes: "world".to_owned(),
        size: None,
        region: None,
        per_light: false,
        threads: Some(2),
        progress: false,
    }
}

fn begin(options: &Options) -> Result<Rendering, Error> {
    begin_scene(SCENE, options)
}

fn begin_scene(text: &str, options: &Options) -> Result<Rendering, Error> {
    let path = Path::new("library.ron");
    let scene = Scene::parse(text, path).unwrap();
    Rendering::begin(&Arc::new(scene), path, options)
}

/// All pictures of a rendering.
fn all(options: &Options) -> Vec<Picture> {
    let mut rendering = begin(options).unwrap();
    let mut pictures = Vec::new();
    loop {
        match rendering.next(Duration::from_secs(60)).unwrap() {
            Next::Picture(picture) => pictures.push(*picture),
            Next::Waiting => panic!("no picture for a minute"),
            Next::End => return pictures,
        }
    }
}

fn given(arrays: &[PictureArray]) -> Vec<(&str, GivenNumbers<'_>)> {
    let given = arrays.iter().filter_map(|array| {
        let numbers = match &array.numbers {
            Numbers::F64(numbers) => GivenNumbers::F64(numbers),
            Numbers::U32(numbers) => GivenNumbers::U32(numbers),
            Numbers::Bool(_) => return None,
        };
        Some((&*array.name, numbers))
    });
    given.collect()
}

#[test]
fn saved_pictures_are_the_files_of_the_command() {
    let scene = temporary("library.ron");
    std::fs::write(&scene, SCENE).unwrap();
    let channels = ["depth", "normal", "id", "mean_normal", "coverage_id"];
    for (ending, words, options, has_channels) in [
        (
            "png",
            vec!["--bits", "16"],
            SaveOptions {
                bits: Some(16),
                ..SaveOptions::default()
            },
            false,
        ),
        (
            "tif",
            vec!["--float"],
            SaveOptions {
                float: true,
                ..SaveOptions::default()
            },
            false,
        ),
        (
            "npz",
            vec!["--error-channel"],
            SaveOptions {
                error: true,
                ..SaveOptions::default()
            },
            true,
        ),
        ("npy", vec![], SaveOptions::default(), false),
        (
            "exr",
            vec!["--error-channel"],
            SaveOptions {
                error: true,
                ..SaveOptions::default()
            },
            false,
        ),
    ] {
        let (of_command, own) = (
            temporary(&format!("library-command.{ending}")),
            temporary(&format!("library-own.{ending}")),
        );
        let mut arguments = vec!["render", scene.to_str().unwrap(), "--frames", "3", "-o"];
        arguments.push(of_command.to_str().unwrap());
        arguments.extend(words);
        let list = channels.join(",");
        if has_channels {
            arguments.extend(["--channels", &list]);
        }
        let (code, _, err) = run_here(&arguments);
        assert_eq!(code, 0, "{err}");
        let mut picture = all(&Options {
            channels: channels
                .iter()
                .filter(|_| has_channels)
                .map(|name| (*name).to_owned())
                .collect(),
            ..self::options(&[3])
        });
        let mut picture = picture.remove(0);
        let arrays = picture.take_arrays();
        picture.save(&own, &options, &given(&arrays)).unwrap();
        let [expected, found] = [&of_command, &own].map(|path| std::fs::read(path).unwrap());
        assert!(expected == found, "{ending}");

        // Another picture does not claim to be this one.
        let mut arrays = arrays;
        if let Numbers::F64(light) = &mut arrays[0].numbers {
            light[7] += 1e-12;
        }
        picture.save(&own, &options, &given(&arrays)).unwrap();
        assert!(std::fs::read(&own).unwrap() != expected, "{ending}");
        for path in [of_command, own] {
            std::fs::remove_file(path).unwrap();
        }
    }
    std::fs::remove_file(scene).unwrap();
}

#[test]
fn pictures_of_lights_add_up_and_only_the_whole_has_channels() {
    let mut options = options(&[2]);
    (options.per_light, options.channels) = (true, vec!["id".to_owned()]);
    let mut picture = all(&options).remove(0);
    let names = |picture: &mut Picture| -> Vec<String> {
        picture
            .take_arrays()
            .into_iter()
            .map(|array| array.name)
            .collect()
    };
    let lights = picture.take_per_light();
    assert_eq!(names(&mut picture), ["light", "error", "bound", "id"]);
    let found: Vec<&str> = lights.iter().map(|(name, _)| &**name).collect();
    assert_eq!(found, ["key", "light-2", "ambient"]);
    for (_, mut light) in lights {
        assert_eq!(names(&mut light), ["light", "error", "bound"]);
    }
}

#[test]
fn every_light_has_a_picture_of_its_own_name() {
    let mut options = options(&[2]);
    options.per_light = true;
    for (name, sky) in [("ambient", ""), ("light-2", ""), ("sky", "sky: 0.5, ")] {
        let text = SCENE.replace("\"key\"", &format!("{name:?}"));
        let text = text.replace("ambient:", &format!("{sky}ambient:"));
        let error = begin_scene(&text, &options).err().unwrap();
        let expected = format!("two lights would share the picture `{name}`");
        assert!(error.to_string().ends_with(&expected), "{error}");
    }
}

#[test]
fn frames_come_in_the_order_that_was_asked_for() {
    let pictures = all(&options(&[4, 2, 3, 2]));
    let frames: Vec<i32> = pictures.iter().map(Picture::frame).collect();
    assert_eq!(frames, [4, 2, 3]);
}

/// Whoever takes no picture is not waited for.
#[test]
fn a_rendering_can_be_stopped_at_any_time() {
    for taken in 0..3 {
        let mut rendering = begin(&options(&[1, 2, 3, 4, 5])).unwrap();
        for _ in 0..taken {
            assert!(matches!(
                rendering.next(Duration::from_secs(60)),
                Ok(Next::Picture(_))
            ));
        }
        rendering.stop();
        assert!(matches!(
            rendering.next(Duration::from_secs(60)),
            Ok(Next::End)
        ));
    }
}

#[test]
fn wrong_options_are_refused_by_their_names() {
    let of = |change: fn(&mut Options)| {
        let mut options = options(&[1]);
        change(&mut options);
        match begin(&options) {
            Err(Error::Value(message)) => message,
            _ => "accepted".to_owned(),
        }
    };
    for (message, expected) in [
        (
            of(|options| options.frames = vec![]),
            "frames: expected one at least",
        ),
        (
            of(|options| options.frames = vec![6]),
            "frame: expected a frame of the scene, from 1 to 5, found 6",
        ),
        (
            of(|options| options.method = Method::Tolerance(0.0)),
            "tolerance: expected a finite number above 0",
        ),
        (
            of(|options| options.channels = vec!["deep".to_owned()]),
            "channels[0]: expected one of depth, normal",
        ),
        (
            of(|options| options.depth = "z".to_owned()),
            "depth: expected one of axis, ray, found \"z\"",
        ),
        (
            of(|options| options.size = Some((0, 5))),
            "size: expected columns and rows",
        ),
    ] {
        assert!(message.starts_with(expected), "{message}");
    }
}
