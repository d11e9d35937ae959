//! Rows of text with a line of names.

use super::*;

#[test]
fn csv_is_read() {
    for text in [
        "x,y,z,radius\n1,-2.5,3e-3,.5\n4,5,6,7\n",
        "x,y,z,radius\r\n1,-2.5,3e-3,0.5\r\n4,5,6,7",
        "\u{feff}# Z ; name; X;Y ;R\n0.003; \"a;b\" ;\"1\"; -2.5 ;0.5\n\n6;;+4.0;5;7\n \n",
        "x\ty\tz\tr\n1\t-2.5\t0.003\t5e-1\n4\t5\t6\t7",
    ] {
        let scene = scene("a.csv", text, "");
        assert_eq!(spheres(&scene), TWO, "{text}");
        assert_eq!(albedos(&scene), [Color::ONE; 2]);
        assert_eq!(scene.clouds()[0].spheres, 0..2);
    }
    assert!(spheres(&scene("a.csv", "x,y,z,r\n", "")).is_empty());
}

#[test]
fn csv_is_refused_at_its_place() {
    for (text, expected) in [
        (
            "",
            "a.csv:1:1: expected a line with the names of the columns, found the end of the file",
        ),
        (
            "\n1,2",
            "a.csv:1:1: expected a line with the names of the columns, found the end of the line",
        ),
        (
            "1,2\n",
            "a.csv:1:1: expected a column `x`, found `1`, `2` (you can use numbers for columns: `columns: (x: 1, \
             y: 2, z: 3)`)",
        ),
        (
            "x,y,zz\n",
            "a.csv:1:1: expected a column `z`, found `x`, `y`, `zz` (for a two-dimensional table, use `columns: \
             (z: 0.0)`)",
        ),
        (
            "x,y,z\n",
            "a.csv:1:1: expected a column `radius`, or else `radius: …` in the scene, found `x`, `y`, `z`",
        ),
        (
            "x,y,z,X,r\n",
            "a.csv:1:1: expected every column once, found `x` a second time",
        ),
        (
            "x,y,z,r\n1,2,3,4\n1,2,3\n",
            "a.csv:3:6: expected a number for `r`, found the end of the line",
        ),
        (
            "x,y,z,r\n1,2,3,4\n1,2,3,4,5\n",
            "a.csv:3:9: expected the end of the line after 4 columns, found 5",
        ),
        (
            "x,y,z,r\n1,,3,4\n",
            "a.csv:2:3: expected a number for `y`, found nothing",
        ),
        (
            "x,y,z,r\n1,ä,b,4\n",
            "a.csv:2:3: expected a number for `y`, found `ä`",
        ),
        (
            "n,x,y,z,r\nä,1,b,3,4\n",
            "a.csv:2:5: expected a number for `y`, found `b`",
        ),
        (
            "x,y,z,r\n1,2,NaN,4\n",
            "a.csv:2:5: expected a finite number for `z`, found NaN",
        ),
        (
            "x,y,z,r\n1,2,-inf,4\n",
            "a.csv:2:5: expected a finite number for `z`, found -inf",
        ),
        (
            "x,y,z,r\n1,2,1e999,4\n",
            "a.csv:2:5: expected a finite number for `z`, found 1e999",
        ),
        (
            "x,y,z,r\n1,2,3,0\n",
            "a.csv:2:7: expected a radius greater than 0 for `r`, found 0",
        ),
        (
            "x,y,z,r\n1,2,3,-1\r\n",
            "a.csv:2:7: expected a radius greater than 0 for `r`, found -1",
        ),
        (
            "x,y,z,radius,r,g,b\n1,2,3,4,0,1,-0.5\n",
            "a.csv:2:13: expected a color channel of at least 0 for `b`, found -0.5",
        ),
    ] {
        assert_eq!(refusal("a.csv", text, ""), expected);
    }
    let broken = [b"x,y,z,r\n1,2,".as_slice(), &[0xff, b',', b'4', b'\n']].concat();
    let expected = "a.csv:2:5: expected a number for `z`, found `\u{fffd}`";
    assert_eq!(refusal("a.csv", broken, ""), expected);
    assert_eq!(
        refusal("a.csv", "x,y,z,energy\n", "radius: 1, value: \"energie\""),
        "a.csv:1:1: expected a column `energie`, found `x`, `y`, `z`, `energy`, did you mean `energy`?"
    );
    let long = format!("x,y,z,r\n{}", "1".repeat(5 << 20));
    let expected = "a.csv:2:1: expected a line of at most 1 MiB, found a longer one";
    assert_eq!(refusal("a.csv", long, ""), expected);
}

