//! Data files of LAMMPS: styles of atoms, stated and guessed, elements, and files that are broken.

use super::*;

/// A file with these atoms and this line before them.
fn data(line: &str, atoms: &str) -> String {
    let count = atoms.lines().count();
    format!(
        "LAMMPS data file via write_data, 3 atoms\n\n{count} atoms\n2 atom types\n1 bonds # one\n\n-5.0 5 xlo xhi\n0 9 ylo yhi\n\
         0 9 zlo zhi\n\nMasses\n\n1 15.9994 # O\n2 1.008 # H1\n\nPair Coeffs # lj/cut\n\n1 0.1 3.2\n2 0 0\n\n{line}\n\n{atoms}\n\
         Bonds\n\n1 1 1 2\n"
    )
}

/// The van der Waals radii of oxygen and hydrogen, in ångströms.
const O: f64 = 1.52;
const H: f64 = 1.1;

#[test]
fn styles_of_atoms_are_stated_or_guessed() {
    let [first, second] = [[1.0, -2.5, 0.25, O], [4.0, 5.0, 6.0, H]];
    for (style, rows) in [
        ("full", "1 7 1 -0.8 1 -2.5 0.25\n2 7 2 0.4 4 5 6\n"),
        (
            "full",
            "1 7 1 -0.8 1 -2.5 0.25 0 -1 2\n2 7 2 0.4 4 5 6 0 0 0\n",
        ),
        ("molecular", "1 7 1 1 -2.5 0.25\n2 7 2 4 5 6\n"),
        ("molecular", "1 7 1 1 -2.5 0.25 0 0 0\n2 7 2 4 5 6 0 0 0\n"),
        ("atomic", "1 1 1 -2.5 0.25\n2 2 4 5 6\n"),
        ("atomic", "1 1 1 -2.5 0.25 1 0 0\n2 2 4 5 6 0 0 -1\n"),
        ("charge", "1 1 -1 1 -2.5 0.25\n2 2 1 4 5 6\n"),
        ("charge", "1 1 1.0 1 -2.5 0.25\n2 2 1.0 4 5 6\n"),
    ] {
        let stated = scene("a.data", data(&format!("Atoms  # {style}"), rows), "");
        assert_eq!(spheres(&stated), [first, second], "{style}");
        assert_eq!(warnings(&stated), "", "{style}");
        let guessed = scene("a", data("Atoms", rows), "");
        assert_eq!(spheres(&guessed), [first, second], "{style}");
        let told = warnings(&guessed);
        let expected = format!(
            "a:21: the style of the atoms is not stated: they are read as `{style}`, with the columns id, "
        );
        assert!(told.starts_with(&expected), "{told}");
        assert!(told.ends_with(&format!("confirm this with `Atoms # {style}`")));
    }
    // Another word behind `Atoms` states nothing.
    let commented = data(
        "Atoms # I like comments",
        "1 1 1 -2.5 0.25 # first\n2 2 4 5 6 # second\n",
    );
    let commented = scene("a.data", commented, "");
    assert_eq!(spheres(&commented), [first, second]);
    assert!(warnings(&commented).contains("read as `atomic`"));
    for (style, rows) in [
        ("bond", "1 7 1 1 -2.5 0.25\n2 7 2 4 5 6\n"),
        ("angle", "1 7 1 1 -2.5 0.25\n2 7 2 4 5 6\n"),
        ("ellipsoid", "1 1 0 2.5 1 -2.5 0.25\n2 2 1 2.5 4 5 6\n"),
        (
            "dipole",
            "1 1 0.5 1 -2.5 0.25 0 0 1\n2 2 0.5 4 5 6 1 0 0 0 0 0\n",
        ),
    ] {
        let rows = rows.replace(" 1 0 0 0 0 0\n", " 1 0 0\n");
        let stated = scene("a.lmp", data(&format!("Atoms # {style}"), &rows), "");
        assert_eq!(spheres(&stated), [first, second], "{style}");
    }
    // Diameters are halved, and charges color.
    let grains = "1 1 2.5 1.1 1 -2.5 0.25\n2 2 0.5 1.1 4 5 6\n";
    let expected = [[1.0, -2.5, 0.25, 1.25], [4.0, 5.0, 6.0, 0.25]];
    for line in ["Atoms # sphere", "Atoms"] {
        assert_eq!(spheres(&scene("a.data", data(line, grains), "")), expected);
    }
    let charged = "1 1 -0.5 1 -2.5 0.25 # first\n2 2 0.5 4 5 6 # second\n";
    let fields = "value: \"q\", colormap: Grey, keep: [(\"type\", Between(1, 2))]";
    let colored = scene("a.data", data("Atoms # charge", charged), fields);
    assert_eq!(albedos(&colored), [Color::ZERO, Color::ONE]);
}

