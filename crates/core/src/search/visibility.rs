//! A world, ready to be asked what stands between a point and a light.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::discs::DiscCache;
use super::hierarchy::Hierarchy;
use super::nested::Nested;
use super::occluders::Occluders;
use super::point_occluders::PointOccluders;
use crate::model::light::Light;
use crate::model::ray::Ray;
use crate::model::sky::Sky;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::{LightPart, World};
use crate::patches::known::Patches;

/// Lengths whose squares are far from over- and underflow.
const MODERATE: Range<f64> = 1e-35..1e35;

/// In worlds of so many spheres views are searched from front to back: most spheres are hidden, or
/// not in the picture. Not tuned: with fewer the hierarchy costs more than it leaves out, and with
/// more the sorting of all spheres does.
const CROWD: usize = 1 << 15;

/// The spheres of a world, its lights, and for every light those that may keep it from a point; copies share it
/// all.
#[derive(Clone, Debug)]
pub(crate) struct Visibility<'world> {
    spheres: &'world [Sphere],
    /// In a world of shadows, or of very many spheres.
    pub(super) hierarchy: Option<Arc<Hierarchy>>,
    /// The lights, which may be others than the world's.
    all_lights: Arc<[Light]>,
    /// Those without a disc, whose shadows have edges.
    lights: Arc<[Light]>,
    /// The sky, which may be another than the world's.
    sky: Option<Sky>,
    /// One for each light; none in a world without shadows.
    occluders: Arc<[Occlusion<'world>]>,
    /// True where squares of all lengths are far from over- and underflow.
    is_moderate: bool,
    extent: Extent,
    /// The same world without nested spheres, where it has many.
    outer: Option<Arc<OuterSpheres<'world>>>,
    /// Those of the spheres that are left out in it.
    left_out: Option<Arc<Nested>>,
    /// What is known of the light of a sky.
    patches: Arc<Patches>,
}

/// A world without the spheres that lie inside of others.
#[derive(Clone, Debug)]
struct OuterSpheres<'world> {
    nested: Arc<Nested>,
    visibility: Visibility<'world>,
}

