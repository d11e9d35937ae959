//! Tests of `rule.rs`.

use super::*;

#[test]
fn nodes_lie_in_order_between_the_ends_and_weights_are_positive() {
    let rule = &RULE;
    let inside = &rule.nodes[..NODES];
    assert!(inside.iter().all(|node| (0.0..1.0).contains(node)));
    assert!(inside.is_sorted() && rule.nodes[7] == rule.nodes[6]);
    assert!(rule.fine[..NODES].iter().all(|&weight| weight > 0.0));
    assert!(rule.fine[7] == 0.0 && rule.coarse[7] == 0.0);
    assert!(rule.coarse.iter().filter(|&&weight| weight > 0.0).count() == 3);
}

/// Kronrod's rule with 7 points is exact to degree 11, Gauss's with 3 to degree 5.
#[test]
fn rules_are_exact_for_polynomials() {
    let rule = &RULE;
    for degree in 0..=12 {
        let exact = 1.0 / f64::from(degree + 1);
        let off = |weights: &[f64; 8]| {
            let terms = weights.iter().zip(rule.nodes);
            let sum: f64 = terms.map(|(weight, node)| weight * node.powi(degree)).sum();
            (sum - exact).abs()
        };
        assert!((off(&rule.fine) < 1e-15) == (degree <= 11), "{degree}");
        assert!((off(&rule.coarse) < 1e-15) == (degree <= 5), "{degree}");
    }
}

#[test]
fn estimates_grow_with_the_difference_and_never_exceed_it() {
    let mut last = 0.0;
    for exponent in -16..=0 {
        let difference = 10.0_f64.powi(exponent);
        let estimate = error_estimate(difference, 1.0);
        assert!(last < estimate && estimate <= difference);
        last = estimate;
    }
    assert_eq!(error_estimate(0.0, 1.0), 0.0);
    assert!(error_estimate(f64::NAN, f64::NAN).is_nan());
}
