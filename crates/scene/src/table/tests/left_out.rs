//! Contents of tables that no sphere shows: said with their places, or refused.

use super::cut;
use super::formats::npz;
use super::*;

const VTK: &str =
    "# vtk DataFile Version 3.0\np\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3\n4 5 6\n";

/// The warnings about a table whose spheres have these centers.
fn said(name: &str, bytes: impl AsRef<[u8]>, fields: &str, centers: &[[f64; 3]]) -> String {
    let scene = scene(name, bytes, fields);
    let found = spheres(&scene);
    let found: Vec<[f64; 3]> = found.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
    assert_eq!(found, centers, "{name}");
    warnings(&scene)
}

fn array(shape: &str, numbers: &[f64]) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}");
    npy(&header, &doubles(numbers))
}

#[test]
fn lines_after_the_first_frame_that_are_no_frame_are_said() {
    let xyz = "1\n\nC 1 2 3\n";
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n\
                ITEM: ATOMS id x y z radius\n1 1 2 3 1\n";
    let first = &[[1.0, 2.0, 3.0]];
    for (name, text, expected) in [
        ("a.xyz", format!("{xyz}\n\n"), ""),
        (
            "a.xyz",
            format!("{xyz}O 4 5 6\n"),
            "a.xyz:4: no frame follows the first one here: expected the number of atoms, found `O 4 5 6`",
        ),
        (
            "a.dump",
            format!("{dump}2 4 5 6 1\n"),
            "a.dump:11: no frame follows the first one here: expected a line `ITEM: …`, found 2 4 5 6 1",
        ),
        (
            "a.xyz",
            xyz.repeat(2),
            "a.xyz: the first frame of several is shown (`frames: All` shows them one after another)",
        ),
    ] {
        assert_eq!(said(name, text, "", first), expected);
    }
}

#[test]
fn bytes_after_the_last_row_are_said() {
    let one = array("(1, 4)", &[1.0, 2.0, 3.0, 0.5]);
    let two = [one.clone(), one.clone()].concat();
    let first = &[[1.0, 2.0, 3.0]];
    let at = one.len();
    let expected =
        format!("a.npy: another array follows the first one at byte {at}: it is not read");
    assert_eq!(said("a.npy", &two, "", first), expected);
    // NumPy's arrays in one file, compressed.
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut gzip, &two).unwrap();
    let gzip = gzip.finish().unwrap();
    assert!(said("a.npy.gz", gzip, "", first).contains("another array follows"));
    let frames = [array("(1, 1, 4)", &[1.0, 2.0, 3.0, 0.5]), vec![7]].concat();
    let (steps, is_said) = cut::shown("a.npy", &frames, "frames: All").unwrap();
    assert!(steps.len() == 1 && is_said);

    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    let whole = format!("{ply}end_header\n1 2 3\n\n");
    assert_eq!(said("a.ply", &whole, "radius: 1", first), "");
    assert_eq!(
        said("a.ply", whole + "4 5 6\n", "radius: 1", first),
        "a.ply:10: lines follow the last vertex: they are not read"
    );
    // Those of another element.
    let faces = format!("{ply}element face 1\nproperty list uchar int i\nend_header\n1 2 3\n1 0\n");
    assert_eq!(said("a.ply", faces, "radius: 1", first), "");
    let binary = ply.replace("ascii", "binary_little_endian") + "end_header\n";
    let of_rows = |rows: &[f32]| [binary.as_bytes(), &floats(rows)].concat();
    assert_eq!(
        said("a.ply", of_rows(&[1.0, 2.0, 3.0]), "radius: 1", first),
        ""
    );
    assert_eq!(
        said(
            "a.ply",
            of_rows(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            "radius: 1",
            first
        ),
        format!(
            "a.ply: bytes follow the last vertex at byte {}: they are not read",
            binary.len() + 12
        )
    );
}

