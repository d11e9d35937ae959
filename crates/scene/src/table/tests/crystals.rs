//! Crystals in CIF.

use super::*;

/// The atoms of a scene, as `symbol x y z`, with their places to 1e-4, in any order.
pub(super) fn atoms(scene: &Scene, symbols: &[(f64, &str)]) -> Vec<(String, [f64; 3])> {
    let atom = |sphere: [f64; 4]| {
        let symbol = symbols.iter().find(|(radius, _)| *radius == sphere[3]);
        (
            symbol.unwrap().1.to_owned(),
            [sphere[0], sphere[1], sphere[2]],
        )
    };
    spheres(scene).into_iter().map(atom).collect()
}

/// Lines `symbol x y z` behind one that begins with `#`.
fn frozen(text: &str) -> Vec<(String, [f64; 3])> {
    let atom = |line: &str| {
        let mut words = line.split(' ');
        let symbol = words.next().unwrap().to_owned();
        let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
        (symbol, [numbers[0], numbers[1], numbers[2]])
    };
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(atom)
        .collect()
}

/// Says which atoms of one list are not in the other, but for whole cells by these edges.
pub(super) fn check(found: &[(String, [f64; 3])], expected: &str) {
    let expected = frozen(expected);
    assert_eq!(found.len(), expected.len());
    for (symbol, at) in &expected {
        let is_same = |(other, place): &&(String, [f64; 3])| {
            other == symbol && (0..3).all(|axis| (place[axis] - at[axis]).abs() < 2e-4)
        };
        assert_eq!(
            found.iter().filter(is_same).count(),
            1,
            "{symbol} at {at:?} of {found:?}"
        );
    }
}

/// A data block with these items, symmetry, columns and rows.
fn cif(symmetry: &str, columns: &str, rows: &str) -> String {
    let columns = columns
        .split(' ')
        .map(|name| format!("_atom_site_{name}\n"));
    format!(
        "data_a\n_cell_length_a 4\n_cell_length_b 5\n_cell_length_c 6\n_cell_angle_alpha 90\n_cell_angle_beta 90\n\
         _cell_angle_gamma 90\n{symmetry}loop_\n{}{rows}",
        columns.collect::<String>()
    )
}

const PLACES: &str = "label fract_x fract_y fract_z";
const INVERSION: &str =
    "loop_\n_space_group_symop_id\n_space_group_symop_operation_xyz\n1 'x, y, z'\n2 '-x, -y, -z'\n";

/// Against ASE 3.29.0, whose cells of 2 x 2 x 2 are frozen in `crystals`.
#[test]
fn eight_cells_of_a_crystal_are_those_of_ase() {
    let fields = "radii: Covalent, repeat: (2, 2, 2)";
    let quartz = scene("quartz.cif", include_str!("crystals/quartz.cif"), fields);
    check(
        &atoms(&quartz, &[(1.11, "Si"), (0.66, "O")]),
        include_str!("crystals/quartz.txt"),
    );
    assert_eq!((quartz.clouds()[0].rows, quartz.clouds()[0].kept), (2, 2));
}

#[test]
fn equivalent_atoms_on_one_place_are_one() {
    let count = |place: &str| {
        let text = cif(INVERSION, PLACES, &format!("C1 {place}\n"));
        spheres(&scene("a.cif", text, "")).len()
    };
    for (place, expected) in [
        ("0 0 0", 1),
        (".5 0 .5", 1),
        ("1 2 -3", 1),
        ("0.0004 0 0", 1),
        ("0.0006 0 0", 2),
        ("0.9996 0.5 0", 1),
        ("0.1 0.2 0.3", 2),
    ] {
        assert_eq!(count(place), expected, "{place}");
    }
    let text = cif(INVERSION, PLACES, "C1 -0.25 1.5 0.125\n");
    let found = spheres(&scene("a.cif", text, "radius: 1"));
    assert_eq!(found, [[3.0, 2.5, 0.75, 1.0], [1.0, 2.5, 5.25, 1.0]]);
}

/// Without symmetry, atoms stay where the file has them.
#[test]
fn atoms_of_p1_are_not_moved() {
    for symmetry in [
        "_symmetry_space_group_name_H-M 'P 1'\n",
        "_space_group_IT_number 1\n",
        "_symmetry_equiv_pos_as_xyz 'x,y,z'\n",
        "_space_group_symop.operation_xyz x,y,z\n",
    ] {
        let scene = scene(
            "a.cif",
            cif(symmetry, PLACES, "C1 -0.25 1.5 0.125\n"),
            "radius: 1",
        );
        assert_eq!(spheres(&scene), [[-1.0, 7.5, 0.75, 1.0]], "{symmetry}");
        assert_eq!(warnings(&scene), "", "{symmetry}");
    }
    let unknown = scene("a.cif", cif("", PLACES, "C1 0 0 0\n"), "");
    assert!(warnings(&unknown).contains("neither symmetry operations nor a space group"));
}

