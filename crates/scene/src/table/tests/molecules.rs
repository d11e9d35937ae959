//! Molecules in MOL2 and SDF: elements, columns, several of them in a file, and files that are broken.

use super::cut;
use super::*;

/// Two molecules: one with types of Tripos, one with those of another force field.
const MOL2: &str = "# made by hand
@<TRIPOS>MOLECULE
first
 4 3 1 0 0
SMALL
USER_CHARGES

@<TRIPOS>ATOM
      1 CA          1.5000   -2.0000    0.2500 C.3       1 ALA1        0.1250
      2 OXT         2.0000    0.0000    0.0000 O.co2     1 ALA1       -0.5000
      3 ZN          3.0000    0.0000    0.0000 Zn        2 ZN2         2.0000
      4 X1          4.0000    0.0000    0.0000 Du        3 UNK3        0.0000
@<TRIPOS>BOND
     1     1     2    1
@<TRIPOS>MOLECULE
second
2
SMALL
NO_CHARGES
@<TRIPOS>ATOM
1 CL1 0 1 2 cl
2 C2 0 1 3 ca
@<TRIPOS>SUBSTRUCTURE
";

/// Two molecules of V2000, and one of V3000 behind them.
const SDF: &str = "water
  made by hand

  3  2  0  0  0  0  0  0  0  0999 V2000
    0.0000    0.5000   -1.2500 O   0  0  0  0  0
 -100.1250-1000.5000    2.0000 H   0  0
    3.0000    0.0000    0.0000 D   0
  1  2  1  0
  1  3  1  0
M  END
> <energy>
-1.5

$$$$

  a title of nothing

  1  0  0  0  0  0  0  0  0  0999 V2000
    1.0000    2.0000    3.0000 R#  0
M  END
$$$$
salt

a comment
  0  0  0     0  0            999 V3000
M  V30 BEGIN CTAB
M  V30 COUNTS 2 1 0 0 0
M  V30 BEGIN ATOM
M  V30 1 Na 1.5 2.5 -3.5 0 CHG=1
M  V30 2 \"NOT [Cl,Br]\" 4 5 6 0
M  V30 END ATOM
M  V30 BEGIN BOND
M  V30 1 1 1 2
M  V30 END BOND
M  V30 END CTAB
M  END
$$$$
";

/// Centers and radii of each step.
fn steps(name: &str, bytes: &str) -> Vec<Vec<[f64; 4]>> {
    let fields = "frames: All, right_handed: false";
    let (steps, _) = cut::shown(name, bytes.as_bytes(), fields).unwrap();
    let numbers = |sphere: &Sphere| sphere.center().extend(sphere.radius()).to_array();
    let numbers = |step: &Vec<Sphere>| step.iter().map(numbers).collect();
    steps.iter().map(numbers).collect()
}

/// The van der Waals radii of C, O, Zn, Cl, Na and H, in ångströms.
const RADII: [f64; 6] = [1.7, 1.52, 2.01, 1.75, 2.27, 1.1];

#[test]
fn atoms_of_mol2_have_elements_by_type_or_name() {
    let [c, o, zn, cl, ..] = RADII;
    let first = scene("a.mol2", MOL2, "");
    let found = spheres(&first);
    let expected = [
        [1.5, -2.0, 0.25, c],
        [2.0, 0.0, 0.0, o],
        [3.0, 0.0, 0.0, zn],
        [4.0, 0.0, 0.0, 1.0],
    ];
    assert_eq!(found, expected);
    assert_eq!(
        warnings(&first),
        "a.mol2: the first frame of several is shown (`frames: All` shows them one after another)\n\
         a.mol2:12:48: expected elements with known radii and colors, found `Du` (1 row) (for these, marbles uses \
         `others: (radius: 1, color: \"#ff80c0\")`)"
    );
    // `ca` of another force field is carbon, by the name of the atom.
    let second = vec![[0.0, 1.0, 2.0, cl], [0.0, 1.0, 3.0, c]];
    assert_eq!(steps("a.mol2", MOL2), [expected.to_vec(), second]);
    let charged = scene(
        "a.mol2",
        MOL2,
        "value: \"charge\", keep: [(\"residue\", Is(\"ALA1\"))], colormap: Grey",
    );
    assert_eq!(albedos(&charged), [Color::ONE, Color::ZERO]);
    let typed = scene("a.mol2", MOL2, "keep: [(\"type\", Is(\"O.co2\"))]");
    assert_eq!(spheres(&typed), [[2.0, 0.0, 0.0, o]]);
    let zinc = scene("a.txt", MOL2, "keep: [(\"element\", Is(\"Zn\"))]");
    assert_eq!(spheres(&zinc), [[3.0, 0.0, 0.0, zn]]);
}

