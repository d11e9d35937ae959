use super::*;

#[test]
fn a_cell_of_lengths_and_angles_has_them() {
    let (lengths, angles) = ([7.0, 8.5, 9.0], [75.0, 100.0, 118.0]);
    let cell = Cell::of_lengths(lengths, angles).unwrap();
    let near = |found: [f64; 3], expected: [f64; 3]| {
        found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-12)
    };
    assert!(near(cell.lengths(), lengths), "{:?}", cell.lengths());
    assert!(near(cell.angles(), angles), "{:?}", cell.angles());
    let [a, b] = [cell.edges.x_axis, cell.edges.y_axis];
    assert_eq!((a.y, a.z, b.z), (0.0, 0.0, 0.0));
    assert!(cell.edges.determinant() > 0.0);
}

#[test]
fn right_angles_are_exact() {
    let cell = Cell::of_lengths([5.64; 3], [90.0; 3]).unwrap();
    assert_eq!(cell.edges, DMat3::from_diagonal(DVec3::splat(5.64)));
}

#[test]
fn fractions_lead_back_to_their_point() {
    let cell = Cell::of_lengths([3.0, 4.0, 5.0], [90.0, 90.0, 120.0]).unwrap();
    let cell = Cell::new(cell.edges, DVec3::new(1.0, -2.0, 0.5)).unwrap();
    let fractions = DVec3::new(0.25, -1.5, 3.0);
    let found = cell.fractions(cell.point(fractions));
    assert!((found - fractions).abs().max_element() < 1e-14, "{found}");
    assert_eq!(cell.point(DVec3::ZERO), DVec3::new(1.0, -2.0, 0.5));
}

#[test]
fn cells_without_a_volume_are_refused() {
    let flat = [DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
    for edges in [flat, [DVec3::ZERO; 3], [DVec3::X, DVec3::Y, DVec3::ZERO]] {
        let edges = DMat3::from_cols_array_2d(&edges.map(|edge| edge.to_array()));
        let message = Cell::new(edges, DVec3::ZERO).unwrap_err();
        assert!(message.ends_with("found one without a volume"), "{message}");
    }
    for infinite in [f64::NAN, f64::INFINITY] {
        let edges = DMat3::from_diagonal(DVec3::new(1.0, infinite, 1.0));
        assert!(Cell::new(edges, DVec3::ZERO).is_err());
        assert!(Cell::new(DMat3::IDENTITY, DVec3::splat(infinite)).is_err());
        assert!(Cell::of_lengths([1.0, infinite, 1.0], [90.0; 3]).is_err());
        assert!(Cell::of_lengths([1.0; 3], [90.0, infinite, 90.0]).is_err());
    }
    for angles in [[0.0, 90.0, 90.0], [180.0, 90.0, 90.0], [60.0, 60.0, 150.0]] {
        assert!(Cell::of_lengths([1.0; 3], angles).is_err(), "{angles:?}");
    }
}

/// Lengths have no unit.
#[test]
fn tiny_and_huge_cells_are_cells() {
    for size in [1e-90, 1e90] {
        let cell = Cell::of_lengths([size; 3], [90.0, 90.0, 60.0]).unwrap();
        let [a, b, c] = cell.lengths();
        assert!(
            [a, b, c]
                .iter()
                .all(|length| (length / size - 1.0).abs() < 1e-12)
        );
    }
}
