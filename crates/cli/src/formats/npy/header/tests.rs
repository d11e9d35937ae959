use std::io::Cursor;

use blake3::Hash;

use super::*;
use crate::base::region::Region;

const SIZE: Size = Size {
    width: 3,
    height: 2,
};

#[test]
fn headers_come_back_with_their_stamps() {
    let stamp = Stamp {
        digest: Hash::from_bytes([0xc5; 32]),
        region: Region::all(SIZE),
    };
    for number in [Number::F64, Number::F32, Number::U32] {
        for channels in [None, Some(1), Some(4)] {
            for stamp in [None, Some(stamp)] {
                let array = Array {
                    size: SIZE,
                    channels,
                    number,
                };
                let bytes = bytes(&array, stamp.as_ref());
                assert_eq!(bytes.len() % ALIGNMENT, 0);
                assert_eq!(bytes.last(), Some(&b'\n'));
                let start = bytes.len() as u64;
                let expected = Header {
                    array,
                    stamp,
                    start,
                };
                assert_eq!(read(&mut Cursor::new(&bytes)), Ok(expected));
                for length in [7, 9, 20, bytes.len() - 1] {
                    assert!(read(&mut Cursor::new(&bytes[..length])).is_err());
                }
            }
        }
    }
}

#[test]
fn a_plain_header_is_what_numpy_writes() {
    let array = Array {
        size: SIZE,
        channels: Some(3),
        number: Number::F64,
    };
    let expected = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3, 3), }";
    let expected = format!("{expected:117}\n");
    let start = b"\x93NUMPY\x01\x00\x76\x00";
    assert_eq!(bytes(&array, None), [start, expected.as_bytes()].concat());
}

#[test]
fn headers_of_others_are_read_or_refused() {
    let of = |dictionary: &str| array_of(dictionary);
    let array = of("{\"shape\":(2,3),'fortran_order' : False,\"descr\":\"<u4\"}").unwrap();
    assert_eq!((array.size, array.channels), (SIZE, None));
    assert_eq!(array.number, Number::U32);
    for (dictionary, reason) in [
        ("{}", "describe an array"),
        (
            "{'descr': '>f8', 'fortran_order': False, 'shape': (2, 3)}",
            "found `>f8`",
        ),
        (
            "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3)}",
            "column by column",
        ),
        (
            "{'descr': '<f8', 'fortran_order': False, 'shape': (2,)}",
            "found (2,)",
        ),
        (
            "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3, 4, 5)}",
            "found (2, 3, 4, 5)",
        ),
        (
            "{'descr': '<f8', 'fortran_order': False, 'shape': (-2, 3)}",
            "found (-2, 3)",
        ),
    ] {
        let refused = of(dictionary).unwrap_err();
        assert!(refused.contains(reason), "{refused}");
    }
}
