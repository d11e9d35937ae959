//! Tables whose numbers could be taken for others: refused, said, or read as they are meant.

use super::*;

/// A dump of one atom in a box from 0 to 10.
fn dump(columns: &str, row: &str) -> String {
    format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\nITEM: ATOMS {columns}\n{row}\n"
    )
}

#[test]
fn positions_are_of_one_kind() {
    let middle = [1.0, 2.0, 3.0, 1.0];
    for (columns, row, fields, expected) in [
        ("xs ys zs radius", ".1 .2 .3 1", "", middle),
        ("XS YS ZS radius", ".1 .2 .3 1", "", middle),
        (
            "xsu ysu zsu radius",
            "1.1 .2 -.3 1",
            "",
            [11.0, 2.0, -3.0, 1.0],
        ),
        ("zs ys xs radius", ".3 .2 .1 1", "", middle),
        ("xs ys zs x y z radius", ".9 .9 .9 1 2 3 1", "", middle),
        (
            "xs ys zs x y z radius",
            ".1 .2 .3 9 9 9 1",
            "columns: (x: \"xs\", y: \"ys\", z: \"zs\")",
            middle,
        ),
        // A constant is a length.
        (
            "xs ys radius",
            ".1 .2 1",
            "columns: (z: Constant(3))",
            middle,
        ),
        (
            "x yu zs radius",
            "1 2 3 1",
            "columns: (x: \"x\", y: \"yu\", z: Constant(3))",
            middle,
        ),
    ] {
        assert_eq!(
            spheres(&scene("a.dump", dump(columns, row), fields)),
            [expected],
            "{columns}"
        );
    }
    let of_one_kind = |names: &str| {
        format!(
            "a.dump:9:1: expected x, y and z of one kind, found {names} (choose them with `columns: (x: …, y: …, z: …)`)"
        )
    };
    let together = |names: &str| {
        format!(
            "a.dump:9:1: expected `xs`, `ys` and `zs` together, which are fractions of the cell, found {names} for x, y and z"
        )
    };
    for (columns, fields, expected) in [
        ("xs y z radius", "", of_one_kind("`xs`, `y` and `z`")),
        ("x ys zs radius", "", of_one_kind("`x`, `ys` and `zs`")),
        ("x yu zu radius", "", of_one_kind("`x`, `yu` and `zu`")),
        ("xs ys zsu radius", "", of_one_kind("`xs`, `ys` and `zsu`")),
        (
            "xs ys zs radius",
            "columns: (x: \"ys\", y: \"xs\", z: \"zs\")",
            together("`ys`, `xs` and `zs`"),
        ),
        (
            "xs ys z radius",
            "columns: (x: 1, y: 2, z: 3)",
            together("`xs`, `ys` and `z`"),
        ),
    ] {
        assert_eq!(
            refusal("a.dump", dump(columns, ".1 .2 .3 1"), fields),
            expected
        );
    }
}

/// Parts of a cell need the cell, in every format.
#[test]
fn parts_of_no_cell_are_refused() {
    let boxless = dump("xs ys zs radius", ".1 .2 .3 1")
        .replace("ITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\n", "");
    let xyz = "1\nProperties=species:S:1:xs:R:1:ys:R:1:zs:R:1\nC .1 .2 .3\n";
    let records = "{'descr': [('xs', '<f8'), ('ys', '<f8'), ('zs', '<f8')], 'fortran_order': False, 'shape': (1,)}";
    for (name, bytes) in [
        ("a.dump", boxless.into_bytes()),
        ("a.xyz", xyz.as_bytes().to_vec()),
        ("a.csv", b"xs,ys,zs\n.1,.2,.3\n".to_vec()),
        ("a.npy", npy(records, &doubles(&[0.1, 0.2, 0.3]))),
    ] {
        let message = refusal(name, &bytes, "radius: 1");
        let expected =
            "expected a cell, because `xs`, `ys` and `zs` are fractions of it, found none";
        assert!(message.contains(expected), "{message}");
        let chosen = "radius: 1, columns: (x: \"xs\", y: \"ys\", z: \"zs\")";
        assert_eq!(
            spheres(&scene(name, bytes, chosen)),
            [[0.1, 0.2, 0.3, 1.0]],
            "{name}"
        );
    }
}

#[test]
fn columns_of_one_name_are_refused() {
    for (text, name) in [
        ("x,y,z,radius,radius\n1,2,3,1,9\n", "radius"),
        ("x,y,z,Diameter,diameter\n1,2,3,1,9\n", "Diameter"),
        ("x (mm),x (cm),y,z,r\n1,9,2,3,1\n", "x (mm)"),
        ("x,y,z,r [mm],r [um]\n1,2,3,1,9\n", "r [mm]"),
    ] {
        let expected =
            format!("a.csv:1:1: expected every column once, found `{name}` a second time");
        assert_eq!(refusal("a.csv", text, ""), expected);
    }
    // A whole name means one of them.
    let text = "x (mm),x (cm),y,z,r\n1,9,2,3,1\n";
    let found = spheres(&scene("a.csv", text, "columns: (x: \"x (cm)\")"));
    assert_eq!(found, [[9.0, 2.0, 3.0, 1.0]]);
}