#[test]
fn velocities_are_said_to_be_left_out() {
    let told = |text: String| warnings(&scene("a.data", text, ""));
    let whole = data("Atoms # atomic", "1 1 1 -2.5 0.25\n2 2 4 5 6\n");
    assert_eq!(told(whole.clone()), "");
    // The atoms are in the lines 23 and 24, and two lines follow them before the next section.
    let section = "Velocities\n\n1 0 0 0\n2 0 0 0\n\n";
    let expected =
        "the velocities of this section are not read: a dump with `vx vy vz` has them as columns";
    let before = whole.replace("Bonds", &format!("{section}Bonds"));
    assert_eq!(told(before), format!("a.data:26: {expected}"));
    let behind = whole.clone() + "\n" + section;
    assert_eq!(told(behind), format!("a.data:30: {expected}"));
    let first = whole.replace("Atoms", &format!("{section}Atoms"));
    assert_eq!(told(first), format!("a.data:21: {expected}"));
    // A comment that names it is none.
    assert_eq!(told(whole + "2 1 1 2 # Velocities\n"), "");
}

#[test]
fn elements_are_those_that_names_of_all_types_tell() {
    let rows = "1 1 1 2 3\n2 2 4 5 6\n";
    let whole = data("Atoms # atomic", rows);
    let kept = scene("a.data", &whole, "keep: [(\"element\", Is(\"H\"))]");
    assert_eq!(spheres(&kept), [[4.0, 5.0, 6.0, H]]);
    let own = scene("a.data", &whole, "radii: {\"O\": 2, \"2\": 3}");
    assert_eq!(spheres(&own).map_radii(), [2.0, 3.0]);
    // CHARMM's name of a carbon is not calcium, and so nothing is.
    for comment in ["# CA", "", "# calcium", "# O/x"] {
        let without = whole.replace("# O\n", &format!("{comment}\n"));
        let message = refusal("a.data", &without, "");
        let expected = "a.data:21:1: expected a column `radius`, or else `radius: …` in the scene, found `id`, `type`, `x`, `y`, `z`";
        assert_eq!(message, expected, "{comment}");
    }
    let types = "columns: (element: \"type\"), radii: {\"1\": 0.4, \"2\": 0.7}";
    let typed = scene("a.data", whole.replace("# O\n", "\n"), types);
    assert_eq!(spheres(&typed).map_radii(), [0.4, 0.7]);
    // Labels may stand in place of the numbers.
    let labels = whole
        .replace("Masses\n", "Atom Type Labels\n\n1 O\n2 H\n\nMasses\n")
        .replace("\n2 1.008 # H1\n", "\nH 1.008\n")
        .replace("\n2 2 4 5 6\n", "\n2 H 4 5 6\n");
    assert_eq!(spheres(&scene("a.data", &labels, "")).map_radii(), [O, H]);
    let guessed = scene("a.data", labels.replace(" # atomic", ""), "");
    assert_eq!(spheres(&guessed).map_radii(), [O, H]);
}

trait Radii {
    fn map_radii(&self) -> Vec<f64>;
}

impl Radii for Vec<[f64; 4]> {
    fn map_radii(&self) -> Vec<f64> {
        self.iter().map(|sphere| sphere[3]).collect()
    }
}

