//! Loops on the threads of the current rayon pool.
//!
//! Each iterator of rayon is compiled anew; these loops share one.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// Items that a thread takes at once.
const PIECE: usize = 1 << 10;

/// The results of `map` for all indices below `count`, in their order.
pub(crate) fn map<T: Send + Sync>(count: usize, map: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let results: Vec<OnceLock<T>> = (0..count).map(|_| OnceLock::new()).collect();
    run(count, &|index| {
        results[index].get_or_init(|| map(index));
    });
    let results = results.into_iter();
    results.filter_map(OnceLock::into_inner).collect()
}

/// The results of `map` for the pieces of a slice, in their order.
pub(crate) fn map_pieces<T: Sync, U: Send + Sync>(
    items: &[T],
    of_piece: impl Fn(&[T]) -> U + Sync,
) -> Vec<U> {
    map(items.len().div_ceil(PIECE), |index| {
        let start = index * PIECE;
        of_piece(&items[start..items.len().min(start + PIECE)])
    })
}

/// What `of` makes of each item, in their order.
pub(crate) fn map_each<T: Sync, U: Clone + Default + Send>(
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
pub(crate) fn change_all<T: Send>(
    items: &mut [T],
    change: impl Fn(usize, &mut T) -> bool + Sync,
) -> bool {
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
