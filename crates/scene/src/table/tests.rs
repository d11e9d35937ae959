//! Tables of every format, good and bad, read by way of a scene.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::{env, fs, process};

use glam::DVec3;
use marbles_core::{Color, Sphere};

use self::ply::binary_ply;
use super::Colormap;
use crate::Scene;
use crate::values::from_srgb;

mod atoms;
mod cells;
mod cells_refused;
mod collections;
mod colors;
mod compressed;
mod contents;
mod crystals;
mod csv;
mod cut;
mod elements;
mod foreign;
mod formats;
mod gsd;
mod hands;
mod lammps_data;
mod left_out;
mod matrix;
mod misread;
mod molecules;
mod npy;
mod operations;
mod ply;
mod poscars;
mod rows;
mod topologies;
mod trajectories;
mod vtk;
mod vtk_xml;
mod xyz;

/// A folder that is gone after the test.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = env::temp_dir().join(format!("marbles-tables-{}-{number}", process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The scene with a cloud whose table is called `name` and holds `bytes`.
///
/// Its numbers are those of the table, whatever the hands of the format.
fn load(name: &str, bytes: impl AsRef<[u8]>, fields: &str) -> Result<Scene, String> {
    let comma = if fields.is_empty() { "" } else { ", " };
    load_as_it_is(name, bytes, &format!("{fields}{comma}right_handed: false"))
}

/// The same with the hands of the format.
fn load_as_it_is(name: &str, bytes: impl AsRef<[u8]>, fields: &str) -> Result<Scene, String> {
    let folder = Folder::new();
    fs::write(folder.0.join(name), bytes).unwrap();
    let text = format!(
        "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),\nclouds: [(file: \"{name}\", \
         {fields})])"
    );
    let path = folder.0.join("scene.ron");
    Scene::parse(&text, &path).map_err(|error| {
        let folder = format!("{}{}", folder.0.display(), std::path::MAIN_SEPARATOR);
        error.to_string().replace(&folder, "")
    })
}

fn scene(name: &str, bytes: impl AsRef<[u8]>, fields: &str) -> Scene {
    load(name, bytes, fields).unwrap_or_else(|message| panic!("{message}"))
}

/// The warnings about a scene and its table, one behind another, without the folder.
fn warnings(scene: &Scene) -> String {
    let folder = |text: &str| {
        let end = text.find("/marbles-tables-").map(|at| at + 1);
        let end = end.and_then(|at| text[at..].find('/').map(|slash| at + slash + 1));
        text[end.unwrap_or(0)..].to_owned()
    };
    let told: Vec<String> = scene.warnings().iter().map(|text| folder(text)).collect();
    told.join("\n")
}

/// Centers and radii.
fn spheres(scene: &Scene) -> Vec<[f64; 4]> {
    let numbers = |sphere: &Sphere| sphere.center().extend(sphere.radius()).to_array();
    scene.world().spheres().iter().map(numbers).collect()
}

fn albedos(scene: &Scene) -> Vec<Color> {
    let world = scene.world();
    (0..world.spheres().len())
        .map(|index| world.albedo(index))
        .collect()
}

/// The first line of the message that refuses a table.
fn refusal(name: &str, bytes: impl AsRef<[u8]>, fields: &str) -> String {
    let message = load(name, bytes, fields).expect_err("a bad table");
    message.lines().next().unwrap().to_owned()
}

/// A file in the format NPY.
fn npy(header: &str, numbers: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(numbers);
    bytes
}

