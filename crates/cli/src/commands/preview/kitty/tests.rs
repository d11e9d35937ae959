//! Tests of `kitty.rs`.

use super::*;
use crate::base::size::Size;

#[test]
fn pieces_are_the_picture() {
    // Noise, so that there are several pieces.
    let numbers = 0..60 * 60_u32;
    let codes = numbers.map(|n| [13, 17, 29].map(|f| ((n * n * f + n * 101 * f) >> 5) as u8));
    let picture = Picture {
        size: Size {
            width: 60,
            height: 60,
        },
        codes: codes.collect(),
    };
    let text = text(&picture).unwrap();
    let commands = text.strip_suffix("\x1b\\\n").unwrap();
    let commands: Vec<&str> = commands.split("\x1b\\").collect();
    assert!(commands.len() > 1);
    let mut data = String::new();
    for (index, command) in commands.iter().enumerate() {
        let command = command.strip_prefix("\x1b_G").unwrap();
        let (control, piece) = command.split_once(';').unwrap();
        let is_last = index + 1 == commands.len();
        let expected = match (index, is_last) {
            (0, _) => format!("a=T,f=100,i={},q=2,m=1", std::process::id()),
            (_, false) => "m=1".to_owned(),
            (_, true) => "m=0".to_owned(),
        };
        assert_eq!(control, expected);
        assert!(piece.len() == 4096 || is_last && (1..4096).contains(&piece.len()));
        data.push_str(piece);
    }
    let png = STANDARD.decode(data).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(png))
        .read_info()
        .unwrap();
    let mut codes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut codes).unwrap();
    assert_eq!(codes, picture.codes.as_flattened());
}
