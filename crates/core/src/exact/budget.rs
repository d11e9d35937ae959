//! The work that a pixel may cost, and the signs that more of it would be in vain.

use std::ops::AddAssign;

/// The work on a part of a pixel, counted while it goes on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CellWork {
    /// Points at which light was computed.
    pub(crate) samples: u64,
    /// Pieces of curves that were held against a sphere, a curve or an occluder.
    pub(crate) tests: u64,
}

impl CellWork {
    /// The work in units, of about 30 ns each: a sample of light on bumps, and a test, take one. What every cell
    /// costs before its first sample is added.
    pub(crate) fn units(self) -> u64 {
        const OF_CELL: u64 = 50;
        OF_CELL + self.samples + self.tests
    }
}

impl AddAssign for CellWork {
    fn add_assign(&mut self, other: Self) {
        self.samples += other.samples;
        self.tests += other.tests;
    }
}

/// The work that one pixel, at one moment, has cost and may cost.
///
/// All of it is counted in the pixel itself: threads, tiles and other pixels cannot change where it ends.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Budget {
    spent: u64,
    most: u64,
    /// The error by rounding when the work was looked at last, and when it is looked at next.
    rounding: Option<f64>,
    next: u64,
    /// The tests that told what parts see; of those of which little is to be hoped several times.
    looking: u64,
    most_looking: u64,
    /// The same tests, each of them once.
    looked: u64,
}

/// The error of a pixel so far, as claimed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Doubt {
    pub(crate) error: f64,
    /// The share of the error that comes from rounding.
    pub(crate) rounding: f64,
}

/// The units that a pixel may cost: a few thousand times a pixel with ordinary edges, which costs about 200.
pub(crate) const MOST: u64 = 1_500_000;

/// The units that a pixel may cost at each of the moments of an open shutter, which are seven at least.
pub(crate) const MOST_AT_A_MOMENT: u64 = MOST / 24;

/// The units that a pixel may cost over all moments together, before it ends: the last panels are finished.
pub(crate) const MOST_OVER_TIME: u64 = MOST / 24;

/// The units that a pixel may cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowance {
    /// For a pixel that sees no bumps.
    ordinary: u64,
    /// For a pixel that sees bumps.
    pub(crate) bumpy: u64,
}

impl Allowance {
    /// The allowance of a pixel whose lights are integrated in so many groups, one after the other.
    pub(crate) fn still(groups: usize) -> Self {
        Self {
            ordinary: MOST,
            bumpy: MOST / groups as u64,
        }
    }

    /// The same at one of the moments of a panel of time that is 2⁻ˡ of the whole, l being its level. The shorter
    /// a panel is, the more of them share what a pixel with bumps may cost.
    pub(crate) fn at_a_moment(self, level: u32) -> Self {
        /// The level from which on all moments have the same.
        const MOST_SHARED: u32 = 4;
        let share = MOST / MOST_AT_A_MOMENT;
        Self {
            ordinary: self.ordinary / share,
            bumpy: (self.bumpy / share) >> level.min(MOST_SHARED),
        }
    }

    /// Returns whether it is that of one of many moments.
    pub(crate) fn is_of_moment(self) -> bool {
        self.ordinary < MOST
    }
}

/// Bumps side by side in a pixel up to which two thirds of the budget are theirs, and from which on nothing is: a
/// hundred and more bumps are left to samples.
const FEW_GRAINS: f64 = 2.0;
const MANY_GRAINS: f64 = 12.0;

/// The share of the budget that pixels with bumps may need, on average, to be worth it; how many times that one of them
/// may have; and the share that it may have if they are not worth it.
const MOST_NEED: f64 = 0.1;
const MOST_NEEDS: f64 = 20.0;
const HOPELESS: f64 = 0.005;

/// The share of the budget that a single part of a pixel may take.
const OF_PART: u64 = 8;

/// Returns whether so many pairs of curves, each of which is a test or more, cost more than a part of a pixel may before
/// anything is known of it: its quarters see fewer of them each.
pub(crate) fn is_beyond_a_part(pairs: u64) -> bool {
    pairs > MOST / OF_PART
}

