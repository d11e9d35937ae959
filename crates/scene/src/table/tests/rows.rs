//! Rows that are kept, and those that nothing is looked at of.

use super::formats::npz;
use super::*;

#[test]
fn rows_that_are_not_kept_are_not_looked_at() {
    let header = "{'descr': [('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ('r', '<f8'), ('n', '<i8')], \
                  'fortran_order': False, 'shape': (3,)}";
    let mut records = Vec::new();
    for (numbers, kind) in [
        ([f64::NAN, 0.0, 0.0, 1.0], 0_i64),
        ([1.0, 2.0, 3.0, 0.5], 1),
        ([0.0, 0.0, 0.0, -1.0], 0),
    ] {
        records.extend(doubles(&numbers));
        records.extend(kind.to_le_bytes());
    }
    let array = npy(header, &records);
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               property float r\nproperty int n\nend_header\nnan 0 0 1 0\n1 2 3 0.5 1\n0 0 0 0 0\n";
    for (name, bytes, fields) in [
        // Not a number, infinite, a radius of 0, one below, text, colors beyond what there is.
        (
            "a.csv",
            b"n,x,y,z,r\n0,nan,0,0,1\n0,inf,0,0,1\n0,0,0,0,0\n1,1,2,3,0.5\n0,0,0,0,-1\n0,text,0,0,?\n".to_vec(),
            "keep: [(\"n\", Is(1))]",
        ),
        (
            "a.csv",
            b"x,y,z,r,red,green,blue,n\n1,2,3,0.5,1,1,1,a\n0,0,0,1,-1,0,0,b\n".to_vec(),
            "keep: [(\"n\", Is(\"a\"))]",
        ),
        (
            "a.csv",
            b"n,x,y,z,r,value\n5,1,2,3,0.5,7\n4,1,2,3,0.5,\n4\n".to_vec(),
            "keep: [(\"n\", Between(5, 6))], value: \"value\"",
        ),
        ("a.npy", array.clone(), "keep: [(\"n\", Is(1))]"),
        ("a.npz", npz(&[("a", array)]), "keep: [(\"n\", Every(1)), (\"n\", Is(1))]"),
        ("a.ply", ply.as_bytes().to_vec(), "keep: [(\"n\", Is(1))]"),
        (
            "a.xyz",
            b"3\nProperties=species:S:1:pos:R:3:n:I:1\nbead nan 0 0 0\nO 1 2 3 1\nO 1 x 3 0\n".to_vec(),
            "keep: [(\"n\", Is(1))], radius: 0.5",
        ),
    ] {
        let scene = scene(name, bytes, fields);
        assert_eq!(spheres(&scene), [[1.0, 2.0, 3.0, 0.5]], "{name}, {fields}");
        assert_eq!(warnings(&scene), "", "{name}, {fields}");
    }
}

/// Whether a column has numbers or text is that of the rows that are kept.
#[test]
fn the_first_row_that_is_kept_tells_texts() {
    let text = "n,x,y,z,r,v\n0,0,0,0,1,broken\n1,1,2,3,0.5,1\n1,1,2,3,0.5,2\n1,1,2,3,0.5,3\n";
    let kept = scene("a.csv", text, "value: \"v\", keep: [(\"n\", Is(1))]");
    let viridis = Colormap::Viridis.colors();
    assert_eq!(albedos(&kept), [viridis[0], viridis[128], viridis[255]]);
    let text = "n,x,y,z,r,v\n0,0,0,0,1,7\n1,1,2,3,0.5,a\n1,1,2,3,0.5,b\n";
    let kept = scene("a.csv", text, "value: \"v\", keep: [(\"n\", Is(1))]");
    let colors = kept.clouds()[0].colors.as_ref().unwrap();
    assert!(matches!(&colors.meaning, crate::ColorMeaning::Categories(all) if all.len() == 2));
}

/// Faults in the columns of conditions are told, and faults in kept rows as before.
#[test]
fn rows_are_refused_where_they_are_looked_at() {
    let keep = "keep: [(\"n\", Is(1))]";
    for (text, expected) in [
        (
            "x,y,z,r,n\n0,0,0,1,0\n0,0,0,1,one\n",
            "a.csv:3:9: expected a number for `n`, found `one`",
        ),
        (
            "x,y,z,r,n\n0,0,0,0,0\n0,0,0,0,1\n",
            "a.csv:3:7: expected a radius greater than 0 for `r`, found 0",
        ),
        (
            "x,y,z,r,n\n0,0,0,0\n",
            "a.csv:2:8: expected a number for `n`, found the end of the line",
        ),
    ] {
        assert_eq!(refusal("a.csv", text, keep), expected);
    }
}

