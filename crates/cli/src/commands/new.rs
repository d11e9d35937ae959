//! `marbles new`: a scene to start from.

use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::Path;

use super::args::NewArguments;
use crate::base::failure::Failure;
use crate::base::status;
use crate::terminal::console::Console;

const STILL: &str = include_str!("new/still.ron");
const TURNTABLE: &str = include_str!("new/turntable.ron");
/// The word that stands for the file in the comments of the scenes.
const NAME: &str = "NAME";

pub(crate) fn run(arguments: &NewArguments, console: &Console) -> Result<u8, Failure> {
    let path = &arguments.scene;
    let ending = path.extension();
    if ending.is_none_or(|ending| !ending.eq_ignore_ascii_case("ron")) {
        return Err(Failure::Usage(format!(
            "expected a file name that ends in .ron, found `{}`",
            path.display()
        )));
    }
    let text = if arguments.turntable {
        TURNTABLE
    } else {
        STILL
    };
    write(path, &text.replace(NAME, &shown(path)))?;
    console.result(&path.display().to_string());
    if console.is_interactive() {
        let shown = shown(path);
        console.note(&format!("see it: marbles preview {shown} --watch"));
    }
    Ok(status::SUCCESS)
}

/// The file's name in a comment or a message, which are one line, in quotes where a shell needs them.
fn shown(path: &Path) -> String {
    let name = path.display().to_string();
    let is_plain = |letter: char| letter.is_alphanumeric() || "._-/\\:~+@%".contains(letter);
    if name.chars().all(is_plain) {
        name
    } else if name.contains(|letter: char| letter.is_control() || letter == '\'') {
        NAME.to_owned()
    } else {
        format!("'{name}'")
    }
}

/// Writes a file that must not be there yet.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)
            .map_err(|error| Failure::io(folder, "cannot create the folder", &error))?;
    }
    // Which asks and creates at once: nobody else's file is ever lost.
    let mut file = File::create_new(path).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::at(path, "the file is already there"),
        _ => Failure::io(path, "cannot create the file", &error),
    })?;
    file.write_all(text.as_bytes()).map_err(|error| {
        // What could not be written is no scene; there is nothing to tell beside the error.
        let _ = fs::remove_file(path);
        Failure::io(path, "cannot write the file", &error)
    })
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::tests::run_here;

    fn folder(name: &str) -> PathBuf {
        let process = std::process::id();
        std::env::temp_dir().join(format!("marbles-{process}-new-{name}"))
    }

    #[test]
    fn new_scenes_are_valid_and_rendered() {
        let folder = folder("valid");
        for (name, option) in [("still", None), ("turn", Some("--turntable"))] {
            let scene = folder.join(format!("{name}.ron"));
            let scene = scene.to_str().unwrap();
            let made = run_here(&[&["new", scene], option.as_slice()].concat());
            assert_eq!(made, (0, format!("{scene}\n"), String::new()));
            let text = fs::read_to_string(scene).unwrap();
            assert!(text.contains(&format!("marbles preview {scene} --watch ")));
            assert!(!text.contains(NAME));
            let (code, out, err) = run_here(&["check", scene]);
            assert_eq!((code, &*err), (0, ""));
            assert_eq!(
                out.contains("frames      a still"),
                option.is_none(),
                "{out}"
            );
            let picture = folder.join(format!("{name}.png"));
            let picture = picture.to_str().unwrap();
            let (code, out, err) = run_here(&["render", scene, "--frames", "1", "-o", picture]);
            assert_eq!((code, &*err), (0, ""));
            assert!(out.contains(" 0 over the tolerance"), "{out}");
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn files_that_are_there_stay() {
        let folder = folder("there");
        fs::create_dir_all(&folder).unwrap();
        let scene = folder.join("mine.ron");
        fs::write(&scene, "mine").unwrap();
        let (code, out, err) = run_here(&["new", scene.to_str().unwrap()]);
        assert_eq!((code, &*out), (1, ""));
        assert!(
            err.ends_with("mine.ron: the file is already there\n"),
            "{err}"
        );
        assert_eq!(fs::read(&scene).unwrap(), b"mine");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn other_endings_are_refused() {
        for name in ["ball", "ball.png", "ron", ".ron", "ball.ron.txt"] {
            let (code, out, err) = run_here(&["new", &format!("missing/{name}")]);
            assert_eq!((code, &*out), (2, ""), "{err}");
        }
        assert!(!Path::new("missing").exists());
    }

    #[test]
    fn names_in_comments_can_be_pasted() {
        assert_eq!(shown(Path::new("out/ball.ron")), "out/ball.ron");
        assert_eq!(shown(Path::new("my ball.ron")), "'my ball.ron'");
        assert_eq!(shown(Path::new("a\nb.ron")), NAME);
    }
}
