//! NPZ files, like those of NumPy's `savez`: a ZIP archive whose uncompressed members contain one array each.
//!
//! # Source
//! *APPNOTE.TXT*, PKWARE: each member follows its own header; at the end come all headers once more, and the offset of
//! this list. All sizes have eight bytes (ZIP64), as in NumPy's files.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};

use super::array::{Array, Number};
use super::header;
use crate::base::size::Size;

/// The version of ZIP with sizes of eight bytes, 4.5.
const VERSION: u16 = 45;
/// A placeholder for a size of four bytes; the real size has eight bytes, in another field.
const ELSEWHERE: u32 = u32::MAX;
/// A placeholder for a count of two bytes.
const COUNT_ELSEWHERE: u16 = u16::MAX;
/// The type of the field with the sizes of eight bytes.
const ZIP64: u16 = 1;
/// The first day in ZIP, 1980-01-01 at midnight. With a fixed time, the same arrays make the same bytes.
const DATE: [u16; 2] = [0, 0x21];

/// The signatures of the parts.
const LOCAL: u32 = 0x0403_4b50;
const CENTRAL: u32 = 0x0201_4b50;
const END_64: u32 = 0x0606_4b50;
const PLACE_OF_END_64: u32 = 0x0706_4b50;
const END: u32 = 0x0605_4b50;

/// The number of numbers that are converted to bytes at a time.
const NUMBERS: usize = 1 << 13;

/// A file of the archive.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) checksum: u32,
    pub(super) bytes: u64,
    /// The offset of its header.
    pub(super) place: u64,
}

/// An archive of arrays that grow together, piece by piece.
#[derive(Debug, Default)]
pub(super) struct Archive {
    members: Vec<Member>,
    /// The offset behind the last member.
    end: u64,
}

/// A member that is being written.
#[derive(Debug)]
struct Member {
    entry: Entry,
    checksum: crc32fast::Hasher,
    /// The offset of its next bytes.
    next: u64,
}

impl Archive {
    /// Adds an array with this name, header and number of further bytes, all of which must come before the end.
    pub(super) fn add(
        &mut self,
        file: &mut File,
        name: &str,
        header: &[u8],
        bytes: u64,
    ) -> io::Result<()> {
        let entry = Entry {
            name: format!("{name}.npy"),
            checksum: 0,
            bytes: header.len() as u64 + bytes,
            place: self.end,
        };
        let next = self.end + entry.local().len() as u64;
        self.end = next + entry.bytes;
        self.members.push(Member {
            entry,
            checksum: crc32fast::Hasher::new(),
            next,
        });
        self.extend(file, self.members.len() - 1, header)
    }

    /// Adds bytes to the array with this index.
    pub(super) fn extend(&mut self, file: &mut File, index: usize, bytes: &[u8]) -> io::Result<()> {
        let member = &mut self.members[index];
        file.seek(SeekFrom::Start(member.next))?;
        file.write_all(bytes)?;
        member.checksum.update(bytes);
        member.next += bytes.len() as u64;
        Ok(())
    }

    /// Writes all headers, whose checksums are known now.
    pub(super) fn finish(self, file: &mut File) -> io::Result<()> {
        let mut entries = Vec::new();
        for mut member in self.members {
            member.entry.checksum = member.checksum.finalize();
            file.seek(SeekFrom::Start(member.entry.place))?;
            file.write_all(&member.entry.local())?;
            entries.push(member.entry);
        }
        file.seek(SeekFrom::Start(self.end))?;
        file.write_all(&list(&entries, self.end))
    }
}

/// The list of the members, which follows the last one, at this offset.
pub(super) fn list(entries: &[Entry], place: u64) -> Vec<u8> {
    let mut list: Vec<u8> = entries.iter().flat_map(Entry::central).collect();
    let length = list.len() as u64;
    list.extend(end(entries.len() as u64, place, length));
    list
}

/// Writes arrays with one number per pixel, row by row, under their names.
pub(crate) fn write(to: &mut dyn Write, size: Size, arrays: &[(&str, &[f64])]) -> io::Result<()> {
    let array = Array {
        size,
        channels: None,
        number: Number::F64,
    };
    let start = header::bytes(&array, None);
    let mut place = 0;
    let mut entries = Vec::new();
    for (name, numbers) in arrays {
        let mut checksum = crc32fast::Hasher::new();
        checksum.update(&start);
        for_each_part(numbers, |bytes| {
            checksum.update(bytes);
            Ok(())
        })?;
        let entry = Entry {
            name: format!("{name}.npy"),
            checksum: checksum.finalize(),
            bytes: (start.len() + size_of_val(*numbers)) as u64,
            place,
        };
        let local = entry.local();
        to.write_all(&local)?;
        to.write_all(&start)?;
        for_each_part(numbers, |bytes| to.write_all(bytes))?;
        place += local.len() as u64 + entry.bytes;
        entries.push(entry);
    }
    to.write_all(&list(&entries, place))
}

