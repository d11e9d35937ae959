//! Tests of `python.rs`.

use super::*;

#[test]
fn headers_are_read() {
    let header = "{'descr': [('x', '<f4'), (\"p\", '<f8', (3,))], 'fortran_order': False, 'shape': (3L, ), }  \n";
    let literal = Literal::read(header).unwrap();
    assert_eq!(literal.get("fortran_order"), Some(&Literal::Flag(false)));
    assert_eq!(
        literal.get("shape"),
        Some(&Literal::List(vec![Literal::Whole(3)]))
    );
    let text = |text: &str| Literal::Text(text.to_owned());
    let x = Literal::List(vec![text("x"), text("<f4")]);
    let three = Literal::List(vec![Literal::Whole(3)]);
    let p = Literal::List(vec![text("p"), text("<f8"), three]);
    assert_eq!(literal.get("descr"), Some(&Literal::List(vec![x, p])));
    assert_eq!(literal.get("other"), None);
}

#[test]
fn other_texts_are_none() {
    let deep = "(".repeat(100_000);
    for text in [
        "", "{", "(1", "'a", "{1 2}", "1 2", "-1", "{'a': }", "a", &deep,
    ] {
        assert_eq!(Literal::read(text), None);
    }
}