/// Every line is counted, kept or not, also where many pieces are read at a time.
#[test]
fn rows_that_are_not_kept_are_counted() {
    const ROWS: usize = 100_000;
    let mut text = String::from("x,y,z,r,n\n");
    for row in 0..ROWS {
        let radius = if row % 4 == 0 { "1" } else { "0" };
        text += &format!("{row},0,0,{radius},{}\n", row % 4);
    }
    let scene = scene("a.csv", text, "keep: [(\"n\", Is(0))]");
    assert_eq!(scene.world().spheres().len(), ROWS / 4);
    assert_eq!(scene.clouds()[0].rows, ROWS as u64);
}

#[test]
fn tables_of_a_plane_have_a_constant() {
    let flat = "x,y,r\n0,0,1\n3,0,2\n1,3,0.7\n";
    let expected = "a.csv:1:1: expected a column `z`, found `x`, `y`, `r` (for a two-dimensional table, use \
         `columns: (z: 0.0)`)";
    assert_eq!(refusal("a.csv", flat, ""), expected);
    let found = spheres(&scene("a.csv", flat, "columns: (z: Constant(-2.5))"));
    let expected = [
        [0.0, 0.0, -2.5, 1.0],
        [3.0, 0.0, -2.5, 2.0],
        [1.0, 3.0, -2.5, 0.7],
    ];
    assert_eq!(found, expected);
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3)}";
    let array = npy(header, &doubles(&[1.0, 2.0, 3.0]));
    let columns = "columns: (y: Constant(7)), radius: 1";
    let found = spheres(&scene("a.npy", array, columns));
    assert_eq!(found, [[1.0, 7.0, 3.0, 1.0]]);
}

const EVENTS: &str = "time,mag,x,y,z
2020-02-26T20:00:29.166Z,0.4,-101,303,-211
2020-02-12T09:56:10.713Z,1.2,12,-80,-40
2020-03-31T10:32:39.906Z,0.0,83,878,-619
2020-06-01T00:00:00.000Z,-1,400,-300,-500
";

#[test]
fn magnitudes_become_radii_and_times_colors() {
    let radii = |scene: &Scene| {
        spheres(scene)
            .iter()
            .map(|sphere| sphere[3])
            .collect::<Vec<_>>()
    };
    let law = "columns: (radius: \"mag\", radius_scale: 20, radius_law: Exponential(0.5)), value: \"time\"";
    let scene = scene("a.csv", EVENTS, law);
    let expected =
        [0.4, 1.2, 0.0, -1.0].map(|magnitude: f64| 20.0 * libm::pow(10.0, 0.5 * magnitude));
    assert_eq!(
        (radii(&scene), warnings(&scene)),
        (expected.to_vec(), String::new())
    );
    let colors = scene.clouds()[0].colors.as_ref().unwrap();
    let crate::ColorMeaning::Scale {
        low,
        high,
        are_times,
        ..
    } = colors.meaning
    else {
        panic!("{colors:?}")
    };
    let shown = [low, high].map(crate::written_time);
    assert_eq!(
        (are_times, shown),
        (true, ["2020-02-12 09:56:10".into(), "2020-06-01".into()])
    );
    // In the order of time: the second is the first, and the last one the last.
    let viridis = Colormap::Viridis.colors();
    assert_eq!(
        (albedos(&scene)[1], albedos(&scene)[3]),
        (viridis[0], viridis[255])
    );
    let expected = "a.csv:4:26: expected a radius greater than 0 for `mag` (`radius_law: Exponential(0.5)` \
         converts magnitudes to radii), found 0.0";
    assert_eq!(
        refusal(
            "a.csv",
            EVENTS,
            "columns: (radius: \"mag\", radius_scale: 20)"
        ),
        expected
    );
    let volumes = "x,y,z,volume\n0,0,0,8\n0,0,0,27\n";
    let cube_root = "columns: (radius: \"volume\", radius_law: Power(0.3333333333333333))";
    let found = radii(&self::scene("a.csv", volumes, cube_root));
    assert!(
        (found[0] - 2.0).abs() < 1e-12 && (found[1] - 3.0).abs() < 1e-12,
        "{found:?}"
    );
    let message = refusal(
        "a.csv",
        EVENTS,
        "columns: (radius: \"mag\", radius_law: Exponential(900))",
    );
    let expected = "a.csv:2:26: expected a number that gives a finite radius greater than 0 for `mag`, found 0.4";
    assert_eq!(message, expected);
}
