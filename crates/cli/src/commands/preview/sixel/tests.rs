//! Tests of `sixel.rs`.

use super::*;
use crate::base::size::Size;

const RED: [u8; 3] = [255, 0, 0];
const BLUE: [u8; 3] = [0, 0, 255];

fn picture(width: u32, height: u32, codes: Vec<[u8; 3]>) -> Picture {
    let size = Size { width, height };
    Picture { size, codes }
}

#[test]
fn six_rows_are_a_band() {
    // A red column beside a blue one, of seven rows, and a red row below.
    let mut codes = [RED, BLUE].repeat(7);
    codes.extend([RED, RED]);
    // The colors are sorted: blue is 0. All six bits are 63, `?` + 63 is `~`; in the second band there are two rows.
    assert_eq!(
        text(&picture(2, 8, codes)),
        "\x1bP0;1;0q\"1;1;2;8#0;2;0;0;100#1;2;100;0;0#0?~$#1~$-#0?@$#1BA$-\x1b\\\n"
    );
}

#[test]
fn long_runs_are_counted() {
    let codes = [vec![RED; 5], vec![BLUE; 3]].concat();
    let text = text(&picture(8, 1, codes));
    assert!(text.ends_with("#0!5?@@@$#1!5@$-\x1b\\\n"), "{text:?}");
}

/// The pixels that a terminal shows, by another way: each byte is a column of six.
#[test]
fn every_pixel_has_the_color_of_its_number() {
    let (width, height) = (37, 20);
    let numbers = 0..width * height;
    // Few enough colors that each is exact, in codes that whole percents give.
    let codes = numbers.map(|n| [51 * (n * n % 6) as u8, 51 * (n / 7 % 6) as u8, 0]);
    let picture = picture(width, height, codes.collect());
    let text = text(&picture);
    let (head, body) = text
        .strip_suffix("\x1b\\\n")
        .unwrap()
        .split_once("#")
        .unwrap();
    assert_eq!(head, "\x1bP0;1;0q\"1;1;37;20");
    let mut palette = Vec::new();
    let mut shown = vec![[1_u8; 3]; picture.codes.len()];
    let (mut color, mut col, mut band, mut count) = (0, 0, 0, 1);
    let mut rest = format!("#{body}");
    let number = |rest: &mut String| -> usize {
        let end = rest.find(|letter: char| !letter.is_ascii_digit()).unwrap();
        let digits: String = rest.drain(..end).collect();
        digits.parse().unwrap()
    };
    while !rest.is_empty() {
        match rest.remove(0) {
            '#' => {
                color = number(&mut rest);
                if rest.starts_with(';') {
                    let mut parts = [0; 4];
                    for part in &mut parts {
                        rest.remove(0);
                        *part = number(&mut rest);
                    }
                    assert_eq!(parts[0], 2);
                    palette.push([1, 2, 3].map(|channel| (parts[channel] * 255 / 100) as u8));
                    assert_eq!(palette.len(), color + 1);
                }
            }
            '$' => col = 0,
            '-' => (col, band) = (0, band + 1),
            '!' => count = number(&mut rest),
            sixel => {
                for _ in 0..count {
                    for row in (0..6).filter(|row| (sixel as u8 - 63) >> row & 1 == 1) {
                        shown[(6 * band + row) * width as usize + col] = palette[color];
                    }
                    col += 1;
                }
                count = 1;
            }
        }
    }
    assert!(shown == picture.codes, "{text:?}");
}
