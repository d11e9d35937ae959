//! Formats of other programs.

use super::*;

const LAMMPS: &str = "ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS xy xz yz pp pp pp
-1 11 2
0 5 0
0 4 1
ITEM: ATOMS id type xs ys zs radius
1 1 0 0 0 0.5
2 2 1 1 1 0.25
";

#[test]
fn dumps_of_lammps_are_read() {
    // The bounds -1..11 contain the tilt of 2, and 0..5 that of 1: the edges are (10, 0, 0), (2, 4, 0), (0, 1, 4).
    let found = spheres(&scene("a.dump", LAMMPS, ""));
    assert_eq!(found, [[-1.0, 0.0, 0.0, 0.5], [11.0, 5.0, 4.0, 0.25]]);
    let unwrapped = LAMMPS.replace("xs ys zs", "xu yu zu");
    let found = spheres(&scene("a.lammpstrj", &unwrapped, ""));
    assert_eq!(found, [[0.0, 0.0, 0.0, 0.5], [1.0, 1.0, 1.0, 0.25]]);
    let general = LAMMPS
        .replace("xy xz yz pp pp pp", "abc origin pp pp pp")
        .replace("-1 11 2\n0 5 0\n0 4 1", "1 2 0 5\n0 1 0 6\n0 0 1 7");
    let found = spheres(&scene("a.dump", &general, ""));
    assert_eq!(found, [[5.0, 6.0, 7.0, 0.5], [6.0, 9.0, 8.0, 0.25]]);
    let kept = spheres(&scene("a.txt", LAMMPS, "keep: [(\"type\", Is(2))]"));
    assert_eq!(kept, [[11.0, 5.0, 4.0, 0.25]]);
    for (text, expected) in [
        (
            LAMMPS.replace("\n2\n", "\n3\n"),
            "a.dump:12:1: expected 3 atoms, as `ITEM: NUMBER OF ATOMS` says, and after 2 of them another, found the end of the file",
        ),
        (
            LAMMPS.replace("0 4 1", "0 4"),
            "a.dump:8:1: expected 3 numbers of the box, found 0 4",
        ),
        (
            LAMMPS.replace("ITEM: NUMBER OF ATOMS\n2\n", ""),
            "a.dump:7:1: expected `ITEM: NUMBER OF ATOMS` before, found `ITEM: ATOMS id type xs ys zs radius`",
        ),
        (
            LAMMPS.replace("1 1 0 0 0 0.5", "1 1 0 x 0 0.5"),
            "a.dump:10:7: expected a number for `ys`, found `x`",
        ),
        (
            LAMMPS.replace(" radius", " q"),
            "a.dump:9:1: expected a column `radius`, or else `radius: …` in the scene, found `id`, `type`, `xs`, `ys`, `zs`, `q`",
        ),
    ] {
        assert_eq!(refusal("a.dump", text, ""), expected);
    }
}

#[test]
fn gro_is_in_nanometers_and_names_tell_elements() {
    let text = "Water and an ion
    4
    1SOL     OW    1   0.100   0.200   0.300  0.1000  0.2000  0.3000
    1SOL    HW1    2   0.150   0.200   0.300
    2ALA     CA    3   1.000   1.000   1.000
    3CL      CL    4  -1.000   0.000   0.000
   2.0 2.0 2.0
";
    let scene = scene("a.gro", text, "");
    let expected = [
        [0.1, 0.2, 0.3, 0.152],
        [0.15, 0.2, 0.3, 0.11],
        [1.0, 1.0, 1.0, 0.17],
        [-1.0, 0.0, 0.0, 0.175],
    ];
    for (found, expected) in spheres(&scene).iter().zip(expected) {
        assert!(
            (0..4).all(|index| (found[index] - expected[index]).abs() < 1e-12),
            "{found:?}"
        );
    }
    let wide = "t\n1\n    1SOL     OW    1   0.10001   0.20002   0.30003\n 1 1 1\n";
    let found = spheres(&self::scene("a.gro", wide, "radius: 1"));
    assert_eq!(found, [[0.10001, 0.20002, 0.30003, 1.0]]);
}

const PDB: &str = "HEADER    A SMALL THING
MODEL        1
ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.00           N
ATOM      2  CA  ALA A   1      11.639   6.071  -5.147  1.00 20.00           C
HETATM    3 CA    CA B   2       0.000   0.000   0.000  1.00 30.00
ENDMDL
MODEL        2
ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00 10.00           N
ENDMDL
END
";

