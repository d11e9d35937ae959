//! Scenes of broken pixels, with as few spheres and lights as still break them.

use std::path::Path;

use super::Broken;
use super::draft::Draft;
use super::subject::Subject;

/// Leaves out what is not needed for a pixel to fall short.
fn reduced(draft: &Draft, broken: &Broken) -> Draft {
    let mut draft = draft.clone();
    let mut index = 0;
    while let Some(less) = draft.without(index) {
        let falls_short =
            Subject::of(&less).is_ok_and(|subject| subject.shortfall(broken).is_some());
        if falls_short {
            draft = less;
        } else {
            index += 1;
        }
    }
    draft
}

/// Writes the reduced scene of a broken pixel into a folder.
pub(super) fn write(
    folder: &Path,
    name: &str,
    draft: &Draft,
    broken: &Broken,
) -> Result<(), String> {
    let text = format!("// {broken}\n{}", reduced(draft, broken).text());
    let path = folder.join(name).with_extension("ron");
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&path, text))
        .map_err(|error| format!("{}: {error}", path.display()))
}