#[test]
fn space_groups_without_operations_are_refused() {
    let text = cif(
        "_symmetry_space_group_name_H-M 'F m -3 m'\n",
        PLACES,
        "C1 0 0 0\n",
    );
    let message = refusal("a.cif", text, "");
    let expected = "a.cif:8:32: expected symmetry operations (a loop of `_space_group_symop_operation_xyz`), because the \
                    space group `F m -3 m` is not P 1, found none: write all atoms of the cell with ASE";
    assert!(message.starts_with(expected), "{message}");
}

/// Values have uncertainties, lie on several lines, or are missing; items follow the atoms; labels tell elements.
#[test]
fn lists_of_atoms_have_many_forms() {
    let expected = [[1.0, 2.5, 1.5, 0.76], [2.0, 1.25, 3.0, 0.66]];
    let p1 = "_space_group_IT_number 1\n";
    let plain = cif(p1, PLACES, "C1 0.25 0.5 0.25\nO2 0.5 0.25 0.5\n");
    let rest = plain.find("loop_").unwrap();
    let behind = format!(
        "data_a\n{}{}",
        &plain[rest..],
        &plain["data_a\n".len()..rest]
    );
    let text_field = "data_b\n_note\n;\n_atom_site_fract_x\ndata_c\n;\n";
    for text in [
        plain.clone(),
        behind,
        plain.replace("_atom_site_", "_atom_site."),
        plain.replace("data_a\n", text_field),
        plain.replace('\n', "\r\n"),
        plain.replace("0.25 0.5 0.25", "0.2500(3) .5 2.5E-1(12)"),
        plain.replace("C1 0.25 0.5 0.25\nO2", "C1 0.25\n  0.5\n0.25 O2"),
        plain.replace("_atom_site_label", "_atom_site_type_symbol"),
        plain.replace("C1 0.25", "'C1' '0.25'"),
        plain.replace("C1 0.25", ";C1\n; 0.25"),
        plain.clone() + "loop_\n_atom_site_aniso_label\n_atom_site_aniso_U_11\nC1 0.1\nO2 0.2\n",
        plain.replace("loop_\n", "loop_\n_atom_type_symbol\nC O\nloop_\n"),
    ] {
        assert_eq!(
            spheres(&scene("a.cif", &text, "radii: Covalent")),
            expected,
            "{text}"
        );
    }
    let columns = "label type_symbol fract_x fract_y fract_z";
    let ions = cif(p1, columns, "C1A C4+ 0.25 0.5 0.25\nOw O2- 0.5 0.25 0.5\n");
    assert_eq!(spheres(&scene("a.cif", ions, "radii: Covalent")), expected);
}

#[test]
fn what_a_crystal_leaves_open_is_said() {
    let p1 = "_space_group_IT_number 1\n";
    let columns = "label fract_x fract_y fract_z occupancy";
    let rows = "C1 0.25 0.5 0.25 1\nO2 0.5 0.25 0.5 0.70(1)\nO3 0.55 0.25 0.5 0.3\nH4 ? ? ? 1\nH5 . . . .\n";
    let partial = scene("a.cif", cif(p1, columns, rows), "");
    assert_eq!(spheres(&partial).len(), 3);
    let told = warnings(&partial);
    assert!(
        told.contains("a.cif:16:1: atoms with an occupancy below 1 are shown as all others"),
        "{told}"
    );
    assert!(told.contains("some cells: 2 in the list"), "{told}");
    assert!(
        told.contains("a.cif:18:1: atoms without coordinates are left out: 2, of which"),
        "{told}"
    );
    let kept = "keep: [(\"occupancy\", Between(0.5, 1))]";
    let kept = scene("a.cif", cif(p1, columns, rows), kept);
    assert_eq!(spheres(&kept).len(), 2);
    assert_eq!((kept.clouds()[0].rows, kept.clouds()[0].kept), (3, 2));
    let shared = scene(
        "a.cif",
        cif(p1, PLACES, "Na1 0 0 0\nK1 0.0005 0 1\nK2 0.5 0 0\n"),
        "",
    );
    assert_eq!(spheres(&shared).len(), 2);
    assert!(
        warnings(&shared)
            .contains("from one that the file lists before, as those of disordered crystals do: 1")
    );
}

