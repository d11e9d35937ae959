//! The part in Rust of the Python package `marbles`: scenes from text and tables in memory, renderings, pictures as
//! arrays. `python/marbles` is the rest, and describes the whole.
//!
//! The crate is empty without its feature `module`.

#![cfg(feature = "module")]
// What Python sees is documented in `_native.pyi`.
#![allow(missing_docs, reason = "the documentation is in `_native.pyi`")]

mod errors;
mod picture;
mod rendering;
mod scene;

use std::ffi::OsString;
use std::path::Path;

use marbles_scene::Scene;
use pyo3::prelude::*;

use crate::errors::{refused, scene_error};

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::errors::{Fault, RenderError, SceneError};
    #[pymodule_export]
    use crate::picture::Picture;
    #[pymodule_export]
    use crate::rendering::Rendering;
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::{run, scene_text, set_value, to_ron, value_at};

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}

/// Runs the command as a process of its own would.
#[pyfunction]
fn run(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| marbles_cli::exit_code(arguments))
}

#[pyfunction]
fn to_ron(py: Python<'_>, text: &str) -> PyResult<String> {
    Scene::text_in_ron(text).map_err(|error| scene_error(py, &error))
}

#[pyfunction]
fn set_value(py: Python<'_>, text: &str, path: &str, value: &str) -> PyResult<String> {
    Scene::with_value(text, path, value).map_err(|message| refused(py, path, &message))
}

#[pyfunction]
fn value_at<'t>(text: &'t str, path: &str) -> Option<&'t str> {
    Scene::value_in(text, path)
}

#[pyfunction]
fn scene_text(py: Python<'_>, path: &str) -> PyResult<String> {
    Scene::text_of(Path::new(path)).map_err(|error| scene_error(py, &error))
}
