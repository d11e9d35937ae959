//! Pictures in NPZ files: their light, and the digest that it contains.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

use blake3::Hash;
use rawzip::{CompressionMethod, MAX_CENTRAL_DIRECTORY_RECORD_SIZE, ZipArchive};

use super::arrays::LIGHT;
use super::npz::{Entry, list};
use super::{read, stored};
use crate::base::failure::reason;
use crate::base::region::Region;
use crate::formats::picture::Picture;
use crate::formats::source::Source;

/// The name of the format.
pub(crate) const NAME: &str = "NPZ";

/// A member of an archive.
struct Member {
    entry: Entry,
    /// The offset of its bytes, if they are stored as they are.
    start: Option<u64>,
}

impl Member {
    fn is_light(&self) -> bool {
        self.entry.name.strip_suffix(".npy") == Some(LIGHT)
    }
}

/// The light in an archive of marbles, or the only array of another one.
pub(crate) fn begin(source: &Source) -> Result<Picture, String> {
    let path = path_of(source)?;
    let light = light(members(path)?)?;
    let section = section(path, &light)?;
    let picture = read::begin_in(Box::new(BufReader::new(section)))?;
    Ok(Picture {
        format: NAME,
        description: picture.description.replacen(read::NAME, NAME, 1),
        ..picture
    })
}

/// Returns whether the archive at `path` has an array with the name of the light.
pub(crate) fn has_light(path: &Path) -> bool {
    members(path).is_ok_and(|members| members.iter().any(Member::is_light))
}

/// The digest and the region of the picture in an archive. Reads all of it: nothing may differ from what marbles writes.
pub(crate) fn contents(source: &Source) -> Result<(Hash, Region), String> {
    const DAMAGED: &str = "it is damaged, or not by this version of marbles";
    let path = path_of(source)?;
    let members = members(path)?;
    let mut file = File::open(path).map_err(|error| reason(&error))?;
    let mut entries = Vec::new();
    let mut place = 0;
    for member in &members {
        let entry = Entry {
            place,
            ..member.entry.clone()
        };
        let local = entry.local();
        require(&mut file, place, &local)?;
        place += local.len() as u64;
        if member.start != Some(place) {
            return Err(DAMAGED.to_owned());
        }
        let mut checksum = crc32fast::Hasher::new();
        let mut bytes = section(path, member)?;
        let mut buffer = vec![0; 1 << 16];
        loop {
            let count = bytes.read(&mut buffer).map_err(|error| reason(&error))?;
            if count == 0 {
                break;
            }
            checksum.update(&buffer[..count]);
        }
        let found = checksum.finalize();
        if found != entry.checksum {
            let (name, expected) = (&entry.name, entry.checksum);
            return Err(format!(
                "expected the checksum 0x{expected:08x} of `{name}`, found 0x{found:08x}: it is damaged"
            ));
        }
        place += entry.bytes;
        entries.push(entry);
    }
    let end = list(&entries, place);
    require(&mut file, place, &end)?;
    let length = file
        .seek(SeekFrom::End(0))
        .map_err(|error| reason(&error))?;
    if length != place + end.len() as u64 {
        return Err(DAMAGED.to_owned());
    }
    let light = light(members)?;
    let mut section = section(path, &light)?;
    stored::contents(&mut section).ok_or_else(|| "it contains no digest".to_owned())
}

/// Requires these bytes at an offset.
fn require(file: &mut File, place: u64, expected: &[u8]) -> Result<(), String> {
    let mut found = vec![0; expected.len()];
    let read = file
        .seek(SeekFrom::Start(place))
        .and_then(|_| file.read_exact(&mut found));
    match read {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Err("it ends early".to_owned()),
        Err(error) => Err(reason(&error)),
        Ok(()) if found != expected => {
            Err(format!("its headers differ at byte {place}: it is damaged"))
        }
        Ok(()) => Ok(()),
    }
}

/// The path of an archive, whose members are found from its end.
fn path_of(source: &Source) -> Result<&Path, String> {
    match source {
        Source::File(path) => Ok(path),
        Source::Memory(_) => {
            Err("expected a file, found a pipe: save the picture first".to_owned())
        }
    }
}

/// The arrays of an archive.
fn members(path: &Path) -> Result<Vec<Member>, String> {
    let damaged = |error: rawzip::Error| format!("expected an archive of arrays: {error}");
    let file = File::open(path).map_err(|error| reason(&error))?;
    let mut buffer = vec![0; MAX_CENTRAL_DIRECTORY_RECORD_SIZE];
    let archive = ZipArchive::from_file(file, &mut buffer).map_err(damaged)?;
    let mut members = Vec::new();
    let mut entries = archive.entries(&mut buffer);
    while let Some(entry) = entries.next_entry().map_err(damaged)? {
        let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
        let is_stored =
            entry.compression_method() == CompressionMethod::STORE && !entry.flags().is_encrypted();
        let checksum = entry.crc32();
        let data = archive.get_entry(entry.wayfinder()).map_err(damaged)?;
        let (start, end) = data.compressed_data_range();
        members.push(Member {
            entry: Entry {
                name,
                checksum,
                bytes: end.saturating_sub(start),
                place: 0,
            },
            start: is_stored.then_some(start),
        });
    }
    Ok(members)
}

/// The member with the light, or the only one.
fn light(mut members: Vec<Member>) -> Result<Member, String> {
    let index = members.iter().position(Member::is_light);
    match index.or_else(|| (members.len() == 1).then_some(0)) {
        Some(index) => Ok(members.swap_remove(index)),
        None => {
            let names = members.iter().map(|member| &*member.entry.name);
            let names: Vec<&str> = names.take(10).collect();
            let names = names.join(", ");
            Err(format!(
                "expected one array, or one called `{LIGHT}`, found {names}"
            ))
        }
    }
}

/// The bytes of a member.
fn section(path: &Path, member: &Member) -> Result<Section, String> {
    let start = member.start.ok_or_else(|| {
        let name = &member.entry.name;
        format!("expected arrays that are stored as they are, found `{name}` compressed")
    })?;
    let mut file = File::open(path).map_err(|error| reason(&error))?;
    let length = file.metadata().map_err(|error| reason(&error))?.len();
    // Readers take memory for rows that the section is long enough for.
    if start
        .checked_add(member.entry.bytes)
        .is_none_or(|end| end > length)
    {
        return Err("it ends early".to_owned());
    }
    file.seek(SeekFrom::Start(start))
        .map_err(|error| reason(&error))?;
    Ok(Section {
        file,
        start,
        length: member.entry.bytes,
        place: 0,
    })
}

/// A part of a file, like a file of its own.
struct Section {
    file: File,
    start: u64,
    length: u64,
    place: u64,
}

impl Read for Section {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.length.saturating_sub(self.place);
        let most = buffer
            .len()
            .min(usize::try_from(left).unwrap_or(usize::MAX));
        let count = self.file.read(&mut buffer[..most])?;
        self.place += count as u64;
        Ok(count)
    }
}

impl Seek for Section {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::End(offset) => self.length.checked_add_signed(offset),
            SeekFrom::Current(offset) => self.place.checked_add_signed(offset),
        };
        let place = place.ok_or(ErrorKind::InvalidInput)?;
        let absolute = self
            .start
            .checked_add(place)
            .ok_or(ErrorKind::InvalidInput)?;
        self.file.seek(SeekFrom::Start(absolute))?;
        self.place = place;
        Ok(place)
    }
}