/// The spheres that may keep a light from points.
#[derive(Clone, Debug)]
enum Occlusion<'world> {
    Discs(DiscCache<'world>),
    Point(PointOccluders<'world>),
}

/// Bounds of all spheres together.
#[derive(Clone, Copy, Debug)]
struct Extent {
    /// The least and the greatest coordinates of centers; infinite where there are none.
    low: DVec3,
    high: DVec3,
    smallest_radius: f64,
    largest_radius: f64,
}

impl Extent {
    fn new(spheres: &[Sphere]) -> Self {
        let mut extent = Self {
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
            smallest_radius: f64::INFINITY,
            largest_radius: 0.0,
        };
        for sphere in spheres {
            extent.low = extent.low.min(sphere.center());
            extent.high = extent.high.max(sphere.center());
            extent.smallest_radius = extent.smallest_radius.min(sphere.radius());
            extent.largest_radius = extent.largest_radius.max(sphere.radius());
        }
        extent
    }

    fn is_moderate(&self) -> bool {
        let largest = self.low.abs().max(self.high.abs()).max_element();
        MODERATE.contains(&self.smallest_radius)
            && MODERATE.contains(&self.largest_radius)
            && largest < MODERATE.end
    }
}

/// Returns whether searches in a world need a hierarchy.
fn has_hierarchy(world: &World) -> bool {
    let casts_shadows = world.shadows && (!world.lights.is_empty() || world.sky.is_some());
    casts_shadows || world.spheres().len() >= CROWD
}

impl<'world> Visibility<'world> {
    /// About the most bytes that the search in a world takes while it is prepared.
    pub(crate) fn most_bytes(world: &World) -> u64 {
        if has_hierarchy(world) {
            Hierarchy::most_bytes(world.spheres())
        } else {
            0
        }
    }

    /// Prepares the search in a world.
    pub(crate) fn new(world: &'world World) -> Self {
        let spheres = world.spheres();
        let is_asked = has_hierarchy(world);
        let extent = Extent::new(spheres);
        let mut unlit = Self {
            spheres,
            hierarchy: is_asked.then(|| Arc::new(Hierarchy::new(spheres))),
            lights: Arc::new([]),
            all_lights: Arc::new([]),
            sky: world.sky,
            occluders: Arc::new([]),
            is_moderate: spheres.is_empty() || extent.is_moderate(),
            extent,
            outer: None,
            left_out: None,
            patches: Arc::default(),
        };
        unlit.outer = unlit.outer_spheres().map(Arc::new);
        unlit.with_lights(world, world.lights.as_slice().into())
    }

    /// The same world without nested spheres, if it has many.
    fn outer_spheres(&self) -> Option<OuterSpheres<'world>> {
        let hierarchy = self.hierarchy.as_deref().filter(|_| self.is_moderate)?;
        let nested = Arc::new(Nested::find(self.spheres, hierarchy)?);
        let hierarchy = Hierarchy::without(self.spheres, Some(&nested.is_nested));
        let visibility = Self {
            hierarchy: Some(Arc::new(hierarchy)),
            left_out: Some(Arc::clone(&nested)),
            patches: Arc::default(),
            ..self.clone()
        };
        Some(OuterSpheres { nested, visibility })
    }

    /// The visibility to use for a view: without nested spheres, if it sees nothing of them.
    pub(crate) fn of_view(&self, view: &View) -> &Self {
        match &self.outer {
            Some(outer) if outer.nested.are_hidden_from(view) => &outer.visibility,
            _ => self,
        }
    }

    /// The same that another visibility of these spheres leaves out is left out.
    pub(super) fn as_in(&self, other: &Visibility<'_>) -> &Self {
        match &self.outer {
            Some(outer) if other.left_out.is_some() => &outer.visibility,
            _ => self,
        }
    }

    /// Returns whether a sphere is seen by no view.
    pub(super) fn leaves_out(&self, sphere: usize) -> bool {
        let nested = self.left_out.as_deref();
        nested.is_some_and(|nested| nested.is_nested[sphere])
    }

    /// What is known of the light of its sky.
    pub(crate) fn patches(&self) -> &Patches {
        &self.patches
    }

    /// The same world, or one of the same spheres, under other lights, as many as it has.
    pub(crate) fn with_lights(&self, world: &World, lights: Arc<[Light]>) -> Self {
        let hard = lights.iter().filter(|light| light.sun().is_none());
        let hard: Arc<[Light]> = hard.copied().collect();
        let casting = if world.shadows { &hard[..] } else { &[] };
        let of_light = |light: &Light| {
            let hierarchy = self.hierarchy.clone()?;
            Some(match light {
                Light::Directional(light) => {
                    let occluders = Occluders::new(self.spheres, hierarchy, light.toward());
                    Occlusion::Discs(DiscCache::new(occluders))
                }
                Light::Point(light) => Occlusion::Point(PointOccluders::new(
                    self.spheres,
                    hierarchy,
                    light.position(),
                    self.extent.smallest_radius,
                )),
            })
        };
        let outer = self.outer.as_deref().map(|outer| OuterSpheres {
            visibility: outer.visibility.with_lights(world, Arc::clone(&lights)),
            ..outer.clone()
        });
        Self {
            occluders: casting.iter().filter_map(of_light).collect(),
            lights: hard,
            all_lights: lights,
            sky: self.sky.filter(|_| world.sky.is_some()),
            outer: outer.map(Arc::new),
            ..self.clone()
        }
    }

    /// The same world under another sky, if it has one.
    pub(crate) fn with_sky(&self, sky: Sky) -> Self {
        let Some(before) = self.sky else {
            return self.clone();
        };
        let patches = match before.has_parts_of(&sky) {
            true => Arc::clone(&self.patches),
            false => Arc::default(),
        };
        let outer = self.outer.as_deref().map(|outer| OuterSpheres {
            visibility: outer.visibility.with_sky(sky),
            ..outer.clone()
        });
        Self {
            sky: Some(sky),
            patches,
            outer: outer.map(Arc::new),
            ..self.clone()
        }
    }

    /// The same for a part of the light.
    pub(crate) fn under(&self, part: LightPart) -> Self {
        let index = match part {
            LightPart::Ambient | LightPart::Sky => None,
            LightPart::Light(index) => Some(index),
        };
        let light = index.map(|index| self.all_lights[index]);
        // Its place among those without a disc.
        let index = index.filter(|&index| self.all_lights[index].sun().is_none());
        let index = index.map(|index| {
            let before = self.all_lights[..index].iter();
            before.filter(|light| light.sun().is_none()).count()
        });
        // There is none in a world without shadows.
        let occluders = index.and_then(|index| self.occluders.get(index));
        let outer = self.outer.as_deref().map(|outer| OuterSpheres {
            visibility: outer.visibility.under(part),
            ..outer.clone()
        });
        Self {
            lights: index.map(|index| self.lights[index]).into_iter().collect(),
            all_lights: light.into_iter().collect(),
            sky: self.sky.filter(|_| part == LightPart::Sky),
            occluders: occluders.cloned().into_iter().collect(),
            outer: outer.map(Arc::new),
            ..self.clone()
        }
    }

    /// The lights without a disc.
    pub(crate) fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// All lights.
    pub(crate) fn all_lights(&self) -> &[Light] {
        &self.all_lights
    }

    /// The sky.
    pub(crate) fn sky(&self) -> Option<Sky> {
        self.sky
    }

    /// All spheres in a hierarchy, if any hide light from others.
    pub(crate) fn hierarchy(&self) -> Option<&Hierarchy> {
        self.hierarchy.as_deref()
    }

    /// The hierarchy that finds what a view sees, where asking sphere by sphere takes too long.
    pub(super) fn hierarchy_of_crowd(&self) -> Option<&Hierarchy> {
        let is_crowd = self.spheres.len() >= CROWD && self.is_moderate;
        self.hierarchy.as_deref().filter(|_| is_crowd)
    }

    /// True where squares of all lengths of the spheres are far from over- and underflow.
    pub(crate) fn is_moderate(&self) -> bool {
        self.is_moderate
    }

    /// The spheres, by their indices.
    pub(crate) fn spheres(&self) -> &'world [Sphere] {
        self.spheres
    }

    /// The spheres as the directional light with this index sees them.
    ///
    /// # Panics
    /// Where it is a point light.
    pub(crate) fn light(&self, index: usize) -> &DiscCache<'world> {
        match &self.occluders[index] {
            Occlusion::Discs(discs) => discs,
            Occlusion::Point(_) => unreachable!("the discs of a point light"),
        }
    }

    /// Makes ready for shadow rays toward directional lights, from so many rows of samples, one for each pixel.
    pub(crate) fn expect_rows(&self, rows: u64) {
        let casting = if self.is_moderate {
            &self.occluders[..]
        } else {
            &[]
        };
        for occlusion in casting {
            if let Occlusion::Discs(discs) = occlusion {
                discs.expect(rows);
            }
        }
    }

    /// The spheres as the point light with this index sees them; none in a world without shadows, or for another light.
    pub(crate) fn point_light(&self, index: usize) -> Option<&PointOccluders<'world>> {
        match self.occluders.get(index)? {
            Occlusion::Discs(_) => None,
            Occlusion::Point(occluders) => Some(occluders),
        }
    }

    /// Says whether any sphere but the one with the index `except` stands between a point of that
    /// one's surface, known up to a distance of `point_error`, and the light with this index.
    ///
    /// Another sphere whose surface passes through the point within that error hides the light if
    /// it lies toward it: coincident spheres do not darken each other, touching ones do not leak.
    pub(crate) fn is_blocked(
        &self,
        light: usize,
        to_light: &Ray,
        point_error: f64,
        except: usize,
    ) -> bool {
        let occluders = self.light(light).occluders();
        occluders.any(to_light.origin, point_error, |index| {
            self.hides(index, to_light, point_error, except)
        })
    }

    /// Says whether a sphere stands there.
    #[inline(always)]
    pub(super) fn hides(
        &self,
        sphere: usize,
        to_light: &Ray,
        point_error: f64,
        except: usize,
    ) -> bool {
        let occluder = &self.spheres[sphere];
        // A sphere that coincides with the point's own is settled by n·l as that one is.
        sphere != except
            && occluder.is_met(to_light, point_error)
            && *occluder != self.spheres[except]
    }

    /// Says whether something `holds` for any of the spheres that may keep the light with this index
    /// from points of space that lie within `around` of `points` or between them, and outside of the spheres: each is
    /// asked once, those sooner, by and large, that lie nearer, until it does.
    ///
    /// What lies outside of a sphere is shaded only if it lies lower than the sphere's center.
    pub(crate) fn any_occluder(
        &self,
        light: usize,
        points: &[DVec3],
        around: f64,
        holds: impl FnMut(usize) -> bool,
    ) -> bool {
        let occluders = self.light(light).occluders();
        let heights = points.iter().map(|&point| occluders.height(point));
        // A pixel asks for points as far around what it sees, and counts them so much lower.
        let lowest = heights.fold(f64::INFINITY, f64::min) - 2.0 * around;
        let lowest_top = lowest + self.extent.smallest_radius;
        occluders.any_within(points, around, lowest_top.max(lowest + around), holds)
    }

    /// The largest finite radius or coordinate of a center as seen from the viewpoint.
    pub(super) fn largest_size(&self, viewpoint: DVec3) -> f64 {
        let Extent { low, high, .. } = self.extent;
        // Differences round in the order of the numbers: none is larger than that of a bound.
        let farthest = (low - viewpoint).abs().max((high - viewpoint).abs());
        let largest = farthest.max_element().max(self.extent.largest_radius);
        if largest.is_finite() {
            return largest;
        }
        let size = |sphere: &Sphere| {
            let to_center = (sphere.center() - viewpoint).abs().max_element();
            to_center.max(sphere.radius())
        };
        let sizes = self.spheres.iter().map(size);
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    }
}
