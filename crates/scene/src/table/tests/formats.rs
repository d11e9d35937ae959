//! Formats of other programs, and what is common to all.

use super::atoms::{LAMMPS, PDB};
use super::elements::PQR;
use super::*;

#[test]
fn tables_of_text_have_many_forms() {
    let expected = TWO;
    for (name, text) in [
        (
            "a.txt",
            "# made by hand\n# x y z r\n1 -2.5 3e-3 0.5\n4 5 6 7\n",
        ),
        (
            "a.dat",
            "% x  y  z  r\n  1\t-2.5 3e-3 0.5\n% between\n\n4 5 6 7",
        ),
        ("a", "x y z radius\n1 -2.5 0.003 0.5\n4 5 6 7\n"),
        (
            "a.csv",
            "\"Points:0\",\"Points:1\",\"Points:2\",\"Diameter\"\n1,-2.5,0.003,1\n4,5,6,14\n",
        ),
        (
            "a.csv",
            "id;X (mm);Y (mm);Z (mm);Radius [mm]\n1;1;-2,5;0,003;0,5\n2;4;5;6;7\n",
        ),
        (
            "a.tsv",
            "Position.X\tPosition.Y\tPosition.Z\tRadius\n1\t-2.5\t0.003\t0.5\n4\t5\t6\t7\n",
        ),
        ("a.txt", "x,y,z,radius\n1.0D0,-2.5,3d-3,0.5\n4,5,6,7\n"),
    ] {
        assert_eq!(spheres(&scene(name, text, "")), expected, "{text}");
    }
    let points = spheres(&scene("a.xyz", "1 2 3\n4 5 6\n", "radius: 1"));
    assert_eq!(points, [[1.0, 2.0, 3.0, 1.0], [4.0, 5.0, 6.0, 1.0]]);
    let plain = "9 1 -2.5 0.003 0.5\n9 4 5 6 7\n";
    let columns = "columns: (x: 2, y: 3, z: 4, radius: 5)";
    assert_eq!(spheres(&scene("a.txt", plain, columns)), expected);
    assert_eq!(
        spheres(&scene("a.csv", plain.replace(' ', ","), columns)),
        expected
    );
    let doubled = [[1.0, -2.5, 3e-3, 1.0], [4.0, 5.0, 6.0, 14.0]];
    let scaled = "columns: (x: 2, y: 3, z: 4, radius: 5, radius_scale: 2)";
    assert_eq!(spheres(&scene("a.txt", plain, scaled)), doubled);
    assert_eq!(
        refusal("a.txt", plain, "columns: (x: 2, y: 3, z: 9, radius: 5)"),
        "a.txt:1:1: expected the number of a column, from 1 to 5, found 9"
    );
    assert_eq!(
        refusal("a.trr", b"\0\0\x07\xc9\0\0", ""),
        "scene.ron:2:17: expected a table (`.csv`, `.tsv`, `.txt`, `.dat`, `.npy`, `.npz`, `.ply`, `.xyz`, `.extxyz`, \
         `.dump`, `.lammpstrj`, `.gro`, `.gsd`, `.pdb`, `.ent`, `.pdbqt`, `.pqr`, `.cif`, `.mmcif`, `.pdbx`, `.mol2`, `.sdf`, `.sd`, `.mol`, `.mdl`, `.data`, `.lmp`, `.vtk`, `.poscar`, `.contcar`, `.xdatcar`, `.vasp`, `.vtu`, `.vtp`, `.pvd`, `.xtc` or `.dcd`), found \"a.trr\", \
         a trajectory of GROMACS (TRR): save it as extended XYZ, PDB or a LAMMPS dump, with MDAnalysis, MDTraj or ASE"
    );
}

