//! Values of the command line that take the place of a scene file's own.

use std::str::FromStr;

use crate::text::{quoted, set};

/// A value that takes the place of a scene file's own.
///
/// # Example
/// ```
/// use marbles_scene::{Scene, Setting};
///
/// # let folder = std::env::temp_dir().join(format!("marbles Setting {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let file = folder.join("ball.ron");
/// // `ball.ron` has a picture of 64 × 48 pixels.
/// # std::fs::write(&file, "(image: (width: 64, height: 48), lens: Fov(40), camera: Free(), spheres: [])")?;
/// let smaller: Setting = "image.width=32".parse()?;
/// let scene = Scene::load_with(&file, &[smaller], &|_| {})?;
/// let view = scene.view(1)?;
/// assert_eq!((view.width, view.height), (32, 48));
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Setting {
    /// The place of the value, for example `lights[0].toward`.
    pub(super) path: String,
    /// The value, as the file would have it.
    pub(super) value: String,
}

/// The reason for which a text is no [`Setting`].
///
/// # Example
/// ```
/// use marbles_scene::Setting;
///
/// let error = "image.width".parse::<Setting>().unwrap_err();
/// assert_eq!(error.found, "image.width");
/// ```
#[derive(Clone, Debug, Eq, PartialEq, thiserror::Error)]
#[error("expected PATH=VALUE, such as `lights[0].intensity=2`, found {}", quoted(.found))]
#[non_exhaustive]
pub struct SettingError {
    /// The text.
    pub found: String,
}

impl Setting {
    /// The value at `path`, both as they stand before and after the `=` of an option.
    pub fn new(path: &str, value: &str) -> Self {
        Self {
            path: path.to_owned(),
            value: value.to_owned(),
        }
    }
}

impl Setting {
    /// The text of a scene file with this value.
    ///
    /// # Errors
    /// Returns what was expected if the file does not have what the path names.
    pub fn put_into(&self, text: &str) -> Result<String, String> {
        set(text, &self.path, &self.value)
    }

    /// Returns whether this is a value of the camera, or the zoom.
    pub fn is_of_camera(&self) -> bool {
        let name = self.path.split(['.', '[']).next();
        matches!(name, Some("camera" | "zoom"))
    }
}

impl FromStr for Setting {
    type Err = SettingError;

    /// Reads `PATH=VALUE`.
    fn from_str(text: &str) -> Result<Self, SettingError> {
        let refused = || SettingError {
            found: text.to_owned(),
        };
        let (path, value) = text.split_once('=').ok_or_else(refused)?;
        let (path, value) = (path.trim(), value.trim());
        if path.is_empty() || value.is_empty() {
            return Err(refused());
        }
        Ok(Self::new(path, value))
    }
}
