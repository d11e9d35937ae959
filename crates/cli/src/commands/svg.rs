//! SVG: plain shapes and text, without scripts, styles or links, so that a page can show it as it is.

use std::fmt::Write;

/// Fonts that most systems have: an SVG contains none.
const FONTS: &str = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

/// A position on the drawing in pixels: x to the right, y downward, from the top left corner.
pub(crate) type Place = (f64, f64);

/// A drawing on white, to which shapes are added in the order of painting.
pub(crate) struct Svg {
    text: String,
    /// The width and the height with which it is shown.
    size: Place,
}

/// The look of a text, and its anchor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    pub(crate) anchor: Anchor,
    pub(crate) size: f64,
    pub(crate) is_bold: bool,
    pub(crate) color: &'static str,
}

/// The part of a text that is at its position.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Svg {
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Self {
        Self::scaled(width, height, 1.0, title)
    }

    /// A drawing that is shown `scale` times as large as its positions and sizes say.
    pub(crate) fn scaled(width: f64, height: f64, scale: f64, title: &str) -> Self {
        let size = (scale * width, scale * height);
        let (shown_width, shown_height) = (number(size.0), number(size.1));
        let (width, height) = (number(width), number(height));
        let title = escaped(title);
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{shown_width}\" height=\"{shown_height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\" role=\"img\">\n\
             <title>{title}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        Self { text, size }
    }

    /// The width and the height with which the drawing is shown.
    pub(crate) fn size(&self) -> Place {
        self.size
    }

    /// Adds another drawing by its top left corner.
    pub(crate) fn drawing(&mut self, (x, y): Place, drawing: Self) {
        let place = format!("<svg x=\"{}\" y=\"{}\" ", number(x), number(y));
        let text = drawing.finish();
        self.text.push_str(&text.replacen("<svg ", &place, 1));
    }

    /// Adds a picture by its top left corner, from the bytes of a PNG.
    pub(crate) fn png(&mut self, (x, y): Place, (width, height): Place, png: &[u8]) {
        let [x, y, width, height] = [x, y, width, height].map(number);
        // Programs that are older than SVG 2 know `href` by its old name alone.
        self.element(format_args!(
            "<image xmlns:xlink=\"http://www.w3.org/1999/xlink\" x=\"{x}\" y=\"{y}\" width=\"{width}\" \
             height=\"{height}\" xlink:href=\"data:image/png;base64,{}\"/>",
            base64(png)
        ));
    }

    /// The text of the file.
    pub(crate) fn finish(self) -> String {
        self.text + "</svg>\n"
    }

    /// Adds a line through these places.
    pub(crate) fn line(&mut self, places: &[Place], width: f64, color: &str) {
        self.polyline(places, width, color, "stroke-linecap=\"round\"");
    }

    /// Adds a dashed line through these places.
    pub(crate) fn dashes(&mut self, places: &[Place], width: f64, color: &str) {
        self.polyline(places, width, color, "stroke-dasharray=\"7 6\"");
    }

    fn polyline(&mut self, places: &[Place], width: f64, color: &str, look: &str) {
        let place = |(x, y): &Place| format!("{},{}", number(*x), number(*y));
        let points: Vec<String> = places.iter().map(place).collect();
        self.element(format_args!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\" \
             stroke-linejoin=\"round\" {look}/>",
            points.join(" "),
            number(width)
        ));
    }

    pub(crate) fn disk(&mut self, (x, y): Place, radius: f64, color: &str) {
        let [x, y, radius] = [x, y, radius].map(number);
        self.element(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{color}\"/>"
        ));
    }

    /// Adds a rectangle by its top left corner and its sides.
    pub(crate) fn rectangle(&mut self, (x, y): Place, (width, height): Place, color: &str) {
        let [x, y, width, height] = [x, y, width, height].map(number);
        self.element(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{color}\"/>"
        ));
    }

    /// Adds a rectangle with a thin gray edge, which shows any color on white.
    pub(crate) fn swatch(&mut self, (x, y): Place, side: f64, color: &str) {
        // The edge lies inside.
        let [x, y, side] = [x + 0.5, y + 0.5, side - 1.0].map(number);
        self.element(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{side}\" height=\"{side}\" fill=\"{color}\" stroke=\"#808080\" \
             stroke-width=\"1\"/>"
        ));
    }

    /// Adds a rectangle with a gradient from the left to the right through evenly spaced colors. `name` is that of no
    /// other gradient of the drawing.
    pub(crate) fn gradient(
        &mut self,
        (x, y): Place,
        (width, height): Place,
        colors: &[String],
        name: &str,
    ) {
        self.element(format_args!("<linearGradient id=\"{name}\">"));
        let last = colors.len().saturating_sub(1).max(1) as f64;
        for (index, color) in colors.iter().enumerate() {
            let offset = number(100.0 * index as f64 / last);
            self.element(format_args!(
                "<stop offset=\"{offset}%\" stop-color=\"{color}\"/>"
            ));
        }
        self.element(format_args!("</linearGradient>"));
        self.rectangle((x, y), (width, height), &format!("url(#{name})"));
    }

    /// Adds a square that stands on a corner.
    pub(crate) fn square(&mut self, (x, y): Place, side: f64, color: &str) {
        let [x, y, side] = [x - side / 2.0, y - side / 2.0, side].map(number);
        self.element(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{side}\" height=\"{side}\" fill=\"{color}\"/>"
        ));
    }

    /// Adds a text with its base line at a position.
    pub(crate) fn text(&mut self, place: Place, style: Style, text: &str) {
        self.text_element(place, style, &escaped(text));
    }

    /// Adds a power of ten.
    pub(crate) fn power(&mut self, place: Place, style: Style, exponent: i32) {
        // Hyphens are too short for a minus.
        let exponent = exponent.to_string().replace('-', "\u{2212}");
        let (up, size) = (number(-0.4 * style.size), number(0.72 * style.size));
        let content = format!("10<tspan dy=\"{up}\" font-size=\"{size}\">{exponent}</tspan>");
        self.text_element(place, style, &content);
    }

    fn text_element(&mut self, (x, y): Place, style: Style, content: &str) {
        let Style {
            anchor,
            size,
            is_bold,
            color,
        } = style;
        let [x, y, size] = [x, y, size].map(number);
        let weight = if is_bold { " font-weight=\"bold\"" } else { "" };
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        self.element(format_args!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{weight} text-anchor=\"{anchor}\" \
             fill=\"{color}\">{content}</text>"
        ));
    }

    fn element(&mut self, element: std::fmt::Arguments<'_>) {
        // Writing into a string cannot fail.
        let _ = writeln!(self.text, "{element}");
    }
}

/// Bytes in base 64, as RFC 4648 defines it.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |index: usize| u32::from(group.get(index).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            let is_there = digit <= group.len();
            let value = (bits >> (18 - 6 * digit)) & 63;
            text.push(if is_there {
                char::from(DIGITS[value as usize])
            } else {
                '='
            });
        }
    }
    text
}

/// Two decimals are finer than the pixels of any screen.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}

/// A text for use between tags or quotes; characters that XML does not allow become replacement characters.
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

    /// The vectors of RFC 4648, section 10.
    #[test]
    fn bytes_are_written_in_base_64() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xff, 0xef, 0xbe]), "/+++");
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
