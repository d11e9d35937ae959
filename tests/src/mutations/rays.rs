//! Compares hits with exact arithmetic, for rays and spheres whose numbers have altered bits.

use std::path::Path;

use glam::DVec3;
use marbles_core::{Ray, Sphere};

use super::Input;
use super::seeds::Seed;
use crate::hits::families::FAMILIES;
use crate::hits::judge::judge;
use crate::hits::tally::Tally;
use crate::hits::verdict::verdict;
use crate::numbers::Numbers;

/// The number of cases per input.
const CASES: usize = 100;

/// Empty: the cases are made anew from the families.
pub(super) fn seeds(_: &Path) -> Vec<Seed> {
    vec![Seed {
        name: "rays".to_owned(),
        bytes: Vec::new(),
    }]
}

/// Compares some hits with the judge; returns whether there were any.
///
/// # Panics
/// If a hit is not as claimed.
pub(super) fn judge_some(input: &Input<'_>) -> bool {
    let mut numbers = Numbers(input.numbers);
    let mut tally = Tally::default();
    for _ in 0..CASES {
        let family = &FAMILIES[numbers.below(FAMILIES.len())];
        let Some((sphere, ray)) = altered(family.case(numbers.bits()), &mut numbers) else {
            continue;
        };
        let exact = judge(&sphere, &ray);
        let failure = verdict(&mut tally, exact.as_ref(), sphere.hit(&ray));
        assert!(failure.is_none(), "{failure:?}\n{sphere:?}\n{ray:?}");
    }
    !tally.distances.is_empty()
}

/// A case in which up to three numbers have an altered bit; `None` if the result is not a sphere and a ray.
fn altered((sphere, ray): (Sphere, Ray), numbers: &mut Numbers) -> Option<(Sphere, Ray)> {
    let mut values = [0.0; 10];
    let (center, origin, direction) = (sphere.center(), ray.origin, ray.direction);
    for (place, vector) in [(0, center), (3, origin), (6, direction)] {
        vector.write_to_slice(&mut values[place..]);
    }
    values[9] = sphere.radius();
    for _ in 0..numbers.below(4) {
        let value = &mut values[numbers.below(10)];
        // The lower bits are where hits are decided.
        let bit = numbers.below(64).min(numbers.below(64));
        *value = f64::from_bits(value.to_bits() ^ (1 << bit));
    }
    let [center, origin, direction] = [0, 3, 6].map(|place| DVec3::from_slice(&values[place..]));
    let is_ray = origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO;
    let sphere = Sphere::new(center, values[9]).ok()?;
    is_ray.then_some((sphere, Ray { origin, direction }))
}
