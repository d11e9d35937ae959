//! Tests of `attribute_order.rs`.

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
fn truncated_headers_are_left_alone() {
    let end = FILE.len() - b"\0rest".len();
    for length in 0..=end {
        let mut file = FILE[..length].to_vec();
        assert_eq!(sort_attributes(&mut file), None);
        assert_eq!(file, FILE[..length]);
    }
}
