//! Tables of every format, good and bad, read by way of a scene.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::{env, fs, process};

use glam::DVec3;
use marbles_core::{Color, Sphere};

use super::Colormap;
use crate::Scene;
use crate::color::from_srgb;

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
fn load(name: &str, bytes: impl AsRef<[u8]>, fields: &str) -> Result<Scene, String> {
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
fn csv_is_read() {
    for text in [
        "x,y,z,radius\n1,-2.5,3e-3,.5\n4,5,6,7\n",
        "x,y,z,radius\r\n1,-2.5,3e-3,0.5\r\n4,5,6,7",
        "\u{feff}# Z ; name; X;Y ;R\n0.003; \"a;b\" ;\"1\"; -2.5 ;0.5\n\n6;;+4.0;5;7\n \n",
        "x\ty\tz\tr\n1\t-2.5\t0.003\t5e-1\n4\t5\t6\t7",
    ] {
        let scene = scene("a.csv", text, "");
        assert_eq!(spheres(&scene), TWO, "{text}");
        assert_eq!(albedos(&scene), [Color::ONE; 2]);
        assert_eq!(scene.clouds()[0].spheres, 0..2);
    }
    assert!(spheres(&scene("a.csv", "x,y,z,r\n", "")).is_empty());
}

#[test]
fn csv_is_refused_at_its_place() {
    for (text, expected) in [
        (
            "",
            "a.csv:1:1: expected a line with the names of the columns, found the end of the file",
        ),
        (
            "\n1,2",
            "a.csv:1:1: expected a line with the names of the columns, found the end of the line",
        ),
        (
            "1,2,3\n",
            "a.csv:1:1: expected a column `x`, found `1`, `2`, `3`",
        ),
        (
            "x,y,zz\n",
            "a.csv:1:1: expected a column `z`, found `x`, `y`, `zz`",
        ),
        (
            "x,y,z\n",
            "a.csv:1:1: expected a column `radius`, or else `radius: …` in the scene, found `x`, `y`, `z`",
        ),
        (
            "x,y,z,X,r\n",
            "a.csv:1:1: expected every column once, found `x` a second time",
        ),
        (
            "x,y,z,r\n1,2,3,4\n1,2,3\n",
            "a.csv:3:6: expected a number for `r`, found the end of the line",
        ),
        (
            "x,y,z,r\n1,2,3,4\n1,2,3,4,5\n",
            "a.csv:3:9: expected the end of the line after 4 columns, found 5",
        ),
        (
            "x,y,z,r\n1,,3,4\n",
            "a.csv:2:3: expected a number for `y`, found nothing",
        ),
        (
            "x,y,z,r\n1,ä,b,4\n",
            "a.csv:2:3: expected a number for `y`, found `ä`",
        ),
        (
            "n,x,y,z,r\nä,1,b,3,4\n",
            "a.csv:2:5: expected a number for `y`, found `b`",
        ),
        (
            "x,y,z,r\n1,2,NaN,4\n",
            "a.csv:2:5: expected a finite number for `z`, found NaN",
        ),
        (
            "x,y,z,r\n1,2,-inf,4\n",
            "a.csv:2:5: expected a finite number for `z`, found -inf",
        ),
        (
            "x,y,z,r\n1,2,1e999,4\n",
            "a.csv:2:5: expected a finite number for `z`, found 1e999",
        ),
        (
            "x,y,z,r\n1,2,3,0\n",
            "a.csv:2:7: expected a radius greater than 0 for `r`, found 0",
        ),
        (
            "x,y,z,r\n1,2,3,-1\r\n",
            "a.csv:2:7: expected a radius greater than 0 for `r`, found -1",
        ),
        (
            "x,y,z,radius,r,g,b\n1,2,3,4,0,1,-0.5\n",
            "a.csv:2:13: expected a color channel of at least 0 for `b`, found -0.5",
        ),
    ] {
        assert_eq!(refusal("a.csv", text, ""), expected);
    }
    let broken = [b"x,y,z,r\n1,2,".as_slice(), &[0xff, b',', b'4', b'\n']].concat();
    let expected = "a.csv:2:5: expected a number for `z`, found `\u{fffd}`";
    assert_eq!(refusal("a.csv", broken, ""), expected);
    assert_eq!(
        refusal("a.csv", "x,y,z,energy\n", "radius: 1, value: \"energie\""),
        "a.csv:1:1: expected a column `energie`, found `x`, `y`, `z`, `energy`, did you mean `energy`?"
    );
    let long = format!("x,y,z,r\n{}", "1".repeat(5 << 20));
    let expected = "a.csv:2:1: expected a line of at most 1 MiB, found a longer one";
    assert_eq!(refusal("a.csv", long, ""), expected);
}

#[test]
fn a_message_shows_the_line_and_who_names_the_table() {
    let message = load("a.csv", "x,y,z,r\n1,2,3,4\n1,abc,3,4\n", "").unwrap_err();
    let expected = "a.csv:3:3: expected a number for `y`, found `abc`
  |
3 | 1,abc,3,4
  |   ^^^
the table is named at scene.ron:2:17";
    assert_eq!(message, expected);
}

#[test]
fn many_rows_come_in_their_order_and_the_first_fault_is_told() {
    let row = |index: usize| format!("{index},{},0,1\n", index * index);
    let rows: Vec<String> = (0..400_000).map(row).collect();
    let good = format!("x,y,z,r\n{}", rows.concat());
    assert!(good.len() > 6_000_000);
    let found = spheres(&scene("a.csv", &good, ""));
    assert_eq!(found.len(), 400_000);
    for (index, sphere) in found.iter().enumerate() {
        let x = index as f64;
        assert_eq!(*sphere, [x, x * x, 0.0, 1.0]);
    }
    for bad in [399_999, 300_000, 123_456] {
        let mut rows = rows.clone();
        rows[399_999] = String::from("nobody\n");
        rows[bad] = String::from("1,2,3,z\n");
        let expected = format!("a.csv:{}:7: expected a number for `r`, found `z`", bad + 2);
        let text = format!("x,y,z,r\n{}", rows.concat());
        assert_eq!(refusal("a.csv", text, ""), expected);
    }
}

#[test]
fn columns_of_colors_are_linear_numbers() {
    let text = "x,y,z,radius,r,g,b\n0,0,0,1,0.25,0.5,2\n";
    assert_eq!(
        albedos(&scene("a.csv", text, "")),
        [Color::new(0.25, 0.5, 2.0)]
    );
    assert_eq!(
        albedos(&scene("a.csv", text, "color: Material")),
        [Color::ONE]
    );
    let message = refusal("a.csv", "x,y,z\n", "radius: 1, color: Table");
    assert_eq!(
        message,
        "a.csv:1:1: expected a column `red`, found `x`, `y`, `z`"
    );
}

#[test]
fn numbers_become_colors_of_a_colormap() {
    let text = "x,y,z,r,energy\n0,0,5,1,-1\n1,0,6,1,0\n1,0,7,1,1\n";
    let viridis = Colormap::Viridis.colors();
    let found = albedos(&scene("a.csv", text, "value: \"energy\""));
    assert_eq!(found, [viridis[0], viridis[128], viridis[255]]);
    let magma = Colormap::Magma.colors();
    let fields = "value: \"energy\", colormap: Magma, range: (0, 2)";
    let found = albedos(&scene("a.csv", text, fields));
    assert_eq!(found, [magma[0], magma[0], magma[128]]);
    // A column that is used otherwise, too; and the default name.
    let found = albedos(&scene("a.csv", text, "value: \"z\", colormap: Grey"));
    assert_eq!(found, [0x000000, 0x808080, 0xffffff].map(from_srgb));
    let renamed = text.replace("energy", "value");
    let found = albedos(&scene("a.csv", renamed, "colormap: Viridis"));
    assert_eq!(found, [viridis[0], viridis[128], viridis[255]]);
}

#[test]
fn xyz_is_read() {
    let text = " 2 \r\nwater\nO 1 -2.5 3e-3 0.7 more\n  h\t4  5 6\n2\nthe next frame\nX\n";
    let scene = scene("a.xyz", text, "");
    let [oxygen, hydrogen] = TWO.map(|[x, y, z, _]| [x, y, z]);
    let expected = [
        [oxygen[0], oxygen[1], oxygen[2], 1.52],
        [hydrogen[0], hydrogen[1], hydrogen[2], 1.1],
    ];
    assert_eq!(spheres(&scene), expected);
    assert_eq!(albedos(&scene), [from_srgb(0xff0d0d), Color::ONE]);
    let covalent = self::scene("a.xyz", text, "radii: Covalent");
    assert_eq!(spheres(&covalent)[0][3], 0.66);
    let fixed = self::scene("a.xyz", text, "radius: 3, color: Material");
    assert_eq!(spheres(&fixed)[0][3], 3.0);
    assert_eq!(albedos(&fixed)[0], Color::ONE);
    // What is no element does where none is needed.
    let beads = self::scene("a.xyz", "1\n\nbead 1 2 3\n", "radius: 3, color: Material");
    assert_eq!(spheres(&beads), [[1.0, 2.0, 3.0, 3.0]]);
    assert!(spheres(&self::scene("a.xyz", "0\n\n", "")).is_empty());
}

#[test]
fn a_material_keeps_its_color_unless_elements_are_asked_for() {
    let folder = Folder::new();
    fs::write(folder.0.join("a.xyz"), "1\n\nO 1 2 3").unwrap();
    for (fields, expected) in [("", 0x102030), (", color: Element", 0xff0d0d)] {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), materials: {{\"m\": \
             (albedo: \"#102030\")}}, clouds: [(file: \"a.xyz\", material: \"m\"{fields})])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
        assert_eq!(albedos(&scene), [from_srgb(expected)]);
    }
}

#[test]
fn extended_xyz_is_read() {
    let text = "2\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=id:I:1:species:S:1:pos:R:3:force:R:2:\
                radius:R:1:color:R:3 Time=0\n7 A 1 -2.5 3e-3 9 9 0.5 1 0.5 0\n\
                8 B 4 5 6 9 8 7 0 0 1\n";
    let scene = scene("a.xyz", text, "");
    assert_eq!(spheres(&scene), TWO);
    assert_eq!(albedos(&scene), [Color::new(1.0, 0.5, 0.0), Color::Z]);
    let by_force = self::scene("a.extxyz", text, "value: \"force_2\", colormap: Grey");
    assert_eq!(albedos(&by_force), [Color::ONE, Color::ZERO]);
    let elements = "1\nProperties=species:S:1:pos:R:3\nAr 0 0 0\n";
    assert_eq!(spheres(&self::scene("a.xyz", elements, ""))[0][3], 1.88);
}

#[test]
fn xyz_is_refused_at_its_place() {
    for (text, expected) in [
        (
            "",
            "a.xyz:1:1: expected the number of atoms, found the end of the file",
        ),
        (
            "\n",
            "a.xyz:1:1: expected the number of atoms, found the end of the line",
        ),
        (
            " two\n",
            "a.xyz:1:2: expected the number of atoms, found `two`",
        ),
        ("-2\n", "a.xyz:1:1: expected the number of atoms, found -2"),
        (
            "2\n",
            "a.xyz:2:1: expected a comment, found the end of the file",
        ),
        (
            "3\n\nO 1 2 3\nO 1 2 3\n",
            "a.xyz:5:1: expected 3 atoms, as the first line says, and after 2 of them another, found the end of the file",
        ),
        (
            "18446744073709551615\n\nO 1 2 3\n",
            "a.xyz:4:1: expected 18446744073709551615 atoms, as the first line says, and after 1 of them another, found the end of the file",
        ),
        (
            "2\n\nO 1 2 3\n\nO 1 2 3\n",
            "a.xyz:4:1: expected an element for `element`, found the end of the line",
        ),
        (
            "1\n\nO 1 2  \n",
            "a.xyz:3:6: expected a number for `z`, found the end of the line",
        ),
        (
            "1\n\nO 1 x 3\n",
            "a.xyz:3:5: expected a number for `y`, found `x`",
        ),
        (
            "1\n\nC1 1 2 3\n",
            "a.xyz:3:1: expected the symbol of an element, found `C1`, did you mean `C`?",
        ),
        (
            "1\n\nbead 1 2 3\n",
            "a.xyz:3:1: expected the symbol of an element, found `bead` (with `radius: …` and `color: Material` none is needed)",
        ),
        (
            "1\n\nOg 1 2 3\n",
            "a.xyz:3:1: expected an element whose radius is known, found `Og`",
        ),
        (
            "1\nProperties=species:S:1:pos:R\n",
            "a.xyz:2:12: expected properties `name:type:columns`, of type S, R, I or L, found `pos:R`",
        ),
        (
            "1\nProperties=species:S:1:pos:R:99999999999\n",
            "a.xyz:2:12: expected properties `name:type:columns`, of type S, R, I or L, found `pos:R:99999999999`",
        ),
        (
            "1\nProperties=species:S:1\n",
            "a.xyz:2:1: expected a column `x`, found `species`",
        ),
        (
            "1\nProperties=species:S:1:pos:R:3\nO 1 2 3 4\n",
            "a.xyz:3:9: expected the end of the line after 4 columns, found 4",
        ),
    ] {
        assert_eq!(refusal("a.xyz", text, ""), expected);
    }
}

const PLY_FIELDS: &str = "comment by hand
element vertex 2
property float x
property float y
property double z
property float32 radius
property uchar red
property uint8 green
property uchar blue
property short charge
element face 1
property list uchar int vertex_indices
end_header
";

/// The rows of [`TWO`], colored.
fn ply_rows() -> Vec<u8> {
    let mut bytes = Vec::new();
    for ([x, y, z, radius], color) in TWO.iter().zip([[255, 0, 128], [1, 2, 3]]) {
        bytes.extend(floats(&[*x as f32, *y as f32]));
        bytes.extend(doubles(&[*z]));
        bytes.extend(floats(&[*radius as f32]));
        bytes.extend(color);
        bytes.extend((-3_i16).to_le_bytes());
    }
    bytes
}

fn binary_ply() -> Vec<u8> {
    let header = format!("ply\nformat binary_little_endian 1.0\n{PLY_FIELDS}");
    let mut bytes = header.into_bytes();
    bytes.extend(ply_rows());
    bytes
}

#[test]
fn ply_is_read() {
    let text = format!(
        "ply\nformat ascii 1.0\n{PLY_FIELDS}1 -2.5 3e-3 0.5 255 0 128 -3\n4 5 6 7 1 2 3 -3\n3 0 1 2\n"
    );
    let windows = text.replace('\n', "\r\n");
    for bytes in [text.into_bytes(), windows.into_bytes(), binary_ply()] {
        let scene = scene("a.ply", bytes, "");
        assert_eq!(spheres(&scene), TWO);
        let expected = [0xff0080, 0x010203].map(from_srgb);
        for (found, expected) in albedos(&scene).into_iter().zip(expected) {
            assert!((found - expected).abs().max_element() < 1e-7);
        }
    }
    let scene = scene("a.ply", binary_ply(), "value: \"charge\", radius: 2");
    let middle = Colormap::Viridis.colors()[128];
    assert_eq!(albedos(&scene), [middle; 2]);
    assert_eq!(spheres(&scene)[0][3], 2.0);
}

#[test]
fn ply_is_refused_at_its_place() {
    for (text, expected) in [
        ("", "a.ply:1:1: expected `ply`, found the end of the file"),
        (
            "plyx\n",
            "a.ply:1:1: expected `ply`, with which PLY files start, found `plyx`",
        ),
        (
            "ply\n",
            "a.ply:2:1: expected `end_header`, found the end of the file",
        ),
        (
            "ply\nformat binary_big_endian 1.0\n",
            "a.ply:2:8: expected `ascii 1.0` or `binary_little_endian 1.0`, found `binary_big_endian`",
        ),
        (
            "ply\nelement face 3\n",
            "a.ply:2:9: expected the element `vertex` before all others, found `face`",
        ),
        (
            "ply\nelement vertex -3\n",
            "a.ply:2:16: expected the number of vertices, found -3",
        ),
        (
            "ply\nelement vertex 3\nproperty list uchar int x\n",
            "a.ply:3:10: expected a number as the property of a vertex, found `list`",
        ),
        (
            "ply\nelement vertex 3\nproperty flat x\n",
            "a.ply:3:10: expected a type (`char`, `uchar`, `short`, `ushort`, `int`, `uint`, `float` or `double`), found `flat`",
        ),
        (
            "ply\nend_header\n",
            "a.ply:2:1: expected a line `format …` before, found `end_header`",
        ),
        (
            "ply\nformat ascii 1.0\nend_header\n",
            "a.ply:3:1: expected a line `element vertex …` before, found `end_header`",
        ),
        (
            "ply\nvertices\n",
            "a.ply:2:1: expected `element …`, `property …`, `comment …` or `end_header`, found `vertices`",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
            "a.ply:5:1: expected a column `y`, found `x`",
        ),
    ] {
        assert_eq!(refusal("a.ply", text, ""), expected);
    }
    let head = format!("ply\nformat ascii 1.0\n{PLY_FIELDS}");
    let rows = "1 2 3 4 5 6 7 8\n";
    for (body, expected) in [
        (
            String::from(rows),
            "a.ply:17:1: expected 2 vertices, as the header says, and after 1 of them another, found the end of the file",
        ),
        (
            format!("{rows}1 2 3 4 5 6 256 8\n"),
            "a.ply:17:13: expected a whole number from 0 to 255 for `blue`, found 256",
        ),
        (
            format!("{rows}1 2 3 4 5 6\n"),
            "a.ply:17:12: expected a number for `blue`, found the end of the line",
        ),
    ] {
        assert_eq!(refusal("a.ply", format!("{head}{body}"), ""), expected);
    }
}

#[test]
fn binary_ply_is_refused_by_row_and_byte() {
    let good = binary_ply();
    let start = good.len() - 2 * 25;
    let cut = &good[..good.len() - 1];
    assert_eq!(
        refusal("a.ply", cut, ""),
        "a.ply: expected 2 vertices of 25 bytes, 50 bytes in all, found 49"
    );
    let mut bad = good.clone();
    let at = start + 25 + 16;
    bad[at..at + 4].copy_from_slice(&0_f32.to_le_bytes());
    let expected = format!(
        "a.ply: row 2, column 4, byte {at}: expected a radius greater than 0 for `radius`, found 0"
    );
    assert_eq!(refusal("a.ply", bad, ""), expected);
    let text = String::from_utf8_lossy(&good[..start]).into_owned();
    for (count, size) in [
        ("99999999999", "2499999999975"),
        ("18446744073709551615", "461168601842738790375"),
    ] {
        let header = text.replace("vertex 2", &format!("vertex {count}"));
        let expected =
            format!("a.ply: expected {count} vertices of 25 bytes, {size} bytes in all, found 0");
        assert_eq!(refusal("a.ply", header, ""), expected);
    }
}

#[test]
fn npy_is_read() {
    let flat = TWO.concat();
    let single: Vec<f32> = flat.iter().map(|x| *x as f32).collect();
    let columns: Vec<f64> = (0..4)
        .flat_map(|column| TWO.map(|row| row[column]))
        .collect();
    let header = |descr: &str, order: &str, shape: &str| {
        format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}   \n")
    };
    for bytes in [
        npy(&header("'<f8'", "False", "(2, 4)"), &doubles(&flat)),
        npy(&header("'<f8'", "True", "(2, 4)"), &doubles(&columns)),
    ] {
        assert_eq!(spheres(&scene("a.npy", bytes, "")), TWO);
    }
    let bytes = npy(&header("'<f4'", "False", "(2, 4)"), &floats(&single));
    for (found, expected) in spheres(&scene("a.npy", bytes, "")).iter().zip(TWO) {
        assert_eq!(*found, expected.map(|x| f64::from(x as f32)));
    }
    let three = npy(
        &header("'<f8'", "False", "(1, 3)"),
        &doubles(&[1.0, 2.0, 3.0]),
    );
    assert_eq!(
        spheres(&scene("a.npy", three, "radius: 4")),
        [[1.0, 2.0, 3.0, 4.0]]
    );
    let seven = [1.0, 2.0, 3.0, 4.0, 0.25, 0.5, 1.0];
    let seven = scene(
        "a.npy",
        npy(&header("'<f8'", "False", "(1, 7)"), &doubles(&seven)),
        "",
    );
    assert_eq!(albedos(&seven), [Color::new(0.25, 0.5, 1.0)]);
    let five = [0.0, 0.0, 0.0, 1.0, 10.0, 0.0, 0.0, 0.0, 1.0, 20.0];
    let five = npy(&header("'<f8'", "False", "(2, 5)"), &doubles(&five));
    let five = scene("a.npy", five, "colormap: Grey");
    assert_eq!(albedos(&five), [Color::ZERO, Color::ONE]);
}

#[test]
fn npy_of_records_is_read() {
    let header = "{'descr': [('name', '<U2'), ('pos', '<f4', (3,)), ('radius', '<f8'), \
                  ('rgb', '|u1', (3,)), ('element', '<i4')], 'fortran_order': False, 'shape': (1,)}";
    let mut row = vec![b'x'; 8];
    row.extend(floats(&[1.0, 2.0, 3.0]));
    row.extend(doubles(&[4.0]));
    row.extend([255, 0, 255]);
    row.extend(18_i32.to_le_bytes());
    let scene = scene("a.npy", npy(header, &row), "");
    assert_eq!(spheres(&scene), [[1.0, 2.0, 3.0, 4.0]]);
    assert_eq!(albedos(&scene), [Color::new(1.0, 0.0, 1.0)]);
    let argon = self::scene("a.npy", npy(header, &row), "color: Element");
    assert_eq!(albedos(&argon), [from_srgb(0x80d1e3)]);
    let header = header.replace("'radius'", "'charge'");
    let argon = self::scene("a.npy", npy(&header, &row), "");
    assert_eq!(spheres(&argon), [[1.0, 2.0, 3.0, 1.88]]);
    let at = row.len() - 4;
    for (number, expected) in [
        (118, "an element whose radius is known"),
        (119, "the number of an element, from 1 to 118 for `element`"),
    ] {
        row[at] = number;
        let bytes = npy(&header, &row);
        let byte = bytes.len() - 4;
        let expected =
            format!("a.npy: row 1, column 9, byte {byte}: expected {expected}, found {number}");
        assert_eq!(refusal("a.npy", bytes, ""), expected);
    }
}

#[test]
fn npy_is_refused() {
    let header = |descr: &str, shape: &str| {
        format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}")
    };
    let f8 = |shape: &str| header("'<f8'", shape);
    let cases = [
        (
            Vec::new(),
            "expected an NPY file, which starts with \\x93NUMPY, found ``",
        ),
        (
            b"PK\x03\x04".to_vec(),
            "expected an NPY file, which starts with \\x93NUMPY, found `PK\\u{3}\\u{4}`",
        ),
        (
            b"\x93NUMPY\x09\x00\x00\x00".to_vec(),
            "expected version 1, 2 or 3 of the format, found 9",
        ),
        (
            b"\x93NUMPY\x01\x00\xff\x00{}".to_vec(),
            "expected a header, found the end of the file",
        ),
        (
            b"\x93NUMPY\x02\x00\xff\xff\xff\xff{}".to_vec(),
            "expected a header of at most 1 MiB, found 4294967295 bytes",
        ),
        (
            npy("{'descr'", &[]),
            "expected a header that describes an array, found `{'descr'`",
        ),
        (
            npy("{}", &[]),
            "expected `descr`, `fortran_order` and `shape` in the header, found `{}`",
        ),
        (
            npy(&header("'>f8'", "(1, 3)"), &[]),
            "expected numbers of type `<f4` or `<f8`, found `>f8`",
        ),
        (
            npy(&f8("(10, 2)"), &[]),
            "expected an array of shape (rows, 3), (rows, 4), (rows, 5) or (rows, 7), found (10, 2)",
        ),
        (
            npy(&f8("(10,)"), &[]),
            "expected an array of shape (rows, 3), (rows, 4), (rows, 5) or (rows, 7), found (10)",
        ),
        (
            npy(&f8("(3, 4)"), &[0; 95]),
            "expected 3 rows of 32 bytes, 96 bytes in all, found 95",
        ),
        (
            npy(&f8("(18446744073709551615, 4)"), &[0; 95]),
            "expected 18446744073709551615 rows of 32 bytes, 590295810358705651680 bytes in all, found 95",
        ),
        (
            npy(&f8("(1, 3)"), &[0; 24]),
            "expected a column `radius`, or else `radius: …` in the scene, found `x`, `y`, `z`",
        ),
        (
            npy(&header("[('x', '>f8')]", "(1,)"), &[]),
            "expected a little-endian type such as `<f8`, `<f4`, `<i4` or `|u1`, found `>f8`",
        ),
        (
            npy(&header("[('x', '<f8')]", "(1, 1)"), &[]),
            "expected records in an array of one dimension, found more",
        ),
        (
            npy(&header("[('x', '<f8')]", "(1,)"), &[0; 8]),
            "expected a column `y`, found `x`",
        ),
        (
            npy(
                &header(
                    "[('x', '<f8'), ('y', '<f8'), ('z', '|S5'), ('r', '<f8')]",
                    "(1,)",
                ),
                &[0; 29],
            ),
            "expected numbers in the column `z`, found something else",
        ),
        (
            npy(&header("[('x', '<f8', (1000000000000,))]", "(1,)"), &[0; 8]),
            "expected at most 1000 values in a field, found more in `x`",
        ),
        (
            npy(
                &header(
                    "[('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ('r', '<f8'), ('big', 'V99999999999999999999')]",
                    "(1,)",
                ),
                &[0; 8],
            ),
            "expected a little-endian type such as `<f8`, `<f4`, `<i4` or `|u1`, found `V99999999999999999999`",
        ),
    ];
    for (bytes, expected) in cases {
        assert_eq!(refusal("a.npy", bytes, ""), format!("a.npy: {expected}"));
    }
    let bytes = npy(
        &f8("(2, 4)"),
        &doubles(&[1.0, 2.0, 3.0, 4.0, 5.0, f64::NAN, 7.0, 8.0]),
    );
    let at = bytes.len() - 24;
    let expected =
        format!("a.npy: row 2, column 2, byte {at}: expected a finite number for `y`, found NaN");
    assert_eq!(refusal("a.npy", bytes, ""), expected);
    let header = f8("(2, 4)").replace("False", "True");
    let bytes = npy(
        &header,
        &doubles(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, -8.0]),
    );
    let at = bytes.len() - 8;
    let expected = format!(
        "a.npy: row 2, column 4, byte {at}: expected a radius greater than 0 for `radius`, found -8"
    );
    assert_eq!(refusal("a.npy", bytes, ""), expected);
}