/// The share of the budget that finding out what a part of a pixel sees may take.
const OF_CROWD: u64 = 32;

/// The tests with which it may be found out what a part of a pixel sees.
pub(crate) const OF_A_CROWD: u64 = MOST / OF_CROWD;

/// Returns whether so many pairs of spheres, or tests, are more than that: quarters of the part see fewer spheres each.
pub(crate) fn is_beyond_a_crowd(pairs: u64) -> bool {
    pairs > OF_A_CROWD
}

/// The spheres that a pixel may see of which more are not told apart: each of its parts would ask all of them.
pub(crate) const MOST_SPHERES: usize = 2048;

/// The share of the budget that goes to finding out what parts of a pixel see.
const OF_LOOKING: u64 = 4;

/// The units at which rounding is looked at for the first time; every doubling after that it is looked at
/// again.
const FIRST_LOOK: u64 = 512;

impl Budget {
    /// The budget of a pixel with so many bumps side by side.
    ///
    /// The finer bumps are, the more pixels of a picture are alike: what most of them need tells how much a pixel has.
    pub(crate) fn new(allowance: Allowance, grains: f64, tolerance: f64) -> Self {
        if grains <= 0.0 {
            return Self {
                most: allowance.ordinary,
                next: FIRST_LOOK,
                most_looking: MOST / OF_LOOKING,
                ..Self::default()
            };
        }
        let most = allowance.bumpy / 3 * 2;
        let most = most as f64;
        let most = if grains > MANY_GRAINS {
            0.0
        } else {
            // Products, which are the same on every machine: `powi` need not be.
            let share = (FEW_GRAINS / grains).min(1.0);
            let share = share * share;
            let need = need(grains, tolerance);
            let needed = if need <= MOST_NEED * most {
                MOST_NEEDS * need
            } else {
                HOPELESS * most
            };
            (most * (share * share)).max(needed.min(most))
        };
        Self {
            spent: 0,
            most: most as u64,
            rounding: None,
            next: FIRST_LOOK,
            looking: 0,
            most_looking: MOST / OF_LOOKING,
            looked: 0,
        }
    }

    /// The same where the pixel's tile leaves no more units than this: to finding out what parts see, and to all of the
    /// work on a crowd.
    pub(crate) fn within(self, units: u64, is_crowd: bool) -> Self {
        Self {
            most: if is_crowd {
                self.most.min(units)
            } else {
                self.most
            },
            most_looking: self.most_looking.min(units),
            ..self
        }
    }

    /// The units that the pixel has cost.
    pub(crate) fn spent(&self) -> u64 {
        self.spent
    }

    /// The units that it may still cost.
    pub(crate) fn left(&self) -> u64 {
        self.most.saturating_sub(self.spent)
    }

    /// The tests that told what parts of the pixel see.
    pub(crate) fn looked(&self) -> u64 {
        self.looked
    }

    /// Returns whether the budget does not suffice for anything: bumps divide lines so often that even the whole
    /// of a pixel costs more.
    pub(crate) fn is_nothing(&self) -> bool {
        const LEAST: u64 = 2000;
        self.most < LEAST
    }

    /// Counts the work on a part of the pixel.
    pub(crate) fn spend(&mut self, work: CellWork) {
        self.spent += work.units();
    }

    /// Counts the tests that told what a part sees, and whether its quarters may see as much.
    ///
    /// If spheres are side by side, a quarter sees fewer of them. If their contours nearly coincide, a quarter sees as many,
    /// and so do half of the quarters: more work on these is in vain, and they count more. This is an estimate, which a
    /// crowd that thins out late can fool: then a pixel is given up that might be known.
    pub(crate) fn count_looking(&mut self, tests: u64, is_in_vain: bool) {
        const IN_VAIN: u64 = 4;
        self.looked += tests;
        self.looking += tests * if is_in_vain { IN_VAIN } else { 1 };
    }

    /// The units that the next part may take.
    pub(crate) fn of_part(&self) -> u64 {
        (self.most / OF_PART).min(self.left())
    }

