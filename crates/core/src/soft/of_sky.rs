//! The light of a sky in one pixel.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::bodies::Bodies;
use super::candidate::Candidate;
use super::curve::Curve;
use super::doubt::{Extent, of_bumps, of_shadows, of_small_spheres};
use super::edges::Break;
use super::gather::Neighborhood;
use super::list::{arrange, gathered, missed, of_part};
use super::node::light_at_node;
use super::point::{Occluders, SurfacePoint};
use super::rectangle::{Along, Cell, Contents, Light, Lit};
use super::rule::whole_integral;
use super::scene::Soft;
use super::sky::{light_of, reached};
use super::visible::Hidden;
use crate::light::shading_normal::ShadingNormal;
use crate::model::camera::Projection;
use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::NoiseCells;
use crate::model::sky::Sky;
use crate::model::sphere::Sphere;
use crate::patches::known::Patches;
use crate::patches::light::{NodeLight, Shares};
use crate::patches::patch::Patch;
use crate::patches::square::{Node, Square, WIDEST, point as point_of};

/// Squares of which a thread knows the patch, and the spheres that may hide light from them.
const KNOWN: usize = 1 << 10;
const KNOWN_LISTS: usize = 1 << 12;

/// What a thread keeps for skies.
#[derive(Debug)]
pub(crate) struct SkyMemory {
    patches: Vec<Option<(Square, Arc<Patch>)>>,
    lists: Vec<Option<(Square, Arc<Vec<u32>>)>>,
    /// The spheres of a square's list side by side.
    arranged: Option<Square>,
    bodies: Bodies,
    noise: Option<Box<NoiseCells>>,
}

impl Default for SkyMemory {
    fn default() -> Self {
        Self {
            patches: vec![None; KNOWN],
            lists: vec![None; KNOWN_LISTS],
            arranged: None,
            bodies: Bodies::default(),
            noise: None,
        }
    }
}

impl SkyMemory {
    /// Forgets another world.
    pub(crate) fn begin(&mut self) {
        self.patches.fill(None);
        self.lists.fill(None);
        self.arranged = None;
    }
}

/// The width of the squares that are tried first, in pixels and in radians.
const FIRST: f64 = 16.0;
const FIRST_ANGLE: f64 = 0.5;

/// That of the last ones, in parts of a cell. Not tuned.
const NARROWEST: f64 = 0.25;

/// What a point may claim in a pixel, and in parts of a pixel that claims too much, in parts of the tolerance. Not tuned.
const OF_WHOLE: f64 = 1.0;
const OF_PARTS: f64 = 0.5;

/// The light of a sky in one pixel.
pub(crate) struct OfSky<'a, 'scene> {
    pub(crate) soft: &'a Soft<'scene>,
    pub(crate) sky: &'a Sky,
    pub(crate) patches: &'a Patches,
    pub(crate) key: PixelKey,
    pub(crate) projection: Projection,
    /// The side of a pixel, on the plane at the distance 1 or in the units of candidates, and that of the cell.
    pub(crate) pixel: f64,
    pub(crate) side: f64,
    /// The error that is allowed of patches.
    pub(crate) allowed: f64,
    pub(crate) memory: &'a mut SkyMemory,
    pub(crate) hidden: &'a mut Hidden,
}

impl OfSky<'_, '_> {
    fn shading(&self, candidate: &Candidate) -> ShadingNormal {
        ShadingNormal::new(self.soft.world, candidate.sphere, self.key)
    }

    /// The spheres that may hide light from a square.
    ///
    /// The list of a square of some level is gathered from all spheres, those of smaller ones from the list of a square that
    /// they are a part of: so a list is what its square says, whatever was made before.
    fn list(&mut self, square: &Square, occluders: &Occluders<'_>) -> Arc<Vec<u32>> {
        let place = square.hash() as usize % KNOWN_LISTS;
        if let Some((of, list)) = &self.memory.lists[place]
            && of == square
        {
            return Arc::clone(list);
        }
        let list = match square.next_home() {
            Some(around) => Arc::new(of_part(&self.list(&around, occluders), square, occluders)),
            None => self.patches.list(square, || gathered(square, occluders)),
        };
        self.memory.lists[place] = Some((*square, Arc::clone(&list)));
        list
    }

    /// Puts the spheres that may hide light from a square that has a list side by side.
    fn arrange(&mut self, home: Square, occluders: &Occluders<'_>) {
        if self.memory.arranged != Some(home) {
            let list = self.list(&home, occluders);
            arrange(&list, occluders, &mut self.memory.bodies);
            self.memory.arranged = Some(home);
        }
    }

