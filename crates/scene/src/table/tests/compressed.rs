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

pub(super) fn bzip2(bytes: &[u8]) -> Vec<u8> {
    let mut bzip2 = ::bzip2::write::BzEncoder::new(Vec::new(), ::bzip2::Compression::fast());
    bzip2.write_all(bytes).unwrap();
    bzip2.finish().unwrap()
}

pub(super) fn xz(bytes: &[u8]) -> Vec<u8> {
    let options = lzma_rust2::XzOptions::with_preset(1);
    let mut xz = lzma_rust2::XzWriter::new(Vec::new(), options).unwrap();
    xz.write_all(bytes).unwrap();
    xz.finish().unwrap()
}

/// The table, compressed by `bz2.compress` of Python 3.11.7.
const BZIP2: &str = "425a6839314159265359fb712a7a00000ed980001000077f800200107020002226268309b50a1a69800a79e3ac1c8b102c2fac910126\
                     28d4cbe2ee48a70a121f6e254f40";
/// The table, compressed by `lzma.compress` of Python 3.11.7 with the checksums CRC-64, CRC-32 and SHA-256, and with none; the
/// second with a dictionary of 512 MiB.
const XZ: [&str; 4] = [
    "fd377a585a000004e6d6b446020021011c00000010cf58cc01001f782c792c7a2c720a312c2d322e352c33652d332c302e350a342c352c362c370a00e95e\
     91f0ddace8ff000138201829770c1fb6f37d010000000004595a",
    "fd377a585a0000016922de3602002101220000008240acdc01001f782c792c7a2c720a312c2d322e352c33652d332c302e350a342c352c362c370a00599a\
     f2e4000134201466c2a09042990d010000000001595a",
    "fd377a585a00000ae1fb0ca10200210116000000742fe5a301001f782c792c7a2c720a312c2d322e352c33652d332c302e350a342c352c362c370a00244b\
     92b68e5ae6b9f116dbd62600702387a0bb6f572db02041c285d4e7684a0100015020b7c853a1189b4b9a01000000000a595a",
    "fd377a585a000000ff12d9410200210116000000742fe5a301001f782c792c7a2c720a312c2d322e352c33652d332c302e350a342c352c362c370a000001\
     302010a3aec406729e7a010000000000595a",
];

fn of_digits(text: &str) -> Vec<u8> {
    let byte = |at: usize| u8::from_str_radix(&text[at..at + 2], 16).unwrap();
    (0..text.len()).step_by(2).map(byte).collect()
}

#[test]
fn files_of_bzip2_and_xz_are_read() {
    let bz2 = of_digits(BZIP2);
    let xzs = XZ.map(of_digits);
    let (start, rest) = TABLE.split_at(10);
    let (start, rest) = (start.as_bytes(), rest.as_bytes());
    let padded = [xz(start), vec![0; 8], xz(b""), xz(rest), vec![0; 4]].concat();
    for (name, bytes) in [
        ("a.csv.bz2", bz2.clone()),
        ("a.csv", bz2.clone()),
        (
            "a.csv.bz2",
            [bzip2(start), bzip2(b""), bzip2(rest)].concat(),
        ),
        ("a.csv.xz", xzs[0].clone()),
        ("a.csv.xz", xzs[2].clone()),
        ("a.csv", xzs[3].clone()),
        ("a.csv.xz", padded),
    ] {
        assert_eq!(spheres(&scene(name, bytes, "")), TWO, "{name}");
    }
    for (name, bytes, expected) in [
        (
            "a.csv.bz2",
            [&bz2[..], b"xy"].concat(),
            "expected another bzip2 stream or the end at byte 68, found the byte 0x78",
        ),
        (
            "a.csv.bz2",
            bz2[..60].to_vec(),
            "the bzip2 stream at byte 0 is cut: the file ends within it",
        ),
        (
            "a.csv.bz2",
            [&bz2[..], &bz2[..60]].concat(),
            "the bzip2 stream at byte 68 is cut: the file ends within it",
        ),
        (
            "a.csv.xz",
            xzs[0][..60].to_vec(),
            "the xz stream is cut: the file ends within it",
        ),
        (
            "a.csv.xz",
            [&xzs[0][..], b"xy"].concat(),
            "the xz stream is damaged before byte 89: invalid data after stream",
        ),
        (
            "a.csv.xz",
            xzs[1].clone(),
            "the xz stream needs more than 128 MiB of memory before byte 24: decompress it",
        ),
    ] {
        let message = refusal(name, bytes, "");
        let found = message.split("cannot be read: ").nth(1);
        assert_eq!(found, Some(expected), "{message}");
    }
}

#[test]
fn damaged_files_of_bzip2_and_xz_are_refused() {
    let bz2 = of_digits(BZIP2);
    // The checksum of the block, and that of the stream, which begins within a byte.
    check(
        "a.csv.bz2",
        &bz2,
        (10..14).chain(bz2.len() - 5..bz2.len() - 1),
        "",
    );
    for xz in [XZ[0], XZ[2]].map(of_digits) {
        check("a.csv.xz", &xz, 0..xz.len(), "");
    }
    for (name, whole) in [("a.csv.bz2", bz2), ("a.csv.xz", of_digits(XZ[0]))] {
        for end in 1..whole.len() {
            assert!(
                load(name, &whole[..end], "").is_err(),
                "{name} cut at byte {end}"
            );
        }
    }
    // Neither holds more than its size lets expect.
    let comment = "#".repeat(1 << 20) + "\n";
    let (bz2, xz) = (bzip2(comment.as_bytes()), xz(comment.as_bytes()));
    for (name, bytes) in [("a.txt.bz2", bz2.repeat(70)), ("a.txt.xz", xz.repeat(70))] {
        let message = refusal(name, bytes, "");
        assert!(
            message.contains("decompress to more than 67108864"),
            "{message}"
        );
    }
    let many = bzip2(b"").repeat(4097);
    let message = refusal("a.csv.bz2", [many, bzip2(TABLE.as_bytes())].concat(), "");
    assert!(
        message.contains("more than 4096 of its bzip2 streams are empty"),
        "{message}"
    );
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
            xz(&bzip2(TABLE.as_bytes())),
            "this xz file, found a bzip2 file",
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
    let expected =
        "a.npz.gz: expected an uncompressed NPZ file, found one in a gzip file: decompress it once";
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