#[test]
fn molecules_of_sdf_are_frames() {
    let [.., na, h] = RADII;
    let first = scene("a.sdf", SDF, "");
    let expected = [
        [0.0, 0.5, -1.25, RADII[1]],
        [-100.125, -1000.5, 2.0, h],
        [3.0, 0.0, 0.0, h],
    ];
    assert_eq!(spheres(&first), expected);
    assert_eq!(
        warnings(&first),
        "a.sdf: the first frame of several is shown (`frames: All` shows them one after another)"
    );
    let second = vec![[1.0, 2.0, 3.0, 1.0]];
    let third = vec![[1.5, 2.5, -3.5, na], [4.0, 5.0, 6.0, 1.0]];
    assert_eq!(steps("a.sdf", SDF), [expected.to_vec(), second, third]);
    // A file of one molecule ends without a mark.
    let (one, _) = SDF.split_once("> <energy>").unwrap();
    let one = one.replace('\n', "\r\n");
    assert_eq!(warnings(&scene("a", &one, "frames: All")), "");
}

#[test]
fn broken_molecules_are_refused_at_their_lines() {
    let sdf = |from: &str, to: &str| SDF.replacen(from, to, 1);
    let mol2 = |from: &str, to: &str| MOL2.replacen(from, to, 1);
    let (cut, _) = SDF.split_once("M  END").unwrap();
    for (name, text, expected) in [
        (
            "a.mol2",
            mol2(" 4 3 1", " four 3 1"),
            "a.mol2:4:1: expected the numbers of atoms and bonds, found ` four 3 1 0 0`",
        ),
        (
            "a.mol2",
            mol2("    0.2500", "       nan"),
            "a.mol2:9:44: expected a finite number for `z`, found `nan`",
        ),
        (
            "a.mol2",
            mol2("    0.0000 O.co2", ""),
            "a.mol2:10:62: expected a value for `residue`, found the end of the line",
        ),
        (
            "a.mol2",
            mol2(" 4 3 1", " 5 3 1"),
            "a.mol2:13:1: expected 5 atoms, according to `@<TRIPOS>MOLECULE`, found `@<TRIPOS>BOND`",
        ),
        (
            "a.mol2",
            mol2(" 4 3 1", " 3 3 1"),
            "a.mol2:12:1: expected a line `@<TRIPOS>…` after the atoms that `@<TRIPOS>MOLECULE` counts, found `      4 \
             X1          4.0000    0.0000    …`",
        ),
        (
            "a.mol2",
            mol2("@<TRIPOS>ATOM", "@<TRIPOS>ATOMS"),
            "a.mol2:15:1: expected `@<TRIPOS>ATOM` of the molecule before, found `@<TRIPOS>MOLECULE`",
        ),
        (
            "a.mol2",
            "@<TRIPOS>MOLECULE\nx\n9999999999999\n@<TRIPOS>ATOM\n1 C 1 2 3 C.3\n".into(),
            "a.mol2:6:1: expected 9999999999999 atoms, according to `@<TRIPOS>MOLECULE` (1 read), found the end of the file",
        ),
        (
            "a.mol2",
            "@<TRIPOS>MOLECULE\nx\n1\n".into(),
            "a.mol2:4:1: expected `@<TRIPOS>ATOM` of this molecule, found the end of the file",
        ),
        (
            "a.mol2",
            "@<TRIPOS>ATOM\n1 C 1 2 3 C.3\n".into(),
            "a.mol2:1:1: expected `@<TRIPOS>MOLECULE` with the number of atoms before, found `@<TRIPOS>ATOM`",
        ),
        (
            "a.mol2",
            "nothing\n".into(),
            "a.mol2:2:1: expected `@<TRIPOS>MOLECULE`, found the end of the file",
        ),
        (
            "a.sdf",
            sdf("    0.5000", "       inf"),
            "a.sdf:5:18: expected a finite number for `y`, found inf",
        ),
        (
            "a.sdf",
            sdf("-1000.5000    2.0000", "-1000.5       2.0000"),
            "",
        ),
        (
            "a.sdf",
            sdf("0.5000   -1.2500", "0.5000 -1.2500"),
            "a.sdf:5:22: expected a number for `z` in columns 21 to 30 (the fields of this format have fixed columns), \
             found -1.2500 O",
        ),
        (
            "a.sdf",
            sdf("  3  2  0", "  4  2  0"),
            "a.sdf:8:3: expected a number for `x` in columns 1 to 10 (the fields of this format have fixed columns), found 1  2  1",
        ),
        (
            "a.mol",
            sdf("  3  2  0", "  x  2  0").replace("V2000", ""),
            "a.mol:4:1: expected the numbers of atoms and bonds in the fourth line of a molecule, found `  x  2  0  0  \
             0  0  0  0  0  0999 `",
        ),
        (
            "a.sdf",
            cut.to_owned(),
            "a.sdf:10:1: expected `M  END` after the atoms and bonds of a molecule, found the end of the file",
        ),
        (
            "a.sdf",
            sdf("M  END\n> ", "> "),
            "a.sdf:13:1: expected `M  END` after the atoms and bonds of a molecule, found `$$$$`",
        ),
        (
            "a.sdf",
            "x\ny\n".into(),
            "a.sdf:3:1: expected the numbers of atoms and bonds in the fourth line of a molecule, found the end of the file",
        ),
    ] {
        if expected.is_empty() {
            assert!(load(name, text, "").is_ok());
        } else {
            assert_eq!(refusal(name, text, ""), expected);
        }
    }
    let (_, salt) = SDF.split_once("R#  0\nM  END\n$$$$\n").unwrap();
    let salt = |from: &str, to: &str| salt.replacen(from, to, 1);
    for (text, expected) in [
        (
            salt("2 1 0", "3 1 0"),
            "a.mol:10:1: expected 3 atoms, according to `M  V30 COUNTS`, found `M  V30 END ATOM`",
        ),
        (
            salt("2 1 0", "1 1 0"),
            "a.mol:9:1: expected `M  V30 END ATOM` after the atoms that `M  V30 COUNTS` counts, found `M  V30 2 \"NOT [Cl,Br]\" 4 5 6 0`",
        ),
        (
            salt("CHG=1", "CHG=-\nM  V30 1"),
            "a.mol:8:32: expected an atom on one line, without `-` at its end, found `-`",
        ),
        (
            salt("COUNTS 2", "COUNTS two"),
            "a.mol:6:1: expected `M  V30 COUNTS` with the number of atoms, found `M  V30 COUNTS two 1 0 0 0`",
        ),
        (
            salt("BEGIN ATOM", "BEGIN ATOMS"),
            "a.mol:14:1: expected `M  V30 BEGIN ATOM`, found `M  V30 END CTAB`",
        ),
        (
            salt("M  V30 BEGIN CTAB\nM  V30 COUNTS 2 1 0 0 0\n", "M  END\n"),
            "a.mol:5:1: expected `M  V30 COUNTS` with the number of atoms, found `M  END`",
        ),
        (
            salt("-3.5", "-3,5"),
            "a.mol:8:21: expected a number for `z`, found -3,5",
        ),
    ] {
        assert_eq!(refusal("a.mol", text, ""), expected);
    }
}
