//! Descriptions of the columns of a table.

use marbles_scene::{
    CloudDescription, ColorMeaning, ColumnContents, ColumnSummary, harmless, written_time,
};

use crate::base::numbers::{range, short};

/// A column: its kind, its range, and its use.
pub(super) fn told(column: &ColumnSummary, cloud: &CloudDescription) -> String {
    let contents = match &column.contents {
        ColumnContents::Numbers {
            low,
            high,
            missing,
            are_times,
        } => {
            let missing = match missing {
                0 => String::new(),
                missing => format!(", {missing} missing"),
            };
            match low <= high {
                true if *are_times => {
                    let (low, high) = (written_time(*low), written_time(*high));
                    format!("{low} to {high}{missing}")
                }
                true => format!("{}{missing}", range([*low, *high].into_iter())),
                false => format!("no numbers{missing}"),
            }
        }
        ColumnContents::Texts { count, examples } => {
            let examples: Vec<String> = examples.iter().map(|text| format!("{text:?}")).collect();
            let more = if *count > examples.len() { ", …" } else { "" };
            format!("{count} texts: {}{more}", examples.join(", "))
        }
        ColumnContents::Other => "neither numbers nor text".to_owned(),
    };
    let colors = cloud.colors.as_ref();
    let is_color = colors.is_some_and(|colors| colors.column.as_ref() == Some(&column.name));
    let name = harmless(&column.name);
    let mut text = format!("{name}: {contents}");
    if is_color && let Some(colors) = colors {
        match &colors.meaning {
            ColorMeaning::Scale {
                low,
                high,
                are_times,
                ..
            } => {
                let number = |number: &f64| match are_times {
                    true => written_time(*number),
                    false => short(*number),
                };
                text.push_str(&format!(
                    "; colors from {} to {}",
                    number(low),
                    number(high)
                ));
            }
            ColorMeaning::Categories(categories) => {
                let count = |count: usize, one: &str, several: &str| match count {
                    1 => format!("1 {one}"),
                    count => format!("{count} {several}"),
                };
                let mut colors: Vec<[u64; 3]> = categories
                    .iter()
                    .map(|(_, color)| color.to_array().map(f64::to_bits))
                    .collect();
                colors.sort_unstable();
                colors.dedup();
                let different = count(colors.len(), "color", "colors");
                text.push_str(&match colors.len() == categories.len() {
                    true => format!("; {different}"),
                    false => {
                        let all = count(categories.len(), "category", "categories");
                        format!("; {all}, {different}")
                    }
                });
            }
        }
    }
    text
}