#[test]
fn broken_data_files_are_refused_at_their_lines() {
    let rows = "1 1 1 2 3\n2 2 4 5 6\n";
    let whole = data("Atoms # atomic", rows);
    let changed = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        whole.replacen(from, to, 1)
    };
    let (start, _) = whole.split_once("2 2 4 5 6").unwrap();
    for (text, expected) in [
        (
            changed("# atomic", "# hybrid sphere"),
            "a.data:21:9: expected atoms of the style `full`, `molecular`, `atomic`, `charge`, `sphere`, `bond`, `angle`, \
             `ellipsoid` or `dipole`, found `hybrid`",
        ),
        (
            changed(" # atomic\n\n1 1", "\n\n1 9"),
            "a.data:23:1: expected the style of the atoms, such as `Atoms # full`, before this row, found 1 9 1 2 3",
        ),
        (
            changed("2 atoms\n", "two atoms\n"),
            "a.data:3:1: expected the number of atoms, found `two atoms`",
        ),
        (
            changed("2 atoms\n", "\n"),
            "a.data:21:1: expected the number of atoms before, found `Atoms # atomic`",
        ),
        (
            changed("2 atoms\n", "99999999999 atoms\n"),
            "a.data:25:1: expected 99999999999 atoms, according to the start of the file, found the end of the line",
        ),
        (
            start.replacen("2 atoms\n", "99999999999 atoms\n", 1),
            "a.data:24:1: expected 99999999999 atoms, according to the start of the file (1 read), found the end of the file",
        ),
        (
            changed("2 atoms\n", "1 atoms\n"),
            "a.data:24:1: expected the name of a section after the atoms that the file counts, found 2 2 4 5 6",
        ),
        (
            changed("4 5 6", "4 nan 6"),
            "a.data:24:7: expected a finite number for `y`, found `nan`",
        ),
        (
            changed("4 5 6", "4 5"),
            "a.data:24:8: expected a number for `z`, found the end of the line",
        ),
        (
            changed("4 5 6\n", "4 5 6 7\n"),
            "a.data:24:11: expected the end of the line after 6 columns, found 7",
        ),
        (
            start.split_once("Atoms").unwrap().0.to_owned(),
            "a.data:21:1: expected the section `Atoms`, found the end of the file",
        ),
    ] {
        let found = refusal("a.data", &text, "");
        assert!(found.starts_with(expected), "\n{found}\n{expected}");
    }
    let open = scene("a.data", start.to_owned() + "2 2 4 5 6", "");
    assert_eq!(
        warnings(&open),
        "a.data:24: the file ends within this line: its last number may have been cut off"
    );
}

#[test]
fn boxes_are_those_of_dumps() {
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS xy xz yz pp pp pp\n-5 6.5 1 -0.5 0.25\n\
                0 9.25 0.5 0 0\n0 9 0.25 0 0\nITEM: ATOMS id type x y z ix iy iz\n1 1 1 2 3 0 -1 2\n2 2 4 5 6 1 0 0\n"
        .replace("-5 6.5 1 -0.5 0.25\n0 9.25 0.5 0 0\n0 9 0.25 0 0", "-5.5 6 1\n0 9.25 -0.5\n0 9 0.25");
    let rows = "1 1 1 2 3 0 -1 2\n2 2 4 5 6 1 0 0\n";
    let tilted =
        data("Atoms # atomic", rows).replace("0 9 zlo zhi", "0 9 zlo zhi\n1 -0.5 0.25 xy xz yz");
    let vectors = data("Atoms # atomic", rows).replace(
        "-5.0 5 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi",
        "10 0 0 avec\n1 9 0 bvec\n-0.5 0.25 9 cvec\n-5 0 0 abc origin",
    );
    for fields in [
        "radius: 1, repeat: (2, 1, 3)",
        "radius: 1, unwrap: true",
        "radius: 1, wrap: true, position: (1, 2, 3)",
    ] {
        let expected = spheres(&scene("a.dump", &dump, fields));
        assert_ne!(expected, spheres(&scene("a.dump", &dump, "radius: 1")));
        for (text, what) in [(&tilted, "bounds"), (&vectors, "vectors")] {
            let found = spheres(&scene("a.data", text, fields));
            assert_eq!(found, expected, "{what}, {fields}");
        }
    }
    let flat = tilted.replace("0 9 zlo zhi", "0 0 zlo zhi");
    let message = refusal("a.data", &flat, "radius: 1, repeat: (1, 2, 1)");
    let expected = "a.data:7:1: expected a cell of three finite edges that span a volume, found one without a volume";
    assert_eq!(message, expected);
    // Whoever asks for no cell may have one without a volume.
    assert_eq!(spheres(&scene("a.data", &flat, "radius: 1")).len(), 2);
}
