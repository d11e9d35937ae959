//! Tests of `token.rs`.

use super::*;

#[test]
fn comments_and_white_space_are_skipped() {
    let text = "  // ä\n /* a /* b */ ( */\t-3 ";
    let at = skip_trivia(text, 0);
    assert_eq!(&text[at..token_end(text, at)], "-3");
}

#[test]
fn tokens_end_where_they_should() {
    for (text, token) in [
        ("(a", "("),
        ("radius: 3", "radius"),
        ("-1e-3,", "-1e-3"),
        (r#""a\"b" c"#, r#""a\"b""#),
        (r##"r#"a"b"# c"##, r##"r#"a"b"#"##),
        ("\"no end", "\"no end"),
        ("ä(", "ä"),
        ("Surface#", "Surface"),
        ("#ff0000)", "#ff0000"),
        ("r#radius:", "r#radius"),
        ("", ""),
    ] {
        assert_eq!(&text[..token_end(text, 0)], token);
    }
}

#[test]
fn values_end_with_their_brackets() {
    for (text, value) in [
        ("3 // c", "3"),
        (
            "Free( a: \")\", /* ) */ b: [1] ) /* c */ ",
            "Free( a: \")\", /* ) */ b: [1] )",
        ),
        ("(1, 2)", "(1, 2)"),
        ("Free /* c */ (x)", "Free /* c */ (x)"),
    ] {
        assert_eq!(&text[..value_end(text, 0)], value);
    }
}

#[test]
fn what_is_not_closed_is_found() {
    assert_eq!(unclosed("(a: [1, 2], b: (c"), Some(Unclosed::Bracket(15)));
    assert_eq!(unclosed("(a: \"b, c)"), Some(Unclosed::String(4)));
    assert_eq!(unclosed("(a: 1) /* b"), Some(Unclosed::Comment(7)));
    assert_eq!(unclosed(" /* a */ /* /* b"), Some(Unclosed::Comment(9)));
    assert_eq!(unclosed("(a: 1 /* b */)"), None);
    assert_eq!(unclosed(")]"), None);
}

#[test]
fn brackets_that_are_missing_are_found() {
    // The bracket that is not closed, and what tells so: a field's name in a list, or another closing bracket.
    assert_eq!(missing_bracket("(a: [1, b: 2)"), Some((4, 8)));
    assert_eq!(missing_bracket("(a: [(b: 1), (b: 2))"), Some((4, 19)));
    assert_eq!(missing_bracket("[(1, 2]"), Some((1, 6)));
    assert_eq!(missing_bracket("({\"a\": [1})"), Some((7, 9)));
    for text in [
        "(a: [1, 2], b: {\"c\": [(d: 3)]})",
        "(a: [\"b: )\"]",
        "(a))",
        "(a: [1",
    ] {
        assert_eq!(missing_bracket(text), None, "{text}");
    }
}

#[test]
fn names_of_fields_are_found() {
    let text = "(frame: 1, /* pan: */ tilt /* : */ : 3)";
    let value = text.find('3').unwrap();
    assert_eq!(&text[field_name(text, 0, value)], "tilt");
}
