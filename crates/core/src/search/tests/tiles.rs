//! Tiles ask the spheres that reach into them, and few others.

use super::*;

/// Counted work: most spheres are not even asked.
#[test]
fn tiles_ask_few_spheres() {
    let mut random = Random(5);
    let balls: Vec<_> = (0..1000)
        .map(|_| (random.point() * 100.0, 3.0 + 9.0 * random.number()))
        .collect();
    let world = world_of(balls, &mut random);
    let visibility = Visibility::new(&world);
    let degrees = Angle::from_degrees(20.0);
    let camera = Camera::orbit(DVec3::ZERO, 400.0, degrees, degrees, Angle::ZERO);
    let lens = Lens {
        width: 600.0,
        distance: 700.0,
        shift: DVec2::ZERO,
        pixel_aspect: 1.0,
    };
    let view = View {
        camera,
        lens,
        zoom: 1.0,
        width: 600,
        height: 600,
        frame: 1,
    };
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let tiles = (0..75).flat_map(|row| (0..75).map(move |col| (row * SIDE, col * SIDE)));
    let candidates: usize = tiles
        .map(|(row, col)| {
            let tile = Tile {
                col,
                row,
                width: SIDE,
                height: SIDE,
            };
            index.balls(tile).count()
        })
        .sum();
    assert!(
        candidates < 10 * 75 * 75,
        "{} a tile",
        candidates as f64 / (75.0 * 75.0)
    );
}

/// Spheres that reach into a tile by a ten-thousandth of their radius.
#[test]
fn spheres_that_barely_reach_into_a_tile_are_among_its_candidates() {
    let mut random = Random(6);
    for _ in 0..2000 {
        let view = view(&mut random);
        let col = SIDE * (1 + (3.0 * random.number()) as u32);
        let row = SIDE;
        // A point on one of the tile's edges, and the way out of the tile from there.
        let along = random.number() * f64::from(SIDE);
        let fine = f64::from(FINE);
        let (left, top) = (f64::from(col), f64::from(row));
        let side = f64::from(SIDE);
        let (across, beyond) = match (4.0 * random.number()) as u32 {
            0 => ((left, top + along), DVec2::NEG_X),
            1 => ((left + side, top + along), DVec2::X),
            2 => ((left + along, top), DVec2::Y),
            _ => ((left + along, top + side), DVec2::NEG_Y),
        };
        let cell = |pixels: f64| (pixels * fine) as u64;
        let on_edge = view.cell_center(cell(across.0), cell(across.1), FINE);
        let direction = view.ray(on_edge).direction;
        let other = view.ray(on_edge + beyond * view.lens.width).direction;
        // Out of the tile, across its plane.
        let plane = direction.cross(direction.cross(other)).normalize();
        let outward = if plane.dot(other) < 0.0 {
            -plane
        } else {
            plane
        };
        let edge_along = view
            .ray(on_edge + beyond.perp() * view.lens.width)
            .direction;
        let normal = direction.cross(edge_along).normalize();
        let normal = if normal.dot(outward) < 0.0 {
            -normal
        } else {
            normal
        };
        let radius = 0.01 + random.number();
        let touch = view.camera.position + direction * (1.0 + 5.0 * random.number());
        let center = touch + normal * (radius * (1.0 - 1e-4));
        let world = world_of([(center, radius)], &mut random);
        let visibility = Visibility::new(&world);
        let index = ViewIndex::new(&visibility, &view, RayPoints::All);
        let width = SIDE.min(view.width - col);
        let height = SIDE.min(view.height - row);
        assert_eq!(
            index
                .balls(Tile {
                    col,
                    row,
                    width,
                    height
                })
                .count(),
            1
        );
    }
}
