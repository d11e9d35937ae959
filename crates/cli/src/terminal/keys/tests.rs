//! Tests of `keys.rs`.

use super::*;

fn arrow(to: Direction, shift: bool) -> Key {
    Key::Arrow { to, shift }
}

#[test]
fn bytes_are_keys() {
    for (bytes, expected) in [
        (&b"\x1b[A"[..], vec![arrow(Direction::Up, false)]),
        (b"\x1bOB", vec![arrow(Direction::Down, false)]),
        (b"\x1b[1;2C", vec![arrow(Direction::Right, true)]),
        (b"\x1b[1;5D", vec![arrow(Direction::Left, false)]),
        (b"\x1b[H\x1b[1~\x1b[7~\x1bOH", vec![Key::Home; 4]),
        (b"\x1b", vec![Key::Escape]),
        (
            b"+\x1b[Cq",
            vec![
                Key::Letter(b'+'),
                arrow(Direction::Right, false),
                Key::Letter(b'q'),
            ],
        ),
        // The mouse wheel, F5, Alt and q, an answer to a question.
        (b"\x1b[<64;1;1M\x1b[15~\x1bq\x1b[?62;4c", vec![]),
        (b"\x1b[", vec![]),
    ] {
        assert_eq!(
            decode(bytes),
            expected,
            "{:?}",
            bytes.escape_ascii().to_string()
        );
    }
}

#[test]
fn sequences_are_open_until_their_last_byte() {
    for (bytes, expected) in [
        (&b""[..], false),
        (b"q", false),
        (b"\x1b", true),
        (b"\x1b[A\x1b", true),
        (b"\x1b[1;2", true),
        (b"\x1b[1;2C", false),
        (b"\x1bO", true),
        (b"\x1bOA", false),
        (b"\x1bx", false),
        (b"\x1b[Aq", false),
    ] {
        assert_eq!(
            is_open(bytes),
            expected,
            "{:?}",
            bytes.escape_ascii().to_string()
        );
    }
}

#[test]
fn keys_wait_until_they_are_taken() {
    let keys = Keys::new();
    assert!(!keys.is_waiting());
    keys.wait(Duration::ZERO);
    keys.press(vec![Key::Home, Key::Letter(b'q')]);
    assert!(keys.is_waiting());
    keys.wait(Duration::from_secs(600));
    assert_eq!(keys.take(), [Key::Home, Key::Letter(b'q')]);
    assert!(!keys.is_waiting());
}
