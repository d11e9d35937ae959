//! ICC profiles for linear codes: marbles writes them into TIFF files, and recognizes them in the files of other programs.
//!
//! Source: "Specification ICC.1:2001-04", version 2 of the format, which every reader supports.

/// The lengths in bytes of the header, of the number of tags, and of a tag's entry in the table.
const HEADER_BYTES: usize = 128;
const COUNT_BYTES: usize = 4;
const ENTRY_BYTES: usize = 12;

/// The white of the connection space, D50, and the primaries of Rec. 709 adapted to it with the Bradford method: X, Y and
/// Z, in multiples of 1/65536.
const WHITE: [i32; 3] = [63_190, 65_536, 54_061];
const RED: [i32; 3] = [28_576, 14_581, 912];
const GREEN: [i32; 3] = [25_239, 46_983, 6_361];
const BLUE: [i32; 3] = [9_375, 3_972, 46_787];

/// The name of the profile.
const NAME: &str = "linear Rec. 709";

/// The profile for linear codes, with three colors or gray.
pub(super) fn linear(is_grey: bool) -> Vec<u8> {
    let (space, name): (&[u8; 4], _) = if is_grey {
        (b"GRAY", "linear gray")
    } else {
        (b"RGB ", NAME)
    };
    let mut tags = vec![
        (*b"desc", description(name)),
        (*b"cprt", text("no copyright, use freely")),
        (*b"wtpt", xyz(WHITE)),
    ];
    if is_grey {
        tags.push((*b"kTRC", identity()));
    } else {
        tags.extend([(*b"rXYZ", xyz(RED)), (*b"gXYZ", xyz(GREEN))]);
        tags.push((*b"bXYZ", xyz(BLUE)));
        tags.extend([*b"rTRC", *b"gTRC", *b"bTRC"].map(|tag| (tag, identity())));
    }
    let mut table = (tags.len() as u32).to_be_bytes().to_vec();
    let mut data = Vec::new();
    let start = HEADER_BYTES + COUNT_BYTES + ENTRY_BYTES * tags.len();
    for (tag, bytes) in tags {
        table.extend(tag);
        table.extend(((start + data.len()) as u32).to_be_bytes());
        table.extend((bytes.len() as u32).to_be_bytes());
        data.extend(bytes);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    let mut profile = header((start + data.len()) as u32, *space);
    profile.extend(table);
    profile.extend(data);
    profile
}

/// The header of a profile with this length in bytes, for codes in this color space.
fn header(bytes: u32, space: [u8; 4]) -> Vec<u8> {
    let mut header = bytes.to_be_bytes().to_vec();
    header.extend([0; 4]); // no preferred engine
    header.extend([2, 0x40, 0, 0]); // version 2.4
    header.extend(b"mntr");
    header.extend(space);
    header.extend(b"XYZ ");
    for number in [2026_u16, 1, 1, 0, 0, 0] {
        header.extend(number.to_be_bytes()); // the same date in all files
    }
    header.extend(b"acsp");
    // Platform, flags, manufacturer, model and attributes are empty; the intent 0 is perceptual.
    header.extend([0; 28]);
    header.extend(WHITE.iter().flat_map(|number| number.to_be_bytes()));
    header.resize(HEADER_BYTES, 0);
    header
}

/// A name in the form of version 2: ASCII, with empty fields for Unicode and Macintosh scripts.
fn description(name: &str) -> Vec<u8> {
    let mut bytes = b"desc\0\0\0\0".to_vec();
    bytes.extend((name.len() as u32 + 1).to_be_bytes());
    bytes.extend(name.as_bytes());
    bytes.push(0);
    bytes.extend([0; 4 + 4 + 2 + 1 + 67]);
    bytes
}

fn text(text: &str) -> Vec<u8> {
    let mut bytes = b"text\0\0\0\0".to_vec();
    bytes.extend(text.as_bytes());
    bytes.push(0);
    bytes
}

fn xyz(numbers: [i32; 3]) -> Vec<u8> {
    let mut bytes = b"XYZ \0\0\0\0".to_vec();
    bytes.extend(numbers.iter().flat_map(|number| number.to_be_bytes()));
    bytes
}

/// The identity curve.
fn identity() -> Vec<u8> {
    let mut bytes = b"curv\0\0\0\0".to_vec();
    bytes.extend(0_u32.to_be_bytes());
    bytes
}

/// Returns whether the codes of a picture with this profile are linear.
pub(super) fn is_linear(profile: &[u8]) -> bool {
    let curves: &[[u8; 4]] = match profile.get(16..20) {
        Some(b"GRAY") => &[*b"kTRC"],
        Some(b"RGB ") => &[*b"rTRC", *b"gTRC", *b"bTRC"],
        _ => return false,
    };
    curves
        .iter()
        .all(|&tag| find(profile, tag).is_some_and(is_identity))
}

/// The data of a tag.
fn find(profile: &[u8], tag: [u8; 4]) -> Option<&[u8]> {
    let table = profile.get(HEADER_BYTES + COUNT_BYTES..)?;
    let (entries, _) = table.as_chunks::<ENTRY_BYTES>();
    let entry = entries.iter().find(|entry| entry[..4] == tag)?;
    let number = |first: usize| {
        let bytes = entry[first..first + 4].try_into().ok()?;
        usize::try_from(u32::from_be_bytes(bytes)).ok()
    };
    let (start, length) = (number(4)?, number(8)?);
    profile.get(start..start.checked_add(length)?)
}

/// Returns whether a curve is the identity: without a table, with a power of 1, or a table of only 0 and 1.
fn is_identity(curve: &[u8]) -> bool {
    const POWER_OF_1: [u8; 2] = [1, 0];
    match (curve.get(..4), curve.get(8..12), curve.get(12..)) {
        (Some(b"curv"), Some([0, 0, 0, 0]), _) => true,
        (Some(b"curv"), Some([0, 0, 0, 1]), Some(power)) => power.starts_with(&POWER_OF_1),
        (Some(b"curv"), Some([0, 0, 0, 2]), Some(table)) => table.starts_with(&[0, 0, 0xff, 0xff]),
        // A power, in the first kind of formula: f(x) = x^g.
        (Some(b"para"), Some([0, 0, _, _]), Some(power)) => power.starts_with(&[0, 1, 0, 0]),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_profiles_are_recognized() {
        for is_grey in [false, true] {
            let profile = linear(is_grey);
            let length = u32::from_be_bytes(profile[..4].try_into().unwrap());
            assert_eq!(length as usize, profile.len());
            assert!(is_linear(&profile));
            for length in 0..profile.len() {
                // The last bytes belong to the data of a tag that is read.
                assert!(!is_linear(&profile[..length]), "{length}");
            }
        }
        let mut bent = linear(true);
        let curve = bent.windows(4).rposition(|bytes| bytes == b"curv").unwrap();
        bent[curve + 11] = 1;
        assert!(!is_linear(&bent));
    }

    #[test]
    fn the_primaries_add_up_to_white() {
        for axis in 0..3 {
            let sum: i32 = [RED, GREEN, BLUE].iter().map(|color| color[axis]).sum();
            assert!((sum - WHITE[axis]).abs() <= 1, "{axis}");
        }
    }
}