/// The bytes of the numbers, in pieces.
fn for_each_part(numbers: &[f64], mut take: impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
    for part in numbers.chunks(NUMBERS) {
        let bytes: Vec<u8> = part
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        take(&bytes)?;
    }
    Ok(())
}

impl Entry {
    /// The header before the file.
    pub(super) fn local(&self) -> Vec<u8> {
        let mut header = LOCAL.to_le_bytes().to_vec();
        self.describe(&mut header, 20);
        header.extend(self.name.as_bytes());
        put_16(&mut header, &[ZIP64, 16]);
        put_64(&mut header, &[self.bytes, self.bytes]);
        header
    }

    /// The header in the list at the end.
    fn central(&self) -> Vec<u8> {
        let mut header = CENTRAL.to_le_bytes().to_vec();
        put_16(&mut header, &[VERSION]);
        self.describe(&mut header, 28);
        // No comment, on the first disk, no text, and no attributes.
        put_16(&mut header, &[0, 0, 0, 0, 0]);
        header.extend(ELSEWHERE.to_le_bytes());
        header.extend(self.name.as_bytes());
        put_16(&mut header, &[ZIP64, 24]);
        put_64(&mut header, &[self.bytes, self.bytes, self.place]);
        header
    }

    /// The part that both headers share; the field of sizes that follows has this many bytes.
    fn describe(&self, header: &mut Vec<u8>, field: u16) {
        const STORED: u16 = 0;
        put_16(header, &[VERSION, 0, STORED]);
        put_16(header, &DATE);
        header.extend(self.checksum.to_le_bytes());
        header.extend(ELSEWHERE.to_le_bytes());
        header.extend(ELSEWHERE.to_le_bytes());
        put_16(header, &[self.name.len() as u16, field]);
    }
}

/// The end of an archive; its list of members has this position and length.
fn end(files: u64, place: u64, length: u64) -> Vec<u8> {
    /// Bytes of the first part after its signature and this number.
    const REST: u64 = 44;
    let mut end = END_64.to_le_bytes().to_vec();
    put_64(&mut end, &[REST]);
    put_16(&mut end, &[VERSION, VERSION]);
    // The only disk.
    put_64(&mut end, &[0, files, files, length, place]);
    end.extend(PLACE_OF_END_64.to_le_bytes());
    end.extend(0_u32.to_le_bytes());
    put_64(&mut end, &[place + length]);
    end.extend(1_u32.to_le_bytes());
    end.extend(END.to_le_bytes());
    put_16(&mut end, &[0, 0, COUNT_ELSEWHERE, COUNT_ELSEWHERE]);
    end.extend(ELSEWHERE.to_le_bytes());
    end.extend(ELSEWHERE.to_le_bytes());
    put_16(&mut end, &[0]);
    end
}

fn put_16(to: &mut Vec<u8>, numbers: &[u16]) {
    to.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

fn put_64(to: &mut Vec<u8>, numbers: &[u64]) {
    to.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_leads_to_the_list_and_the_list_to_the_arrays() {
        let size = Size {
            width: 3,
            height: 2,
        };
        let numbers = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.5; 6]];
        let mut file = Vec::new();
        write(
            &mut file,
            size,
            &[("one", &numbers[0]), ("other", &numbers[1])],
        )
        .unwrap();
        let long = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
        let short = |at: usize| u16::from_le_bytes(file[at..at + 2].try_into().unwrap());
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        // The last 22 bytes are the end, the 20 before say where its longer form is.
        let locator = file.len() - 42;
        assert_eq!([word(locator), word(locator + 20)], [PLACE_OF_END_64, END]);
        let end = long(locator + 8);
        assert_eq!((word(end), long(end + 24)), (END_64, 2));
        assert_eq!(long(end + 48) + long(end + 40), end);
        let mut list = long(end + 48);
        for (name, numbers) in ["one.npy", "other.npy"].iter().zip(&numbers) {
            assert_eq!(word(list), CENTRAL);
            let length = usize::from(short(list + 28));
            assert_eq!(&file[list + 46..list + 46 + length], name.as_bytes());
            let field = list + 46 + length;
            let (bytes, place) = (long(field + 4), long(field + 20));
            assert_eq!(word(place), LOCAL);
            assert_eq!(word(place + 14), word(list + 16), "the checksum");
            let start = place + 30 + length + usize::from(short(place + 28));
            let array = &file[start..start + bytes];
            assert_eq!(crc32fast::hash(array), word(list + 16));
            assert!(array.starts_with(b"\x93NUMPY"));
            let expected: Vec<u8> = numbers
                .iter()
                .flat_map(|number| number.to_le_bytes())
                .collect();
            assert!(array.ends_with(&expected));
            list = field + 4 + usize::from(short(field + 2));
        }
        assert_eq!(list, end);
    }
}
