//! The camera in the text of a scene file.

use super::{OrbitCamera, OrbitCenter};
use crate::text::{append_after, is_json, set, value_at};

/// Edits are those of texts in RON.
fn refuse_json(text: &str) -> Result<(), String> {
    if is_json(text) {
        return Err("expected a scene in RON, found one in JSON".to_owned());
    }
    Ok(())
}

/// The field of the camera, and that of the zoom.
const CAMERA: &str = "camera";
const ZOOM: &str = "zoom";

impl OrbitCamera {
    /// The text of a scene file with this camera in the place of its own; nothing else changes.
    ///
    /// A `Frame` or `Orbit` camera of the text keeps its other fields, and gets the angles that differ. Any other camera
    /// becomes an `Orbit`. A zoom that the text does not have is written behind the camera.
    ///
    /// # Errors
    /// Returns what was expected if the text has no camera, or is in JSON.
    pub fn put_into(&self, text: &str) -> Result<String, String> {
        refuse_json(text)?;
        let camera = value_at(text, CAMERA)
            .ok_or_else(|| "expected a field `camera`, found none".to_owned())?;
        let kind = camera.split(|letter: char| !letter.is_ascii_alphanumeric());
        let is_kept = kind.take(1).eq([self.kind()]);
        let mut text = text.to_owned();
        if is_kept {
            for (name, number) in self.angles() {
                let path = format!("{CAMERA}.{name}");
                if number_at(&text, &path, 0.0) != Some(number) {
                    text = set(&text, &path, &written(number))?;
                }
            }
        } else {
            text = set(&text, CAMERA, &self.value())?;
        }
        self.put_zoom_into(&text)
    }

    /// The text of a scene file with the zoom of this camera, and its own camera.
    ///
    /// # Errors
    /// As [`Self::put_into`].
    pub fn put_zoom_into(&self, text: &str) -> Result<String, String> {
        refuse_json(text)?;
        if number_at(text, ZOOM, 1.0) == Some(self.zoom) {
            return Ok(text.to_owned());
        }
        let zoom = written(self.zoom);
        match value_at(text, ZOOM) {
            Some(_) => set(text, ZOOM, &zoom),
            None => append_after(text, CAMERA, &format!(", {ZOOM}: {zoom}")),
        }
    }

    /// The fields of a scene file that describe this camera, in a line.
    pub fn line(&self) -> String {
        let zoom = match self.zoom {
            1.0 => String::new(),
            zoom => format!(" {ZOOM}: {},", written(zoom)),
        };
        format!("{CAMERA}: {},{zoom}", self.value())
    }

    /// The fields of the text of a scene file that describe its camera, in a line.
    pub fn line_of(text: &str) -> String {
        let field = |name: &str| Some(format!("{name}: {},", value_at(text, name)?));
        let fields: Vec<String> = [CAMERA, ZOOM].into_iter().filter_map(field).collect();
        fields.join(" ")
    }

    /// The value of the field `camera`, without a roll of 0.
    pub fn value(&self) -> String {
        let mut fields = Vec::new();
        if let OrbitCenter::At { target, radius } = self.center {
            let target = target.to_array().map(written).join(", ");
            fields.push(format!("target: ({target})"));
            fields.push(format!("radius: {}", written(radius)));
        }
        let angles = self.angles().into_iter();
        let angles = angles.filter(|&(name, number)| name != "roll" || number != 0.0);
        fields.extend(angles.map(|(name, number)| format!("{name}: {}", written(number))));
        format!("{}({})", self.kind(), fields.join(", "))
    }

    fn kind(&self) -> &'static str {
        match self.center {
            OrbitCenter::Framed => "Frame",
            OrbitCenter::At { .. } => "Orbit",
        }
    }

    fn angles(&self) -> [(&'static str, f64); 3] {
        [
            ("azimuth", self.azimuth),
            ("elevation", self.elevation),
            ("roll", self.roll),
        ]
    }
}

/// The number at a path; the default if there is none. `None` for something else than a number.
fn number_at(text: &str, path: &str, default: f64) -> Option<f64> {
    value_at(text, path).map_or(Some(default), |value| value.parse().ok())
}

/// The shortest number that is read as this one, without a minus before 0.
fn written(number: f64) -> String {
    let number = number + 0.0;
    match number.abs() {
        1e-6..1e15 => number.to_string(),
        0.0 => "0".to_owned(),
        _ => format!("{number:e}"),
    }
}