#[test]
fn a_message_shows_the_line_and_who_names_the_table() {
    let message = load("a.csv", "x,y,z,r\n1,2,3,4\n1,abc,3,4\n", "").unwrap_err();
    let expected = "a.csv:3:3: expected a number for `y`, found `abc`
  |
3 | 1,abc,3,4
  |   ^^^
the table is named at scene.ron:2:17";
    assert_eq!(message, expected);
}

#[test]
fn many_rows_come_in_their_order_and_the_first_fault_is_told() {
    let row = |index: usize| format!("{index},{},0,1\n", index * index);
    let rows: Vec<String> = (0..400_000).map(row).collect();
    let good = format!("x,y,z,r\n{}", rows.concat());
    assert!(good.len() > 6_000_000);
    let found = spheres(&scene("a.csv", &good, ""));
    assert_eq!(found.len(), 400_000);
    for (index, sphere) in found.iter().enumerate() {
        let x = index as f64;
        assert_eq!(*sphere, [x, x * x, 0.0, 1.0]);
    }
    for bad in [399_999, 300_000, 123_456] {
        let mut rows = rows.clone();
        rows[399_999] = String::from("nobody\n");
        rows[bad] = String::from("1,2,3,z\n");
        let expected = format!("a.csv:{}:7: expected a number for `r`, found `z`", bad + 2);
        let text = format!("x,y,z,r\n{}", rows.concat());
        assert_eq!(refusal("a.csv", text, ""), expected);
    }
}

#[test]
fn columns_of_colors_are_linear_numbers() {
    let text = "x,y,z,radius,r,g,b\n0,0,0,1,0.25,0.5,2\n";
    assert_eq!(
        albedos(&scene("a.csv", text, "")),
        [Color::new(0.25, 0.5, 2.0)]
    );
    assert_eq!(
        albedos(&scene("a.csv", text, "color: Material")),
        [Color::ONE]
    );
    let message = refusal("a.csv", "x,y,z\n", "radius: 1, color: Table");
    assert_eq!(
        message,
        "a.csv:1:1: expected a column `red`, found `x`, `y`, `z`"
    );
}

#[test]
fn numbers_become_colors_of_a_colormap() {
    let text = "x,y,z,r,energy\n0,0,5,1,-1\n1,0,6,1,0\n1,0,7,1,1\n";
    let viridis = Colormap::Viridis.colors();
    let found = albedos(&scene("a.csv", text, "value: \"energy\""));
    assert_eq!(found, [viridis[0], viridis[128], viridis[255]]);
    let magma = Colormap::Magma.colors();
    let fields = "value: \"energy\", colormap: Magma, range: (0, 2)";
    let found = albedos(&scene("a.csv", text, fields));
    assert_eq!(found, [magma[0], magma[0], magma[128]]);
    // A column that is used otherwise, too; and the default name.
    let found = albedos(&scene("a.csv", text, "value: \"z\", colormap: Grey"));
    assert_eq!(found, [0x000000, 0x808080, 0xffffff].map(from_srgb));
    let renamed = text.replace("energy", "value");
    let found = albedos(&scene("a.csv", renamed, "colormap: Viridis"));
    assert_eq!(found, [viridis[0], viridis[128], viridis[255]]);
}
