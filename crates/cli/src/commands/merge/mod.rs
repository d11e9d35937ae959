//! `marbles merge`: joins parts of a picture that were rendered separately.
//!
//! The picture is written row by row, and the parts are read row by row, so that pictures may be larger than the
//! memory.

mod parts;

use self::parts::Parts;
use super::args::MergeArguments;
use super::inputs::Inputs;
use crate::base::failure::Failure;
use crate::base::numbers::counted;
use crate::base::shown::Shown;
use crate::base::status;
use crate::files::destination::prepare;
use crate::formats::encoding::Format;
use crate::terminal::console::Console;
use crate::terminal::interrupt;

pub(crate) fn run(arguments: &MergeArguments, console: &Console) -> Result<u8, Failure> {
    let path = &arguments.output;
    let format = Format::of_file(path).filter(|format| *format != Format::Npz);
    let format = format.ok_or_else(|| {
        Failure::unusable(
            path,
            "expected a file name that ends in .png, .exr, .npy or .tif",
        )
    })?;
    Inputs::parts(&arguments.parts).refuse([path.clone()])?;
    interrupt::listen(console);
    let mut parts = Parts::examine(&arguments.parts)?;
    let (kind, whole, digest) = (parts.kind.clone(), parts.whole, parts.digest);
    prepare(path)?;
    if kind.format() != format {
        let expected = "expected the file extension of the parts";
        return Err(Failure::unusable(path, expected));
    }
    kind.write(path, whole, &digest, |rows| parts.rows(rows))?;
    if !arguments.quiet {
        let pixels = whole.pixels();
        let parts = counted(arguments.parts.len() as u64, "part");
        let path = path.shown();
        console.result(&format!("{path}: {pixels} pixels from {parts}"));
    }
    Ok(status::SUCCESS)
}
