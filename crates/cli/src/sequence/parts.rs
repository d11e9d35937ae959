//! The pictures of a frame: one of all light, or one for each part of the light.

use std::collections::HashSet;
use std::ffi::OsString;
use std::path::PathBuf;

use marbles_core::{LightPart, World};

/// A picture of a frame.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct PicturePart {
    /// The part of the light that it shows; `None` for all of it.
    pub(crate) light: Option<LightPart>,
    name: Name,
    /// Whether the picture contains the center values.
    has_centers: bool,
}

/// The name of a picture's file.
#[derive(Clone, Debug, Eq, PartialEq)]
enum Name {
    /// The name for the frame, with this text before the extension.
    Inserted(String),
    /// This name, in the same folder.
    Whole(String),
}

impl PicturePart {
    /// The picture of all light.
    pub(crate) fn whole() -> Self {
        Self {
            light: None,
            name: Name::Inserted(String::new()),
            has_centers: true,
        }
    }

    /// One picture for each part of a world's light. `.light-KEY` is added before the extension, where KEY is the name
    /// of the light or else its [`light_number`], `.sky` for the sky and `.ambient` for the rest.
    pub(crate) fn each(world: &World, names: &[Option<String>]) -> Result<Vec<Self>, String> {
        let mut keys = HashSet::new();
        let count = world.lights.len();
        let part = |light| {
            let inserted = match light {
                LightPart::Light(index) => {
                    let name = names.get(index).and_then(Option::as_deref);
                    let key = name.map_or_else(|| light_number(index, count), file_safe);
                    if !keys.insert(key.clone()) {
                        return Err(format!("two lights would share the file of `{key}`"));
                    }
                    format!(".light-{key}")
                }
                LightPart::Sky => ".sky".to_owned(),
                LightPart::Ambient => ".ambient".to_owned(),
            };
            Ok(Self {
                light: Some(light),
                name: Name::Inserted(inserted),
                has_centers: light == LightPart::Ambient,
            })
        };
        world.light_parts().map(part).collect()
    }

    /// The picture of one of the lights, in a file with this name.
    pub(crate) fn named(light: LightPart, name: String) -> Self {
        Self {
            light: Some(light),
            name: Name::Whole(name),
            has_centers: light == LightPart::Ambient,
        }
    }

    /// The same picture without center values.
    pub(crate) fn without_centers(self) -> Self {
        Self {
            has_centers: false,
            ..self
        }
    }

    /// The part of a world that the picture shows.
    pub(crate) fn of(&self, world: &World) -> World {
        match self.light {
            Some(light) => world.under(light),
            None => world.clone(),
        }
    }

    /// The names of the lights that the picture shows, among those of the world.
    pub(crate) fn names_of<'a>(&self, names: &'a [Option<String>]) -> &'a [Option<String>] {
        match self.light {
            Some(LightPart::Light(index)) => names.get(index..=index).unwrap_or_default(),
            Some(LightPart::Sky | LightPart::Ambient) => &[],
            None => names,
        }
    }

    /// Returns whether the picture contains the center values. They are the same for all lights, and without the picture
    /// of all light, that of ambient light has them.
    pub(crate) fn has_centers(&self) -> bool {
        self.has_centers
    }

    /// The file of the picture, derived from the one at `path`.
    pub(crate) fn path(&self, path: PathBuf) -> PathBuf {
        match &self.name {
            Name::Inserted(part) if part.is_empty() => path,
            Name::Inserted(part) => {
                let mut name = OsString::from(path.file_stem().unwrap_or_default());
                name.push(part);
                if let Some(ending) = path.extension() {
                    name.push(".");
                    name.push(ending);
                }
                path.with_file_name(name)
            }
            Name::Whole(name) => path.with_file_name(name),
        }
    }
}

/// The number of one of several lights, from 1, with as many digits as the last one has, so that names sort in the
/// order of the lights.
pub(super) fn light_number(index: usize, count: usize) -> String {
    let digits = count.to_string().len();
    format!("{:0digits$}", index + 1)
}

/// The name of a light, with a dash for every character that is problematic in file names.
fn file_safe(name: &str) -> String {
    let safe = |letter: char| match letter {
        '-' | '_' => letter,
        _ if letter.is_alphanumeric() => letter,
        _ => '-',
    };
    name.chars().map(safe).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use glam::DVec3;
    use marbles_core::{Light, Sky};

    use super::*;

    fn world() -> World {
        let mut world = World::new();
        for _ in 0..2 {
            let light = Light::directional(DVec3::Y, DVec3::ONE);
            world.lights.extend(light);
        }
        world
    }

    #[test]
    fn files_are_named_after_their_lights() {
        let parts = PicturePart::each(&world(), &[Some("key / warm".to_owned()), None]).unwrap();
        let paths = parts.iter().map(|part| part.path("a/b.0001.exr".into()));
        let paths: Vec<PathBuf> = paths.collect();
        let expected = [
            "a/b.0001.light-key---warm.exr",
            "a/b.0001.light-2.exr",
            "a/b.0001.ambient.exr",
        ];
        assert_eq!(paths, expected.map(PathBuf::from));
        assert_eq!(
            PicturePart::whole().path("a.png".into()),
            Path::new("a.png")
        );
        let mut world = world();
        world.sky = Some(Sky::uniform(DVec3::ONE));
        let parts = PicturePart::each(&world, &[Some("sky".to_owned()), None]).unwrap();
        let paths = parts.iter().map(|part| part.path("a.png".into()));
        let paths: Vec<PathBuf> = paths.collect();
        let expected = [
            "a.light-sky.png",
            "a.light-2.png",
            "a.sky.png",
            "a.ambient.png",
        ];
        assert_eq!(paths, expected.map(PathBuf::from));
        let named = PicturePart::named(LightPart::Light(0), "001.png".to_owned());
        assert_eq!(named.path("a/x.png".into()), Path::new("a/001.png"));
    }

    #[test]
    fn files_of_many_lights_sort_as_the_lights_do() {
        let mut world = world();
        for count in [9, 10, 123] {
            let light = world.lights[0];
            world.lights.resize(count, light);
            let parts = PicturePart::each(&world, &vec![None; count]).unwrap();
            let paths = parts[..count].iter().map(|part| part.path("a.png".into()));
            let paths: Vec<PathBuf> = paths.collect();
            assert!(paths.is_sorted(), "{paths:?}");
            let digits = count.to_string().len();
            assert_eq!(
                paths[6],
                PathBuf::from(format!("a.light-{:0digits$}.png", 7))
            );
        }
    }

    #[test]
    fn no_two_lights_share_a_file() {
        for names in [[Some("2"), None], [Some("a b"), Some("a-b")]] {
            let names = names.map(|name| name.map(str::to_owned));
            assert!(PicturePart::each(&world(), &names).is_err());
        }
    }
}
