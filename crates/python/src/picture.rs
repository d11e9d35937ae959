//! A rendered frame.

use std::path::PathBuf;

use marbles_cli::library::{GivenNumbers, Numbers, Picture as Rendered, PictureArray, SaveOptions};
use numpy::ndarray::{ArrayD, IxDyn};
use numpy::{IntoPyArray, PyArray3, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors::library_error;

#[pyclass(frozen, module = "marbles._native")]
pub(crate) struct Picture {
    rendered: Rendered,
    #[pyo3(get)]
    arrays: Py<PyDict>,
    per_light: Vec<(String, Py<Picture>)>,
}

impl Picture {
    pub(crate) fn new(py: Python<'_>, mut rendered: Rendered) -> PyResult<Self> {
        let arrays = PyDict::new(py);
        for array in rendered.take_arrays() {
            let (name, array) = owned(py, array)?;
            arrays.set_item(name, array)?;
        }
        let mut per_light = Vec::new();
        for (name, picture) in rendered.take_per_light() {
            per_light.push((name, Py::new(py, Self::new(py, picture)?)?));
        }
        Ok(Self {
            rendered,
            arrays: arrays.unbind(),
            per_light,
        })
    }

    /// Does something with the arrays as they are now.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&[(&str, GivenNumbers<'_>)]) -> Result<T, marbles_cli::library::Error> + Send,
    ) -> PyResult<T> {
        let mut held: Vec<(String, Held<'_>)> = Vec::new();
        for (name, array) in self.arrays.bind(py) {
            let held_array = if let Ok(array) = array.cast::<PyArrayDyn<f64>>() {
                Held::F64(array.try_readonly()?)
            } else if let Ok(array) = array.cast::<PyArrayDyn<u32>>() {
                Held::U32(array.try_readonly()?)
            } else {
                continue;
            };
            held.push((name.extract()?, held_array));
        }
        let mut given = Vec::new();
        for (name, array) in &held {
            let numbers = match array {
                Held::F64(array) => array.as_slice().map(GivenNumbers::F64),
                Held::U32(array) => array.as_slice().map(GivenNumbers::U32),
            };
            let numbers = numbers.map_err(|_| {
                PyValueError::new_err(format!("{name}: expected a contiguous array in C order"))
            })?;
            given.push((&**name, numbers));
        }
        let done = py.detach(|| work(&given));
        done.map_err(|error| library_error(py, &error))
    }
}

/// An array that nothing changes meanwhile.
enum Held<'py> {
    F64(PyReadonlyArrayDyn<'py, f64>),
    U32(PyReadonlyArrayDyn<'py, u32>),
}

/// An array that Python owns, in the same memory.
fn owned(py: Python<'_>, array: PictureArray) -> PyResult<(String, Bound<'_, PyAny>)> {
    fn of<T: numpy::Element>(
        py: Python<'_>,
        shape: Vec<usize>,
        numbers: Vec<T>,
    ) -> PyResult<Bound<'_, PyAny>> {
        let array = ArrayD::from_shape_vec(IxDyn(&shape), numbers);
        let array = array.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(array.into_pyarray(py).into_any())
    }
    let PictureArray {
        name,
        shape,
        numbers,
    } = array;
    let array = match numbers {
        Numbers::F64(numbers) => of(py, shape, numbers),
        Numbers::U32(numbers) => of(py, shape, numbers),
        Numbers::Bool(values) => of(py, shape, values),
    };
    Ok((name, array?))
}

#[pymethods]
impl Picture {
    #[getter]
    fn frame(&self) -> i32 {
        self.rendered.frame()
    }

    #[getter]
    fn per_light(&self, py: Python<'_>) -> Vec<(String, Py<Self>)> {
        let pictures = self.per_light.iter();
        pictures
            .map(|(name, picture)| (name.clone(), picture.clone_ref(py)))
            .collect()
    }

    #[getter]
    fn over(&self) -> u64 {
        self.rendered.summary().over_tolerance
    }

    #[getter]
    fn largest_error(&self) -> f64 {
        self.rendered.summary().largest_error
    }

    #[getter]
    fn sidecar(&self, py: Python<'_>) -> PyResult<String> {
        self.rendered
            .sidecar()
            .map_err(|error| library_error(py, &error))
    }

    #[pyo3(signature = (path, *, bits, linear, exposure, rgb, float, error, sidecar))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        bits: Option<u8>,
        linear: bool,
        exposure: Option<f64>,
        rgb: bool,
        float: bool,
        error: bool,
        sidecar: bool,
    ) -> PyResult<()> {
        let options = SaveOptions {
            bits,
            linear,
            exposure,
            rgb,
            float,
            error,
            sidecar,
        };
        self.with(py, |given| self.rendered.save(&path, &options, given))
    }

    fn to_srgb<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let codes = self.with(py, |given| self.rendered.to_srgb(given))?;
        let (width, height) = self.rendered.size();
        let channels = codes.len() / (width as usize * height as usize);
        let shape = (height as usize, width as usize, channels);
        let codes = numpy::ndarray::Array3::from_shape_vec(shape, codes);
        let codes = codes.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(codes.into_pyarray(py))
    }

    fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(py, |given| self.rendered.png(given))?;
        Ok(PyBytes::new(py, &bytes))
    }
}
