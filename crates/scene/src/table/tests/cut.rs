//! Files that end too early: refused, or said where the format cannot tell.

use super::formats::npz;
use super::*;

const GRO: &str = "water\n2\n    1SOL     OW    1   0.100   0.200   0.300\n    1SOL    HW1    2   0.150   0.200   0.300\n   1.00000   1.00000   1.00000\n";
const DUMP: &str = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z radius\n1 0.25 0.5 0.75 1.25\n2 1.25 1.5 1.75 1.25\n";
const ATOM: &str =
    "ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.00           N\n";
const CIF: &str = "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.pdbx_PDB_model_num\n";
const VTK: &str = "# vtk DataFile Version 3.0\np\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3\n4 5 6\nPOINT_DATA 2\nSCALARS radius float 1\nLOOKUP_TABLE default\n2.5\n3.5\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\nend_header\n1 2 3 1.5\n4 5 6 1.5\n";

/// Every step of a scene, and what is said of it.
pub(super) fn shown(
    name: &str,
    bytes: &[u8],
    fields: &str,
) -> Result<(Vec<Vec<Sphere>>, bool), String> {
    let folder = Folder::new();
    fs::write(folder.0.join(name), bytes).unwrap();
    let text = format!(
        "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [(file: \"{name}\", {fields})])"
    );
    let scene =
        Scene::parse(&text, &folder.0.join("scene.ron")).map_err(|error| error.to_string())?;
    let frames = scene.frames().unwrap_or(1..=1);
    let worlds = frames.map(|frame| {
        let world = scene.world_at(frame).map_err(|error| error.to_string())?;
        // Again, as after another one.
        let again = scene.world_at(frame).map_err(|error| error.to_string())?;
        assert_eq!(world.spheres(), again.spheres());
        Ok(world.spheres().to_vec())
    });
    let worlds: Result<_, String> = worlds.collect();
    Ok((worlds?, !scene.warnings().is_empty()))
}

/// Cuts a table everywhere behind `start`: it is refused, or what it shows is said to be in doubt, or every step that it
/// shows is whole.
pub(super) fn check(name: &str, bytes: &[u8], start: usize, fields: &str) {
    let (whole, is_doubted) = shown(name, bytes, fields).unwrap();
    assert!(!is_doubted, "{name} is whole");
    for end in start + 1..bytes.len() {
        if let Ok((found, false)) = shown(name, &bytes[..end], fields) {
            let cut = String::from_utf8_lossy(&bytes[start..end]);
            let is_whole = !found.is_empty() && whole.starts_with(&found);
            assert!(
                is_whole,
                "{name} cut at byte {end}, after {cut:?}: {found:?}"
            );
        }
    }
}

#[test]
fn a_step_that_is_cut_is_no_step() {
    let xyz = "2\n\nC 1.25 2.5 3.75\nO 4.25 5.5 6.75\n";
    let model = |number: u32| format!("MODEL     {number:4}\n{ATOM}{ATOM}ENDMDL\n");
    let rows = |model: u32| format!("C 1.5 2.5 3.5 {model}\nO 4.5 5.5 6.5 {model}\n");
    let all = "frames: All";
    for (name, first, last, fields) in [
        ("a.xyz", xyz.to_owned(), xyz.to_owned(), all),
        ("a.dump", DUMP.to_owned(), DUMP.to_owned(), all),
        ("a.gro", GRO.to_owned(), GRO.to_owned(), all),
        ("a.pdb", model(1), model(2) + "END\n", all),
        (
            "a.pdb",
            format!("{ATOM}{ATOM}END\n"),
            format!("{ATOM}{ATOM}END\n"),
            all,
        ),
        ("a.cif", CIF.to_owned() + &rows(1), rows(2) + "#\n", all),
        ("a.pdb", String::new(), format!("{ATOM}{ATOM}END\n"), ""),
        ("a.cif", CIF.to_owned(), rows(1) + "#\n", ""),
        ("a.pdb", String::new(), model(1), ""),
    ] {
        let start = first.len();
        check(name, (first + &last).as_bytes(), start, fields);
    }
}

