//! Tables without a cell, cells that are none, and more cells than can be shown.

use super::cells::{TILTED, centers, dump};
use super::*;

#[test]
fn tables_without_a_cell_are_refused_where_it_is_asked_for() {
    let plain = "1\n\nC 1 2 3\n";
    for field in ["repeat: (2, 1, 1)", "wrap: true", "edges: true"] {
        let message = refusal("a.xyz", plain, field);
        let name = field.split(':').next().unwrap();
        let expected =
            format!("expected a table with a cell for `{name}`, found none in \"a.xyz\"");
        assert!(message.contains(&expected), "{message}");
        // The place is that of the field.
        let column = "clouds: [(file: \"a.xyz\", ".len() + 1 + name.len() + 2;
        assert!(
            message.starts_with(&format!("scene.ron:2:{column}: ")),
            "{message}"
        );
    }
    let message = refusal("a.csv", "x,y,z\n1,2,3\n", "radius: 1, wrap: true");
    assert!(message.contains("found none in \"a.csv\""), "{message}");
    // A single cell needs none.
    assert_eq!(
        centers(&scene("a.xyz", plain, "repeat: (1, 1, 1), wrap: false")).len(),
        1
    );
}

#[test]
fn cells_that_span_nothing_are_refused_where_the_table_tells_them() {
    for (cell, expected) in [
        (
            "4 0 0 0 4 0 0 0 0",
            "a.xyz:2:10: expected a cell of three finite edges that span a volume, found one without a volume",
        ),
        (
            "4 0 0 0 4 0 0 0 inf",
            "a.xyz:2:10: expected a cell of three finite edges that span a volume, found an infinite one",
        ),
        (
            "4 0 0 0 4 0 0 0",
            "a.xyz:2:10: expected the nine numbers of the edges of the cell, found 4 0 0 0 4 0 0 0",
        ),
    ] {
        let text = format!("1\nLattice=\"{cell}\"\nC 1 2 3\n");
        assert_eq!(refusal("a.xyz", &text, "edges: true"), expected);
        // Nobody asks for it.
        assert_eq!(centers(&scene("a.xyz", &text, "")), [[1.0, 2.0, 3.0]]);
    }
    let pdb = "CRYST1   10.000   10.000   10.000  90.00  90.00 200.00\n\
               HETATM    1  C   LIG A   1       1.000   2.000   3.000  1.00  0.00           C\nEND\n";
    let message = refusal("a.pdb", pdb, "wrap: true");
    assert!(
        message.starts_with(
            "a.pdb:1:1: expected a cell with lengths greater than 0 and angles between"
        ),
        "{message}"
    );
}

#[test]
fn image_flags_that_are_missing_or_no_cells_are_refused() {
    let bounds = "0 4\n0 5\n0 6";
    let text = dump("pp pp pp", bounds, "type x y z ix iy", &["1 1 2 3 0 0"]);
    let message = refusal("a.dump", text, "radius: 1, unwrap: true");
    assert!(
        message.starts_with("a.dump:9:1: expected image flags in the columns `ix`, `iy` and `iz`"),
        "{message}"
    );
    assert!(message.contains("found no `iz`"), "{message}");
    let text = dump(
        "pp pp pp",
        bounds,
        "type x y z ix iy iz",
        &["1 1 2 3 0 0.5 0"],
    );
    let message = refusal("a.dump", text, "radius: 1, unwrap: true");
    assert!(
        message.starts_with("a.dump:10:11: expected a whole number of cells for `iy`, found 0.5"),
        "{message}"
    );
    let text = "1\nProperties=species:S:1:pos:R:3:ix:I:1:iy:I:1:iz:I:1\nC 1 2 3 -1 0 0\n";
    let message = refusal("a.xyz", text, "unwrap: true");
    assert!(
        message.contains("expected a table with a cell for `unwrap`"),
        "{message}"
    );
    let message = refusal("a.xyz", TILTED, "wrap: true, unwrap: true");
    assert!(
        message.contains("expected `wrap` or `unwrap`, found both"),
        "{message}"
    );
}

#[test]
fn more_cells_than_can_be_shown_are_refused() {
    let message = refusal("a.xyz", TILTED, "repeat: (100000, 100000, 1)");
    assert!(
        message.contains("expected at most 4294967294 spheres, found 20000000000"),
        "{message}"
    );
    let most = u32::MAX;
    let message = refusal(
        "a.xyz",
        TILTED,
        &format!("repeat: ({most}, {most}, {most}), edges: true"),
    );
    assert!(
        message.contains("expected at most 4294967294 spheres"),
        "{message}"
    );
    for repeat in [
        "(0, 1, 1)",
        "(1, 1)",
        "(1.5, 1, 1)",
        "(-1, 1, 1)",
        "4294967296",
    ] {
        assert!(
            load("a.xyz", TILTED, &format!("repeat: {repeat}")).is_err(),
            "{repeat}"
        );
    }
    let far = "1\nLattice=\"1e308 0 0 0 1e308 0 0 0 1e308\"\nC 1 2 3\n";
    assert!(load("a.xyz", far, "repeat: (9, 1, 1)").is_err());
}

/// Without a sphere there is nothing to repeat, however often.
#[test]
fn an_empty_table_is_repeated_at_once() {
    let text = "1\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=species:S:1:pos:R:3\nC 0 0 0\n";
    let many = "repeat: (100000, 100000, 100000), keep: [(\"species\", Is(\"H\"))]";
    for fields in [many, &format!("{many}, edges: true")] {
        let scene = load("a.xyz", text, &format!("radius: 1, {fields}"));
        let is_empty = scene.is_ok_and(|scene| scene.world().spheres().is_empty());
        assert!(is_empty, "{fields}");
    }
}
