//! A world that changes over time.

use std::path::PathBuf;
use std::sync::Arc;

use marbles_core::{Albedos, MaterialId, Sphere, World};

use super::cloud::{CloudError, OpenCloud, Step};
use crate::bounds::Bounds;

/// A world some of whose clouds have several steps.
#[derive(Debug)]
pub(crate) struct Series {
    /// Everything before the first cloud that changes.
    base: World,
    parts: Vec<Part>,
    /// The frame of the first step.
    first_frame: i32,
    /// The scene file, and its text, for messages.
    pub(crate) source: (PathBuf, String),
}

/// A cloud behind the base.
#[derive(Debug)]
pub(crate) enum Part {
    Still {
        spheres: Vec<Sphere>,
        albedos: Option<Albedos>,
        material: MaterialId,
    },
    Changing(Arc<OpenCloud>),
}

/// The steps of all clouds that change over time. Frames with the same steps show the same world.
///
/// # Example
/// ```
/// use marbles_scene::Scene;
///
/// # let folder = std::env::temp_dir().join(format!("marbles StepKey {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `run.1.csv` and `run.2.csv` are two steps of a table; each is shown for two frames.
/// # std::fs::write(folder.join("run.1.csv"), "x,y,z,radius\n0,0,5,1\n")?;
/// # std::fs::write(folder.join("run.2.csv"), "x,y,z,radius\n1,0,5,1\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Free(),
///     clouds: [(file: "run.####.csv", speed: 0.5)])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// // …
/// assert_eq!(scene.steps_at(1), scene.steps_at(2));
/// assert_ne!(scene.steps_at(2), scene.steps_at(3));
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Eq, Hash, PartialEq)]
pub struct StepKey(Vec<Option<usize>>);

/// The fault of the cloud at this place of the scene file.
pub(crate) type Refused = (std::ops::Range<usize>, CloudError);

impl Series {
    pub(crate) fn new(
        base: World,
        parts: Vec<Part>,
        first_frame: i32,
        source: (PathBuf, String),
    ) -> Self {
        Self {
            base,
            parts,
            first_frame,
            source,
        }
    }

    /// The clouds that change.
    pub(crate) fn changing(&self) -> impl Iterator<Item = &OpenCloud> {
        self.parts.iter().filter_map(|part| match part {
            Part::Still { .. } => None,
            Part::Changing(cloud) => Some(&**cloud),
        })
    }

    /// The steps of a frame.
    pub(crate) fn key(&self, frame: i32) -> StepKey {
        let frames = i64::from(frame) - i64::from(self.first_frame);
        StepKey(self.changing().map(|cloud| cloud.step_at(frames)).collect())
    }

    /// The world of these steps.
    pub(crate) fn world(&self, key: &StepKey) -> Result<World, Refused> {
        let mut world = self.base.clone();
        let mut steps = key.0.iter();
        for part in &self.parts {
            match part {
                Part::Still {
                    spheres,
                    albedos,
                    material,
                } => world.add_spheres(spheres.clone(), *material, albedos.clone()),
                Part::Changing(cloud) => {
                    let Some(Some(step)) = steps.next() else {
                        continue;
                    };
                    let step = cloud.read(*step, &|_| {});
                    let Step {
                        spheres, albedos, ..
                    } = step.map_err(|error| (cloud.cloud.place.clone(), error))?;
                    world.add_spheres(spheres, cloud.cloud.material, albedos);
                }
            }
        }
        Ok(world)
    }

    /// The box around the spheres of all steps.
    pub(crate) fn bounds(&self) -> Result<Bounds, Refused> {
        let mut bounds = Bounds::NONE;
        self.for_each(&mut |spheres| bounds = bounds.around(Bounds::of(spheres)))?;
        Ok(bounds)
    }

    /// Hands over the spheres of all steps, some at a time.
    pub(crate) fn for_each(&self, take: &mut dyn FnMut(&[Sphere])) -> Result<(), Refused> {
        take(self.base.spheres());
        for part in &self.parts {
            match part {
                Part::Still { spheres, .. } => take(spheres),
                Part::Changing(cloud) => {
                    for step in 0..cloud.steps().unwrap_or(0) {
                        let spheres = cloud.spheres(step);
                        take(&spheres.map_err(|error| (cloud.cloud.place.clone(), error))?);
                    }
                }
            }
        }
        Ok(())
    }
}