/// A file of one frame, cut at each line: a number may be cut, and no format has a mark after the last line.
#[test]
fn a_table_that_is_cut_at_a_line_is_no_table() {
    let ends = |text: &str| -> Vec<usize> {
        let ends = text.char_indices().filter(|(_, letter)| *letter == '\n');
        ends.map(|(at, _)| at + 1).collect()
    };
    for (name, text) in [
        ("a.gro", GRO),
        ("a.dump", DUMP),
        ("a.vtk", VTK),
        ("a.ply", PLY),
    ] {
        let (whole, _) = shown(name, text.as_bytes(), "").unwrap();
        for end in ends(text) {
            match shown(name, &text.as_bytes()[..end], "") {
                Ok((found, _)) => assert!(end == text.len() && found == whole, "{name} {end}"),
                Err(message) => assert!(message.contains("found "), "{message}"),
            }
        }
    }
    // What points have beside their places is announced, and missing.
    let announced = VTK.split_inclusive("POINT_DATA 2\n").next().unwrap();
    let scene = scene("a.vtk", announced, "radius: 1");
    let expected = "a.vtk:8: the file ends after a header for numbers of points or cells: the numbers may have \
         been cut off";
    assert_eq!(scene.warnings(), [expected]);
}

#[test]
fn bytes_that_are_cut_are_no_table() {
    let header =
        |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}");
    let frames = npy(&header("(2, 1, 4)"), &doubles(&TWO.concat()));
    let start = frames.len() - 32;
    check("a.npy", &frames, start, "frames: All");
    let table = npy(&header("(2, 4)"), &doubles(&TWO.concat()));
    check("a.npy", &table, 0, "");
    check("a.npz", &npz(&[("a", table)]), 0, "");
    check("a.ply", &binary_ply(), 0, "");
}

#[test]
fn ends_that_formats_do_not_tell_are_said() {
    let said =
        |name: &str, text: &str, fields: &str| scene(name, text, fields).warnings().join("; ");
    let cut = format!("{ATOM}{ATOM}");
    assert_eq!(
        said("a.pdb", &cut, ""),
        "a.pdb:2: the file ends with an atom, without `TER` or `END`: others may have been cut off"
    );
    assert_eq!(said("a.pdb", &(cut.clone() + "TER\n"), ""), "");
    // What is compressed is whole.
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut gzip, cut.as_bytes()).unwrap();
    let whole = scene("a.pdb.gz", gzip.finish().unwrap(), "");
    assert!(whole.warnings().is_empty());
    // A box of numbers that fill their columns.
    let wide = GRO.replace("   1.00000   1.00000", "40000.0000040000.00000");
    assert_eq!(said("a.gro", &wide, ""), "");
    let cut = CIF.to_owned() + "C 1 2 3 1\n";
    assert_eq!(
        said("a.cif", &cut, "frames: All"),
        "a.cif:8: the file ends with an atom, without a line `#`: others may have been cut off"
    );
    let two = "1\n\nC 1 2 3\n1\n\nC 1 2 34";
    assert_eq!(
        said("a.xyz", two, "frames: All"),
        "a.xyz:6: the file ends within this line: its last number may have been cut off"
    );
    for (text, expected) in [
        (
            format!("MODEL        1\n{ATOM}MODEL        2\n{ATOM}ENDMDL\n"),
            "a.pdb:3:1: expected `ENDMDL` after the atoms of this model, found `MODEL        2`",
        ),
        (
            format!("MODEL        1\n{ATOM}"),
            "a.pdb:3:1: expected `ENDMDL` after the atoms of this model, found the end of the file",
        ),
    ] {
        assert_eq!(refusal("a.pdb", text, ""), expected);
    }
    let no_box = GRO.replace("   1.00000   1.00000   1.00000\n", "");
    assert_eq!(
        refusal("a.gro", no_box, ""),
        "a.gro:5:1: expected the three or nine numbers of the box after the atoms, found the end of the file"
    );
}

/// The lines after the rows of small frames are not read again for each frame.
#[test]
fn many_small_frames_are_read_once_each() {
    use crate::table::{Frames, Request};
    const FRAMES: usize = 3000;
    let rows = (0..FRAMES).map(|model| format!("C 1 2 3 {model}\n"));
    let cif = CIF.to_owned() + &rows.collect::<String>() + "#\n";
    let pdb = format!("MODEL        1\n{ATOM}ENDMDL\n").repeat(FRAMES);
    for (name, text) in [("a.cif", cif), ("a.pdb", pdb)] {
        let folder = Folder::new();
        let path = folder.0.join(name);
        fs::write(&path, &text).unwrap();
        let mut frames = Frames::open(&path, &|_, _| {}).unwrap();
        let mut count = 0;
        while frames.read(&Request::default()).unwrap().is_some() {
            count += 1;
        }
        assert_eq!(count, FRAMES);
        // A frame is handed out with the 4 kB that its rows may take.
        let handed_out = frames.handed_out();
        assert!(handed_out < 5000 * FRAMES as u64, "{name}: {handed_out}");
    }
}
