//! The contents of a cell: the spheres that it may see, their edges, and the casters of shadows on them.

use super::active::{Active, Terminators};
use super::behind::Cover;
use super::coincidence::{contours_apart, has_same_contour, is_contour, nesting};
use super::cut_side::CutSide;
use super::face::Face;
use super::hidden::HiddenSpheres;
use super::occluder_cache::OccluderCache;
use super::patch::Patch;
use super::reach::Reach;
use crate::edges::cell::{Ball, Cell};
use crate::edges::seam::SeamPlane;
use crate::edges::shadow::Caster;
use crate::edges::silhouette::silhouette;
use crate::edges::terminator::terminator;
use crate::exact::budget::{is_beyond_a_crowd, is_beyond_a_part};
use crate::exact::scene::InCamera;
use crate::model::camera::Projection;
use crate::model::roughness::PixelKey;
use crate::numeric::polynomial::Quadratic;
use crate::numeric::rounding::{GEOMETRY_SLACK, UNIT_ROUNDOFF};

/// A curve on which light may change abruptly.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Kind {
    /// The contour of the active sphere with this position.
    Silhouette(usize),
    /// The intersection of two active spheres.
    Seam(usize, usize),
    /// The great circle of an active sphere that faces a light edge-on.
    Terminator(usize, usize),
    /// The circle in which the plane beyond which a light sends nothing cuts an active sphere.
    Cutoff(usize, usize),
    /// The inner edge of an active sphere's outline.
    Outline(usize),
}

/// The spheres, curves and occluders that matter in a cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contents {
    pub(crate) active: Vec<Active>,
    pub(crate) conics: Vec<(Kind, Quadratic)>,
    /// For every active sphere and every light.
    pub(crate) reach: Vec<Reach>,
    pub(crate) occluders: Vec<Caster>,
    /// The visible part of each active sphere inside of its outline; empty where none is seen.
    pub(super) faces: Vec<Face>,
    /// The pixel that the cell belongs to.
    pub(crate) pixel: PixelKey,
    /// The distance, in sides of the cell, by which rounding may move an edge; and the area of spheres that are too small to
    /// be resolved, which are left out.
    pub(crate) rounding: f64,
    /// Whether all parallel rays of the cell begin inside of a sphere that casts shadows, so that no directional light
    /// gets to what they see.
    pub(super) is_enclosed: bool,
    /// Spheres of which some parallel rays of the cell begin inside, and others not.
    pub(super) cut: Vec<(usize, Ball)>,
    /// That of which one side alone is asked for.
    pub(super) side: Option<(usize, CutSide)>,
    /// Whether edges of the cell are not known because of these.
    pub(crate) is_mixed: bool,
    /// The work on pairs of spheres, in the unit of tests.
    pub(crate) tests: u64,
    /// Whether the curves are so many that the cell is left to its quarters: not all of them are listed then, nor what
    /// keeps the light away.
    pub(crate) is_crowded: bool,
    hidden: HiddenSpheres,
}

/// The width, in sides of a cell, below which the silhouette of a sphere is not resolved: rounding moves the
/// roots of a discriminant, whose coefficients are of the order of the cell, by the square root of some units
/// in the last place, 1e-8. Such a sphere covers less than 1e-14 of the cell.
pub(super) const NARROWEST: f64 = 1e-7;

/// A bound of what rounding moves points by, relative to the largest numbers that they are computed from:
/// some units in the last place.
pub(super) const ROUNDINGS: f64 = 8.0 * UNIT_ROUNDOFF;

/// The distance from the eye, in radii, at which the plane of a circle passes that is seen as a line, and what
/// rounding moves such a line by, in sides of a cell: it is a double root.
const SEEN_EDGE_ON: f64 = 1e-5;
const ROOT_OF_ROUNDING: f64 = 1e-7;

