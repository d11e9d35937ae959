//! Which directions above a part of a surface are hidden, on a grid.
//!
//! Directions are projected from the one straight down onto the plane of the surface: caps become discs. The cells of a grid
//! are hidden if one cap hides all of their directions, or if they lie below the horizon. So what lies behind *several* caps
//! is known to be hidden, but for a margin of cells along their circles.

use glam::{DVec2, DVec3};

use super::cap::{Cap, Frame};

/// Cells along a row: the bits of a number.
const SIDE: usize = 64;

/// Rows, and how many times as tall as wide a cell is. A row takes more time than cells do.
const ROWS: usize = 32;
const TALL: f64 = (SIDE / ROWS) as f64;

/// Caps whose angles have smaller sines fill hardly a cell.
pub(crate) const NARROWEST: f64 = 1.5 / SIDE as f64;

/// What rounding may move a circle by.
const SLACK: f64 = 1e-9;

/// The directions above a part of a surface.
#[derive(Clone, Debug)]
pub(crate) struct Hemisphere {
    frame: Frame,
    normal: DVec3,
    /// Half of the grid's side.
    reach: f64,
    /// The cells that are hidden, as bits of a row.
    rows: [u64; ROWS],
}

/// A disc of the grid, in widths of cells.
#[derive(Clone, Copy, Debug)]
struct Disc {
    center: DVec2,
    radius: f64,
}

/// The bits of a row from the cell of a place to before that of another.
fn bits(from: f64, to: f64) -> u64 {
    let side = SIDE as f64;
    let (from, to) = (from.clamp(0.0, side) as u32, to.clamp(0.0, side) as u32);
    if from >= to {
        return 0;
    }
    (u64::MAX >> (SIDE as u32 - (to - from))) << from
}

impl Hemisphere {
    /// The directions above all surfaces whose normals are within an angle of one, of which nothing is hidden.
    pub(crate) fn new(normal: DVec3, turn: f64) -> Self {
        /// Normals that turn by more are taken to turn by this angle: more is hidden then than is said.
        const MOST: f64 = 1.2;
        // The directions of a sine above −sin(turn) lie in a disc of this radius.
        let reach = libm::tan(std::f64::consts::FRAC_PI_4 + 0.5 * turn.min(MOST)) * (1.0 + SLACK);
        let mut hemisphere = Self {
            frame: Cap::below(-normal).frame(),
            normal,
            reach,
            rows: [0; ROWS],
        };
        if turn < MOST {
            let middle = 0.5 * SIDE as f64;
            let above = Disc {
                center: DVec2::splat(middle),
                radius: middle,
            };
            for (row, open) in hemisphere.rows.iter_mut().enumerate() {
                *open = !above.touched(row);
            }
        }
        hemisphere
    }

    /// The disc of a cap that is made wider, or narrower, by an angle that rounding may cause; none if it is too wide.
    fn disc(&self, cap: &Cap, slack: f64) -> Option<Disc> {
        let height = self.normal.dot(cap.axis) + cap.cosine;
        // A larger cap might hold the direction straight down.
        if height < 1e-2 {
            return None;
        }
        let cells = 0.5 * SIDE as f64 / self.reach;
        let toward = DVec2::new(cap.axis.dot(self.frame.x), cap.axis.dot(self.frame.y));
        let center = (toward / height + self.reach) * cells;
        let radius = cap.sine / height * cells + slack * (1.0 + center.length()) / height;
        Some(Disc { center, radius })
    }

    /// Hides the directions within a cap.
    pub(crate) fn hide(&mut self, cap: &Cap) {
        // Those that are smaller than the circle through the corners of a cell fill none.
        if let Some(disc) = self.disc(cap, -SLACK)
            && 4.0 * disc.radius * disc.radius > 1.0 + TALL * TALL
        {
            for row in disc.rows() {
                self.rows[row] |= disc.filled(row);
            }
        }
    }

    /// True if all directions within a cap are hidden.
    pub(crate) fn is_hidden(&self, cap: &Cap) -> bool {
        let Some(disc) = self.disc(cap, SLACK) else {
            return false;
        };
        let is_hidden = |row: usize| disc.touched(row) & !self.rows[row] == 0;
        // Most caps that are seen are seen in the middle.
        let middle = disc.center.y.clamp(0.0, SIDE as f64 - 1.0) / TALL;
        is_hidden(middle as usize) && disc.rows().all(is_hidden)
    }
}

impl Disc {
    /// The rows that it may touch.
    fn rows(&self) -> std::ops::Range<usize> {
        let last = ROWS as f64;
        let low = ((self.center.y - self.radius) / TALL).clamp(0.0, last);
        let high = ((self.center.y + self.radius) / TALL + 1.0).clamp(0.0, last);
        low as usize..high as usize
    }

    /// Half of its width at a distance from its center.
    fn half(&self, apart: f64) -> Option<f64> {
        let square = self.radius * self.radius - apart * apart;
        (square >= 0.0).then(|| square.sqrt())
    }

    /// The cells of a row that it may touch.
    fn touched(&self, row: usize) -> u64 {
        let low = row as f64 * TALL - self.center.y;
        let apart = low.max(-TALL - low).max(0.0);
        match self.half(apart) {
            Some(half) => bits(self.center.x - half, self.center.x + half + 1.0),
            None => 0,
        }
    }

    /// The cells of a row that lie inside of it.
    fn filled(&self, row: usize) -> u64 {
        let low = row as f64 * TALL - self.center.y;
        let apart = low.abs().max((low + TALL).abs());
        match self.half(apart) {
            Some(half) => bits(self.center.x - half + 1.0, self.center.x + half),
            None => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_directions_of_a_hidden_cap_are_hidden() {
        let mut state = 3_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
        };
        let (mut hidden, mut seen) = (0, 0);
        for _ in 0..200 {
            let mut vector = || DVec3::new(next(), next(), next()).normalize();
            let normal = vector();
            let caps: Vec<(DVec3, DVec3)> = (0..14).map(|_| (vector(), vector())).collect();
            let caps = caps
                .into_iter()
                .map(|(axis, size)| Cap::within(axis, 0.7 * size.x.abs()));
            let caps: Vec<Cap> = caps.collect();
            let turn = 0.3 * vector().x.abs();
            let mut hemisphere = Hemisphere::new(normal, turn);
            caps.iter().for_each(|cap| hemisphere.hide(cap));
            for _ in 0..40 {
                let cap = Cap::within(vector(), 0.2 * vector().x.abs());
                let frame = cap.frame();
                let directions = (0..60).map(|index| {
                    let (sine, cosine) = libm::sincos(f64::from(index));
                    let part = libm::sqrt(f64::from(index) / 59.0);
                    let turned = (frame.x * cosine + frame.y * sine) * part * cap.sine;
                    cap.axis * (1.0 - turned.length_squared()).sqrt() + turned
                });
                let is_hidden = |direction: DVec3| {
                    direction.dot(normal) < -libm::sin(turn)
                        || caps.iter().any(|cap| direction.dot(cap.axis) >= cap.cosine)
                };
                if hemisphere.is_hidden(&cap) {
                    hidden += 1;
                    assert!(directions.into_iter().all(is_hidden), "{cap:?}");
                } else {
                    seen += 1;
                }
            }
        }
        assert!(hidden > 500 && seen > 500, "{hidden} {seen}");
    }
}
