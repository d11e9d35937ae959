//! The modules of a crate, and the files that they import.

use std::collections::{BTreeMap, BTreeSet};

use super::items::{self, Use};

/// The modules of a crate.
#[derive(Debug)]
pub(crate) struct Tree {
    /// The files with code that is not only for tests.
    pub(crate) files: Vec<String>,
    modules: Vec<Module>,
}

/// A module, which is a file or a part of one.
#[derive(Debug)]
struct Module {
    parent: Option<usize>,
    file: usize,
    children: BTreeMap<String, usize>,
    items: items::Module,
}

/// An import from one file to another.
#[derive(Clone, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub(crate) struct Import {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) line: usize,
    /// The path as written in the code.
    pub(crate) path: String,
}

/// The target of a path. Both fields are empty if it is not in this crate.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    module: Option<usize>,
    file: Option<usize>,
    /// Whether the name is known here; it may come from another crate.
    is_known: bool,
}

/// The longest chain of re-exports that is followed; only cycles are longer.
const MOST_STEPS: usize = 16;

impl Tree {
    /// The crate with the files `sources`, starting with its `lib.rs`.
    pub(crate) fn new(sources: &BTreeMap<String, String>) -> Result<Self, String> {
        let mut tree = Self {
            files: Vec::new(),
            modules: Vec::new(),
        };
        tree.add_file(sources, "lib.rs", "", None)?;
        Ok(tree)
    }

    /// Adds a file whose modules have their files in `folder`; returns its module.
    fn add_file(
        &mut self,
        sources: &BTreeMap<String, String>,
        name: &str,
        folder: &str,
        parent: Option<usize>,
    ) -> Result<usize, String> {
        let source = sources
            .get(name)
            .ok_or_else(|| format!("expected the file {name}"))?;
        let file = self.files.len();
        self.files.push(name.to_owned());
        let first = self.modules.len();
        let modules = items::modules(source);
        let count = modules.len();
        for (index, items) in modules.into_iter().enumerate() {
            let own = first + index;
            let parent = match items.path.split_last() {
                None => parent,
                Some((name, outer)) => {
                    let mut all = self.modules[first..].iter();
                    let outer = all.position(|module| module.items.path == outer);
                    let outer = first + outer.ok_or("no outer module")?;
                    self.modules[outer].children.insert(name.clone(), own);
                    Some(outer)
                }
            };
            self.modules.push(Module {
                parent,
                file,
                children: BTreeMap::new(),
                items,
            });
        }
        for own in first..first + count {
            let items = self.modules[own].items.clone();
            let mut below = folder.to_owned();
            for part in &items.path {
                below += &format!("{part}/");
            }
            for child in items.children {
                if child == "tests" {
                    continue;
                }
                let flat = format!("{below}{child}.rs");
                let nested = format!("{below}{child}/mod.rs");
                let name = if sources.contains_key(&flat) {
                    flat
                } else {
                    nested
                };
                let folder = format!("{below}{child}/");
                let module = self.add_file(sources, &name, &folder, Some(own))?;
                self.modules[own].children.insert(child, module);
            }
        }
        Ok(first)
    }

    /// The imports from one file to another.
    pub(crate) fn imports(&self) -> BTreeSet<Import> {
        let mut imports = BTreeSet::new();
        for (index, module) in self.modules.iter().enumerate() {
            let mut add = |to: usize, line: usize, path: &[String], end: &str| {
                let path = path.join("::") + end;
                let from = module.file;
                if to != from {
                    imports.insert(Import {
                        from,
                        to,
                        line,
                        path,
                    });
                }
            };
            for import in &module.items.uses {
                let found = self.resolve(index, &import.path, 0);
                if self.is_re_export(index, import, found) {
                    continue;
                }
                if import.alias == "*" {
                    for file in found.module.map_or(vec![], |module| self.all_of(module)) {
                        add(file, import.line, &import.path, "::*");
                    }
                } else if let Some(file) = found.file {
                    add(file, import.line, &import.path, "");
                }
            }
            for (path, line) in &module.items.paths {
                if let Some(file) = self.resolve(index, path, 0).file {
                    add(file, *line, path, "");
                }
            }
        }
        imports
    }

    /// Whether the module only re-exports a name of one of its own modules.
    fn is_re_export(&self, module: usize, import: &Use, found: Found) -> bool {
        let items = &self.modules[module].items;
        let leads_to = found
            .file
            .or(found.module.map(|module| self.modules[module].file));
        let is_below = leads_to.is_some_and(|file| {
            let mut below = self.modules.iter().enumerate();
            below.any(|(other, inner)| inner.file == file && self.is_inside(other, module))
        });
        import.is_public && is_below && !items.words.contains(&import.alias)
    }

    fn is_inside(&self, module: usize, outer: usize) -> bool {
        let mut parents = std::iter::successors(Some(module), |&at| self.modules[at].parent);
        parents.any(|parent| parent == outer)
    }

    /// The files of the names that `use module::*` imports.
    fn all_of(&self, module: usize) -> Vec<usize> {
        let Module { file, items, .. } = &self.modules[module];
        let own = (!items.definitions.is_empty()).then_some(*file);
        let public = items.uses.iter().filter(|import| import.is_public);
        let handed_on = public.filter_map(|import| self.resolve(module, &import.path, 0).file);
        own.into_iter().chain(handed_on).collect()
    }

    /// The target of a path that is written in this module.
    fn resolve(&self, module: usize, path: &[String], steps: usize) -> Found {
        let mut current = module;
        let mut is_own = false;
        for (index, name) in path.iter().enumerate() {
            match name.as_str() {
                "crate" => current = 0,
                "self" => {}
                "super" => current = self.modules[current].parent.unwrap_or(0),
                name => {
                    let is_last = index + 1 == path.len();
                    let found = self.look_up(current, name, is_last, steps);
                    match found {
                        _ if is_last && found.is_known => return found,
                        Found {
                            module: Some(next), ..
                        } => current = next,
                        Found { file: Some(_), .. } => return found,
                        _ if found.is_known || !is_own => return Found::default(),
                        // A macro may have made it.
                        _ => {
                            return Found {
                                file: Some(self.modules[current].file),
                                ..found
                            };
                        }
                    }
                }
            }
            is_own = true;
        }
        Found {
            module: Some(current),
            file: None,
            is_known: true,
        }
    }

    /// The meaning of the name in this module.
    fn look_up(&self, module: usize, name: &str, is_last: bool, steps: usize) -> Found {
        let Module {
            children,
            items,
            file,
            ..
        } = &self.modules[module];
        let child = children.get(name).copied();
        let mut found = Found {
            module: child,
            file: items.definitions.contains(name).then_some(*file),
            is_known: child.is_some() || items.definitions.contains(name),
        };
        if steps == MOST_STEPS || child.is_some() && !is_last {
            return found;
        }
        for import in items.uses.iter().filter(|import| import.alias == name) {
            let other = self.resolve(module, &import.path, steps + 1);
            found.module = found.module.or(other.module);
            found.file = found.file.or(other.file);
            found.is_known = true;
        }
        for import in items.uses.iter().filter(|import| import.alias == "*") {
            if found.is_known {
                break;
            }
            if let Some(other) = self.resolve(module, &import.path, steps + 1).module {
                found = self.look_up(other, name, is_last, steps + 1);
            }
        }
        found
    }
}
