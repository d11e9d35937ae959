//! Tests of `attributes.rs`.

use super::*;

const FILE: &[u8] = b"12345678\
    b\0int\0\x01\0\0\0B\
    ab\0int\0\x02\0\0\0\0\0\
    a\0int\0\0\0\0\0\
    \0rest";

#[test]
fn attributes_come_in_the_order_of_their_names() {
    let mut file = FILE.to_vec();
    assert_eq!(sort_attributes(&mut file), Some(()));
    let sorted = b"12345678\
        a\0int\0\0\0\0\0\
        ab\0int\0\x02\0\0\0\0\0\
        b\0int\0\x01\0\0\0B\
        \0rest";
    assert_eq!(file, sorted);
}

#[test]
fn doubles_are_replaced_in_place() {
    let file = |number: f64| {
        let number = number.to_le_bytes();
        let start = b"12345678a\0int\0\x01\0\0\0Bab\0double\0\x08\0\0\0";
        [
            &start[..],
            &number,
            b"abc\0double\0\x08\0\0\0",
            &number,
            b"\0rest",
        ]
        .concat()
    };
    let mut changed = file(0.0);
    assert_eq!(set_double(&mut changed, "ab", 0.1), Some(()));
    assert_eq!(set_double(&mut changed, "abc", 0.1), Some(()));
    assert_eq!(changed, file(0.1));
    for name in ["a", "b", "abcd", ""] {
        assert_eq!(set_double(&mut changed, name, 0.2), None);
    }
    assert_eq!(changed, file(0.1));
}

#[test]
fn truncated_headers_are_left_alone() {
    let end = FILE.len() - b"\0rest".len();
    for length in 0..=end {
        let mut file = FILE[..length].to_vec();
        assert_eq!(sort_attributes(&mut file), None);
        assert_eq!(file, FILE[..length]);
    }
}