/// Pairs of spheres, or of what is seen and an occluder, that are compared in the time of a test, and the tests in the
/// time of a seam: what the budget counts, about.
pub(super) const PAIRS_OF_A_TEST: usize = 8;
/// Occluders that are held against the ways of a point light, of which more is computed, in the time of a test.
pub(super) const WAYS_OF_A_TEST: usize = 2;
const TESTS_OF_A_SEAM: u64 = 4;

impl Contents {
    /// Takes in the spheres out of some that a cell of the pixel may see, and their edges.
    pub(crate) fn see(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
    ) {
        self.see_side(scene, cell, spheres, cache, None);
    }

    /// The same of one side of a sphere that some rays begin inside of.
    pub(crate) fn see_side(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
        side: Option<(usize, CutSide)>,
    ) {
        self.side = side;
        self.active.clear();
        self.conics.clear();
        self.reach.clear();
        self.occluders.clear();
        let size = cell.size[0].min(cell.size[1]);
        self.rounding = ROUNDINGS * cell.extent() / size;
        self.is_enclosed = false;
        self.is_mixed = false;
        self.cut.clear();
        self.tests = 0;
        self.is_crowded = false;
        let cover = Cover::of(cell, spheres);
        let mut unresolved = 0.0;
        let mut all_pairs = 0;
        for &(sphere, mut ball) in spheres {
            if ball.is_cut() && !self.take_cut(scene, cell, (sphere, &mut ball)) {
                continue;
            }
            let width = silhouette_width(&ball) / size;
            if width < NARROWEST {
                unresolved += width * width;
                continue;
            }
            let discriminant = silhouette(cell, &ball);
            let along = cell.along(ball.center);
            let spread = discriminant.spread();
            let mut slack = GEOMETRY_SLACK * (spread + discriminant.one.abs());
            if ball.is_parallel() {
                let length = ball.contour_scale(cell);
                if ball.is_apart() || discriminant.may_vanish() {
                    self.rounding = self.rounding.max(ROUNDINGS * length / size);
                }
                slack += 2.0 * ROUNDINGS * length * ball.radius;
            }
            if cover.is_some_and(|cover| cover.hides(&ball, &discriminant, &along)) {
                continue;
            }
            let half = 0.5 * (along.x.abs() + along.y.abs());
            let is_outside = ball.outside > 0.0;
            let is_behind = along.one + half <= 0.0;
            if is_outside && (discriminant.one + spread + slack < 0.0 || is_behind) {
                continue;
            }
            let active = Active {
                sphere,
                ball,
                discriminant,
                along,
                terminators: Terminators::of(scene, sphere, self.pixel),
                is_dark: false,
            };
            let pairs = self.active.len();
            self.tests += (pairs / PAIRS_OF_A_TEST) as u64;
            all_pairs += pairs as u64;
            if is_beyond_a_crowd(all_pairs) {
                // All that may be seen is listed, and no more compared.
                self.is_crowded = true;
                self.active.push(active);
                continue;
            }
            // Of spheres that coincide the first is seen.
            let is_same = |other: &&mut Active| {
                other.ball.center == ball.center && other.ball.radius == ball.radius
            };
            if let Some(other) = self.active.iter_mut().find(is_same) {
                if sphere < other.sphere {
                    other.sphere = sphere;
                    other.terminators = Terminators::of(scene, sphere, self.pixel);
                }
                continue;
            }
            // Of spheres with one contour the nearest hides the others, or that around them.
            let is_alike = |other: &&mut Active| has_same_contour(&other.ball, &ball);
            if let Some(other) = self.active.iter_mut().find(is_alike) {
                let moved = contours_apart(cell, &ball);
                self.rounding = self.rounding.max(moved / size);
                let is_before = match nesting(scene, sphere, other.sphere) {
                    Some(is_inside) => !is_inside,
                    None => ball.outside < other.ball.outside,
                };
                if is_before {
                    *other = active;
                }
                continue;
            }
            self.active.push(active);
        }
        self.add_caps(scene, cell);
        if self.is_crowded {
            let count = self.active.len() * scene.lights.len();
            self.reach.resize(count, Reach::Past(0..0));
            self.faces.clear();
            self.rounding += unresolved;
            return;
        }
        let reaching = self.lights_that_reach(scene, cell);
        self.hidden.remove(cache.level, &mut self.active);
        for position in 0..self.active.len() {
            let active = self.active[position];
            let is_outside = active.ball.outside > 0.0;
            // From inside, rays of a pinhole meet a sphere everywhere; parallel ones as far as its contour.
            let may_be_passed = is_outside || cell.is_parallel();
            if may_be_passed && active.discriminant.may_vanish() {
                let kind = Kind::Silhouette(position);
                self.conics.push((kind, active.discriminant));
            }
            if !self.is_mixed && !self.is_crowded && !active.is_dark {
                self.add_seams(cell, position);
            }
            self.is_crowded |= self.has_too_many_curves() || is_beyond_a_crowd(self.tests);
            let may_be_lit = is_outside && !active.is_dark;
            let may_be_shaded = may_be_lit && reaching != 0 && scene.world.shadows;
            let patch = may_be_shaded.then(|| {
                let Active {
                    ball,
                    discriminant,
                    along,
                    ..
                } = &active;
                Patch::new(cell, ball, discriminant, along)
            });
            for light in 0..scene.lights.len() {
                let may_reach = may_be_lit && reaching & (1 << light) != 0;
                let cutoff = match &scene.lights[light].near {
                    Some(near) if may_reach => {
                        let plane = scene.lights[light].cutoff(&active.ball);
                        plane.map(|plane| (plane, near.position))
                    }
                    _ => None,
                };
                let is_cut_off =
                    cutoff.is_some_and(|(plane, lamp)| active.is_beyond(cell, &plane, lamp));
                let reach = if may_reach && !is_cut_off {
                    if self.is_crowded {
                        self.reach.push(Reach::Past(0..0));
                        continue;
                    }
                    self.reach_of(scene, cell, (&active, patch.as_ref()), light, cache)
                } else {
                    Reach::Nowhere
                };
                let plane = active.terminators.plane(scene, &active.ball, light);
                // Through the center and across the view it coincides with the contour.
                let is_aligned = cell.is_parallel() && plane.as_ref().is_some_and(is_contour);
                let reach = match plane {
                    // It faces away from all that rays see.
                    Some(plane) if is_aligned && plane.axis.z > 0.0 => Reach::Nowhere,
                    _ => reach,
                };
                if let (Some(plane), Reach::Past(_), false) = (plane, &reach, is_aligned) {
                    let terminator = terminator(cell, &active.ball, &plane);
                    if terminator.may_vanish() {
                        self.conics
                            .push((Kind::Terminator(position, light), terminator));
                    }
                }
                if let (Some((plane, lamp)), Reach::Past(_)) = (cutoff, &reach) {
                    self.add_cutoff(cell, (position, light), &plane, lamp);
                }
                self.reach.push(reach);
            }
        }
        self.count_edges(cache);
        self.rounding += unresolved;
        self.add_outlines(scene, cell);
    }

