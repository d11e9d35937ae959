//! The chemical elements: their symbols, colors and radii.

use std::sync::LazyLock;

use glam::DVec3;
use serde::Deserialize;

use crate::text::closest;
use crate::values::from_srgb;

/// The kind of radii that elements have.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum Radii {
    /// Half of the least distance between molecules.
    #[default]
    VanDerWaals,
    /// Half of the distance between bound atoms.
    Covalent,
}

/// A chemical element.
struct Element {
    symbol: &'static str,
    /// The color in sRGB.
    color: u32,
    /// In picometers, 0 where it is unknown.
    van_der_waals_radius: u16,
    /// In picometers, 0 where it is unknown.
    covalent_radius: u16,
}

/// The elements in the order of their numbers.
///
/// # Source
/// Colors: Jmol's, which extend those of Corey, Pauling and Koltun's models. Van der Waals radii:
/// the CRC Handbook's, which are Bondi's and Mantina's for main groups. Covalent radii: Cordero and
/// others, "Covalent radii revisited", 2008.
static ELEMENTS: LazyLock<Vec<Element>> = LazyLock::new(|| {
    let element = |line: &'static str| {
        let mut fields = line.split(',');
        Some(Element {
            symbol: fields.next()?,
            color: u32::from_str_radix(fields.next()?, 16).ok()?,
            van_der_waals_radius: fields.next()?.parse().ok()?,
            covalent_radius: fields.next()?.parse().ok()?,
        })
    };
    let lines = include_str!("elements.csv").lines();
    lines.skip(1).filter_map(element).collect()
});

/// The numbers of the elements by the letters of their symbols; 0 for none.
static NUMBERS: LazyLock<[[u8; LETTERS]; LETTERS]> = LazyLock::new(|| {
    let mut numbers = [[0; LETTERS]; LETTERS];
    for (element, number) in ELEMENTS.iter().zip(1..) {
        if let Some((first, second)) = letters(element.symbol.as_bytes()) {
            numbers[first][second] = number;
        }
    }
    for isotope in ISOTOPES {
        if let Some((first, second)) = letters(isotope) {
            numbers[first][second] = HYDROGEN;
        }
    }
    numbers
});

/// The symbols of deuterium and tritium, which are hydrogen.
const ISOTOPES: [&[u8]; 2] = [b"D", b"T"];
const HYDROGEN: u8 = 1;

/// The letters of the alphabet, and none.
const LETTERS: usize = 27;

/// The letters of a symbol of one or two, in upper or lower case, by their indices.
fn letters(symbol: &[u8]) -> Option<(usize, usize)> {
    let index = |letter: u8| {
        let is_letter = letter.is_ascii_alphabetic();
        is_letter.then(|| usize::from(letter.to_ascii_lowercase() - b'a'))
    };
    match *symbol {
        [letter] => Some((index(letter)?, LETTERS - 1)),
        [first, second] => Some((index(first)?, index(second)?)),
        _ => None,
    }
}

/// The atomic number of a symbol, in upper or lower case, or of the number itself.
pub(crate) fn number(text: &[u8]) -> Option<u8> {
    if text.first().is_some_and(u8::is_ascii_digit) {
        let number: u8 = str::from_utf8(text).ok()?.parse().ok()?;
        let is_element = (1..=ELEMENTS.len()).contains(&usize::from(number));
        return is_element.then_some(number);
    }
    of_symbol(text)
}

/// The atomic number of a symbol, in upper or lower case; of an isotope of hydrogen that of hydrogen.
pub(crate) fn of_symbol(text: &[u8]) -> Option<u8> {
    let (first, second) = letters(text)?;
    let number = NUMBERS[first][second];
    (number > 0).then_some(number)
}

/// The atomic number of a symbol that stands for an element, and not for one of its isotopes.
pub(crate) fn of_plain_symbol(text: &[u8]) -> Option<u8> {
    let is_isotope = |isotope: &&[u8]| text.eq_ignore_ascii_case(isotope);
    let number = of_symbol(text)?;
    (!ISOTOPES.iter().any(is_isotope)).then_some(number)
}

/// The atomic number of a symbol in its usual case: `CA` is not calcium.
pub(crate) fn of_exact_symbol(text: &[u8]) -> Option<u8> {
    of_symbol(text).filter(|number| symbol(*number).is_some_and(|symbol| symbol.as_bytes() == text))
}

/// The atomic number of a label that begins with a symbol: `C12`, `Fe2+`, `2H`; or of a symbol or a number.
pub(crate) fn of_label(text: &[u8]) -> Option<u8> {
    number(text).or_else(|| of_lettered_label(text))
}

/// The atomic number of a label that has letters: digits alone are the number of something else.
pub(crate) fn of_lettered_label(text: &[u8]) -> Option<u8> {
    let mass = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let text = &text[mass..];
    let count = text
        .iter()
        .take_while(|byte| byte.is_ascii_alphabetic())
        .count();
    let (symbol, rest) = text.split_at(count);
    let is_rest = |byte: &u8| byte.is_ascii_digit() || b"+-_*'".contains(byte);
    (count > 0 && rest.iter().all(is_rest)).then(|| of_symbol(symbol))?
}

/// The symbol that a misspelled one probably stands for.
pub(crate) fn suggestion(text: &str) -> Option<&'static str> {
    let mut symbols = ELEMENTS.iter().map(|element| element.symbol);
    // Labels of atoms start with their element: C12, Fe2+.
    let letters: String = text.chars().take_while(char::is_ascii_alphabetic).collect();
    let mut labeled = symbols.clone();
    if letters.len() < text.len()
        && let Some(symbol) = labeled.find(|symbol| symbol.eq_ignore_ascii_case(&letters))
    {
        return Some(symbol);
    }
    let mut characters = text.chars();
    match (characters.next(), characters.next(), characters.next()) {
        (None, ..) | (Some(_), None, _) => None,
        // Any two letters are close to any one of them.
        (Some(first), Some(_), None) => {
            let mut letter = [0; 4];
            let first = first.encode_utf8(&mut letter);
            symbols.find(|symbol| symbol.eq_ignore_ascii_case(first))
        }
        _ => closest(text, symbols),
    }
}

/// The radius of the element with this atomic number, in ångströms; `None` where it is unknown.
pub(crate) fn radius(number: u8, radii: Radii) -> Option<f64> {
    let element = ELEMENTS.get(usize::from(number).checked_sub(1)?)?;
    let picometers = match radii {
        Radii::VanDerWaals => element.van_der_waals_radius,
        Radii::Covalent => element.covalent_radius,
    };
    (picometers > 0).then(|| f64::from(picometers) / 100.0)
}

/// The symbol of an atomic number.
pub(crate) fn symbol(number: u8) -> Option<&'static str> {
    let element = ELEMENTS.get(usize::from(number).checked_sub(1)?)?;
    Some(element.symbol)
}

/// The linear colors of atomic numbers; 0, which none has, is black.
pub(crate) fn colors() -> Vec<DVec3> {
    let encoded = ELEMENTS.iter().map(|element| element.color);
    [0].into_iter().chain(encoded).map(from_srgb).collect()
}

#[cfg(test)]
mod tests;
