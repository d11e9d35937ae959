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
use crate::light::reflection::ViewedPoints;
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
        let least = f64x8::splat(simd, LEAST_GRAZING);
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
        let grazing = toward_eye / points.ray_sq.sqrt();
        let steepest = (grazing - turn_sq.sqrt() * RECEDING).max(grazing * LEAST_OF_GRAZING);
        Self {
            place: ray.times(points.t),
            across,
            offset,
            radius: ball.radius,
            turn_sq,
            grazing,
            second: Self::second(simd, turn_sq, (grazing, steepest), is_cut),
            slide: slide_x.abs() * half[0] + slide_y.abs() * half[1],
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
        turn_sq: f64x8<S>,
        (grazing, steepest): (f64x8<S>, f64x8<S>),
        is_cut: mask64x8<S>,
    ) -> f64x8<S> {
        const OF_TOUCHED: f64 = 0.06;
        const OF_CUT: f64 = 0.025;
        let steeper = grazing / steepest;
        let smooth = turn_sq * grazing * grazing * OF_SECOND;
        let bent = turn_sq * steeper * steeper / steepest * OF_SECOND;
        let share = is_cut.select(f64x8::splat(simd, OF_CUT), f64x8::splat(simd, OF_TOUCHED));
        bent.min(grazing * share + smooth)
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
        // From the middle of a box to its corner a point moves by P', and by half of P'' more, which is |P'|² over the
        // radius and the cosine for the sphere, and twice the slide for the perspective.
        let moved_sq = self.turn_sq * (0.5 * self.radius * self.radius);
        let more = moved_sq / (self.grazing * self.radius) + moved_sq.sqrt() * self.slide * 2.0;
        for caster in casters {
            let center = caster.center;
            let u = right - center.dot(light.right);
            let v = up - center.dot(light.up);
            let above = height.simd_lt(center.dot(light.toward));
            let inside = (u * u + v * v) * -1.0 + caster.radius * caster.radius;
            let across = [
                (u * right_across[0] + v * up_across[0]) * -2.0,
                (u * right_across[1] + v * up_across[1]) * -2.0,
            ];
            let bend = more * caster.radius + moved_sq;
            let middle = inside - across[0] * self.offset[0] - across[1] * self.offset[1];
            let width = across[0].abs() + across[1].abs();
            if (middle.abs() - bend * 2.0)
                .simd_lt(width * 0.5)
                .to_bitmask()
                == 0
            {
                // No edge is near.
                left = (above & middle.simd_gt(zero)).select(zero, left);
                continue;
            }
            let moved = self.moved(simd, light, (inside, across), (u, v));
            let moved = moved.max(-bend).min(bend);
            let part = HalfPlane::new(simd, middle + moved, across, bend * 0.5);
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
    fn moved(
        &self,
        simd: S,
        light: &Light,
        (inside, across): (f64x8<S>, [f64x8<S>; 2]),
        (u, v): (f64x8<S>, f64x8<S>),
    ) -> f64x8<S> {
        let least = f64x8::splat(simd, f64::MIN_POSITIVE);
        let steep = (across[0] * across[0] + across[1] * across[1]).max(least);
        let step = inside * -1.0 / steep;
        let half = f64x8::splat(simd, 0.5);
        let [x, y] = [
            (across[0] * step).max(-half).min(half),
            (across[1] * step).max(-half).min(half),
        ];
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
        let lit_cosine = cosine - across[0] * aside[0] - across[1] * aside[1];
        let viewed = around.viewed(finish);
        let (diffuse, doubt) = averages(simd, finish, lit_cosine, across, around);
        // Of a terminator in the box more may be hidden, or seen, than its share.
        let width = (across[0].abs() + across[1].abs()) * 0.5;
        let is_cut = lit_cosine.abs().simd_lt(width);
        let ends = is_cut.select((lit_cosine + width).max(zero), zero);
        let reflectance = &finish.reflectance;
        let mut half_cosine = viewed.half_cosine(toward, cosine);
        if reflectance.highlight.is_some() {
            let [x, y] = &around.across;
            let aside = x.times(aside[0]).plus(&y.times(aside[1]));
            half_cosine -= viewed.change_of_half_cosine(toward, &aside) * by_radius;
        }
        let faces = lit_cosine.simd_gt(zero);
        let (shine, shine_doubt) = highlight(simd, finish, half_cosine, faces, around);
        let [most_diffuse, most_shine] = reflectance.brightest(light.intensity);
        let brightness = diffuse * most_diffuse + shine * most_shine;
        self.error += left * (doubt * most_diffuse + shine_doubt * most_shine);
        let ends = ends * most_diffuse;
        self.edges.sum += ends;
        self.edges.most = self.edges.most.max(ends);
        self.edges.sum += edges.sum * brightness;
        self.edges.most = self.edges.most.max(edges.most * brightness);
        self.edges.doubt += edges.doubt * brightness;
        let is_open = left.simd_ge(one) & edges.sum.simd_le(zero);
        let is_dark = left.simd_le(zero) & edges.sum.simd_le(zero);
        let color = reflectance.albedo * light.intensity;
        let strength = reflectance.highlight.map_or(0.0, |(strength, _)| strength);
        for channel in 0..channels {
            let whole = diffuse * color[channel] + shine * (light.intensity[channel] * strength);
            self.value[channel] += whole * left;
            let [least, most] = &mut self.range[channel];
            *least += is_open.select(whole, zero);
            *most += is_dark.select(zero, whole);
        }
    }
}

/// Less of a light than this has no place of its own.
const LEAST_LEFT: f64 = 1e-6;

impl<S: Simd> Surroundings<S> {
    #[inline(always)]
    fn viewed(&self, finish: &Finish) -> ViewedPoints<'_, S> {
        finish.viewed(&self.points, &self.points.normal)
    }
}

