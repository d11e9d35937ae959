//! Scenes in RON say the same in JSON. A translator of its own makes JSON of them.

use std::fs;
use std::path::{Path, PathBuf};

use marbles_scene::Scene;

/// Makes JSON of RON: structures and maps become objects, tuples and lists arrays, variants objects or strings.
struct Translator<'t> {
    ron: &'t [u8],
    at: usize,
    json: String,
}

fn in_json(ron: &str) -> String {
    let mut translator = Translator {
        ron: ron.as_bytes(),
        at: 0,
        json: String::new(),
    };
    translator.value();
    translator.json
}

impl Translator<'_> {
    /// The next byte behind white space and comments of one line; 0 at the end.
    fn next(&mut self) -> u8 {
        loop {
            match self.ron[self.at..] {
                [b'/', b'/', ..] => {
                    while !matches!(self.ron.get(self.at), None | Some(b'\n')) {
                        self.at += 1;
                    }
                }
                [byte, ..] if byte.is_ascii_whitespace() => self.at += 1,
                [byte, ..] => return byte,
                [] => return 0,
            }
        }
    }

    /// A name or a number.
    fn word(&mut self) -> String {
        let is_part = |byte: &&u8| byte.is_ascii_alphanumeric() || b"_+-.".contains(byte);
        let length = self.ron[self.at..].iter().take_while(is_part).count();
        let word = &self.ron[self.at..self.at + length];
        self.at += length;
        String::from_utf8(word.to_vec()).unwrap()
    }

    fn string(&mut self) {
        let start = self.at;
        self.at += 1;
        while self.ron[self.at] != b'"' {
            self.at += 1 + usize::from(self.ron[self.at] == b'\\');
        }
        self.at += 1;
        let string = &self.ron[start..self.at];
        self.json += str::from_utf8(string).unwrap();
    }

    fn value(&mut self) {
        match self.next() {
            b'"' => self.string(),
            b'(' => self.fields_or_tuple(),
            b'[' => self.inside(b"[]", Self::value),
            b'{' => self.inside(b"{}", |this| {
                this.string();
                this.colon();
                this.value();
            }),
            _ => {
                let word = self.word();
                let is_variant = word.starts_with(|c: char| c.is_ascii_uppercase());
                match (is_variant, self.next()) {
                    (true, b'(') => {
                        self.json += &format!("{{\"{word}\": ");
                        self.payload();
                        self.json.push('}');
                    }
                    (true, _) => self.json += &format!("\"{word}\""),
                    (false, _) => self.json += &word,
                }
            }
        }
    }

    /// The values of a variant: a single one stands alone.
    fn payload(&mut self) {
        let start = self.json.len();
        self.fields_or_tuple();
        let payload = &self.json[start..];
        if payload.starts_with('[') && !payload.contains(',') {
            let single = payload[1..payload.len() - 1].to_owned();
            self.json.truncate(start);
            self.json += &single;
        }
    }

    fn fields_or_tuple(&mut self) {
        let open = self.at;
        self.at += 1;
        self.next();
        let is_empty = self.ron[self.at] == b')';
        let is_name = self.word().starts_with(|c: char| c.is_ascii_lowercase());
        let is_structure = is_empty || is_name && self.next() == b':';
        self.at = open;
        if is_structure {
            self.inside(b"{}", |this| {
                let name = this.word();
                this.json += &format!("\"{name}\"");
                this.colon();
                this.value();
            });
        } else {
            self.inside(b"[]", Self::value);
        }
    }

    /// What is between brackets, which become these.
    fn inside(&mut self, brackets: &[u8; 2], element: fn(&mut Self)) {
        self.at += 1;
        self.json.push(char::from(brackets[0]));
        let mut is_first = true;
        while !b")]}".contains(&self.next()) {
            if !is_first {
                self.json += ", ";
            }
            is_first = false;
            element(self);
            if self.next() == b',' {
                self.at += 1;
            }
        }
        self.at += 1;
        self.json.push(char::from(brackets[1]));
    }

    fn colon(&mut self) {
        assert_eq!(self.next(), b':', "{}", self.json);
        self.at += 1;
        self.json += ": ";
    }
}

/// All that a scene is, or why it is refused.
fn meaning(text: &str, path: &Path) -> Result<String, Vec<String>> {
    match Scene::parse(text, path) {
        Ok(scene) => {
            let first = scene.frames().map_or(1, |frames| *frames.start());
            let views = [first, first + 3].map(|frame| scene.view(frame));
            let world = scene.world_at(first).unwrap();
            Ok(format!("{world:?} {views:?} {:?}", scene.description()))
        }
        Err(error) => Err(error.faults().iter().map(|it| it.message.clone()).collect()),
    }
}

