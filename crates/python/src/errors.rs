//! Errors of Rust as exceptions of Python.

use marbles_cli::library::Error;
use marbles_scene::SceneError as RefusedScene;
use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    marbles,
    SceneError,
    PyValueError,
    "A scene, or a table of it, that is refused.\n\n\
     `faults` are all faults, in the order of the text. `path`, `line` and `column` are the place of the first one: the path\n\
     of the value, such as `spheres[3].radius`, and the line and the column in characters, from 1. `file` is the refused\n\
     file: the scene, or a table. `line` and `column` are None if no file is meant."
);
create_exception!(
    marbles,
    RenderError,
    PyRuntimeError,
    "A rendering that failed: no memory, no space on the disk, or a table that changed meanwhile."
);

/// One fault of a refused scene.
#[pyclass(frozen, get_all, module = "marbles._native")]
pub(crate) struct Fault {
    path: String,
    line: usize,
    column: usize,
    message: String,
}

#[pymethods]
impl Fault {
    fn __repr__(&self) -> String {
        let Self {
            path,
            line,
            column,
            message,
        } = self;
        format!("<Fault {path:?}, line {line}, column {column}: {message:?}>")
    }
}

/// The exception for a scene that was refused.
pub(crate) fn scene_error(py: Python<'_>, error: &RefusedScene) -> PyErr {
    let faults = error.faults().iter().map(|fault| Fault {
        path: fault.value.clone(),
        line: fault.line,
        column: fault.column,
        message: fault.message.clone(),
    });
    let file = error.path().to_string_lossy();
    exception(py, &error.to_string(), faults.collect(), &file)
}

/// The exception for the value at a path, which was refused for this reason.
pub(crate) fn refused(py: Python<'_>, path: &str, message: &str) -> PyErr {
    let fault = Fault {
        path: path.to_owned(),
        line: 1,
        column: 1,
        message: message.to_owned(),
    };
    exception(py, &format!("{path}: {message}"), vec![fault], "")
}

/// An exception with its attributes.
fn exception(py: Python<'_>, message: &str, faults: Vec<Fault>, file: &str) -> PyErr {
    let exception = SceneError::new_err(message.to_owned());
    let first = faults.first();
    let path = first.map_or_else(String::new, |fault| fault.path.clone());
    let place = first.map(|fault| (fault.line, fault.column)).unzip();
    let set = || -> PyResult<()> {
        let value = exception.value(py);
        value.setattr("path", path)?;
        value.setattr("line", place.0)?;
        value.setattr("column", place.1)?;
        value.setattr("file", file)?;
        value.setattr("faults", faults)
    };
    match set() {
        Ok(()) => exception,
        Err(error) => error,
    }
}

/// The exception for an error of the library.
pub(crate) fn library_error(py: Python<'_>, error: &Error) -> PyErr {
    match error {
        Error::Value(message) => PyValueError::new_err(message.clone()),
        Error::Scene(error) => scene_error(py, error),
        Error::File(message) => PyOSError::new_err(message.clone()),
        Error::Work(message) => RenderError::new_err(message.clone()),
    }
}
