//! PVD: files of several times, in order of these, with one part or several.

use super::*;

/// A VTU file with the four corners that all formats have.
pub(super) const CORNERS_VTU: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../tests/seeds/tables/corners.vtu"
);

/// A collection of these files at these times.
pub(super) fn collection(files: &[(&str, &str)]) -> String {
    let files = files.iter().map(|(time, file)| {
        format!("    <DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{file}\"/>\n")
    });
    let files: String = files.collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n{files}  </Collection>\n</VTKFile>\n"
    )
}

/// A VTU file with a sphere at these places along x, and an array of this name.
fn points(places: &[f64], array: &str) -> String {
    let numbers = |number: fn(&f64) -> String| -> String { places.iter().map(number).collect() };
    let positions = numbers(|x| format!("{x} 0 0 "));
    let values = numbers(|x| format!("{} ", x + 0.5));
    format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"{}\"><Points><DataArray \
         type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">{positions}</DataArray></Points><PointData><DataArray \
         type=\"Float64\" Name=\"{array}\" format=\"ascii\">{values}</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>\n",
        places.len()
    )
}

/// A folder with these files, and the scene of one of them.
fn load(files: &[(&str, String)], fields: &str) -> (Folder, Result<Scene, String>) {
    let folder = Folder::new();
    for (name, text) in files {
        let path = folder.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let name = files[0].0;
    let text = format!(
        "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),\nclouds: [(file: \"{name}\", {fields})])"
    );
    let scene = Scene::parse(&text, &folder.0.join("scene.ron")).map_err(|error| {
        let within = format!("{}{}", folder.0.display(), std::path::MAIN_SEPARATOR);
        let message = error.to_string().replace(&within, "");
        message.lines().next().unwrap().to_owned()
    });
    (folder, scene)
}

/// The places along x of a scene's spheres in a frame.
fn places(scene: &Scene, frame: i32) -> Vec<f64> {
    let world = scene.world_at(frame).unwrap();
    world
        .spheres()
        .iter()
        .map(|sphere| sphere.center().x)
        .collect()
}

#[test]
fn times_are_frames_in_their_order() {
    let files = [
        (
            "run.pvd",
            collection(&[
                ("10", "run/a.vtu"),
                ("2.5", "run/b.vtu"),
                ("1e1", "run/c.vtu"),
                ("-1", "run/d.vtu"),
            ]),
        ),
        ("run/a.vtu", points(&[1.0, 2.0], "heat")),
        ("run/b.vtu", points(&[3.0], "heat")),
        ("run/c.vtu", points(&[4.0], "heat")),
        ("run/d.vtu", points(&[5.0, 6.0, 7.0], "heat")),
    ];
    let (folder, scene) = load(
        &files,
        "radius: 1, frames: All, value: \"heat\", colormap: Grey",
    );
    let scene = scene.unwrap();
    assert_eq!(scene.frames(), Some(1..=3));
    assert_eq!(scene.warnings(), [""; 0]);
    for _ in 0..2 {
        assert_eq!(places(&scene, 3), [1.0, 2.0, 4.0]);
        assert_eq!(places(&scene, 1), [5.0, 6.0, 7.0]);
        assert_eq!(places(&scene, 2), [3.0]);
    }
    let mut listed = scene.table_files();
    listed.sort();
    let mut expected: Vec<PathBuf> = files.iter().map(|(name, _)| folder.0.join(name)).collect();
    expected.sort();
    assert_eq!(listed, expected);
    let (_folder, first) = load(&files, "radius: 1");
    let first = first.unwrap();
    assert_eq!(places(&first, 1), [5.0, 6.0, 7.0]);
    let expected =
        "run.pvd: the first frame of several is shown (`frames: All` shows them one after another)";
    assert_eq!(first.warnings(), [expected]);
    // A step that changes while frames are rendered.
    fs::write(folder.0.join("run/b.vtu"), points(&[8.0, 9.0], "heat")).unwrap();
    let message = scene.world_at(2).unwrap_err().to_string();
    assert!(message.contains("found a change"), "{message}");
}

#[test]
fn collections_of_other_things_are_refused() {
    let list = |text: &str| collection(&[("0", "a.vtu")]).replace("file=\"a.vtu\"", text);
    let vtu = ("a.vtu", points(&[1.0], "heat"));
    let other = ("b.vtu", points(&[1.0], "mass"));
    let broken = ("c.vtu", vtu.1.replace("1 0 0", "1 0"));
    let inner = ("d.pvd", list("file=\"d.pvd\""));
    let table = ("e.csv", "x,y,z\n1,2,3\n".to_owned());
    for (text, expected) in [
        (
            collection(&[("0", "a.vtu"), ("1", "a_1.vtu")]),
            "run.pvd:5:5: expected a file of this collection, found no file \"a_1.vtu\"",
        ),
        (
            collection(&[("0", "a.vtu"), ("0", "b.vtu")]),
            "b.vtu: expected the same arrays in all parts of a time, found others",
        ),
        (collection(&[("0", "c.vtu")]), "c.vtu:1:"),
        (
            list("file=\"d.pvd\""),
            "d.pvd: expected a table in a single file, found PVD, which lists files",
        ),
        (
            list("file=\"e.csv\""),
            "e.csv: expected a VTU or VTP file in a collection, found CSV",
        ),
        (
            list(""),
            "run.pvd:4:5: expected the name of a file as `file`, found `<DataSet",
        ),
        (
            collection(&[("soon", "a.vtu")]),
            "run.pvd:4:5: expected a number as `timestep`, found `<DataSet",
        ),
        (
            collection(&[]),
            "run.pvd:2:1: expected `<DataSet …>` in this collection, found none",
        ),
    ] {
        let files = [
            ("run.pvd", text),
            vtu.clone(),
            other.clone(),
            broken.clone(),
            inner.clone(),
            table.clone(),
        ];
        let (_folder, scene) = load(&files, "radius: 1, frames: All");
        let message = scene.map(|_| ()).unwrap_err();
        assert!(message.starts_with(expected), "{message}");
    }
}
