//! Points of a sphere, and how they move across boxes.

use fearless_simd::Simd;

use super::contours::Visible;
use super::eight_boxes::EightBoxes;
use crate::edges::cell::{Ball, Cell};
use crate::exact::points::Points;
use crate::numeric::lanes::{f64x8, mask64x8};
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
    /// How normals turn from the middles of what is seen to the points, across the view: where a silhouette cuts a box
    /// the points lie beside the middles.
    pub(super) turned: Vectors<S>,
    pub(super) radius: f64,
    /// The sides of boxes on the retina at distance 1.
    pub(super) sides: [f64; 2],
    /// The square of the angle by which normals turn across a box, and the cosine toward the eye.
    pub(super) turn_sq: f64x8<S>,
    pub(super) grazing: f64x8<S>,
    /// The second derivatives of the points, in boxes: by x twice, by x and y, twice, and by y twice.
    pub(super) seconds: [Vectors<S>; 3],
    /// The error of the normals: see [`Self::errors`]. And what is left of it when their second derivatives are
    /// integrated, in boxes that the silhouette does not cut.
    pub(super) second: f64x8<S>,
    pub(super) third: f64x8<S>,
    pub(super) is_cut: mask64x8<S>,
    /// The change of distances from the middle to the corner of a box, over themselves.
    pub(super) slide: f64x8<S>,
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
        visible: &Visible<S>,
    ) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let [width, height] = boxes.size;
        let half = f64x8::splat(simd, 0.5);
        let (middle, inward) = (visible.middle, visible.inward);
        let offset = [
            (middle[0] + inward[0]).max(-half).min(half),
            (middle[1] + inward[1]).max(-half).min(half),
        ];
        let is_cut = visible.is_cut;
        let sides = [cell.size[0] * width, cell.size[1] * height];
        let mut ray = Vectors::splat(simd, cell.middle);
        ray.x += (boxes.x + offset[0] * width) * cell.size[0];
        ray.y += (boxes.y + offset[1] * height) * cell.size[1];
        let points = Points::new(simd, ball, ray);
        // At a silhouette normals turn fast; but not by more than about 1 across a box.
        let side = sides[0].max(sides[1]) / ball.radius;
        let is_parallel = ball.is_parallel();
        // How far points move for what rays do, as parts of these.
        let scale = if is_parallel { one } else { points.t };
        let least = scale * side + LEAST_GRAZING;
        let toward_eye = (-points.normal.dot(&points.ray)).max(least);
        // P = t d stays on the sphere: n · dP = 0.
        let by_eye = one / toward_eye;
        let (slide_x, slide_y) = (points.normal.x * by_eye, points.normal.y * by_eye);
        let mut along_x = points.ray.times(slide_x);
        along_x.x += 1.0;
        let mut along_y = points.ray.times(slide_y);
        along_y.y += 1.0;
        let across = [
            along_x.times(scale * sides[0]),
            along_y.times(scale * sides[1]),
        ];
        let moved_sq = across[0].length_squared() + across[1].length_squared();
        let turn_sq = moved_sq * (1.0 / (ball.radius * ball.radius));
        let mut slide = slide_x.abs() * (0.5 * sides[0]) + slide_y.abs() * (0.5 * sides[1]);
        let mut slides = [slide_x * sides[0], slide_y * sides[1]];
        if is_parallel {
            // Without perspective.
            (slide, slides) = (slide * 0.0, [slide * 0.0; 2]);
        }
        let turned = Self::turned(
            &points,
            [
                (offset[0] - middle[0]) * (sides[0] / ball.radius) * scale,
                (offset[1] - middle[1]) * (sides[1] / ball.radius) * scale,
            ],
        );
        let ray_length = points.ray_sq.sqrt();
        let (grazing, by_grazing) = (toward_eye / ray_length, by_eye * ray_length);
        let steepest = (grazing - turn_sq.sqrt() * RECEDING).max(grazing * LEAST_OF_GRAZING);
        let (second, third) = Self::errors(
            simd,
            (turn_sq, slide),
            (grazing, by_grazing, steepest),
            is_cut,
        );
        Self {
            place: points.place(),
            seconds: Self::seconds(
                &points,
                (&across, slides),
                (sides, by_eye * (1.0 / ball.radius)),
            ),
            across,
            offset,
            turned,
            radius: ball.radius,
            sides,
            turn_sq,
            grazing,
            second,
            third,
            is_cut,
            slide,
            points,
        }
    }

    /// A step beside the view, of which these are parts along both axes.
    #[inline(always)]
    fn turned(points: &Points<S>, [x, y]: [f64x8<S>; 2]) -> Vectors<S> {
        let ray = &points.ray;
        let along = (ray.x * x + ray.y * y) / points.ray_sq;
        let mut turned = ray.times(-along);
        turned.x += x;
        turned.y += y;
        turned
    }

    /// The second derivatives.
    ///
    /// With the point P = t d of a sphere with the normal n moving by P' and d by d', t' is t times the slide, and
    /// P'' = d (|P'|² / (r (−n · d)) + 2 t'² / t) + 2 t' d'. Parallel rays have no slide.
    #[inline(always)]
    fn seconds(
        points: &Points<S>,
        ([x, y], [slide_x, slide_y]): (&[Vectors<S>; 2], [f64x8<S>; 2]),
        ([width, height], by_depth): ([f64; 2], f64x8<S>),
    ) -> [Vectors<S>; 3] {
        let twice = points.t * 2.0;
        let ray = &points.ray;
        let mut by_x = ray.times(x.length_squared() * by_depth + slide_x * slide_x * twice);
        by_x.x += slide_x * twice * width;
        let mut by_both = ray.times((x.dot(y) * by_depth + slide_x * slide_y * twice) * 2.0);
        by_both.x += slide_y * twice * width;
        by_both.y += slide_x * twice * height;
        let mut by_y = ray.times(y.length_squared() * by_depth + slide_y * slide_y * twice);
        by_y.y += slide_y * twice * height;
        [by_x, by_both, by_y]
    }

    /// The error of taking the normals of points for the average of their boxes, and what is left of it when their
    /// second derivatives are integrated.
    ///
    /// The second derivative of normals is the square of their turn over the cosine toward the eye, in the direction
    /// of that. Near a silhouette the cosine is a root of the distance to it, of which a point knows the average to 6 %
    /// in a box that touches the silhouette, and to 2 % at the place that is chosen in a box that is cut by it.
    #[inline(always)]
    fn errors(
        simd: S,
        (turn_sq, slide): (f64x8<S>, f64x8<S>),
        (grazing, by_grazing, steepest): (f64x8<S>, f64x8<S>, f64x8<S>),
        is_cut: mask64x8<S>,
    ) -> (f64x8<S>, f64x8<S>) {
        const OF_TOUCHED: f64 = 0.06;
        const OF_CUT: f64 = 0.025;
        /// The share left of second derivatives that are integrated over parts of boxes by the middles of the parts.
        const OF_KNOWN: f64 = 0.3;
        let by_steepest = f64x8::splat(simd, 1.0) / steepest;
        let steeper = grazing * by_steepest;
        // By the perspective, twice the slide across the whole box.
        let aside = turn_sq.sqrt() * slide * (4.0 * OF_SECOND);
        let smooth = turn_sq * grazing * grazing * OF_SECOND + aside;
        let bent = turn_sq * steeper * steeper * by_steepest * OF_SECOND;
        let share = is_cut.select(f64x8::splat(simd, OF_CUT), f64x8::splat(simd, OF_TOUCHED));
        let second = (bent + aside).min(grazing * share + smooth);
        let known = turn_sq * by_grazing * OF_SECOND;
        let unknown = (bent - known).max(f64x8::splat(simd, 0.0));
        (second, second.min(unknown + (known + aside) * OF_KNOWN))
    }
}
