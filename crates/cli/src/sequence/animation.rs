//! All frames in one file.

use std::sync::mpsc::Receiver;

use super::{Order, Sequence, Tally, Ways};
use crate::commands::render::FRAME_OF_A_STILL;
use crate::formats::Unwritten;
use crate::sequence::messages;
use crate::sequence::strip_encoder::Ending;
use crate::terminal::progress::Progress;

impl Sequence<'_> {
    /// Writes pictures as they come. Without all of them there is no file, and none counts as written.
    pub(super) fn write_loop(
        &self,
        orders: Receiver<Order>,
        ways: &Ways,
        progress: &Progress,
    ) -> Tally {
        let _closing = ways.belt.closing();
        let mut tally = Tally::default();
        let first = self.frames.iter().next();
        let path = self.pattern.path(first.unwrap_or(FRAME_OF_A_STILL));
        let shown = path.display().to_string();
        // There are fewer, or the list of frames would have been refused.
        let frames = u32::try_from(self.frames.count()).unwrap_or(u32::MAX);
        let mut warnings = Vec::new();
        let rate = self.frames_per_second;
        let belt = &mut &ways.belt;
        let written = ways.coder.write_loop(&path, frames, rate, belt, || {
            let order = orders.recv().ok()?;
            let frame = order.facts.frame;
            let Ending { gathered, time } = order.ending.recv().ok()?;
            let summary = gathered.summary?;
            tally.add(summary, time);
            progress.written(frame, tally.written, 0);
            if summary.over_tolerance > 0 {
                let shown = format!("{shown}: frame {frame}");
                let count = summary.over_tolerance;
                warnings.push(messages::over_tolerance(&shown, count, gathered.worst));
            }
            Some(())
        });
        match (written, &tally.total) {
            (Ok(()), Some(total)) => {
                progress.result(&messages::result(&shown, total, tally.time));
                for warning in warnings {
                    progress.warn(&warning);
                }
                return tally;
            }
            (Err(Unwritten::Failed(failure)), _) => {
                // The one that was being written, if it was not the end of the file.
                let mut frames = self.frames.iter();
                let failed = frames.nth(tally.written as usize);
                let failed = failed.or_else(|| self.frames.iter().last());
                let failed = failed.unwrap_or(FRAME_OF_A_STILL);
                let message = failure.into_message();
                ways.failures.add(failed, &path, message, progress);
            }
            (Err(Unwritten::Stopped), _) | (Ok(()), None) => {}
        }
        Tally::default()
    }
}
