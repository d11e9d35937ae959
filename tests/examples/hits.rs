//! Compares methods to intersect a ray and a sphere: wrong decisions, errors, times, and the arithmetic that decided.
//!
//! `cargo hits` prints tables in Markdown; with `--write` they become the measured parts of
//! docs/accuracy.md.

#[path = "../../benches/src/page.rs"]
#[expect(unreachable_pub, reason = "it belongs to the benchmarks' library")]
mod page;
#[path = "hits/table.rs"]
mod table;
#[path = "hits/timing.rs"]
mod timing;

use std::io::{self, Write};

use marbles_core::{Floor, Ray, Sphere};
use marbles_tests::hits::families::{FAMILIES, Family};
use marbles_tests::hits::forms::FORMS;
use marbles_tests::hits::frames::{self, Frame};
use marbles_tests::hits::judge;
use marbles_tests::hits::tally::Tally;
use page::Page;
use rayon::prelude::*;
use table::{Table, number};

const USAGE: &str = "\
cargo hits [--write]
    Compares marbles with other methods to intersect a ray and a sphere, and prints two tables.
    --write    also write the tables into docs/accuracy.md
";

/// Cases per family.
const CASES: u64 = 5_000;

/// The index in [`FORMS`] of the form that the times of all forms are divided by.
const PERPENDICULAR: usize = 2;

fn main() -> io::Result<()> {
    let mut out = io::stdout().lock();
    if std::env::args().any(|argument| matches!(&*argument, "--help" | "-h")) {
        return write!(out, "{USAGE}");
    }
    let parts = ["forms", "floors"];
    let is_to_write = std::env::args().any(|argument| argument == "--write");
    let mut page = is_to_write.then(|| Page::open("docs/accuracy.md", &parts));
    let tallies: Vec<_> = FAMILIES.par_iter().map(judge_forms).collect();
    let frames = [frames::ball(), frames::cloud()];
    let tables = [
        compare_forms(&tallies, &frames),
        count_floors(&tallies, &frames),
    ];
    for (part, table) in parts.into_iter().zip(tables) {
        writeln!(out, "{table}")?;
        if let Some(page) = &mut page {
            page.write(part, &table.to_string());
        }
    }
    Ok(())
}

/// The results of every form on the cases of a family.
fn judge_forms(family: &Family) -> [Tally; FORMS.len()] {
    let mut tallies = FORMS.map(|_| Tally::default());
    for index in 0..CASES {
        let (sphere, ray) = family.case(index);
        let exact = judge::judge(&sphere, &ray);
        for (tally, (_, form)) in tallies.iter_mut().zip(FORMS) {
            tally.count(exact.as_ref(), form(&sphere, &ray));
        }
    }
    tallies
}

fn compare_forms(tallies: &[[Tally; FORMS.len()]], frames: &[Frame; 2]) -> Table {
    let mut table = Table::new(&[
        "method",
        "false hits",
        "false misses",
        "t, median ulp",
        "t, worst ulp",
        "n, worst 2^-53 rad",
        "ball, ns per test",
        "ratio",
        "cloud, ns per test",
        "ratio",
    ]);
    let times = frames.each_ref().map(timing::nanoseconds_a_test);
    for (index, (name, _)) in FORMS.into_iter().enumerate() {
        let mut whole = Tally::default();
        for family in tallies {
            whole.add(family[index].clone());
        }
        let mut row = vec![
            name.to_owned(),
            whole.false_hits.to_string(),
            whole.false_misses.to_string(),
            number(table::median(&mut whole.distances)),
            number(whole.worst_distance()),
            number(whole.worst_angle),
        ];
        for times in times {
            row.push(format!("{:.2}", times[index]));
            row.push(format!("{:.2}", times[index] / times[PERPENDICULAR]));
        }
        table.push(row);
    }
    table
}

/// Counts the tests that each kind of arithmetic decided, and the wrong decisions of each form.
fn count_floors(tallies: &[[Tally; FORMS.len()]], frames: &[Frame]) -> Table {
    let mut table = Table::new(&[
        "rays",
        "tests",
        "hits",
        "doubles",
        "double-double",
        "integers",
        "wrong: b² - 4ac",
        "wrong: stable q",
        "wrong: perpendicular",
        "wrong: marbles",
    ]);
    for frame in frames {
        let tests = frame
            .rays
            .iter()
            .flat_map(|ray| frame.spheres.iter().map(move |sphere| (*sphere, *ray)));
        let mut row = vec![frame.name.to_owned()];
        row.extend(floors(tests));
        row.extend(FORMS.map(|_| String::new()));
        table.push(row);
    }
    for (family, tallies) in FAMILIES.iter().zip(tallies) {
        let mut row = vec![family.name.to_owned()];
        row.extend(floors((0..CASES).map(|number| family.case(number))));
        for tally in tallies {
            row.push((tally.false_hits + tally.false_misses).to_string());
        }
        table.push(row);
    }
    table
}

/// The number of tests, the number of hits, and the number of tests that each kind of arithmetic decided.
fn floors(tests: impl Iterator<Item = (Sphere, Ray)>) -> [String; 5] {
    let (mut count, mut hits) = (0_u64, 0_u64);
    let mut floors = [0_u64; 3];
    for (sphere, ray) in tests {
        let (hit, floor) = sphere.hit_and_floor(&ray);
        count += 1;
        hits += u64::from(hit.is_some());
        floors[match floor {
            Floor::Fast => 0,
            Floor::Double => 1,
            Floor::Exact => 2,
        }] += 1;
    }
    [count, hits, floors[0], floors[1], floors[2]].map(|count| count.to_string())
}