#[test]
fn compressed_tables_are_those_that_were_compressed() {
    use std::io::Write;
    let text = "x,y,z,r\n1,-2.5,3e-3,0.5\n4,5,6,7\n";
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(text.as_bytes()).unwrap();
    let gzip = gzip.finish().unwrap();
    let level = ruzstd::encoding::CompressionLevel::Fastest;
    let zstd = ruzstd::encoding::compress_to_vec(text.as_bytes(), level);
    for (name, bytes) in [("a.csv.gz", &gzip), ("a.csv.zst", &zstd), ("a.csv", &gzip)] {
        assert_eq!(spheres(&scene(name, bytes, "")), TWO, "{name}");
    }
    // Two members, one behind the other, are one file.
    let twice = [&gzip[..], &gzip[..]].concat();
    let message = refusal("a.csv.gz", &twice, "");
    assert_eq!(
        message,
        "a.csv.gz:4:1: expected a number for `x`, found `x`"
    );
    let twice = [&zstd[..], &zstd[..]].concat();
    let message = refusal("a.csv.zst", &twice, "");
    assert_eq!(
        message,
        "a.csv.zst:4:1: expected a number for `x`, found `x`"
    );
    let message = refusal("a.csv.gz", &gzip[..gzip.len() / 2], "");
    assert!(message.contains("cannot be read"), "{message}");
    let message = refusal("a.csv.zst", &zstd[..zstd.len() / 2], "");
    assert!(message.contains("cannot be read"), "{message}");
    // By columns, which a compressed file does not have side by side.
    let header = "{'descr': '>f4', 'fortran_order': True, 'shape': (2, 4)}";
    let numbers = [1.0_f32, 4.0, -2.5, 5.0, 0.25, 6.0, 0.5, 7.0];
    let bytes: Vec<u8> = numbers
        .iter()
        .flat_map(|number| number.to_be_bytes())
        .collect();
    let array = npy(header, &bytes);
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(&array).unwrap();
    let expected = [[1.0, -2.5, 0.25, 0.5], [4.0, 5.0, 6.0, 7.0]];
    for bytes in [array, gzip.finish().unwrap()] {
        assert_eq!(spheres(&scene("a.npy", bytes, "")), expected);
    }
}

/// Few bytes can be compressed rows without end.
#[test]
fn files_that_are_compressed_too_well_are_refused() {
    use std::io::Write;
    let gzip = |start: &str, line: &str, count: usize| {
        let level = flate2::Compression::best();
        let mut gzip = flate2::write::GzEncoder::new(Vec::new(), level);
        gzip.write_all(start.as_bytes()).unwrap();
        let lines = line.repeat(1000);
        for _ in 0..count / 1000 {
            gzip.write_all(lines.as_bytes()).unwrap();
        }
        gzip.finish().unwrap()
    };
    let refused = |name: &str, bytes: &[u8], fields: &str, found: &str| {
        let message = refusal(name, bytes, fields);
        let words =
            message.contains(found) && message.contains("decompress it if you want to read it");
        assert!(words, "{message}");
    };
    let rows = gzip("x,y,z,r\n", "0,0,0,1\n", 132_000);
    let most = "expected at most 131072 rows in a compressed file of";
    refused("a.csv.gz", &rows, "", most);
    let rows = gzip("x,y,z,r\n", "0,0,0,1\n", 131_000);
    assert_eq!(spheres(&scene("a.csv.gz", rows, "")).len(), 131_000);
    let empty = gzip("x,y,z,r\n", &format!("{}\n", " ".repeat(999)), 70_000);
    refused("a.csv.gz", &empty, "", "decompress to more than 67108864");
    let steps = gzip("", "1\n\nH 0 0 0\n", 132_000);
    let fields = "radius: 1, frames: All";
    refused("a.xyz.gz", &steps, fields, "expected at most 131072 frames");
    let header = "{'descr': '|i1', 'fortran_order': False, 'shape': (140000, 4)}";
    let array = npy(header, &[1; 560_000]);
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    gzip.write_all(&array).unwrap();
    refused(
        "a.npy.gz",
        &gzip.finish().unwrap(),
        "",
        "expected at most 131072",
    );
}