/// The averages over boxes of the diffuse falloff, and their errors.
#[inline(always)]
fn averages<S: Simd>(
    simd: S,
    finish: &Finish,
    cosine: f64x8<S>,
    across: [f64x8<S>; 2],
    around: &Surroundings<S>,
) -> (f64x8<S>, f64x8<S>) {
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let falloff = &finish.reflectance.diffuse;
    let exponent = falloff.exponent;
    let second = around.second;
    let width = (across[0].abs() + across[1].abs()) * 0.5;
    let is_cut = cosine.abs().simd_lt(width);
    if exponent == 1.0 {
        let mut average = cosine.max(zero);
        if is_cut.to_bitmask() != 0 {
            average = is_cut.select(ramp(simd, cosine, across), average);
        }
        return (average, second);
    }
    let average = falloff.of(cosine);
    // e cⁿ⁻¹ c'' + e (e − 1) cⁿ⁻² c'².
    let least = cosine.max(width).max(f64x8::splat(simd, f64::MIN_POSITIVE));
    let power = falloff.of(least);
    let by_least = one / least;
    let bends = second * by_least
        + around.turn_sq * by_least * by_least * ((exponent - 1.0).abs() * OF_SECOND);
    let most = falloff.of((cosine + width).max(zero));
    let smooth = (power * bends * exponent).min(most);
    (
        average,
        is_cut.select(most - falloff.of(cosine - width), smooth),
    )
}

/// The averages of a highlight's power where the surface faces the light, and their errors.
#[inline(always)]
fn highlight<S: Simd>(
    simd: S,
    finish: &Finish,
    half_cosine: f64x8<S>,
    faces: mask64x8<S>,
    around: &Surroundings<S>,
) -> (f64x8<S>, f64x8<S>) {
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let Some((_, falloff)) = &finish.reflectance.highlight else {
        return (zero, zero);
    };
    let shininess = falloff.exponent;
    let power = falloff.of(half_cosine);
    // The highest cosine in the box, by half of what normals turn across it, and a little more as rays turn.
    let turn = around.turn_sq.sqrt() * HALF_TURN;
    let sine = (one - half_cosine * half_cosine).max(zero).sqrt();
    let nearest = (half_cosine + turn * sine + turn * turn).min(one);
    let most = falloff.of(nearest);
    let bends = around.second * shininess
        + around.turn_sq * sine * sine * (shininess * shininess * OF_SECOND);
    let error = (most * bends).min(most);
    // Where it ends at the terminator.
    let error = faces.select(error, most);
    let reach = nearest.simd_gt(zero);
    (faces.select(power, zero), reach.select(error, zero))
}

/// Half of the turn across a box, and a quarter more for the turn of rays.
const HALF_TURN: f64 = 0.625;
