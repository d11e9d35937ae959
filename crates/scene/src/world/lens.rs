//! The lens of a scene file.

use glam::DVec2;
use marbles_core::Lens;

use crate::file;
use crate::text::Placed;

/// The lens; `None` where a fault was reported.
pub(crate) fn lens(lens: &Placed<file::Lens>) -> Option<Lens> {
    match lens.value.as_ref()? {
        file::Lens::Retina {
            width,
            distance,
            shift,
        } => Some(Lens {
            width: width.get()?.0,
            distance: distance.get()?.0,
            shift: shift.get()?.0,
        }),
        file::Lens::Fov(degrees) => {
            let lens = Lens::from_field_of_view(degrees.get()?.0.to_radians());
            // The smallest angles vanish in radians.
            let width = lens.width.max(f64::MIN_POSITIVE);
            Some(Lens { width, ..lens })
        }
    }
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
    })
}
