use super::*;

const WANTED: Quantities = Quantities(0).with(Quantity::Depth).with(Quantity::Position);

/// Sixteen columns and two rows, the left tile of which sees spheres numbered from its corner on.
fn geometry() -> Geometry {
    let mut geometry = Geometry::new((16, 2), WANTED, None);
    let mut seen = TileGeometry::default();
    for (number, row) in seen.rows.iter_mut().enumerate() {
        row.sees_any = true;
        for col in 0..SIDE {
            row.ids[col] = (10 * number + col) as u32;
            row.of_mut(Quantity::Position)[2][col] = (100 * number + col) as f64;
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

#[test]
fn what_no_ray_meets_has_the_values_of_nothing() {
    let geometry = geometry();
    assert_eq!(geometry.ids(0)[8], Geometry::NOTHING);
    assert_eq!(
        geometry.values(Quantity::Depth, 0, 1).unwrap()[15],
        f64::INFINITY
    );
    assert_eq!(geometry.values(Quantity::Position, 1, 1).unwrap()[15], 0.0);
    assert_eq!(geometry.values(Quantity::Normal, 0, 0), None);
}

#[test]
fn tiles_lie_where_they_belong_and_parts_are_cut_there() {
    let geometry = geometry();
    assert_eq!(geometry.ids(1)[..3], [10, 11, 12]);
    assert_eq!(geometry.values(Quantity::Position, 2, 1).unwrap()[3], 103.0);
    let part = geometry.cut(Window {
        col: 2,
        row: 1,
        width: 7,
        height: 1,
    });
    assert_eq!(part.ids(0), [12, 13, 14, 15, 16, 17, Geometry::NOTHING]);
    assert_eq!(
        part.values(Quantity::Position, 2, 0),
        geometry
            .values(Quantity::Position, 2, 1)
            .map(|row| &row[2..9])
    );
}
