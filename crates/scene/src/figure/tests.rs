use std::path::PathBuf;
use std::{env, fs, process};

use glam::DVec3;
use marbles_core::{Color, Light, Sphere};

use super::*;
use crate::Scene;

/// A folder that is removed with its files.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = env::temp_dir().join(format!("marbles-figure-{}-{name}", process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The text of the figure of a table.
fn text(name: &str, bytes: impl AsRef<[u8]>) -> String {
    let folder = Folder::new(name);
    let path = folder.write(name, bytes);
    let text = Figure::default().scene_text(&path, name);
    let scene = Scene::parse(&text, &folder.0.join("scene.ron"));
    let scene = scene.unwrap_or_else(|error| panic!("{error}\n{text}"));
    // What the text says is what the table alone is shown as.
    let alone = Scene::load(&path).unwrap();
    assert_eq!(alone.world().spheres(), scene.world().spheres());
    assert_eq!(alone.view(1).unwrap(), scene.view(1).unwrap());
    text
}

/// Crystals are shown with all atoms on the faces of the cell; other tables with a cell say that it can be repeated.
#[test]
fn cells_are_shown_whole() {
    let salt = "salt\n5.64\n1 0 0\n0 1 0\n0 0 1\nNa Cl\n1 1\nDirect\n0 0 0\n.5 .5 .5\n";
    let text = self::text("POSCAR", salt);
    assert!(
        text.contains("radii: Covalent, //") && text.contains("edges: true, //"),
        "{text}"
    );
    assert!(text.contains("// repeat: (2, 2, 2), //"), "{text}");
    let folder = Folder::new("salt");
    let path = folder.write("POSCAR", salt);
    assert_eq!(Scene::load(&path).unwrap().world().spheres().len(), 9);
    let text = self::text("box.xyz", "1\nLattice=\"2 0 0 0 2 0 0 0 2\"\nC 0 0 0\n");
    assert!(
        text.contains("// repeat: (2, 2, 2), //") && !text.contains("edges"),
        "{text}"
    );
    let text = self::text("no-box.xyz", "1\n\nC 0 0 0\n");
    assert!(!text.contains("repeat"), "{text}");
}

#[test]
fn columns_are_found_or_left_out() {
    for (name, table, expected) in [
        (
            "named.csv",
            "x,y,z,radius\n0,0,0,1\n4,1,2,2\n",
            "material: \"particles\",\n        //",
        ),
        ("flat.csv", "x,y,r\n0,0,1\n4,1,1\n", "columns: (z: 0.0),"),
        ("three.txt", "0 0 0\n2 0 0\n4 0 0\n", "radius: 0.9,"),
        ("two.txt", "0 0\n2 0\n", "columns: (x: 1, y: 2, z: 0.0),"),
        (
            "four.txt",
            "0 0 0 1\n9 1 0 2\n",
            "columns: (x: 1, y: 2, z: 3, radius: 4),",
        ),
        (
            "value.txt",
            "0 0 0 -1.5\n9 1 0 2\n",
            "columns: (x: 1, y: 2, z: 3),",
        ),
        ("alone.csv", "x,y,z\n5,5,5\n", "radius: 1,"),
        ("same.csv", "x,y,z\n5,5,5\n5,5,5\n", "radius: 1,"),
    ] {
        let text = text(name, table);
        assert!(text.contains(expected), "{name}: {text}");
    }
}

