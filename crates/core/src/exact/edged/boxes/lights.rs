//! The light of what eight boxes see of a sphere.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::eight::EightBoxes;
use super::half_plane::{HalfPlane, ramp};
use super::outlines::{Edges, Visible};
use crate::edges::cell::{Ball, Cell};
use crate::edges::shadow::Caster;
use crate::exact::points::Points;
use crate::exact::scene::Light;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::numeric::vectors::Vectors;

/// The light of a sphere in eight boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit<S: Simd> {
    /// In each channel: the average, and the least and the most that parts of a box may send.
    pub(super) value: [f64x8<S>; 3],
    pub(super) range: [[f64x8<S>; 2]; 3],
    /// The error of taking one point's light for the average of its box.
    pub(super) error: f64x8<S>,
    /// Edges of shadows, weighted by the light that they take away.
    pub(super) edges: Edges<S>,
}

/// A sphere's points and how they move across boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings<S: Simd> {
    points: Points<S>,
    /// The points, and their changes across a box along both axes.
    place: Vectors<S>,
    across: [Vectors<S>; 2],
    /// From the middles of boxes to the points, in sides.
    offset: [f64x8<S>; 2],
    radius: f64,
    /// The square of the angle by which normals turn across a box, and the cosine toward the eye.
    turn_sq: f64x8<S>,
    grazing: f64x8<S>,
    /// The error of the normals: see [`Self::second`].
    second: f64x8<S>,
    /// The change of distances from the middle to the corner of a box, over themselves; across a box along both axes;
    /// the sides of boxes on the retina at distance 1; and −1 / (n · d).
    slide: f64x8<S>,
    slides: [f64x8<S>; 2],
    sides: [f64; 2],
    by_toward_eye: f64x8<S>,
}

/// The share of the range of a quadratic function over a box by which the value in its middle is off: the average
/// of squares from −½ to ½ is 1/12, half of it for a second derivative of 1.
const OF_SECOND: f64 = 1.0 / 24.0;

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

    /// The share of each box that casters leave to a light, and the integrals of the coordinates over what they take.
    #[inline(always)]
    fn left_by(
        &self,
        simd: S,
        light: &Light,
        casters: &[Caster],
        edges: &mut Edges<S>,
    ) -> (f64x8<S>, [f64x8<S>; 2]) {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let mut left = one;
        let mut dark = [zero; 2];
        let right = self.place.dot_one(light.right);
        let up = self.place.dot_one(light.up);
        let height = self.place.dot_one(light.toward);
        let right_across = [
            self.across[0].dot_one(light.right),
            self.across[1].dot_one(light.right),
        ];
        let up_across = [
            self.across[0].dot_one(light.up),
            self.across[1].dot_one(light.up),
        ];
        let height_across = [
            self.across[0].dot_one(light.toward),
            self.across[1].dot_one(light.toward),
        ];
        // From the middle of a box to its corner a point moves by P', and by half of P'' more, which is |P'|² over the
        // radius and the cosine for the sphere, and twice the slide for the perspective.
        let moved_sq = self.turn_sq * (0.5 * self.radius * self.radius);
        let more = moved_sq / (self.grazing * self.radius) + moved_sq.sqrt() * self.slide * 2.0;
        for caster in casters {
            let center = caster.center;
            let u = right - center.dot(light.right);
            let v = up - center.dot(light.up);
            let inside = (u * u + v * v) * -1.0 + caster.radius * caster.radius;
            let across = [
                (u * right_across[0] + v * up_across[0]) * -2.0,
                (u * right_across[1] + v * up_across[1]) * -2.0,
            ];
            let bend = more * caster.radius + moved_sq;
            let middle = inside - across[0] * self.offset[0] - across[1] * self.offset[1];
            let foot = foot(simd, middle, across);
            // The caster is above the points, or above those at the edge where these are outside of its disc.
            let at_foot = height + height_across[0] * foot[0] + height_across[1] * foot[1];
            let is_inside = middle.simd_gt(zero);
            let above = is_inside
                .select(height, at_foot)
                .simd_lt(center.dot(light.toward));
            let width = across[0].abs() + across[1].abs();
            if (middle.abs() - bend * 2.0)
                .simd_lt(width * 0.5)
                .to_bitmask()
                == 0
            {
                // No edge is near.
                left = (above & is_inside).select(zero, left);
                continue;
            }
            let second = self.second_of(light, foot, (u, v));
            let part = HalfPlane::of_second_degree(simd, middle, across, (second, bend));
            let share = above.select(part.share, zero);
            edges.add(
                above.select(part.ambiguity(simd), zero),
                above.select(part.doubt, zero),
            );
            for (dark, moment) in dark.iter_mut().zip(part.moments) {
                *dark += above.select(moment, zero);
            }
            left = left * (one - share);
        }
        (left, dark)
    }
}

