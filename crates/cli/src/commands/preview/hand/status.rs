//! The line below the picture.

use marbles_scene::OrbitCamera;

/// The keys, from the longest text to the shortest one.
const KEYS: [&str; 5] = [
    "arrows turn  + - zoom  r R roll  Home back  w write  p print  q quit",
    "arrows turn  + - zoom  r roll  Home  w write  p print  q quit",
    "arrows + - r Home  w write  p print  q quit",
    "arrows + - r Home w p q",
    "q quits",
];

/// The camera and the keys, as much of it as fits into a line of so many columns.
pub(super) fn of_camera(camera: &OrbitCamera, columns: usize) -> String {
    let OrbitCamera {
        azimuth,
        elevation,
        roll,
        zoom,
        ..
    } = camera;
    let mut angles = format!(
        "azimuth {}, elevation {}",
        short(*azimuth),
        short(*elevation)
    );
    if *roll != 0.0 {
        angles += &format!(", roll {}", short(*roll));
    }
    if *zoom != 1.0 {
        angles += &format!(", zoom {zoom}");
    }
    let both = KEYS[..3].iter().map(|keys| format!("{angles} | {keys}"));
    let keys = KEYS.iter().map(|&keys| keys.to_owned());
    fitting(both.chain(keys), columns)
}

/// The reason for which the camera cannot be turned, as much of it as fits.
pub(super) fn of_still(reason: &str, columns: usize) -> String {
    let texts = [
        format!("it cannot be turned: {reason}; q quits"),
        format!("q quits; {reason}"),
    ];
    fitting(texts.into_iter(), columns)
}

/// The first text that fits; otherwise the last one, of which the screen shows the beginning.
fn fitting(mut texts: impl Iterator<Item = String>, columns: usize) -> String {
    let mut last = String::new();
    texts
        .find(|text| {
            last.clone_from(text);
            console::measure_text_width(text) <= columns
        })
        .unwrap_or(last)
}

/// The angle with four digits behind the point at most.
fn short(degrees: f64) -> f64 {
    const PARTS: f64 = 1e4;
    (degrees * PARTS).round() / PARTS + 0.0
}

#[cfg(test)]
mod tests;