#[test]
fn pdb_is_read_model_by_model() {
    let first = scene("a.pdb", PDB, "");
    let found = spheres(&first);
    assert_eq!(found.len(), 3);
    assert_eq!(found[1][..3], [11.639, 6.071, -5.147]);
    // Nitrogen, the alpha carbon, and calcium by the place of its name.
    let radii: Vec<f64> = found.iter().map(|sphere| sphere[3]).collect();
    assert_eq!(radii, [1.55, 1.7, 2.31]);
    assert_eq!(
        first.warnings(),
        ["a.pdb: the first frame of several is shown (`frames: All` shows them one after another)"]
    );
    let kept = spheres(&scene("a.pdb", PDB, "keep: [(\"chain\", Is(\"B\"))]"));
    assert_eq!(kept.len(), 1);
    let kept = spheres(&scene(
        "a.ent",
        PDB,
        "keep: [(\"b_factor\", Between(15, 25))]",
    ));
    assert_eq!(kept.len(), 1);
    let folder = Folder::new();
    fs::write(folder.0.join("a.pdb"), PDB).unwrap();
    let text = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
        clouds: [(file: \"a.pdb\", frames: All)])";
    let series = Scene::parse(text, &folder.0.join("scene.ron")).unwrap();
    let count = |frame| series.world_at(frame).unwrap().spheres().len();
    assert_eq!(
        (series.frames(), count(1), count(2), count(3)),
        (Some(1..=2), 3, 1, 1)
    );
}

#[test]
fn mmcif_is_read_model_by_model() {
    let row = |model: u32, x: f64| format!("ATOM {x} 2 3 C 'C A' \"x 'y\" {model}\n");
    let text = format!(
        "data_1ABC\n_entry.id 1ABC\n_text\n;\nloop_\n_atom_site.Cartn_x\n;\nloop_\n_atom_site.group_PDB\n\
         _atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.type_symbol\n\
         _atom_site.label_comp_id\n_atom_site.note\n_atom_site.pdbx_PDB_model_num\n{}{}{}#\nloop_\n_x.y\n1\n",
        row(1, 1.5),
        row(1, 2.5),
        row(2, 3.5)
    );
    let expected = [[1.5, 2.0, 3.0, 1.7], [2.5, 2.0, 3.0, 1.7]];
    assert_eq!(spheres(&scene("a.cif", &text, "")), expected);
    let residue = "keep: [(\"residue\", Is(\"C A\"))]";
    assert_eq!(spheres(&scene("a.cif", &text, residue)), expected);
    let crystal = "data_x\nloop_\n_atom_site_label\n_atom_site_fract_x\nNa 0.5\n";
    let message = refusal("a.cif", crystal, "");
    assert!(message.contains("save it as XYZ"), "{message}");
}

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
        refusal("a.xtc", b"\0\0\x07\xcb\0\0", ""),
        "scene.ron:2:17: expected a table (`.csv`, `.tsv`, `.txt`, `.dat`, `.npy`, `.npz`, `.ply`, `.xyz`, `.extxyz`, \
         `.dump`, `.lammpstrj`, `.gro`, `.pdb`, `.ent`, `.pdbqt`, `.cif`, `.mmcif` or `.vtk`), found \"a.xtc\": save \
         the trajectory as extended XYZ, PDB or a LAMMPS dump, with MDAnalysis, MDTraj or ASE"
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
fn npz(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    use std::io::{Cursor, Write};
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in arrays {
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(format!("{name}.npy"), options).unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
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
    let alone = npz(&[("arr_0", npy(&header("(2, 4)"), &doubles(&TWO.concat())))]);
    assert_eq!(spheres(&scene("a.npz", alone, "")), TWO);
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
        "a.vtk:4:1: expected a dataset of points: POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID, found `DATASET STRUCTURED_POINTS`"
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

/// Whatever byte is another one, there is a scene or a message.
#[test]
fn any_byte_of_other_formats_may_be_another_one() {
    let cif = "data_a\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.type_symbol\n1 2 3 C\n#\n";
    let gro = "t\n1\n    1SOL     OW    1   0.100   0.200   0.300\n 1 1 1\n";
    let vtk = "# vtk DataFile Version 3.0\np\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 3\nPOINT_DATA 1\nSCALARS radius float 1\nLOOKUP_TABLE default\n2\n";
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4)}";
    let archive = npz(&[("a", npy(header, &doubles(&TWO[0])))]);
    for (name, good) in [
        ("a.dump", LAMMPS.as_bytes()),
        ("a.pdb", PDB.as_bytes()),
        ("a.cif", cif.as_bytes()),
        ("a.gro", gro.as_bytes()),
        ("a.vtk", vtk.as_bytes()),
        ("a.npz", &archive),
        ("a.txt", b"# x y z r\n1 2 3 4\n"),
    ] {
        let folder = Folder::new();
        let path = folder.0.join(name);
        let text = |frames: &str| {
            format!(
                "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [(file: \"{name}\"{frames})])"
            )
        };
        for at in 0..good.len() {
            for other in [None, Some(b'\n'), Some(b'9'), Some(b'-'), Some(0xff)] {
                let mut bytes = good.to_vec();
                match other {
                    None => bytes.truncate(at),
                    Some(other) => bytes[at] = other,
                }
                let _ = fs::remove_file(&path);
                fs::write(&path, bytes).unwrap();
                for frames in ["", ", frames: All"] {
                    if let Err(error) = Scene::parse(&text(frames), &folder.0.join("scene.ron")) {
                        let fault = &error.faults()[0];
                        assert!(fault.message.contains("expected "), "{}", fault.message);
                        assert!(fault.message.contains("found "), "{}", fault.message);
                    }
                }
            }
        }
    }
}
