//! Covering arrays: a small number of rows in which all combinations of values of any three factors occur.
//!
//! A row has one value for each factor. An array has *strength three* if for any three factors every combination of
//! three values is in some row, except for values that contradict each other.

use std::collections::BTreeSet;

use crate::numbers::Numbers;

/// A value of a factor, as the numbers of both.
pub type Choice = (usize, usize);

/// Values of three factors, in the order of the factors.
type Triple = [Choice; 3];

/// The number of candidates for each row; the one with the most triples that are still missing is taken.
const TRIES: usize = 24;

/// The rows of an array of strength three. `levels` is the number of values of each factor.
///
/// `contradict` returns whether two values of different factors must not occur together; every factor must have a value
/// that contradicts no other. The algorithm is greedy: each row takes, factor by factor, the value with the most
/// missing triples. The array is the same in every run.
pub fn rows(levels: &[usize], contradict: impl Fn(Choice, Choice) -> bool) -> Vec<Vec<usize>> {
    let mut missing = triples(levels, &contradict);
    let mut numbers = Numbers(1);
    let mut rows = Vec::new();
    while let Some(first) = missing.first().copied() {
        let mut best: Option<(usize, Vec<usize>)> = None;
        for _ in 0..TRIES {
            let row = row(levels, &missing, first, &contradict, &mut numbers);
            let count = of_row(&row)
                .filter(|triple| missing.contains(triple))
                .count();
            if best.as_ref().is_none_or(|(most, _)| count > *most) {
                best = Some((count, row));
            }
        }
        let Some((_, row)) = best else { break };
        for triple in of_row(&row) {
            missing.remove(&triple);
        }
        rows.push(row);
    }
    rows
}

/// All triples without contradictions.
fn triples(levels: &[usize], contradict: &impl Fn(Choice, Choice) -> bool) -> BTreeSet<Triple> {
    let choices = |factor: usize| (0..levels[factor]).map(move |value| (factor, value));
    let mut all = BTreeSet::new();
    for third in 2..levels.len() {
        for second in 1..third {
            for first in 0..second {
                for a in choices(first) {
                    for b in choices(second) {
                        for c in choices(third) {
                            let pairs = [(a, b), (a, c), (b, c)];
                            if !pairs.into_iter().any(|(one, other)| contradict(one, other)) {
                                all.insert([a, b, c]);
                            }
                        }
                    }
                }
            }
        }
    }
    all
}

/// The triples of a row.
fn of_row(row: &[usize]) -> impl Iterator<Item = Triple> {
    let count = row.len();
    (2..count).flat_map(move |third| {
        (1..third).flat_map(move |second| {
            (0..second).map(move |first| [first, second, third].map(|factor| (factor, row[factor])))
        })
    })
}

/// A row that contains a triple, and many other missing ones.
fn row(
    levels: &[usize],
    missing: &BTreeSet<Triple>,
    with: Triple,
    contradict: &impl Fn(Choice, Choice) -> bool,
    numbers: &mut Numbers,
) -> Vec<usize> {
    let mut chosen: Vec<Choice> = with.to_vec();
    let mut left: Vec<usize> = (0..levels.len())
        .filter(|factor| with.iter().all(|(other, _)| other != factor))
        .collect();
    while !left.is_empty() {
        let factor = left.swap_remove(numbers.below(left.len()));
        let start = numbers.below(levels[factor]);
        let values = (0..levels[factor]).map(|value| (factor, (start + value) % levels[factor]));
        let allowed = values.filter(|&value| !chosen.iter().any(|&other| contradict(value, other)));
        let gain = |value: &Choice| gain(*value, &chosen, missing);
        // The value that contradicts none is always left.
        let best = allowed.max_by_key(gain).unwrap_or((factor, 0));
        chosen.push(best);
    }
    chosen.sort_unstable();
    chosen.into_iter().map(|(_, value)| value).collect()
}

/// The number of missing triples that a value forms with two chosen ones.
fn gain(value: Choice, chosen: &[Choice], missing: &BTreeSet<Triple>) -> usize {
    let pairs = chosen
        .iter()
        .enumerate()
        .flat_map(|(index, one)| chosen[..index].iter().map(move |other| (*one, *other)));
    let triple = |(one, other): (Choice, Choice)| {
        let mut triple = [value, one, other];
        triple.sort_unstable();
        triple
    };
    pairs
        .filter(|&pair| missing.contains(&triple(pair)))
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of triples without contradictions that are in no row, by exhaustive search.
    fn uncovered(
        rows: &[Vec<usize>],
        levels: &[usize],
        contradict: fn(Choice, Choice) -> bool,
    ) -> usize {
        let all = triples(levels, &contradict);
        let is_in = |triple: &Triple, row: &[usize]| {
            triple.iter().all(|&(factor, value)| row[factor] == value)
        };
        let covered = |triple: &&Triple| !rows.iter().any(|row| is_in(triple, row));
        all.iter().filter(covered).count()
    }

    const LEVELS: [usize; 6] = [4, 5, 3, 2, 2, 3];

    fn contradict(one: Choice, other: Choice) -> bool {
        let pair = [one, other];
        pair.contains(&(1, 4)) && pair.contains(&(3, 1))
    }

    #[test]
    fn every_three_values_that_may_be_together_are_in_some_row() {
        let rows = rows(&LEVELS, contradict);
        assert_eq!(uncovered(&rows, &LEVELS, contradict), 0);
        // No fewer would do than the three largest factors have triples.
        assert!((60..=85).contains(&rows.len()), "{}", rows.len());
    }

    #[test]
    fn without_a_row_some_are_missing() {
        let mut rows = rows(&LEVELS, contradict);
        rows.remove(0);
        assert!(uncovered(&rows, &LEVELS, contradict) > 0);
    }

    #[test]
    fn no_row_contradicts_itself() {
        for row in rows(&LEVELS, contradict) {
            assert!(!(row[1] == 4 && row[3] == 1), "{row:?}");
        }
        let free = rows(&LEVELS, |_, _| false);
        assert!(free.iter().any(|row| row[1] == 4 && row[3] == 1));
    }

    #[test]
    fn triples_are_counted_as_products() {
        let all = triples(&[2, 3, 4], &|_, _| false);
        assert_eq!(all.len(), 24);
        let some = triples(&[2, 3, 4], &|one, other| [one, other] == [(0, 0), (1, 0)]);
        assert_eq!(some.len(), 20);
    }

    #[test]
    fn arrays_are_always_the_same() {
        assert_eq!(rows(&LEVELS, contradict), rows(&LEVELS, contradict));
    }
}
