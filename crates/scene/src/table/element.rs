//! The chemical elements: their symbols, colors and radii.

use glam::DVec3;
use serde::Deserialize;

use crate::text::closest;
use crate::values::from_srgb;

/// Which radii elements have.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum Radii {
    /// How near molecules come to each other.
    #[default]
    VanDerWaals,
    /// Half of how near bound atoms come to each other.
    Covalent,
}

/// The atomic number of a symbol, in upper or lower case, or of the number itself.
pub(crate) fn number(text: &[u8]) -> Option<u8> {
    if text.first().is_some_and(u8::is_ascii_digit) {
        let number: u8 = str::from_utf8(text).ok()?.parse().ok()?;
        let is_element = (1..=ELEMENTS.len()).contains(&usize::from(number));
        return is_element.then_some(number);
    }
    let at = match *text {
        [letter] => usize::from(ONE_LETTER[letter_index(letter)?]),
        [first, second] => {
            let row = letter_index(first)?;
            usize::from(TWO_LETTERS[row][letter_index(second)?])
        }
        _ => 0,
    };
    (at > 0).then_some(at as u8)
}

/// The symbol that a misspelled one probably stands for.
pub(crate) fn suggestion(text: &str) -> Option<&'static str> {
    let mut symbols = ELEMENTS.iter().map(|element| element.0);
    // Labels of atoms start with their element: C12, Fe2+.
    let letters: String = text.chars().take_while(char::is_ascii_alphabetic).collect();
    if letters.len() < text.len()
        && let Some(symbol) = symbols
            .clone()
            .find(|symbol| symbol.eq_ignore_ascii_case(&letters))
    {
        return Some(symbol);
    }
    match text.len() {
        0 => None,
        // Any two letters are close to any one of them.
        1 | 2 => symbols.find(|symbol| text.len() == 2 && symbol.eq_ignore_ascii_case(&text[..1])),
        _ => closest(text, symbols),
    }
}

/// The radius of the element with this atomic number, in ångströms; `None` where it is unknown.
pub(crate) fn radius(number: u8, radii: Radii) -> Option<f64> {
    let element = ELEMENTS.get(usize::from(number).checked_sub(1)?)?;
    let picometers = match radii {
        Radii::VanDerWaals => element.2,
        Radii::Covalent => element.3,
    };
    (picometers > 0).then(|| f64::from(picometers) / 100.0)
}

/// The linear colors of atomic numbers; 0, which none has, is black.
pub(crate) fn colors() -> Vec<DVec3> {
    let encoded = ELEMENTS.iter().map(|element| element.1);
    [0].into_iter().chain(encoded).map(from_srgb).collect()
}

fn letter_index(letter: u8) -> Option<usize> {
    let lower = letter.to_ascii_lowercase();
    lower
        .is_ascii_lowercase()
        .then(|| usize::from(lower - b'a'))
}

/// Atomic numbers of symbols with one letter, by that letter; 0 for none.
static ONE_LETTER: [u8; 26] = {
    let mut table = [0; 26];
    let mut at = 0;
    while at < ELEMENTS.len() {
        let symbol = ELEMENTS[at].0.as_bytes();
        if symbol.len() == 1 {
            table[(symbol[0] - b'A') as usize] = at as u8 + 1;
        }
        at += 1;
    }
    table
};

/// Atomic numbers of symbols with two letters, by those letters; 0 for none.
static TWO_LETTERS: [[u8; 26]; 26] = {
    let mut table = [[0; 26]; 26];
    let mut at = 0;
    while at < ELEMENTS.len() {
        let symbol = ELEMENTS[at].0.as_bytes();
        if symbol.len() == 2 {
            table[(symbol[0] - b'A') as usize][(symbol[1] - b'a') as usize] = at as u8 + 1;
        }
        at += 1;
    }
    table
};