fn doubles(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

const TWO: [[f64; 4]; 2] = [[1.0, -2.5, 3e-3, 0.5], [4.0, 5.0, 6.0, 7.0]];

#[test]
fn any_byte_of_a_table_may_be_another_one() {
    let csv = b"x,y,z,r,g,b,radius\n1,2,3,\"4\",5,6,7\n1,2,3,4,5,6,7\n".to_vec();
    let xyz = b"2\nProperties=species:S:1:pos:R:3:f:R:2\nO 1 2 3 4 5\nH 1 2 3 4 5\n".to_vec();
    let header = "{'descr': [('x', '<f4'), ('y', '<f8'), ('z', '<f8'), ('r', '|u1')], \
                  'fortran_order': False, 'shape': (2,)}";
    let numbers = [1_u8; 42];
    for (name, good) in [
        ("a.csv", csv),
        ("a.xyz", xyz),
        ("a.ply", binary_ply()),
        ("a.npy", npy(header, &numbers)),
    ] {
        let folder = Folder::new();
        let path = folder.0.join(name);
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [(file: \"{name}\")])"
        );
        let check = |bytes: &[u8]| {
            // A new file is written sooner than an old one is replaced.
            let _ = fs::remove_file(&path);
            fs::write(&path, bytes).unwrap();
            if let Err(error) = Scene::parse(&text, &folder.0.join("scene.ron")) {
                let fault = &error.faults()[0];
                assert!(fault.message.starts_with("expected "), "{}", fault.message);
                assert!(fault.message.contains("found "), "{}", fault.message);
                assert!(!fault.message.contains('\n'), "{}", fault.message);
                assert!(fault.line >= 1 && fault.column >= 1);
            }
        };
        for at in 0..good.len() {
            check(&good[..at]);
            for other in [b'\n', b'9', b'-', b'"', 0xff] {
                let mut bytes = good.clone();
                bytes[at] = other;
                check(&bytes);
            }
        }
    }
}

#[test]
fn what_is_no_table_is_refused_where_it_is_named() {
    let folder = Folder::new();
    fs::write(folder.0.join("argon.xyz"), "1\n\nAr 0 0 0\n").unwrap();
    fs::create_dir(folder.0.join("folder.csv")).unwrap();
    let path = folder.0.join("scene.ron");
    let refusal = |cloud: &str| {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),\nclouds: [({cloud})])"
        );
        let error = Scene::parse(&text, &path).unwrap_err();
        assert_eq!(error.path(), path);
        let fault = &error.faults()[0];
        format!("{}:{}: {}", fault.line, fault.column, fault.message)
    };
    for (cloud, expected) in [
        (
            "file: \"argn.xyz\"",
            "2:17: expected a table, found no file \"argn.xyz\", did you mean \"argon.xyz\"?",
        ),
        (
            "file: \"a/b.csv\"",
            "2:17: expected a table, found no file \"a/b.csv\"",
        ),
        (
            "file: \"folder.csv\"",
            "2:17: expected a table, found the folder \"folder.csv\"",
        ),
        (
            "file: \"argon.pdb\"",
            "2:17: expected a table, found no file \"argon.pdb\", did you mean \"argon.xyz\"?",
        ),
        (
            "file: \"argon.xyz\", color: Element, colormap: Viridis",
            "2:56: expected `color: Value` together with this, found `color: Element`",
        ),
        (
            "file: \"argon.xyz\", scale: 1e300, position: (1e308, 0, 0), radius: 1e200",
            "2:17: expected finite spheres with radii greater than 0 after `scale`, `rotate_degrees` and `position`, found others",
        ),
        (
            "file: \"argon.xyz\", raduis: 3",
            "2:30: expected a field of this cloud, found `raduis`, did you mean `radius`?",
        ),
        (
            "file: \"argon.xyz\", colormap: Viridi",
            "2:40: expected a colormap (`Viridis`, `Inferno`, `Magma`, `Plasma`, `Cividis`, `CoolWarm` or `Grey`), found `Viridi`, did you mean `Viridis`?",
        ),
        (
            "file: \"argon.xyz\", range: (2, 1)",
            "2:37: expected a low number that is less than the high one, found `(2, 1)`",
        ),
        (
            "file: \"argon.xyz\", material: \"gold\"",
            "2:40: expected the name of a material (the scene has no materials), found \"gold\"",
        ),
        (
            "radius: 1",
            "2:10: expected `file` in this cloud, found none",
        ),
    ] {
        assert_eq!(refusal(cloud), expected);
    }
}

