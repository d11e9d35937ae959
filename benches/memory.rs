//! Measures the memory of scenes with ten million and with a hundred million spheres, from reading the table to the last picture.
//!
//! With `-- --write`, the result becomes a part of docs/growth.md. The benchmark needs 1.6 GB of disk space, 8 GB of memory, and
//! Linux, which reports the memory of a process.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::process::ExitCode;

use marbles_benches::page::Page;
use marbles_benches::process::{self, Held};
use marbles_benches::{Folder, is_to_write, seconds};

/// The numbers of spheres, their largest radius, and their names in the table.
const COUNTS: [(u64, f32, &str); 3] = [
    (1_000, 2.0, "10³"),
    (10_000_000, 0.5, "10⁷"),
    (100_000_000, 0.25, "10⁸"),
];
const FRAMES: usize = 3;

#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn main() -> ExitCode {
    process::main(|| {
        let mut table = String::from(
            "| spheres | size of the file | first frame, with reading | next frame | peak memory | memory while rendering | memory per sphere |\n\
             |--:|--:|--:|--:|--:|--:|--:|\n",
        );
        let mut without = 0;
        for (count, radius, name) in COUNTS {
            let run = run(count, radius);
            if count == COUNTS[0].0 {
                without = run.held.now;
                continue;
            }
            let each = (run.held.now - without) as f64 / count as f64;
            let [table_size, most, held] = [run.table, run.held.most, run.held.now].map(gigabytes);
            let [first, further] = [run.frames[0], run.frames[1]].map(seconds);
            let _ = writeln!(
                table,
                "| {name} | {table_size} | {first} | {further} | {most} | {held} | {each:.1} B |"
            );
        }
        println!("{table}");
        if is_to_write() {
            Page::open("docs/growth.md", &["memory"]).write("memory", &table);
        }
    })
}

struct Run {
    /// The bytes of the table.
    table: u64,
    /// The seconds of each frame; those of the first from the start of the process.
    frames: Vec<f64>,
    held: Held,
}

/// Writes a table of spheres, and renders some frames of a turntable of it.
fn run(count: u64, radius: f32) -> Run {
    let folder = Folder::new();
    let table = write_table(&folder, count, radius);
    let scene = format!(
        "(image: (width: 600, height: 600), lens: Fov(40), \
         camera: Orbit(target: (0, 0, 0), radius: 380, elevation: 20), \
         lights: [Directional(toward: (1, 2, -1))], clouds: [(file: \"spheres.npy\")], \
         animation: Turntable(frames: {FRAMES}))"
    );
    fs::write(folder.0.join("spheres.ron"), scene).expect("a scene can be written");
    let words = ["render", "spheres.ron", "--samples", "1", "--threads", "2"];
    let words = words
        .into_iter()
        .chain(["--progress=none", "-o", "frames/####.npy"]);
    let (frames, held) = process::watched(&folder.0, &words.collect::<Vec<_>>(), FRAMES);
    Run {
        table,
        frames,
        held,
    }
}

/// Writes spheres at random places of a cube of side 200, in single precision; returns the bytes of the table.
fn write_table(folder: &Folder, count: u64, radius: f32) -> u64 {
    let path = folder.0.join("spheres.npy");
    let file = File::create(&path).expect("a table can be written");
    let mut file = BufWriter::with_capacity(1 << 20, file);
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({count}, 4), }}");
    let header = format!("{header:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    file.write_all(&bytes).expect("a table can be written");
    let mut state = count;
    let mut random = || {
        // Knuth's linear congruence, of which the upper bits are good.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1_u64 << 24) as f32
    };
    for _ in 0..count {
        let row = [0, 1, 2].map(|_| 200.0 * random() - 100.0);
        for number in [row[0], row[1], row[2], radius * (0.5 + 0.5 * random())] {
            file.write_all(&number.to_le_bytes())
                .expect("a table can be written");
        }
    }
    file.flush().expect("a table can be written");
    fs::metadata(path).expect("the table is there").len()
}

fn gigabytes(bytes: u64) -> String {
    format!("{:.2} GB", bytes as f64 / 1e9)
}
