//! Figures of tables: one command from a file to a picture, and the scene that it renders.

use std::fs;

use crate::folder::{Folder, code, text};

const WATER: &str = "3\nwater\nO 0 0 0.117\nH 0 0.757 -0.469\nH 0 -0.757 -0.469\n";
const GRAINS: &str = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\n\
    ITEM: ATOMS id type x y z vx vy vz\n1 1 0.8 0.9 0.5 -0.2 0 0\n2 1 2 1.1 0.5 0.5 0 0\n3 1 3.2 0.9 0.8 0 0 0.1\n";

fn folder() -> Folder {
    let folder = Folder::new();
    for (name, table) in [
        ("water.xyz", WATER),
        ("grains.dump", GRAINS),
        (
            "points.csv",
            "x,y,z,mass\n0,0,0,1.5\n1,0,0,2.5\n0,1,3,4.5\n",
        ),
        ("balls.txt", "0 0 0 1\n9 0 1 2\n0 8 1 1\n"),
    ] {
        fs::write(folder.path(name), table).unwrap();
    }
    folder
}

#[test]
fn a_table_and_its_scene_are_the_same_picture() {
    let folder = folder();
    for (table, name) in [
        ("water.xyz", "water"),
        ("grains.dump", "grains"),
        ("points.csv", "points"),
        ("balls.txt", "balls"),
    ] {
        for options in ["", " --view top", " --view -30,40", " --turntable=2"] {
            let made = folder.run(&format!("new {table} -o scenes/{name}.ron{options}"));
            assert_eq!(code(&made), 0, "{}", text(&made.stderr));
            let numbered = if options.contains("turn") { ".#" } else { "" };
            let render = |file: &str, options: &str, output: &str| {
                // The middle of the picture, at its own size: that is a part of the scene.
                let more = "--samples 1 --strict --region 500,200,600,240";
                let line = format!("render {file}{options} {more} -o {output}{numbered}.png");
                let rendered = folder.run(&line);
                assert_eq!(code(&rendered), 0, "{line}: {}", text(&rendered.stderr));
                folder.read(&format!("{output}{}.png", numbered.replace('#', "1")))
            };
            let of_table = render(table, options, "table");
            let of_scene = render(&format!("scenes/{name}.ron"), "", "scene");
            assert!(of_table == of_scene, "{table}{options}");
            fs::remove_file(folder.path(&format!("scenes/{name}.ron"))).unwrap();
        }
    }
}

#[test]
fn pictures_are_named_after_their_tables() {
    let folder = folder();
    let render = |options: &str| {
        let rendered = folder.run(&format!("render --samples 1 {options}"));
        assert_eq!(code(&rendered), 0, "{}", text(&rendered.stderr));
        text(&rendered.stdout)
    };
    assert!(render("water.xyz").starts_with("water.png: "));
    assert!(render("water.xyz --turntable=2 --size 20x10").starts_with("water.0001.png: "));
    assert!(render("grains.dump points.csv --size 20x10 -o {scene}.tif").contains("points.tif: "));
    let transparent = render("water.xyz --transparent --size 20x10 -o a.png");
    assert!(transparent.starts_with("a.png: "), "{transparent}");
    render("water.xyz --alpha --size 20x10 -o b.png");
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    // Another color of the background, and white after all.
    render("water.xyz --set background=0 --size 20x10 -o c.png");
    render("water.xyz --white --size 20x10 -o d.png");
    render("water.xyz --size 20x10 -o e.png");
    assert_ne!(folder.read("c.png"), folder.read("e.png"));
    assert_eq!(folder.read("d.png"), folder.read("e.png"));
}

#[test]
fn views_and_backgrounds_of_scenes_are_replaced() {
    let folder = folder();
    fs::write(
        folder.path("a.ron"),
        "(image: (width: 30, height: 20), lens: Fov(30), camera: Free(), ambient: 0.5, clouds: [(file: \"water.xyz\")])",
    )
    .unwrap();
    let options = "--view right --turntable=3 --white";
    let rendered = folder.run(&format!("render a.ron {options} --frames 2 -o a.png"));
    assert_eq!(code(&rendered), 0, "{}", text(&rendered.stderr));
    let set =
        "--set camera=Frame(azimuth:-90) --set animation=Turntable(frames:3) --set background=1";
    let rendered = folder.run(&format!("render a.ron {set} --frames 2 -o b.png"));
    assert_eq!(code(&rendered), 0, "{}", text(&rendered.stderr));
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
}

#[test]
fn wrong_tables_and_options_are_refused() {
    let folder = folder();
    fs::write(folder.path("cut.xyz"), "3\n\nO 0 0 0\n").unwrap();
    fs::write(folder.path("a.ron"), "()").unwrap();
    for (line, status, expected) in [
        ("render missing.pdb", 2, "missing.pdb: no such file"),
        ("render cut.xyz", 2, "cut.xyz"),
        ("new cut.xyz", 2, "cut.xyz"),
        ("new missing.pdb", 2, "missing.pdb: no such file"),
        (
            "new water.xyz -o a.ron",
            1,
            "a.ron: the file already exists",
        ),
        (
            "new water.xyz -o a.png",
            2,
            "expected a file name that ends in .ron, found `a.png`",
        ),
        (
            "new a.ron -o b.ron",
            2,
            "a.ron: expected a table of particles",
        ),
        (
            "new b.ron --view top",
            2,
            "--view is for the scene of a table",
        ),
        (
            "render water.xyz --view above",
            2,
            "expected front, back, left, right, top, bottom",
        ),
        ("render water.xyz --turntable=0", 2, "--turntable"),
        ("render water.xyz --white --alpha", 2, "--white"),
        ("render water.xyz -o water.xyz", 2, "water.xyz"),
    ] {
        let output = folder.run(line);
        let errors = text(&output.stderr);
        assert_eq!(code(&output), status, "{line}: {errors}");
        assert!(errors.contains(expected), "{line}: {errors}");
    }
    assert!(!folder.path("b.ron").exists() && !folder.path("cut.ron").exists());
}

#[test]
fn drawings_inside_stand_next_to_the_picture() {
    let folder = folder();
    let line = "render points.csv --size 640x400 --samples 1 -o a.png --legend inside --scale-bar=inside --set unit=\"mm\"";
    let rendered = folder.run(line);
    assert_eq!(code(&rendered), 0, "{}", text(&rendered.stderr));
    let figure = String::from_utf8(folder.read("a.svg")).unwrap();
    assert!(figure.starts_with("<svg xmlns"), "{figure}");
    // The legend is 340 wide.
    assert!(figure.contains("width=\"980\" height=\"400\""), "{figure}");
    assert!(figure.contains("data:image/png;base64,iVBORw0KGgo"));
    assert_eq!(figure.matches("<svg x=\"640\" y=").count(), 2, "{figure}");
    assert!(
        figure.contains(">mass</text>") && figure.contains(" mm</text>"),
        "{figure}"
    );
    assert_eq!(figure.matches("</svg>").count(), 3);
    for more in ["-o a.exr", "--turntable=2", "-o b.png --region 0,0,9,9"] {
        let refused = folder.run(&format!(
            "render points.csv --samples 1 --legend inside {more}"
        ));
        assert_eq!(code(&refused), 2, "{more}");
        let errors = text(&refused.stderr);
        assert!(
            errors.contains("next to a single whole picture in PNG"),
            "{errors}"
        );
    }
}
