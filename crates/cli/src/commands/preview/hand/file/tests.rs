//! Tests of `file.rs`.

use marbles_core::glam::DVec3;
use marbles_scene::OrbitCenter;

use super::super::motion::Motion;
use super::*;
use crate::tests::temporary;

const RIGHT: Motion = Motion::Around {
    right: 5.0,
    up: 0.0,
};

fn hand(center: OrbitCenter) -> Hand {
    Hand::new(OrbitCamera {
        center,
        azimuth: 0.0,
        elevation: 10.0,
        roll: 0.0,
        zoom: 1.0,
    })
}

/// A file with this text, removed at the end.
struct Written(std::path::PathBuf);

impl Written {
    fn new(name: &str, text: &str) -> Self {
        let path = temporary(name);
        fs::write(&path, text).unwrap();
        Self(path)
    }

    fn text(&self) -> String {
        fs::read_to_string(&self.0).unwrap()
    }
}

impl Drop for Written {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

const SCENE: &str =
    "\u{feff}( // a scene\r\n    camera: Frame(elevation: 10), // its camera\r\n    lens: Fov(3))";

#[test]
fn the_camera_is_written_into_the_file() {
    let scene = Written::new("hand.ron", SCENE);
    let mut file = CameraFile::of(&scene.0, &[]).unwrap();
    let mut hand = hand(OrbitCenter::Framed);
    assert!(
        file.write(&mut hand)
            .ends_with("hand.ron has this camera already")
    );
    assert_eq!(file.lines(&hand).unwrap(), "camera: Frame(elevation: 10),");
    assert_eq!(scene.text(), SCENE);
    hand.apply(RIGHT);
    hand.apply(Motion::Zoom(4));
    assert_eq!(
        file.lines(&hand).unwrap(),
        "camera: Frame(elevation: 10, azimuth: -5), zoom: 2,"
    );
    assert!(
        file.write(&mut hand)
            .ends_with("hand.ron: the camera is written")
    );
    let camera = "camera: Frame(elevation: 10, azimuth: -5), zoom: 2,";
    let expected = SCENE.replace("camera: Frame(elevation: 10),", camera);
    assert_eq!(scene.text(), expected);
    // And again from there.
    assert_eq!(hand.change(), Change::None);
    hand.apply(RIGHT);
    file.write(&mut hand);
    assert_eq!(scene.text(), expected.replace("-5", "-10"));
}

#[test]
fn a_camera_that_somebody_else_wrote_stays() {
    let scene = Written::new("hand_of_others.ron", SCENE);
    let mut file = CameraFile::of(&scene.0, &[]).unwrap();
    let mut hand = hand(OrbitCenter::Framed);
    hand.apply(RIGHT);
    let of_others = SCENE.replace("elevation: 10", "elevation: 11");
    fs::write(&scene.0, &of_others).unwrap();
    let message = file.write(&mut hand);
    assert!(
        message.contains("its camera has changed since it was read"),
        "{message}"
    );
    assert_eq!(scene.text(), of_others);
    // Other changes are kept.
    let other_lens = SCENE.replace("Fov(3)", "Fov(4)");
    fs::write(&scene.0, &other_lens).unwrap();
    file.write(&mut hand);
    assert_eq!(scene.text(), other_lens.replace("10)", "10, azimuth: -5)"));
    fs::remove_file(&scene.0).unwrap();
    hand.apply(RIGHT);
    let message = file.write(&mut hand);
    assert!(
        message.contains("cannot read the file: no such file"),
        "{message}"
    );
    assert!(!scene.0.exists());
}

/// What `--set` says of the camera is written with it, and nothing else of it.
#[test]
fn the_camera_of_the_command_line_is_written() {
    let scene = Written::new("hand_set.ron", SCENE);
    let settings = [
        "camera=Orbit(target: (1, 1, 1), radius: 3, elevation: 10)",
        "lens=Fov(9)",
    ];
    let settings = settings.map(|setting| setting.parse().unwrap());
    let mut file = CameraFile::of(&scene.0, &settings).unwrap();
    let mut hand = hand(OrbitCenter::At {
        target: DVec3::ONE,
        radius: 3.0,
    });
    hand.apply(RIGHT);
    file.write(&mut hand);
    let camera = "Orbit(target: (1, 1, 1), radius: 3, elevation: 10, azimuth: -5)";
    assert_eq!(scene.text(), SCENE.replace("Frame(elevation: 10)", camera));
}

#[test]
#[cfg(unix)]
fn a_file_keeps_its_permissions_and_its_links() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let scene = Written::new("hand_mode.ron", SCENE);
    let link = temporary("hand_link.ron");
    let _ = fs::remove_file(&link);
    symlink(&scene.0, &link).unwrap();
    fs::set_permissions(&scene.0, fs::Permissions::from_mode(0o600)).unwrap();
    let mut file = CameraFile::of(&link, &[]).unwrap();
    let mut hand = hand(OrbitCenter::Framed);
    hand.apply(RIGHT);
    file.write(&mut hand);
    assert_ne!(scene.text(), SCENE);
    assert!(link.is_symlink());
    assert_eq!(
        fs::metadata(&scene.0).unwrap().permissions().mode() & 0o777,
        0o600
    );
    fs::remove_file(link).unwrap();
}

#[test]
fn a_table_has_a_command_instead() {
    let table = Written::new("hand.xyz", "2\n\nO 0 0 0\nH 1 0 0\n");
    let mut file = CameraFile::of(&table.0, &[]).unwrap();
    let mut hand = hand(OrbitCenter::Framed);
    hand.apply(RIGHT);
    let message = file.write(&mut hand);
    assert!(
        message.contains("hand.xyz is a table, which has no camera: p prints"),
        "{message}"
    );
    let name = table.0.to_str().unwrap();
    let command = format!("marbles render {name} --view -5,10");
    let lines = file.lines(&hand).unwrap();
    assert_eq!(
        lines,
        format!("camera: Frame(azimuth: -5, elevation: 10),\n{command}")
    );
    hand.apply(Motion::Roll(5.0));
    hand.apply(Motion::Zoom(4));
    let lines = file.lines(&hand).unwrap();
    let more = format!("{command} --set camera.roll=5 --set zoom=2");
    assert_eq!(lines.lines().nth(1), Some(&*more));
    let hand = self::hand(OrbitCenter::At {
        target: DVec3::ONE,
        radius: 3.0,
    });
    let camera = "'camera=Orbit(target: (1, 1, 1), radius: 3, azimuth: 0, elevation: 10)'";
    let line = format!("marbles render {name} --set {camera}");
    assert_eq!(file.lines(&hand).unwrap().lines().nth(1), Some(&*line));
}
