//! The steps of a cloud that changes over time.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use crate::file::End;
use crate::table::{ColumnRef, FramePlace, Frames, Source, TableError};
use crate::text::LocatedFault;

/// The steps that a cloud has.
#[derive(Clone, Debug)]
pub(super) enum Steps {
    /// The first frame of a file, which does not change.
    One,
    /// A file for each.
    Files(Vec<PathBuf>),
    /// Frames of one file.
    Frames(Vec<FramePlace>),
    /// The rows of one table that have the same number in a column.
    Times(ColumnRef, Vec<f64>),
}

impl Steps {
    /// Doubts in the last of several files, which a program may still write when it is read. What is wrong in it
    /// is told when its turn comes.
    pub(super) fn doubts_of_last(&self, skip_lines: u64) -> Option<(PathBuf, Vec<LocatedFault>)> {
        let Self::Files(files) = self else {
            return None;
        };
        let (first, last) = (files.first()?, files.last()?);
        let mut frames = Frames::new(Source::open(last, &|_, _| {}).ok()?, skip_lines).ok()?;
        frames.skip().ok()?;
        let mut doubts = frames.take_doubts();
        let is_open = |path: &Path| last_byte(path).ok().map(|byte| byte != b'\n');
        if frames.is_plain_text() && is_open(last)? && !is_open(first)? {
            let doubt = "the file ends within a line, unlike the first file: its last number may have been cut off";
            doubts.push(LocatedFault::of_file(doubt));
        }
        Some((last.clone(), doubts))
    }
}

fn last_byte(path: &Path) -> io::Result<u8> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::End(-1))?;
    let mut byte = [0];
    file.read_exact(&mut byte)?;
    Ok(byte[0])
}

/// The step that each frame of the animation shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Timeline {
    /// The numbers of the steps that are shown; `None` for all.
    pub(super) range: Option<RangeInclusive<i32>>,
    /// One of so many is shown.
    pub(super) every: u32,
    /// Steps that a frame is on from the one before.
    pub(super) speed: f64,
    /// The look after the last one.
    pub(super) end: End,
}

impl Timeline {
    /// Those of these numbers that lie in the range.
    pub(super) fn in_range(&self, numbers: impl Iterator<Item = i64>) -> impl Iterator<Item = i64> {
        numbers.filter(|number| self.is_in_range(*number))
    }

    fn is_in_range(&self, number: i64) -> bool {
        let range = self.range.as_ref();
        range.is_none_or(|range| {
            (i64::from(*range.start())..=i64::from(*range.end())).contains(&number)
        })
    }

    /// The steps with these numbers that are shown, by their places.
    pub(super) fn choose(&self, numbers: impl Iterator<Item = i64>) -> Vec<usize> {
        let chosen = numbers
            .enumerate()
            .filter(|(_, number)| self.is_in_range(*number));
        chosen
            .step_by(self.every as usize)
            .map(|(place, _)| place)
            .collect()
    }

    /// The number of frames in which `count` steps are shown once.
    pub(super) fn frames(&self, count: usize) -> i32 {
        let frames = libm::ceil(count as f64 / self.speed - SLACK);
        // Saturating; an animation has a frame at least.
        (frames as i32).max(1)
    }

    /// The step that is shown so many frames behind the first one; `None` for nothing.
    pub(super) fn at(&self, frames: i64, count: usize) -> Option<usize> {
        let step = libm::floor(frames.max(0) as f64 * self.speed + SLACK);
        // Saturating, beyond all steps.
        let step = step as usize;
        match self.end {
            _ if step < count => Some(step),
            End::Hold => count.checked_sub(1),
            End::Loop => step.checked_rem(count),
            End::Hide => None,
        }
    }
}

/// Products of frames and speeds that should be whole numbers are, within this.
const SLACK: f64 = 1e-9;

/// The places of all frames of a table.
pub(super) fn index(frames: &mut Frames<'_>) -> Result<Vec<FramePlace>, TableError> {
    let mut places = Vec::new();
    loop {
        let place = frames.place();
        if !frames.skip()? {
            if places.len() > 1 {
                frames.doubt_open_end();
            }
            return Ok(places);
        }
        places.push(place);
        frames.check_count(places.len())?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline(speed: f64, end: End) -> Timeline {
        Timeline {
            range: None,
            every: 1,
            speed,
            end,
        }
    }

    #[test]
    fn frames_show_steps_at_their_speed() {
        let all =
            |timeline: &Timeline| -> Vec<_> { (0..7).map(|frame| timeline.at(frame, 3)).collect() };
        let [zero, one, two] = [0, 1, 2].map(Some);
        assert_eq!(
            all(&timeline(1.0, End::Hold)),
            [zero, one, two, two, two, two, two]
        );
        assert_eq!(
            all(&timeline(1.0, End::Loop)),
            [zero, one, two, zero, one, two, zero]
        );
        assert_eq!(
            all(&timeline(1.0, End::Hide)),
            [zero, one, two, None, None, None, None]
        );
        assert_eq!(
            all(&timeline(0.5, End::Hide)),
            [zero, zero, one, one, two, two, None]
        );
        let tenth = timeline(0.1, End::Hold);
        assert!((0..30).all(|frame| tenth.at(frame, 3) == Some(frame as usize / 10)));
        assert_eq!(tenth.frames(3), 30);
        assert_eq!(timeline(2.0, End::Hold).frames(5), 3);
        assert_eq!(timeline(2.0, End::Loop).at(3, 5), Some(1));
        assert_eq!(timeline(1.0, End::Loop).at(3, 0), None);
    }

    #[test]
    fn steps_are_chosen_by_their_numbers() {
        let chosen = |range, every| {
            let timeline = Timeline {
                range,
                every,
                ..timeline(1.0, End::Hold)
            };
            timeline.choose([0, 5, 10, 15, 20].into_iter())
        };
        assert_eq!(chosen(None, 1), [0, 1, 2, 3, 4]);
        assert_eq!(chosen(Some(5..=15), 1), [1, 2, 3]);
        assert_eq!(chosen(Some(5..=20), 3), [1, 4]);
        assert!(chosen(Some(30..=40), 1).is_empty());
    }
}
