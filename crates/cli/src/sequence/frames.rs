//! Lists of frame numbers in the user's notation: `7`, `1-100`, `1-100x2`, `1-9:2,50,-5`.
//!
//! Range expressions of Open Job Description are also accepted: `10-1:-1` counts down, and spaces are allowed around
//! numbers.

use std::ops::RangeInclusive;
use std::str::FromStr;

use marbles_scene::{Scene, harmless};

/// The largest number of frames in a list, counting repetitions. More pictures would take too long, and so many are
/// counted quickly.
const MOST_FRAMES: u64 = 10_000_000;

/// The frame number of a scene without animation.
pub(crate) const FRAME_OF_A_STILL: i32 = 1;

/// The frames of a scene.
pub(crate) fn frames_of(scene: &Scene) -> RangeInclusive<i32> {
    let frames = scene.frames();
    frames.unwrap_or(FRAME_OF_A_STILL..=FRAME_OF_A_STILL)
}

/// Frame numbers in the order of the list, without repetitions.
///
/// The list stays as short as its text: it is expanded only during iteration.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct FrameList {
    /// At least one.
    ranges: Vec<Range>,
}

/// The frames `first`, `first + step`, … up to `last`, or down to it if `step` is negative.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
struct Range {
    first: i64,
    last: i64,
    step: i64,
}

impl FrameList {
    /// These frames in their order; `None` of none.
    pub(crate) fn of(frames: &[i32]) -> Option<Self> {
        let runs = frames.chunk_by(|one, next| one.checked_add(1) == Some(*next));
        let range = |run: &[i32]| Range {
            first: run[0].into(),
            last: run[run.len() - 1].into(),
            step: 1,
        };
        let ranges: Vec<Range> = runs.map(range).collect();
        (!ranges.is_empty()).then_some(Self { ranges })
    }

    /// The frames in order; repetitions are left out.
    pub(crate) fn iter(&self) -> impl Iterator<Item = i32> {
        self.ranges.iter().enumerate().flat_map(|(index, range)| {
            let earlier = &self.ranges[..index];
            range
                .iter()
                .filter(|&frame| !earlier.iter().any(|range| range.contains(frame)))
                .map(|frame| frame as i32)
        })
    }

    /// The first frame in order.
    pub(crate) fn first(&self) -> i32 {
        self.ranges[0].first as i32
    }

    /// The number of frames that [`FrameList::iter`] yields.
    pub(crate) fn count(&self) -> u64 {
        if let [range] = self.ranges[..] {
            return range.len();
        }
        let frames = self.ranges.iter().flat_map(|range| range.iter());
        let mut frames: Vec<i32> = frames.map(|frame| frame as i32).collect();
        frames.sort_unstable();
        frames.dedup();
        frames.len() as u64
    }
}

/// Frames in the user's notation, in order: `3-7,9`. Long lists are shortened.
pub(crate) fn listed(frames: &[i32]) -> String {
    const MOST_RANGES: usize = 20;
    let mut sorted = frames.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let mut ranges = sorted.chunk_by(|one, next| one + 1 == *next);
    let shown: Vec<String> = ranges
        .by_ref()
        .take(MOST_RANGES)
        .map(|range| match range {
            [first, .., last] => format!("{first}-{last}"),
            _ => range.iter().map(i32::to_string).collect(),
        })
        .collect();
    let others: usize = ranges.map(<[i32]>::len).sum();
    match others {
        0 => shown.join(","),
        _ => format!("{} and {others} more", shown.join(",")),
    }
}

impl From<RangeInclusive<i32>> for FrameList {
    fn from(frames: RangeInclusive<i32>) -> Self {
        let range = Range {
            first: i64::from(*frames.start()),
            last: i64::from(*frames.end()),
            step: 1,
        };
        Self {
            ranges: vec![range],
        }
    }
}

impl FromStr for FrameList {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let ranges = text.split(',').map(|item| item.trim().parse());
        let ranges: Vec<Range> = ranges.collect::<Result<_, _>>()?;
        match ranges.iter().map(|range| range.len()).sum() {
            0..=MOST_FRAMES => Ok(Self { ranges }),
            frames => Err(format!(
                "expected a list of at most {MOST_FRAMES} frames, found {frames}"
            )),
        }
    }
}

impl Range {
    fn iter(self) -> impl Iterator<Item = i64> {
        (0..self.len() as i64).map(move |index| self.first + index * self.step)
    }

    fn len(self) -> u64 {
        ((self.last - self.first) / self.step + 1) as u64
    }

    fn contains(self, frame: i64) -> bool {
        let (least, most) = (self.first.min(self.last), self.first.max(self.last));
        (least..=most).contains(&frame) && (frame - self.first) % self.step == 0
    }
}

impl FromStr for Range {
    type Err = String;

    fn from_str(item: &str) -> Result<Self, Self::Err> {
        const EXPECTED: &str = "expected frames such as 7, 1-100 or 1-100x2";
        if item.is_empty() {
            return Err(format!("{EXPECTED} between the commas, found nothing"));
        }
        let syntax = || format!("{EXPECTED}, found `{}`", harmless(item));
        let (first, rest) = leading_number(item).ok_or_else(syntax)?;
        let first = frame_number(first)?;
        let (last, step) = if rest.is_empty() {
            (first, 1)
        } else {
            let rest = rest.strip_prefix('-').and_then(leading_number);
            let (last, rest) = rest.ok_or_else(syntax)?;
            let last = frame_number(last)?;
            let step = rest.strip_prefix(['x', ':']).map(leading_number);
            match step {
                Some(Some((number, ""))) => (last, step_number(number)?),
                None if rest.is_empty() => (last, 1),
                _ => return Err(syntax()),
            }
        };
        if step > 0 && last < first {
            return Err(format!(
                "expected the smaller frame first, from {last} to {first}, found `{first}-{last}`"
            ));
        }
        if step < 0 && last > first {
            return Err(format!(
                "expected the larger frame first, because the step is negative, from {last} to \
                 {first}, found `{first}-{last}`"
            ));
        }
        Ok(Self { first, last, step })
    }
}

/// Splits off an optional sign and at least one digit, with the spaces around them.
fn leading_number(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let digits = text.strip_prefix('-').unwrap_or(text);
    let rest = digits.trim_start_matches(|letter: char| letter.is_ascii_digit());
    let (number, rest) = text.split_at(text.len() - rest.len());
    (number.len() > text.len() - digits.len()).then(|| (number, rest.trim_start()))
}

fn frame_number(text: &str) -> Result<i64, String> {
    const RANGE: RangeInclusive<i64> = i32::MIN as i64..=i32::MAX as i64;
    let number = text.parse().ok().filter(|number| RANGE.contains(number));
    number.ok_or_else(|| {
        let (min, max) = RANGE.into_inner();
        format!("expected frame numbers from {min} to {max}, found {text}")
    })
}

fn step_number(text: &str) -> Result<i64, String> {
    const MOST: i64 = u32::MAX as i64;
    let step = text.parse().ok();
    let step = step.filter(|step: &i64| *step != 0 && (-MOST..=MOST).contains(step));
    step.ok_or_else(|| {
        format!("expected a step from 1 to {MOST}, or from -{MOST} to -1, found {text}")
    })
}

#[cfg(test)]
mod tests;
