//! XTC and DCD: files of MDAnalysis 2.11.0, as MDAnalysis and mdtraj 1.11.1 read them; damaged files.

use super::super::{Frames, Request, Rows};
use super::*;

/// Three frames of six molecules of water, in nanometers and ångströms; the box of the last frame has an angle of 60 degrees.
pub(super) const WATER_XTC: &[u8] = include_bytes!("../../../../../tests/seeds/tables/water.xtc");
pub(super) const WATER_DCD: &[u8] = include_bytes!("../../../../../tests/seeds/tables/water.dcd");
/// The same, big-endian.
const BIG: &[u8] = include_bytes!("../../../../../tests/seeds/tables/big.dcd");
/// Two frames of six atoms, which are not compressed.
pub(super) const FEW: &[u8] = include_bytes!("../../../../../tests/seeds/tables/few.xtc");
/// Four triples of atoms that are too far from each other for one number of three coordinates, of mdtraj.
const FAR: &[u8] = include_bytes!("../../../../../tests/seeds/tables/far.xtc");
/// Three frames of four atoms, of which two are fixed, by hand. The angles of the cell are cosines.
const FIXED: &[u8] = include_bytes!("../../../../../tests/seeds/tables/fixed.dcd");
/// So many frames with a few atoms at the same points, in the format XTC.
pub(super) fn xtc(points: &[[f64; 3]], frames: u32) -> Vec<u8> {
    let count = points.len() as u32;
    let mut file = Vec::new();
    for frame in 0..frames {
        file.extend([1995, count, frame, 0].map(u32::to_be_bytes).concat());
        file.extend([0; 36]);
        file.extend(count.to_be_bytes());
        let numbers = points.iter().flatten();
        file.extend(numbers.flat_map(|number| (*number as f32).to_be_bytes()));
    }
    file
}

/// The same in the format DCD.
pub(super) fn dcd(points: &[[f64; 3]], frames: u32) -> Vec<u8> {
    let mut file = Vec::new();
    let mut record = |bytes: &[u8]| {
        let size = (bytes.len() as u32).to_le_bytes();
        file.extend([&size[..], bytes, &size].concat());
    };
    let mut header = [b"CORD", &frames.to_le_bytes()[..]].concat();
    header.resize(84, 0);
    record(&header);
    record(&0_u32.to_le_bytes());
    record(&(points.len() as u32).to_le_bytes());
    for _ in 0..frames {
        for axis in 0..3 {
            let numbers: Vec<f32> = points.iter().map(|point| point[axis] as f32).collect();
            record(&floats(&numbers));
        }
    }
    file
}

fn request() -> Request {
    Request {
        radius: Some(1.0),
        ..Request::default()
    }
}

/// All frames of the bytes.
fn frames(name: &str, bytes: &[u8]) -> Vec<Rows> {
    let folder = Folder::new();
    let path = folder.0.join(name);
    fs::write(&path, bytes).unwrap();
    let mut frames = Frames::open(&path, &|_, _| {}).unwrap();
    let mut all = Vec::new();
    while let Some(rows) = frames.read(&request()).unwrap() {
        all.push(rows);
    }
    all
}

/// The first of so many frames, all of the same size.
fn first_of(bytes: &[u8], frames: usize) -> &[u8] {
    &bytes[..bytes.len() / frames]
}

fn center(rows: &Rows, atom: usize) -> [f32; 3] {
    rows.spheres[atom]
        .center()
        .to_array()
        .map(|number| number as f32)
}

/// The edges of a frame's cell.
fn edges(rows: &Rows) -> [[f64; 3]; 3] {
    rows.cell.clone().unwrap().unwrap().edges.to_cols_array_2d()
}

fn assert_near(found: [[f64; 3]; 3], expected: [[f64; 3]; 3]) {
    for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
        assert!((found - expected).abs() < 2e-6, "{found} for {expected}");
    }
}

#[test]
fn frames_of_xtc_are_those_that_other_programs_read() {
    let all = frames("a.xtc", WATER_XTC);
    assert_eq!(all.len(), 3);
    assert!(all.iter().all(|rows| rows.spheres.len() == 18));
    assert_eq!(center(&all[0], 0), [2.505, 1.790_000_1, 0.867_000_04]);
    assert_eq!(center(&all[1], 3), [1.774, 0.883, 2.768_000_1]);
    assert_eq!(center(&all[2], 17), [2.953, 2.857, 0.497]);
    assert_near(
        edges(&all[0]),
        [[3.1, 0.0, 0.0], [0.0, 3.2, 0.0], [0.0, 0.0, 3.3]],
    );
    let tilted = [[3.3, 0.0, 0.0], [1.6, 2.771_281_2, 0.0], [0.0, 0.0, 3.3]];
    assert_near(edges(&all[2]), tilted);
    // The kind of frame that GROMACS writes since 2023 if there are very many atoms: the size has 64 bits.
    let first = first_of(WATER_XTC, 3);
    let wide = [
        &2023_u32.to_be_bytes(),
        &first[4..88],
        &[0; 4],
        &first[88..],
    ]
    .concat();
    let [wide] = &frames("a.xtc", &wide)[..] else {
        panic!("one frame")
    };
    assert_eq!(wide.spheres, all[0].spheres);
}