impl<S: Simd> Surroundings<S> {
    /// What the second derivative of a caster's function adds to it from a point to the edge, straight along its
    /// gradient.
    ///
    /// With the point P = t d of a sphere with the normal n moving by P' and d by d', t' is t times the slide, and
    /// P'' = d (|P'|² / (r (−n · d)) + 2 t'² / t) + 2 t' d'.
    #[inline(always)]
    fn second_of(
        &self,
        light: &Light,
        [x, y]: [f64x8<S>; 2],
        (u, v): (f64x8<S>, f64x8<S>),
    ) -> f64x8<S> {
        let place = self.across[0].times(x).plus(&self.across[1].times(y));
        let slide = self.slides[0] * x + self.slides[1] * y;
        let along = place.length_squared() * self.by_toward_eye * (1.0 / self.radius)
            + slide * slide * self.points.t * 2.0;
        let turn = slide * self.points.t * 2.0;
        let ray = &self.points.ray;
        let second = Vectors {
            x: ray.x * along + turn * x * self.sides[0],
            y: ray.y * along + turn * y * self.sides[1],
            z: ray.z * along,
        };
        let (right, up) = (place.dot_one(light.right), place.dot_one(light.up));
        let bent = u * second.dot_one(light.right) + v * second.dot_one(light.up);
        (right * right + up * up + bent) * -1.0
    }
}

impl<S: Simd> Lit<S> {
    /// Ambient light alone.
    #[inline(always)]
    pub(super) fn ambient(simd: S, color: Color) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let [x, y, z] = [
            f64x8::splat(simd, color.x),
            f64x8::splat(simd, color.y),
            f64x8::splat(simd, color.z),
        ];
        Self {
            value: [x, y, z],
            range: [[x; 2], [y; 2], [z; 2]],
            error: zero,
            edges: Edges::none(simd),
        }
    }

    /// Adds a light, past casters.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        simd: S,
        of: (&Finish, &Light, usize),
        around: &Surroundings<S>,
        casters: &[Caster],
    ) {
        let (finish, light, channels) = of;
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let toward = light.toward;
        let cosine = around.points.normal.dot_one(toward);
        let by_radius = 1.0 / around.radius;
        let across = [
            around.across[0].dot_one(toward) * by_radius,
            around.across[1].dot_one(toward) * by_radius,
        ];
        let highest = cosine + across[0].abs() + across[1].abs();
        if highest.simd_gt(zero).to_bitmask() == 0 {
            return;
        }
        let mut edges = Edges::none(simd);
        let (left, dark) = around.left_by(simd, light, casters, &mut edges);
        // The middle of what is lit.
        let by_left = one / left.max(f64x8::splat(simd, LEAST_LEFT));
        let half = f64x8::splat(simd, 0.5);
        let aside = [
            (dark[0] * by_left).max(-half).min(half),
            (dark[1] * by_left).max(-half).min(half),
        ];
        let faced = Faced {
            cosine: cosine - across[0] * aside[0] - across[1] * aside[1],
            across,
            width: (across[0].abs() + across[1].abs()) * 0.5,
        };
        let diffuse = faced.diffuse(simd, finish, around);
        let viewed = finish.viewed(&around.points, &around.points.normal);
        let [x, y] = &around.across;
        let aside = x
            .times(aside[0] * by_radius)
            .plus(&y.times(aside[1] * by_radius));
        let mut half_cosine = viewed.half_cosine(toward, cosine);
        if finish.reflectance.highlight.is_some() {
            half_cosine -= viewed.change_of_half_cosine(toward, &aside);
        }
        let shine = faced.shine(simd, finish, half_cosine, around);
        let weights = finish.reflectance.brightest(light.intensity);
        self.error += left * (diffuse.doubt * weights[0] + shine.doubt * weights[1]);
        // A terminator in the box is an edge as those of shadows are.
        let ends = diffuse.ambiguity * weights[0] + shine.ambiguity * weights[1];
        let brightness = diffuse.most * weights[0] + shine.most * weights[1];
        self.edges.add(ends, zero);
        self.edges.sum += edges.sum * brightness;
        self.edges.most = self.edges.most.max(edges.most * brightness);
        self.edges.doubt += edges.doubt * brightness;
        let is_open = left.simd_ge(one) & (edges.sum + ends).simd_le(zero);
        let is_dark = left.simd_le(zero) & edges.sum.simd_le(zero);
        let color = finish.reflectance.albedo * light.intensity;
        let highlight = finish.reflectance.highlight.as_ref();
        let strength = light.intensity * highlight.map_or(0.0, |(strength, _)| *strength);
        for channel in 0..channels {
            let whole = diffuse.value * color[channel] + shine.value * strength[channel];
            let highest = diffuse.most * color[channel] + shine.most * strength[channel];
            self.value[channel] += whole * left;
            let [least, most] = &mut self.range[channel];
            *least += is_open.select(whole, zero);
            *most += is_dark.select(zero, highest);
        }
    }
}

/// The cosines toward a light in boxes: in the middles of what is lit, and how they change across.
#[derive(Clone, Copy, Debug)]
struct Faced<S: Simd> {
    cosine: f64x8<S>,
    across: [f64x8<S>; 2],
    /// Half of the most that they change.
    width: f64x8<S>,
}

