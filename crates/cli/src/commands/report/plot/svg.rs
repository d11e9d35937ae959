//! Drawings as SVG: plain shapes and text, without scripts, styles or links, which a page may show
//! as it is.

use std::fmt::Write;

use super::drawing::{Anchor, Color, Drawing, Place, Shape, Size, Text};

/// What a reader has: an SVG carries no font.
const FONTS: &str = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

/// The text of the file.
pub(super) fn text(drawing: &Drawing) -> String {
    let (width, height) = (number(drawing.width), number(drawing.height));
    let title = escaped(&drawing.title);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\" role=\"img\">\n\
         <title>{title}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for shape in &drawing.shapes {
        svg.push_str(&element(shape));
        svg.push('\n');
    }
    svg.push_str("</svg>\n");
    svg
}

fn element(shape: &Shape) -> String {
    match shape {
        Shape::Line {
            places,
            width,
            color,
            dashed,
        } => {
            let dashes = if *dashed {
                " stroke-dasharray=\"7 6\""
            } else {
                " stroke-linecap=\"round\""
            };
            format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" \
                 stroke-linejoin=\"round\"{dashes}/>",
                points(places),
                hexadecimal(*color),
                number(*width)
            )
        }
        Shape::Disk {
            center: (x, y),
            radius,
            color,
        } => format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"/>",
            number(*x),
            number(*y),
            number(*radius),
            hexadecimal(*color)
        ),
        Shape::Square {
            center: (x, y),
            side,
            color,
        } => format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{side}\" height=\"{side}\" fill=\"{}\"/>",
            number(x - side / 2.0),
            number(y - side / 2.0),
            hexadecimal(*color),
            side = number(*side),
        ),
        Shape::Text(text) => text_element(text),
    }
}

fn text_element(text: &Text) -> String {
    let (size, weight) = match text.size {
        Size::Title => (16.0, " font-weight=\"bold\""),
        Size::Normal => (14.0, ""),
        Size::Small => (12.0, ""),
    };
    let anchor = match text.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let mut content = escaped(&text.text);
    if !text.exponent.is_empty() {
        // Hyphens are too short for a minus.
        let exponent = escaped(&text.exponent.replace('-', "\u{2212}"));
        let (up, size) = (number(-0.4 * size), number(0.72 * size));
        // Writing into a string cannot fail.
        let _ = write!(
            content,
            "<tspan dy=\"{up}\" font-size=\"{size}\">{exponent}</tspan>"
        );
    }
    format!(
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{weight} text-anchor=\"{anchor}\" fill=\"{}\">\
         {content}</text>",
        number(text.place.0),
        number(text.place.1),
        number(size),
        hexadecimal(text.color)
    )
}

fn points(places: &[Place]) -> String {
    let place = |(x, y): &Place| format!("{},{}", number(*x), number(*y));
    places.iter().map(place).collect::<Vec<_>>().join(" ")
}

/// Two decimals are finer than any screen.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

fn hexadecimal(Color([red, green, blue]): Color) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A text between tags or quotes; what XML cannot hold becomes a replacement character.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            '\t' | '\n' | '\r' => escaped.push(' '),
            '\0'..' ' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            _ => escaped.push(letter),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::report::plot::chart;
    use crate::commands::report::results::tests::report;

    /// The elements of a well-formed document, each with its attributes; panics on any other.
    fn elements(document: &str) -> Vec<String> {
        let (mut open, mut found) = (Vec::new(), Vec::new());
        let mut rest = document;
        while let Some(start) = rest.find('<') {
            let between = &rest[..start];
            assert!(!between.contains('>'), "{between}");
            assert!(!open.is_empty() || between.trim().is_empty(), "{between}");
            for entity in between.split('&').skip(1) {
                let known = ["amp;", "lt;", "gt;", "quot;", "apos;"];
                assert!(
                    known.iter().any(|name| entity.starts_with(name)),
                    "{entity}"
                );
            }
            let end = rest.find('>').expect("an end of the tag");
            let tag = &rest[start + 1..end];
            assert!(
                !tag.contains('<') && tag.matches('"').count().is_multiple_of(2),
                "{tag}"
            );
            let name = |tag: &str| tag.split([' ', '/']).next().unwrap_or_default().to_owned();
            if let Some(closed) = tag.strip_prefix('/') {
                assert_eq!(open.pop().as_deref(), Some(closed));
            } else {
                found.push(tag.to_owned());
                if !tag.ends_with('/') {
                    open.push(name(tag));
                }
            }
            rest = &rest[end + 1..];
        }
        assert!(open.is_empty() && rest.trim().is_empty());
        found
    }

    #[test]
    fn documents_are_well_formed() {
        let mut report = report();
        report.title = "a < b & \"c\" > 'd'\u{1}, \n".to_owned();
        let document = text(&chart::draw(&report));
        if let Ok(p) = std::env::var("SVG_OUT") {
            std::fs::write(p, &document).unwrap();
        }
        let elements = elements(&document);
        assert!(elements[0].starts_with("svg xmlns="));
        let count = |name: &str| {
            let of_name = |tag: &&String| tag.split(' ').next() == Some(name);
            elements.iter().filter(of_name).count()
        };
        // Two points and the mark of the legend; two points, the mark and the background.
        assert_eq!((count("circle"), count("rect")), (3, 4));
        assert!(count("text") > 20 && count("tspan") >= 5 && count("polyline") > 20);
        assert!(document.contains("a &lt; b &amp; &quot;c&quot; &gt; &apos;d&apos;\u{fffd},  <"));
    }

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, -0.001, 1.0, 12.345, -3.5, 100.0].map(number);
        assert_eq!(
            texts,
            ["0", "0", "1", "12.35", "-3.5", "100"].map(str::to_owned)
        );
    }
}
