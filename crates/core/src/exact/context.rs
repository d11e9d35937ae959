//! The view and the tolerance that pixels are integrated with.

use fearless_simd::Simd;

use super::budget::Allowance;
use super::crowd::UnitsOfTile;
use super::part::Part;
use super::scene::{InCamera, Light};
use super::surface::Finish;
use crate::edges::cell::Cell;
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;
use crate::picture::pixel::{Evidence, Pixel, Status};
use crate::picture::tile::Tile;

/// The share of the tolerance below which light does not count. Not tuned.
pub(crate) const NEGLIGIBLE: f64 = 0.01;

/// The sides of a pixel on the retina at distance 1; for parallel rays at any.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides {
    pub(crate) width: f64,
    /// The height over the width. It multiplies what is then multiplied by the width: if it is 1, as for square pixels,
    /// nothing is rounded for it.
    pub(crate) height_by_width: f64,
}

impl Sides {
    /// Width and height.
    #[inline(always)]
    pub(crate) fn both(&self) -> [f64; 2] {
        [self.width, self.width * self.height_by_width]
    }

    #[inline(always)]
    pub(crate) fn shorter(&self) -> f64 {
        self.width * self.height_by_width.min(1.0)
    }

    #[inline(always)]
    pub(crate) fn longer(&self) -> f64 {
        self.width * self.height_by_width.max(1.0)
    }

    /// Half of the diagonal.
    #[inline(always)]
    pub(crate) fn half_diagonal(&self) -> f64 {
        let ratio = self.height_by_width;
        self.width * (0.5 * (1.0 + ratio * ratio).sqrt())
    }
}

/// A view of a scene, and how exactly its pixels are asked for.
#[derive(Clone, Debug)]
pub(crate) struct Context<'scene> {
    pub(crate) scene: InCamera<'scene>,
    pub(crate) view: View,
    /// The error that a pixel may have under the lights of one group.
    pub(crate) tolerance: f64,
    /// Whether errors are to be proved where that is possible. A proof claims more than an estimate, which
    /// averages over time have to make up for.
    pub(crate) is_proved: bool,
    /// Whether pixels have an alpha channel.
    pub(crate) has_alpha: bool,
    /// The light that an error of the covered area counts as, in units: 1 where the area is what is asked for. In pictures
    /// without alpha light alone counts, which edges change by about as much.
    pub(crate) of_coverage: f64,
    /// The light of pixels that see no sphere.
    pub(crate) background: Color,
    /// About the largest difference of light that an edge may make, highlights left out.
    pub(crate) contrast: f64,
    pub(crate) allowance: Allowance,
    /// The units that the crowds of a tile may cost.
    pub(crate) of_crowds: UnitsOfTile,
    /// The scene whose light is its normals, if this one has a single light, which is directional. Plain surfaces send the
    /// product of their mean normal and its direction: pictures of the same view under other lights share the former.
    pub(crate) normals: Option<InCamera<'scene>>,
}

impl Context<'_> {
    /// The cell that covers some pixels.
    pub(crate) fn cell(&self, tile: Tile) -> Cell {
        let distance = self.view.magnification();
        let pixel = self.view.pixel_size() / distance;
        let center = |col: u32, row: u32| {
            self.view.cell_center(u64::from(col), u64::from(row), 1) / distance
        };
        let first = center(tile.col, tile.row);
        let last = center(tile.col + tile.width - 1, tile.row + tile.height - 1);
        Cell {
            middle: (0.5 * (first + last)).extend(1.0),
            size: [
                pixel.x * f64::from(tile.width),
                pixel.y * f64::from(tile.height),
            ],
            projection: self.scene.projection,
        }
    }

    /// The scene whose light is its normals, and the only light, where what a surface sends is the product of both.
    pub(crate) fn normals_on(&self, finish: &Finish) -> Option<(&InCamera<'_>, &Light)> {
        let normals = self.normals.as_ref().filter(|_| finish.is_plain())?;
        Some((normals, self.scene.single_light()?))
    }

    /// The tolerance of mean normals, of which light differs by no more than `contrast`. That counts as rounded up to
    /// three binary digits: lights that are about as bright have the mean normals in common.
    pub(crate) fn tolerance_of_normals(&self, contrast: f64) -> f64 {
        /// Below this contrast counts as this.
        const LEAST: f64 = 0.25;
        /// The bits of a double's fraction behind the first two.
        const REST: u64 = (1 << (f64::MANTISSA_DIGITS - 3)) - 1;
        let contrast = contrast.max(LEAST);
        let rounded = f64::from_bits((contrast.to_bits() + REST) & !REST);
        self.tolerance / rounded
    }

    /// A pixel that sees no sphere.
    pub(crate) fn empty_pixel(&self) -> Pixel {
        Pixel {
            value: self.background,
            alpha: 0.0,
            error: 0.0,
            evidence: Evidence::Bound,
            status: Status::Met,
        }
    }

    /// The pixel with this integral.
    pub(crate) fn pixel_of(&self, part: &Part) -> Pixel {
        let error = part.error;
        Pixel {
            value: self.scene.spread(part.value),
            alpha: part.covered,
            error,
            evidence: Evidence::Estimate,
            status: if error <= self.tolerance {
                Status::Met
            } else if part.rounding > 0.5 * error {
                Status::AtRoundoff
            } else {
                Status::OutOfBudget
            },
        }
    }

    /// The key of the pixel that lies `lane` columns to the right of a tile's first.
    pub(crate) fn key(&self, start: Tile, lane: u32) -> PixelKey {
        PixelKey {
            col: start.col + lane,
            row: start.row,
            frame: self.view.frame,
        }
    }

    /// The rays through the middles of eight pixels of a row, and the sides of a pixel.
    #[inline(always)]
    pub(crate) fn rays<S: Simd>(&self, simd: S, start: Tile) -> (Vectors<S>, Sides) {
        let cell = self.cell(start);
        let distance = self.view.magnification();
        let mut u = [0.0; 8];
        for (lane, u) in u.iter_mut().enumerate() {
            let col = u64::from(start.col) + lane as u64;
            *u = self.view.cell_center(col, u64::from(start.row), 1).x / distance;
        }
        let ray = Vectors {
            x: f64x8::from_array(simd, u),
            ..Vectors::splat(simd, cell.middle)
        };
        let [width, height] = cell.size;
        let sides = Sides {
            width,
            height_by_width: height / width,
        };
        (ray, sides)
    }
}