/// Symbol, color in sRGB, van der Waals and covalent radius in picometers, 0 where it is unknown.
///
/// # Source
/// Colors: Jmol's, which extend those of Corey, Pauling and Koltun's models. Van der Waals radii:
/// the CRC Handbook's, which are Bondi's and Mantina's for main groups. Covalent radii: Cordero and
/// others, "Covalent radii revisited", 2008.
#[rustfmt::skip]
const ELEMENTS: [(&str, u32, u16, u16); 118] = [
    ("H", 0xffffff, 110, 31),
    ("He", 0xd9ffff, 140, 28),
    ("Li", 0xcc80ff, 182, 128),
    ("Be", 0xc2ff00, 153, 96),
    ("B", 0xffb5b5, 192, 84),
    ("C", 0x909090, 170, 76),
    ("N", 0x3050f8, 155, 71),
    ("O", 0xff0d0d, 152, 66),
    ("F", 0x90e050, 147, 57),
    ("Ne", 0xb3e3f5, 154, 58),
    ("Na", 0xab5cf2, 227, 166),
    ("Mg", 0x8aff00, 173, 141),
    ("Al", 0xbfa6a6, 184, 121),
    ("Si", 0xf0c8a0, 210, 111),
    ("P", 0xff8000, 180, 107),
    ("S", 0xffff30, 180, 105),
    ("Cl", 0x1ff01f, 175, 102),
    ("Ar", 0x80d1e3, 188, 106),
    ("K", 0x8f40d4, 275, 203),
    ("Ca", 0x3dff00, 231, 176),
    ("Sc", 0xe6e6e6, 215, 170),
    ("Ti", 0xbfc2c7, 211, 160),
    ("V", 0xa6a6ab, 207, 153),
    ("Cr", 0x8a99c7, 206, 139),
    ("Mn", 0x9c7ac7, 205, 139),
    ("Fe", 0xe06633, 204, 132),
    ("Co", 0xf090a0, 200, 126),
    ("Ni", 0x50d050, 197, 124),
    ("Cu", 0xc88033, 196, 132),
    ("Zn", 0x7d80b0, 201, 122),
    ("Ga", 0xc28f8f, 187, 122),
    ("Ge", 0x668f8f, 211, 120),
    ("As", 0xbd80e3, 185, 119),
    ("Se", 0xffa100, 190, 120),
    ("Br", 0xa62929, 185, 120),
    ("Kr", 0x5cb8d1, 202, 116),
    ("Rb", 0x702eb0, 303, 220),
    ("Sr", 0x00ff00, 249, 195),
    ("Y", 0x94ffff, 232, 190),
    ("Zr", 0x94e0e0, 223, 175),
    ("Nb", 0x73c2c9, 218, 164),
    ("Mo", 0x54b5b5, 217, 154),
    ("Tc", 0x3b9e9e, 216, 147),
    ("Ru", 0x248f8f, 213, 146),
    ("Rh", 0x0a7d8c, 210, 142),
    ("Pd", 0x006985, 210, 139),
    ("Ag", 0xc0c0c0, 211, 145),
    ("Cd", 0xffd98f, 218, 144),
    ("In", 0xa67573, 193, 142),
    ("Sn", 0x668080, 217, 139),
    ("Sb", 0x9e63b5, 206, 139),
    ("Te", 0xd47a00, 206, 138),
    ("I", 0x940094, 198, 139),
    ("Xe", 0x429eb0, 216, 140),
    ("Cs", 0x57178f, 343, 244),
    ("Ba", 0x00c900, 268, 215),
    ("La", 0x70d4ff, 243, 207),
    ("Ce", 0xffffc7, 242, 204),
    ("Pr", 0xd9ffc7, 240, 203),
    ("Nd", 0xc7ffc7, 239, 201),
    ("Pm", 0xa3ffc7, 238, 199),
    ("Sm", 0x8fffc7, 236, 198),
    ("Eu", 0x61ffc7, 235, 198),
    ("Gd", 0x45ffc7, 234, 196),
    ("Tb", 0x30ffc7, 233, 194),
    ("Dy", 0x1fffc7, 231, 192),
    ("Ho", 0x00ff9c, 230, 192),
    ("Er", 0x00e675, 229, 189),
    ("Tm", 0x00d452, 227, 190),
    ("Yb", 0x00bf38, 226, 187),
    ("Lu", 0x00ab24, 224, 187),
    ("Hf", 0x4dc2ff, 223, 175),
    ("Ta", 0x4da6ff, 222, 170),
    ("W", 0x2194d6, 218, 162),
    ("Re", 0x267dab, 216, 151),
    ("Os", 0x266696, 216, 144),
    ("Ir", 0x175487, 213, 141),
    ("Pt", 0xd0d0e0, 213, 136),
    ("Au", 0xffd123, 214, 136),
    ("Hg", 0xb8b8d0, 223, 132),
    ("Tl", 0xa6544d, 196, 145),
    ("Pb", 0x575961, 202, 146),
    ("Bi", 0x9e4fb5, 207, 148),
    ("Po", 0xab5c00, 197, 140),
    ("At", 0x754f45, 202, 150),
    ("Rn", 0x428296, 220, 150),
    ("Fr", 0x420066, 348, 260),
    ("Ra", 0x007d00, 283, 221),
    ("Ac", 0x70abfa, 247, 215),
    ("Th", 0x00baff, 245, 206),
    ("Pa", 0x00a1ff, 243, 200),
    ("U", 0x008fff, 241, 196),
    ("Np", 0x0080ff, 239, 190),
    ("Pu", 0x006bff, 243, 187),
    ("Am", 0x545cf2, 244, 180),
    ("Cm", 0x785ce3, 245, 169),
    ("Bk", 0x8a4fe3, 244, 0),
    ("Cf", 0xa136d4, 245, 0),
    ("Es", 0xb31fd4, 245, 0),
    ("Fm", 0xb31fba, 245, 0),
    ("Md", 0xb30da6, 246, 0),
    ("No", 0xbd0d87, 246, 0),
    ("Lr", 0xc70066, 246, 0),
    ("Rf", 0xcc0059, 0, 0),
    ("Db", 0xd1004f, 0, 0),
    ("Sg", 0xd90045, 0, 0),
    ("Bh", 0xe00038, 0, 0),
    ("Hs", 0xe6002e, 0, 0),
    ("Mt", 0xeb0026, 0, 0),
    ("Ds", 0xeb0026, 0, 0),
    ("Rg", 0xeb0026, 0, 0),
    ("Cn", 0xeb0026, 0, 0),
    ("Nh", 0xeb0026, 0, 0),
    ("Fl", 0xeb0026, 0, 0),
    ("Mc", 0xeb0026, 0, 0),
    ("Lv", 0xeb0026, 0, 0),
    ("Ts", 0xeb0026, 0, 0),
    ("Og", 0xeb0026, 0, 0),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_symbol_has_its_number() {
        for (index, element) in ELEMENTS.iter().enumerate() {
            let expected = Some(index as u8 + 1);
            assert_eq!(number(element.0.as_bytes()), expected);
            assert_eq!(number(element.0.to_lowercase().as_bytes()), expected);
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
        ] {
            assert_eq!(suggestion(text), expected, "{text}");
        }
    }
}
