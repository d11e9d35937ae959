//! The lens of a scene file.

use glam::DVec2;
use marbles_core::{Intrinsics, Lens};

use crate::file;
use crate::text::{Placed, refuse};
use crate::values::FocalLength;

/// The lens of a picture of this size; `None` where a fault was reported.
pub(crate) fn lens(lens: &Placed<file::Lens>, image: &Placed<file::Image>) -> Option<Lens> {
    match lens.value.as_ref()? {
        file::Lens::Retina {
            width,
            distance,
            shift,
        } => Some(Lens {
            width: width.get()?.0,
            distance: distance.get()?.0,
            shift: shift.get()?.0,
            pixel_aspect: 1.0,
        }),
        file::Lens::Fov(degrees) => {
            let width = 2.0 * libm::tan(0.5 * degrees.get()?.0.to_radians());
            Some(Lens {
                // The smallest angles vanish in radians.
                width: width.max(f64::MIN_POSITIVE),
                distance: 1.0,
                shift: DVec2::ZERO,
                pixel_aspect: 1.0,
            })
        }
        file::Lens::Matrix { fx, fy, cx, cy } => {
            let focal_lengths = focal_lengths(fx, fy)?;
            let principal_point = DVec2::new(cx.get()?.0, cy.get()?.0);
            let image = image.value.as_ref()?;
            let intrinsics = Intrinsics {
                focal_lengths,
                principal_point,
            };
            Some(intrinsics.lens(image.width.get()?.0, image.height.get()?.0))
        }
        file::Lens::Parallel { width, shift } => {
            Some(Lens::parallel(width.get()?.0, shift.get()?.0))
        }
    }
}

/// The focal lengths in widths and in heights of a pixel.
fn focal_lengths(fx: &Placed<FocalLength>, fy: &Placed<FocalLength>) -> Option<DVec2> {
    /// The longer side of a pixel over the shorter one, at most.
    const MOST: f64 = 1000.0;
    let (x, y) = (fx.get()?.0, fy.get()?.0);
    if x > MOST * y || y > MOST * x {
        let (least, most) = (x / MOST, x * MOST);
        let message =
            format!("expected a focal length from {least} to {most}, as fx is {x}, found {y}");
        return refuse(fy.place.clone(), message);
    }
    Some(DVec2::new(x, y))
}

/// The lens as the file writes it.
pub(crate) fn lens_as_written(lens: &Placed<file::Lens>) -> Option<String> {
    Some(match lens.value.as_ref()? {
        file::Lens::Retina {
            width,
            distance,
            shift,
        } => {
            let (width, distance, shift) = (width.get()?.0, distance.get()?.0, shift.get()?.0);
            if shift == DVec2::ZERO {
                format!("Retina(width: {width}, distance: {distance})")
            } else {
                let DVec2 { x, y } = shift;
                format!("Retina(width: {width}, distance: {distance}, shift: ({x}, {y}))")
            }
        }
        file::Lens::Fov(degrees) => format!("Fov({})", degrees.get()?.0),
        file::Lens::Matrix { fx, fy, cx, cy } => {
            let [fx, fy] = [fx.get()?.0, fy.get()?.0];
            let [cx, cy] = [cx.get()?.0, cy.get()?.0];
            format!("Matrix(fx: {fx}, fy: {fy}, cx: {cx}, cy: {cy})")
        }
        file::Lens::Parallel { width, shift } => {
            let (width, DVec2 { x, y }) = (width.get()?.0, shift.get()?.0);
            if (x, y) == (0.0, 0.0) {
                format!("Parallel(width: {width})")
            } else {
                format!("Parallel(width: {width}, shift: ({x}, {y}))")
            }
        }
    })
}
