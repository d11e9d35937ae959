//! Names that spheres share.

use std::collections::HashMap;

/// The categories of spheres, by their indices among the names.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Categories {
    pub(crate) names: Vec<String>,
    pub(crate) indices: Vec<u32>,
    known: HashMap<Box<[u8]>, u32>,
}

impl Categories {
    /// The most names.
    pub(crate) const MOST: usize = 1 << 16;

    /// The index of a name; `None` where there are too many.
    pub(crate) fn index(&mut self, name: &[u8]) -> Option<u32> {
        if let Some(index) = self.known.get(name) {
            return Some(*index);
        }
        if self.names.len() == Self::MOST {
            return None;
        }
        let index = self.names.len() as u32;
        self.names.push(String::from_utf8_lossy(name).into_owned());
        self.known.insert(name.into(), index);
        Some(index)
    }

    /// Adds others behind these; returns whether there are too many names.
    pub(super) fn append(&mut self, others: Self) -> bool {
        let names: Vec<Option<u32>> = others
            .names
            .iter()
            .map(|name| self.index(name.as_bytes()))
            .collect();
        let of = |index: &u32| names[*index as usize].unwrap_or(0);
        self.indices.extend(others.indices.iter().map(of));
        names.contains(&None)
    }
}