#[test]
fn clouds_come_behind_the_spheres_in_the_order_of_the_file() {
    let folder = Folder::new();
    fs::write(folder.0.join("a.xyz"), "2\n\nAr 0 0 1\nAr 0 0 2\n").unwrap();
    fs::write(folder.0.join("b.csv"), "x,y,z,r,value\n0,0,3,1,7\n").unwrap();
    let text = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
        materials: {\"dark\": (albedo: 0.125, exponent: 2)},
        clouds: [(file: \"a.xyz\", material: \"dark\"), (file: \"b.csv\", material: \"dark\",
                  colormap: Grey, scale: 2, position: (0, 0, 1))],
        spheres: [(center: (0, 0, 0), radius: 1)])";
    let scene = Scene::parse(text, &folder.0.join("scene.ron")).unwrap();
    let depths: Vec<f64> = spheres(&scene).iter().map(|sphere| sphere[2]).collect();
    // Atoms have right-handed axes.
    assert_eq!(depths, [0.0, -1.0, -2.0, 7.0]);
    let clouds: Vec<_> = scene
        .clouds()
        .iter()
        .map(|cloud| cloud.spheres.clone())
        .collect();
    assert_eq!(clouds, [1..3, 3..4]);
    let argon = from_srgb(0x80d1e3);
    assert_eq!(
        albedos(&scene),
        [Color::ONE, argon, argon, from_srgb(0x808080)]
    );
    assert_eq!(scene.world().material(3).exponent, 2.0);
}

#[test]
fn reading_tells_how_far_it_is() {
    const ROWS: usize = 300_000;
    let folder = Folder::new();
    let text = "x,y,z\n".to_owned() + &"100000,200000,300000\n".repeat(ROWS);
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({ROWS}, 3), }}\n");
    let array = npy(&header, &doubles(&vec![1.0; 3 * ROWS]));
    for (name, bytes) in [("a.csv", text.into_bytes()), ("a.npy", array)] {
        fs::write(folder.0.join(name), &bytes).unwrap();
        let scene = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),\n\
             clouds: [(file: \"{name}\", radius: 1)])"
        );
        let path = folder.0.join("scene.ron");
        fs::write(&path, scene).unwrap();
        let told = Mutex::new(Vec::new());
        let scene = Scene::load_with(&path, &[], &|progress| {
            assert_eq!(progress.table, Path::new(name));
            assert_eq!(progress.size, bytes.len() as u64);
            told.lock().unwrap().push(progress.read);
        });
        assert_eq!(scene.unwrap().world().spheres().len(), ROWS);
        let told = told.into_inner().unwrap();
        assert!(told.is_sorted() && told.last() == Some(&(bytes.len() as u64)));
        // In megabytes, so that telling costs nothing.
        assert!((3..30).contains(&told.len()), "{}", told.len());
    }
}

/// Products of numbers in a header have a limit before memory is taken for them.
#[test]
fn headers_do_not_multiply() {
    let fields: String = (0..11)
        .map(|field| format!("('f{field}', '|V0', (1000,)), "))
        .collect();
    let header = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': (2,)}}");
    let expected = "a.npy: expected at most 10000 values in a record, found more";
    assert_eq!(refusal("a.npy", npy(&header, &[]), ""), expected);
    let properties: Vec<String> = (0..11).map(|field| format!("f{field}:R:1000")).collect();
    let text = format!("1\nProperties={}\nO 1 2 3\n", properties.join(":"));
    let expected = "a.xyz:2:12: expected at most 10000 columns, found more";
    assert_eq!(refusal("a.xyz", text, ""), expected);
}

/// Letters of two bytes are no elements, alone or beside others.
#[test]
fn elements_of_other_alphabets_are_none() {
    for name in ["\u{e9}", "\u{e9}C"] {
        let told = warnings(&scene("a.xyz", format!("1\n\n{name} 1 2 3\n"), ""));
        assert!(told.starts_with("a.xyz:3:1: expected"), "{told}");
        let csv = format!("element,x,y,z\n{name},1,2,3\n");
        let told = warnings(&scene("a.csv", csv, ""));
        assert!(told.starts_with("a.csv:2:1: expected"), "{told}");
    }
}
