//! Rays and spheres whose numbers have some other bits, held against exact arithmetic.

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

/// Cases of an input.
const CASES: usize = 100;

/// Nothing: the cases are those of families, drawn anew.
pub(super) fn seeds(_: &Path) -> Vec<Seed> {
    vec![Seed {
        name: "rays".to_owned(),
        bytes: Vec::new(),
    }]
}

/// Holds some hits against the judge; returns whether there were any.
///
/// # Panics
/// When one is not what is claimed.
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

/// A case in which up to three numbers have another bit; `None` where that is no sphere and ray.
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
