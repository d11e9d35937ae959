//! Values put into the text of a scene in place of its own: `lights[0].toward` by its path.

use std::ops::Range;

use ron::value::RawValue;

use super::show::show;
use super::suggest::did_you_mean;
use super::token::{is_white_space, skip_trivia, token_end, value_end};

/// A step of a path.
#[derive(Clone, Debug, PartialEq)]
enum Part<'p> {
    Name(&'p str),
    Index(usize),
}

/// An item of a structure, a list or a map.
struct Item<'t> {
    /// The name before the colon, without its quotation marks.
    key: Option<&'t str>,
    /// The place of the name, or else of the value.
    start: usize,
    value: Range<usize>,
}

/// The text between brackets.
struct Inside<'t> {
    items: Vec<Item<'t>>,
    /// The place of the closing bracket, and whether a comma has to come before another item.
    end: usize,
    needs_comma: bool,
    bracket: u8,
}

/// The text with `value` at `path`. A field that is missing is added to its structure.
///
/// # Errors
/// Returns what was expected instead of the path, or of a part of it, or of the value: exactly one.
pub(crate) fn set(text: &str, path: &str, value: &str) -> Result<String, String> {
    let parts = parts(path)?;
    let value = one_value(value)?;
    let mut place = whole(text);
    for (index, part) in parts.iter().enumerate() {
        let is_last = index + 1 == parts.len();
        let inside = inside(text, place.clone());
        let inside = inside.ok_or_else(|| {
            let found = show(text[place.clone()].trim());
            format!("expected something with {}, found {found}", shown(part))
        })?;
        match find(&inside, part) {
            Some(item) => place = item,
            None if is_last && may_have(&inside, part) => {
                let Part::Name(name) = part else {
                    return Err(missing(&inside, part));
                };
                let comma = if inside.needs_comma { ", " } else { "" };
                let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
                let key = match inside.bracket {
                    b'{' => format!("{name:?}"),
                    _ if name.chars().all(is_plain) => (*name).to_owned(),
                    _ => return Err(missing(&inside, part)),
                };
                let (before, after) = text.split_at(inside.end);
                return Ok(format!("{before}{comma}{key}: {value}{after}"));
            }
            None => return Err(missing(&inside, part)),
        }
    }
    let (before, after) = (&text[..place.start], &text[place.end..]);
    Ok(format!("{before}{value}{after}"))
}

/// The value at `path`; `None` where there is none.
pub(crate) fn value_at<'t>(text: &'t str, path: &str) -> Option<&'t str> {
    Some(&text[place_of(text, path)?])
}

/// The text with more text behind the value at `path`, before the comma that may follow.
///
/// # Errors
/// Returns what was expected if there is no such value.
pub(crate) fn append_after(text: &str, path: &str, more: &str) -> Result<String, String> {
    let place = place_of(text, path);
    let place = place.ok_or_else(|| format!("expected `{path}`, found none"))?;
    let (before, after) = text.split_at(place.end);
    Ok(format!("{before}{more}{after}"))
}

/// The path of the innermost value around a place of a text in RON, or in JSON; empty for the whole.
pub(crate) fn path_at(text: &str, at: usize) -> String {
    let mut path = String::new();
    let mut place = whole(text);
    while let Some(inside) = inside(text, place.clone()) {
        let is_around = |item: &(usize, Item<'_>)| item.1.start <= at && at <= item.1.value.end;
        let count = inside.items.len();
        let Some((index, item)) = inside.items.into_iter().enumerate().find(is_around) else {
            break;
        };
        match item.key {
            // In JSON, a variant is an object with one key.
            Some(variant) if variant.starts_with(|letter: char| letter.is_ascii_uppercase()) => {}
            Some(name) => {
                let point = if path.is_empty() { "" } else { "." };
                path.push_str(point);
                let is_plain = |letter: char| letter.is_alphanumeric() || "_- ".contains(letter);
                match name.chars().all(is_plain) {
                    true => path.push_str(name),
                    false => path.push_str(&format!("\"{name}\"")),
                }
            }
            // The only value of a variant, as in `Fov(50)`, is the variant's.
            None if count == 1 && !text[place.start..].starts_with(['(', '[']) => {}
            None => path.push_str(&format!("[{index}]")),
        }
        place = item.value;
    }
    path
}

/// The place of the value at `path`.
fn place_of(text: &str, path: &str) -> Option<Range<usize>> {
    let parts = parts(path).ok()?;
    let from_all = Some(whole(text));
    parts
        .iter()
        .fold(from_all, |place, part| find(&inside(text, place?)?, part))
}

/// The place of the value that a text is.
fn whole(text: &str) -> Range<usize> {
    let start = skip_trivia(text, 0);
    start..value_end(text, start)
}

/// The value in a text without what surrounds it. What ends it early, or leaves it open, would change the text around.
fn one_value(text: &str) -> Result<String, String> {
    // A comment ends with its line.
    let line = format!("{text}\n");
    let value = RawValue::from_ron(&line).map(|value| value.trim().get_ron().to_owned());
    let value = value.ok().filter(|value| !value.is_empty());
    value.ok_or_else(|| format!("expected one value, found {}", show(text)))
}

/// The steps of a path: names with points between them, and numbers from 0 in brackets.
fn parts(path: &str) -> Result<Vec<Part<'_>>, String> {
    let wrong = || {
        format!(
            "expected a path such as `lights[0].toward`, found {}",
            show(path)
        )
    };
    let mut parts = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        if let Some(inside) = rest.strip_prefix('[') {
            let (index, after) = inside.split_once(']').ok_or_else(wrong)?;
            parts.push(Part::Index(index.trim().parse().map_err(|_| wrong())?));
            rest = after;
            continue;
        }
        if !parts.is_empty() {
            rest = rest.strip_prefix('.').ok_or_else(wrong)?;
        }
        let (name, after) = match rest.strip_prefix('"') {
            Some(inside) => inside.split_once('"').ok_or_else(wrong)?,
            None => rest.split_at(rest.find(['.', '[']).unwrap_or(rest.len())),
        };
        // Brackets, colons and the like would be more than a name.
        let is_name = |letter: char| letter.is_alphanumeric() || "_- ".contains(letter);
        if name.is_empty() || !(rest.starts_with('"') || name.chars().all(is_name)) {
            return Err(wrong());
        }
        parts.push(Part::Name(name));
        rest = after;
    }
    match parts.is_empty() {
        true => Err(wrong()),
        false => Ok(parts),
    }
}