#[test]
fn units_that_differ_are_said() {
    let said = |text: &str, fields: &str| warnings(&scene("a.csv", text, fields));
    let differ = |other: &str| {
        format!(
            "a.csv: the columns `x (mm)` and `{other}` have different units, but are read as if they had the same one \
             (`columns: (radius_scale: …)` multiplies radii)"
        )
    };
    let radii = "x (mm),y (mm),z (mm),radius (um)\n1,2,3,100\n";
    assert_eq!(said(radii, ""), differ("radius (um)"));
    assert_eq!(said(radii, "columns: (radius_scale: 0.001)"), "");
    assert_eq!(said(radii, "radius: 1"), "");
    assert_eq!(
        said("x (mm),y (mm),z (um),radius (mm)\n1,2,3,1\n", ""),
        differ("z (um)")
    );
    assert_eq!(said("x (µm),y (um),z [UM],radius\n1,2,3,1\n", ""), "");
    let atoms = |unit: &str| format!("element,x ({unit}),y ({unit}),z ({unit})\nC,1,2,3\n");
    assert_eq!(
        said(&atoms("nm"), ""),
        "a.csv: the radii of elements are in ångströms, but the column `x (nm)` is not: `columns: (radius_scale: …)` \
         multiplies them"
    );
    assert_eq!(said(&atoms("nm"), "columns: (radius_scale: 0.1)"), "");
    for unit in ["Å", "A", "Angstrom"] {
        assert_eq!(said(&atoms(unit), ""), "", "{unit}");
    }
}

#[test]
fn coordinates_that_leave_their_columns_are_refused() {
    let pdb = |numbers: &str| format!("HETATM    1  C   LIG A   1    {numbers}           C\nEND\n");
    let gro = |numbers: &str| {
        format!(
            "t\n2\n    1LIG     C1    1   0.100   0.200   0.300\n    1LIG     C1    2{numbers}\n 1 1 1\n"
        )
    };
    for (numbers, expected) in [
        (
            "-111.104-116.134-116.504100.00100.00",
            Some([-111.104, -116.134, -116.504]),
        ),
        ("1234.5671234.5671234.567  1.00 10.00", Some([1234.567; 3])),
        (
            "  11.104   6.134  -6.504100.00 10.00",
            Some([11.104, 6.134, -6.504]),
        ),
        (
            " 11.1041  6.1341 -6.5041  1.00 10.00",
            Some([11.1041, 6.1341, -6.5041]),
        ),
        ("12345.67812345.67812345.678  1.00 10.00", None),
        ("  11.104   6.134-1234.567  1.00 10.00", None),
        ("  11.10412345.678  -6.504  1.00 10.00", None),
    ] {
        let found = load("a.pdb", pdb(numbers), "");
        match expected {
            Some(expected) => assert_eq!(spheres(&found.unwrap())[0][..3], expected),
            None => assert!(found.is_err(), "{numbers}"),
        }
    }
    assert_eq!(
        refusal("a.pdb", pdb("12345.67812345.67812345.678  1.00 10.00"), ""),
        "a.pdb:1:31: expected coordinates that fit into their columns, found 12345.67812345.67812345."
    );
    // Programs that divide lines by spaces write such lines.
    assert_eq!(
        refusal(
            "a.pdb",
            "ATOM 1 N MET A 1 27.340 24.430 2.614 1.00 9.67 N\n",
            ""
        ),
        "a.pdb:1:32: expected a number for `x` in columns 31 to 38 (the fields of this format have fixed columns), \
         found 2.614 1"
    );
    for (numbers, is_read) in [
        ("1234.5671234.5671234.567  0.1000", true),
        ("1234.5671234.5671234.5671234.5671234.5671234.567", true),
        ("12345.67812345.67812345.678", false),
    ] {
        assert_eq!(
            load("a.gro", gro(numbers), "").is_ok(),
            is_read,
            "{numbers}"
        );
    }
}

/// Lines that are atoms, but not in the form of the format, are never skipped.
#[test]
fn irregular_atoms_are_atoms() {
    let atom = "ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.00           N\n";
    let count = |text: String| load("a.pdb", text, "").map(|scene| spheres(&scene).len());
    assert_eq!(count(format!("{atom}{}END\n", atom.to_lowercase())), Ok(2));
    assert_eq!(
        count(format!(
            "{atom}{}END\n",
            atom.replace("ATOM      1", "ATOM 100000")
        )),
        Ok(2)
    );
    assert_eq!(
        count(format!("{atom}REMARK ATOM 1.0 2.0 3.0\nEND\n")),
        Ok(1)
    );
    assert!(count(format!("{atom} {atom}END\n")).is_err());
    assert!(count("ATOM\t1\tN\tALA\tA\t1\t11.104\t6.134\t-6.504\nEND\n".to_owned()).is_err());
}

