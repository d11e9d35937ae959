//! Tests of `blocks.rs`.

use super::*;
use crate::base::size::Size;

const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 128, 0];
const BLUE: [u8; 3] = [1, 2, 250];

#[test]
fn two_rows_are_a_line() {
    let picture = Picture {
        size: Size {
            width: 2,
            height: 2,
        },
        codes: vec![RED, RED, GREEN, BLUE],
    };
    assert_eq!(
        text(&picture, "\n"),
        "\x1b[38;2;255;0;0m\x1b[48;2;0;128;0m▀\x1b[48;2;1;2;250m▀\x1b[0m\n"
    );
}

#[test]
fn the_last_row_of_an_odd_number_has_nothing_below() {
    let picture = Picture {
        size: Size {
            width: 1,
            height: 3,
        },
        codes: vec![RED, RED, BLUE],
    };
    assert_eq!(
        text(&picture, "|"),
        "\x1b[38;2;255;0;0m\x1b[48;2;255;0;0m▀\x1b[0m|\x1b[38;2;1;2;250m▀\x1b[0m|"
    );
}
