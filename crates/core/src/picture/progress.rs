//! The caller's say in a rendering.

use std::fmt;
use std::ops::ControlFlow;

/// Is told of pixels that are done, of none now and then; when it breaks the work ends.
pub(crate) type Progress<'caller> = dyn Fn(u64) -> ControlFlow<()> + Sync + 'caller;

/// The caller of a rendering asked it to stop.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Cancelled, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// use std::ops::ControlFlow;
///
/// let renderer = Renderer::new(&world);
/// let stop = |_| ControlFlow::Break(());
/// let ended = renderer.render_with_progress(&view, &Settings::default(), &stop);
/// assert_eq!(ended, Err(Cancelled));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("the rendering was stopped")
    }
}

impl std::error::Error for Cancelled {}
