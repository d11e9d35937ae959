//! Compares the pixels of a scene with a picture of more pixels, and with samples.

use glam::DVec4;

use super::picture::Picture;
use super::sampled::Sampled;
use super::subject::Subject;
use super::{Broken, Found, random};
use marbles_tests::numbers::Numbers;

/// The factor of the finer picture that finds suspects, and its tolerance.
const FINER: u32 = 3;
const FINEST: f64 = 1e-6;
/// Its tolerance under soft light, which takes long: this part of the smallest tolerance, but not less than this.
const SOFT_FINEST_OF_TOLERANCE: f64 = 0.1;
const SOFT_FINEST: f64 = 1e-5;

/// The number of suspect pixels of a scene under soft light that the integrator judges at each tolerance.
const SOFT_JUDGED: u32 = 16;

/// The difference from the finer picture, in tolerances, from which a pixel is suspect. The remaining tenth is more
/// than the claims of both pictures.
const SUSPECT: f64 = 0.9;

/// A pixel of the finer picture that claims more than this, a hundred times its tolerance, is over its tolerance. It
/// may have the same fault as the suspect pixel, so its claim is added to the difference.
const GIVEN_UP: f64 = 1e-4;

/// The fraction of the tolerance below which a claim is negligible.
pub(super) const NEGLIGIBLE: f64 = 0.01;

/// A difference is used as the true error if it is at least this many times the claim of the finer picture.
const TELLING: f64 = 10.0;
/// It is also used for the ratio to a claim if the claim is this many times that of the finer picture: the error of the
/// ratio is then below a tenth.
const TELLING_OF_CLAIMS: f64 = 10.0;

/// A claim is false if the error is this many times as large, and larger than this fraction of the tolerance.
const FALSE: f64 = 20.0;
const FALSE_OF_TOLERANCE: f64 = 0.02;

/// If the difference is not precise enough, the integrator judges one of this many pixels.
const SHARE: u32 = 256;

/// The broken pixels of a scene, and the ratios of true and claimed errors.
pub(super) fn judge(subject: &Subject, tolerances: &[f64]) -> Found {
    if random::is_fine(subject) {
        return random::judge(subject, tolerances);
    }
    let mut found = Found::new(tolerances);
    let finest = if subject.is_soft() {
        let smallest = tolerances.iter().copied().fold(f64::INFINITY, f64::min);
        (SOFT_FINEST_OF_TOLERANCE * smallest).max(SOFT_FINEST)
    } else {
        FINEST
    };
    let Some(finer) = subject.finer_picture(FINER, finest) else {
        found.skipped += u64::from(subject.is_soft());
        return found;
    };
    let sampled = Sampled::of(subject);
    for (index, &tolerance) in tolerances.iter().enumerate() {
        let Some(picture) = subject.picture(tolerance) else {
            continue;
        };
        let mut left = SOFT_JUDGED;
        for place in picture.places() {
            let pixel = Pixel::of(&picture, &finer, place, tolerance);
            found.pixels += 1;
            found.rendered += 1;
            found.given_up[index] += u64::from(pixel.is_confessed);
            if pixel.is_confessed && found.unmet.is_none() {
                found.unmet = Some(pixel.broken(pixel.apart));
            }
            let is_suspect = pixel.is_suspect(subject.is_soft())
                || sampled.as_ref().is_some_and(|it| pixel.is_unlike(it));
            if is_suspect && subject.is_soft() && left == 0 && !pixel.is_surely_off() {
                found.unjudged += 1;
            } else if is_suspect {
                left = left.saturating_sub(1);
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

/// A pixel at a tolerance, and its comparison with the finer picture.
struct Pixel {
    place: (u32, u32),
    tolerance: f64,
    value: DVec4,
    claimed: f64,
    /// Whether it is reported as over the tolerance.
    is_confessed: bool,
    /// The difference from the mean of its parts in the finer picture.
    apart: f64,
    /// The claimed error of this mean.
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

    /// The largest allowed error of the pixel.
    fn allowed(&self) -> f64 {
        if self.is_confessed {
            self.claimed
        } else {
            self.tolerance
        }
    }

    /// Returns whether the finer picture contradicts the pixel.
    fn is_suspect(&self, is_soft: bool) -> bool {
        let gave_up = is_soft || self.uncertain > GIVEN_UP;
        self.apart > SUSPECT * self.allowed()
            || gave_up && self.apart + self.uncertain > self.allowed()
    }

    /// Returns whether the finer picture contradicts the pixel by more than it claims.
    fn is_surely_off(&self) -> bool {
        self.apart - self.uncertain > self.allowed()
    }

    /// Returns whether samples contradict the pixel.
    fn is_unlike(&self, sampled: &Sampled) -> bool {
        sampled.contradicts(self.place(), self.value, self.allowed())
    }

    /// The pixel as a broken one, if the integrator agrees.
    fn shortfall(&self, subject: &Subject) -> Option<Broken> {
        let allowed = self.allowed();
        let (error, uncertain) = subject.error_of(self.place(), self.value, allowed)?;
        (error > allowed + uncertain).then(|| self.broken(error))
    }

    /// Returns whether its claim is a tiny part of its error.
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

    /// The true error divided by the claimed one, and the number of pixels that this ratio represents; `None` for
    /// negligible claims. The integrator decides if the finer picture is not precise enough.
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
        if subject.is_slow() || subject.is_soft() || chance.below(SHARE as usize) != 0 {
            return None;
        }
        let (error, uncertain) = subject.error_of(self.place(), self.value, claimed)?;
        tells(error, uncertain).then_some((error / claimed, SHARE))
    }
}

/// Returns whether a claim is finite and not negligible.
pub(super) fn claims_something(claimed: f64, tolerance: f64) -> bool {
    claimed.is_finite() && claimed >= NEGLIGIBLE * tolerance
}
