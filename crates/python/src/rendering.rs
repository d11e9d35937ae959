//! Frames that are being rendered.

use std::path::Path;
use std::process;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use marbles_cli::library::{Next, Options, Rendering as Running};
use marbles_scene::Scene;
use pyo3::prelude::*;

use crate::errors::{RenderError, library_error};
use crate::picture::Picture;

#[pyclass(frozen, module = "marbles._native")]
pub(crate) struct Rendering {
    running: Mutex<Running>,
    #[pyo3(get)]
    warnings: Vec<String>,
    /// The process whose threads render. One that was forked from it has neither these threads nor the one that may
    /// have the lock.
    process: u32,
}

/// The time between two looks for Ctrl-C.
const PAUSE: Duration = Duration::from_millis(50);

impl Rendering {
    pub(crate) fn begin(
        py: Python<'_>,
        scene: &Arc<Scene>,
        path: &Path,
        options: &Options,
    ) -> PyResult<Self> {
        let running = py.detach(|| Running::begin(scene, path, options));
        let running = running.map_err(|error| library_error(py, &error))?;
        Ok(Self {
            warnings: running.warnings().to_vec(),
            running: Mutex::new(running),
            process: process::id(),
        })
    }

    fn is_of_another_process(&self) -> bool {
        self.process != process::id()
    }

    fn with<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Running) -> T + Send) -> T {
        // Whoever waits for the lock must not hold the interpreter: the one that has it may need that.
        py.detach(|| work(&mut self.running.lock().unwrap_or_else(PoisonError::into_inner)))
    }
}

#[pymethods]
impl Rendering {
    fn next(&self, py: Python<'_>) -> PyResult<Option<Picture>> {
        if self.is_of_another_process() {
            return Err(RenderError::new_err(
                "expected the process that began to render these frames, found another process, forked from it",
            ));
        }
        loop {
            let next = self.with(py, |running| running.next(PAUSE));
            match next.map_err(|error| library_error(py, &error))? {
                Next::Picture(picture) => return Picture::new(py, *picture).map(Some),
                Next::End => return Ok(None),
                Next::Waiting => {}
            }
            if let Err(interrupt) = py.check_signals() {
                self.stop(py);
                return Err(interrupt);
            }
        }
    }

    fn stop(&self, py: Python<'_>) {
        if self.is_of_another_process() {
            return;
        }
        self.with(py, Running::stop);
    }
}
