//! The rows of a step, read from its file.

use std::path::Path;
use std::sync::PoisonError;

use super::CloudError;
use super::open::{FIRST_OF_SEVERAL, OpenCloud, UNWATCHED};
use super::steps::Steps;
use crate::table::{FramePlace, Frames, OtherName, Request, Rows, Source, TableError};
use crate::text::harmless;

impl OpenCloud {
    /// Opens the file at `path` behind the lines that the scene skips.
    pub(super) fn open_file<'watch>(
        &self,
        path: &Path,
        watch: &'watch (dyn Fn(u64, u64) + Sync),
    ) -> Result<Frames<'watch>, TableError> {
        let source = match self.in_memory() {
            Some(bytes) => Source::in_memory(path, bytes, watch),
            None => Source::open(path, watch)?,
        };
        let mut frames = Frames::new(source, self.cloud.skip_lines)?;
        if let Some((name, _)) = &self.cloud.topology {
            frames.set_topology(OtherName {
                name: name.clone(),
                path: self.folder.join(name),
            })?;
        }
        Ok(frames)
    }

    /// The rows of a step, and whether frames follow that are not read.
    pub(super) fn rows(
        &self,
        step: usize,
        watch: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<(Rows, bool), CloudError> {
        let path = self.path(step);
        let rows = match &self.steps {
            Steps::Frames(places) => {
                let rows = self.frame(&path, step, places);
                rows.map(|rows| (rows, false))
            }
            Steps::One | Steps::Files(_) => self.first_frame(&path, &self.cloud.request, watch),
            Steps::Times(column, times) => {
                let request = self.request_at(column, times[step]);
                self.first_frame(&path, &request, watch)
            }
        };
        rows.map_err(|error| self.refuse_table(&path, error))
    }

    pub(super) fn first_frame(
        &self,
        path: &Path,
        request: &Request,
        watch: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<(Rows, bool), TableError> {
        let mut frames = self.open_file(path, watch)?;
        self.observed.check(path, &frames)?;
        let rows = frames.read(request);
        frames.check_unchanged()?;
        self.observed.note_others(&mut frames)?;
        let rows = rows?.ok_or_else(gone)?;
        let has_more = frames.has_more();
        if has_more && path != self.path(0) {
            // That of the first step is told with the scene.
            let name = harmless(&self.name_of(path));
            self.observed.warn([format!("{name}: {FIRST_OF_SEVERAL}")]);
        }
        frames.finish()?;
        self.note_doubts(path, &mut frames);
        Ok((rows, has_more))
    }

    fn frame(&self, path: &Path, step: usize, places: &[FramePlace]) -> Result<Rows, TableError> {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let ready = open.take().and_then(|mut frames| {
            frames.go_to(places[step]).ok()?;
            Some(frames)
        });
        let mut frames = match ready {
            Some(frames) => frames,
            None => {
                let mut frames = self.open_file(path, UNWATCHED)?;
                frames.go_to(places[step])?;
                frames
            }
        };
        self.observed.check(path, &frames)?;
        frames.check_unchanged()?;
        let rows = frames.read(&self.cloud.request);
        // What another one looks like says nothing.
        frames.check_unchanged()?;
        self.observed.note_others(&mut frames)?;
        let rows = rows?;
        *open = Some(frames);
        rows.ok_or_else(gone)
    }
}

/// The file became shorter since its frames were counted.
pub(super) fn gone() -> TableError {
    std::io::Error::from(std::io::ErrorKind::UnexpectedEof).into()
}
