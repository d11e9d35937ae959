//! The pixels of a scene, held against the same picture with more pixels, and by samples.

use glam::DVec4;

use super::picture::Picture;
use super::sampled::Sampled;
use super::subject::Subject;
use super::{Broken, Found, random};
use marbles_tests::numbers::Numbers;

/// The division of pixels that finds suspects, and its tolerance.
const FINER: u32 = 3;
const FINEST: f64 = 1e-6;

/// The error that a pixel may seem to have against the finer picture, in tolerances, before the truth is asked: what
/// both pictures claim is below that.
const SUSPECT: f64 = 0.9;

/// A pixel of the finer picture that claims more, a hundred times its tolerance, gave up: it may be off as the
/// pixel is, so it clears the pixel only with what it claims.
const GIVEN_UP: f64 = 1e-4;

/// A claim below this part of the tolerance is negligible.
pub(super) const NEGLIGIBLE: f64 = 0.01;

/// A difference tells the true error if it is so many times what the finer picture claims.
const TELLING: f64 = 10.0;
/// It tells the ratio to a claim, too, if the claim is so many times that: the ratio is off by less than a tenth.
const TELLING_OF_CLAIMS: f64 = 10.0;

/// A claim is false if a pixel is off by more than so many times as much, and by more than a part of the tolerance.
const FALSE: f64 = 20.0;
const FALSE_OF_TOLERANCE: f64 = 0.02;

/// If the difference does not tell, the truth is asked of one of so many pixels.
const SHARE: u32 = 256;

/// The pixels of a scene that fall short, and how far its pixels are off.
pub(super) fn judge(subject: &Subject, tolerances: &[f64]) -> Found {
    if random::is_fine(subject) {
        return random::judge(subject, tolerances);
    }
    let mut found = Found::new(tolerances);
    let Some(finer) = subject.finer_picture(FINER, FINEST) else {
        return found;
    };
    let sampled = Sampled::of(subject);
    for (index, &tolerance) in tolerances.iter().enumerate() {
        let Some(picture) = subject.picture(tolerance) else {
            continue;
        };
        for place in picture.places() {
            let pixel = Pixel::of(&picture, &finer, place, tolerance);
            found.pixels += 1;
            found.rendered += 1;
            found.given_up[index] += u64::from(pixel.is_confessed);
            if pixel.is_confessed && found.unmet.is_none() {
                found.unmet = Some(pixel.broken(pixel.apart));
            }
            if pixel.is_suspect() || sampled.as_ref().is_some_and(|it| pixel.is_unlike(it)) {
                found.broken.extend(pixel.shortfall(subject));
            } else if pixel.has_false_claim() {
                found.false_claims.push(pixel.broken(pixel.apart));
            }
            if let Some((ratio, pixels)) = pixel.honesty(subject) {
                found.honesty[index].count(ratio, pixels);
            }
        }
    }
    found
}

/// A pixel at a tolerance, and what the finer picture knows of it.
struct Pixel {
    place: (u32, u32),
    tolerance: f64,
    value: DVec4,
    claimed: f64,
    /// True if it says that it is over.
    is_confessed: bool,
    /// The distance from the mean of its parts.
    apart: f64,
    /// The error that this mean claims.
    uncertain: f64,
}

impl Pixel {
    fn of(picture: &Picture, finer: &Picture, place: (u32, u32), tolerance: f64) -> Self {
        let (col, row) = place;
        let (mut mean, mut uncertain) = (DVec4::ZERO, 0.0);
        let parts = FINER * FINER;
        for part in 0..parts {
            let (col, row) = (col * FINER + part % FINER, row * FINER + part / FINER);
            mean += finer.value(col, row) / f64::from(parts);
            uncertain += finer.claimed(col, row) / f64::from(parts);
        }
        let value = picture.value(col, row);
        Self {
            place,
            tolerance,
            value,
            claimed: picture.claimed(col, row),
            is_confessed: picture.is_over(col, row),
            apart: (value - mean).abs().max_element(),
            uncertain,
        }
    }

    fn place(&self) -> (u32, u32) {
        self.place
    }

    /// The largest error that the pixel may have.
    fn allowed(&self) -> f64 {
        if self.is_confessed {
            self.claimed
        } else {
            self.tolerance
        }
    }

    /// True unless the finer picture clears the pixel.
    fn is_suspect(&self) -> bool {
        let gave_up = self.uncertain > GIVEN_UP;
        self.apart > SUSPECT * self.allowed()
            || gave_up && self.apart + self.uncertain > self.allowed()
    }

    /// True if samples find nothing like it.
    fn is_unlike(&self, sampled: &Sampled) -> bool {
        sampled.contradicts(self.place(), self.value, self.allowed())
    }

    /// The pixel as a broken one, if the truth says that it is.
    fn shortfall(&self, subject: &Subject) -> Option<Broken> {
        let allowed = self.allowed();
        let (error, uncertain) = subject.error_of(self.place(), self.value, allowed)?;
        (error > allowed + uncertain).then(|| self.broken(error))
    }

    /// True if it claims next to nothing of what it is off by.
    fn has_false_claim(&self) -> bool {
        let off = self.apart - self.uncertain;
        off > FALSE * self.claimed && off > FALSE_OF_TOLERANCE * self.tolerance
    }

    /// The pixel with its true error.
    fn broken(&self, error: f64) -> Broken {
        let (col, row) = self.place();
        Broken {
            col,
            row,
            tolerance: self.tolerance,
            error,
            claimed: self.claimed,
            is_confessed: self.is_confessed,
        }
    }

    /// The true error over the claimed one, and for how many pixels it stands; none of negligible claims. The
    /// truth is asked where the finer picture is too close to tell.
    fn honesty(&self, subject: &Subject) -> Option<(f64, u32)> {
        let Self { claimed, apart, .. } = *self;
        if !claims_something(claimed, self.tolerance) {
            return None;
        }
        let tells = |error: f64, uncertain: f64| {
            error >= TELLING * uncertain || claimed >= TELLING_OF_CLAIMS * uncertain
        };
        if tells(apart, self.uncertain) {
            return Some((apart / claimed, 1));
        }
        let mut chance = Numbers(claimed.to_bits() ^ u64::from(32 * self.place.1 + self.place.0));
        if subject.is_slow() || chance.below(SHARE as usize) != 0 {
            return None;
        }
        let (error, uncertain) = subject.error_of(self.place(), self.value, claimed)?;
        tells(error, uncertain).then_some((error / claimed, SHARE))
    }
}

/// True for claims that are finite and not negligible.
pub(super) fn claims_something(claimed: f64, tolerance: f64) -> bool {
    claimed.is_finite() && claimed >= NEGLIGIBLE * tolerance
}
