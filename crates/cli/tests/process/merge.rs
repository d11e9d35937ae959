//! Parts of pictures, and the merged pictures.

use std::fs;

use crate::folder::{assert_complete, code, text};
use crate::sequences::{TURNTABLE, turntable};

/// Sixteen parts of a picture; none of them begins at the border of a tile.
fn parts(width: u32, height: u32) -> Vec<String> {
    let cuts = |all: u32| [0, all / 4 + 1, all / 2 - 3, 3 * all / 4, all];
    let (columns, rows) = (cuts(width), cuts(height));
    let part = |rows: &[u32], columns: &[u32]| {
        let (col, row) = (columns[0], rows[0]);
        format!("{col},{row},{},{}", columns[1] - col, rows[1] - row)
    };
    let rows = rows.windows(2);
    rows.flat_map(|rows| columns.windows(2).map(move |columns| part(rows, columns)))
        .collect()
}

#[test]
fn parts_are_merged_into_the_picture() {
    let folder = turntable();
    let colored = TURNTABLE.to_owned();
    let grey = colored
        .replace("\"#d02840\"", "0.5")
        .replace("\"#202838\"", "0.25");
    fs::write(folder.path("grey.ron"), grey).unwrap();
    for (scene, ending, more) in [
        ("turn", "png", ""),
        ("turn", "png", "--bits 16 --alpha"),
        ("grey", "png", ""),
        ("turn", "exr", ""),
        ("grey", "exr", "--float --alpha --error-channel"),
        ("turn", "exr", "--samples 2"),
        (
            "turn",
            "exr",
            "--samples 1 --channels depth,normal,position,id,albedo,mask --axes camera-opencv",
        ),
        ("turn", "png", "--linear --exposure -0.5"),
        ("turn", "npy", ""),
        ("grey", "npy", "--alpha"),
    ] {
        let render = format!("render {scene}.ron --frames 7 --size 101x83 {more}");
        let output = folder.run(&format!("{render} -o whole.{ending}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let mut names = Vec::new();
        for (number, region) in parts(101, 83).iter().enumerate() {
            let name = format!("part{number}.{ending}");
            let output = folder.run(&format!("{render} -o {name} --region {region}"));
            assert_eq!(code(&output), 0, "{}", text(&output.stderr));
            names.push(name);
        }
        let skipping = format!("{render} -o part3.{ending} --skip-existing --region");
        let [same, other] = [3, 4].map(|number| {
            let region = &parts(101, 83)[number];
            text(&folder.run(&format!("{skipping} {region}")).stdout)
        });
        assert!(same.contains(": skipped"), "{same}");
        assert!(!other.contains(": skipped"), "{other}");
        folder.run(&format!("{skipping} {}", parts(101, 83)[3]));
        names.rotate_left(5);
        let all = names.join(" ");
        let output = folder.run(&format!("merge ./{} {all}", names[3]));
        let errors = text(&output.stderr);
        assert_eq!(code(&output), 2, "{errors}");
        assert!(errors.contains("would replace a part"), "{errors}");
        let output = folder.run(&format!("merge merged.{ending} {all}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let line = format!("merged.{ending}: 8383 pixels from 16 parts\n");
        assert_eq!(text(&output.stdout), line);
        let [whole, merged] =
            ["whole", "merged"].map(|name| folder.read(&format!("{name}.{ending}")));
        assert!(whole == merged, "{scene}.{ending} {more}");
        // What is merged is as good as what is rendered.
        let again = format!("{render} -o merged.{ending} --skip-existing");
        assert!(text(&folder.run(&again).stdout).contains(": skipped"));
    }
}

#[test]
fn errors_beside_light_are_merged_on_their_own() {
    let folder = turntable();
    let render = "render turn.ron --frames 7 --size 50x40 --error-channel";
    for (name, region) in [
        ("whole", ""),
        ("left", "--region 0,0,21,40"),
        ("right", "--region 21,0,29,40"),
    ] {
        let output = folder.run(&format!("{render} -o {name}.npy {region}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    }
    for file in ["", "_error"] {
        let merge = format!("merge merged{file}.npy left{file}.npy right{file}.npy");
        assert_eq!(code(&folder.run(&merge)), 0);
        let [whole, merged] =
            ["whole", "merged"].map(|name| folder.read(&format!("{name}{file}.npy")));
        assert!(whole == merged, "{file}");
    }
    let again = format!("{render} -o merged.npy --skip-existing");
    assert!(text(&folder.run(&again).stdout).contains(": skipped"));
    let output = folder.run("merge mixed.npy left.npy right_error.npy");
    assert_eq!(code(&output), 2);
    let reason =
        "marbles: right_error.npy: not made from the same scene, frame and settings as left.npy";
    assert!(text(&output.stderr).starts_with(reason));
}

#[test]
fn parts_that_are_no_picture_together_are_refused() {
    let folder = turntable();
    let render = |name: &str, more: &str| {
        let output = folder.run(&format!(
            "render turn.ron --frames 1 --size 20x20 -o {name} {more}"
        ));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    };
    render("left.png", "--region 0,0,10,20");
    render("right.png", "--region 10,0,10,20");
    render("wide.png", "--region 9,0,11,20");
    render("narrow.png", "--region 11,0,9,20");
    render("other.png", "--region 10,0,10,20 --tolerance 1e-2");
    render("right.exr", "--region 10,0,10,20");
    let mut broken = folder.read("right.png");
    broken.pop();
    fs::write(folder.path("broken.png"), broken).unwrap();
    for (parts, reason) in [
        (
            "left.png wide.png",
            "wide.png: its region 9,0,11,20 overlaps that of left.png, 0,0,10,20",
        ),
        (
            "left.png narrow.png",
            "the parts leave a gap: none contains the pixel in column 10, row 0",
        ),
        ("left.png", "the parts leave a gap"),
        (
            "left.png other.png",
            "other.png: not made from the same scene, frame and settings as left.png",
        ),
        (
            "left.png right.exr",
            "right.exr: not made from the same scene, frame and settings as left.png",
        ),
        (
            "left.png broken.png",
            "broken.png: expected a complete picture",
        ),
        ("left.png missing.png", "missing.png: no such file"),
        ("left.png turn.ron", "turn.ron: expected a complete picture"),
    ] {
        let output = folder.run(&format!("merge out.png {parts}"));
        assert_eq!(code(&output), 2, "{parts}");
        let errors = text(&output.stderr);
        assert!(
            errors.starts_with(&format!("marbles: {reason}")),
            "{errors}"
        );
        assert!(!folder.path("out.png").exists());
    }
    for arguments in [
        "merge out.exr left.png right.png",
        "merge out.jpg left.png right.png",
        "merge out.png",
        "render turn.ron --frames 1 --size 20x20 --region 10,0,11,20",
        "render turn.ron --frames 1 --region 0,0,0,1",
        "render turn.ron --frames 1 --region 0,0,1",
    ] {
        assert_eq!(code(&folder.run(arguments)), 2, "{arguments}");
    }
    assert_eq!(
        code(&folder.run("merge nowhere/new/out.png left.png right.png")),
        0
    );
    assert_complete(&folder.path("nowhere/new/out.png"));
}

#[test]
fn an_exr_of_a_part_says_where_it_lies() {
    let folder = turntable();
    let region = "--region 13,29,40,21";
    let output = folder.run(&format!("render turn.ron --frames 1 -o part.exr {region}"));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    folder.run("render turn.ron --frames 1 -o whole.exr");
    let output = folder.run("compare part.exr whole.exr");
    let lines = text(&output.stdout);
    assert!(
        lines.contains("data window 40 x 21 at column 13, row 29"),
        "{lines}"
    );
}
