//! Tests of `chunks.rs`.

use super::*;
use crate::sequence::frames::FrameList;

#[test]
fn frames_are_written_as_ranges() {
    assert_eq!(expression(&[7]), "7");
    assert_eq!(expression(&[1, 2]), "1,2");
    assert_eq!(expression(&[1, 2, 3, 4]), "1-4");
    assert_eq!(expression(&[9, 11, 13, 15]), "9-15:2");
    assert_eq!(expression(&[17, 19, 30]), "17,19,30");
    assert_eq!(expression(&[-3, -2, -1, 0, 4, 8]), "-3-0,4,8");
    assert_eq!(expression(&[1, 2, 3, 7, 9, 11, 13]), "1-3,7-13:2");
    assert_eq!(expression(&[5, 4, 3]), "5-3:-1");
    assert_eq!(expression(&[1, 2, 4, 6, 8]), "1,2-8:2");
}

#[test]
fn ranges_are_read_back_as_the_same_frames() {
    for list in [
        "1-2400",
        "5,1-6x2,2-5,5,0",
        "-10--8,-4-4x4",
        "9-1:-2,4,100-50:-7",
        "-2147483648-2147483647x4294967295,0",
        "-2147483648,2147483647,0-5",
    ] {
        let frames: Vec<i32> = list.parse::<FrameList>().unwrap().iter().collect();
        for chunk in frames.chunks(1).chain(frames.chunks(7)).chain([&*frames]) {
            let text = expression(chunk);
            let read: FrameList = text.parse().unwrap();
            assert_eq!(read.iter().collect::<Vec<i32>>(), chunk, "{text}");
        }
    }
}
