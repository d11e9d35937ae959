//! Pictures and command lines, given to the whole program.

use std::ffi::OsString;
use std::fs;
use std::io::sink;
use std::path::Path;

use super::Input;
use super::seeds::{self, Seed};
use crate::numbers::Numbers;

/// A scene that renders very quickly, as a still and as a sequence.
const SCENE: &str = "(
    image: (width: 24, height: 20),
    lens: Fov(40),
    camera: Orbit(target: (0, 0, 0), radius: 5),
    animation: Turntable(frames: 40),
    ambient: 0.1,
    lights: [Directional(toward: (-1, 1, -1), intensity: 0.9)],
    spheres: [(center: (0, 0, 0), radius: 1), (center: (1, 1, 0), radius: 0.5)],
)
";
const RENDER: &str = "render scene.ron --frames 1 --samples 2 --quiet --threads 1";

/// The options that lead to the different files, and the names of the files.
const FILES: [(&str, &str); 9] = [
    ("a.png", ""),
    ("b.png", "--bits 16 --alpha --region 0,0,24,10"),
    ("c.exr", "--error-channel"),
    ("d.exr", "--float --channels id,depth --region 0,10,24,10"),
    ("e.npy", ""),
    ("f.exr", "--per-light=layers"),
    ("g.tif", "--alpha"),
    ("h.tif", "--float --region 0,10,24,10"),
    ("i.npz", "--error-channel --channels id,depth"),
];

/// Runs `marbles`; returns the exit code.
///
/// # Panics
/// If the exit code is not a documented one.
fn marbles(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words = [OsString::from("marbles")].into_iter().chain(words);
    let code = marbles_cli::run_with(words, sink(), sink());
    assert!(code <= 3, "exit code {code}");
    code
}

/// Runs `marbles` with these words, the last of which is the name of a file in a folder.
fn marbles_in(folder: &Path, words: &str) -> u8 {
    let is_file = |word: &str| word.contains(".ron") || FILES.iter().any(|(name, _)| *name == word);
    let place = |word: &str| match is_file(word) {
        true => folder.join(word).into_os_string(),
        false => OsString::from(word),
    };
    marbles(words.split_whitespace().map(place))
}

/// Compares an altered picture with itself.
pub(super) fn compare(input: &Input<'_>) -> bool {
    let path = input.write().into_os_string();
    let words = ["compare", "--quiet", "--diff"].map(OsString::from);
    let mut numbers = Numbers(input.numbers);
    let ending = numbers.either(&["png", "exr"]);
    let difference = input.folder.join(format!("difference.{ending}"));
    let files = [difference.into_os_string(), path.clone(), path];
    marbles(words.into_iter().chain(files)) != 2
}

/// Files that `marbles` rendered.
pub(super) fn rendered(folder: &Path) -> Vec<Seed> {
    let files = folder.join("whole");
    fs::create_dir_all(&files).expect("a folder can be made");
    for folder in [folder, &files] {
        fs::write(folder.join("scene.ron"), SCENE).expect("a scene can be written");
    }
    for (name, options) in FILES {
        let code = marbles_in(&files, &format!("{RENDER} -o {name} {options}"));
        assert_eq!(code, 0, "{name}");
    }
    let mut seeds = seeds::in_folder(&files);
    seeds.retain(|seed| FILES.iter().any(|(name, _)| *name == seed.name));
    seeds
}

/// Resumes a sequence that contains an altered file, and merges such a file with another one. Returns whether the file
/// was accepted as complete.
pub(super) fn resume(input: &Input<'_>) -> bool {
    let path = input.write();
    let whole = input.folder.join("whole");
    let (name, options) = FILES
        .iter()
        .find(|(name, _)| *name == input.name)
        .expect("one of them");
    let code = marbles_in(
        input.folder,
        &format!("{RENDER} --skip-existing -o {name} {options}"),
    );
    assert_eq!(code, 0, "it is there, or it is rendered");
    let after = fs::read(&path).expect("there is a picture");
    let is_skipped = after == input.bytes;
    // Unless it was taken for complete, it is now.
    assert!(is_skipped || after == fs::read(whole.join(name)).expect("it was rendered"));

    input.write();
    let parts = [path, whole.join(name)].map(Into::into);
    let out = input.folder.join(format!("merged-{name}"));
    marbles(
        ["merge".into(), out.into_os_string()]
            .into_iter()
            .chain(parts),
    );
    is_skipped
}

/// Options of `marbles farm`, one word per line, for the parsers of frame lists, patterns, sizes and so on.
pub(super) fn command_lines(folder: &Path) -> Vec<Seed> {
    fs::write(folder.join("scene.ron"), SCENE).expect("a scene can be written");
    [
        "--frames\n1-40x2,7,3-5\n-o\nout/a.####.png\n--size\n640x480",
        "--frames\n9-1:-1\n-o\n{scene}/%04d.exr\n--region\n0,0,12,9\n--float",
        "--frames=1-9,20-11:-3\n--output=x{frame:04}.npy\n--error-channel\n--chunk\n3",
        "--tolerance\n1e-4\n--set\ncamera.azimuth=30\n--set\nspheres[1].radius=0.25\n-o\na.##.png",
        "--samples\n3\n--exposure\n-1.5\n--bits\n16\n--fps\n29.97\n--threads\n3\n-o\n%d.png",
        "--channels\ndepth,normal,id\n--depth\nray\n--axes\nopencv\n-o\n#.exr\n--alpha",
    ]
    .into_iter()
    .map(|words| Seed {
        name: "words".to_owned(),
        bytes: words.as_bytes().to_vec(),
    })
    .collect()
}

/// Writes a job with altered options; this renders nothing.
pub(super) fn plan(input: &Input<'_>) -> bool {
    let text = String::from_utf8_lossy(input.bytes);
    let engine = if input.numbers & 1 == 0 {
        "slurm"
    } else {
        "openjd"
    };
    let scene = input.folder.join("scene.ron").into_os_string();
    let start = ["farm".into(), engine.into(), scene];
    marbles(start.into_iter().chain(text.lines().map(OsString::from))) == 0
}