/// Data blocks are frames, with their own cells and symmetry.
#[test]
fn data_blocks_are_frames() {
    let first = cif(INVERSION, PLACES, "C1 0.25 0.5 0.25\n");
    let second = cif(
        "_space_group_IT_number 1\n",
        PLACES,
        "C1 0.25 0.5 0.25\nO2 0 0 0\nN3 .1 .1 .1\n",
    );
    let second = second
        .replace("data_a", "data_b")
        .replace("length_a 4", "length_a 8");
    let text = format!("data_global\n_journal_year 2026\n{first}{second}");
    let one = scene("a.cif", &text, "");
    assert_eq!(spheres(&one).len(), 2);
    assert!(
        warnings(&one).contains("the first frame of several is shown"),
        "{}",
        warnings(&one)
    );
    let folder = Folder::new();
    fs::write(folder.0.join("a.cif"), text).unwrap();
    let scene = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
        clouds: [(file: \"a.cif\", frames: All)])";
    let series = Scene::parse(scene, &folder.0.join("scene.ron")).unwrap();
    let world = |frame| series.world_at(frame).unwrap();
    assert_eq!((world(2).spheres().len(), world(1).spheres().len()), (3, 2));
    assert_eq!(world(2).spheres()[0].center().x, 2.0);
}

#[test]
fn damaged_crystals_are_refused_with_their_lines() {
    let p1 = "_space_group_IT_number 1\n";
    let good = cif(INVERSION, PLACES, "C1 0.25 0.5 0.25\nO2 0.5 0.25 0.5\n");
    for (text, expected) in [
        (
            good.replace("O2 0.5 0.25 0.5", "O2 0.5 0.25"),
            "a.cif:19:1: expected 4 values for this atom, one for each column, found 3",
        ),
        (
            good.replace("O2 0.5 0.25 0.5", "O2 0.5 nan 0.5"),
            "a.cif:19:8: expected a finite number for `fract_y`, found `nan`",
        ),
        (
            good.replace("O2 0.5 0.25 0.5", "O2 0.5(1) x(2) 0.5"),
            "a.cif:19:11: expected a number for `fract_y`, found `x(2)`",
        ),
        (
            good.replace("-x, -y, -z", "-x, -y"),
            "a.cif:12:3: expected a symmetry operation such as `-y, x-y, z+1/3`, found `'-x, -y'`",
        ),
        (
            good.replace("-x, -y, -z", "x, x, z"),
            "a.cif:12:3: expected a symmetry operation",
        ),
        (
            good.replace("_cell_length_c 6\n", ""),
            "a.cif:19:1: expected the cell of the crystal (`_cell_length_a` to `_cell_angle_gamma`) in this data block, found none",
        ),
        (
            good.replace("length_c 6", "length_c ?"),
            "a.cif:20:1: expected the cell of the crystal",
        ),
        (
            good.replace("length_c 6", "length_c six"),
            "a.cif:7:1: expected a cell with lengths greater than 0",
        ),
        (
            good.replace("gamma 90", "gamma 180"),
            "a.cif:7:1: expected a cell with lengths greater than 0",
        ),
        (
            good.clone() + "_note\n;\nabc\n",
            "a.cif:23:1: expected a line `;`, which ends the text that line 21 starts, found the end of the file",
        ),
        (
            cif(p1, "label fract_x fract_y", "C1 0 0\n"),
            "a.cif:10:1: expected a column `z`, found",
        ),
        (
            "data_a\n_cell_length_a 1\n".to_owned(),
            "a.cif:3:1: expected a loop of `_atom_site.…`, of `_atom_site_fract_x` and others, or of",
        ),
    ] {
        let message = refusal("a.cif", &text, "radii: Covalent");
        assert!(message.starts_with(expected), "{message}\n{text}");
    }
    let many: String = (0..385).map(|place| format!("{place} x,y,z\n")).collect();
    let message = refusal("a.cif", good.replace("2 '-x, -y, -z'\n", &many), "");
    assert!(
        message.contains("expected at most 384 symmetry operations"),
        "{message}"
    );
    assert!(
        load("a.cif", good.trim_end(), "")
            .is_ok_and(|scene| warnings(&scene).contains("the file ends within this line"))
    );
}

/// Any byte of it may be another one.
#[test]
fn damaged_bytes_of_crystals_are_found_or_harmless() {
    let text = cif(
        INVERSION,
        "label fract_x fract_y fract_z occupancy",
        "C1 0.25(1) 0.5 0.25 .\n 'O 2' 0.5\n;0.2\n;\n 0.5 1\n_note\n;\na\n;\n",
    );
    for at in 0..text.len() {
        let _ = load("a.cif", &text[..at], "edges: true, radius: 1");
        for other in [b'\n', b';', b'_'] {
            let mut bytes = text.clone().into_bytes();
            bytes[at] = other;
            if let Err(message) = load("a.cif", bytes, "edges: true, radius: 1") {
                assert!(
                    message.contains("expected ") && message.contains("found "),
                    "{message}"
                );
            }
        }
    }
}