    /// The same for the scene whose light is its normals: nothing shades them.
    pub(crate) fn of_normals(&self, into: &mut Self) {
        into.active.clear();
        let active = self.active.iter().map(|active| Active {
            terminators: Terminators::Nowhere,
            ..*active
        });
        into.active.extend(active);
        into.conics.clear();
        let is_of_light = |kind: &Kind| matches!(kind, Kind::Terminator(..) | Kind::Cutoff(..));
        let conics = self.conics.iter().filter(|(kind, _)| !is_of_light(kind));
        into.conics.extend(conics);
        into.occluders.clear();
        into.faces.clear();
        into.reach.clear();
        let lights = 3 * self.active.len();
        into.reach.extend((0..lights).map(|_| Reach::Past(0..0)));
        into.pixel = self.pixel;
        into.rounding = self.rounding;
    }

    /// Whether holding each curve against all that may cut it would cost more than a part of a pixel may.
    pub(super) fn has_too_many_curves(&self) -> bool {
        let curves = (self.conics.len() + self.occluders.len()) as u64;
        is_beyond_a_part(curves * (curves + self.active.len() as u64))
    }

    /// The spheres that the cell may see, those included of which only some rays begin inside.
    pub(crate) fn spheres(&self) -> impl Iterator<Item = usize> {
        let cut = self.cut.iter().filter(|_| self.is_mixed);
        let active = self.active.iter().map(|active| active.sphere);
        active.chain(cut.map(|(sphere, _)| *sphere))
    }

