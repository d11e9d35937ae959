//! Channels with values of rays through pixel centers.

use std::collections::BTreeMap;
use std::fs;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers};

use crate::folder::{Folder, code, text};
use crate::sequences::turntable;

/// A ball straight ahead, another ball next to it, and nothing else.
const BALLS: &str = "(
    image: (width: 41, height: 31),
    lens: Retina(width: 41, distance: 50),
    camera: Free(position: (1, 2, 3)),
    lights: [Directional(toward: (-1, 1, -1))],
    materials: { \"red\": (albedo: (0.75, 0.25, 0.125)), \"bumps\": (rough: (amplitude: 0.5)) },
    spheres: [(center: (1, 2, 13), radius: 2, material: \"red\"),
              (center: (4, 2, 13), radius: 1)],
)
";

const ALL: &str = "--channels depth,normal,position,id,albedo,mask";

/// The numbers of the channels of a file.
pub(crate) type Channels = BTreeMap<String, FlatSamples>;

/// Reads an EXR of the folder.
pub(crate) fn read(folder: &Folder, name: &str) -> Channels {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(folder.path(name))
        .unwrap();
    let channels = image.layer_data.channel_data.list.into_iter();
    channels
        .map(|channel| (channel.name.to_string(), channel.sample_data))
        .collect()
}

fn render(folder: &Folder, arguments: &str) -> Channels {
    let output = folder.run(&format!("render {arguments} -o a.exr"));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    read(folder, "a.exr")
}

fn balls() -> Folder {
    let folder = Folder::new();
    fs::write(folder.path("balls.ron"), BALLS).unwrap();
    folder
}

/// A number of a float channel, at a column and row of the picture.
fn at(channels: &Channels, name: &str, col: usize, row: usize) -> f32 {
    match &channels[name] {
        FlatSamples::F32(floats) => floats[row * 41 + col],
        other => panic!("{name}: {other:?}"),
    }
}

fn vector(channels: &Channels, name: &str, col: usize, row: usize) -> [f32; 3] {
    ["X", "Y", "Z"].map(|part| at(channels, &format!("{name}.{part}"), col, row))
}

#[test]
fn the_middle_of_a_ball_is_where_it_is() {
    let folder = balls();
    let channels = render(&folder, &format!("balls.ron {ALL}"));
    let names: Vec<&str> = channels.keys().map(|name| &**name).collect();
    let expected = "B G R albedo.B albedo.G albedo.R depth.Z id.V mask.V normal.X normal.Y normal.Z \
                    position.X position.Y position.Z";
    assert_eq!(names.join(" "), expected);
    assert_eq!(at(&channels, "depth.Z", 20, 15), 8.0);
    assert_eq!(vector(&channels, "normal", 20, 15), [0.0, 0.0, -1.0]);
    assert_eq!(vector(&channels, "position", 20, 15), [1.0, 2.0, 11.0]);
    let albedo = ["R", "G", "B"].map(|part| at(&channels, &format!("albedo.{part}"), 20, 15));
    assert_eq!(albedo, [0.75, 0.25, 0.125]);
    assert_eq!(at(&channels, "mask.V", 20, 15), 1.0);
    // The other ball's center is 15 pixels to the right.
    let FlatSamples::U32(ids) = &channels["id.V"] else {
        panic!("{:?}", channels["id"]);
    };
    assert_eq!(
        [ids[0], ids[15 * 41 + 20], ids[15 * 41 + 35]],
        [u32::MAX, 0, 1]
    );
    // The corner sees nothing.
    assert_eq!(at(&channels, "depth.Z", 0, 0), f32::INFINITY);
    assert_eq!(vector(&channels, "normal", 0, 0), [0.0; 3]);
    assert_eq!(vector(&channels, "position", 0, 0), [0.0; 3]);
    assert_eq!(at(&channels, "mask.V", 0, 0), 0.0);
}

#[test]
fn axes_and_depths_are_those_that_are_asked_for() {
    let folder = balls();
    let world = render(&folder, &format!("balls.ron {ALL}"));
    let (col, row) = (23, 12);
    let [x, y, z] = vector(&world, "position", col, row);
    let [nx, ny, nz] = vector(&world, "normal", col, row);
    // The camera is not turned, and stands at (1, 2, 3).
    let near = |found: [f32; 3], expected: [f32; 3]| {
        let pairs = found.into_iter().zip(expected);
        let off = pairs.fold(0.0_f32, |most, (one, other)| most.max((one - other).abs()));
        assert!(off < 1e-5, "{found:?} {expected:?}");
    };
    for (axes, [sx, sy, sz]) in [
        ("camera-opencv", [1.0, -1.0, 1.0]),
        ("camera-opengl", [1.0, 1.0, -1.0]),
    ] {
        let options = format!("{ALL} --axes {axes} --depth ray");
        let camera = render(&folder, &format!("balls.ron {options}"));
        let position = vector(&camera, "position", col, row);
        near(position, [sx * (x - 1.0), sy * (y - 2.0), sz * (z - 3.0)]);
        near(
            vector(&camera, "normal", col, row),
            [sx * nx, sy * ny, sz * nz],
        );
        let squares = position.map(|part| f64::from(part) * f64::from(part));
        let distance = squares.iter().sum::<f64>().sqrt();
        let depth = f64::from(at(&camera, "depth.Z", col, row));
        assert!((depth - distance).abs() < 1e-5);
        assert!(depth > f64::from(at(&world, "depth.Z", col, row)));
    }
}

#[test]
fn channels_do_not_depend_on_the_picture() {
    let folder = balls();
    let one = render(&folder, &format!("balls.ron {ALL} --samples 1"));
    for more in [
        "--samples 4 --float",
        "--tolerance 1e-2",
        "--alpha --error-channel --threads 1",
    ] {
        let other = render(&folder, &format!("balls.ron {ALL} {more}"));
        let centers = one
            .iter()
            .filter(|(name, _)| !["R", "G", "B"].contains(&&***name));
        for (name, values) in centers {
            assert_eq!(
                format!("{values:?}"),
                format!("{:?}", other[name]),
                "{more} {name}"
            );
        }
    }
    // And the picture does not depend on them.
    let plain = render(&folder, "balls.ron --samples 1 --float");
    for name in ["R", "G", "B"] {
        assert_eq!(format!("{:?}", one[name]), format!("{:?}", plain[name]));
    }
}

/// Some readers convert all channels to the type of the first, which is the picture: it has floats as well.
#[test]
fn all_channels_but_numbers_of_spheres_are_floats() {
    let folder = balls();
    for options in [
        ALL.to_owned(),
        format!("{ALL} --alpha --error-channel"),
        "--channels id --per-light=layers".to_owned(),
        "--channels mean_normal,coverage_id".to_owned(),
    ] {
        let channels = render(&folder, &format!("balls.ron {options}"));
        assert!(channels.len() > 3);
        for (name, values) in channels {
            let is_float = matches!(values, FlatSamples::F32(_));
            assert_eq!(is_float, !name.ends_with("id.V"), "{options}: {name}");
        }
    }
    let small = render(&folder, "balls.ron --channels depth,id --half");
    for (name, values) in small {
        let is_half = matches!(values, FlatSamples::F16(_));
        assert_eq!(is_half, ["R", "G", "B"].contains(&&*name), "{name}");
    }
    let plain = render(&folder, "balls.ron");
    assert!(
        plain
            .values()
            .all(|values| matches!(values, FlatSamples::F16(_)))
    );
}

#[test]
fn bumps_have_two_normals() {
    let folder = balls();
    let rough = BALLS.replace(
        "radius: 2, material: \"red\"",
        "radius: 2, material: \"bumps\"",
    );
    fs::write(folder.path("rough.ron"), rough).unwrap();
    let [smooth, rough] =
        ["balls", "rough"].map(|name| render(&folder, &format!("{name}.ron --channels normal")));
    assert!(!smooth.contains_key("geometric_normal.X"));
    let (col, row) = (22, 14);
    let geometric = vector(&rough, "geometric_normal", col, row);
    assert_eq!(geometric, vector(&smooth, "normal", col, row));
    assert_ne!(geometric, vector(&rough, "normal", col, row));
}

#[test]
fn frames_without_the_channels_are_rendered_again() {
    let folder = turntable();
    let run = |more: &str| {
        let frames = "render turn.ron --frames 1-2 -o t.#.exr --size 24x16";
        let output = folder.run(&format!("{frames} --skip-existing {more}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        text(&output.stdout).matches(": skipped").count()
    };
    assert_eq!([run(""), run("")], [0, 2]);
    assert_eq!([run("--channels id"), run("--channels id")], [0, 2]);
    assert_eq!(run("--channels id,depth --depth ray"), 0);
    assert_eq!(run("--channels depth,id --depth ray"), 2);
    assert_eq!(run("--channels depth,id"), 0);
}

#[test]
fn arrays_hold_the_same_in_doubles() {
    let folder = balls();
    let floats = render(&folder, &format!("balls.ron {ALL}"));
    let output = folder.run(&format!("render balls.ron {ALL} -o b.npy"));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert_eq!(
        folder.names("."),
        [
            "a.exr",
            "b.npy",
            "b_channels.npy",
            "b_id.npy",
            "ball.ron",
            "balls.ron"
        ]
    );
    let names = "depth.Z normal.X normal.Y normal.Z position.X position.Y position.Z \
                 albedo.R albedo.G albedo.B mask.V";
    let names: Vec<&str> = names.split(' ').collect();
    let bytes = folder.read("b_channels.npy");
    let (doubles, _) = bytes[bytes.len() - 41 * 31 * 8 * names.len()..].as_chunks::<8>();
    let bytes = folder.read("b_id.npy");
    let (ids, _) = bytes[bytes.len() - 41 * 31 * 4..].as_chunks::<4>();
    let FlatSamples::U32(expected) = &floats["id.V"] else {
        panic!("{:?}", floats["id.V"]);
    };
    for pixel in 0..41 * 31 {
        assert_eq!(u32::from_le_bytes(ids[pixel]), expected[pixel]);
        for (place, name) in names.iter().enumerate() {
            let double = f64::from_le_bytes(doubles[pixel * names.len() + place]);
            let float = at(&floats, name, pixel % 41, pixel / 41);
            // A unit in the last place of a float at most.
            let off = (double - f64::from(float)).abs();
            let is_near = off <= f64::from(f32::EPSILON) * double.abs();
            assert!(
                is_near || f64::from(float) == double,
                "{name} {float} {double}"
            );
        }
    }
    let header = |name: &str| text(&folder.read(name)[10..100]);
    assert!(header("b_channels.npy").contains("'shape': (31, 41, 11)"));
    assert!(header("b_id.npy").contains("'<u4'"));
    let again = folder.run(&format!("render balls.ron {ALL} -o b.npy --skip-existing"));
    assert!(text(&again.stdout).contains(": skipped"));
    fs::remove_file(folder.path("b_id.npy")).unwrap();
    let again = folder.run(&format!("render balls.ron {ALL} -o b.npy --skip-existing"));
    assert!(!text(&again.stdout).contains(": skipped"));
}

#[test]
fn arrays_of_parts_are_merged() {
    let folder = balls();
    for (name, region) in [
        ("whole", ""),
        ("left", "--region 0,0,19,31"),
        ("right", "--region 19,0,22,31"),
    ] {
        let output = folder.run(&format!("render balls.ron {ALL} -o {name}.npy {region}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    }
    for part in ["", "_channels", "_id"] {
        let names = ["merged", "left", "right"].map(|name| format!("{name}{part}.npy"));
        let output = folder.run(&format!("merge {}", names.join(" ")));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let [merged, whole] =
            ["merged", "whole"].map(|name| folder.read(&format!("{name}{part}.npy")));
        assert!(merged == whole, "{part}");
    }
    let output = folder.run("merge mixed.npy left.npy right_id.npy");
    assert_eq!(code(&output), 2);
}

#[test]
fn averages_are_stored_beside_them() {
    let folder = balls();
    let options = "--channels id,mean_normal,coverage_id";
    let channels = render(&folder, &format!("balls.ron {options}"));
    let names: Vec<&str> = channels.keys().map(|name| &**name).collect();
    let expected = "B G R coverage_error.V coverage_id.V coverage_share.V id.V mean_normal.X mean_normal.Y mean_normal.Z \
                    mean_normal_error.V";
    assert_eq!(names.join(" "), expected);
    // The middle of a ball, in which the normals turn alike to all sides, and a corner.
    let normal = vector(&channels, "mean_normal", 20, 15);
    assert!(normal[0].abs() < 1e-3 && normal[1].abs() < 1e-3 && (normal[2] + 1.0).abs() < 4e-3);
    assert!(at(&channels, "mean_normal_error.V", 20, 15) <= 1e-3);
    assert_eq!(at(&channels, "coverage_share.V", 20, 15), 1.0);
    assert_eq!(vector(&channels, "mean_normal", 0, 0), [0.0; 3]);
    let FlatSamples::U32(ids) = &channels["coverage_id.V"] else {
        panic!("{:?}", channels["coverage_id.V"]);
    };
    assert_eq!(
        [ids[0], ids[15 * 41 + 20], ids[15 * 41 + 35]],
        [u32::MAX, 0, 1]
    );
    for row in 0..31 {
        for col in 0..41 {
            let share = at(&channels, "coverage_share.V", col, row);
            assert_eq!(share == 0.0, ids[row * 41 + col] == u32::MAX);
        }
    }

    let output = folder.run(&format!("render balls.ron {options} -o c.npy"));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let header = |name: &str| text(&folder.read(name)[10..100]);
    assert!(header("c_channels.npy").contains("'shape': (31, 41, 6)"));
    assert!(header("c_coverage_id.npy").contains("'<u4'"));
    let array = folder.read("c_coverage_id.npy");
    let bytes: Vec<u8> = ids.iter().flat_map(|id| id.to_le_bytes()).collect();
    assert_eq!(array[array.len() - bytes.len()..], bytes[..]);
    let again = folder.run(&format!(
        "render balls.ron {options} -o c.npy --skip-existing"
    ));
    assert!(text(&again.stdout).contains(": skipped"));
}

#[test]
fn a_png_has_no_such_channels() {
    let folder = balls();
    let output = folder.run("render balls.ron -o a.png --channels depth,id");
    assert_eq!(code(&output), 2);
    let expected = "marbles: --channels is for EXR, NPY and NPZ files, but the output is PNG\n";
    assert!(
        text(&output.stderr).contains(expected),
        "{}",
        text(&output.stderr)
    );
    let output = folder.run("render balls.ron -o a.exr --channels dept");
    let errors = text(&output.stderr);
    assert!(
        errors.contains("depth, normal, position, id, albedo, mask"),
        "{errors}"
    );
}
