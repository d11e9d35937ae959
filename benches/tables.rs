//! Measures the time of reading a table, in each format, on one thread and on two.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use marbles_benches::{Case, Folder, main as run, table};
use marbles_core::Sphere;
use marbles_scene::Scene;

/// The number of rows of the large table.
const COUNT: usize = 1_000_000;

fn main() {
    run(|| {
        let folder = Folder::new();
        let sizes = [1, 1000, COUNT];
        let scenes: Vec<(String, PathBuf)> = sizes
            .iter()
            .flat_map(|&count| write(&folder.0, count))
            .collect();
        let pools = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            (threads, pool.expect("threads can be had"))
        });
        for (index, count) in sizes.into_iter().enumerate() {
            let scenes = scenes.chunks(scenes.len() / sizes.len()).nth(index);
            let mut cases = Vec::new();
            for (name, path) in scenes.into_iter().flatten() {
                for (threads, pool) in &pools {
                    cases.push(Case {
                        name: format!("{name}, {threads}"),
                        millions: count as f64 * 1e-6,
                        run: Box::new(move |_| pool.install(|| load(path))),
                    });
                }
            }
            let title = format!("{count} rows: format, threads");
            for sum in table(&title, "rows", 20, &cases) {
                // The coordinates are spread around 0, and text has seven digits of them.
                assert_eq!(sum.0, count);
                assert!(sum.1.abs() < 0.1 + 0.01 * count as f64, "{}", sum.1);
            }
        }
    });
}

/// The number of spheres of a scene, and the sum of their first coordinates.
fn load(path: &Path) -> (usize, f64) {
    let scene = Scene::load(path).unwrap_or_else(|error| panic!("{error}"));
    let spheres: &[Sphere] = scene.world().spheres();
    let sum = spheres.iter().map(|sphere| sphere.center().x).sum();
    (spheres.len(), sum)
}

/// Writes a table in every format, and a scene for each; returns the names of the formats, and the scenes.
fn write(folder: &Path, count: usize) -> Vec<(String, PathBuf)> {
    let mut state = 1_u64;
    let mut random = || {
        // Knuth's linear congruence, of which the upper bits are good.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let rows: Vec<[f64; 4]> = (0..count)
        .map(|_| [random(), random(), random(), 0.001])
        .collect();
    let mut csv = String::from("x,y,z,radius\n");
    let mut xyz = format!("{count}\n\n");
    let mut ascii = ply("ascii", count).into_bytes();
    let mut binary = ply("binary_little_endian", count).into_bytes();
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({count}, 4), }}\n");
    let mut npy = b"\x93NUMPY\x01\x00".to_vec();
    npy.extend((header.len() as u16).to_le_bytes());
    npy.extend(header.as_bytes());
    for row in &rows {
        let [x, y, z, radius] = row;
        let _ = writeln!(csv, "{x},{y},{z},{radius}");
        let _ = writeln!(xyz, "Ar {x:.7} {y:.7} {z:.7}");
        ascii.extend(format!("{x:.7} {y:.7} {z:.7} {radius}\n").as_bytes());
        for number in row {
            binary.extend((*number as f32).to_le_bytes());
            npy.extend(number.to_le_bytes());
        }
    }
    let tables = [
        ("CSV", "csv", csv.into_bytes()),
        ("XYZ", "xyz", xyz.into_bytes()),
        ("PLY, text", "ply", ascii),
        ("PLY, binary", "ply", binary),
        ("NPY", "npy", npy),
    ];
    let write = |(index, (name, ending, bytes)): (usize, (&str, &str, Vec<u8>))| {
        let table = format!("{count}-{index}.{ending}");
        fs::write(folder.join(&table), bytes).expect("a table can be written");
        let path = folder.join(format!("{count}-{index}.ron"));
        let scene = format!(
            "(image: (width: 9, height: 9), lens: Fov(40), camera: Free(), clouds: [(file: \
             \"{table}\")])"
        );
        fs::write(&path, scene).expect("a scene can be written");
        (name.to_owned(), path)
    };
    tables.into_iter().enumerate().map(write).collect()
}

/// The header of a PLY file.
fn ply(format: &str, count: usize) -> String {
    let properties = ["x", "y", "z", "radius"].map(|name| format!("property float {name}\n"));
    let properties = properties.concat();
    format!("ply\nformat {format} 1.0\nelement vertex {count}\n{properties}end_header\n")
}
