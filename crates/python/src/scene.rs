//! A scene that was read and checked.

use std::collections::HashMap;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::Arc;

use marbles_cli::library::{self, Options};
use marbles_core::{Method, Window};
use marbles_scene::{Scene as LoadedScene, Tables};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyDict;

use crate::errors::{library_error, scene_error};
use crate::rendering::Rendering;

#[pyclass(frozen, module = "marbles._native")]
pub(crate) struct Scene {
    scene: Arc<LoadedScene>,
    /// Named in messages and in sidecars.
    path: PathBuf,
}

/// The bytes of a table, which Python keeps.
struct Table(PyBackedBytes);

impl AsRef<[u8]> for Table {
    fn as_ref(&self) -> &[u8] {
        &self.0
    }
}

/// The material of spheres that have none.
const NO_MATERIAL: u32 = u32::MAX;

#[pymethods]
impl Scene {
    #[staticmethod]
    fn parse(
        py: Python<'_>,
        text: &str,
        path: PathBuf,
        tables: HashMap<String, PyBackedBytes>,
    ) -> PyResult<Self> {
        let mut in_memory = Tables::default();
        for (name, bytes) in tables {
            in_memory.insert(&name, Arc::new(Table(bytes)));
        }
        let scene = py.detach(|| LoadedScene::parse_with_tables(text, &path, &in_memory));
        let scene = scene.map_err(|error| scene_error(py, &error))?;
        Ok(Self {
            scene: Arc::new(scene),
            path,
        })
    }

    #[getter]
    fn size(&self) -> PyResult<(u32, u32)> {
        let frame = self.scene.frames().map_or(1, |frames| *frames.start());
        let view = self.scene.view(frame).map_err(value_error)?;
        Ok((view.width, view.height))
    }

    #[getter]
    fn frames(&self) -> Option<(i32, i32)> {
        let frames = self.scene.frames()?;
        Some((*frames.start(), *frames.end()))
    }

    #[getter]
    fn frames_per_second(&self) -> Option<f64> {
        self.scene.frames_per_second()
    }

    #[getter]
    fn materials(&self) -> Vec<String> {
        self.scene.description().materials.clone()
    }

    #[getter]
    fn lights(&self) -> Vec<Option<String>> {
        self.scene.description().lights.clone()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.scene.warnings().to_vec()
    }

    fn take_warnings(&self) -> Vec<String> {
        self.scene.take_late_warnings()
    }

    fn spheres<'py>(&self, py: Python<'py>, frame: i32) -> PyResult<Bound<'py, PyDict>> {
        let world = py.detach(|| self.scene.world_at(frame));
        let world = world.map_err(|error| scene_error(py, &error))?;
        let spheres = world.spheres();
        let count = spheres.len();
        let named = self.scene.description().materials.len();
        let centers = spheres.iter().flat_map(|sphere| sphere.center().to_array());
        let albedos = (0..count).flat_map(|index| world.albedo(index).to_array());
        let material = |index| match world.material_index(index) as usize {
            material if material < named => material as u32,
            _ => NO_MATERIAL,
        };
        let materials: Vec<u32> = (0..count).map(material).collect();
        let radii: Vec<f64> = spheres.iter().map(|sphere| sphere.radius()).collect();
        let table = PyDict::new(py);
        table.set_item("center", rows_of_three(centers.collect())?.into_pyarray(py))?;
        table.set_item("radius", PyArray1::from_vec(py, radii))?;
        table.set_item("albedo", rows_of_three(albedos.collect())?.into_pyarray(py))?;
        table.set_item("material", PyArray1::from_vec(py, materials))?;
        Ok(table)
    }

    #[pyo3(signature = (frame, size))]
    fn sidecar(&self, py: Python<'_>, frame: i32, size: Option<(u32, u32)>) -> PyResult<String> {
        let text = library::sidecar_of(&self.scene, &self.path, frame, size);
        text.map_err(|error| library_error(py, &error))
    }

    #[pyo3(signature = (frames, *, tolerance, samples, alpha, channels, depth, axes, size, region, per_light, threads, progress))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn start(
        &self,
        py: Python<'_>,
        frames: Vec<i32>,
        tolerance: Option<f64>,
        samples: Option<u32>,
        alpha: bool,
        channels: Vec<String>,
        depth: String,
        axes: String,
        size: Option<(u32, u32)>,
        region: Option<(u32, u32, u32, u32)>,
        per_light: bool,
        threads: Option<usize>,
        progress: bool,
    ) -> PyResult<Rendering> {
        let samples = samples.map(|samples| {
            let none = || PyValueError::new_err("samples: expected one at least, found 0");
            NonZeroU32::new(samples).ok_or_else(none)
        });
        let method = match (tolerance, samples) {
            (Some(tolerance), None) => Method::Tolerance(tolerance),
            (None, Some(samples)) => Method::Samples(samples?),
            _ => {
                let message = "expected `tolerance` or `samples`, found both or none";
                return Err(PyValueError::new_err(message));
            }
        };
        let region = region.map(|(col, row, width, height)| Window {
            col,
            row,
            width,
            height,
        });
        let options = Options {
            frames,
            method,
            alpha,
            channels,
            depth,
            axes,
            size,
            region,
            per_light,
            threads,
            progress,
        };
        Rendering::begin(py, &self.scene, &self.path, &options)
    }
}

fn rows_of_three(numbers: Vec<f64>) -> PyResult<Array2<f64>> {
    Array2::from_shape_vec((numbers.len() / 3, 3), numbers).map_err(value_error)
}

fn value_error(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
