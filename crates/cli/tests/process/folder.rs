//! A folder in which `marbles` runs, and its contents afterwards.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// A ball in front of the camera.
pub(crate) const BALL: &str = "(
    image: (width: 600, height: 600),
    lens: Retina(width: 600, distance: 100),
    camera: Free(),
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 400), radius: 300)],
)
";

/// The animation of `roll.ron`, in which nothing moves.
const ROLL: &str = "animation: Keyframes(frames: (-9, 20100), keys: [(frame: 1)])";

/// A folder with `ball.ron` and `roll.ron`, the same scene as a sequence. It is removed when the test ends.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("process-{}-{count}", std::process::id());
        let folder = Self(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
        fs::create_dir_all(&folder.0).unwrap();
        folder.write_scene(BALL);
        folder
    }

    /// Writes a still scene as `ball.ron`, and a sequence of the same pictures as `roll.ron`.
    pub(crate) fn write_scene(&self, still: &str) {
        fs::write(self.path("ball.ron"), still).unwrap();
        let roll = still.replacen("lights:", &format!("{ROLL},\n    lights:"), 1);
        fs::write(self.path("roll.ron"), roll).unwrap();
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// `marbles` with these arguments, separated by spaces, in this folder.
    pub(crate) fn marbles(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_marbles"));
        command.args(arguments.split_whitespace());
        command.current_dir(&self.0);
        command.stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, arguments: &str) -> Output {
        self.marbles(arguments).output().unwrap()
    }

    /// The names in the folder `name` except for `roll.ron`, sorted.
    pub(crate) fn names(&self, name: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.path(name)) else {
            return Vec::new();
        };
        let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
        let mut names: Vec<String> = entries.map(|entry| name(entry.unwrap())).collect();
        names.retain(|name| name != "roll.ron");
        names.sort();
        names
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

pub(crate) fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal ended the process")
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

pub(crate) fn is_picture(name: &str) -> bool {
    Path::new(name).extension() == Some(OsStr::new("png"))
}

pub(crate) fn assert_complete(path: &Path) {
    let file = BufReader::new(File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    reader.finish().unwrap();
}
