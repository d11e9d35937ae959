//! Lists of frame numbers, as the user writes them: `7`, `1-100`, `1-100x2`, `1-9:2,50,-5`.
//!
//! Range expressions of Open Job Description are such lists, where `10-1:-1` counts down and there
//! may be spaces around numbers.

use std::ops::RangeInclusive;
use std::str::FromStr;

use thiserror::Error;

/// The longest list that users may write, each frame as often as it is named: nobody waits for
/// more pictures, and so many frames are counted in no time.
const MOST_FRAMES: u64 = 10_000_000;

/// Frame numbers in the order of the list, each once.
///
/// The list stays as short as its text: it costs nothing before it is iterated.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct FrameList {
    ranges: Vec<Range>,
}

/// The frames `first`, `first + step`, … up to `last`, or down to it where `step` is negative.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
struct Range {
    first: i64,
    last: i64,
    step: i64,
}

/// Why a text is no list of frames.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
pub(crate) enum FrameListError {
    #[error("expected frames such as 7, 1-100 or 1-100x2 between the commas, found nothing")]
    Empty,
    #[error("expected frames such as 7, 1-100 or 1-100x2, found `{0}`")]
    Syntax(String),
    #[error("expected frame numbers from {min} to {max}, found {0}", min = i32::MIN, max = i32::MAX)]
    Number(String),
    #[error("expected a step from 1 to {max}, or from -{max} to -1, found {0}", max = u32::MAX)]
    Step(String),
    #[error("expected the smaller frame first, from {last} to {first}, found `{first}-{last}`")]
    Backward { first: i32, last: i32 },
    #[error(
        "expected the larger frame first where the step is negative, from {last} to {first}, \
         found `{first}-{last}`"
    )]
    Forward { first: i32, last: i32 },
    #[error("expected a list of at most {MOST_FRAMES} frames, found one of {0}")]
    TooMany(u64),
}

impl FrameList {
    /// The frames in order, a frame that is named twice only the first time.
    pub(crate) fn iter(&self) -> impl Iterator<Item = i32> {
        self.ranges.iter().enumerate().flat_map(|(index, range)| {
            let earlier = &self.ranges[..index];
            range
                .iter()
                .filter(|&frame| !earlier.iter().any(|range| range.contains(frame)))
                .map(|frame| frame as i32)
        })
    }

    /// How many frames [`FrameList::iter`] yields.
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

    /// Whether there is more than one frame.
    pub(crate) fn is_sequence(&self) -> bool {
        self.iter().nth(1).is_some()
    }
}

/// Frames as users write them, in order: `3-7,9`, and no more than one can look at.
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
    type Err = FrameListError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let ranges = text.split(',').map(|item| item.trim().parse());
        let ranges: Vec<Range> = ranges.collect::<Result<_, _>>()?;
        match ranges.iter().map(|range| range.len()).sum() {
            0..=MOST_FRAMES => Ok(Self { ranges }),
            frames => Err(FrameListError::TooMany(frames)),
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
    type Err = FrameListError;

    fn from_str(item: &str) -> Result<Self, Self::Err> {
        if item.is_empty() {
            return Err(FrameListError::Empty);
        }
        let syntax = || FrameListError::Syntax(item.to_owned());
        let (first, rest) = leading_number(item).ok_or_else(syntax)?;
        let first = frame_number(first)?;
        if rest.is_empty() {
            return Ok(Self {
                first: i64::from(first),
                last: i64::from(first),
                step: 1,
            });
        }
        let (last, rest) = rest
            .strip_prefix('-')
            .and_then(leading_number)
            .ok_or_else(syntax)?;
        let last = frame_number(last)?;
        let step = match rest.strip_prefix(['x', ':']) {
            Some(step) => {
                leading_number(step)
                    .filter(|(_, rest)| rest.is_empty())
                    .ok_or_else(syntax)?
                    .0
            }
            None if rest.is_empty() => "1",
            None => return Err(syntax()),
        };
        let step = match step.parse::<i64>() {
            Ok(step) if (1..=u64::from(u32::MAX)).contains(&step.unsigned_abs()) => step,
            _ => return Err(FrameListError::Step(step.to_owned())),
        };
        if step > 0 && last < first {
            return Err(FrameListError::Backward { first, last });
        }
        if step < 0 && last > first {
            return Err(FrameListError::Forward { first, last });
        }
        Ok(Self {
            first: i64::from(first),
            last: i64::from(last),
            step,
        })
    }
}

/// Splits an optional sign and at least one digit off, with the spaces around them.
fn leading_number(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let digits = text.strip_prefix('-').unwrap_or(text);
    let rest = digits.trim_start_matches(|letter: char| letter.is_ascii_digit());
    let (number, rest) = text.split_at(text.len() - rest.len());
    (number.len() > text.len() - digits.len()).then(|| (number, rest.trim_start()))
}

