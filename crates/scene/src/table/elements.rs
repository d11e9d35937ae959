//! The elements of a table's rows: what radii, colors, categories and conditions all go by.

use super::element::{self, Radii};
use super::request::Request;

/// The most names that are no elements and have colors of their own.
const MOST_NAMES: usize = 256 - OWN_COLORS as usize;
/// The first color of such names, behind that of others and those of the elements.
const OWN_COLORS: u8 = 119;

/// The name of what is no element.
pub(crate) const OTHERS: &str = "others";

/// The element of a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Atom<'a> {
    /// The atomic number, 0 where there is none.
    pub(crate) number: u8,
    /// The text that tells it, or that tells none.
    pub(crate) label: &'a [u8],
}

impl Atom<'_> {
    /// No atom.
    pub(crate) const NONE: Self = Self {
        number: 0,
        label: b"",
    };
}

/// The radii and colors of elements, and those that the scene gives to single names.
#[derive(Clone, Debug)]
pub(crate) struct Elements {
    kind: Radii,
    own_radii: Vec<Own<f64>>,
    own_colors: Vec<Own<u8>>,
    /// The radius of what is no element.
    other_radius: f64,
}

/// A value that a scene gives to a name.
#[derive(Clone, Debug)]
struct Own<T> {
    name: Box<[u8]>,
    /// The element that is meant, unless it is a name of the table alone.
    number: Option<u8>,
    value: T,
}

impl<T> Own<T> {
    fn new(name: &str, value: T) -> Self {
        Self {
            name: name.as_bytes().into(),
            number: element::of_plain_symbol(name.as_bytes()),
            value,
        }
    }

    /// Says whether this is given to an atom.
    fn is_of(&self, atom: Atom<'_>) -> bool {
        match self.number {
            Some(number) => number == atom.number,
            None => *self.name == *atom.label,
        }
    }
}

/// The radius of an atom, and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum AtomRadius {
    /// From the table of elements.
    Known(f64),
    /// The scene gives it to the name at this place of those that it lists.
    Own(f64, usize),
    /// That of others.
    Other(f64),
}

impl Elements {
    pub(crate) fn new(request: &Request) -> Self {
        let own_radii = request.own_radii.iter();
        // Elements have their places among the colors, other names get some behind them.
        let names = request.palette.iter();
        let names = names.filter(|name| element::of_plain_symbol(name.as_bytes()).is_none());
        Self {
            kind: request.radii,
            own_radii: own_radii
                .map(|(name, radius)| Own::new(name, *radius))
                .collect(),
            own_colors: (OWN_COLORS..=u8::MAX)
                .zip(names)
                .map(|(color, name)| Own::new(name, color))
                .collect(),
            other_radius: request.other_radius.unwrap_or(1.0),
        }
    }

    /// Refuses more names that are no elements than there are colors.
    pub(crate) fn check(&self, request: &Request) -> Result<(), String> {
        let names = request.palette.iter();
        let names = names.filter(|name| element::of_plain_symbol(name.as_bytes()).is_none());
        match names.count() {
            count if count > MOST_NAMES => Err(format!(
                "expected at most {MOST_NAMES} names in `palette` that are not elements, found {count}"
            )),
            _ => Ok(()),
        }
    }

    /// The number of radii that the scene gives to names.
    pub(crate) fn own_radii(&self) -> usize {
        self.own_radii.len()
    }

    /// The radius of an atom, in ångströms.
    #[inline]
    pub(crate) fn radius(&self, atom: Atom<'_>) -> AtomRadius {
        let own = self.own_radii.iter().position(|own| own.is_of(atom));
        if let Some(place) = own {
            return AtomRadius::Own(self.own_radii[place].value, place);
        }
        match element::radius(atom.number, self.kind) {
            Some(radius) => AtomRadius::Known(radius),
            None => AtomRadius::Other(self.other_radius),
        }
    }

    /// The color of an atom: its atomic number, 0 for others, or one behind those of the elements.
    #[inline]
    pub(crate) fn color(&self, atom: Atom<'_>) -> u8 {
        let mut own = self.own_colors.iter();
        own.find(|own| own.is_of(atom))
            .map_or(atom.number, |own| own.value)
    }

    /// The name of an atom as a category: the symbol of its element, or else what the table calls it.
    #[inline]
    pub(crate) fn name<'a>(&self, atom: Atom<'a>) -> &'a [u8] {
        element::symbol(atom.number).map_or(atom.label, str::as_bytes)
    }

    /// Says whether an atom is one that a condition calls so: an element by its symbol, or else a name of the table.
    #[inline]
    pub(crate) fn is_called(&self, atom: Atom<'_>, wanted: &str) -> bool {
        match element::of_plain_symbol(wanted.as_bytes()) {
            Some(number) => number == atom.number,
            None => wanted.as_bytes() == atom.label,
        }
    }
}

/// The names of the colors of atoms: others, the elements, and what the scene gives colors to beside them.
pub(crate) fn color_names(palette: &[String]) -> Vec<String> {
    let mut names = vec![OTHERS.to_owned()];
    let symbols = (1..OWN_COLORS).filter_map(element::symbol);
    names.extend(symbols.map(str::to_owned));
    let is_own = |name: &&String| element::of_plain_symbol(name.as_bytes()).is_none();
    names.extend(palette.iter().filter(is_own).take(MOST_NAMES).cloned());
    names
}
