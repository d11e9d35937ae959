//! Symmetry operations of crystals, as CIF writes them: `-y, x-y, z+1/3`.

use glam::{DMat3, DVec3};

use super::number::parse;

/// A symmetry operation on the fractions of the edges of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Operation {
    turn: DMat3,
    shift: DVec3,
}

impl Operation {
    /// The operation that leaves everything as it is.
    pub(crate) const IDENTITY: Self = Self {
        turn: DMat3::IDENTITY,
        shift: DVec3::ZERO,
    };

    /// The operation that this text writes; `None` if it writes none.
    pub(crate) fn parse(text: &[u8]) -> Option<Self> {
        let text = str::from_utf8(text).ok()?;
        let plain: String = text
            .chars()
            .filter(|letter| !letter.is_whitespace())
            .collect();
        let plain = plain.to_ascii_lowercase();
        let rows: Vec<[f64; 4]> = plain.split(',').map(row).collect::<Option<_>>()?;
        let rows: [[f64; 4]; 3] = rows.try_into().ok()?;
        let turn = DMat3::from_cols_array_2d(&rows.map(|[x, y, z, _]| [x, y, z])).transpose();
        // A sum that leaves a direction out puts different atoms on one place.
        let is_whole = turn.determinant().abs() == 1.0;
        is_whole.then_some(Self {
            turn,
            shift: DVec3::from_array(rows.map(|[.., shift]| shift)),
        })
    }

    /// The equivalent place of one with these fractions.
    pub(crate) fn of(&self, fractions: DVec3) -> DVec3 {
        self.turn * fractions + self.shift
    }
}

/// The factors on x, y and z, and the number, whose sum this text is.
fn row(text: &str) -> Option<[f64; 4]> {
    let mut row = [0.0; 4];
    let mut rest = text;
    if rest.is_empty() {
        return None;
    }
    while !rest.is_empty() {
        let (sign, term) = match rest.as_bytes()[0] {
            b'-' => (-1.0, &rest[1..]),
            b'+' => (1.0, &rest[1..]),
            // The first term alone may lack a sign.
            _ if rest.len() == text.len() => (1.0, rest),
            _ => return None,
        };
        let end = term.find(['+', '-']).unwrap_or(term.len());
        let (term, after) = term.split_at(end);
        rest = after;
        match term {
            "x" => row[0] += sign,
            "y" => row[1] += sign,
            "z" => row[2] += sign,
            number => row[3] += sign * quotient(number)?,
        }
    }
    Some(row)
}

/// A number, or the quotient of two.
fn quotient(text: &str) -> Option<f64> {
    let digits = |text: &str| {
        let is_plain = text
            .bytes()
            .all(|byte| byte.is_ascii_digit() || byte == b'.');
        parse(text.as_bytes(), false).filter(|number| is_plain && number.is_finite())
    };
    let number = match text.split_once('/') {
        Some((above, below)) => digits(above)? / digits(below)?,
        None => digits(text)?,
    };
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_read_in_all_their_notations() {
        let at = DVec3::new(0.1, 0.2, 0.3);
        for (text, expected) in [
            ("x,y,z", [0.1, 0.2, 0.3]),
            ("-y, x-y, z+1/3", [-0.2, -0.1, 0.3 + 1.0 / 3.0]),
            ("1/2-X, 0.5+Y, -Z", [0.4, 0.7, -0.3]),
            ("+x,-z-.25,y+3/4", [0.1, -0.55, 0.95]),
        ] {
            let found = Operation::parse(text.as_bytes()).map(|operation| operation.of(at));
            let off = (found.unwrap_or(DVec3::NAN) - DVec3::from_array(expected)).abs();
            assert!(off.max_element() < 1e-15, "{text}: {found:?}");
        }
    }

    #[test]
    fn what_is_no_operation_is_none() {
        for text in [
            "",
            "x,y",
            "x,y,z,+1",
            "x,y,",
            "x,y,w",
            "x,y,2x",
            "x,x,z",
            "x,y,z+1/0",
            "x,y,z+",
            "xy,y,z",
            "0,0,0",
            "x,y,z+1e400",
            "x,y,z--1",
            "x,y,z+nan",
            "é,y,z",
        ] {
            assert_eq!(Operation::parse(text.as_bytes()), None, "{text}");
        }
    }
}
