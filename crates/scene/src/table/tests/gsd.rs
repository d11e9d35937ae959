//! GSD: files of the package `gsd` 5.0.1, whose numbers `gsd.hoomd` reads so; damaged files.

use super::super::{Coloring, ColumnRef, Frames, Paint, Request, Value};
use super::*;

/// Three frames: the first has every kind of chunk, the second leaves all but positions to it, the third has other particles.
pub(super) const FRAMES: &[u8] = include_bytes!("../../../../../tests/seeds/tables/frames.gsd");
/// A tilted box, and one of a plane without a height, both with image flags.
const BOXES: &[u8] = include_bytes!("../../../../../tests/seeds/tables/boxes.gsd");
/// Positions alone.
const PLAIN: &[u8] = include_bytes!("../../../../../tests/seeds/tables/plain.gsd");

/// So many frames with particles at the same points, the last of which end the file.
pub(super) fn file(points: &[[f64; 3]], frames: u64) -> Vec<u8> {
    const NAMES: &[u8; 64] = b"particles/N\0particles/position\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";
    let entries = 1 + frames;
    let (index, count) = (256, points.len() as u64);
    let names = index + 32 * entries;
    let data = names + 64;
    let mut file = 0x65df_65df_65df_65df_u64.to_le_bytes().to_vec();
    for field in [index, entries, names, 1, 0x0002_0000_0001_0004] {
        file.extend(field.to_le_bytes());
    }
    file.resize(112, 0);
    file.extend(b"hoomd");
    file.resize(256, 0);
    let mut entry = |frame: u64, rows: u64, start: u64, size: u32, name: u16, kind: u8| {
        for field in [frame, rows, start] {
            file.extend(field.to_le_bytes());
        }
        file.extend(size.to_le_bytes());
        file.extend(name.to_le_bytes());
        file.extend([kind, 0]);
    };
    entry(0, 1, data, 1, 0, 4);
    for frame in 0..frames {
        entry(frame, count, data + 8 + 24 * count * frame, 3, 1, 10);
    }
    file.extend(NAMES);
    file.extend(count.to_le_bytes());
    for _ in 0..frames {
        file.extend(doubles(&points.concat()));
    }
    file
}

/// The position of a particle, by its index, at a step.
fn position(index: usize, step: usize) -> [f64; 3] {
    let i = index as f64;
    [
        0.5 * i + 0.25 + step as f64,
        -1.25 * i,
        (index % 3) as f64 + 0.125,
    ]
}

/// The frames of the bytes, as rows that are read so.
fn frames(bytes: &[u8], request: &Request) -> Result<Vec<super::super::Rows>, String> {
    let folder = Folder::new();
    let path = folder.0.join("a.gsd");
    fs::write(&path, bytes).unwrap();
    let told = |error| format!("{error:?}");
    let mut frames = Frames::open(&path, &|_, _| {}).map_err(told)?;
    let mut all = Vec::new();
    while let Some(rows) = frames.read(request).map_err(told)? {
        all.push(rows);
    }
    Ok(all)
}

#[test]
fn particles_of_all_frames_are_read() {
    let all = frames(FRAMES, &Request::default()).unwrap();
    assert_eq!(all.len(), 3);
    for (step, (rows, count)) in all.iter().zip([5, 5, 7]).enumerate() {
        let found: Vec<([f64; 3], f64)> = rows
            .spheres
            .iter()
            .map(|sphere| (sphere.center().to_array(), sphere.radius()))
            .collect();
        let radius = |index: usize| match step {
            2 => 0.5,
            _ => 0.25 + 0.125 * (index % 4) as f64,
        };
        let expected: Vec<_> = (0..count)
            .map(|index| (position(index, step), radius(index)))
            .collect();
        assert_eq!(found, expected, "step {step}");
        assert!(rows.is_right_handed);
    }
    let plain = frames(PLAIN, &Request::default()).unwrap();
    assert!(plain.len() == 1 && plain[0].spheres.iter().all(|sphere| sphere.radius() == 0.5));
}

