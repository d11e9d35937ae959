//! Panels are as short as what is seen moves, and no shorter.

use glam::DVec3;

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::exposure::Pose;
use crate::model::material::{Highlight, Material};
use crate::model::sphere::Sphere;
use crate::numeric::angle::Angle;

/// A camera that goes around a point which it looks at, by so many degrees.
#[derive(Debug)]
struct Around(f64);

impl Motion for Around {
    fn pose(&self, time: f64) -> Option<Pose> {
        let pan = Angle::from_degrees(self.0 * time);
        let ahead = Camera::free(DVec3::ZERO, pan, Angle::ZERO, Angle::ZERO);
        let position = ahead.world_from_camera * DVec3::new(0.0, 0.0, -10.0);
        Some(Pose {
            camera: Camera {
                position,
                on_axis: position,
                ..ahead
            },
            zoom: 1.0,
        })
    }

    fn is_smooth(&self) -> bool {
        true
    }
}

/// In the middle of the picture the surface stands still, and what is behind it does not.
#[test]
fn highlights_move_unlike_the_surface() {
    let motion = Around(6.0);
    let view = View {
        camera: motion.pose(0.0).unwrap().camera,
        lens: Lens {
            width: 1.0,
            distance: 1.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 320,
        height: 240,
        frame: 1,
    };
    let levels = [None, Some(0.5)].map(|strength| {
        let mut world = World::new();
        let material = world.add_material(Material {
            highlight: strength.map(|strength| Highlight {
                strength,
                shininess: 20.0,
            }),
            ..Material::MATTE_WHITE
        });
        let sphere = Sphere::new(DVec3::new(0.0, 0.0, 40.0), 40.0);
        world.add_sphere(sphere.unwrap(), material);
        let levels = PanelLevels::new(&world, &view, &motion, 1e-3);
        levels.at(160, 120).level
    });
    assert!(levels[1] > levels[0] + 1, "{levels:?}");
}

#[test]
fn panels_are_as_short_as_they_have_to_be() {
    for (travel, lowest) in [(0.0, 0), (0.4, 0), (7.0, 0), (7.0, 1), (30.0, 0), (30.0, 1)] {
        let start = FirstPanels::new(travel, 1e-3, lowest);
        assert!(start.is_fine && start.missed <= SHARE * 1e-3);
        let is_least = start.level == lowest || missed(travel, start.level - 1) > SHARE * 1e-3;
        assert!(start.level >= lowest && is_least, "{start:?}");
    }
    let lost = FirstPanels::new(1e5, 1e-3, 0);
    assert!(!lost.is_fine && lost.missed == 1.0);
}

/// Whole turns between the moments at which travel is measured look like none.
#[test]
fn whole_turns_are_not_taken_for_rest() {
    let motion = Around(8.0 * 360.0 * 1000.0);
    let view = View {
        camera: motion.pose(0.0).unwrap().camera,
        lens: Lens {
            width: 1.0,
            distance: 1.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 32,
        height: 24,
        frame: 1,
    };
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    world.add_sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap(), white);
    let levels = PanelLevels::new(&world, &view, &motion, 1e-3);
    let first = levels.at(16, 12);
    assert!(!first.is_fine && first.missed == 1.0, "{first:?}");
    assert_eq!(first.level, BLIND);
}
