//! Scene files in other units of light and of length.

/// The words before light values, and before lengths.
const LIGHT: [&str; 6] = [
    "intensity: ",
    "ambient: ",
    "background: ",
    "color: ",
    "above: ",
    "below: ",
];
const LENGTHS: [&str; 11] = [
    "center: ",
    "radius: ",
    "position: ",
    "target: ",
    "reference: ",
    "distance: ",
    "shift: ",
    "Retina(width: ",
    "Parallel(width: ",
    "Units(",
    "Surface(",
];

/// A scene file with its light and its lengths multiplied by these factors.
///
/// A power of two keeps all digits.
pub(super) fn scaled(text: &str, light: f64, length: f64) -> String {
    let text = times(text, &LIGHT, light);
    times(&text, &LENGTHS, length)
}

/// The text with all numbers multiplied that directly follow one of the words, alone or in parentheses.
fn times(text: &str, words: &[&str], factor: f64) -> String {
    if factor == 1.0 {
        return text.to_owned();
    }
    let next = |rest: &str| {
        let ends = words
            .iter()
            .filter_map(|word| Some(rest.find(word)? + word.len()));
        ends.min()
    };
    let (mut result, mut rest) = (String::new(), text);
    while let Some(start) = next(rest) {
        let (before, after) = rest.split_at(start);
        let is_list = after.starts_with('(');
        let ends: &[char] = if is_list { &[')'] } else { &[',', ')', '\n'] };
        let (value, after) = after.split_at(after.find(ends).unwrap_or(after.len()));
        result += before;
        result += &multiplied(value, factor);
        rest = after;
    }
    result + rest
}

/// A number, or a list of numbers without its last parenthesis, multiplied by a factor.
fn multiplied(value: &str, factor: f64) -> String {
    let (open, list) = match value.strip_prefix('(') {
        Some(list) => ("(", list),
        None => ("", value),
    };
    let parts = list
        .split(',')
        .map(|part| match part.trim().parse::<f64>() {
            // The shortest text that is read as the same double.
            Ok(number) => format!("{:e}", number * factor),
            Err(_) => part.to_owned(),
        });
    open.to_owned() + &parts.collect::<Vec<_>>().join(", ")
}
