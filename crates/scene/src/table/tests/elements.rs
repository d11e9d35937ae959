//! Elements: what radii, colors, categories and conditions go by.

use super::*;

const TIP4P: &str = "four-site water, nm
8
    1SOL     OW    1   0.000   0.000   0.000
    1SOL    HW1    2   0.096   0.000   0.000
    1SOL    HW2    3  -0.024   0.093   0.000
    1SOL     MW    4   0.013   0.010   0.000
    2SOL     OW    5   0.400   0.000   0.000
    2SOL    HW1    6   0.496   0.000   0.000
    2SOL    HW2    7   0.376   0.093   0.000
    2SOL     MW    8   0.413   0.010   0.000
   1.00000   1.00000   1.00000
";

fn radii(scene: &Scene) -> Vec<f64> {
    let round = |radius: f64| (1e6 * radius).round() / 1e6;
    scene
        .world()
        .spheres()
        .iter()
        .map(|sphere| round(sphere.radius()))
        .collect()
}

/// The names of the colors, in their order.
fn names(scene: &Scene) -> Vec<String> {
    match scene.clouds()[0]
        .colors
        .as_ref()
        .map(|colors| &colors.meaning)
    {
        Some(crate::ColorMeaning::Categories(all)) => all.iter().map(|all| all.0.clone()).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn what_is_no_element_is_shown_as_others_and_said() {
    let scene = scene("a.gro", TIP4P, "");
    assert_eq!(
        radii(&scene),
        [0.152, 0.11, 0.11, 0.1, 0.152, 0.11, 0.11, 0.1]
    );
    assert_eq!(albedos(&scene)[3], from_srgb(0xff80c0));
    assert_eq!(
        warnings(&scene),
        "a.gro:6:14: expected elements with known radii and colors, found `MW` (2 rows) (for these, marbles uses \
         `others: (radius: 1, color: \"#ff80c0\")`)"
    );
    assert_eq!(names(&scene), ["others", "H", "O"]);
    // Whoever says what others have knows of them.
    let said = self::scene("a.gro", TIP4P, "others: (radius: 0.5, color: \"#0000ff\")");
    assert_eq!(
        (radii(&said)[3], albedos(&said)[3]),
        (0.05, from_srgb(0x0000ff))
    );
    assert_eq!(warnings(&said), "");
    for fields in [
        "keep: [(\"name\", Is(\"OW\"))]",
        "keep: [(\"element\", Is(\"O\"))]",
    ] {
        let kept = self::scene("a.gro", TIP4P, fields);
        assert_eq!(
            (radii(&kept), warnings(&kept)),
            (vec![0.152; 2], String::new()),
            "{fields}"
        );
    }
    let kept = self::scene(
        "a.gro",
        TIP4P,
        "keep: [(\"element\", Is(\"MW\"))], radius: 1, color: Material",
    );
    assert_eq!((radii(&kept).len(), warnings(&kept)), (2, String::new()));
    let names_of_many: String = (0..20).map(|bead| format!("B{bead} 0 0 0\n")).collect();
    let many = self::scene(
        "a.xyz",
        format!("20\n\n{names_of_many}"),
        "radius: 1, color: Material",
    );
    assert_eq!(warnings(&many), "");
    let beads: String = (0..20).map(|bead| format!("Q{bead} 0 0 0\n")).collect();
    let many = warnings(&self::scene("a.xyz", format!("20\n\n{beads}"), ""));
    assert!(many.contains("`Q7` (1 row), others (12 rows)"), "{many}");
}

#[test]
fn isotopes_numbers_and_labels_are_elements() {
    let rows = "D 0 0 0\nT 0 0 0\n2H 0 0 0\nFe2+ 0 0 0\nX 0 0 0\n";
    let scene = scene("a.xyz", format!("5\n\n{rows}"), "");
    assert_eq!(radii(&scene), [1.1, 1.1, 1.1, 2.04, 1.0]);
    assert!(
        warnings(&scene).starts_with("a.xyz:7:1: "),
        "{}",
        warnings(&scene)
    );
    let heavy = "keep: [(\"element\", Is(\"D\"))]";
    assert_eq!(
        radii(&self::scene("a.xyz", format!("5\n\n{rows}"), heavy)),
        [1.1]
    );
    let hydrogen = "keep: [(\"element\", Is(\"H\"))]";
    assert_eq!(
        radii(&self::scene("a.xyz", format!("5\n\n{rows}"), hydrogen)),
        [1.1; 3]
    );
    let csv = "element,x,y,z\n8,0,0,0\n1,0,0,0\nC7,0,0,0\n";
    assert_eq!(radii(&self::scene("a.csv", csv, "")), [1.52, 1.1, 1.7]);
    let misspelled = warnings(&self::scene("a.xyz", "1\n\nCxx1 0 0 0\n", ""));
    assert!(misspelled.contains("found `Cxx1` (1 row)"), "{misspelled}");
}

/// One notion of elements: colors, categories, palettes, conditions.
#[test]
fn values_by_element_are_those_of_its_colors() {
    for fields in ["", "value: \"element\"", "color: Element"] {
        let scene = scene("a.gro", TIP4P, fields);
        assert_eq!(names(&scene), ["others", "H", "O"], "{fields}");
        assert_eq!(albedos(&scene)[0], from_srgb(0xff0d0d), "{fields}");
    }
    let categories = scene("a.gro", TIP4P, "value: \"element\", color: Category");
    assert_eq!(names(&categories), ["H", "MW", "O"]);
    let folder = Folder::new();
    fs::write(folder.0.join("a.gro"), TIP4P).unwrap();
    let text = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [(file: \"a.gro\")])";
    let scene = Scene::parse(text, &folder.0.join("scene.ron")).unwrap();
    let columns = scene.columns(0).unwrap();
    let element = columns
        .iter()
        .find(|column| column.name == "element")
        .unwrap();
    let crate::ColumnContents::Texts { examples, .. } = &element.contents else {
        panic!("{element:?}")
    };
    assert_eq!(examples[..], ["O", "H", "MW"]);
}

#[test]
fn single_elements_have_radii_and_colors_of_the_scene() {
    let fields =
        "radii: {\"O\": 1.2, \"MW\": 0.3}, palette: {\"O\": \"#00f\", \"MW\": \"#123456\"}";
    let scene = scene("a.gro", TIP4P, fields);
    assert_eq!(radii(&scene)[..4], [0.12, 0.11, 0.11, 0.03]);
    let expected = [0x0000ff, 0xffffff, 0xffffff, 0x123456].map(from_srgb);
    assert_eq!(albedos(&scene)[..4], expected);
    assert_eq!(
        (names(&scene), warnings(&scene)),
        (vec!["H".into(), "O".into(), "MW".into()], String::new())
    );
    // An isotope by its own name, an element by that of either.
    let heavy = "2\n\nD 0 0 0\nH 0 0 0\n";
    let isotope = self::scene(
        "a.xyz",
        heavy,
        "palette: {\"D\": \"#0000ff\"}, radii: {\"h\": 2}",
    );
    assert_eq!(albedos(&isotope), [from_srgb(0x0000ff), Color::ONE]);
    assert_eq!(
        (radii(&isotope), warnings(&isotope)),
        (vec![2.0; 2], String::new())
    );
    let unused = warnings(&self::scene("a.xyz", heavy, "radii: {\"O\": 2}"));
    assert!(
        unused.contains("scene.ron:2:33: `radii` has radii for \"O\", which match no row: "),
        "{unused}"
    );
    let unused = warnings(&self::scene("a.xyz", heavy, "radius: 1, radii: {\"H\": 2}"));
    assert!(unused.contains("`radii` has radii for \"H\""), "{unused}");
    let twice = refusal("a.xyz", heavy, "radii: {\"O\": 2, \"O\": 1}");
    assert!(
        twice.contains("expected every element once, found \"O\" a second time"),
        "{twice}"
    );
    let message = refusal("a.xyz", heavy, "radii: {\"O\": 0}");
    assert!(
        message.contains("expected a radius greater than 0, found 0"),
        "{message}"
    );
}

#[test]
fn types_of_lammps_are_no_atomic_numbers() {
    let types = "3\nAtoms. Timestep: 0\n1 0 0 0\n2 0 0 1\n1 0 0 2\n";
    for text in [
        types.to_owned(),
        types.replace("Atoms. Timestep: 0", "of another program"),
    ] {
        let scene = scene("a.xyz", &text, "");
        assert_eq!(radii(&scene), [1.0; 3]);
        let told = warnings(&scene);
        let guess = "a.xyz:3:1: the numbers in the column `element` are read as types of atoms";
        assert!(told.starts_with(guess), "{told}");
        assert!(told.contains("found `1` (2 rows), `2` (1 row)"), "{told}");
    }
    let said = "radii: {\"1\": 2, \"2\": 3}, palette: {\"1\": 0.5, \"2\": 1}";
    assert_eq!(radii(&scene("a.xyz", types, said)), [2.0, 3.0, 2.0]);
    let numbers = "columns: (element: \"element\")";
    let helium = scene("a.xyz", types, numbers);
    assert_eq!(
        (radii(&helium), warnings(&helium)),
        (vec![1.1, 1.4, 1.1], String::new())
    );
    let water = scene("a.xyz", "3\n\n8 0 0 0\n1 0 0 1\n1 0 0 2\n", "");
    assert_eq!(radii(&water), [1.52, 1.1, 1.1]);
    assert!(
        warnings(&water).contains("read as atomic numbers"),
        "{}",
        warnings(&water)
    );
    // Nothing is guessed where nothing goes by it.
    assert_eq!(
        warnings(&scene("a.xyz", types, "radius: 1, color: Material")),
        ""
    );
}

/// Every frame reads numbers as the first one does.
#[test]
fn all_frames_take_numbers_for_the_same() {
    let folder = Folder::new();
    let text = "2\n\n8 0 0 0\n1 0 0 1\n1\n\n1 0 0 0\n";
    fs::write(folder.0.join("a.xyz"), text).unwrap();
    let scene = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
        clouds: [(file: \"a.xyz\", frames: All)])";
    let scene = Scene::parse(scene, &folder.0.join("scene.ron")).unwrap();
    assert_eq!(scene.world_at(2).unwrap().spheres()[0].radius(), 1.1);
}

/// An unknown element of a later step is told when the step is read, once.
#[test]
fn unknown_elements_of_later_steps_are_told() {
    let folder = Folder::new();
    let text = "1\n\nO 0 0 0\n1\n\nMW 0 0 0\n1\n\nMW 0 0 0\n";
    fs::write(folder.0.join("a.xyz"), text).unwrap();
    let scene = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
        clouds: [(file: \"a.xyz\", frames: All)])";
    let scene = Scene::parse(scene, &folder.0.join("scene.ron")).unwrap();
    assert!(scene.warnings().is_empty() && scene.take_late_warnings().is_empty());
    for frame in 1..=3 {
        scene.world_at(frame).unwrap();
    }
    let late = scene.take_late_warnings();
    assert_eq!(late.len(), 1, "{late:?}");
    assert!(
        late[0].contains("a.xyz:6:1: ") && late[0].contains("`MW` (1 row)"),
        "{late:?}"
    );
    assert!(scene.take_late_warnings().is_empty());
}

pub(super) const PQR: &str = "REMARK   a small thing
ATOM      1  N   ALA     1      46.457  12.189  21.556  0.1414 1.8240
ATOM      2  CA  ALA A   1      47.614  11.997  22.448  0.0962 1.9080
HETATM10003  H   ALA A  16A     45.900  12.900  21.900  0.1997 0.6000
TER
ATOM 4 O1 LIG A 16 A -1 -2 -3 -0.5 1.5
END
";

#[test]
fn pqr_has_radii_of_its_own() {
    let scene = scene("a.pqr", PQR, "");
    assert_eq!(radii(&scene), [1.824, 1.908, 0.6, 1.5]);
    assert_eq!(names(&scene), ["H", "C", "N", "O"]);
    assert_eq!(spheres(&scene)[1][..3], [47.614, 11.997, 22.448]);
    let first = self::scene(
        "a.pqr",
        PQR,
        "keep: [(\"chain\", Is(\"A\")), (\"charge\", Between(-1, 0))]",
    );
    assert_eq!(radii(&first), [1.5]);
    let charged = self::scene("a.pqr", PQR, "value: \"charge\"");
    assert_eq!(
        charged.clouds()[0]
            .colors
            .as_ref()
            .unwrap()
            .column
            .as_deref(),
        Some("charge")
    );
    // By what the file says of itself, too.
    let named = PQR.replace("a small thing", "1 PQR file generated by PDB2PQR");
    assert_eq!(
        radii(&self::scene("a.txt.unknown", &named, "")),
        [1.824, 1.908, 0.6, 1.5]
    );
    let broken = PQR.replace("  0.0962 1.9080", "");
    let expected = "a.pqr:3:55: expected a value for `charge`, found the end of the line";
    assert_eq!(refusal("a.pqr", broken, ""), expected);
}

/// Force fields give hydrogen atoms that are bound to oxygen the radius 0.
#[test]
fn atoms_of_pqr_with_the_radius_0_are_left_out() {
    let zero = PQR
        .replace(" 0.6000", " 0.0000")
        .replace("-0.5 1.5", "-0.5 0");
    let scene = scene("a.pqr", &zero, "");
    assert_eq!(radii(&scene), [1.824, 1.908]);
    assert_eq!(
        warnings(&scene),
        "a.pqr:4:1: atoms with a radius of 0 are left out: 2, of which this is the first (`radius: 1` shows all atoms, \
         with one radius)"
    );
    let kept = self::scene("a.pqr", &zero, "keep: [(\"radius\", Between(0.1, 9))]");
    assert_eq!(
        (radii(&kept), warnings(&kept)),
        (vec![1.824, 1.908], String::new())
    );
    assert_eq!(radii(&self::scene("a.pqr", &zero, "radius: 1")), [1.0; 4]);
    let negative = PQR.replace(" 0.6000", " -0.600");
    let expected = "a.pqr:4:64: expected a radius greater than 0 for `radius`, found -0.600";
    assert_eq!(refusal("a.pqr", &negative, ""), expected);
}

#[test]
fn names_of_pdb_tell_elements_by_their_residues() {
    let line = |record: &str, name: &str, residue: &str, element: &str| {
        format!(
            "{record:<6}    1 {name:<4} {residue:<4}A   1      11.104   6.134  -6.504  1.00 10.00          {element:>2}\n"
        )
    };
    for (lines, expected) in [
        // In residues that are standard, names from column 13 are no metals.
        (vec![line("ATOM", "CA", "ALA", "")], 1.7),
        (vec![line("ATOM", "HG1", "THR", "")], 1.1),
        (
            vec![line("ATOM", "CD", "LYS", ""), line("ATOM", " N", "LYS", "")],
            1.7,
        ),
        // Ions, and what is aligned as the format has it.
        (vec![line("HETATM", "CA", "CA", "")], 2.31),
        (vec![line("HETATM", "SOD", "SOD", "")], 2.27),
        (
            vec![
                line("HETATM", "CD1", "LIG", ""),
                line("HETATM", " C2", "LIG", ""),
            ],
            2.18,
        ),
        // Where all names begin there, none is aligned.
        (
            vec![
                line("HETATM", "CD1", "LIG", ""),
                line("HETATM", "C2", "LIG", ""),
            ],
            1.7,
        ),
        // What the element's own column says, if it says one.
        (vec![line("ATOM", "CA", "ALA", "CA")], 2.31),
        (vec![line("ATOM", " CA", "ALA", "42")], 1.7),
        (vec![line("ATOM", " CA", "ALA", "X")], 1.7),
        (vec![line("ATOM", " D1", "DOD", "D")], 1.1),
    ] {
        let text = lines.concat() + "END\n";
        let scene = scene("a.pdb", &text, "");
        assert_eq!(radii(&scene)[0], expected, "{text}");
        assert_eq!(warnings(&scene), "", "{text}");
    }
    // AutoDock's types have a charge before them, and another place.
    let docked = |kind: &str| {
        line("HETATM", " X1", "LIG", "").trim_end().to_owned()
            + &format!("     0.123 {kind}\nEND\n")
    };
    for (kind, expected) in [
        ("NA", 1.55),
        ("A", 1.7),
        ("Cl", 1.75),
        ("Fe", 2.04),
        ("HD", 1.1),
        ("OA", 1.52),
    ] {
        let text = docked(kind);
        let expected = (vec![expected], String::new());
        let scene = scene("a.pdbqt", &text, "");
        assert_eq!((radii(&scene), warnings(&scene)), expected, "{text}");
    }
    let dummy = line("HETATM", " Q1", "MEM", "");
    let told = warnings(&scene("a.pdb", dummy, ""));
    assert!(told.contains("found `Q1` (1 row)"), "{told}");
}
