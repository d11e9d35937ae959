//! The rules for imports.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::order::{Layers, level};
use super::tree::{Import, Tree};

/// The faults in the imports of a crate, as messages.
pub(crate) fn faults(tree: &Tree, layers: &Layers) -> Vec<String> {
    let imports = tree.imports();
    let mut faults = unlisted(tree, layers);
    faults.extend(upward(tree, &imports, layers));
    faults.extend(circles(tree, &imports));
    faults
}

/// The layer of a file; `None` for the crate itself.
fn layer(file: &str) -> Option<&str> {
    let first = file.split('/').next().unwrap_or(file);
    let name = first.strip_suffix(".rs").unwrap_or(first);
    (name != "lib").then_some(name)
}

/// Layers that are missing in the list, and names without a layer.
fn unlisted(tree: &Tree, layers: &Layers) -> Vec<String> {
    let files: BTreeSet<&str> = tree.files.iter().filter_map(|file| layer(file)).collect();
    let names: BTreeSet<&str> = layers.iter().flatten().map(String::as_str).collect();
    let missing = files.difference(&names);
    let missing = missing.map(|name| format!("`{name}` is not in the list of ARCHITECTURE.md"));
    let stale = names.difference(&files);
    let stale = stale.map(|name| format!("`{name}` of ARCHITECTURE.md does not exist"));
    missing.chain(stale).collect()
}

/// An import with its place.
fn show(tree: &Tree, import: &Import) -> String {
    let Import {
        from,
        to,
        line,
        path,
    } = import;
    format!(
        "{}:{line}: `{path}`, which is in {}",
        tree.files[*from], tree.files[*to]
    )
}

/// Imports of a layer that is not below; only the first from one file to another.
fn upward(tree: &Tree, imports: &BTreeSet<Import>, layers: &Layers) -> Vec<String> {
    let mut faults = Vec::new();
    let mut told = BTreeSet::new();
    for import in imports {
        let from = layer(&tree.files[import.from]);
        let to = layer(&tree.files[import.to]);
        let rule = match (from, to) {
            // The crate's own file stands above all.
            (None, _) => continue,
            (Some(_), None) => "nothing uses lib.rs".to_owned(),
            (Some(from), Some(to)) if from == to => continue,
            (Some(from), Some(to)) => match (level(layers, from), level(layers, to)) {
                (Some(high), Some(low)) if high <= low => {
                    format!("`{from}` may not use `{to}`, which is not below it")
                }
                _ => continue,
            },
        };
        if told.insert((import.from, import.to)) {
            faults.push(format!("{}: {rule}", show(tree, import)));
        }
    }
    faults
}

/// Cycles of files: the shortest one through each file that is in a cycle.
fn circles(tree: &Tree, imports: &BTreeSet<Import>) -> Vec<String> {
    let mut from: BTreeMap<usize, BTreeMap<usize, &Import>> = BTreeMap::new();
    for import in imports {
        let targets = from.entry(import.from).or_default();
        targets.entry(import.to).or_insert(import);
    }
    let mut told = BTreeSet::new();
    let mut faults = Vec::new();
    for &start in from.keys() {
        let Some(circle) = shortest_circle(&from, start) else {
            continue;
        };
        let files: BTreeSet<usize> = circle.iter().map(|import| import.from).collect();
        if told.insert(files) {
            let lines: Vec<String> = circle.iter().map(|import| show(tree, import)).collect();
            let count = circle.len();
            faults.push(format!(
                "{count} files import each other in a circle:\n  {}",
                lines.join("\n  ")
            ));
        }
    }
    faults
}

/// The imports that lead from `start` back to it.
fn shortest_circle<'i>(
    from: &BTreeMap<usize, BTreeMap<usize, &'i Import>>,
    start: usize,
) -> Option<Vec<&'i Import>> {
    let mut reached_by: BTreeMap<usize, &Import> = BTreeMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(file) = queue.pop_front() {
        for (&to, &import) in from.get(&file).into_iter().flatten() {
            if reached_by.contains_key(&to) {
                continue;
            }
            reached_by.insert(to, import);
            queue.push_back(to);
        }
    }
    let mut circle = vec![*reached_by.get(&start)?];
    while circle[0].from != start {
        circle.insert(0, reached_by[&circle[0].from]);
    }
    Some(circle)
}

#[cfg(test)]
mod tests;
