//! The direction in which the camera of a figure looks, as a user writes it.

use std::str::FromStr;

use crate::text::quoted;

/// The direction from which a camera looks at the middle of what it shows, in degrees.
///
/// # Example
/// ```
/// use marbles_scene::ViewAngle;
///
/// assert_eq!("top".parse(), Ok(ViewAngle { azimuth: 0.0, elevation: 90.0 }));
/// assert_eq!("-30,15".parse(), Ok(ViewAngle { azimuth: -30.0, elevation: 15.0 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewAngle {
    /// The turn of the view about the vertical axis: 0 looks along z, 90 along x.
    pub azimuth: f64,
    /// The height of the camera over the horizon, from -90 to 90.
    pub elevation: f64,
}

/// The reason for which a text is no [`ViewAngle`].
///
/// # Example
/// ```
/// use marbles_scene::ViewAngle;
///
/// let error = "above".parse::<ViewAngle>().unwrap_err();
/// assert_eq!(error.found, "above");
/// ```
#[derive(Clone, Debug, Eq, PartialEq, thiserror::Error)]
#[error(
    "expected front, back, left, right, top, bottom or AZIMUTH,ELEVATION in degrees (elevation from -90 to 90), such \
     as 30,15, found {}",
    quoted(.found)
)]
#[non_exhaustive]
pub struct ViewAngleError {
    /// The text.
    pub found: String,
}

/// The views that have names.
const NAMED: [(&str, f64, f64); 6] = [
    ("front", 0.0, 0.0),
    ("back", 180.0, 0.0),
    ("left", 90.0, 0.0),
    ("right", -90.0, 0.0),
    ("top", 0.0, 90.0),
    ("bottom", 0.0, -90.0),
];

impl FromStr for ViewAngle {
    type Err = ViewAngleError;

    /// Reads the name of a view, or an azimuth and an elevation in degrees.
    fn from_str(text: &str) -> Result<Self, ViewAngleError> {
        let named = NAMED.iter().find(|named| named.0 == text);
        if let Some(&(_, azimuth, elevation)) = named {
            return Ok(Self { azimuth, elevation });
        }
        let number = |text: &str| text.trim().parse::<f64>().ok();
        let angles = text
            .split_once(',')
            .and_then(|(azimuth, elevation)| Some((number(azimuth)?, number(elevation)?)));
        match angles {
            Some((azimuth, elevation)) if azimuth.abs() <= 360.0 && elevation.abs() <= 90.0 => {
                Ok(Self { azimuth, elevation })
            }
            _ => Err(ViewAngleError {
                found: text.to_owned(),
            }),
        }
    }
}