#[test]
fn the_first_sensible_column_is_colored() {
    let rows = |columns: &str, row: &dyn Fn(u32) -> String| {
        let rows: String = (0..30)
            .map(|index| format!("{index},0,{index},{}\n", row(index)))
            .collect();
        format!("x,y,z,{columns}\n{rows}")
    };
    for (name, table, expected) in [
        (
            "a.csv",
            rows("id,mass", &|n| format!("{n},{}.5", n * n)),
            "value: \"mass\", colormap: Viridis, //",
        ),
        (
            "b.csv",
            rows("kind,mass", &|n| format!("{},{n}.5", n % 3)),
            "value: \"kind\", color: Category,",
        ),
        (
            "c.csv",
            rows("kind,mass", &|n| format!("1,{n}.5")),
            "value: \"mass\",",
        ),
        (
            "d.csv",
            rows("vx,vy,vz", &|n| format!("{n},0,1")),
            "value: Length(\"vx\", \"vy\", \"vz\")",
        ),
        ("e.csv", rows("name", &|n| format!("row {n}")), "albedo:"),
        (
            "f.csv",
            rows("kind", &|n| format!("k{}", n % 2)),
            "value: \"kind\", color: Category,",
        ),
        (
            "g.csv",
            rows("m", &|n| match n {
                3 => String::new(),
                n => format!("{n}.5"),
            }),
            "missing:",
        ),
        (
            "h.csv",
            rows("red,green,blue,m", &|n| format!("1,0,0,{n}.5")),
            "\"particles\": (outline",
        ),
        (
            "i.csv",
            rows("type,type,m", &|n| format!("1,{},{n}.5", n % 2)),
            "value: \"m\",",
        ),
    ] {
        let text = text(name, table);
        assert!(text.contains(expected), "{name}: {text}");
    }
}

#[test]
fn a_camera_looks_along_the_least_extent() {
    let view = |points: &[[f64; 3]]| {
        let spheres = points
            .iter()
            .map(|point| Sphere::new(DVec3::from_array(*point), 0.1).unwrap());
        let view = angle::of(&spheres.collect::<Vec<_>>(), false);
        (view.azimuth, view.elevation)
    };
    let grid = |scale: [f64; 3]| {
        let mut points = Vec::new();
        for index in 0..27 {
            let place = [index % 3, index / 3 % 3, index / 9];
            points.push([0, 1, 2].map(|axis| scale[axis] * f64::from(place[axis])));
        }
        points
    };
    // Planes are seen from the front, or from above.
    assert_eq!(view(&grid([2.0, 1.0, 0.0])), (0.0, 0.0));
    assert_eq!(view(&grid([2.0, 0.0, 1.0])), (0.0, 90.0));
    assert_eq!(view(&grid([0.0, 1.0, 2.0])), (90.0, 0.0));
    // Slabs are seen at a slight tilt.
    assert_eq!(view(&grid([2.0, 1.0, 0.2])), (15.0, 15.0));
    assert_eq!(view(&grid([2.0, 0.2, 1.0])), (15.0, 75.0));
    // Cubes, points and numbers too large look alike from everywhere.
    for points in [grid([1.0; 3]), grid([0.0; 3]), grid([1e300; 3]), vec![]] {
        assert_eq!(view(&points), (25.0, 20.0));
    }
    // A rod is seen across.
    let (azimuth, _) = view(&grid([0.01, 0.01, 9.0]));
    assert!((60.0..=110.0).contains(&azimuth), "{azimuth}");
}

#[test]
fn views_have_names() {
    let view = |text: &str| {
        text.parse::<ViewAngle>()
            .map(|view| (view.azimuth, view.elevation))
            .ok()
    };
    assert_eq!(view("right"), Some((-90.0, 0.0)));
    assert_eq!(view("30, -15.5"), Some((30.0, -15.5)));
    for wrong in ["", "Front", "30", "30,91", "30,nan", "inf,0", "1,2,3"] {
        assert_eq!(view(wrong), None, "{wrong}");
    }
}

/// From the left, x points away from the camera; a table of another program has z toward it in front.
#[test]
fn named_views_look_from_there() {
    let folder = Folder::new("named");
    let path = folder.write("a.xyz", "2\n\nO 0 0 0\nH 1 2 3\n");
    for (name, toward_camera) in [
        ("front", DVec3::new(0.0, 0.0, 1.0)),
        ("back", DVec3::new(0.0, 0.0, -1.0)),
        ("left", DVec3::new(-1.0, 0.0, 0.0)),
        ("right", DVec3::new(1.0, 0.0, 0.0)),
        ("top", DVec3::new(0.0, 1.0, 0.0)),
        ("bottom", DVec3::new(0.0, -1.0, 0.0)),
    ] {
        let figure = Figure {
            view: Some(name.parse().unwrap()),
            ..Figure::default()
        };
        let scene = Scene::load_figure(&path, &figure, &[], &|_| {}).unwrap();
        let along = scene.view(1).unwrap().camera.world_from_camera.z_axis;
        // The world of a scene has z negated.
        let expected = -toward_camera * DVec3::new(1.0, 1.0, -1.0);
        assert!((along - expected).length() < 1e-12, "{name}: {along}");
    }
}

