//! Reduces scenes of broken pixels to as few spheres and lights as still break them.

use std::path::Path;

use super::Broken;
use super::draft::Draft;
use super::subject::Subject;
use super::ulp;

/// The fault of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    /// It is over its tolerance without a report, or claims too little.
    Short,
    /// It changes too much if a sphere, chosen by the seed, grows.
    Moved(u64),
    /// It is reported as over its tolerance.
    GivenUp,
}

impl Fault {
    /// The suffix of file names.
    fn ending(self) -> &'static str {
        match self {
            Self::Short => "",
            Self::Moved(_) => "-ulp",
            Self::GivenUp => "-given-up",
        }
    }
}

/// Removes everything that the pixel does not need for its fault. Returns the scene, and the sphere that grows.
fn reduced(draft: &Draft, broken: &Broken, fault: Fault) -> (Draft, Option<usize>) {
    let mut draft = draft.clone();
    let mut grown = match fault {
        Fault::Moved(seed) => ulp::grown(&draft, seed).map(|(index, _)| index),
        Fault::Short | Fault::GivenUp => None,
    };
    let falls_short = |draft: &Draft, grown: Option<usize>| match grown {
        Some(grown) => ulp::still_moves(draft, grown, broken),
        None => Subject::of(draft).is_ok_and(|subject| match fault {
            Fault::GivenUp => subject.gives_up(broken),
            _ => subject.shortfall(broken).is_some(),
        }),
    };
    if let Some(less) = draft.without_doubles()
        && falls_short(&less, grown)
    {
        draft = less;
    }
    let mut index = 0;
    while let Some(less) = draft.without(index) {
        let is_grown = grown == Some(index);
        // The others move up.
        let moved_up = grown.map(|grown| grown - usize::from(index < grown));
        if !is_grown && falls_short(&less, moved_up) {
            (draft, grown) = (less, moved_up);
        } else {
            index += 1;
        }
    }
    (draft, grown)
}

/// Writes the reduced scene of a pixel with a fault to a folder.
pub(super) fn write(
    folder: &Path,
    name: &str,
    draft: &Draft,
    broken: &Broken,
    fault: Fault,
) -> Result<(), String> {
    let (reduced, grown) = reduced(draft, broken, fault);
    let mut head = format!("// {broken}");
    if let Some(grown) = grown {
        head += &format!("; when spheres[{grown}] grows by an ulp");
    }
    for (name, is_set) in [("alpha", draft.alpha), ("per light", draft.per_light)] {
        head += if is_set { "; " } else { "" };
        head += if is_set { name } else { "" };
    }
    if draft.light != 1.0 {
        head += &format!("; all in units of {:e} of light", draft.light);
    }
    let text = format!("{head}\n{}", reduced.text());
    let path = folder.join(format!("{name}{}.ron", fault.ending()));
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&path, text))
        .map_err(|error| format!("{}: {error}", path.display()))
}
