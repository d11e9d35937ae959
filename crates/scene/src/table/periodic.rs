//! The cells that a scene shows of a periodic table: repeats, and spheres that are moved or shown at several faces.

use glam::DVec3;
use marbles_core::{Sphere, parallel};

use super::cell::Cell;
use super::error::TableError;
use super::paint::Paint;
use super::request::Periodic;
use super::rows::Rows;

/// The distance from a face at which a sphere lies on it, as a share of the edge that leads to the face.
const ON_FACE: f64 = 1e-3;
/// The same from the lower face of a cell, within which rounding has moved a center out of it.
const ROUNDED: f64 = 1e-7;
/// The most spheres of a table: they are numbered with 32 bits.
const MOST_SPHERES: u64 = u32::MAX as u64 - 1;

impl Periodic {
    /// Moves the spheres of a table into its cell, and repeats them.
    ///
    /// # Errors
    /// Refuses a table without a cell, a cell without a volume, and more spheres than a scene or the memory may hold.
    pub(super) fn apply(self, rows: &mut Rows) -> Result<(), TableError> {
        let Some(field) = self.field() else {
            return Ok(());
        };
        let cell = match &rows.cell {
            Some(Ok(cell)) => *cell,
            Some(Err(fault)) => return Err(fault.clone().into()),
            None => return Err(TableError::NoCell(field)),
        };
        if self.wraps {
            wrap(&mut rows.spheres, &cell)?;
        }
        if self.is_repeated() || self.shows_edges {
            let faces = match self.shows_edges {
                true => rows
                    .spheres
                    .iter()
                    .map(|sphere| Faces::of(sphere, &cell))
                    .collect(),
                false => Vec::new(),
            };
            self.add_images(rows, &cell, &faces)?;
        }
        Ok(())
    }

    /// Adds the images of all spheres behind those that there are, whose faces are given if they matter.
    fn add_images(self, rows: &mut Rows, cell: &Cell, faces: &[Faces]) -> Result<(), TableError> {
        let count = rows.spheres.len();
        if count == 0 {
            // Any number of repeats shows nothing.
            return Ok(());
        }
        let total = match self.shows_edges {
            true => faces.iter().map(|faces| self.images(*faces)).sum(),
            false => count as u128 * self.images(Faces::default()),
        };
        if total > u128::from(MOST_SPHERES) {
            let [a, b, c] = self.repeat;
            return Err(TableError::InScene(format!(
                "expected at most {MOST_SPHERES} spheres, found {total} (`repeat: ({a}, {b}, {c})` of {count})"
            )));
        }
        rows.reserve(total as u64 - count as u64)?;
        let reach = |axis: usize| {
            let beyond = i64::from(self.shows_edges && cell.is_periodic[axis]);
            -beyond..i64::from(self.repeat[axis]) + beyond
        };
        let mut places = Vec::new();
        for i in reach(0) {
            for j in reach(1) {
                for k in reach(2) {
                    let image = [i, j, k];
                    if image == [0; 3] {
                        continue;
                    }
                    if !self.shows_edges || self.is_in_block(image) {
                        copy(rows, cell, image, 0..count)?;
                        continue;
                    }
                    let is_shown = |place: &usize| self.shows(faces[*place], image);
                    places.clear();
                    places.extend((0..count).filter(is_shown));
                    copy(rows, cell, image, places.iter().copied())?;
                }
            }
        }
        Ok(())
    }

    /// The number of images of a sphere on these faces, itself among them.
    fn images(self, faces: Faces) -> u128 {
        let along = |axis: usize| {
            let [low, high] = faces.0[axis];
            u128::from(self.repeat[axis]) + u128::from(low) + u128::from(high)
        };
        (0..3).map(along).product()
    }

    fn is_in_block(self, image: [i64; 3]) -> bool {
        let mut axes = image.iter().zip(self.repeat);
        axes.all(|(at, count)| (0..i64::from(count)).contains(at))
    }

    /// Says whether a sphere on these faces has this image.
    fn shows(self, faces: Faces, image: [i64; 3]) -> bool {
        let mut axes = image.iter().zip(self.repeat).zip(faces.0);
        axes.all(|((at, count), [low, high])| match *at {
            -1 => high,
            at if at == i64::from(count) => low,
            _ => true,
        })
    }
}

/// The faces of the cell on which a sphere lies, along each edge: the lower and the upper one.
#[derive(Clone, Copy, Debug, Default)]
struct Faces([[bool; 2]; 3]);

impl Faces {
    fn of(sphere: &Sphere, cell: &Cell) -> Self {
        let fractions = cell.fractions(sphere.center()).to_array();
        let mut faces = Self::default();
        for (axis, along) in faces.0.iter_mut().enumerate() {
            let is_at =
                |face: f64| cell.is_periodic[axis] && (fractions[axis] - face).abs() <= ON_FACE;
            *along = [is_at(0.0), is_at(1.0)];
        }
        faces
    }
}

/// Moves every center into the cell, along the edges along which it repeats.
fn wrap(spheres: &mut [Sphere], cell: &Cell) -> Result<(), TableError> {
    let moved = |sphere: &mut Sphere| {
        let mut cells = whole_cells(cell.fractions(sphere.center())).to_array();
        for (cells, is_periodic) in cells.iter_mut().zip(cell.is_periodic) {
            if !is_periodic {
                *cells = 0.0;
            }
        }
        let center = sphere.center() - cell.edges * DVec3::from_array(cells);
        let moved = Sphere::new(center, sphere.radius());
        moved.map(|moved| *sphere = moved).is_ok()
    };
    match parallel::change_all(spheres, |_, sphere| moved(sphere)) {
        true => Ok(()),
        false => Err(not_finite()),
    }
}

/// The cells by which a point with these fractions is outside of the cell.
pub(super) fn whole_cells(fractions: DVec3) -> DVec3 {
    (fractions + ROUNDED).floor()
}

/// Adds the images of these spheres, so many cells away.
fn copy(
    rows: &mut Rows,
    cell: &Cell,
    image: [i64; 3],
    places: impl Iterator<Item = usize> + Clone,
) -> Result<(), TableError> {
    let shift = cell.edges * DVec3::from_array(image.map(|cells| cells as f64));
    for place in places.clone() {
        let sphere = rows.spheres[place];
        let image = Sphere::new(sphere.center() + shift, sphere.radius());
        rows.spheres.push(image.map_err(|_| not_finite())?);
    }
    rows.paint.copy(places);
    Ok(())
}

fn not_finite() -> TableError {
    let message = "expected finite centers of the spheres in other cells, found an infinite one";
    TableError::InScene(message.to_owned())
}

impl Paint {
    /// Adds the colors of the spheres at these places once more.
    pub(super) fn copy(&mut self, places: impl Iterator<Item = usize>) {
        fn more<T: Copy>(values: &mut Vec<T>, places: impl Iterator<Item = usize>) {
            for place in places {
                values.push(values[place]);
            }
        }
        match self {
            Self::Material | Self::Distinct(_) | Self::Contents(_) => {}
            Self::Colors(colors) => more(colors, places),
            Self::Elements(numbers) => more(numbers, places),
            Self::Values(values) => more(values, places),
            Self::Categories(categories) => more(&mut categories.indices, places),
        }
    }
}