/// The edges of the boxes are (4, 0, 0), (0.5 · 3, 3, 0) and, of the first, (0.25 · 2, −0.5 · 2, 2).
#[test]
fn boxes_are_cells() {
    let shown = |fields: &str, frame: i32| {
        let folder = Folder::new();
        fs::write(folder.0.join("a.gsd"), BOXES).unwrap();
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
             clouds: [(file: \"a.gsd\", frames: All, right_handed: false, {fields})])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
        let world = scene.world_at(frame).unwrap();
        let centers = world
            .spheres()
            .iter()
            .map(|sphere| sphere.center().to_array());
        centers.collect::<Vec<_>>()
    };
    // (1, 1, 0.5) in the cell (1, 0, −1), and (−2.5, −1, −0.75) in (0, −2, 0).
    assert_eq!(
        shown("unwrap: true", 1),
        [[4.5, 2.0, -1.5], [-5.5, -7.0, -0.75]]
    );
    assert_eq!(
        shown("unwrap: true", 2),
        [[5.0, 1.0, 0.0], [-5.5, -7.0, 0.0]]
    );
    assert_eq!(
        shown("repeat: (1, 1, 2)", 1),
        [
            [1.0, 1.0, 0.5],
            [-2.5, -1.0, -0.75],
            [1.5, 0.0, 2.5],
            [-2.0, -2.0, 1.25]
        ]
    );
    // Both are in the box around the origin already.
    let inside = [[1.0, 1.0, 0.5], [-2.5, -1.0, -0.75]];
    assert_eq!(shown("wrap: true", 1), inside);
    let refused = refusal("a.gsd", file(&[[0.0; 3]], 1), "repeat: (2, 1, 1)");
    assert!(refused.contains("a cell"), "{refused}");
}

#[test]
fn what_a_frame_leaves_out_is_that_of_the_first_or_the_default() {
    let column = |name: &str, coloring| {
        let request = Request {
            coloring: Some(coloring),
            value: Some(Value::Column(ColumnRef::Name(name.to_owned()))),
            missing: super::super::Missing::Color(DVec3::ZERO),
            ..Request::default()
        };
        let all = frames(FRAMES, &request).unwrap();
        all.into_iter().map(|rows| rows.paint).collect::<Vec<_>>()
    };
    let numbers = |name: &str| -> Vec<Vec<f64>> {
        let all = column(name, Coloring::Value).into_iter();
        all.map(|paint| match paint {
            Paint::Values(values) => values,
            other => panic!("{other:?}"),
        })
        .collect()
    };
    let velocity = vec![0.0, 2.0, 4.0, 6.0, 8.0];
    assert_eq!(
        numbers("velocity_3"),
        [velocity.clone(), velocity, vec![0.0; 7]]
    );
    let image = vec![0.0, -1.0, -2.0, -3.0, -4.0];
    assert_eq!(numbers("iz"), [image.clone(), image, vec![0.0; 7]]);
    let typeid = vec![0.0, 1.0, 2.0, 0.0, 1.0];
    assert_eq!(numbers("typeid"), [typeid.clone(), typeid, vec![0.0; 7]]);
    let energy = numbers("log/particles/energy");
    assert_eq!(energy[1], [0.0, 0.5, 1.0, 1.5, 2.0]);
    assert!(energy[2].iter().all(|value| value.is_nan()));
    for (step, paint) in column("type", Coloring::Category).into_iter().enumerate() {
        let Paint::Categories(categories) = paint else {
            panic!("categories")
        };
        let names: Vec<_> = categories
            .names
            .iter()
            .map(|name| String::from_utf8_lossy(name.as_ref()).into_owned())
            .collect();
        let expected: &[&str] = if step == 2 {
            &["A"]
        } else {
            &["A", "Bee", "C"]
        };
        assert_eq!(names, expected);
    }
}

#[test]
fn frames_are_steps_of_a_scene() {
    let folder = Folder::new();
    fs::write(folder.0.join("a.gsd"), FRAMES).unwrap();
    let text = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), \
                clouds: [(file: \"a.gsd\", frames: All, right_handed: false)])";
    let scene = Scene::parse(text, &folder.0.join("scene.ron")).unwrap();
    assert_eq!(scene.frames(), Some(1..=3));
    for step in [2, 0, 1] {
        let world = scene.world_at(step + 1).unwrap();
        let first = world.spheres()[1].center().to_array();
        assert_eq!(first, position(1, step as usize));
    }
    let first = load("a", FRAMES, "").unwrap();
    assert!(warnings(&first).contains("the first frame of several is shown"));
    let types = load("a.gsd", FRAMES, "keep: [(\"type\", Is(\"Bee\"))]").unwrap();
    assert_eq!(spheres(&types).len(), 2);
    let elements = "columns: (element: \"type\"), radius: 1, palette: {\"A\": \"#f00\", \"Bee\": \"#0f0\", \"C\": \"#00f\"}";
    assert_eq!(albedos(&load("a.gsd", FRAMES, elements).unwrap()).len(), 5);
}

#[test]
fn files_that_are_cut_or_altered_are_refused_or_read() {
    let request = Request {
        radius: Some(1.0),
        ..Request::default()
    };
    let small = file(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], 2);
    // Every byte of the small file.
    for (bytes, step) in [(&small[..], 1), (FRAMES, 17)] {
        let whole = frames(bytes, &request).unwrap();
        let spheres = |all: &[super::super::Rows]| -> Vec<Vec<Sphere>> {
            all.iter().map(|rows| rows.spheres.clone()).collect()
        };
        for end in (0..bytes.len()).step_by(step) {
            if let Ok(found) = frames(&bytes[..end], &request) {
                assert_eq!(spheres(&found), spheres(&whole), "cut at byte {end}");
            }
        }
        for at in (0..bytes.len()).step_by(step) {
            let mut altered = bytes.to_vec();
            altered[at] ^= 1 << (at % 8);
            let found = frames(&altered, &request).unwrap_or_default();
            let counts = found.iter().map(|rows| rows.spheres.len());
            assert!(counts.max() <= Some(131_072), "altered at byte {at}");
        }
    }
}

#[test]
fn what_is_no_gsd_file_of_hoomd_is_refused() {
    let altered = |at: usize, bytes: &[u8]| {
        let mut file = FRAMES.to_vec();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        refusal("a.gsd", file, "")
    };
    let mut swapped = FRAMES[..8].to_vec();
    swapped.reverse();
    for (message, expected) in [
        (
            altered(0, &swapped),
            "expected a GSD file of little-endian numbers, found another file",
        ),
        (
            altered(112, b"other\0"),
            "expected the schema \"hoomd\", found `other`",
        ),
        (
            altered(16, &[0xff; 8]),
            "expected 18446744073709551615 entries of 32 bytes in the index",
        ),
        (
            refusal("a.gsd", &FRAMES[..100], ""),
            "expected a header of 256 bytes, found 100",
        ),
        (refusal("a.gsd", "1 2 3\n", ""), "expected a GSD file"),
        (
            refusal("a.gsd.gz", super::compressed::gzip(FRAMES), ""),
            "expected an uncompressed GSD file",
        ),
    ] {
        assert!(message.contains(expected), "{message}");
    }
    // The radius of the second particle of the first frame.
    let sizes: Vec<u8> = [0.5_f32, 0.75, 1.0, 1.25, 0.5]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let start = memchr::memmem::find(FRAMES, &sizes).unwrap();
    assert_eq!(
        altered(start + 4, &(-1.0_f32).to_le_bytes()),
        format!(
            "a.gsd: row 2, column 6, byte {}: expected a radius greater than 0 for `diameter`, found -1",
            start + 4
        )
    );
    let types: Vec<u8> = [0_u32, 1, 2, 0, 1]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let start = memchr::memmem::find(FRAMES, &types).unwrap();
    let mut file = FRAMES.to_vec();
    file[start + 4] = 9;
    assert!(
        refusal("a.gsd", file, "value: \"type\"")
            .contains("expected the number of one of 3 types, from 0, for the particle 2, found 9")
    );
}
