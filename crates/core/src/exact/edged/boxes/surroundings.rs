//! Points of a sphere, and how they move across boxes.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::eight_boxes::EightBoxes;
use super::outlines::Visible;
use crate::edges::cell::{Ball, Cell};
use crate::exact::points::Points;
use crate::numeric::vectors::Vectors;

/// A sphere's points and how they move across boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings<S: Simd> {
    pub(super) points: Points<S>,
    /// The points, and their changes across a box along both axes.
    pub(super) place: Vectors<S>,
    pub(super) across: [Vectors<S>; 2],
    /// From the middles of boxes to the points, in sides.
    pub(super) offset: [f64x8<S>; 2],
    pub(super) radius: f64,
    /// The square of the angle by which normals turn across a box, and the cosine toward the eye.
    pub(super) turn_sq: f64x8<S>,
    pub(super) grazing: f64x8<S>,
    /// The error of the normals: see [`Self::second`].
    pub(super) second: f64x8<S>,
    /// The change of distances from the middle to the corner of a box, over themselves; across a box along both axes;
    /// the sides of boxes on the retina at distance 1; and −1 / (n · d).
    pub(super) slide: f64x8<S>,
    pub(super) slides: [f64x8<S>; 2],
    pub(super) sides: [f64; 2],
    pub(super) by_toward_eye: f64x8<S>,
}

/// The share of the range of a quadratic function over a box by which the value in its middle is off: the average
/// of squares from −½ to ½ is 1/12, half of it for a second derivative of 1.
pub(super) const OF_SECOND: f64 = 1.0 / 24.0;

/// By how much the cosine toward the eye falls from the middle of a box to where it recedes, over the turn of normals;
/// and the share of it that is left at least. Chosen by what boxes claimed, not proved.
const RECEDING: f64 = 0.35;
const LEAST_OF_GRAZING: f64 = 0.7;

/// The least cosine toward the eye that is divided by.
const LEAST_GRAZING: f64 = 1e-6;

impl<S: Simd> Surroundings<S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        cell: &Cell,
        boxes: &EightBoxes<S>,
        ball: &Ball,
        &Visible {
            place: offset,
            is_cut,
            ..
        }: &Visible<S>,
    ) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let [width, height] = boxes.size;
        let mut ray = Vectors::splat(simd, cell.middle);
        ray.x += (boxes.x + offset[0] * width) * cell.size[0];
        ray.y += (boxes.y + offset[1] * height) * cell.size[1];
        let points = Points::new(simd, ball, ray);
        // At a silhouette normals turn fast; but not by more than about 1 across a box.
        let side = (cell.size[0] * width).max(cell.size[1] * height) / ball.radius;
        let least = points.t * side + LEAST_GRAZING;
        let toward_eye = (-points.normal.dot(&ray)).max(least);
        // P = t d stays on the sphere: n · dP = 0.
        let by_eye = one / toward_eye;
        let zero = f64x8::splat(simd, 0.0);
        let wide = [
            points.t * (cell.size[0] * width),
            points.t * (cell.size[1] * height),
        ];
        let (slide_x, slide_y) = (points.normal.x * by_eye, points.normal.y * by_eye);
        let sides = [cell.size[0] * width, cell.size[1] * height];
        let half = [0.5 * sides[0], 0.5 * sides[1]];
        let along_x = Vectors {
            x: one,
            y: zero,
            z: zero,
        }
        .plus(&ray.times(slide_x));
        let along_y = Vectors {
            x: zero,
            y: one,
            z: zero,
        }
        .plus(&ray.times(slide_y));
        let across = [along_x.times(wide[0]), along_y.times(wide[1])];
        let moved_sq = across[0].length_squared() + across[1].length_squared();
        let turn_sq = moved_sq * (1.0 / (ball.radius * ball.radius));
        let slide = slide_x.abs() * half[0] + slide_y.abs() * half[1];
        let grazing = toward_eye / points.ray_sq.sqrt();
        let steepest = (grazing - turn_sq.sqrt() * RECEDING).max(grazing * LEAST_OF_GRAZING);
        Self {
            place: ray.times(points.t),
            across,
            offset,
            radius: ball.radius,
            turn_sq,
            grazing,
            second: Self::second(simd, (turn_sq, slide), (grazing, steepest), is_cut),
            slide,
            slides: [slide_x * sides[0], slide_y * sides[1]],
            sides,
            by_toward_eye: by_eye,
            points,
        }
    }

    /// The error of taking the normals of points for the average of their boxes.
    ///
    /// The second derivative of normals is the square of their turn over the cosine toward the eye, in the direction
    /// of that. Near a silhouette the cosine is a root of the distance to it, of which a point knows the average to 6 %
    /// in a box that touches the silhouette, and to 2 % at the place that is chosen in a box that is cut by it.
    #[inline(always)]
    fn second(
        simd: S,
        (turn_sq, slide): (f64x8<S>, f64x8<S>),
        (grazing, steepest): (f64x8<S>, f64x8<S>),
        is_cut: mask64x8<S>,
    ) -> f64x8<S> {
        const OF_TOUCHED: f64 = 0.06;
        const OF_CUT: f64 = 0.025;
        let steeper = grazing / steepest;
        // By the perspective, twice the slide across the whole box.
        let aside = turn_sq.sqrt() * slide * (4.0 * OF_SECOND);
        let smooth = turn_sq * grazing * grazing * OF_SECOND + aside;
        let bent = turn_sq * steeper * steeper / steepest * OF_SECOND;
        let share = is_cut.select(f64x8::splat(simd, OF_CUT), f64x8::splat(simd, OF_TOUCHED));
        (bent + aside).min(grazing * share + smooth)
    }
}
