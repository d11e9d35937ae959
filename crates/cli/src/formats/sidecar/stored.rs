//! The parts of an existing sidecar that identify its picture.

use std::fs;
use std::path::Path;

use blake3::Hash;
use marbles_core::Window;
use serde_json::Value;

use crate::base::region::Region;
use crate::base::size::Size;

/// The digest of the picture of the sidecar at `path`, and the part that it shows; `None` if the file is not complete.
pub(crate) fn contents(path: &Path) -> Option<(Hash, Region)> {
    let value: Value = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
    let number = |of: &Value, name: &str| u32::try_from(of.get(name)?.as_u64()?).ok();
    let size = |of: &Value| {
        let (width, height) = (number(of, "width")?, number(of, "height")?);
        Some(Size { width, height })
    };
    let digest = Hash::from_hex(value.get("digest")?.as_str()?).ok()?;
    let whole = size(value.get("image")?)?;
    let Some(part) = value.get("region") else {
        return Some((digest, Region::all(whole)));
    };
    let Size { width, height } = size(part)?;
    let window = Window {
        col: number(part, "col")?,
        row: number(part, "row")?,
        width,
        height,
    };
    Some((digest, Region::new(window, whole)?))
}
