//! The layers of the crates, as the document lists them.

use std::collections::BTreeMap;

/// The layers of a crate from the bottom; those of the same level do not use each other.
pub(crate) type Layers = Vec<Vec<String>>;

/// The layers in the blocks of the document, by the names of the crates.
pub(crate) fn layers(document: &str) -> Result<BTreeMap<String, Layers>, String> {
    let mut texts: Vec<(String, String)> = Vec::new();
    let mut is_inside = false;
    for line in document.lines().map(str::trim) {
        if line.starts_with("```") {
            is_inside = line == "```layers";
        } else if is_inside {
            match (line.split_once(':'), texts.last_mut()) {
                (Some((name, rest)), _) => texts.push((name.trim().into(), rest.into())),
                (None, Some((_, text))) => *text += line,
                (None, None) => return Err(format!("expected a crate, found `{line}`")),
            }
        }
    }
    let mut all = BTreeMap::new();
    for (name, text) in texts {
        let level = |level: &str| {
            level
                .split(',')
                .map(|name| name.trim().to_owned())
                .collect()
        };
        let levels: Layers = text.split('←').map(level).collect();
        if levels.iter().flatten().any(String::is_empty) {
            return Err(format!("expected names between the arrows of {name}"));
        }
        if all.insert(name.clone(), levels).is_some() {
            return Err(format!("expected {name} once"));
        }
    }
    Ok(all)
}

/// The level of a layer, from 0 at the bottom.
pub(crate) fn level(layers: &Layers, name: &str) -> Option<usize> {
    layers
        .iter()
        .position(|level| level.iter().any(|other| other == name))
}

#[test]
fn layers_are_listed_from_the_bottom() {
    let text = "a\n```layers\ncore: a ← b, c\n  ← d\ncli: e\n```\nx: y\n```layers\nscene: f\n```";
    let all = layers(text).unwrap();
    assert_eq!(all["core"], [vec!["a"], vec!["b", "c"], vec!["d"]]);
    assert_eq!(all["cli"], [["e"]]);
    assert_eq!(all["scene"], [["f"]]);
    assert_eq!(all.len(), 3);
    assert_eq!(level(&all["core"], "c"), Some(1));
    assert_eq!(level(&all["core"], "x"), None);
    assert!(layers("```layers\ncore: a ← ← b\n```").is_err());
    assert!(layers("```layers\ncore: a\ncore: b\n```").is_err());
}
