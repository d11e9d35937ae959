//! The tokens of a CIF, and the items of a data block that tell its crystal.
//!
//! # Source
//! Hall, Allen and Brown, "The crystallographic information file (CIF)", 1991; the core dictionary of CIF.

use std::ops::Range;

use super::cell::{Cell, ToldCell};
use super::fields::{Division, Fields};
use super::number::parse;
use super::symmetry::Operation;
use crate::text::LocatedFault;

/// A token of a CIF.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token<'a> {
    /// The name of an item, with the line before it.
    Name(&'a [u8]),
    /// The start of a loop.
    Loop,
    /// The start or the end of a block or a frame.
    Block(&'a [u8]),
    Value(Value<'a>),
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Value<'a> {
    pub(crate) text: &'a [u8],
    /// The place in its line, quotation marks included; empty if it has lines of its own.
    pub(crate) span: Range<usize>,
    /// Nothing stands around it: what looks like a number is one, and `.` and `?` stand for nothing.
    pub(crate) is_plain: bool,
}

/// Divides lines into tokens.
#[derive(Debug, Default)]
pub(crate) struct Lexer {
    /// The start of a text of several lines that is not yet ended.
    text: Option<Vec<u8>>,
}

impl Lexer {
    /// Says whether the next line belongs to a text of several lines.
    pub(crate) fn is_in_text(&self) -> bool {
        self.text.is_some()
    }

    /// Hands the tokens of the next line to `take`.
    pub(crate) fn feed(&mut self, line: &[u8], mut take: impl FnMut(Token<'_>)) {
        /// More of a text than anything here needs.
        const LONGEST: usize = 1 << 10;
        let mut rest = line;
        match (&mut self.text, line.strip_prefix(b";")) {
            (Some(text), None) => {
                if text.len() < LONGEST {
                    text.push(b' ');
                    text.extend(&line[..line.len().min(LONGEST)]);
                }
                return;
            }
            (Some(text), Some(behind)) => {
                take(Token::Value(Value {
                    text: text.trim_ascii(),
                    span: 0..0,
                    is_plain: false,
                }));
                self.text = None;
                rest = behind;
            }
            (None, Some(start)) => {
                self.text = Some(start[..start.len().min(LONGEST)].to_vec());
                return;
            }
            (None, None) => {}
        }
        let before = line.len() - rest.len();
        let mut fields = Fields::new(rest, &Division::QuotedWords);
        while let Some(field) = fields.next() {
            let text = &rest[field.clone()];
            let is_quoted = field.start > 0 && b"'\"".contains(&rest[field.start - 1]);
            let place = before + field.start..before + field.end;
            match text {
                [b'#', ..] if !is_quoted => return,
                [b'_', ..] if !is_quoted => take(Token::Name(text)),
                text if !is_quoted && text.eq_ignore_ascii_case(b"loop_") => take(Token::Loop),
                text if !is_quoted && is_block(text) => take(Token::Block(text)),
                text => take(Token::Value(Value {
                    text,
                    span: match is_quoted {
                        true => place.start - 1..(place.end + 1).min(line.len()),
                        false => place,
                    },
                    is_plain: !is_quoted,
                })),
            }
        }
    }
}

/// Says whether a word starts or ends a block.
pub(crate) fn is_block(word: &[u8]) -> bool {
    const WORDS: [&[u8]; 4] = [b"data_", b"save_", b"global_", b"stop_"];
    let starts = |start: &[u8]| {
        word.get(..start.len())
            .is_some_and(|it| it.eq_ignore_ascii_case(start))
    };
    WORDS.iter().any(|start| starts(start))
}

/// The items of a data block that tell its crystal.
#[derive(Debug, Default)]
pub(crate) struct Items {
    expected: Expected,
    /// The lengths and the angles of the cell; NaN where a text is no number.
    cell: [Option<f64>; 6],
    /// The line of the last of them.
    cell_place: (u64, Vec<u8>),
    pub(crate) operations: Vec<Operation>,
    /// What is wrong in an operation.
    pub(crate) fault: Option<LocatedFault>,
    pub(crate) group: Group,
}

/// What a data block says of its space group.
#[derive(Debug, Default)]
pub(crate) enum Group {
    /// Nothing.
    #[default]
    Unknown,
    /// It has no symmetry but that of the lattice.
    P1,
    /// Another one, whose name stands here.
    Other(String, LocatedFault),
}

/// What the next value belongs to.
#[derive(Debug, Default)]
enum Expected {
    #[default]
    Nothing,
    Item(Option<Item>),
    Loop {
        columns: Vec<Option<Item>>,
        /// The values that were read.
        values: usize,
    },
}

/// An item that tells something of a crystal.
#[derive(Clone, Copy, Debug)]
enum Item {
    /// A length or an angle of the cell.
    Cell(usize),
    Operation,
    Group,
}

impl Item {
    /// The item of this name, whose category may stand before a point.
    fn of(name: &[u8]) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let name = String::from_utf8(name).ok()?.replace('.', "_");
        let in_cell = CELL.iter().position(|known| *known == name);
        Some(match name.as_str() {
            _ if in_cell.is_some() => Self::Cell(in_cell?),
            "_symmetry_equiv_pos_as_xyz" | "_space_group_symop_operation_xyz" => Self::Operation,
            "_symmetry_space_group_name_h-m"
            | "_space_group_name_h-m_alt"
            | "_symmetry_space_group_name_hall"
            | "_space_group_name_hall"
            | "_symmetry_int_tables_number"
            | "_space_group_it_number" => Self::Group,
            _ => return None,
        })
    }
}

/// The names of the lengths and angles of a cell.
const CELL: [&str; 6] = [
    "_cell_length_a",
    "_cell_length_b",
    "_cell_length_c",
    "_cell_angle_alpha",
    "_cell_angle_beta",
    "_cell_angle_gamma",
];

/// More operations than a cell of any space group has, of which that of Fm-3m has 192.
const MOST_OPERATIONS: usize = 384;

impl Items {
    /// Says whether a line can be passed over: it belongs to a loop that says nothing of the crystal.
    pub(crate) fn is_unneeded(&self, line: &[u8]) -> bool {
        let Expected::Loop { columns, values } = &self.expected else {
            return false;
        };
        let is_of_loop = *values > 0 && columns.iter().all(Option::is_none);
        let is_value = || match line.trim_ascii_start() {
            [] => true,
            [b'_' | b';', ..] => false,
            word => {
                let end = word.iter().position(u8::is_ascii_whitespace);
                let word = &word[..end.unwrap_or(word.len())];
                !is_block(word) && !word.eq_ignore_ascii_case(b"loop_")
            }
        };
        is_of_loop && is_value()
    }

    /// Ends the loop whose values are not handed in.
    pub(crate) fn end_loop(&mut self) {
        self.expected = Expected::Nothing;
    }

    /// Takes in the next token, which stands in this line.
    pub(crate) fn take(&mut self, number: u64, line: &[u8], token: Token<'_>) {
        match token {
            Token::Block(_) => *self = Self::default(),
            Token::Loop => {
                self.expected = Expected::Loop {
                    columns: Vec::new(),
                    values: 0,
                }
            }
            Token::Name(name) => match &mut self.expected {
                Expected::Loop { columns, values: 0 } => columns.push(Item::of(name)),
                _ => self.expected = Expected::Item(Item::of(name)),
            },
            Token::Value(value) => {
                let item = match &mut self.expected {
                    Expected::Nothing => None,
                    Expected::Item(item) => item.take(),
                    Expected::Loop { columns, values } => {
                        let place = values.checked_rem(columns.len());
                        *values += 1;
                        place.and_then(|place| columns[place])
                    }
                };
                if let Some(item) = item {
                    self.set(item, number, line, &value);
                }
            }
        }
    }

    fn set(&mut self, item: Item, number: u64, line: &[u8], value: &Value<'_>) {
        if value.is_plain && is_nothing(value.text) {
            return;
        }
        match item {
            Item::Cell(place) => {
                self.cell[place] = Some(measured(value.text).unwrap_or(f64::NAN));
                self.cell_place = (number, line.to_vec());
            }
            Item::Operation => match Operation::parse(value.text) {
                Some(operation) if self.operations.len() < MOST_OPERATIONS => {
                    self.operations.push(operation);
                }
                found => {
                    let expected = match found {
                        Some(_) => &format!("at most {MOST_OPERATIONS} symmetry operations"),
                        None => "a symmetry operation such as `-y, x-y, z+1/3`",
                    };
                    let span = value.span.clone();
                    let fault = LocatedFault::expected(number, line, span, expected);
                    self.fault.get_or_insert(fault);
                }
            },
            Item::Group => {
                let name = String::from_utf8_lossy(value.text).into_owned();
                let plain: String = name.chars().filter(|c| c.is_alphanumeric()).collect();
                let is_p1 = ["p1", "p111", "1"].contains(&plain.to_ascii_lowercase().as_str());
                match self.group {
                    Group::Other(..) => {}
                    _ if is_p1 => self.group = Group::P1,
                    _ => {
                        let span = value.span.clone();
                        let place = LocatedFault::in_line(number, line, span, String::new());
                        self.group = Group::Other(name, place);
                    }
                }
            }
        }
    }

    /// The cell, where all of it is told.
    pub(crate) fn cell(&self) -> Option<ToldCell> {
        let numbers: Option<Vec<f64>> = self.cell.iter().copied().collect();
        let [a, b, c, alpha, beta, gamma] = numbers?.try_into().ok()?;
        let cell = Cell::of_lengths([a, b, c], [alpha, beta, gamma]);
        let (number, line) = &self.cell_place;
        let fault = |message| LocatedFault::in_line(*number, line, 0..line.len(), message);
        Some(cell.map_err(fault))
    }

    /// The cell of a molecule's file, in which edges of length 1 stand for none.
    pub(crate) fn cell_of_molecule(&self) -> Option<ToldCell> {
        let is_none = self.cell[..3].iter().all(|length| *length == Some(1.0));
        self.cell().filter(|_| !is_none)
    }
}

/// Says whether a plain value stands for nothing.
pub(crate) fn is_nothing(value: &[u8]) -> bool {
    matches!(value, b"." | b"?")
}

/// A number without the uncertainty behind it.
fn measured(text: &[u8]) -> Option<f64> {
    let end = uncertainty(text).unwrap_or(text.len());
    parse(&text[..end], false).filter(|number| number.is_finite())
}

/// The place in a number at which its uncertainty begins: `(4)` of `0.123(4)`.
pub(crate) fn uncertainty(text: &[u8]) -> Option<usize> {
    let start = text.iter().position(|byte| *byte == b'(')?;
    let inside = text[start + 1..].strip_suffix(b")")?;
    let is_number = parse(&text[..start], false).is_some();
    let is_digits = inside
        .iter()
        .all(|byte| byte.is_ascii_digit() || *byte == b'.');
    (is_number && is_digits).then_some(start)
}
