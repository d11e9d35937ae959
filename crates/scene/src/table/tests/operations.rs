//! Columns that need one more operation: constants, powers, times, lines before the table.

use super::*;

#[test]
fn constants_stand_for_columns() {
    let flat = "x,y,vx,vy\n0,1,3,4\n2,3,0,0.5\n";
    let columns =
        "columns: (z: 0.0, radius: 2.5), value: Length(\"vx\", \"vy\", 0.0), colormap: Grey";
    let constant = scene("a.csv", flat, columns);
    assert_eq!(
        spheres(&constant),
        [[0.0, 1.0, 0.0, 2.5], [2.0, 3.0, 0.0, 2.5]]
    );
    // The speeds are 5 and 0.5.
    assert_eq!(albedos(&constant), [Color::ONE, Color::ZERO]);
    let scaled = "columns: (z: -1e1, radius: Constant(3), radius_scale: 0.5)";
    let scaled = spheres(&scene("a.csv", flat, scaled));
    assert_eq!(scaled, [[0.0, 1.0, -10.0, 1.5], [2.0, 3.0, -10.0, 1.5]]);
    for (fields, expected) in [
        (
            "columns: (z: 0, radius: 1.0)",
            "scene.ron:2:39: expected the name of a column in quotation marks, its number from 1, or a constant such as `0.0`, found 0",
        ),
        (
            "columns: (z: -3, radius: 1.0)",
            "scene.ron:2:39: expected the name of a column in quotation marks, its number from 1, or a constant such as `0.0`, found -3",
        ),
        (
            "columns: (z: 0.0, radius: -0.5)",
            "scene.ron:2:52: expected a radius greater than 0, found -0.5",
        ),
        (
            "columns: (z: 0.0), radius: 1, value: 0.5",
            "a.csv:1:1: expected a column, found the constant `0.5`, which is allowed only for `x`, `y`, `z`, `radius` and in `Length`",
        ),
    ] {
        assert_eq!(refusal("a.csv", flat, fields), expected);
    }
}

#[test]
fn radii_follow_from_numbers_by_a_power() {
    let table = "x,y,z,m\n0,0,0,9\n0,0,0,0.25\n0,0,0,0\n";
    let radii = |fields: &str| -> Vec<f64> {
        let scene = scene("a.csv", table, fields);
        spheres(&scene).iter().map(|sphere| sphere[3]).collect()
    };
    // 1 + 2 × √9, 1 + 2 × √0.25, 1
    let power = "radius: Power(column: \"m\", factor: 2, exponent: 0.5, offset: 1)";
    assert_eq!(radii(&format!("columns: ({power})")), [7.0, 2.0, 1.0]);
    let scaled = format!("columns: ({power}, radius_scale: 10)");
    assert_eq!(radii(&scaled), [70.0, 20.0, 10.0]);
    let plain = "columns: (radius: Power(column: 4, offset: 0.5))";
    assert_eq!(radii(plain), [9.5, 0.75, 0.5]);
    for (fields, expected) in [
        (
            "columns: (radius: Power(column: \"m\", exponent: -1))",
            "a.csv:4:7: expected a number that gives a finite radius greater than 0 for `m`, found 0",
        ),
        (
            "columns: (radius: Power(column: \"m\", factor: -1, offset: 5))",
            "a.csv:2:7: expected a number that gives a finite radius greater than 0 for `m`, found 9",
        ),
        (
            "columns: (radius: Power(column: \"m\"), radius_law: Power(2))",
            "scene.ron:2:76: expected `radius: Power(…)` or `radius_law`, found both",
        ),
        (
            "columns: (radius: Power(column: 2.5))",
            "scene.ron:2:58: expected the name of a column in quotation marks, or its number from 1, found a constant",
        ),
        (
            "columns: (radius: Power(factor: 2))",
            "scene.ron:2:44: expected `column` in this `Power`, found none",
        ),
    ] {
        assert_eq!(refusal("a.csv", table, fields), expected);
    }
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4)}";
    let array = npy(header, &doubles(&[1.0, 2.0, 3.0, -4.0]));
    let message = refusal(
        "a.npy",
        &array,
        "columns: (radius: Power(column: 4, exponent: 0.5))",
    );
    let expected = "a.npy: row 1, column 4, byte 91: expected a number that gives a finite radius greater than 0 \
                    for `radius`, found -4";
    assert_eq!(message, expected);
}

#[test]
fn lines_before_a_table_are_skipped() {
    let table = "Simulation of 3 grains, 2024\nx,y,z,r\n1,-2.5,3e-3,0.5\n4,5,6,7\n";
    assert_eq!(spheres(&scene("a.csv", table, "skip_lines: 1")), TWO);
    let two = format!("written, by, a, program\n{table}");
    for name in ["a.csv", "a.txt", "a.table"] {
        assert_eq!(spheres(&scene(name, &two, "skip_lines: 2")), TWO);
    }
    let gz = super::compressed::gzip(two.as_bytes());
    assert_eq!(spheres(&scene("a.csv.gz", gz, "skip_lines: 2")), TWO);
    let broken = two.replace("4,5,6", "4,five,6");
    for (name, text, fields, expected) in [
        (
            "a.csv",
            broken.as_str(),
            "skip_lines: 2",
            "a.csv:5:3: expected a number for `y`, found `five`",
        ),
        (
            "a.csv",
            table,
            "skip_lines: 9",
            "a.csv:5:1: expected a table behind 9 lines (`skip_lines: 9`), found the end of the file",
        ),
        (
            "a.csv",
            table,
            "skip_lines: 4",
            "a.csv:5:1: expected a line with the names of the columns, found the end of the file",
        ),
        (
            "a.xyz",
            "title\n1\n\nC 1 2 3\n",
            "skip_lines: 1",
            "a.xyz: expected a table of plain text for `skip_lines`, found XYZ",
        ),
        (
            "a.csv",
            table,
            "skip_lines: 1.5",
            "scene.ron:2:38: expected a whole number of lines, at least 0, found 1.5",
        ),
    ] {
        assert_eq!(refusal(name, text, fields), expected);
    }
}