/// The text in the brackets of the value at this place; `None` where it has none.
fn inside(text: &str, place: Range<usize>) -> Option<Inside<'_>> {
    let is_open = |at: usize| text[at..].starts_with(['(', '[', '{']);
    let mut open = place.start;
    if !is_open(open) {
        open = skip_trivia(text, token_end(text, open));
    }
    if open >= place.end || !is_open(open) {
        return None;
    }
    let mut items = Vec::new();
    let mut at = skip_trivia(text, open + 1);
    let mut needs_comma = false;
    while at < place.end && !text[at..].starts_with([')', ']', '}']) {
        let word_end = token_end(text, at);
        let colon = skip_trivia(text, word_end);
        let mut key = None;
        let mut start = at;
        if text[colon..].starts_with(':') {
            key = Some(text[at..word_end].trim_matches('"'));
            start = skip_trivia(text, colon + 1);
        }
        let end = value_end(text, start);
        if end <= at {
            return None;
        }
        items.push(Item {
            key,
            start: at,
            value: start..end,
        });
        at = skip_trivia(text, end);
        needs_comma = !text[at..].starts_with(',');
        if !needs_comma {
            at = skip_trivia(text, at + 1);
        }
    }
    // Behind the last item, not behind the line that ends it.
    let before = text[..at].trim_end_matches(is_white_space);
    let last = items.last().map_or(open + 1, |item| item.value.end);
    let has_comment = text[last..at].contains("//");
    Some(Inside {
        items,
        end: if has_comment { at } else { before.len() },
        needs_comma,
        bracket: text.as_bytes()[open],
    })
}

fn find(inside: &Inside<'_>, part: &Part<'_>) -> Option<Range<usize>> {
    let item = match part {
        Part::Name(name) => inside.items.iter().find(|item| item.key == Some(name)),
        Part::Index(index) => inside.items.get(*index).filter(|item| item.key.is_none()),
    };
    item.map(|item| item.value.clone())
}

/// Says whether a field of this name can be added.
fn may_have(inside: &Inside<'_>, part: &Part<'_>) -> bool {
    let has_names = inside.items.iter().all(|item| item.key.is_some());
    matches!(part, Part::Name(_)) && has_names && inside.bracket != b'['
}

/// The message that there is no such item.
fn missing(inside: &Inside<'_>, part: &Part<'_>) -> String {
    let keys: Vec<&str> = inside.items.iter().filter_map(|item| item.key).collect();
    let count = inside.items.len();
    match part {
        Part::Name(name) if !keys.is_empty() => {
            let meant = did_you_mean(name, keys.iter().copied(), |name| format!("`{name}`"));
            let list = match meant.is_empty() {
                true => format!(" among `{}`", keys.join("`, `")),
                false => meant,
            };
            format!("expected {}, found none{list}", shown(part))
        }
        Part::Index(_) if keys.is_empty() && count > 0 => {
            format!(
                "expected {}, found those from [0] to [{}]",
                shown(part),
                count - 1
            )
        }
        _ => format!("expected {}, found none", shown(part)),
    }
}

