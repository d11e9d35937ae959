//! A scene in words and numbers.

use std::ops::Range;
use std::path::PathBuf;

use glam::DVec3;

use crate::world::ScaleKind;

/// The spheres of a table.
///
/// # Example
/// ```
/// use marbles_scene::Scene;
///
/// # let folder = std::env::temp_dir().join(format!("marbles CloudDescription {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `balls.csv`: two rows with the columns x, y, z and radius
/// # std::fs::write(folder.join("balls.csv"), "x,y,z,radius\n0,0,0,1\n3,0,0,1\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Frame(),
///     clouds: [(file: "balls.csv")])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// # std::fs::remove_dir_all(&folder)?;
/// // …
/// let cloud = &scene.clouds()[0];
/// assert_eq!(cloud.file.to_str(), Some("balls.csv"));
/// assert_eq!(cloud.spheres, 0..2);
/// assert_eq!(cloud.steps, None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CloudDescription {
    /// The table as the scene file names it.
    pub file: PathBuf,
    /// The range of its spheres in the world of the first frame.
    pub spheres: Range<usize>,
    /// The number of rows of the table in the first frame, including those that were not kept.
    pub rows: u64,
    /// The number of rows that were kept. Each is a sphere, unless a crystal's symmetry or repeated cells make it several.
    pub kept: u64,
    /// The cell of the first frame, if the table has one.
    pub cell: Option<CellDescription>,
    /// True if the axes of the table are right-handed, because the scene file says so, or else because its format has
    /// such axes.
    pub is_right_handed: bool,
    /// The number of its steps, if it changes over time.
    pub steps: Option<usize>,
    /// The column that the colors show, if they show one.
    pub colors: Option<ColorDescription>,
}

/// The cell of a periodic table, in the axes and the unit of the table.
///
/// # Example
/// ```
/// use marbles_scene::Scene;
///
/// # let folder = std::env::temp_dir().join(format!("marbles CellDescription {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `polonium.xyz`: one atom in a cube
/// # std::fs::write(folder.join("polonium.xyz"), "1\nLattice=\"3.4 0 0 0 3.4 0 0 0 3.4\"\nPo 0 0 0\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Frame(),
///     clouds: [(file: "polonium.xyz", repeat: (3, 3, 2))])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// # std::fs::remove_dir_all(&folder)?;
/// // …
/// let cloud = &scene.clouds()[0];
/// let cell = cloud.cell.as_ref().expect("the table has a cell");
/// assert_eq!((cell.lengths, cell.angles), ([3.4; 3], [90.0; 3]));
/// assert_eq!((cell.repeat, cloud.spheres.len()), ([3, 3, 2], 18));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CellDescription {
    /// The edges a, b and c.
    pub edges: [DVec3; 3],
    /// The corner from which the edges go out.
    pub origin: DVec3,
    /// The lengths of the edges.
    pub lengths: [f64; 3],
    /// The angles between b and c, a and c, and a and b, in degrees.
    pub angles: [f64; 3],
    /// The number of cells that the scene shows along each edge.
    pub repeat: [u32; 3],
}

/// The meaning of the colors of a table's spheres.
///
/// # Example
/// ```
/// use marbles_scene::Scene;
///
/// # let folder = std::env::temp_dir().join(format!("marbles ColorDescription {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `balls.csv`: two rows with the columns x, y, z, radius and mass
/// # std::fs::write(folder.join("balls.csv"), "x,y,z,radius,mass\n0,0,0,1,2.5\n3,0,0,1,7.5\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Frame(),
///     clouds: [(file: "balls.csv", color: Value, value: "mass")])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// # std::fs::remove_dir_all(&folder)?;
/// // …
/// let colors = scene.clouds()[0].colors.as_ref().expect("the scene asks for colors");
/// assert_eq!(colors.column.as_deref(), Some("mass"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ColorDescription {
    /// The name of the column; `None` for the length of a vector.
    pub column: Option<String>,
    /// The unit that the table states after the column's name.
    pub unit: Option<String>,
    /// The meaning of each color.
    pub meaning: ColorMeaning,
}

/// The meaning of colors.
///
/// # Example
/// ```
/// use marbles_scene::{ColorMeaning, Scene};
///
/// # let folder = std::env::temp_dir().join(format!("marbles ColorMeaning {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// // `balls.csv`: two balls, with the masses 2.5 and 7.5
/// # std::fs::write(folder.join("balls.csv"), "x,y,z,radius,mass\n0,0,0,1,2.5\n3,0,0,1,7.5\n")?;
/// let text = r#"(image: (width: 32, height: 32), lens: Fov(40), camera: Frame(),
///     clouds: [(file: "balls.csv", color: Value, value: "mass")])"#;
/// # let scene = Scene::parse(text, &folder.join("scene.ron"))?;
/// # std::fs::remove_dir_all(&folder)?;
/// // …
/// let colors = scene.clouds()[0].colors.as_ref().expect("the scene asks for colors");
/// match &colors.meaning {
///     ColorMeaning::Scale { low, high, .. } => assert_eq!((*low, *high), (2.5, 7.5)),
///     ColorMeaning::Categories(_) => panic!("masses are numbers"),
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum ColorMeaning {
    /// Numbers on a scale.
    Scale {
        /// The number of the first color, which smaller numbers have, too.
        low: f64,
        /// The number of the last color, which larger numbers have, too.
        high: f64,
        /// The way in which colors follow numbers between them.
        kind: ScaleKind,
        /// The linear colors, from the low end to the high one.
        colors: Vec<DVec3>,
        /// True if the numbers are times, in seconds since the start of 1970.
        are_times: bool,
    },
    /// Categories, in their order, each with its linear color.
    Categories(Vec<(String, DVec3)>),
}

/// A scene in words and numbers, for people.
///
/// # Example
/// ```
/// use std::path::Path;
///
/// use marbles_scene::Scene;
///
/// let text = r#"(image: (width: 64, height: 48), lens: Fov(40), camera: Free(), spheres: [],
///     materials: {"gold": ()}, lights: [Directional(toward: (0, 1, 0), name: "sun")])"#;
/// let scene = Scene::parse(text, Path::new("empty.ron"))?;
/// let description = scene.description();
/// assert_eq!(description.materials, ["gold"]);
/// assert_eq!(description.lights, [Some(String::from("sun"))]);
/// assert_eq!((description.camera, description.animation), ("Free", None));
/// assert_eq!(description.lens, "Fov(40)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub struct Description {
    /// The names of the materials that the file defines, in the order of the world's.
    pub materials: Vec<String>,
    /// The names of the lights, if they have any, in the order of the world's.
    pub lights: Vec<Option<String>>,
    /// The kind of camera, for example `LookAt`.
    pub camera: &'static str,
    /// The kind of animation, `Keyframes` or `Turntable`; `None` for a still.
    pub animation: Option<&'static str>,
    /// The lens as the file writes it, for example `Fov(50)`.
    pub lens: String,
    /// The unit of lengths, for example `nm`, if the file names one.
    pub unit: Option<String>,
}
