//! Outlines: what a cell sees of spheres inside of them, and beside that.

use super::contents::{Contents, Kind, NARROWEST, silhouette_width};
use super::face::Face;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::exact::scene::InCamera;
use crate::numeric::rounding::GEOMETRY_SLACK;

impl Contents {
    /// Finds the outlines of the active spheres, and their edges.
    pub(super) fn add_outlines(&mut self, scene: &InCamera<'_>, cell: &Cell) {
        self.faces.clear();
        if !scene.has_outlines() {
            return;
        }
        let mut has_outlines = false;
        for position in 0..self.active.len() {
            let active = &self.active[position];
            let face = face(scene, cell, (active.sphere, &active.ball));
            has_outlines |= !matches!(face, Face::All);
            if let Face::Inside(_, conic) = &face {
                self.conics.push((Kind::Outline(position), *conic));
            }
            self.faces.push(face);
        }
        if !has_outlines {
            self.faces.clear();
        }
    }

    /// Whether some of what is seen are outlines.
    pub(crate) fn has_outlines(&self) -> bool {
        !self.faces.is_empty()
    }

    /// The visible part of an active sphere inside of its outline.
    #[inline]
    pub(crate) fn face(&self, position: usize) -> &Face {
        self.faces.get(position).unwrap_or(&Face::All)
    }
}

/// The part of a sphere inside of its outline that a cell sees.
fn face(scene: &InCamera<'_>, cell: &Cell, (sphere, ball): (usize, &Ball)) -> Face {
    let Some(inside) = scene.inside_outline(sphere, ball) else {
        return Face::All;
    };
    let size = cell.size[0].min(cell.size[1]);
    if silhouette_width(&inside) < NARROWEST * size {
        return Face::Nothing;
    }
    let conic = silhouette(cell, &inside);
    let spread = conic.spread();
    let slack = GEOMETRY_SLACK * (spread + conic.one.abs());
    if conic.one + spread + slack < 0.0 {
        Face::Nothing
    } else if conic.one - spread - slack > 0.0 {
        Face::All
    } else {
        Face::Inside(inside, conic)
    }
}