#[test]
fn arrays_of_all_types_and_orders_are_read() {
    let header =
        |kind: &str| format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': (1, 4)}}");
    let numbers = [1_i16, -2, 3, 4];
    let expected = [[1.0, -2.0, 3.0, 4.0]];
    let big: Vec<u8> = numbers
        .iter()
        .flat_map(|number| number.to_be_bytes())
        .collect();
    let little: Vec<u8> = numbers
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let long: Vec<u8> = numbers
        .iter()
        .flat_map(|&number| i64::from(number).to_le_bytes())
        .collect();
    let half = [0x3c00_u16, 0xc000, 0x4200, 0x4400];
    let half: Vec<u8> = half
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    for (kind, bytes) in [(">i2", big), ("<i2", little), ("<i8", long), ("<f2", half)] {
        assert_eq!(
            spheres(&scene("a.npy", npy(&header(kind), &bytes), "")),
            expected,
            "{kind}"
        );
    }
    // Three dimensions are frames.
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1, 4)}";
    let both = doubles(&TWO.concat());
    let folder = Folder::new();
    fs::write(folder.0.join("a.npy"), npy(header, &both)).unwrap();
    let text = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
        clouds: [(file: \"a.npy\", frames: All)])";
    let series = Scene::parse(text, &folder.0.join("scene.ron")).unwrap();
    for frame in [2, 1, 2] {
        let world = series.world_at(frame).unwrap();
        let sphere = world.spheres()[0];
        let found = sphere.center().extend(sphere.radius()).to_array();
        assert_eq!(found, TWO[frame as usize - 1]);
    }
}

/// An archive of arrays.
pub(super) fn npz(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    use std::io::Write;
    let mut file = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut file);
    for (name, bytes) in arrays {
        let name = format!("{name}.npy");
        let builder = archive.new_file(&*name);
        let builder = builder.compression_method(rawzip::CompressionMethod::DEFLATE);
        let (mut entry, config) = builder.start().unwrap();
        let encoder = flate2::write::DeflateEncoder::new(&mut entry, flate2::Compression::fast());
        let mut writer = config.wrap(encoder);
        writer.write_all(bytes).unwrap();
        let (encoder, descriptor) = writer.finish().unwrap();
        encoder.finish().unwrap();
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    file
}

#[test]
fn archives_of_named_arrays_are_tables() {
    let header =
        |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}");
    let positions = npy(
        &header("(2, 3)"),
        &doubles(&[1.0, -2.5, 3e-3, 4.0, 5.0, 6.0]),
    );
    let radii = npy(&header("(2,)"), &doubles(&[0.5, 7.0]));
    let other = npy(&header("(5,)"), &doubles(&[0.0; 5]));
    let names = npy(
        "{'descr': '<U2', 'fortran_order': False, 'shape': (2,)}",
        &{
            let characters = ['A', 'r', 'B', '\0'];
            characters.map(|c| (c as u32).to_le_bytes()).concat()
        },
    );
    let archive = npz(&[
        ("time", other),
        ("positions", positions),
        ("radius", radii),
        ("kind", names),
    ]);
    assert_eq!(spheres(&scene("a.npz", &archive, "")), TWO);
    let kept = scene("a.npz", &archive, "keep: [(\"kind\", Is(\"B\"))]");
    assert_eq!(spheres(&kept), TWO[1..]);
    let mut alone = npz(&[("arr_0", npy(&header("(2, 4)"), &doubles(&TWO.concat())))]);
    assert_eq!(spheres(&scene("a.npz", &alone, "")), TWO);
    // Behind the data stand `PK\x07\x08` and the checksum, which the directory repeats.
    let checksum = alone
        .windows(4)
        .position(|four| four == b"PK\x07\x08")
        .unwrap()
        + 4;
    let stored = alone[checksum..checksum + 4].to_vec();
    let places = (0..alone.len() - 4).filter(|&place| alone[place..place + 4] == stored);
    for place in places.collect::<Vec<_>>() {
        alone[place] ^= 1;
    }
    let message = refusal("a.npz", &alone, "");
    assert!(
        message.contains("expected the checksum 0x")
            && message.ends_with("(in the member `arr_0.npy`)"),
        "{message}"
    );
    let message = refusal("a.npz", npz(&[]), "");
    assert_eq!(
        message,
        "a.npz: expected arrays of as many rows as there are spheres, found none"
    );
}

