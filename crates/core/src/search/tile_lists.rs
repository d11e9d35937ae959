//! Lists of what may be seen in each tile.

use super::frustum::TileRange;

/// For every tile the places, in rising order, of the ranges that cover it.
#[derive(Clone, Debug)]
pub(super) struct TileLists {
    columns: u32,
    /// The start of the list of each tile in `places`; one more for the end.
    starts: Vec<u32>,
    places: Vec<u32>,
    /// For each row of tiles the ranges that are too large to be listed in every tile.
    wide: Vec<Vec<(u32, TileRange)>>,
}

impl TileLists {
    /// The lists for a picture of `columns` by `rows` tiles.
    pub(super) fn new<Ranges: Iterator<Item = TileRange>>(
        columns: u32,
        rows: u32,
        ranges: impl Fn() -> Ranges,
    ) -> Self {
        let widest = widest_listed(ranges());
        let is_listed = |range: &TileRange| size_class(range) <= widest;
        // First how many, one tile further on; then where each list ends, by counting up.
        let mut starts = vec![0_u32; columns as usize * rows as usize + 2];
        for range in ranges().filter(is_listed) {
            for row in range.rows.0..=range.rows.1 {
                let first = row as usize * columns as usize + 2;
                let (from, to) = range.columns;
                for count in &mut starts[first + from as usize..=first + to as usize] {
                    *count += 1;
                }
            }
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut places = vec![0; sum as usize];
        let mut wide = vec![Vec::new(); rows as usize];
        for (place, range) in ranges().enumerate() {
            let place = place as u32;
            for row in range.rows.0..=range.rows.1 {
                if !is_listed(&range) {
                    wide[row as usize].push((place, range));
                    continue;
                }
                let first = row as usize * columns as usize + 1;
                let (from, to) = range.columns;
                for next in &mut starts[first + from as usize..=first + to as usize] {
                    places[*next as usize] = place;
                    *next += 1;
                }
            }
        }
        Self {
            columns,
            starts,
            places,
            wide,
        }
    }

    /// The memory that they take, in bytes.
    pub(super) fn bytes(&self) -> usize {
        let wide = self.wide.iter().map(|row| size_of_val(&row[..]));
        let listed = self.starts.len() + self.places.len();
        listed * size_of::<u32>() + size_of_val(&self.wide[..]) + wide.sum::<usize>()
    }

    /// The places of the ranges that cover a tile, in rising order.
    #[inline]
    pub(super) fn at(&self, column: u32, row: u32) -> Places<'_> {
        let tile = row as usize * self.columns as usize + column as usize;
        let (start, end) = (self.starts[tile] as usize, self.starts[tile + 1] as usize);
        Places {
            column,
            listed: &self.places[start..end],
            wide: &self.wide[row as usize],
        }
    }
}

/// Places in rising order: those listed for a tile, and those of wide ranges that cover it.
#[derive(Clone, Debug)]
pub(crate) struct Places<'lists> {
    column: u32,
    listed: &'lists [u32],
    wide: &'lists [(u32, TileRange)],
}

impl Places<'_> {
    /// Returns whether they are more than so many.
    pub(super) fn are_more_than(&self, most: usize) -> bool {
        let has_wide = !self.wide.is_empty();
        self.listed.len() > most || has_wide && self.clone().nth(most).is_some()
    }
}

impl Iterator for Places<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        while let Some((&(place, range), rest)) = self.wide.split_first() {
            let is_here = range.columns.0 <= self.column && self.column <= range.columns.1;
            if is_here && self.listed.first().is_some_and(|&listed| listed < place) {
                break;
            }
            self.wide = rest;
            if is_here {
                return Some(place);
            }
        }
        let (&place, rest) = self.listed.split_first()?;
        self.listed = rest;
        Some(place)
    }
}

/// The binary logarithm of a range's number of tiles.
fn size_class(range: &TileRange) -> usize {
    range.count().ilog2() as usize
}

/// The class of the largest ranges that are listed in every tile: memory is to stay within a
/// small multiple of what the ranges themselves take.
fn widest_listed(ranges: impl Iterator<Item = TileRange>) -> usize {
    /// Entries that are always listed: 16 MiB. Not tuned: wide ranges cost each tile of their rows a
    /// look.
    const ALWAYS: u64 = 1 << 22;
    /// Entries for each range: as much memory as it takes itself.
    const PER_RANGE: u64 = 4;
    let mut entries = [0_u64; u64::BITS as usize];
    let mut most = ALWAYS;
    for range in ranges {
        entries[size_class(&range)] += range.count();
        most += PER_RANGE;
    }
    // Ranges of one tile are always listed.
    let (mut widest, mut sum) = (0, entries[0]);
    for (class, entries) in entries.iter().enumerate().skip(1) {
        sum += entries;
        if sum > most {
            break;
        }
        widest = class;
    }
    widest
}