#[test]
fn positions_of_xtc_may_be_plain_and_far_apart() {
    let all = frames("a.xtc", FEW);
    assert_eq!(all.len(), 2);
    assert_eq!(center(&all[0], 0), [2.504_944_8, 1.789_662_2, 0.866_589_7]);
    assert_eq!(center(&all[1], 5), [1.743_834_5, 0.972_985_7, 2.778_177]);
    let all = frames("a.xtc", FAR);
    assert_eq!(all.len(), 1);
    assert_eq!(center(&all[0], 0), [12200.118, 12317.633, 613.02203]);
    assert_eq!(center(&all[0], 1), [12200.219, 12317.662, 613.02203]);
    assert_eq!(center(&all[0], 11), [19967.016, 6094.865, -10619.593]);
}

#[test]
fn frames_of_dcd_are_those_that_other_programs_read() {
    for bytes in [WATER_DCD, BIG] {
        let all = frames("a.dcd", bytes);
        assert_eq!(all.len(), 3);
        assert_eq!(center(&all[0], 0), [25.049_448, 17.896_622, 8.665_897]);
        assert_eq!(center(&all[1], 17), [16.908_976, 12.609_248, 10.740_371]);
        assert_eq!(center(&all[2], 17), [29.530_968, 28.567_337, 4.969_287_4]);
        let upright = [
            [31.0, 0.0, 0.0],
            [0.0, 32.0, 0.0],
            [0.0, 5.730_390_1, 32.498_657_2],
        ];
        assert_near(edges(&all[0]), upright);
        let tilted = [
            [33.0, 0.0, 0.0],
            [16.0, 27.712_812_9, 0.0],
            [0.0, 6.616_884_2, 32.329_813_5],
        ];
        assert_near(edges(&all[2]), tilted);
    }
    // As MDAnalysis and mdtraj tell it: the second and the third atom stay where they are.
    let all = frames("a.dcd", FIXED);
    let [first, second, third] = &all[..] else {
        panic!("three frames")
    };
    let atoms = |rows: &Rows| [0, 1, 2, 3].map(|atom| center(rows, atom));
    let [one, two, three, four] = [
        [1.0, 5.0, 9.0],
        [2.0, 6.0, 10.0],
        [3.0, 7.0, 11.0],
        [4.0, 8.0, 12.0],
    ];
    assert_eq!(atoms(first), [one, two, three, four]);
    assert_eq!(
        atoms(second),
        [[1.5, 5.5, 9.5], two, three, [4.5, 8.5, 12.5]]
    );
    assert_eq!(
        atoms(third),
        [[2.5, 6.5, 10.5], two, three, [5.5, 9.5, 13.5]]
    );
    // Cosines of 104.4775, 90 and 60 degrees.
    let cell = [
        [10.0, 0.0, 0.0],
        [5.5, 9.526_279_4, 0.0],
        [0.0, -3.464_100_8, 11.489_125_2],
    ];
    assert_near(edges(second), cell);
    // Newer versions of CHARMM write a symmetric matrix.
    let mut matrix = WATER_DCD.to_vec();
    let cell = matrix
        .windows(8)
        .position(|bytes| *bytes == 31_f64.to_le_bytes())
        .unwrap();
    matrix[cell..cell + 48].copy_from_slice(&doubles(&[10.0, -1.0, 11.0, -0.5, 2.0, 12.0]));
    let cell = [[10.0, -1.0, -0.5], [-1.0, 11.0, 2.0], [-0.5, 2.0, 12.0]];
    assert_near(edges(&frames("a.dcd", &matrix)[0]), cell);
}

#[test]
fn a_frame_is_found_without_the_frames_before_it() {
    const FRAMES: usize = 60;
    const ATOMS: u32 = 400_000;
    // All atoms at the origin take two bits each.
    let mut frame = [1995, ATOMS, 0, 0].map(u32::to_be_bytes).concat();
    frame.extend([0; 36]);
    frame.extend(ATOMS.to_be_bytes());
    frame.extend(1000_f32.to_be_bytes());
    frame.extend([0; 24]);
    frame.extend([9, ATOMS / 4].map(u32::to_be_bytes).concat());
    frame.resize(frame.len() + ATOMS as usize / 4, 0);
    let folder = Folder::new();
    let path = folder.0.join("a.xtc");
    fs::write(&path, frame.repeat(FRAMES)).unwrap();
    let read = Mutex::new(0);
    let watch = |bytes, _| *read.lock().unwrap() = bytes;
    let mut frames = Frames::open(&path, &watch).unwrap();
    let mut places = Vec::new();
    loop {
        places.push(frames.place());
        if !frames.skip().unwrap() {
            break;
        }
    }
    assert_eq!(places.len(), FRAMES + 1);
    // What tells the format, and a header of 92 bytes for each frame.
    assert!(*read.lock().unwrap() < 80_000);
    frames.go_to(places[FRAMES - 1]).unwrap();
    let rows = frames.read(&request()).unwrap().unwrap();
    assert_eq!(rows.spheres.len(), ATOMS as usize);
    assert!(*read.lock().unwrap() < 200_000);
}

#[test]
fn any_bit_of_a_trajectory_may_be_another_one() {
    for (name, good) in [
        ("a.xtc", first_of(WATER_XTC, 3)),
        ("a.xtc", first_of(FEW, 2)),
        ("a.dcd", FIXED),
    ] {
        let folder = Folder::new();
        let path = folder.0.join(name);
        for at in 0..good.len() {
            for bit in [0, 7] {
                let mut bytes = good.to_vec();
                bytes[at] ^= 1 << bit;
                // A new file is written sooner than an old one is replaced.
                let _ = fs::remove_file(&path);
                fs::write(&path, &bytes).unwrap();
                let Ok(mut frames) = Frames::open(&path, &|_, _| {}) else {
                    continue;
                };
                while let Ok(Some(rows)) = frames.read(&request()) {
                    assert!(rows.spheres.len() <= bytes.len() * 4);
                }
            }
        }
    }
}