#[test]
fn legacy_vtk_is_read_as_text_and_as_bytes() {
    let text = "# vtk DataFile Version 3.0\npoints\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 -2.5 0.003\n4 5\n6\n\
        VERTICES 2 4\n1 0\n1 1\nCELL_DATA 2\nSCALARS c int\nLOOKUP_TABLE default\n8 9\nPOINT_DATA 2\n\
        FIELD FieldData 2\nradius 1 2 double\n0.5 7\nv 3 2 float\n0 3 4 0 0 0\n";
    assert_eq!(spheres(&scene("a.vtk", text, "")), TWO);
    let colored = scene(
        "a.vtk",
        text,
        "value: Length(\"v_1\", \"v_2\", \"v_3\"), colormap: Grey",
    );
    assert_eq!(albedos(&colored), [Color::ONE, Color::ZERO]);
    let mut binary =
        b"# vtk DataFile Version 3.0\npoints\nBINARY\nDATASET POLYDATA\nPOINTS 2 double\n".to_vec();
    let big =
        |numbers: &[f64]| -> Vec<u8> { numbers.iter().flat_map(|x| x.to_be_bytes()).collect() };
    binary.extend(big(&[1.0, -2.5, 3e-3, 4.0, 5.0, 6.0]));
    binary.extend(b"\nPOINT_DATA 2\nSCALARS radius double 1\nLOOKUP_TABLE default\n");
    binary.extend(big(&[0.5, 7.0]));
    binary.extend(b"\n");
    assert_eq!(spheres(&scene("a.vtk", &binary, "")), TWO);
    assert_eq!(
        refusal("a.vtk", text.replace("POLYDATA", "STRUCTURED_POINTS"), ""),
        "a.vtk:4:1: expected a dataset of points: POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID (ParaView saves the points of \
         others as CSV, by File > Save Data), found `DATASET STRUCTURED_POINTS`"
    );
    let message = refusal(
        "a.vtk",
        text.replace("POINTS 2 float", "POINTS 99999999999 float"),
        "",
    );
    assert!(
        message.starts_with("a.vtk:9:1: expected 299999999997 numbers"),
        "{message}"
    );
}

#[test]
fn big_endian_ply_is_read() {
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 2\nproperty double x\nproperty double y\n\
        property double z\nproperty double radius\nend_header\n".to_vec();
    bytes.extend(TWO.concat().iter().flat_map(|number| number.to_be_bytes()));
    assert_eq!(spheres(&scene("a.ply", bytes, "")), TWO);
}

/// Alters any byte of a file, or cuts it there: there is a scene or a message.
fn alter_bytes(name: &str, good: &[u8]) {
    let folder = Folder::new();
    let path = folder.0.join(name);
    let parse = |clouds: &str| {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [{clouds}])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron"));
        scene.map_err(|error| {
            let fault = &error.faults()[0];
            assert!(fault.message.contains("expected "), "{}", fault.message);
            assert!(fault.message.contains("found "), "{}", fault.message);
        })
    };
    let first = format!("(file: \"{name}\")");
    let all = format!("(file: \"{name}\", frames: All)");
    fs::write(&path, good).unwrap();
    let has_frames = parse(&all).is_ok();
    let both = format!("{first}, {all}");
    for at in 0..good.len() {
        for other in [None, Some(b'\n'), Some(b'9'), Some(b'-'), Some(0xff)] {
            let mut bytes = good.to_vec();
            match other {
                None => bytes.truncate(at),
                Some(other) => bytes[at] = other,
            }
            let _ = fs::remove_file(&path);
            fs::write(&path, bytes).unwrap();
            if !has_frames {
                let _ = parse(&first);
            } else if parse(&both).is_err() {
                // The first frame may have been refused before all of them were looked for.
                let _ = parse(&all);
            }
        }
    }
}

#[test]
fn any_byte_of_atoms_may_be_another_one() {
    for (name, good) in [("a.pdb", PDB), ("a.pqr", PQR)] {
        alter_bytes(name, good.as_bytes());
    }
}

#[test]
fn any_byte_of_other_formats_may_be_another_one() {
    let cif = "data_a\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.type_symbol\n1 2 3 C\n#\n";
    let gro = "t\n1\n    1SOL     OW    1   0.100   0.200   0.300\n 1 1 1\n";
    let vtk = "# vtk DataFile Version 3.0\np\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 3\nPOINT_DATA 1\nSCALARS radius float 1\nLOOKUP_TABLE default\n2\n";
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4)}";
    let archive = npz(&[("a", npy(header, &doubles(&TWO[0])))]);
    for (name, good) in [
        ("a.dump", LAMMPS.as_bytes()),
        ("a.cif", cif.as_bytes()),
        ("a.gro", gro.as_bytes()),
        ("a.vtk", vtk.as_bytes()),
        ("a.npz", &archive),
        ("a.txt", b"# x y z r\n1 2 3 4\n"),
    ] {
        alter_bytes(name, good);
    }
}