/// The scenes of the repository, and those in its pages.
fn scenes() -> Vec<(PathBuf, String)> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut scenes = Vec::new();
    for folder in ["scenes", "scenes/original"] {
        for entry in fs::read_dir(repository.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "ron") {
                scenes.push((path.clone(), fs::read_to_string(&path).unwrap()));
            }
        }
    }
    for page in [
        "README.md",
        "docs/scenes.md",
        "docs/particles.md",
        "docs/errors.md",
    ] {
        let text = fs::read_to_string(repository.join(page)).unwrap();
        for block in text.split("```ron\n").skip(1) {
            let block = block.split("```").next().unwrap();
            if block.trim_start().starts_with('(') {
                scenes.push((repository.join("scenes/page.ron"), block.to_owned()));
            }
        }
    }
    scenes
}

#[test]
fn scenes_say_the_same_in_json() {
    let scenes = scenes();
    assert!(scenes.len() > 20);
    for (path, ron) in scenes {
        let json = in_json(&ron);
        assert!(json.starts_with('{'));
        assert_eq!(
            meaning(&json, &path),
            meaning(&ron, &path),
            "{path:?} {json}"
        );
    }
}

/// Fields that no scene has. The table is not there: what is wrong in the fields is told before.
#[test]
fn variants_of_all_fields_are_known() {
    let cloud = |fields: &str| format!("clouds: [(file: \"no.csv\", {fields})]");
    for fields in [
        cloud("frames: All, end: Loop, every: 2, steps: (1, 3), speed: 2"),
        cloud("frames: First, end: Hide, missing: Hide, up: X, skip_lines: 1, repeat: (1, 2, 3)"),
        cloud("radii: Covalent, color: Element, others: (radius: 1, color: \"red\")"),
        cloud("radii: { \"Fe\": 1.5 }, color: Category, value: 3, palette: { \"X\": (1, 0, 0) }"),
        cloud("color: Value, value: Length(\"vx\", \"vy\", \"vz\"), colormap: CoolWarm, color_scale: Diverging(2)"),
        cloud("color: Value, value: \"Z\", colormap: Grey, color_scale: Log, range: Percentile(1, 99)"),
        cloud("color: Value, value: \"X\", range: (0, 1), missing: \"red\", reversed: true, color_scale: Linear"),
        cloud("columns: (x: \"X\", y: 2, z: Constant(0), radius: Power(column: \"R\", factor: 2, exponent: 0.5, offset: 1))"),
        cloud("columns: (radius: \"R\", radius_law: Exponential(2)), keep: [(\"Q\", Is(\"C\")), (\"q\", Between(0, 1)), (1, Every(2))]"),
        cloud("columns: (radius: \"R\", radius_law: Linear), color: Table, wrap: true, rotate_degrees: (1, 2, 3)"),
        "animation: Turntable(what: Lights, axis: (0, 0, 1))".to_owned(),
        "animation: Turntable(up: Z, swing: 30, shutter: 0.5)".to_owned(),
        "animation: Keyframes(keys: [(frame: 1, azimuth: 2, ease: Hold), (frame: 5, ease: Smooth)])".to_owned(),
        "lights: [Point(position: (1, 2, 3), falloff: None, direction: (0, 0, 1), mu: 2, attached: Camera)]".to_owned(),
        "materials: { \"Z\": (outline: (width: Units(0.1), color: \"white\"), rough: (amplitude: 0.1, grain: Pixel, seed: 1)) }".to_owned(),
    ] {
        let ron = format!("(image: (width: 9, height: 9), lens: Fov(40), camera: Orbit(target: (0, 0, 0), radius: 9), {fields})");
        let json = in_json(&ron);
        let path = Path::new("nowhere/scene");
        let expected = meaning(&ron, path);
        // What is refused is the missing table alone.
        if let Err(faults) = &expected {
            assert_eq!(
                faults[..],
                ["expected a table, found no file \"no.csv\""],
                "{ron}"
            );
        }
        assert_eq!(meaning(&json, path), expected, "{json}");
    }
    for camera in [
        "Frame(fill: 0.5, frame_over: Step)",
        "Pose(rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation: (0, 0, 1), axes: OpenCV)",
    ] {
        let sphere = "spheres: [(center: (0, 0, 5), radius: 1)]";
        let ron =
            format!("(image: (width: 9, height: 9), lens: Fov(40), camera: {camera}, {sphere})");
        let path = Path::new("scene");
        let expected = meaning(&ron, path);
        assert!(expected.is_ok(), "{expected:?}");
        assert_eq!(meaning(&in_json(&ron), path), expected);
    }
}