    /// The light at a node.
    fn node(&mut self, node: &Node, occluders: &Occluders<'_>) -> NodeLight {
        let patches = self.patches;
        patches.node(node, || {
            let home = node.home();
            self.arrange(home, occluders);
            let at = (home.sphere as usize, node.normal());
            let bodies = &self.memory.bodies;
            light_at_node(self.sky, at, (bodies, occluders.spheres), self.hidden)
        })
    }

    /// The patch of a square; none in a world without shadows.
    fn patch(&mut self, square: &Square) -> Option<Arc<Patch>> {
        let occluders = self.soft.occluders()?;
        let hash = square.hash();
        let place = hash as usize % KNOWN;
        if let Some((of, patch)) = &self.memory.patches[place]
            && of == square
        {
            return Some(Arc::clone(patch));
        }
        let patches = self.patches;
        let patch = patches.patch(square, || {
            // Nodes of this square need that list, too.
            let list = self.list(&square.home(), &occluders);
            let missed = missed(&list, square, &occluders);
            let mut light = |node: &Node| self.node(node, &occluders);
            Patch::new(square, missed, occluders.spheres, &mut light)
        });
        self.memory.patches[place] = Some((*square, Arc::clone(&patch)));
        Some(patch)
    }

    /// The normal at a place in the world's frame, and the angle that the unit of cells spans there, seen from the center.
    fn normal_and_unit(&self, candidate: &Candidate, place: DVec2) -> (DVec3, f64) {
        let point = candidate.surface_point(place.x, place.y, self.projection);
        let unit = match self.projection {
            Projection::Central => point.position.z / candidate.radius,
            Projection::Parallel => 1.0 / candidate.radius,
        };
        let normal = self.soft.view.camera.world_from_camera * point.normal;
        (normal, unit)
    }

    /// The width of the squares that are tried first, in radians.
    fn first_width(&self, unit: f64) -> f64 {
        (FIRST * self.pixel * unit).min(FIRST_ANGLE)
    }

    /// The light of a smooth surface at a place, by a patch that claims little enough, or is small enough.
    ///
    /// Where light has an edge, a patch claims much in a part of the cell as wide as its square.
    fn of_patches(&mut self, candidate: &Candidate, place: DVec2) -> Option<(Shares, f64)> {
        let (normal, unit) = self.normal_and_unit(candidate, place);
        let cell = self.side * unit;
        // Of a whole pixel, few points claim the most.
        let is_whole = self.side > 0.75 * self.pixel;
        let most = self.allowed * if is_whole { OF_WHOLE } else { OF_PARTS };
        let mut width = self.first_width(unit);
        let first = Square::level_of(normal, width).max(WIDEST.into());
        let last = Square::level_of(normal, NARROWEST * cell);
        for level in first..=last.max(first) {
            let square = Square::around(candidate.sphere, normal, level);
            let at = square.locate(normal);
            let allowed = most * (cell / width).max(1.0);
            let patch = self.patch(&square)?;
            let claim = patch.claim;
            if claim <= allowed || level >= last {
                let spheres = self.soft.world.spheres();
                let position = point_of(&spheres[candidate.sphere], normal);
                return Some((patch.at(at, position, spheres), claim));
            }
            width *= 0.5;
        }
        None
    }

    /// What corners and the middle of a cell see of a sphere, in the world's frame.
    ///
    /// An [`Extent`] is a bound, and much larger where a huge sphere is seen at a grazing angle.
    fn seen(&self, candidate: &Candidate, cell: &Cell) -> Neighborhood {
        let axes = &self.soft.view.camera.world_from_camera;
        let sphere = &self.soft.world.spheres()[candidate.sphere];
        let normal_at = |at: DVec2| {
            let point = candidate.surface_point(at.x, at.y, self.projection);
            *axes * point.normal
        };
        let normal = normal_at(cell.middle());
        let mut turn: f64 = 0.0;
        for u in cell.u {
            for v in cell.v {
                turn = turn.max((normal_at(DVec2::new(u, v)) - normal).length());
            }
        }
        Neighborhood {
            middle: point_of(sphere, normal),
            around: turn * sphere.radius(),
            normal,
            turn,
        }
    }

