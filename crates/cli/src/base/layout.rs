//! Texts with tables, wrapped at a number of columns.

/// The smallest width for descriptions next to their names. If there is less room, they are placed below the names.
const LEAST: usize = 30;
/// The indents of names, and of descriptions below them.
const NAME: &str = "  ";
const BELOW: &str = "      ";

/// A part of a text.
enum Part {
    Paragraph(String),
    /// A line of a table.
    Row(Row),
}

/// A name and its description, which is empty if the name needs none.
struct Row {
    name: String,
    description: String,
}

/// Wraps a text at `columns`.
///
/// Lines without indent form paragraphs, which end at an empty line or at a colon. Lines indented by two spaces are
/// rows of tables: two more spaces separate the name from the description. Lines with a larger indent continue the
/// description above.
pub(crate) fn lay_out(text: &str, columns: usize) -> String {
    let blocks = text.split("\n\n").map(|block| {
        let parts = parts(block);
        let names = parts.iter().filter_map(|part| match part {
            Part::Row(row) if !row.description.is_empty() => Some(row.name.chars().count()),
            _ => None,
        });
        let indent = NAME.len() + names.max().unwrap_or(0) + 2;
        let beside = (indent + LEAST <= columns).then_some(indent);
        let lines: Vec<String> = parts
            .iter()
            .map(|part| match part {
                Part::Paragraph(text) => wrap(text, "", "", columns),
                Part::Row(row) => laid_out(row, beside, columns),
            })
            .collect();
        lines.join("\n")
    });
    blocks.collect::<Vec<_>>().join("\n\n")
}

fn parts(block: &str) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for line in block.lines() {
        let text = line.trim();
        let indent = line.len() - line.trim_start().len();
        match parts.last_mut() {
            Some(Part::Row(row)) if indent > NAME.len() => {
                row.description = format!("{} {text}", row.description).trim().to_owned();
            }
            _ if indent > 0 => {
                let (name, description) = text.split_once("  ").unwrap_or((text, ""));
                parts.push(Part::Row(Row {
                    name: name.to_owned(),
                    description: description.trim().to_owned(),
                }));
            }
            Some(Part::Paragraph(paragraph)) if !paragraph.ends_with(':') => {
                *paragraph = format!("{paragraph} {text}");
            }
            _ => parts.push(Part::Paragraph(text.to_owned())),
        }
    }
    parts
}

/// A row. The description begins in the column `beside`, if there is room for it.
fn laid_out(Row { name, description }: &Row, beside: Option<usize>, columns: usize) -> String {
    match beside {
        _ if description.is_empty() => wrap(name, NAME, BELOW, columns),
        Some(column) => {
            let width = column - NAME.len();
            let first = format!("{NAME}{name:<width$}");
            wrap(description, &first, &" ".repeat(column), columns)
        }
        None => {
            let name = wrap(name, NAME, BELOW, columns);
            format!("{name}\n{}", wrap(description, BELOW, BELOW, columns))
        }
    }
}

/// Wraps the words of a text at `columns`; a longer word gets a line of its own. The first line begins with `first`,
/// the others with `indent`.
fn wrap(text: &str, first: &str, indent: &str, columns: usize) -> String {
    let mut wrapped = first.to_owned();
    let mut width = first.chars().count();
    let mut is_start = true;
    for word in text.split(' ') {
        let length = word.chars().count();
        if !is_start && width + 1 + length > columns {
            wrapped.push('\n');
            wrapped.push_str(indent);
            width = indent.len();
            is_start = true;
        }
        if !is_start {
            wrapped.push(' ');
            width += 1;
        }
        wrapped.push_str(word);
        width += length;
        is_start = false;
    }
    wrapped
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
Examples:
  marbles render ball.ron              ball.png
  marbles render ball.ron --samples 4  plain supersampling, 4 × 4 points
                                       a pixel
  marbles farm slurm ball.ron

A paragraph of two
lines.

Codes of the program, all that
there are:
  0  everything is well
  130  interrupted";

    #[test]
    fn descriptions_stand_beside_names_where_there_is_room() {
        let expected = "\
Examples:
  marbles render ball.ron              ball.png
  marbles render ball.ron --samples 4  plain supersampling, 4 × 4
                                       points a pixel
  marbles farm slurm ball.ron

A paragraph of two lines.

Codes of the program, all that there are:
  0    everything is well
  130  interrupted";
        assert_eq!(lay_out(TEXT, 69), expected);
    }

    #[test]
    fn else_they_stand_below() {
        let expected = "\
Examples:
  marbles render ball.ron
      ball.png
  marbles render ball.ron --samples
      4
      plain supersampling, 4 × 4
      points a pixel
  marbles farm slurm ball.ron

A paragraph of two lines.

Codes of the program, all that there
are:
  0
      everything is well
  130
      interrupted";
        assert_eq!(lay_out(TEXT, 36), expected);
    }

    #[test]
    fn words_longer_than_the_line_stay_whole() {
        assert_eq!(lay_out("a bbbbbbbbbb c", 5), "a\nbbbbbbbbbb\nc");
    }
}
