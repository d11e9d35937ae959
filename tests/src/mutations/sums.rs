//! The checksums of altered files, because readers stop at a wrong one.

/// The bytes with which a PNG begins.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The bytes with which a member of an archive begins, and its entry in the directory.
const MEMBER: &[u8] = b"PK\x03\x04";
const ENTRY: &[u8] = b"PK\x01\x02";

/// Corrects the checksums of a PNG or an archive.
pub(super) fn mend_sums(bytes: &mut [u8]) {
    if bytes.starts_with(PNG) {
        mend_chunks(bytes);
    } else if bytes.starts_with(MEMBER) {
        mend_members(bytes);
    }
}

/// Corrects the checksums of the chunks of a PNG.
fn mend_chunks(bytes: &mut [u8]) {
    let mut rest = &mut bytes[PNG.len()..];
    // A chunk has the length of its data, its name, its data and its sum.
    while let Some((length, named)) = rest.split_first_chunk_mut::<4>() {
        let length = 4 + u32::from_be_bytes(*length) as usize;
        let Some((data, sum)) = named.split_at_mut_checked(length) else {
            return;
        };
        let Some((sum, after)) = sum.split_first_chunk_mut::<4>() else {
            return;
        };
        *sum = crc32fast::hash(data).to_be_bytes();
        rest = after;
    }
}

/// Corrects the checksums of uncompressed members of an archive, in the members and in the directory.
///
/// # Source
/// PKWARE, "APPNOTE.TXT", 4.3.
fn mend_members(bytes: &mut [u8]) {
    let starts = |bytes: &[u8], mark: &[u8]| -> Vec<usize> {
        let all = bytes.windows(mark.len()).enumerate();
        all.filter(|(_, part)| *part == mark)
            .map(|(at, _)| at)
            .collect()
    };
    for start in starts(bytes, ENTRY) {
        // The method, the size, and the place of the member.
        let stored = short(bytes, start + 10) == Some(0);
        let [size, member] = [20, 42].map(|field| word(bytes, start + field));
        let (true, Some(size), Some(member)) = (stored, size, member) else {
            continue;
        };
        let Some(lengths) = short(bytes, member + 26).zip(short(bytes, member + 28)) else {
            continue;
        };
        let data = member + 30 + lengths.0 + lengths.1;
        let Some(data) = bytes.get(data..data + size) else {
            continue;
        };
        let sum = crc32fast::hash(data).to_le_bytes();
        for place in [start + 16, member + 14] {
            if let Some(old) = bytes.get_mut(place..place + 4) {
                old.copy_from_slice(&sum);
            }
        }
    }
}

fn short(bytes: &[u8], at: usize) -> Option<usize> {
    let number = bytes.get(at..)?.first_chunk()?;
    Some(usize::from(u16::from_le_bytes(*number)))
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let number = bytes.get(at..)?.first_chunk()?;
    usize::try_from(u32::from_le_bytes(*number)).ok()
}

#[cfg(test)]
mod tests {
    use super::super::seeds;
    use super::*;

    /// Whatever byte of a member's data is another one, its sums fit again.
    #[test]
    fn archives_have_the_sums_of_their_members() {
        let whole = seeds::tables()
            .into_iter()
            .find(|seed| seed.name == "arrays.npz")
            .expect("a seed")
            .bytes;
        let mut same = whole.clone();
        mend_sums(&mut same);
        assert!(same == whole);
        let at = whole.windows(6).position(|part| part == b"\x93NUMPY");
        let at = at.expect("an array") + 140;
        let mut altered = whole.clone();
        altered[at] ^= 1;
        let sums = |bytes: &[u8]| bytes[14..18].to_vec();
        mend_sums(&mut altered);
        assert!(sums(&altered) != sums(&whole));
        altered[at] ^= 1;
        mend_sums(&mut altered);
        assert!(altered == whole);
    }
}
