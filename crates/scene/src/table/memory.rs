//! Tables in memory, which a scene names as if they were files.

use std::collections::HashMap;
use std::fmt;
use std::io::{self, Cursor, Read};
use std::sync::Arc;

/// The bytes of a table in memory, shared with whoever made them.
pub type TableBytes = Arc<dyn AsRef<[u8]> + Send + Sync>;

/// Tables in memory: the contents of files of any format, uncompressed, by the names that clouds have for them.
///
/// A scene that [`Scene::parse_with_tables`](crate::Scene::parse_with_tables) checks reads these in place of the files
/// with the same names.
///
/// # Example
/// ```
/// use std::path::Path;
/// use std::sync::Arc;
///
/// use marbles_scene::{Scene, Tables};
///
/// let mut tables = Tables::default();
/// tables.insert("balls.csv", Arc::new("x,y,z,radius\n0,0,5,1\n2,0,5,0.5\n"));
/// let text = "(image: (width: 8, height: 8), lens: Fov(40), camera: Free(), clouds: [(file: \"balls.csv\")])";
/// let scene = Scene::parse_with_tables(text, Path::new("balls.ron"), &tables)?;
/// assert_eq!(scene.world().spheres().len(), 2);
/// # Ok::<(), marbles_scene::SceneError>(())
/// ```
#[derive(Clone, Default)]
pub struct Tables(HashMap<String, TableBytes>);

impl Tables {
    /// Adds a table, in place of another one of this name.
    pub fn insert(&mut self, name: &str, bytes: TableBytes) {
        self.0.insert(name.to_owned(), bytes);
    }

    /// The table of this name.
    pub(crate) fn get(&self, name: &str) -> Option<TableBytes> {
        self.0.get(name).cloned()
    }
}

impl fmt::Debug for Tables {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sizes = self.0.iter();
        let sizes = sizes.map(|(name, bytes)| (name, (**bytes).as_ref().len()));
        formatter.debug_map().entries(sizes).finish()
    }
}

/// The bytes of a table, one after another.
pub(super) struct Memory(Cursor<Bytes>);

struct Bytes(TableBytes);

impl AsRef<[u8]> for Bytes {
    fn as_ref(&self) -> &[u8] {
        (*self.0).as_ref()
    }
}

impl Memory {
    pub(super) fn new(bytes: TableBytes) -> Self {
        Self(Cursor::new(Bytes(bytes)))
    }

    pub(super) fn size(&self) -> u64 {
        self.0.get_ref().as_ref().len() as u64
    }

    pub(super) fn seek(&mut self, to: u64) {
        self.0.set_position(to);
    }
}

impl Read for Memory {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer)
    }
}