#[test]
fn turntables_sizes_and_settings_are_those_of_the_figure() {
    let folder = Folder::new("turntable");
    let path = folder.write("a.xyz", "2\n\nO 0 0 0\nH 1 2 3\n");
    let figure = Figure {
        view: None,
        turntable: Some(7),
        size: Some((300, 500)),
    };
    let settings = ["background=0.25".parse().unwrap()];
    let scene = Scene::load_figure(&path, &figure, &settings, &|_| {}).unwrap();
    assert_eq!(scene.frames(), Some(1..=7));
    let view = scene.view(1).unwrap();
    assert_eq!((view.width, view.height), (300, 500));
    assert_eq!(scene.world().background, DVec3::splat(0.25));
    // A scene keeps its size.
    let text = Figure::default().scene_text(&path, "a.xyz");
    let file = folder.write("scene.ron", text);
    let scene = Scene::load_figure(&file, &figure, &[], &|_| {}).unwrap();
    assert_eq!(scene.frames(), Some(1..=7));
    assert_eq!(scene.view(1).unwrap().width, 1600);
}

#[test]
fn tables_with_faults_are_refused_at_their_place() {
    let folder = Folder::new("faults");
    for (name, table, expected) in [
        ("a.csv", "x,y,z\n0,0,red\n", "a.csv:2:5: "),
        ("b.csv", "x,y,z,radius\n0,0,0,-1\n", "b.csv:2:7: "),
        ("c.csv", "x,y,z\n", "c.csv"),
        (
            "d.csv",
            "a,b,c\n1,2,3\n",
            "d.csv:1:1: expected a column `x`",
        ),
        ("e.xyz", "3\n\nO 0 0 0\n", "e.xyz:"),
        ("f.csv", "", "f.csv"),
    ] {
        let path = folder.write(name, table);
        let error = Scene::load(&path).unwrap_err().to_string();
        assert!(error.contains(expected), "{name}: {error}");
    }
    let path = folder.write("g.xyz", "1\n\nO 0 0 0\n");
    let settings = ["ambient=red".parse().unwrap()];
    let error = Scene::load_figure(&path, &Figure::default(), &settings, &|_| {}).unwrap_err();
    let error = error.to_string();
    assert!(
        error.contains("g.xyz (its scene):") && error.contains("ambient: red"),
        "{error}"
    );
}

/// Soft light takes longer than hard light: few spheres have it, and stills only.
#[test]
fn few_spheres_are_in_soft_light() {
    let folder = Folder::new("soft");
    for (count, turntable, is_soft) in [
        (1, None, true),
        (200, None, true),
        (1, Some(8), false),
        (201, None, false),
    ] {
        let rows = (0..count).map(|row| format!("{row},0,0\n"));
        let path = folder.write("a.csv", format!("x,y,z\n{}", rows.collect::<String>()));
        let figure = Figure {
            turntable,
            ..Figure::default()
        };
        let scene = Scene::load_figure(&path, &figure, &[], &|_| {}).unwrap();
        let world = scene.world();
        assert_eq!(world.sky.is_some(), is_soft, "{count} {turntable:?}");
        assert_eq!(world.shadows, is_soft);
        // Where nothing is hidden, white is not clipped.
        let of_lights: Color = world.lights.iter().map(Light::intensity).sum();
        let of_sky = world.sky.map_or(Color::ZERO, |sky| sky.above());
        let brightest = world.ambient + of_lights + of_sky;
        assert!(brightest.max_element() <= 1.0 + 1e-12, "{brightest}");
    }
}