#[test]
fn arrays_without_a_row_for_each_sphere_are_said() {
    let positions = || {
        (
            "positions",
            array("(2, 3)", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        )
    };
    let centers = &[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    for (name, shape, count, expected) in [
        (
            "color",
            "(1, 3)",
            3,
            "the array `color` has the shape (1, 3), but there are 2 spheres: it is not read",
        ),
        (
            "element",
            "(3,)",
            3,
            "the array `element` has the shape (3), but there are 2 spheres: it is not read",
        ),
        // The scene has the radius, and time has nothing to do with spheres.
        ("radius", "(1,)", 1, ""),
        ("time", "(5,)", 5, ""),
    ] {
        let archive = npz(&[positions(), (name, array(shape, &vec![1.0; count]))]);
        let told = said("a.npz", archive, "radius: 1", centers);
        let expected = match expected {
            "" => String::new(),
            expected => format!("a.npz: {expected}"),
        };
        assert_eq!(told, expected);
    }
    // The only array of two dimensions is no table if the positions are another one.
    let steps = ("positions", array("(1, 2, 3)", &[0.0; 6]));
    let archive = npz(&[steps, ("velocities", array("(2, 3)", &[0.0; 6]))]);
    assert_eq!(
        refusal("a.npz", archive, "radius: 1"),
        "a.npz: expected a column `x`, found `velocities_1`, `velocities_2`, `velocities_3`"
    );
}

#[test]
fn numbers_of_other_counts_of_points_are_refused_or_said() {
    let centers = &[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let of = |rest: &str| said("a.vtk", VTK.to_owned() + rest, "radius: 1", centers);
    assert_eq!(
        refusal(
            "a.vtk",
            VTK.to_owned() + "POINT_DATA 3\nSCALARS a float 1\nLOOKUP_TABLE default\n1\n2\n3\n",
            "radius: 1"
        ),
        "a.vtk:8:1: expected numbers of all 2 points, found `POINT_DATA 3`"
    );
    assert_eq!(
        of("POINT_DATA 2\nFIELD f 1\na 1 3 float\n1 2 3\n"),
        "a.vtk:10: the array `a` has 3 rows, but there are 2 points: it is not read"
    );
    assert_eq!(
        of("7 8 9\nPOINT_DATA 2\n"),
        "a.vtk:8: not a section of a legacy VTK file: the rest of the file is not read"
    );
    assert_eq!(
        of("CELL_DATA 3\nSCALARS a float 1\nLOOKUP_TABLE default\n1\n2\n3\n"),
        ""
    );
}

/// Kinds of numbers that spheres do not need, before those that they do.
#[test]
fn all_kinds_of_numbers_of_points_are_read() {
    for section in [
        "COLOR_SCALARS c 4\n1 0 0 1\n0 1 0 1\n",
        "TENSORS t float\n1 0 0\n0 1 0\n0 0 1\n\n1 0 0\n0 1 0\n0 0 1\n",
        "TENSORS6 t float\n1 0 0 0 1 0\n0 0 1 1 0 0\n",
        "TEXTURE_COORDINATES t 2 float\n0 1\n1 0\n",
        "GLOBAL_IDS g vtkIdType\n7 8\n",
        "NORMALS n float\n0 0 1\n0 1 0\n",
    ] {
        let radii = "SCALARS radius float 1\nLOOKUP_TABLE default\n2.5\n3.5\n";
        let scene = scene("a.vtk", format!("{VTK}POINT_DATA 2\n{section}{radii}"), "");
        let expected = [[1.0, 2.0, 3.0, 2.5], [4.0, 5.0, 6.0, 3.5]];
        assert_eq!(spheres(&scene), expected, "{section}");
        assert_eq!(warnings(&scene), "");
    }
}

const CIF: &str = "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n\
                   _atom_site.pdbx_PDB_model_num\n";

#[test]
fn comments_and_blocks_of_mmcif_end_no_table() {
    let c = [1.0, 2.0, 3.0];
    let o = [4.0, 5.0, 6.0];
    let both = format!("{CIF}C 1 2 3 1\n# of the water\n\nO 4 5 6 1\n#\n");
    assert_eq!(said("a.cif", both, "", &[c, o]), "");
    // Two blocks are two frames, and so are models whatever the case of their column.
    let block = |row: &str| format!("{CIF}{row}\n#\nloop_\n_other.x\n1\n");
    let blocks = block("C 1 2 3 1") + &block("O 4 5 6 1");
    let models = format!("{CIF}C 1 2 3 1\nO 4 5 6 2\n#\n").to_lowercase();
    for text in [&blocks, &models] {
        let told = said("a.cif", text, "", &[c]);
        assert!(
            told.contains("the first frame of several is shown"),
            "{told}"
        );
        let (steps, is_said) = cut::shown("a.cif", text.as_bytes(), "frames: All").unwrap();
        let x: Vec<f64> = steps.iter().map(|step| step[0].center().x).collect();
        assert_eq!((x, is_said), (vec![1.0, 4.0], false));
    }
    for (text, expected) in [
        (
            blocks.replacen(
                "_atom_site.Cartn_x\n_atom_site.Cartn_y",
                "_atom_site.Cartn_y\n_atom_site.Cartn_x",
                1,
            ),
            "a.cif:15:1: expected the columns of the atoms before, in the same order, found `_atom_site.type_symbol`",
        ),
        (
            format!("{CIF}C 1 2 3 1\n;text\n;\n"),
            "a.cif:9:1: expected an atom on one line, without text of several lines, found `;text`",
        ),
        (
            "data_x\n_atom_site.type_symbol C\n_atom_site.Cartn_x 1\n".to_owned(),
            "a.cif:2:1: expected a loop of `_atom_site.…`, whose rows are atoms, found `_atom_site.type_symbol C`",
        ),
    ] {
        assert_eq!(refusal("a.cif", text, "frames: All"), expected);
    }
}

#[test]
fn files_whose_lines_end_with_carriage_returns_alone_are_refused() {
    assert_eq!(
        refusal("a.csv", "x,y,z,r,id\r1,2,3,1,7\r4,5,6,1,8\r", ""),
        "a.csv:1:11: expected lines that end with a line feed, found only carriage returns"
    );
}

#[test]
fn a_first_line_that_counts_columns_is_said() {
    let told = said(
        "a.csv",
        "0,1,2\n5,6,7\n",
        "radius: 1",
        &[[0.0, 1.0, 2.0], [5.0, 6.0, 7.0]],
    );
    let expected = "a.csv:1: the first line numbers the columns, and is read as a sphere: names of columns cannot be numbers";
    assert_eq!(told, expected);
    assert_eq!(
        said("a.csv", "0,1,2.0\n", "radius: 1", &[[0.0, 1.0, 2.0]]),
        ""
    );
}
