//! Tests of `element.rs`.

use super::*;

#[test]
fn every_symbol_has_its_number() {
    assert_eq!(ELEMENTS.len(), 118);
    for (index, element) in ELEMENTS.iter().enumerate() {
        let expected = Some(index as u8 + 1);
        assert_eq!(number(element.symbol.as_bytes()), expected);
        assert_eq!(number(element.symbol.to_lowercase().as_bytes()), expected);
        assert_eq!(number((index + 1).to_string().as_bytes()), expected);
    }
    for text in ["", "0", "119", "300", "Xx", "Car", "C1", "-1", "\u{e4}"] {
        assert_eq!(number(text.as_bytes()), None, "{text}");
    }
}

#[test]
fn known_elements_have_their_radii_and_colors() {
    let of = |symbol: &str| number(symbol.as_bytes()).unwrap();
    for (symbol, radii, expected) in [
        ("H", Radii::VanDerWaals, 1.1),
        ("C", Radii::VanDerWaals, 1.7),
        ("Ar", Radii::VanDerWaals, 1.88),
        ("C", Radii::Covalent, 0.76),
        ("Cm", Radii::Covalent, 1.69),
    ] {
        assert_eq!(radius(of(symbol), radii), Some(expected), "{symbol}");
    }
    assert_eq!(radius(of("Og"), Radii::VanDerWaals), None);
    assert_eq!(radius(0, Radii::VanDerWaals), None);
    assert_eq!(colors()[1], DVec3::ONE);
    assert_eq!(colors()[8], from_srgb(0xff0d0d));
    assert_eq!(colors().len(), 119);
}

#[test]
fn labels_and_slips_are_recognized() {
    for (text, expected) in [
        ("C12", Some("C")),
        ("fe2+", Some("Fe")),
        ("Cx", Some("C")),
        ("Arg", Some("Ar")),
        ("A", None),
        ("", None),
        ("\u{e4}\u{e4}", None),
        // A letter of two bytes.
        ("\u{e9}", None),
        ("\u{e9}C", None),
        ("C\u{e9}", Some("C")),
    ] {
        assert_eq!(suggestion(text), expected, "{text}");
    }
}