    /// Returns whether the work ends: it has cost all that it may, or rounding alone exceeds the tolerance and
    /// stays as it is however small the cells become.
    pub(crate) fn is_over(&mut self, now: Doubt, tolerance: f64) -> bool {
        /// A number that falls by a smaller factor while the work doubles stays.
        const SAME: f64 = 0.9;
        if self.spent >= self.most || self.looking > self.most_looking {
            return true;
        }
        if self.spent < self.next {
            return false;
        }
        self.next = 2 * self.spent;
        let before = self.rounding.replace(now.rounding);
        now.rounding > tolerance && before.is_some_and(|before| now.rounding > SAME * before)
    }
}

/// The units that the pixels of a tile have cost, by their places.
#[derive(Clone, Debug, Default)]
pub(crate) struct TileCosts(Vec<u64>);

impl TileCosts {
    /// Begins with a tile of so many pixels.
    pub(crate) fn clear(&mut self, count: u64) {
        self.0.clear();
        self.0.resize(count as usize, 0);
    }

    pub(crate) fn add(&mut self, place: usize, units: u64) {
        self.0[place] += units;
    }

    pub(crate) fn of(&self, place: usize) -> u64 {
        self.0[place]
    }
}

/// The units that a pixel without edges costs, about: where it is smooth, and on bumps, without what these take in
/// parts. Samples that pixels of a row take together do not count: a pixel's cost is its own.
pub(crate) const FILLED: [u64; 2] = [10, 60];

/// The units that pixels with so many bumps side by side take on average, as measured with amplitudes from
/// 0.5 to 0.9: an estimate, which only decides how much is tried.
fn need(grains: f64, tolerance: f64) -> f64 {
    const OF_ONE: f64 = 200.0;
    const TOLERANCE: f64 = 5e-4;
    const POWER: f64 = 2.0 / 3.0;
    OF_ONE * grains * grains * libm::pow(TOLERANCE / tolerance, POWER)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-5;

    /// The units after which a pixel ends whose parts cost so much, and whose error falls so.
    fn end(mut budget: Budget, of_part: u64, error: impl Fn(f64) -> f64, rounding: f64) -> u64 {
        loop {
            let now = Doubt {
                error: error(budget.spent as f64) + rounding,
                rounding,
            };
            if now.error <= TOLERANCE || budget.is_over(now, TOLERANCE) {
                return budget.spent;
            }
            budget.spend(CellWork {
                samples: of_part,
                tests: 0,
            });
        }
    }

    fn halving(spent: f64) -> f64 {
        2.0 / spent.max(1.0)
    }

    #[test]
    fn edges_are_followed_to_the_tolerance() {
        let spent = end(
            Budget::new(Allowance::still(1), 0.0, TOLERANCE),
            300,
            halving,
            0.0,
        );
        assert!((200_000..201_000).contains(&spent), "{spent}");
    }

    #[test]
    fn rounding_that_stays_ends_at_once() {
        let spent = end(
            Budget::new(Allowance::still(1), 0.0, TOLERANCE),
            100,
            halving,
            10.0 * TOLERANCE,
        );
        assert!(spent < 3 * FIRST_LOOK, "{spent}");
    }

    #[test]
    fn no_pixel_costs_more_than_its_budget_and_one_part() {
        for most in [3000, 30_000, MOST] {
            let allowance = Allowance {
                ordinary: most,
                bumpy: 0,
            };
            let budget = Budget::new(allowance, 0.0, TOLERANCE);
            let spent = end(budget, 300, |_| 0.1, 0.0);
            assert!((most..=most + 350).contains(&spent), "{spent}");
        }
    }

    #[test]
    fn fine_bumps_have_what_they_need() {
        let still = Allowance::still(1);
        let most = |grains: f64, tolerance: f64| Budget::new(still, grains, tolerance).most;
        assert_eq!(most(0.5, 1e-5), MOST / 3 * 2);
        assert_eq!(most(2.0, 1e-5), MOST / 3 * 2);
        assert_eq!(most(4.0, 1e-2), MOST / 24);
        assert_eq!(most(7.0, 1e-3), 123_472);
        assert_eq!(most(7.0, 1e-5), 6663);
        assert_eq!(most(10.0, 1e-5), 5000);
        assert!(Budget::new(still, 12.1, 1e-2).is_nothing());
    }
}
