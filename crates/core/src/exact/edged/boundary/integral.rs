//! The integral over a cell.

use fearless_simd::Simd;
use glam::DVec2;

use super::chord::Reference;
use super::circle::Circle;
use super::clip;
use super::curve::Shape;
use super::events::Stretch;
use super::piece::Piece;
use super::power_rules::PowerRules;
use super::quadrature::total;

use crate::edges::cell::Cell;
use crate::exact::classify::active::{Active, Terminators};
use crate::exact::classify::coincidence::is_contour;
use crate::exact::classify::contents::{Contents, Kind};
use crate::exact::classify::face::Face;
use crate::exact::classify::patch::Patch;
use crate::exact::classify::reach::Reach;
use crate::exact::part::{GiveUp, Part};
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::numeric::lanes::f64x8;
use crate::numeric::polynomial::{Linear, Quadratic};

use super::setting::{
    Boundary, Curve, Edge, Goal, LEAST_SHARE, NONE, Path, SHARE_OF_ALL, Setting, Sum, Surface,
};

impl Boundary {
    /// The integral over a cell.
    #[inline(always)]
    pub(crate) fn integrate<'scene, S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'scene>,
        cell: &Cell,
        contents: &Contents,
        goal: &Goal,
    ) -> Result<Part, GiveUp> {
        let actives = &contents.active;
        let mut surfaces = Vec::with_capacity(actives.len());
        let mut missed = 0.0;
        for (position, active) in actives.iter().enumerate() {
            let mut finish = Finish::new(scene, active.sphere, contents.pixel);
            missed +=
                without_dark_highlight(simd, &mut finish, (scene, cell, contents), position, goal);
            // Parallel rays meet whatever their lines do.
            let along = match cell.is_parallel() {
                true => &Linear {
                    one: 1.0,
                    x: 0.0,
                    y: 0.0,
                },
                false => &active.along,
            };
            let reference = Reference::new(&active.discriminant, along);
            surfaces.push(Surface {
                finish,
                reference,
                terminators: 0,
                cutoffs: 0,
                rules: PowerRules::ZERO,
            });
        }
        self.levels.clear();
        for (kind, conic) in &contents.conics {
            match *kind {
                Kind::Terminator(one, light) => {
                    self.note_terminator(&mut surfaces[one], one, light, conic);
                }
                Kind::Cutoff(one, light) => {
                    let lobe = scene.lights[light].near.and_then(|near| near.lobe);
                    if lobe.is_some_and(|lobe| lobe.is_singular()) {
                        surfaces[one].cutoffs |= 1 << light;
                        self.add_levels(one, &surfaces[one].reference, conic);
                    }
                }
                Kind::Silhouette(_) | Kind::Seam(..) | Kind::Outline(_) => {}
            }
        }
        if cell.is_parallel() {
            self.add_contours_as_terminators(scene, contents, &mut surfaces);
        }
        // Between lines on bumps more may happen than their errors tell.
        let is_bumpy = |active: &Active| active.terminators == Terminators::Anywhere;
        let has_bumps = actives.iter().any(is_bumpy);
        let share = if has_bumps {
            LEAST_SHARE
        } else {
            let curves = contents.conics.len() + contents.occluders.len();
            (SHARE_OF_ALL / (curves + 1) as f64).max(LEAST_SHARE)
        };
        self.regions.clear();
        self.crossings[0].clear();
        self.crossings[1].clear();
        let setting = Setting {
            scene,
            cell,
            contents,
            goal,
            surfaces: &surfaces,
            share,
            has_bumps,
        };
        let zero = f64x8::splat(simd, 0.0);
        let mut sum = Sum {
            value: [zero; 3],
            empty: zero,
            error: missed,
        };
        for (kind, _) in &contents.conics {
            let (circle, edge, own) = match *kind {
                Kind::Silhouette(one) => {
                    let circle = Circle::limb(&actives[one].ball);
                    (circle, Edge::Limb, [one, NONE])
                }
                Kind::Seam(one, other) => {
                    let circle = Circle::seam(&actives[one].ball, &actives[other].ball);
                    let Some(circle) = circle else { continue };
                    (circle, Edge::Seam, [one, other])
                }
                Kind::Outline(one) => {
                    let Face::Inside(inside, _) = contents.face(one) else {
                        continue;
                    };
                    let circle = Circle::outline(&actives[one].ball, inside);
                    (circle, Edge::Outline, [one, NONE])
                }
                Kind::Terminator(one, light) => {
                    let ball = &actives[one].ball;
                    let Some(plane) = actives[one].terminators.plane(scene, ball, light) else {
                        continue;
                    };
                    let circle = Circle::terminator(ball, &plane);
                    (circle, Edge::Terminator(light), [one, NONE])
                }
                Kind::Cutoff(one, light) => {
                    let ball = &actives[one].ball;
                    let Some(plane) = scene.lights[light].cutoff(ball) else {
                        continue;
                    };
                    let circle = Circle::terminator(ball, &plane);
                    (circle, Edge::Cutoff(light), [one, NONE])
                }
            };
            self.add_circle(simd, &setting, circle, edge, own, &mut sum);
        }
        let lights = scene.lights.len();
        for (position, active) in actives.iter().enumerate() {
            for light in 0..lights {
                let Reach::Past(casters) = &contents.reach[position * lights + light] else {
                    continue;
                };
                let toward = scene.lights[light].toward;
                let own = [position, NONE];
                if casters.is_empty() {
                    continue;
                }
                let patch = Patch::new(cell, &active.ball, &active.discriminant, &active.along);
                let middle = 0.5 * (patch.ends[0] + patch.ends[1]);
                let around = 0.5 * (patch.ends[1] - patch.ends[0]).length() + patch.around;
                // Without bumps, light reaches only one side of the sphere.
                let sides: &[f64] = match active.terminators {
                    Terminators::Plain | Terminators::Nowhere => &[1.0],
                    Terminators::Tilted(_) | Terminators::Anywhere => &[1.0, -1.0],
                };
                for caster in casters.clone() {
                    for &side in sides {
                        let caster_ball = &contents.occluders[caster];
                        let curve = Curve {
                            shape: Shape::shadow(&active.ball, caster_ball, (toward, side), middle),
                            edge: Edge::Shadow(light, caster),
                            own,
                        };
                        self.pieces.clear();
                        clip::of_shadow(&curve.shape, (toward, middle), around, &mut self.pieces);
                        self.add(simd, &setting, &curve, &mut sum);
                    }
                }
            }
        }
        // All that crosses the sides is known now.
        for (edge, x) in [(Edge::Left, -0.5), (Edge::Right, 0.5)] {
            self.pieces.clear();
            self.pieces.push(Piece {
                ends: [DVec2::new(0.0, -0.5), DVec2::new(0.0, 0.5)],
                roots: [false; 2],
            });
            let curve = Curve {
                shape: Shape::Side(x),
                edge,
                own: [NONE; 2],
            };
            self.add(simd, &setting, &curve, &mut sum);
        }
        let mut defect = 0.0;
        for (_, left) in &self.regions {
            defect += left.abs();
        }
        let mut value = Color::ZERO;
        for channel in 0..scene.channels {
            value[channel] = total(sum.value[channel]);
        }
        let mut rounding = goal.contrast * contents.rounding;
        if rounding > goal.tolerance {
            // It may move each of the edges.
            rounding *= (contents.conics.len() + contents.occluders.len()).max(1) as f64;
        }
        let part = Part {
            value,
            covered: 1.0 - total(sum.empty),
            error: sum.error + goal.contrast * defect + rounding,
            rounding,
        };
        if part.error.is_finite() && part.value.is_finite() {
            Ok(part)
        } else {
            Err(GiveUp::NotFinite)
        }
    }

    /// Takes contours for terminators of lights that are where parallel rays come from: powers of n·l that are not whole
    /// begin there.
    #[inline(never)]
    fn add_contours_as_terminators(
        &mut self,
        scene: &InCamera<'_>,
        contents: &Contents,
        surfaces: &mut [Surface],
    ) {
        let lights = scene.lights.len();
        for (kind, conic) in &contents.conics {
            let Kind::Silhouette(one) = *kind else {
                continue;
            };
            for light in 0..lights {
                let reaches = matches!(contents.reach[one * lights + light], Reach::Past(_));
                let active = &contents.active[one];
                let plane = active.terminators.plane(scene, &active.ball, light);
                if !reaches || !plane.as_ref().is_some_and(is_contour) {
                    continue;
                }
                self.note_terminator(&mut surfaces[one], one, light, conic);
            }
        }
    }

    /// Notes that a surface has the terminator of a light in the cell, and how light goes to zero there.
    fn note_terminator(
        &mut self,
        surface: &mut Surface,
        position: usize,
        light: usize,
        conic: &Quadratic,
    ) {
        surface.terminators |= 1 << light;
        if surface.is_singular(1 << light) {
            let exponent = surface.finish.reflectance.exponents()[0];
            surface.rules = PowerRules::of(exponent, &mut self.rules);
            self.add_levels(position, &surface.reference, conic);
        }
    }

    #[inline(always)]
    fn add_circle<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        circle: Circle,
        edge: Edge,
        own: [usize; 2],
        sum: &mut Sum<S>,
    ) {
        self.pieces.clear();
        clip::of_circle(setting.cell, &circle, &mut self.pieces);
        let curve = Curve {
            shape: Shape::Circle(circle),
            edge,
            own,
        };
        self.add(simd, setting, &curve, sum);
    }

    /// Adds what the pieces of a curve contribute.
    #[inline(never)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        curve: &Curve,
        sum: &mut Sum<S>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                clip::split(&mut self.pieces, setting.goal.parts);
                let contents = setting.contents;
                let others =
                    contents.active.len() + contents.conics.len() + contents.occluders.len();
                self.work.tests += (self.pieces.len() * others) as u64;
                for index in 0..self.pieces.len() {
                    let piece = self.pieces[index];
                    let whole = Stretch {
                        curve,
                        piece: &piece,
                        start: 0.0,
                        end: 1.0,
                    };
                    let places = whole.places(simd, setting);
                    self.find_arcs(simd, setting, &whole, &places);
                    self.light_arcs(simd, setting, &whole, &places);
                    self.cut_at_levels(simd, setting, &whole, &places);
                    for index in 0..self.lit_arcs.len() {
                        let arc = self.lit_arcs[index];
                        let path = Path {
                            curve,
                            piece: &piece,
                        };
                        self.add_arc(simd, setting, &path, &arc, 0, sum);
                    }
                }
            },
        );
    }
}

/// Leaves out the highlight of a surface where it is too dark to count in a cell; returns a bound of what that
/// leaves out.
#[inline(always)]
fn without_dark_highlight<S: Simd>(
    simd: S,
    finish: &mut Finish,
    (scene, cell, contents): (&InCamera<'_>, &Cell, &Contents),
    position: usize,
    goal: &Goal,
) -> f64 {
    /// The share of the tolerance that a highlight may be.
    const DARK: f64 = 1e-3;
    if finish.reflectance.highlight.is_none() {
        return 0.0;
    }
    let highest = contents.highlight(simd, finish, (scene, cell), position);
    if highest > DARK * goal.tolerance {
        return 0.0;
    }
    finish.reflectance.highlight = None;
    highest
}