    /// Returns whether a cell sees one sphere alone, with nothing but its contour in it.
    pub(crate) fn is_contour_alone(&self) -> bool {
        let is_contour = |(kind, _): &(Kind, Quadratic)| matches!(kind, Kind::Silhouette(_));
        matches!(&self.active[..], [active] if active.ball.outside > 0.0 && !active.is_dark)
            && !self.is_mixed
            && !self.has_outlines()
            && self.occluders.is_empty()
            && self.conics.iter().all(is_contour)
    }

    /// Adds the curves in which an active sphere intersects those before it.
    fn add_seams(&mut self, cell: &Cell, position: usize) {
        let ball = self.active[position].ball;
        self.tests += (position / PAIRS_OF_A_TEST) as u64;
        for (index, other) in self.active[..position].iter().enumerate() {
            if other.is_dark {
                continue;
            }
            let apart_sq = (ball.center - other.ball.center).length_squared();
            let sum = ball.radius + other.ball.radius;
            // Most are far apart.
            if apart_sq > 1.001 * sum * sum {
                continue;
            }
            let apart = apart_sq.sqrt();
            let difference = (ball.radius - other.ball.radius).abs();
            let slack = GEOMETRY_SLACK * (sum + apart);
            if apart < sum + slack && apart > difference - slack && apart > 0.0 {
                let plane = SeamPlane::new(&ball, &other.ball);
                let seam = plane.seen(cell);
                self.tests += TESTS_OF_A_SEAM;
                if seam.may_vanish() {
                    self.conics.push((Kind::Seam(index, position), seam));
                    // It lies on both spheres, no nearer to the eye than either begins.
                    let distance = match cell.projection {
                        Projection::Central => ball.begin().abs().max(other.ball.begin().abs()),
                        Projection::Parallel => 1.0,
                    };
                    let size = cell.size[0].min(cell.size[1]) * distance.max(f64::MIN_POSITIVE);
                    let length = plane.scale + plane.small.center.length() + plane.small.radius;
                    self.rounding = self.rounding.max(ROUNDINGS * length / size);
                    let is_edge_on = match cell.projection {
                        Projection::Central => {
                            let past_eye = 0.5 * (ball.power - other.ball.power).abs() / apart;
                            past_eye < SEEN_EDGE_ON * ball.radius.min(other.ball.radius)
                        }
                        Projection::Parallel => plane.normal.z.abs() < SEEN_EDGE_ON,
                    };
                    if is_edge_on {
                        self.rounding = self.rounding.max(ROOT_OF_ROUNDING);
                    }
                }
            }
        }
    }
}

/// A bound of the width of a sphere's silhouette on the retina at distance 1; infinite where the sphere comes
/// near the eye's plane.
///
/// Along an axis the silhouette is 2 r √(c_x² + c_z² − r²) / (c_z² − r²) wide; through parallel rays 2 r.
pub(super) fn silhouette_width(ball: &Ball) -> f64 {
    if ball.is_parallel() {
        return 2.0 * ball.radius;
    }
    let product = (ball.center.z - ball.radius) * (ball.center.z + ball.radius);
    if ball.center.z > 2.0 * ball.radius {
        2.0 * ball.radius * ball.center.length() / product
    } else {
        f64::INFINITY
    }
}