fn frame_number(text: &str) -> Result<i32, FrameListError> {
    text.parse()
        .map_err(|_| FrameListError::Number(text.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Vec<i32> {
        let list: FrameList = text.parse().unwrap();
        let frames: Vec<i32> = list.iter().collect();
        assert_eq!(list.count(), frames.len() as u64, "{text}");
        assert_eq!(list.is_sequence(), frames.len() > 1, "{text}");
        frames
    }

    fn refusal(text: &str) -> String {
        text.parse::<FrameList>().unwrap_err().to_string()
    }

    #[test]
    fn lists_are_read() {
        assert_eq!(frames("7"), [7]);
        assert_eq!(frames("1-4"), [1, 2, 3, 4]);
        assert_eq!(frames("1-6x2"), [1, 3, 5]);
        assert_eq!(frames("1-7:3"), [1, 4, 7]);
        assert_eq!(frames("9-15:2"), [9, 11, 13, 15]);
        assert_eq!(frames("17, 19,30"), [17, 19, 30]);
        assert_eq!(frames("3-3x5"), [3]);
        assert_eq!(frames("007"), [7]);
    }

    #[test]
    fn negative_frames_are_read() {
        assert_eq!(frames("-5"), [-5]);
        assert_eq!(frames("-2-1"), [-2, -1, 0, 1]);
        assert_eq!(frames("-10--8"), [-10, -9, -8]);
        assert_eq!(frames("-4-4x4"), [-4, 0, 4]);
    }

    #[test]
    fn range_expressions_of_open_job_description_are_read() {
        // What its model 0.13 makes of each.
        assert_eq!(frames("1-3,7,9-15:2"), [1, 2, 3, 7, 9, 11, 13, 15]);
        assert_eq!(frames("1,2,4-8:2"), [1, 2, 4, 6, 8]);
        assert_eq!(frames("-5--1:2,0-2"), [-5, -3, -1, 0, 1, 2]);
        assert_eq!(frames("-5-5:5"), [-5, 0, 5]);
        assert_eq!(frames("1-10:20"), [1]);
        assert_eq!(frames("10-1:-3"), [10, 7, 4, 1]);
        assert_eq!(frames("-1--8:-3"), [-1, -4, -7]);
        assert_eq!(frames("5-5:-1"), [5]);
        assert_eq!(frames(" 1 - 5 : 2 ,\t7 "), [1, 3, 5, 7]);
    }

    #[test]
    fn order_is_kept_and_a_frame_comes_once() {
        assert_eq!(frames("9-1x-2,1-5"), [9, 7, 5, 3, 1, 2, 4]);
        assert_eq!(frames("5,1-6x2,2-5,5,0"), [5, 1, 3, 2, 4, 0]);
        assert_eq!(frames("1-3,2-4,3-9x2,1-9x4").len(), 7);
    }

    #[test]
    fn frames_are_listed_as_users_write_them() {
        assert_eq!(listed(&[5]), "5");
        assert_eq!(listed(&[4, -2, 9, 3, -1, 5, 4]), "-2--1,3-5,9");
        let frames = FrameList::from_str(&listed(&[-3, -2, 7, 8, 9])).unwrap();
        assert_eq!(frames.iter().collect::<Vec<_>>(), [-3, -2, 7, 8, 9]);
        let odd: Vec<i32> = (0..1000).map(|index| 2 * index + 1).collect();
        assert!(listed(&odd).ends_with(",37,39 and 980 more"));
    }

    #[test]
    fn extremes_are_lazy() {
        let list = FrameList::from(i32::MIN..=i32::MAX);
        assert_eq!(list.count(), 1 << 32);
        assert!(list.is_sequence());
        let ends = "-2147483648-2147483647x4294967295";
        assert_eq!(frames(ends), [i32::MIN, i32::MAX]);
    }

    #[test]
    fn long_lists_are_counted_or_refused_at_once() {
        let overlapping = |least: i32, most: i32| {
            let item = |step| format!("{least}-{most}x{step}");
            let items: Vec<String> = (2..300).map(item).collect();
            items.join(",")
        };
        let refused = refusal(&overlapping(-2_000_000_000, 2_000_000_000));
        let expected = "expected a list of at most 10000000 frames, found one of ";
        assert!(refused.starts_with(expected), "{refused}");

        let list: FrameList = overlapping(-900_000, 900_000).parse().unwrap();
        assert!((1_000_000..1_800_001).contains(&list.count()));
        assert!(list.is_sequence());
        assert_eq!(
            refusal("5,1-10000000"),
            format!("{expected}{}", MOST_FRAMES + 1)
        );
    }

    #[test]
    fn refuses_with_what_was_expected() {
        assert!(refusal("").ends_with("found nothing"));
        assert!(refusal("1,,2").ends_with("found nothing"));
        assert!(refusal("1,").ends_with("found nothing"));
        for step in [
            "0",
            "-0",
            "4294967296",
            "-4294967296",
            "99999999999999999999",
        ] {
            let expected = "expected a step from 1 to 4294967295, or from -4294967295 to -1";
            assert_eq!(
                refusal(&format!("1-5x{step}")),
                format!("{expected}, found {step}")
            );
        }
        assert_eq!(
            refusal("1-5:-2"),
            "expected the larger frame first where the step is negative, from 5 to 1, found `1-5`"
        );
        assert_eq!(
            refusal("1--3"),
            "expected the smaller frame first, from -3 to 1, found `1--3`"
        );
        assert_eq!(
            refusal("2147483648"),
            "expected frame numbers from -2147483648 to 2147483647, found 2147483648"
        );
        for text in [
            "a", "1-", "-", "--5", "1-5x", "1-5y2", "1x2", "1-5x2x2", "1 5", "- 5", "+3", "1.5",
            "1-5 2", "1-5:", "1-5::2",
        ] {
            assert!(
                refusal(text).contains(&format!("found `{text}`")),
                "{}",
                refusal(text)
            );
        }
    }
}
