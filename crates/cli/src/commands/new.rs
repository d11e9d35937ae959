//! `marbles new`: writes a first scene, or the scene of a table.

use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Component, Path, PathBuf};

use marbles_scene::{Scene, harmless};

use super::args::NewArguments;
use crate::base::failure::Failure;
use crate::base::scene_name::scene_name;
use crate::base::shown::Shown;
use crate::base::status;
use crate::terminal::console::Console;

const STILL: &str = include_str!("new/still.ron");
const TURNTABLE: &str = include_str!("new/turntable.ron");
/// The word in the comments of the scenes that is replaced by the name of the file.
const NAME: &str = "NAME";
/// The frames of the turntable, which another number may replace.
const FRAMES: &str = "frames: 120,";
pub(crate) fn run(arguments: &NewArguments, console: &Console) -> Result<u8, Failure> {
    let path = match (&arguments.output, is_scene(&arguments.file)) {
        (None, true) => {
            first_scene(arguments)?;
            arguments.file.clone()
        }
        (output, _) => {
            let table = &arguments.file;
            let default = || {
                let mut name = scene_name(table).to_owned();
                name.push(".ron");
                PathBuf::from(name)
            };
            let path = output.clone().unwrap_or_else(default);
            scene_of_table(arguments, table, &path, console)?;
            path
        }
    };
    console.result(&path.shown());
    if console.is_interactive() {
        let shown = shown(&path);
        console.note(&format!("see it: marbles preview {shown} --watch"));
    }
    Ok(status::SUCCESS)
}

/// Says whether a path has the extension of scenes.
fn is_scene(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("ron"))
}

/// Writes a scene of a few balls.
fn first_scene(arguments: &NewArguments) -> Result<(), Failure> {
    let path = &arguments.file;
    for (is_given, option) in [
        (arguments.figure.view.is_some(), "--view"),
        (arguments.white, "--white"),
        (arguments.transparent, "--transparent"),
    ] {
        if is_given {
            return Err(Failure::Usage(format!(
                "{option} is for the scene of a table, but `{}` is the scene to write",
                path.shown()
            )));
        }
    }
    let text = match arguments.figure.turntable {
        Some(frames) => TURNTABLE.replace(FRAMES, &format!("frames: {frames},")),
        None => STILL.to_owned(),
    };
    write(path, &text.replace(NAME, &shown(path)))
}

/// Writes the scene that shows a table, if it is a scene that can be rendered.
fn scene_of_table(
    arguments: &NewArguments,
    table: &Path,
    path: &Path,
    console: &Console,
) -> Result<(), Failure> {
    if !is_scene(path) {
        return Err(Failure::Usage(format!(
            "expected a file name that ends in .ron, found `{}`",
            path.shown()
        )));
    }
    let of_scene = |error| Failure::Scene(Box::new(error));
    if !Scene::is_table(table).map_err(of_scene)? {
        let why =
            "expected a table of particles, or a file name that ends in .ron, found another file";
        return Err(Failure::unusable(table, why));
    }
    if path.exists() {
        return Err(Failure::at(path, "the file already exists"));
    }
    let name = name_from(path, table)?;
    let figure = arguments.figure.figure(None);
    let scene = Scene::load_figure(table, &figure, &[], &|_| {}).map_err(of_scene)?;
    let text = figure.scene_text(table, &name);
    let warnings = scene.warnings().iter();
    warnings.for_each(|warning| console.warn(warning));
    let option = match arguments.transparent {
        true => " --transparent",
        false => "",
    };
    write(
        path,
        &(head(&harmless(&name), &shown(path), option) + &text),
    )
}

/// The first lines of the scene of a table, with the commands that show it.
fn head(table: &str, scene: &str, option: &str) -> String {
    let commands = [
        (
            format!("marbles preview {scene} --watch"),
            "shows it in the terminal, again whenever it is saved",
        ),
        (
            format!("marbles render {scene}{option}"),
            "writes it to a PNG file",
        ),
        (
            format!("marbles check {scene}"),
            "lists the columns of the table",
        ),
    ];
    let widths = commands.iter().map(|(command, _)| command.chars().count());
    let width = widths.max().unwrap_or(0);
    let lines = commands
        .iter()
        .map(|(command, what)| format!("//     {command:width$}    {what}\n"));
    format!(
        "// A figure of {table}. Angles are in degrees; x is right, y up, z forward.\n//\n{}",
        lines.collect::<String>()
    )
}

/// The name by which a scene at `path` calls a table.
fn name_from(path: &Path, table: &Path) -> Result<String, Failure> {
    let folder = |path: &Path| {
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        folder.unwrap_or(Path::new(".")).to_owned()
    };
    let (from, to) = (folder(path), folder(table));
    let is_below = |part: Component<'_>| matches!(part, Component::Normal(_));
    let depth = from
        .components()
        .filter(|part| *part != Component::CurDir)
        .map(|part| is_below(part).then_some(".."))
        .collect::<Option<PathBuf>>();
    let name = match depth {
        _ if from == to => PathBuf::from(table.file_name().unwrap_or_default()),
        Some(depth) if table.is_relative() => depth.join(table),
        _ => fs::canonicalize(table)
            .map_err(|error| Failure::io(table, "cannot find the file", &error))?,
    };
    let name = name.to_str().map(str::to_owned);
    name.ok_or_else(|| {
        let why = "expected a file name in UTF-8, as a scene names a table";
        Failure::unusable(table, why)
    })
}

/// The name of the file in a comment or a message of one line, quoted if a shell needs it.
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

/// Writes a file that must not exist yet.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)
            .map_err(|error| Failure::io(folder, "cannot create the folder", &error))?;
    }
    // Which asks and creates at once: nobody else's file is ever lost.
    let mut file = File::create_new(path).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::at(path, "the file already exists"),
        _ => Failure::io(path, "cannot create the file", &error),
    })?;
    file.write_all(text.as_bytes()).map_err(|error| {
        // What could not be written is no scene; there is nothing to tell beside the error.
        let _ = fs::remove_file(path);
        Failure::io(path, "cannot write the file", &error)
    })
}

#[cfg(test)]
mod tests;
