//! Compressed tables: what their formats have beside the data, and their checksums.

use std::io::Write;

use super::formats::npz;
use super::*;

const TABLE: &str = "x,y,z,r\n1,-2.5,3e-3,0.5\n4,5,6,7\n";

pub(super) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(bytes).unwrap();
    gzip.finish().unwrap()
}

/// A frame with its checksum.
pub(super) fn zstandard(bytes: &[u8]) -> Vec<u8> {
    ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest)
}

/// A frame that is to be passed over.
fn skippable(bytes: &[u8]) -> Vec<u8> {
    let mut frame = 0x184d_2a53_u32.to_le_bytes().to_vec();
    frame.extend((bytes.len() as u32).to_le_bytes());
    frame.extend(bytes);
    frame
}

#[test]
fn what_holds_no_data_is_passed_over() {
    let (gz, zst) = (gzip(TABLE.as_bytes()), zstandard(TABLE.as_bytes()));
    let (start, rest) = TABLE.split_at(10);
    let parts = [
        gzip(start.as_bytes()),
        vec![0; 300],
        gzip(b""),
        gzip(rest.as_bytes()),
    ]
    .concat();
    let skipped = [skippable(b"size"), zst.clone(), skippable(b"")].concat();
    let frames = [
        zstandard(start.as_bytes()),
        skippable(&[1; 70_000]),
        zstandard(rest.as_bytes()),
    ];
    for (name, bytes) in [
        ("a.csv.gz", [&gz[..], &[0; 100_000]].concat()),
        ("a.csv.gz", parts),
        ("a.csv.zst", skipped),
        ("a.csv.zst", frames.concat()),
    ] {
        assert_eq!(spheres(&scene(name, bytes, "")), TWO);
    }
    let behind = |name: &str, bytes: &[u8], more: &[u8]| {
        let message = refusal(name, [bytes, more].concat(), "");
        message.split("cannot be read: ").nth(1).unwrap().to_owned()
    };
    assert_eq!(
        behind("a.csv.gz", &gz, b"\0\0xy"),
        format!(
            "expected another gzip member, zeros or the end at byte {}, found the byte 0x78",
            gz.len() + 2
        )
    );
    assert_eq!(
        behind("a.csv.zst", &zst, b"abcd"),
        format!(
            "expected another Zstandard frame or the end at byte {}, found the bytes [61, 62, 63, 64]",
            zst.len()
        )
    );
    let cut = behind("a.csv.zst", &zst, &skippable(b"four")[..11]);
    let expected = format!(
        "the Zstandard frame at byte {} is cut: the file ends within it",
        zst.len()
    );
    assert_eq!(cut, expected);
}

#[test]
fn tables_that_are_compressed_twice_are_called_so() {
    for (bytes, expected) in [
        (
            gzip(&gzip(TABLE.as_bytes())),
            "this gzip file, found a gzip file",
        ),
        (
            gzip(&zstandard(TABLE.as_bytes())),
            "this gzip file, found a Zstandard file",
        ),
        (
            zstandard(&gzip(TABLE.as_bytes())),
            "this Zstandard file, found a gzip file",
        ),
    ] {
        let message = refusal("a.csv.gz", bytes, "");
        let expected =
            format!("a.csv.gz: expected a table in {expected} within it: decompress it once");
        assert_eq!(message, expected);
    }
}

#[test]
fn archives_are_not_compressed_once_more() {
    let message = refusal("a.npz.gz", gzip(&npz(&[])), "");
    let expected = "a.npz.gz: expected an uncompressed NPZ archive, found one in a gzip file: decompress it once";
    assert_eq!(message, expected);
}

/// Refuses a table of which any bit of these bytes is another one.
fn check(name: &str, bytes: &[u8], places: impl Iterator<Item = usize>, fields: &str) {
    let is_refused = |bytes: &[u8]| load(name, bytes, fields).is_err();
    assert!(!is_refused(bytes), "{name} is whole");
    for place in places {
        for bit in 0..8 {
            let mut bytes = bytes.to_vec();
            bytes[place] ^= 1 << bit;
            assert!(is_refused(&bytes), "{name}: bit {bit} of byte {place}");
        }
    }
}

