use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU32, Ordering};

use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::*;

/// Work whose parts are counted.
struct Parts<'a> {
    next: AtomicU32,
    count: u32,
    act: &'a (dyn Fn(u32) -> ControlFlow<()> + Sync),
    number: u32,
}

impl SharedWork for Parts<'_> {
    fn left(&self) -> u32 {
        let next = self.next.load(Ordering::Relaxed);
        self.count.saturating_sub(next)
    }

    fn help(&self) -> ControlFlow<()> {
        while self.next.fetch_add(1, Ordering::Relaxed) < self.count {
            (self.act)(self.number)?;
        }
        ControlFlow::Continue(())
    }
}

/// Several works with a number of parts each, on some threads.
fn run_works(
    threads: usize,
    counts: &[u32],
    prepare: impl Fn(u32) + Sync,
    act: &(dyn Fn(u32) -> ControlFlow<()> + Sync),
) {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let mut works = (0..).zip(counts);
    pool.unwrap().install(|| {
        run(|| {
            let (number, &count) = works.next()?;
            prepare(number);
            Some(Parts {
                next: AtomicU32::new(0),
                count,
                act,
                number,
            })
        });
    });
}

#[test]
fn every_part_is_done_once() {
    let counts = [5, 0, 1, 100, 3, 0, 0, 7];
    for threads in [1, 2, 3, 7] {
        let done = counts.map(|_| AtomicU32::new(0));
        let prepare = |number| {
            // What a preparation shares, others may do.
            let sum: u32 = (0..100_u32).into_par_iter().sum();
            assert_eq!(
                (sum, done[number as usize].load(Ordering::Relaxed)),
                (4950, 0)
            );
        };
        run_works(threads, &counts, prepare, &|number| {
            done[number as usize].fetch_add(1, Ordering::Relaxed);
            ControlFlow::Continue(())
        });
        assert_eq!(done.map(AtomicU32::into_inner), counts, "{threads} threads");
    }
}

/// The last part of each work waits until another thread has begun the next work.
#[test]
fn the_next_begins_while_others_end_the_last() {
    /// Far longer than it should take.
    const PATIENCE: Duration = Duration::from_secs(60);
    let begun = Mutex::new(0);
    let changed = Condvar::new();
    let last = 5;
    run_works(2, &[1; 6], |_| (), &|number| {
        let mut latest = begun.lock().unwrap();
        *latest = number.max(*latest);
        changed.notify_all();
        let is_early = |latest: &mut u32| *latest < last.min(number + 1);
        let waited = changed.wait_timeout_while(latest, PATIENCE, is_early);
        assert!(!waited.unwrap().1.timed_out());
        ControlFlow::Continue(())
    });
    assert_eq!(begun.into_inner().unwrap(), last);
}

/// A thread that finds work nearly done prepares the next work before all parts are begun: no part ends here until that
/// has happened.
#[test]
fn the_next_is_prepared_while_others_do_the_last() {
    /// Far longer than it should take.
    const PATIENCE: Duration = Duration::from_secs(60);
    let prepared = Mutex::new(0);
    let changed = Condvar::new();
    let last = 5;
    let prepare = |number: u32| {
        *prepared.lock().unwrap() = number;
        changed.notify_all();
    };
    run_works(2, &[2; 6], prepare, &|number| {
        let is_early = |latest: &mut u32| *latest < last.min(number + 1);
        let prepared = prepared.lock().unwrap();
        let waited = changed.wait_timeout_while(prepared, PATIENCE, is_early);
        assert!(!waited.unwrap().1.timed_out());
        ControlFlow::Continue(())
    });
}

/// Nothing is prepared as long as many parts are left.
#[test]
fn the_next_is_not_prepared_too_early() {
    const COUNT: u32 = 50;
    for threads in [1, 2, 3] {
        let begun = [0; 6].map(AtomicU32::new);
        let prepare = |number: u32| {
            let Some(before) = number.checked_sub(1) else {
                return;
            };
            // Two for each of the others, and those that are begun but not counted.
            let few = 2 * (threads - 1) + threads;
            assert!(begun[before as usize].load(Ordering::SeqCst) + few >= COUNT);
        };
        run_works(threads as usize, &[COUNT; 6], prepare, &|number| {
            begun[number as usize].fetch_add(1, Ordering::SeqCst);
            ControlFlow::Continue(())
        });
    }
}

/// Prepared work takes memory.
#[test]
fn no_more_than_the_next_is_prepared() {
    let (prepared, ended) = (AtomicU32::new(0), AtomicU32::new(0));
    let prepare = |_| {
        let ahead = prepared.fetch_add(1, Ordering::SeqCst) + 1;
        // The next, and the one that is worked on.
        assert!(ahead - ended.load(Ordering::SeqCst) / 50 <= 2);
    };
    run_works(2, &[50; 40], prepare, &|_| {
        ended.fetch_add(1, Ordering::SeqCst);
        ControlFlow::Continue(())
    });
    assert_eq!(ended.into_inner(), 2000);
}

#[test]
fn work_ends_for_all_when_one_breaks_or_panics() {
    for threads in [1, 2, 5] {
        for panics in [false, true] {
            let latest = AtomicU32::new(0);
            let ended = catch_unwind(AssertUnwindSafe(|| {
                run_works(threads, &[20; 1000], |_| (), &|number| {
                    latest.fetch_max(number, Ordering::Relaxed);
                    assert!(!panics || number != 9);
                    if number == 9 {
                        return ControlFlow::Break(());
                    }
                    ControlFlow::Continue(())
                });
            }));
            assert_eq!(ended.is_err(), panics);
            let latest = latest.into_inner();
            // Others may be a few works ahead before they look.
            assert!((9..900).contains(&latest), "{latest}");
        }
    }
}