/// Two of the rows have the same time.
const TIMES: &str = "frame,x,y,z,r\n10,1,0,5,1\n-0.5,2,0,5,1\n10,3,0,5,1\n2e0,4,0,5,1\n";

#[test]
fn rows_with_the_same_time_are_a_step() {
    let folder = Folder::new();
    let steps = |name: &str, bytes: &[u8], fields: &str| -> Vec<Vec<f64>> {
        fs::write(folder.0.join(name), bytes).unwrap();
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [(file: \"{name}\", {fields}, \
             right_handed: false)])"
        );
        let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
        let frames = scene.frames().unwrap();
        let x_of = |frame: i32| {
            let world = scene.world_at(frame).unwrap();
            world
                .spheres()
                .iter()
                .map(|sphere| sphere.center().x)
                .collect()
        };
        frames.map(x_of).collect()
    };
    let all = steps("a.csv", TIMES.as_bytes(), "time: \"frame\"");
    assert_eq!(all, [vec![2.0], vec![4.0], vec![1.0, 3.0]]);
    let last = steps(
        "a.csv",
        TIMES.as_bytes(),
        "time: 1, steps: (2, 3), every: 1",
    );
    assert_eq!(last, [vec![4.0], vec![1.0, 3.0]]);
    let kept = steps(
        "a.csv",
        TIMES.as_bytes(),
        "time: \"frame\", keep: [(\"x\", Between(1.5, 3.5))]",
    );
    assert_eq!(kept, [vec![2.0], vec![3.0]]);
    let gz = super::compressed::gzip(TIMES.as_bytes());
    let all = steps("a.csv.gz", &gz, "time: \"frame\", value: \"frame\"");
    assert_eq!(all, [vec![2.0], vec![4.0], vec![1.0, 3.0]]);
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 5)}";
    let rows = [
        1.0, 0.0, 5.0, 1.0, 7.0, 2.0, 0.0, 5.0, 1.0, 6.0, 3.0, 0.0, 5.0, 1.0, 7.0,
    ];
    let all = steps("a.npy", &npy(header, &doubles(&rows)), "time: 5");
    assert_eq!(all, [vec![2.0], vec![1.0, 3.0]]);
    // Dates are numbers.
    let dated = "day,x,y,z,r\n2024-03-01,1,0,5,1\n2024-02-29,2,0,5,1\n";
    let all = steps("a.csv", dated.as_bytes(), "time: \"day\"");
    assert_eq!(all, [vec![2.0], vec![1.0]]);
}

#[test]
fn times_that_tell_no_steps_are_refused() {
    for (text, fields, expected) in [
        (
            TIMES,
            "time: \"fram\"",
            "a.csv:1:1: expected a column `fram`, found `frame`, `x`, `y`, `z`, `r`, did you mean `frame`?",
        ),
        (
            "frame,x,y,z,r\n1,1,0,5,1\n,2,0,5,1\n",
            "time: \"frame\"",
            "a.csv:3:1: expected a number for `frame`, found nothing",
        ),
        (
            "frame,x,y,z,r\n1,1,0,5,1\nnan,2,0,5,1\n",
            "time: \"frame\"",
            "a.csv:3:1: expected a finite number for `frame`, found `nan`",
        ),
        (
            TIMES,
            "time: \"frame\", frames: All",
            "scene.ron:2:32: expected `frames: All` or `time`, found both",
        ),
        (
            TIMES,
            "time: 1.0",
            "scene.ron:2:32: expected the name of a column in quotation marks, or its number from 1, found a constant",
        ),
        (
            TIMES,
            "time: \"frame\", keep: [(\"x\", Is(77))]",
            "scene.ron:2:17: expected steps \"a.csv\", found none",
        ),
    ] {
        assert_eq!(refusal("a.csv", text, fields), expected);
    }
    let folder = Folder::new();
    fs::write(folder.0.join("a.1.csv"), TIMES).unwrap();
    let text = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [(file: \"a.#.csv\", time: \"frame\")])";
    let error = Scene::parse(text, &folder.0.join("scene.ron")).unwrap_err();
    assert_eq!(
        error.faults()[0].message,
        "expected one file for `time`, found a numbered series, each of whose files is a step"
    );
}

/// 1970-01-02 is a day of 86,400 seconds after the start.
#[test]
fn dates_are_seconds() {
    let text = "1970-01-02 1 2 3\n1970-01-01T00:00:01Z 4 5 6\n";
    let found = spheres(&scene(
        "a.txt",
        text,
        "columns: (x: 1, y: 2, z: 3, radius: 4)",
    ));
    assert_eq!(found, [[86_400.0, 1.0, 2.0, 3.0], [1.0, 4.0, 5.0, 6.0]]);
}