fn shown(part: &Part<'_>) -> String {
    match part {
        Part::Name(name) => format!("`{name}`"),
        Part::Index(index) => format!("[{index}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "// A scene.
(
    lens: Fov(50), // degrees
    camera: Orbit(target: (0, 0, 0), radius: 9),
    lights: [Directional(toward: (1, 1, -1)), Point(position: (0, 1, 2))],
    materials: {\"candy\": (albedo: \"#d02840\", exponent: 2), \"b.c\": ()},
)";

    #[test]
    fn values_take_the_place_of_others() {
        for (path, value, from, to) in [
            ("lens", "Fov(20)", "Fov(50)", "Fov(20)"),
            ("camera.radius", "3", "radius: 9", "radius: 3"),
            ("lights[0].toward", "(1, 0, 0)", "(1, 1, -1)", "(1, 0, 0)"),
            ("lights[1].position[2]", "7", "(0, 1, 2)", "(0, 1, 7)"),
            (
                "materials.candy.exponent",
                "1",
                "exponent: 2",
                "exponent: 1",
            ),
            (
                "materials.\"b.c\".exponent",
                "1",
                "\"b.c\": ()",
                "\"b.c\": (exponent: 1)",
            ),
            (
                "camera.azimuth",
                "30",
                "radius: 9)",
                "radius: 9, azimuth: 30)",
            ),
            (
                "materials.new",
                "()",
                "\"b.c\": ()",
                "\"b.c\": (), \"new\": ()",
            ),
            ("lights[0].intensity", "2", "-1))", "-1), intensity: 2)"),
        ] {
            assert_eq!(
                set(TEXT, path, value).unwrap(),
                TEXT.replacen(from, to, 1),
                "{path}"
            );
        }
        let added = set(TEXT, "ambient", "0.5").unwrap();
        assert_eq!(added, TEXT.replace("},\n)", "},ambient: 0.5\n)"));
        assert_eq!(
            set("(a: 1 // one\n)", "b", "2").unwrap(),
            "(a: 1 // one\n, b: 2)"
        );
    }

    #[test]
    fn places_have_the_paths_of_their_values() {
        for (found, path) in [
            ("50)", "lens"),
            ("radius: 9", "camera.radius"),
            ("9)", "camera.radius"),
            ("1, -1", "lights[0].toward[1]"),
            ("2))", "lights[1].position[2]"),
            ("2), \"b.c", "materials.candy.exponent"),
            ("// A", ""),
        ] {
            let at = TEXT.find(found).unwrap();
            assert_eq!(path_at(TEXT, at), path, "{found}");
        }
        let json = r#"{"lens": {"Fov": 50}, "lights": [{"Point": {"position": [0, 1, "x"]}}]}"#;
        let at = json.find("\"x\"").unwrap();
        assert_eq!(path_at(json, at), "lights[0].position[2]");
        assert_eq!(path_at(json, json.find("50").unwrap()), "lens");
        for text in [
            "",
            "(",
            "(a",
            "(a:",
            "(a: (",
            "[",
            "\"",
            "(a: 1",
            ")))",
            "(a: (1, 2",
        ] {
            for at in 0..=text.len() {
                path_at(text, at);
            }
        }
    }

    /// Whatever follows a value, or is missing of it, would become a part of the file around it.
    #[test]
    fn a_value_is_one() {
        for value in [
            "radius=1",
            "1),(center: (0, 0, 9), radius: 2",
            "1, roll: 20",
            "(1",
            "1)",
            "\"a",
            "1 /*",
            "",
            "// 1",
            "#![enable(implicit_some)] 1",
        ] {
            let expected = format!("expected one value, found {}", show(value));
            assert_eq!(set(TEXT, "camera.radius", value).unwrap_err(), expected);
        }
        for value in [" 3 // three", "/* three */ 3", "3"] {
            let found = set(TEXT, "camera.radius", value).unwrap();
            assert_eq!(found, TEXT.replacen("radius: 9", "radius: 3", 1));
        }
        for path in [
            "camera.roll: 20, azimuth",
            "materials.a\": (), \"b",
            "camera.\"roll: 2, x\"",
        ] {
            assert!(set(TEXT, path, "1").is_err(), "{path}");
        }
    }

    #[test]
    fn paths_that_lead_nowhere_are_refused() {
        for (path, expected) in [
            (
                "lights[2].toward",
                "expected [2], found those from [0] to [1]",
            ),
            (
                "light[0].toward",
                "expected `light`, found none, did you mean `lights`?",
            ),
            (
                "materials.gold.exponent",
                "expected `gold`, found none among `candy`, `b.c`",
            ),
            ("lens.x.y", "expected `x`, found none"),
            ("camera.radius.x", "expected something with `x`, found 9"),
            ("", "expected a path such as `lights[0].toward`, found ``"),
            (
                "a..b",
                "expected a path such as `lights[0].toward`, found `a..b`",
            ),
            (
                "a[x]",
                "expected a path such as `lights[0].toward`, found `a[x]`",
            ),
        ] {
            assert_eq!(set(TEXT, path, "1").unwrap_err(), expected, "{path}");
        }
    }
}