    /// The height of what the eye sees of a candidate right below another sphere, in parts of a cell's side.
    fn part_near(&self, other: &Sphere, candidate: &Candidate, cell: &Cell) -> f64 {
        let own = &self.soft.world.spheres()[candidate.sphere];
        let normal = (other.center() - own.center()).normalize();
        let camera = &self.soft.view.camera;
        // Its length as seen, at a distance at which the cell's side has this length.
        let (slant, side) = match self.projection {
            Projection::Central => {
                let to_eye = camera.position - point_of(own, normal);
                let distance = to_eye.length();
                let flat = 1.0 + cell.middle().length_squared();
                (
                    normal.dot(to_eye).abs() / distance,
                    (cell.v[1] - cell.v[0]) * distance / flat,
                )
            }
            Projection::Parallel => {
                let scale = libm::scalbn(1.0, self.soft.index.length_exponent());
                let forward = camera.world_from_camera.z_axis;
                (normal.dot(forward).abs(), (cell.v[1] - cell.v[0]) * scale)
            }
        };
        2.0 * other.radius() * slant / side
    }

    /// The light at a place, from the caps of all spheres that may hide some of it.
    fn exactly(&mut self, candidate: &Candidate, place: DVec2) -> Option<Lit> {
        let ray = self.soft.ray(place);
        let world = self.soft.world;
        let hit = world.spheres()[candidate.sphere].hit_from_viewpoint(&ray)?;
        let noise = &mut self.memory.noise;
        let point: SurfacePoint = self
            .soft
            .point(candidate.sphere, &ray, &hit, self.key, noise)?;
        match self.soft.occluders() {
            Some(occluders) => {
                let (normal, unit) = self.normal_and_unit(candidate, place);
                let level = Square::level_of(normal, self.first_width(unit)).max(WIDEST.into());
                let square = Square::around(candidate.sphere, normal, level);
                self.arrange(square.home(), &occluders);
            }
            None => {
                self.memory.bodies.clear();
                self.memory.arranged = None;
            }
        }
        let bodies = &self.memory.bodies;
        let reached = reached(self.sky, &point, bodies, self.hidden, &mut |_| {});
        Some(Lit {
            light: world.albedo(candidate.sphere) * light_of(self.sky, reached.shares),
            error: 0.0,
        })
    }
}

impl Light for OfSky<'_, '_> {
    fn at(&mut self, candidate: &Candidate, place: DVec2) -> Option<Lit> {
        if self.shading(candidate).is_smooth()
            && let Some((shares, claim)) = self.of_patches(candidate, place)
        {
            let albedo = self.soft.world.albedo(candidate.sphere);
            return Some(Lit {
                light: albedo * light_of(self.sky, shares),
                error: claim * self.brightest(),
            });
        }
        self.exactly(candidate, place)
    }

    fn doubt(&mut self, candidate: &Candidate, cell: &Cell, spacing: f64) -> f64 {
        let shading = self.shading(candidate);
        let soft = self.soft;
        let (sphere, occluders) = (candidate.sphere, soft.occluders());
        if shading.is_smooth() {
            let seen = self.seen(candidate, cell);
            let part_near = |other: &Sphere| self.part_near(other, candidate, cell);
            let doubt = of_shadows(&seen, spacing, sphere, occluders.as_ref(), &part_near);
            return doubt * self.brightest();
        }
        let scale = libm::scalbn(1.0, soft.index.length_exponent());
        let extent = Extent::new(candidate, [cell.u, cell.v], self.projection);
        let axes = &soft.view.camera.world_from_camera;
        let extent = extent.in_world(axes, soft.view.camera.position, scale);
        let of_spheres = of_small_spheres(&extent, sphere, occluders.as_ref());
        of_bumps(&extent, spacing, &shading).max(of_spheres) * self.brightest()
    }

    /// Patches know what they are asked for often, and how finely depends on the cell.
    fn is_shared(&self, candidate: &Candidate) -> bool {
        matches!(self.shading(candidate), ShadingNormal::Bumpy(_))
    }

    fn brightest(&self) -> f64 {
        self.sky.brightest().max_element()
    }

    fn may_see(&self, candidate: &Candidate, cell: &Cell) -> bool {
        candidate.may_be_in(cell.u, cell.v, self.projection)
    }

    fn contents(&mut self, _candidate: &Candidate, cell: &Cell, _number: usize) -> Contents {
        self.side = cell.u[1] - cell.u[0];
        Contents::Smooth { doubt: 0.0 }
    }

    /// Near other spheres the light goes with the square root of the distance from them.
    fn has_roots_at_seams(&self) -> bool {
        true
    }

    fn along(
        &mut self,
        (candidate, _): (&Candidate, usize),
        curve: &Curve,
        _breaks: &[Break],
        limit: f64,
    ) -> Along {
        whole_integral(self, candidate, curve, limit)
    }
}