#[test]
fn checksums_are_compared() {
    let gz = gzip(TABLE.as_bytes());
    check("a.csv.gz", &gz, gz.len() - 8..gz.len(), "");
    let zst = zstandard(TABLE.as_bytes());
    check("a.csv.zst", &zst, zst.len() - 4..zst.len(), "");
    let message = refusal(
        "a.csv.zst",
        {
            let mut bytes = zst;
            *bytes.last_mut().unwrap() ^= 1;
            bytes
        },
        "",
    );
    let words = "the Zstandard frame at byte 0 is damaged: expected the checksum 0x";
    assert!(message.contains(words), "{message}");
    // Of a file whose first frame alone is read.
    let many = gzip("1\n\nC 0 0 0\n".repeat(1000).as_bytes());
    check("a.xyz.gz", &many, many.len() - 8..many.len(), "");
    let steps = gzip(&npy(
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1, 4)}",
        &doubles(&TWO.concat()),
    ));
    check(
        "a.npy.gz",
        &steps,
        steps.len() - 8..steps.len(),
        "frames: All",
    );
}

/// The checksum of a member stands beside its data and in the directory; members that are no columns have one, too.
#[test]
fn checksums_of_archives_are_compared() {
    let header =
        |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}");
    let table = npy(&header("(2, 4)"), &doubles(&TWO.concat()));
    let other = npy(&header("(1, 1, 2)"), &doubles(&[1.0, 2.0]));
    let archive = npz(&[("a", table), ("other", other)]);
    let marks = [(&b"PK\x07\x08"[..], 4), (b"PK\x01\x02", 16)];
    let mut places = Vec::new();
    for (mark, offset) in marks {
        let found = (0..archive.len() - 4).filter(|&at| archive[at..].starts_with(mark));
        places.extend(found.flat_map(|at| at + offset..at + offset + 4));
    }
    assert_eq!(places.len(), 16);
    check("a.npz", &archive, places.into_iter(), "");
}

/// An archive whose members are all one, which is there once.
fn shared(member: &[u8], count: usize) -> Vec<u8> {
    let one = npz(&[("m", member.to_vec())]);
    let directory = one
        .windows(4)
        .position(|four| four == b"PK\x01\x02")
        .unwrap();
    let end = one
        .windows(4)
        .position(|four| four == b"PK\x05\x06")
        .unwrap();
    let entry = &one[directory..end];
    let mut bytes = one[..directory].to_vec();
    bytes.extend(entry.repeat(count));
    let mut tail = one[end..].to_vec();
    tail[8..10].copy_from_slice(&(count as u16).to_le_bytes());
    tail[10..12].copy_from_slice(&(count as u16).to_le_bytes());
    tail[12..16].copy_from_slice(&((count * entry.len()) as u32).to_le_bytes());
    bytes.extend(tail);
    bytes
}

#[test]
fn members_that_share_their_bytes_are_counted() {
    let fields: String = (0..1000)
        .map(|field| format!("('f{field}', '<f8'), "))
        .collect();
    let records = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': (0,)}}");
    let message = refusal("a.npz", shared(&npy(&records, &[]), 11), "radius: 1");
    assert_eq!(
        message,
        "a.npz: expected at most 10000 columns in all arrays, found more (in the member `m.npy`)"
    );
    // No array, but a header: 1 MB, and 67 MB in all.
    let spaces = " ".repeat(1 << 20);
    let other = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1)}}{spaces}");
    let header = &other.as_bytes()[..1 << 20];
    let mut member = b"\x93NUMPY\x02\x00".to_vec();
    member.extend((header.len() as u32).to_le_bytes());
    member.extend(header);
    let message = refusal("a.npz", shared(&member, 70), "radius: 1");
    assert!(
        message.contains("too large when decompressed; decompress it"),
        "{message}"
    );
    // Sizes whose sum is no number.
    let huge = "{'descr': [('a', '|S9223372036854775807'), ('b', '|S9223372036854775807'), ('x', '<f8')], \
                'fortran_order': False, 'shape': (0,)}";
    let message = refusal("a.npz", npz(&[("m", npy(huge, &[]))]), "radius: 1");
    assert!(
        message.contains("expected a table that fits into memory"),
        "{message}"
    );
}

#[test]
fn members_that_hold_nothing_are_counted() {
    let (nothing, table) = (gzip(b""), gzip(TABLE.as_bytes()));
    let few = [nothing.repeat(4096), table.clone()].concat();
    assert_eq!(spheres(&scene("a.csv.gz", few, "")), TWO);
    let many = [nothing.repeat(4097), table].concat();
    let message = refusal("a.csv.gz", many, "");
    assert!(
        message.contains("more than 4096 of its gzip members are empty"),
        "{message}"
    );
}
