//! Keys that change the sky.

use std::fs;

use crate::folder::Folder;
use crate::lights::{balls, run};

#[test]
fn a_frame_is_the_picture_under_its_sky() {
    let sky = "sky: (above: (0.5, 0.25, 0.125), below: 0.25, up: (1, 0, 0))";
    let folder = Folder::new();
    let write = |name: &str, fields: &str| {
        fs::write(folder.path(name), balls(fields)).unwrap();
    };
    let keyed = |last: &str| {
        let keys = format!("(frame: 1, sky: 0), (frame: 3, {last})");
        format!("sky: 1, animation: Keyframes(keys: [{keys}]),")
    };
    write("keyed.ron", &keyed(sky));
    write("still.ron", &format!("{sky},"));
    let options = "--tolerance 0.03125 --size 25x18 --sidecar";
    let render = format!("render keyed.ron -o a.####.npy --skip-existing {options}");
    run(&folder, &render);
    run(&folder, &format!("render still.ron -o b.npy {options}"));
    // The header before them identifies the scene.
    let values = |name: &str| {
        const BYTES: usize = 25 * 18 * 3 * size_of::<f64>();
        let mut file = folder.read(name);
        file.split_off(file.len() - BYTES)
    };
    assert!(values("a.0003.npy") == values("b.npy"));
    assert!(values("a.0001.npy") != values("b.npy"));
    let sidecar = fs::read_to_string(folder.path("a.0003.json")).unwrap();
    assert!(
        sidecar.contains("\"above\": [0.5, 0.25, 0.125]"),
        "{sidecar}"
    );
    // Frames are rendered again if their sky is another one.
    write("keyed.ron", &keyed(&sky.replace("0.125", "0.5")));
    let said = run(&folder, &render);
    assert!(said.contains("a.0003.npy: error"), "{said}");
    assert!(!said.contains("a.0001.npy: error"), "{said}");
}