/// A power of cosines, over boxes.
#[derive(Clone, Copy, Debug)]
struct Power<S: Simd> {
    /// The average, about the highest value, and the error of the average.
    value: f64x8<S>,
    most: f64x8<S>,
    doubt: f64x8<S>,
    /// What may be hidden or seen of it together, where the light ends in the box.
    ambiguity: f64x8<S>,
}

impl<S: Simd> Faced<S> {
    /// The boxes in which the surface turns from the light.
    #[inline(always)]
    fn is_cut(&self) -> mask64x8<S> {
        self.cosine.abs().simd_lt(self.width)
    }

    /// The diffuse falloff.
    #[inline(always)]
    fn diffuse(&self, simd: S, finish: &Finish, around: &Surroundings<S>) -> Power<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let falloff = &finish.reflectance.diffuse;
        let exponent = falloff.exponent;
        let is_cut = self.is_cut();
        let highest = is_cut.select(self.cosine + self.width, self.cosine);
        if exponent == 1.0 {
            let mut value = self.cosine.max(zero);
            if is_cut.to_bitmask() != 0 {
                value = is_cut.select(ramp(simd, self.cosine, self.across), value);
            }
            // Normals of rays that miss may be longer than 1.
            let most = highest.max(zero).min(one);
            return Power {
                value: value.min(one),
                most,
                doubt: around.second.min(one),
                ambiguity: is_cut.select(most, zero),
            };
        }
        // e cᵉ⁻¹ c'' + e (e − 1) cᵉ⁻² c'²: where c is least for e below 1, where it is highest above.
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let half = self.width * 0.5;
        let least = (self.cosine - half).max(half).max(tiny);
        let by_least = one / least;
        let bends = around.second * by_least
            + around.turn_sq * by_least * by_least * ((exponent - 1.0).abs() * OF_SECOND);
        let most = falloff.of(self.cosine + self.width);
        let power = if exponent < 1.0 {
            falloff.of(least)
        } else {
            most
        };
        let smooth = (power * bends * exponent).min(most);
        Power {
            value: falloff.of(self.cosine),
            most,
            doubt: is_cut.select(most, smooth),
            ambiguity: is_cut.select(most, zero),
        }
    }

    /// The falloff of the highlight, which ends where the surface turns from the light.
    #[inline(always)]
    fn shine(
        &self,
        simd: S,
        finish: &Finish,
        half_cosine: f64x8<S>,
        around: &Surroundings<S>,
    ) -> Power<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let nothing = Power {
            value: zero,
            most: zero,
            doubt: zero,
            ambiguity: zero,
        };
        let Some((_, falloff)) = &finish.reflectance.highlight else {
            return nothing;
        };
        let shininess = falloff.exponent;
        // The highest cosine in the box, by half of what normals turn across it, and a little more as rays turn.
        let turn = around.turn_sq.sqrt() * HALF_TURN;
        let sine = (one - half_cosine * half_cosine).max(zero).sqrt();
        let nearest = (half_cosine + turn * sine + turn * turn).min(one);
        let most = falloff.of(nearest);
        let bends = around.second * shininess
            + around.turn_sq * sine * sine * (shininess * shininess * OF_SECOND);
        let doubt = (most * bends).min(most);
        let power = falloff.of(half_cosine);
        let is_cut = self.is_cut();
        if is_cut.to_bitmask() == 0 {
            let faces = self.cosine.simd_gt(zero);
            return Power {
                value: faces.select(power, zero),
                most: faces.select(most, zero),
                doubt: faces.select(doubt, zero),
                ambiguity: zero,
            };
        }
        // Half of the second derivative of normals, along half the diagonal.
        let bend = around.second * (0.25 / OF_SECOND);
        let facing = HalfPlane::new(simd, self.cosine, self.across, bend);
        let is_faced = facing.share + facing.doubt;
        Power {
            value: power * facing.share,
            most: is_faced.simd_gt(zero).select(most, zero),
            doubt: doubt * is_faced.min(one) + most * facing.doubt,
            ambiguity: facing.ambiguity(simd) * most,
        }
    }
}

/// Less of a light than this has no place of its own.
const LEAST_LEFT: f64 = 1e-6;

/// The way in sides of a box from its middle along the gradient to where a linear function vanishes, as far as that
/// lies in the box.
#[inline(always)]
fn foot<S: Simd>(simd: S, value: f64x8<S>, across: [f64x8<S>; 2]) -> [f64x8<S>; 2] {
    let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
    let half = f64x8::splat(simd, 0.5);
    let steep = (across[0] * across[0] + across[1] * across[1]).max(tiny);
    let step = value * -1.0 / steep;
    [
        (across[0] * step).max(-half).min(half),
        (across[1] * step).max(-half).min(half),
    ]
}

/// Half of the turn across a box, and a quarter more for the turn of rays.
const HALF_TURN: f64 = 0.625;
