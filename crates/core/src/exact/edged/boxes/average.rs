//! The average light of eight boxes of a cell.

use fearless_simd::Simd;

use super::contours::{Contours, Visible};
use super::eight_boxes::{Eight, EightBoxes};
use super::half_vectors::Views;
use super::lights::Lit;
use super::normals::Normals;
use super::orders::Orders;
use super::outlines::Line;
use super::region::{OF_AMBIGUITY, Region, Share};
use super::sum::Sum;
use super::surroundings::Surroundings;
use crate::edges::cell::Cell;
use crate::exact::classify::contents::Contents;
use crate::exact::classify::face::Face;
use crate::exact::classify::reach::Reach;
use crate::exact::part::Part;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::polynomial::Quadratic;

/// The data that the boxes of a cell have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a, 'scene> {
    pub(super) scene: &'a InCamera<'scene>,
    pub(super) cell: &'a Cell,
    pub(super) contents: &'a Contents,
    pub(super) background: Color,
    pub(super) has_alpha: bool,
    pub(super) finishes: &'a [Finish],
    pub(super) orders: &'a Orders,
    /// Whether the silhouettes of the active spheres lie in the cell: others fill it.
    pub(super) has_silhouette: &'a [bool],
}

/// The averages of eight boxes.
#[derive(Clone, Debug, Default)]
pub(super) struct Averages {
    pub(super) value: [Eight; 3],
    pub(super) covered: Eight,
    /// Estimates.
    pub(super) error: Eight,
    /// The points at which light was computed.
    pub(super) samples: u64,
}

impl Averages {
    /// The integral over all boxes, which have this area.
    pub(super) fn total(&self, area: f64) -> Part {
        let sum = |lanes: &Eight| lanes.iter().sum::<f64>() * area;
        let [x, y, z] = &self.value;
        Part {
            value: Color::new(sum(x), sum(y), sum(z)),
            covered: sum(&self.covered),
            error: sum(&self.error),
            rounding: 0.0,
        }
    }

    /// The average of one box.
    pub(super) fn lane(&self, lane: usize) -> Part {
        let [x, y, z] = &self.value;
        Part {
            value: Color::new(x[lane], y[lane], z[lane]),
            covered: self.covered[lane],
            error: self.error[lane],
            rounding: 0.0,
        }
    }
}

/// The result asked of eight boxes.
enum Wanted<'a> {
    /// Their averages, with noise to work with.
    Light(&'a mut Averages, &'a mut Option<Box<NoiseCells>>),
    /// For each active sphere the shares in which it is seen, and their errors.
    Areas(&'a mut Vec<[Eight; 2]>),
}

impl Setting<'_, '_> {
    /// Writes the averages of eight boxes, with memory to work in.
    #[inline(always)]
    pub(super) fn averages<S: Simd>(
        &self,
        simd: S,
        boxes: [Eight; 2],
        size: [f64; 2],
        (contours, noise): (&mut Contours, &mut Option<Box<NoiseCells>>),
        averages: &mut Averages,
    ) {
        self.find(
            simd,
            (boxes, size),
            contours,
            Wanted::Light(averages, noise),
        );
    }

    /// Writes the shares of eight boxes in which each active sphere is seen, and their errors.
    #[inline(always)]
    pub(super) fn areas<S: Simd>(
        &self,
        simd: S,
        boxes: [Eight; 2],
        size: [f64; 2],
        contours: &mut Contours,
        found: &mut Vec<[Eight; 2]>,
    ) {
        found.clear();
        found.resize(self.contents.active.len(), [[0.0; 8]; 2]);
        self.find(simd, (boxes, size), contours, Wanted::Areas(found));
    }

