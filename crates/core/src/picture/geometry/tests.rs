use super::*;
use crate::picture::averages::AverageSettings;
use crate::picture::quantities::{Axes, Depth};

const SETTINGS: GeometrySettings = GeometrySettings {
    quantities: Quantities::NONE
        .with(Quantity::Depth)
        .with(Quantity::Position),
    depth: Depth::Axis,
    axes: Axes::World,
    precision: Precision::Single,
    averages: AverageSettings {
        normal: false,
        coverage: false,
        tolerance: 1e-3,
    },
};

/// Sixteen columns and two rows, the left tile of which sees spheres numbered from its corner on.
fn geometry() -> Geometry {
    let mut geometry = Geometry::new((16, 2), &SETTINGS, None);
    let mut seen = TileGeometry::default();
    for (number, row) in seen.rows.iter_mut().enumerate() {
        row.sees_any = true;
        for col in 0..SIDE {
            row.ids[col] = (10 * number + col) as u32;
            row.put_one((Quantity::Position, 2), col, (100 * number + col) as f64);
        }
    }
    let tile = Tile {
        col: 32,
        row: 8,
        width: 8,
        height: 2,
    };
    geometry.write(tile, (32, 8), &seen);
    geometry
}

fn values(geometry: &Geometry, quantity: Quantity, component: usize, row: u32) -> Vec<f64> {
    geometry.values(quantity, component, row).unwrap().collect()
}

fn ids(geometry: &Geometry, row: u32) -> Vec<u32> {
    geometry.ids(row).collect()
}

#[test]
fn what_no_ray_meets_has_the_values_of_nothing() {
    let geometry = geometry();
    assert_eq!(ids(&geometry, 0)[8], Geometry::NOTHING);
    assert_eq!(values(&geometry, Quantity::Depth, 0, 1)[15], f64::INFINITY);
    assert_eq!(values(&geometry, Quantity::Position, 1, 1)[15], 0.0);
    assert!(geometry.values(Quantity::Normal, 0, 0).is_none());
}

#[test]
fn tiles_lie_where_they_belong_and_parts_are_cut_there() {
    let geometry = geometry();
    assert_eq!(ids(&geometry, 1)[..3], [10, 11, 12]);
    let whole = values(&geometry, Quantity::Position, 2, 1);
    assert_eq!(whole[3], 103.0);
    let part = geometry.cut(Window {
        col: 2,
        row: 1,
        width: 7,
        height: 1,
    });
    let nothing = Geometry::NOTHING;
    assert_eq!(ids(&part, 0), [12, 13, 14, 15, 16, 17, nothing]);
    assert_eq!(values(&part, Quantity::Position, 2, 0), whole[2..9]);
    // Its memory is used anew, and sees nothing.
    let empty = Geometry::new((9, 1), &SETTINGS, Some(part));
    assert_eq!(ids(&empty, 0), [nothing; 9]);
}