#[test]
fn rows_of_pqr_with_a_word_more_or_less_are_refused() {
    let of = |row: &str| load("a.pqr", format!("{row}\nEND\n"), "").map(|scene| spheres(&scene)[0]);
    let expected = [46.457, 12.189, 21.556, 1.824];
    for row in [
        "ATOM 1 N ALA 1 46.457 12.189 21.556 0.1414 1.8240",
        "ATOM 1 N ALA A 1 46.457 12.189 21.556 0.1414 1.8240",
        "ATOM 1 N ALA A 1 B 46.457 12.189 21.556 0.1414 1.8240",
        "ATOM 1 N ALA A 1B 46.457 12.189 21.556 0.1414 1.8240",
        "ATOM 1 N ALA A1000 46.457 12.189 21.556 0.1414 1.8240",
        "ATOM 1 N ALA -1 46.457 12.189 21.556 0.1414 1.8240",
    ] {
        assert_eq!(of(row), Ok(expected), "{row}");
    }
    for row in [
        "ATOM 1 N ALA A 1 46.457 12.189 21.556 0.1414 1.8240 9.5",
        "ATOM 1 N ALA 1 46.457 12.189 21.556 0.1414 1.8240 9.5",
        "ATOM 1 N ALA A 1 46.457 12.189 21.556 0.1414",
        "ATOM 1 N ALA 1 46.457 12.189 21.556 0.1414",
        "ATOM 1 N ALA A 1 46.457 12.189-121.556 0.1414 1.8240",
    ] {
        assert!(of(row).is_err(), "{row}");
    }
}

/// Charges and radii have other columns than occupancies: a file that is called PDB is read as what it is.
#[test]
fn a_pqr_that_is_called_pdb_keeps_its_radii() {
    let pqr = "ATOM      1  N   ALA     1      46.457  12.189  21.556  0.1414 1.8240\nEND\n";
    let scene = scene("a.pdb", pqr, "");
    assert_eq!(spheres(&scene), [[46.457, 12.189, 21.556, 1.824]]);
    assert_eq!(
        warnings(&scene),
        "a.pdb: its columns are those of a PQR file, not of a PDB file: it is read as PQR"
    );
    let pdb =
        "ATOM      1  N   ALA A   1      46.457  12.189  21.556  1.00 10.00           N\nEND\n";
    assert_eq!(spheres(&self::scene("a.pdb", pdb, ""))[0][3], 1.55);
}

#[test]
fn properties_may_have_spaces_around_their_sign() {
    for sign in ["=", " = ", "= ", " ="] {
        let text = format!(
            "1\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties{sign}species:S:1:forces:R:3:pos:R:3\nC 9 9 9 1 2 3\n"
        );
        assert_eq!(
            spheres(&scene("a.xyz", text, ""))[0][..3],
            [1.0, 2.0, 3.0],
            "{sign}"
        );
    }
}

/// A first row of whole numbers does not say whether numbers have commas.
#[test]
fn the_first_row_with_a_comma_or_a_point_tells_which_numbers_have() {
    let text = |row: &str| format!("x;y;z;r\n1;2;3;1\n{row}\n");
    let second = |row: &str| load("a.csv", text(row), "").map(|scene| spheres(&scene)[1]);
    assert_eq!(second("1,5;2;3;1"), Ok([1.5, 2.0, 3.0, 1.0]));
    assert_eq!(second("1.5;2;3;1"), Ok([1.5, 2.0, 3.0, 1.0]));
    assert!(second("1.000,5;2;3;1").is_err());
}

/// Elements 1, 2, 3, … are types of something, as a rule.
#[test]
fn atomic_numbers_that_count_are_said() {
    let told = |text: &str, fields: &str| warnings(&scene("a.csv", text, fields));
    let types = "species,x,y,z\n1,1,2,3\n2,4,5,6\n1,7,8,9\n";
    assert_eq!(
        told(types, ""),
        "a.csv:2:1: the numbers in the column `species` are read as atomic numbers; confirm this with `columns: (element: \
         \"species\")`"
    );
    assert_eq!(told(types, "columns: (element: \"species\")"), "");
    assert_eq!(told(types, "radius: 1, color: Material"), "");
    assert_eq!(told("species,x,y,z\n6,1,2,3\n8,4,5,6\n", ""), "");
}

/// PDB files of the format's first versions have the number of each line in columns 73 to 80.
#[test]
fn numbers_of_lines_in_old_pdb_files_are_not_elements() {
    let row = |number: u8| {
        format!(
            "ATOM      {number}  CA  ALA     {number}       1.000   2.000   {number}.000  1.00 35.00      1GDR   {number}\n"
        )
    };
    let scene = scene("a.pdb", format!("{}{}END\n", row(1), row(2)), "");
    assert_eq!(spheres(&scene)[1], [1.0, 2.0, 2.0, 1.7]);
    assert_eq!(warnings(&scene), "");
}

#[test]
fn colors_that_look_like_bytes_are_said() {
    let told = |rows: &str| warnings(&scene("a.csv", format!("x,y,z,radius,r,g,b\n{rows}\n"), ""));
    assert!(told("1,2,3,1,255,0,16").contains("numbers up to 255, which look like bytes"));
    assert!(told("1,2,3,1,1.5,0,0").contains("numbers up to 1.5: with an albedo above 1"));
    assert_eq!(told("1,2,3,1,1,0,0.5"), "");
}
