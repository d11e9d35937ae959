//! The promises of [`Sphere::hit`], for every family, and for each kind of arithmetic alone.

use marbles_core::{Floor, Hit, Ray, Sphere};
use rayon::prelude::*;

use marbles_tests::hits::families::{FAMILIES, Family};
use marbles_tests::hits::forms::FORMS;
use marbles_tests::hits::frames;
use marbles_tests::hits::judge::{ExactHit, judge};
use marbles_tests::hits::tally::Tally;
use marbles_tests::hits::verdict::verdict;

const FLOORS: [Floor; 3] = [Floor::Fast, Floor::Double, Floor::Exact];

/// The results for the cases of a family: of the arithmetic that decided, then of each kind alone.
#[derive(Clone, Default)]
struct Record {
    all: Tally,
    alone: [Tally; 3],
    /// The largest difference between the length of a normal and 1, in 2⁻⁵³.
    worst_length: f64,
    failures: Vec<String>,
}

impl Record {
    fn of(family: &Family, numbers: std::ops::Range<u64>) -> Self {
        numbers
            .into_par_iter()
            .fold(Self::default, |mut record, number| {
                record.hold(family, number);
                record
            })
            .reduce(Self::default, |mut record, other| {
                record.add(other);
                record
            })
    }

    fn hold(&mut self, family: &Family, number: u64) {
        let (sphere, ray) = family.case(number);
        let exact = judge(&sphere, &ray);
        let mut failed = |tally: &mut Tally, found: Option<Hit>, who: &str| {
            if let Some(found) = found {
                let length = ExactHit::excess_length(found.normal);
                self.worst_length = self.worst_length.max(length);
            }
            if let Some(failure) = verdict(tally, exact.as_ref(), found) {
                let name = family.name;
                self.failures.push(format!(
                    "{name} {number}, {who}: {failure}\n    {sphere:?}\n    {ray:?}"
                ));
            }
        };
        let (found, floor) = sphere.hit_and_floor(&ray);
        failed(&mut self.all, found, "hit");
        for (floor_alone, tally) in FLOORS.into_iter().zip(&mut self.alone) {
            let answer = sphere.hit_on_floor(&ray, floor_alone);
            if floor_alone == floor {
                assert!(same(answer, &sphere, &ray), "{} {number}", family.name);
            }
            if let Some(found) = answer {
                failed(tally, found, &format!("{floor_alone:?} alone"));
            }
        }
    }

    fn add(&mut self, other: Self) {
        self.all.add(other.all);
        for (tally, other) in self.alone.iter_mut().zip(other.alone) {
            tally.add(other);
        }
        self.worst_length = self.worst_length.max(other.worst_length);
        self.failures.extend(other.failures);
    }
}

/// Whether one kind of arithmetic alone gave the same bits as all of them together.
fn same(answer: Option<Option<Hit>>, sphere: &Sphere, ray: &Ray) -> bool {
    answer == Some(sphere.hit(ray))
}

/// Judges a number of cases of every family.
#[expect(clippy::print_stdout, reason = "cargo hits-all shows what it measured")]
fn hold_all(cases: u64) -> Record {
    let mut whole = Record::default();
    for family in &FAMILIES {
        let record = Record::of(family, 0..cases);
        whole.add(record);
    }
    let failures = &whole.failures;
    assert!(
        failures.is_empty(),
        "{} cases of {} fail, the first:\n{}",
        failures.len(),
        whole.all.cases,
        failures[..failures.len().min(5)].join("\n")
    );
    for (who, tally) in [("hit", &whole.all)]
        .into_iter()
        .chain(["fast", "double", "exact"].into_iter().zip(&whole.alone))
    {
        println!(
            "{who}: {} cases, {} hits, worst t {:.4} ulp, worst n {:.4} · 2^-53 rad",
            tally.cases,
            tally.distances.len(),
            tally.worst_distance(),
            tally.worst_angle,
        );
        // The claims are not idle: the last rounding alone costs about half of each.
        assert!(tally.worst_distance() >= 0.45 && tally.worst_angle >= 0.5);
    }
    println!("worst length of n: 1 ± {:.4} · 2^-53", whole.worst_length);
    assert!(whole.worst_length >= 1.0);
    // Every floor had much to decide.
    let [fast, double, exact] = whole.alone.each_ref().map(|tally| tally.cases);
    assert!(fast > exact / 3 && double > exact / 2 && exact == whole.all.cases);
    whole
}

#[test]
fn every_decision_is_right_and_every_distance_to_the_last_place() {
    hold_all(4_000);
}

/// `cargo hits-all`: 4.3 million cases.
#[test]
#[ignore = "takes a minute"]
fn millions_of_cases_are_right_to_the_last_place() {
    let whole = hold_all(100_000);
    assert!(whole.all.cases >= 4_000_000);
}

/// A judge that finds no errors in the other methods would prove nothing.
#[test]
fn other_forms_are_found_wrong() {
    for (name, form) in &FORMS[..FORMS.len() - 1] {
        let mut tally = Tally::default();
        for number in 0..50 {
            for family in &FAMILIES {
                let (sphere, ray) = family.case(number);
                tally.count(judge(&sphere, &ray).as_ref(), form(&sphere, &ray));
            }
        }
        let wrong = tally.false_hits.min(tally.false_misses);
        assert!(wrong > tally.cases / 100, "{name}: only {wrong} are wrong");
        assert!(tally.worst_distance() > 1e6 && tally.worst_angle > 1e6);
    }
}

/// When this was written, none of 360,000 tests needed more than doubles, and 7 of 3,600,000 did.
#[test]
fn ordinary_frames_stay_on_the_first_floor() {
    for (frame, most) in [(frames::ball(), 0), (frames::cloud(), 10)] {
        let mut higher = 0;
        for ray in &frame.rays {
            for sphere in &frame.spheres {
                higher += usize::from(sphere.hit_and_floor(ray).1 != Floor::Fast);
            }
        }
        assert!(higher <= most, "{}: {higher} went higher", frame.name);
    }
}