#[test]
fn many_binary_rows_come_in_their_order() {
    let count = 100_000;
    let number = |row: usize, column: usize| (4 * row + column + 1) as f64;
    let by_row: Vec<f64> = (0..4 * count).map(|at| number(at / 4, at % 4)).collect();
    let by_column: Vec<f64> = (0..4 * count)
        .map(|at| number(at % count, at / count))
        .collect();
    for (order, numbers) in [("False", by_row), ("True", by_column)] {
        let header = format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': ({count}, 4)}}");
        let found = spheres(&scene("a.npy", npy(&header, &doubles(&numbers)), ""));
        assert_eq!(found.len(), count);
        for (row, sphere) in found.iter().enumerate() {
            assert_eq!(*sphere, [0, 1, 2, 3].map(|column| number(row, column)));
        }
    }
}

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
            "2:17: expected the name of a table that ends in `.csv`, `.npy`, `.ply`, `.xyz` or `.extxyz`, found \"argon.pdb\"",
        ),
        (
            "file: \"argon.xyz\", color: Element, colormap: Viridis",
            "2:56: expected `color: Value` with this, found `color: Element`",
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
    assert_eq!(depths, [0.0, 1.0, 2.0, 7.0]);
    let clouds: Vec<_> = scene
        .clouds()
        .iter()
        .map(|cloud| cloud.spheres.clone())
        .collect();
    assert_eq!(clouds, [1..3, 3..4]);
    let dark = DVec3::splat(0.125);
    assert_eq!(
        albedos(&scene),
        [Color::ONE, dark, dark, from_srgb(0x808080)]
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
        let told = RefCell::new(Vec::new());
        let scene = Scene::load_watched(&path, &|progress| {
            assert_eq!(progress.table, Path::new(name));
            assert_eq!(progress.size, bytes.len() as u64);
            told.borrow_mut().push(progress.read);
        });
        assert_eq!(scene.unwrap().world().spheres().len(), ROWS);
        let told = told.into_inner();
        assert!(told.is_sorted() && told.last() == Some(&(bytes.len() as u64)));
        // In megabytes, so that telling costs nothing.
        assert!((3..30).contains(&told.len()), "{}", told.len());
    }
}