    /// Light and areas in one kernel: it is long, and what takes its time is the same.
    #[inline(never)]
    fn find<S: Simd>(
        &self,
        simd: S,
        ([x, y], size): ([Eight; 2], [f64; 2]),
        contours: &mut Contours,
        mut wanted: Wanted<'_>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let boxes = EightBoxes {
                    x: f64x8::from_array(simd, x),
                    y: f64x8::from_array(simd, y),
                    size,
                };
                let has_outlines =
                    matches!(wanted, Wanted::Light(..)) && self.contents.has_outlines();
                let outside = self.contours(simd, &boxes, (contours, has_outlines));
                let mut sum = Sum::nothing(simd, self.scene.channels);
                let nothing = f64x8::splat(simd, 0.0);
                // The share of the sphere whose face may follow.
                let mut whole = nothing;
                for contour in &contours.spheres {
                    let Some(mut visible) = contour.visible(simd, contours, self.orders) else {
                        whole = nothing;
                        continue;
                    };
                    match &mut wanted {
                        Wanted::Light(_, noise) => {
                            let share = visible.share.area;
                            if let Line::Beside(outlines) = contour.line {
                                let outlines = u64::from(outlines);
                                visible.is_possible &= mask64x8::from_bitmask(simd, outlines);
                            }
                            let light = self.light(simd, &boxes, (&visible, contour.line), noise);
                            sum.add(&visible, &light);
                            if contour.line.is_face() {
                                let color = self.outline_color(visible.position);
                                sum.take_from_outline(&visible, whole, color);
                            }
                            whole = share;
                        }
                        Wanted::Areas(found) => {
                            found[visible.position] = visible.share_and_error();
                            sum.seen += visible.share.area;
                        }
                    }
                }
                let left = outside.share(simd);
                match wanted {
                    Wanted::Light(averages, _) => {
                        let is_open = outside.most.simd_gt(0.0);
                        *averages = self.with_background(simd, &mut sum, &left, is_open);
                    }
                    Wanted::Areas(found) => sum.fill_areas(simd, &left, found),
                }
            },
        );
    }

    fn outline_color(&self, position: usize) -> Color {
        let sphere = self.contents.active[position].sphere;
        self.scene.outline_color(sphere)
    }

    /// The averages of what is seen and of what is left of boxes beside it.
    #[inline(always)]
    fn with_background<S: Simd>(
        &self,
        simd: S,
        sum: &mut Sum<S>,
        left: &Share<S>,
        is_open: mask64x8<S>,
    ) -> Averages {
        let one = f64x8::splat(simd, 1.0);
        let open = left.area;
        // What no sphere was found to fill may belong to any of them.
        sum.doubt += (one - open - sum.seen).abs();
        sum.fill(simd, one - open);
        sum.ambiguity += left.ambiguity;
        let background = Lit::ambient(simd, self.background, open);
        for (value, of_light) in sum.value.iter_mut().zip(&background.value) {
            *value += *of_light;
        }
        sum.add_range(&background, is_open);
        let mut contrast = sum.contrast(simd);
        if self.has_alpha {
            contrast = (sum.is_covered & is_open).select(contrast.max(one), contrast);
        }
        let error = sum.error + contrast * (sum.ambiguity * OF_AMBIGUITY + sum.doubt);
        let [x, y, z] = sum.value;
        Averages {
            value: [x.into(), y.into(), z.into()],
            covered: (one - open).into(),
            error: error.into(),
            samples: sum.samples,
        }
    }

    /// Finds the contours of the spheres that boxes may see; what is outside of all of them.
    #[inline(always)]
    fn contours<S: Simd>(
        &self,
        simd: S,
        boxes: &EightBoxes<S>,
        (contours, has_outlines): (&mut Contours, bool),
    ) -> Region<S> {
        contours.clear();
        let mut outside = Region::whole(simd);
        for (position, active) in self.contents.active.iter().enumerate() {
            let has_depth = self.orders.needs_depth(position);
            let known = contours.spheres.len();
            let has = (self.has_silhouette[position], has_depth);
            let mut face = None;
            loop {
                let of = (position, active, face);
                contours.add(simd, boxes, of, has, &mut outside);
                if face.is_some() || !has_outlines || contours.spheres.len() == known {
                    break;
                }
                face = self.face(position, contours);
                if face.is_none() {
                    break;
                }
            }
        }
        outside
    }

    /// The contour of the face of the sphere that was added last, if it has an outline beside it.
    #[inline(always)]
    fn face(&self, position: usize, contours: &mut Contours) -> Option<&Quadratic> {
        match self.contents.face(position) {
            Face::All => None,
            Face::Nothing => {
                contours.set_line(Line::All);
                None
            }
            Face::Inside(_, conic) => Some(conic),
        }
    }

    /// The light of a sphere at these places of the boxes.
    #[inline(always)]
    fn light<S: Simd>(
        &self,
        simd: S,
        boxes: &EightBoxes<S>,
        (visible, line): (&Visible<S>, Line),
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Lit<S> {
        let position = visible.position;
        let scene = self.scene;
        let active = &self.contents.active[position];
        let finish = &self.finishes[position];
        let color = if line.is_outline() {
            self.outline_color(position)
        } else {
            finish.reflectance.albedo * scene.ambient
        };
        let mut light = Lit::ambient(simd, color, visible.share.area);
        let lights = scene.lights.len();
        let reaches = &self.contents.reach[position * lights..][..lights];
        if line.is_outline() || reaches.iter().all(|reach| matches!(reach, Reach::Nowhere)) {
            return light;
        }
        let around = Surroundings::new(simd, self.cell, boxes, &active.ball, visible);
        let normals = Normals::new(simd, scene, finish, (&around, visible), noise);
        light.samples = 8 * normals.samples;
        let has_highlight = finish.reflectance.highlight.is_some();
        let views = if has_highlight && active.ball.is_near_eye() {
            Some(Views::new(simd, &around, &normals))
        } else {
            None
        };
        for (of_light, reach) in scene.lights.iter().zip(reaches) {
            if let Reach::Past(casters) = reach {
                let casters = &self.contents.occluders[casters.start..casters.end];
                let of = (finish, of_light, scene.channels);
                light.add(
                    simd,
                    of,
                    (&around, &normals, visible),
                    views.as_ref(),
                    casters,
                );
            }
        }
        light
    }
}
