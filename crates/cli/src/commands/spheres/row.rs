//! The rows of the table of spheres.

use std::io::{self, Write};

use marbles_core::{Sphere, View, VisibleArea};

pub(super) const HEADER: &str = "frame,id,center_x,center_y,depth,ellipse_x,ellipse_y,semi_major,\
    semi_minor,angle_degrees,left,top,right,bottom,area,visible_area,visible_area_error,\
    visible_fraction\n";

/// The coordinates of the center of the first pixel, if those of its corner are 0.
const MIDDLE: f64 = 0.5;

/// Writes the row of the sphere with the number `id` in a view. Numbers have as many digits as are needed to read the
/// same doubles.
pub(super) fn write_row(
    to: &mut impl Write,
    view: &View,
    (id, sphere): (usize, &Sphere),
    visible: &VisibleArea,
) -> io::Result<()> {
    let contour = view.contour(sphere);
    write!(to, "{},{id}", view.frame)?;
    let center = contour.center.map(|center| (center - MIDDLE).to_array());
    write_numbers(to, center)?;
    write!(to, ",{}", contour.depth)?;
    let ellipse = contour.ellipse.as_ref();
    write_numbers(
        to,
        ellipse.map(|ellipse| (ellipse.center - MIDDLE).to_array()),
    )?;
    write_numbers(to, ellipse.map(|ellipse| ellipse.semi_axes))?;
    write_numbers(to, ellipse.map(|ellipse| [ellipse.angle_degrees()]))?;
    for corner in [0, 1] {
        let bounds = ellipse.map(|ellipse| (ellipse.bounds()[corner] - MIDDLE).to_array());
        write_numbers(to, bounds)?;
    }
    let area = ellipse.map(|ellipse| view.area_of(ellipse));
    write_numbers(to, area.map(|area| [area]))?;
    write!(to, ",{},{}", visible.area, visible.error)?;
    // The visible area may be larger by its error.
    let fraction = area
        .filter(|area| *area > 0.0)
        .map(|area| [(visible.area / area).min(1.0)]);
    write_numbers(to, fraction)?;
    writeln!(to)
}

/// Writes some numbers, or empty fields if there are none.
fn write_numbers<const COUNT: usize>(
    to: &mut impl Write,
    numbers: Option<[f64; COUNT]>,
) -> io::Result<()> {
    match numbers {
        Some(numbers) => numbers
            .iter()
            .try_for_each(|number| write!(to, ",{number}")),
        None => to.write_all(&[b','; COUNT]),
    }
}
