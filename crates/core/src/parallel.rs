//! Loops on the threads of the current rayon pool.
//!
//! Each iterator of rayon is compiled anew, and each kind of work that a pool is given; these share one.
//! It is for the crates of this workspace, and no part of the interface of this one.

use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::ThreadPool;
use rayon::prelude::*;

/// Items that a thread takes at once.
const PIECE: usize = 1 << 10;

/// The results of `map` for all indices below `count`, in their order.
pub fn map<T: Send + Sync>(count: usize, map: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let results: Vec<OnceLock<T>> = (0..count).map(|_| OnceLock::new()).collect();
    run(count, &|index| {
        results[index].get_or_init(|| map(index));
    });
    let results = results.into_iter();
    results.filter_map(OnceLock::into_inner).collect()
}

/// Runs `work` on the threads of a pool.
pub fn install<T: Send>(pool: &ThreadPool, work: impl FnOnce() -> T + Send) -> T {
    let (mut work, mut result) = (Some(work), None);
    install_any(pool, &mut || result = work.take().map(|work| work()));
    match result {
        Some(result) => result,
        None => unreachable!("the pool has run the work"),
    }
}

fn install_any(pool: &ThreadPool, work: &mut (dyn FnMut() + Send)) {
    pool.install(work);
}

/// The results of `map` for the pieces of a slice, in their order.
pub fn map_pieces<T: Sync, U: Send + Sync>(
    items: &[T],
    of_piece: impl Fn(&[T]) -> U + Sync,
) -> Vec<U> {
    map_ranges(items.len(), |indices| of_piece(&items[indices]))
}

/// The results of `of` for ranges that cover the indices below `count`, in their order.
pub fn map_ranges<T: Send + Sync>(count: usize, of: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    map(count.div_ceil(PIECE), |piece| of(piece_at(piece, count)))
}

/// The indices of a piece, of those below `count`.
fn piece_at(piece: usize, count: usize) -> Range<usize> {
    piece * PIECE..count.min((piece + 1) * PIECE)
}

/// Returns whether `is` is true of any item. After one of which it is, others may not be asked.
pub fn any<T: Sync>(items: &[T], is: impl Fn(&T) -> bool + Sync) -> bool {
    any_index(items.len(), |index| is(&items[index]))
}

/// The same for the indices below `count`.
pub fn any_index(count: usize, is: impl Fn(usize) -> bool + Sync) -> bool {
    let is_any = AtomicBool::new(false);
    run(count.div_ceil(PIECE), &|piece| {
        let mut indices = piece_at(piece, count);
        if !is_any.load(Ordering::Relaxed) && indices.any(&is) {
            is_any.store(true, Ordering::Relaxed);
        }
    });
    is_any.into_inner()
}

/// What `of` makes of each item, in their order.
pub fn map_each<T: Sync, U: Clone + Default + Send>(
    items: &[T],
    of: impl Fn(&T) -> U + Sync,
) -> Vec<U> {
    // In place: joined from pieces, all of it would be in memory twice.
    let mut made = vec![U::default(); items.len()];
    change_all(&mut made, |index, made| {
        *made = of(&items[index]);
        true
    });
    made
}

/// Calls `change` for each item and its index. Returns whether all calls returned true; after one
/// that did not, items may stay unchanged.
pub fn change_all<T: Send>(items: &mut [T], change: impl Fn(usize, &mut T) -> bool + Sync) -> bool {
    let pieces: Vec<_> = items.chunks_mut(PIECE).map(Mutex::new).collect();
    let is_good = AtomicBool::new(true);
    run(pieces.len(), &|index| {
        let mut piece = pieces[index].lock().unwrap_or_else(PoisonError::into_inner);
        let mut items = piece.iter_mut().zip(index * PIECE..);
        if !(is_good.load(Ordering::Relaxed) && items.all(|(item, at)| change(at, item))) {
            is_good.store(false, Ordering::Relaxed);
        }
    });
    is_good.into_inner()
}

/// Calls `work` for all indices below `count`.
fn run(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_indices() {
        let squares: Vec<usize> = map(1000, |index| index * index);
        assert!(
            squares
                .iter()
                .enumerate()
                .all(|(at, &square)| square == at * at)
        );
    }

    #[test]
    fn pieces_cover_a_slice_once() {
        for count in [0, 1, PIECE - 1, PIECE, PIECE + 1, 5 * PIECE + 3] {
            let items: Vec<usize> = (0..count).collect();
            let pieces = map_pieces(&items, <[usize]>::to_vec);
            assert_eq!(pieces.concat(), items);
        }
    }

    #[test]
    fn any_item_is_found() {
        let items: Vec<usize> = (0..3 * PIECE + 5).collect();
        for place in [0, PIECE - 1, PIECE, items.len() - 1] {
            assert!(any(&items, |item| *item == place));
        }
        assert!(!any(&items, |item| *item == items.len()));
        assert!(!any_index(0, |_| true));
    }

    #[test]
    fn work_runs_in_a_pool_and_returns() {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(3)
            .build()
            .unwrap();
        let text = String::from("7");
        assert_eq!(install(&pool, || text + "!"), "7!");
        assert_eq!(install(&pool, rayon::current_num_threads), 3);
        let panics = std::panic::AssertUnwindSafe(|| install(&pool, || panic!("as it does here")));
        assert!(std::panic::catch_unwind(panics).is_err());
    }

    #[test]
    fn each_item_is_mapped_in_its_place() {
        let items: Vec<usize> = (0..2 * PIECE + 7).collect();
        assert_eq!(map_each(&items, |item| *item), items);
    }

    #[test]
    fn every_item_is_changed_until_a_change_fails() {
        let mut items = vec![0; 3 * PIECE + 1];
        assert!(change_all(&mut items, |at, item| {
            *item = at;
            true
        }));
        assert!(items.iter().enumerate().all(|(at, &item)| item == at));
        assert!(!change_all(&mut items, |at, _| at != 2 * PIECE));
        assert!(change_all::<u8>(&mut [], |_, _| false));
    }
}
