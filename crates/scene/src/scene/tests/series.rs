//! Clouds that change over time, and what their columns mean.

use std::path::PathBuf;
use std::{env, fs, process};

use glam::DVec3;
use marbles_core::{Channels, Color};

use crate::values::from_srgb;
use crate::{ColorMeaning, Scene};

/// A folder of tables that is gone after the test.
pub(super) struct Folder(pub(super) PathBuf);

impl Folder {
    pub(super) fn new(name: &str) -> Self {
        let path = env::temp_dir().join(format!("marbles-series-{name}-{}", process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(super) fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    pub(super) fn load(&self, clouds: &str, camera: &str, more: &str) -> Result<Scene, String> {
        let text = format!(
            "(image: (width: 6, height: 4), lens: Fov(40), camera: {camera}, clouds: [{clouds}]{more})"
        );
        let scene = Scene::parse(&text, &self.0.join("scene.ron"));
        let folder = format!("{}{}", self.0.display(), std::path::MAIN_SEPARATOR);
        scene.map_err(|error| error.to_string().replace(&folder, ""))
    }

    pub(super) fn scene(&self, clouds: &str) -> Scene {
        self.load(clouds, "Free()", "")
            .unwrap_or_else(|message| panic!("{message}"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Three steps of two spheres, the second of which goes along x; the value is 10 times its place.
pub(super) fn steps(folder: &Folder) {
    for step in 0..3 {
        let (x, value) = (2 * step, 20 * step);
        let text = format!("x,y,z,r,value\n0,0,10,1,5\n{x},0,10,1,{value}\n");
        folder.write(&format!("run.{:04}.csv", 10 * step), &text);
    }
}

/// The places of the spheres along x in a frame.
pub(super) fn places(scene: &Scene, frame: i32) -> Vec<f64> {
    let world = scene.world_at(frame).unwrap();
    world
        .spheres()
        .iter()
        .map(|sphere| sphere.center().x)
        .collect()
}

fn colors(scene: &Scene, frame: i32) -> Vec<Color> {
    let world = scene.world_at(frame).unwrap();
    (0..world.spheres().len())
        .map(|index| world.albedo(index))
        .collect()
}

#[test]
fn frames_show_the_steps_of_numbered_files() {
    let folder = Folder::new("files");
    steps(&folder);
    let scene = folder.scene("(file: \"run.####.csv\")");
    assert!(scene.has_steps());
    assert_eq!(scene.frames(), Some(1..=3));
    assert_eq!(places(&scene, 1), [0.0, 0.0]);
    assert_eq!(places(&scene, 3), [0.0, 4.0]);
    assert_eq!(places(&scene, 9), [0.0, 4.0]);
    assert_eq!(scene.steps_at(3), scene.steps_at(9));
    assert_ne!(scene.steps_at(2), scene.steps_at(3));
    // Without the clouds that change.
    assert!(scene.world().spheres().is_empty());
    let chosen = folder.scene("(file: \"run.%04d.csv\", steps: (10, 20), end: Loop, speed: 0.5)");
    let all: Vec<f64> = (1..=6).map(|frame| places(&chosen, frame)[1]).collect();
    assert_eq!(all, [2.0, 2.0, 4.0, 4.0, 2.0, 2.0]);
    let hidden = folder.scene("(file: \"run.####.csv\", every: 2, end: Hide)");
    assert_eq!(places(&hidden, 2), [0.0, 4.0]);
    assert!(places(&hidden, 3).is_empty());
    let message = folder.load("(file: \"run.####.csv\", steps: (30, 40))", "Free()", "");
    let message = message.unwrap_err();
    let expected =
        "expected steps \"run.####.csv\" with a number from 30 to 40, found those from 0 to 20";
    assert!(message.contains(expected), "{message}");
    let message = folder
        .load("(file: \"other.####.csv\")", "Free()", "")
        .unwrap_err();
    assert!(
        message.contains("expected steps \"other.####.csv\", found none"),
        "{message}"
    );
}

/// Clouds keep their order, and those that do not change are there in each frame.
#[test]
fn clouds_that_change_stand_beside_those_that_do_not() {
    let folder = Folder::new("order");
    steps(&folder);
    folder.write("still.csv", "x,y,z,r\n-1,0,0,1\n");
    let still = "(file: \"still.csv\")";
    let scene = folder.scene(&format!("{still}, (file: \"run.####.csv\"), {still}"));
    assert_eq!(places(&scene, 2), [-1.0, 0.0, 2.0, -1.0]);
    assert_eq!(scene.clouds()[1].steps, Some(3));
    assert_eq!(scene.clouds()[2].spheres, 3..4);
    // What stands behind a cloud that changes may be all that has a color, or bumps.
    folder.write("red.csv", "x,y,z,r,red,green,blue\n0,0,0,1,1,0,0\n");
    let colored = folder.scene("(file: \"run.####.csv\"), (file: \"red.csv\")");
    for world in [colored.world(), &colored.world_at(1).unwrap()] {
        assert_eq!(Channels::of(world, false), Channels::Rgb);
    }
    let rough = folder.load(
        "(file: \"run.####.csv\"), (file: \"still.csv\", material: \"m\")",
        "Free()",
        ", materials: {\"m\": (rough: (grain: Surface(1)))}",
    );
    assert!(rough.unwrap().world().has_bumps());
    let keyed = folder.load(
        "(file: \"run.####.csv\")",
        "Free()",
        ", animation: Keyframes(frames: (11, 20))",
    );
    let keyed = keyed.unwrap();
    assert_eq!(keyed.frames(), Some(11..=20));
    assert_eq!(places(&keyed, 12), [0.0, 2.0]);
}

/// Neither colors nor the camera depend on the step, unless that is asked for.
#[test]
fn nothing_jumps_from_step_to_step() {
    let folder = Folder::new("jumps");
    steps(&folder);
    let cloud = "(file: \"run.####.csv\", value: \"value\", colormap: Grey)";
    let scene = folder.load(cloud, "Frame()", "").unwrap();
    // 5 of 0 to 40 in all frames.
    assert_eq!(colors(&scene, 1)[0], colors(&scene, 3)[0]);
    assert_eq!(colors(&scene, 1)[0], from_srgb(0x202020));
    assert_eq!(colors(&scene, 3)[1], Color::ONE);
    let Some(description) = &scene.clouds()[0].colors else {
        panic!("colors")
    };
    assert_eq!(description.column.as_deref(), Some("value"));
    let ColorMeaning::Scale { low, high, .. } = description.meaning else {
        panic!("a scale")
    };
    assert_eq!((low, high), (0.0, 40.0));
    let position = |scene: &Scene, frame| scene.view(frame).unwrap().camera.position;
    assert_eq!(position(&scene, 1), position(&scene, 3));
    // The camera that has all of one step: those of all steps together lie from -1 to 5.
    let all = "x,y,z,r,value\n0,0,10,1,5\n2,0,10,1,5\n4,0,10,1,5\n";
    folder.write("all.csv", all);
    let together = folder.load("(file: \"all.csv\")", "Frame()", "").unwrap();
    assert!((position(&together, 1) - position(&scene, 1)).length() < 1e-12);
    let step = folder.load(cloud, "Frame(frame_over: Step)", "").unwrap();
    folder.write("one.csv", "x,y,z,r\n0,0,10,1\n2,0,10,1\n");
    let alone = folder.load("(file: \"one.csv\")", "Frame()", "").unwrap();
    assert!((position(&alone, 1) - position(&step, 2)).length() < 1e-12);
    assert_ne!(position(&step, 1), position(&step, 2));
    // A step that no frame of the animation shows is framed as well.
    let short = ", animation: Keyframes(frames: (1, 1))";
    let short = folder
        .load(cloud, "Frame(frame_over: Step)", short)
        .unwrap();
    assert_eq!(position(&short, 3), position(&step, 3));
    let slow = "(file: \"run.####.csv\", speed: 1e-5)";
    let message = folder
        .load(slow, "Frame(frame_over: Step)", "")
        .unwrap_err();
    let expected = "expected at most 100000 frames for `frame_over: Step`, found 300000";
    assert!(message.contains(expected), "{message}");
    let slower = slow.replace("1e-5", "1e-9");
    let message = folder.load(&slower, "Free()", "").unwrap_err();
    let expected = "expected steps for at most 1000000 frames, found steps for 2147483647";
    assert!(message.contains(expected), "{message}");
    // The middle of all steps.
    let centered = folder.scene("(file: \"run.####.csv\", center: true)");
    assert_eq!(places(&centered, 1), [-2.0, -2.0]);
    assert_eq!(places(&centered, 3), [-2.0, 2.0]);
}

#[test]
fn frames_of_one_file_are_found_in_any_order() {
    let folder = Folder::new("one");
    let frame = |x: i32| format!("1\nstep {x}\nC {x} 0 0\n");
    folder.write("run.xyz", &[1, 2, 3, 4].map(frame).concat());
    let scene = folder.scene("(file: \"run.xyz\", frames: All, steps: (2, 4))");
    for frame in [3, 1, 2, 2, 1] {
        assert_eq!(places(&scene, frame), [f64::from(frame + 1)]);
    }
    folder.write("cut.xyz", "1\n\nC 1 0 0\n2\n\nC 1 0 0\n");
    let message = folder
        .load("(file: \"cut.xyz\", frames: All)", "Free()", "")
        .unwrap_err();
    let expected = "cut.xyz:7:1: expected 2 atoms, according to the first line of the frame (1 read), \
         found the end of the file";
    assert!(message.starts_with(expected), "{message}");
}

#[test]
fn scales_of_colors_are_linear_logarithmic_or_diverging() {
    let folder = Folder::new("scales");
    folder.write("a.csv", "x,y,z,r,v\n0,0,0,1,1\n1,0,0,1,10\n2,0,0,1,100\n");
    let of = |fields: &str| {
        let cloud = format!("(file: \"a.csv\", value: \"v\", colormap: Grey{fields})");
        colors(&folder.scene(&cloud), 1)
    };
    let grey = |code: u32| from_srgb(0x01_01_01 * code);
    assert_eq!(of(""), [0, 23, 255].map(grey));
    assert_eq!(of(", color_scale: Log"), [0, 128, 255].map(grey));
    assert_eq!(
        of(", color_scale: Log, reversed: true"),
        [255, 127, 0].map(grey)
    );
    // From -80 to 100, as far below 10 as above.
    assert_eq!(
        of(", color_scale: Diverging(10)"),
        [115, 128, 255].map(grey)
    );
    assert_eq!(of(", range: (0, 20)"), [12, 128, 255].map(grey));
    assert_eq!(of(", range: Percentile(0, 50)"), [0, 255, 255].map(grey));
    let refused = |fields: &str| {
        folder.write("b.csv", "x,y,z,r,v\n0,0,0,1,-1\n1,0,0,1,\n");
        let cloud = format!("(file: \"b.csv\", value: \"v\"{fields})");
        let message = folder.load(&cloud, "Free()", "").unwrap_err();
        message.lines().next().unwrap().to_owned()
    };
    let message = refused(", color_scale: Log, missing: Hide");
    assert!(
        message.ends_with("expected numbers greater than 0 for `color_scale: Log`, found -1"),
        "{message}"
    );
    assert!(
        refused("").ends_with("b.csv:3:9: expected a number for `v`, found the end of the line")
    );
    let missing = |missing: &str| {
        colors(
            &folder.scene(&format!(
                "(file: \"b.csv\", value: \"v\", missing: {missing})"
            )),
            1,
        )
    };
    assert_eq!(missing("Hide").len(), 1);
    let grey = missing("\"#808080\"")[1];
    assert!((grey - from_srgb(0x808080)).abs().max_element() < 1e-7);
}

#[test]
fn categories_have_colors_of_their_own() {
    let folder = Folder::new("categories");
    folder.write(
        "a.csv",
        "x,y,z,r,kind,number\n0,0,0,1,b,10\n1,0,0,1,a,9\n2,0,0,1,b,10\n",
    );
    let scene = folder.scene("(file: \"a.csv\", value: \"kind\")");
    let found = colors(&scene, 1);
    assert!(found[0] == found[2] && found[0] != found[1]);
    let Some(description) = &scene.clouds()[0].colors else {
        panic!("colors")
    };
    let ColorMeaning::Categories(categories) = &description.meaning else {
        panic!("categories")
    };
    let names: Vec<&str> = categories.iter().map(|category| &*category.0).collect();
    assert_eq!(names, ["a", "b"]);
    assert_eq!([categories[1].1, categories[0].1], found[..2]);
    let own = folder.scene("(file: \"a.csv\", value: \"kind\", palette: {\"b\": (1, 0, 0)})");
    assert_eq!(colors(&own, 1)[0], DVec3::X);
    // Numbers in their order, not that of their digits.
    let numbers = folder.scene("(file: \"a.csv\", value: \"number\", color: Category)");
    let Some(description) = &numbers.clouds()[0].colors else {
        panic!("colors")
    };
    let ColorMeaning::Categories(categories) = &description.meaning else {
        panic!("categories")
    };
    let names: Vec<&str> = categories.iter().map(|category| &*category.0).collect();
    assert_eq!(names, ["9", "10"]);
}

#[test]
fn rows_are_kept_that_meet_all_conditions() {
    let folder = Folder::new("keep");
    let rows: Vec<String> = (0..100)
        .map(|id| format!("{id},0,0,1,{}\n", id % 3))
        .collect();
    folder.write("a.csv", &format!("x,y,z,r,type\n{}", rows.concat()));
    let scene = folder.scene(
        "(file: \"a.csv\", keep: [(\"type\", Is(2)), (\"x\", Between(10, 20)), (1, Every(2))])",
    );
    assert_eq!(places(&scene, 1), [14.0, 20.0]);
    assert_eq!(scene.clouds()[0].rows, 100);
    let message = folder
        .load("(file: \"a.csv\", keep: [(\"typ\", Is(2))])", "Free()", "")
        .unwrap_err();
    assert!(
        message.starts_with("a.csv:1:1: expected a column `typ`, found"),
        "{message}"
    );
    // A row without a number is not kept, and one with a text is a fault.
    folder.write("b.csv", "x,y,z,r,v\n0,0,0,1,7\n1,0,0,1,\n");
    let keep = "(file: \"b.csv\", keep: [(\"v\", Between(0, 9))])";
    assert_eq!(places(&folder.scene(keep), 1), [0.0]);
    folder.write("b.csv", "x,y,z,r,v\n0,0,0,1,7\n1,0,0,1,seven\n");
    let message = folder.load(keep, "Free()", "").unwrap_err();
    assert!(
        message.starts_with("b.csv:3:9: expected a number for `v`, found `seven`"),
        "{message}"
    );
}
