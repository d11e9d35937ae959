//! Drawings as pixels: every shape covers each pixel by how far it reaches over the pixel's center,
//! and letters come ready from a font.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster};

use super::drawing::{Anchor, Color, Drawing, Place, Shape, Size, Text};

/// Pixels for a unit of the drawing, for the screens of today.
const SCALE: f64 = 2.0;
/// Lengths of dashes and of the gaps between them, in units.
const DASH: f64 = 7.0;
const GAP: f64 = 6.0;

/// Width, height, and row by row the codes of red, green and blue.
pub(super) fn rgb(drawing: &Drawing) -> (u32, u32, Vec<u8>) {
    let width = (drawing.width * SCALE) as usize;
    let height = (drawing.height * SCALE) as usize;
    let mut canvas = Canvas {
        width,
        height,
        codes: vec![u8::MAX; 3 * width * height],
    };
    for shape in &drawing.shapes {
        canvas.paint(shape);
    }
    (width as u32, height as u32, canvas.codes)
}

struct Canvas {
    width: usize,
    height: usize,
    codes: Vec<u8>,
}

impl Canvas {
    fn paint(&mut self, shape: &Shape) {
        match shape {
            Shape::Line {
                places,
                width,
                color,
                dashed,
            } => {
                for pair in places.windows(2) {
                    let (from, to) = (pair[0], pair[1]);
                    if *dashed {
                        for (from, to) in dashes(from, to) {
                            self.stroke(from, to, *width, *color);
                        }
                    } else {
                        self.stroke(from, to, *width, *color);
                    }
                }
            }
            Shape::Disk {
                center,
                radius,
                color,
            } => self.stroke(*center, *center, 2.0 * radius, *color),
            Shape::Square {
                center: (x, y),
                side,
                color,
            } => {
                let reach = side / 2.0;
                let outside = |(to_x, to_y): Place| {
                    ((to_x - x * SCALE).abs()).max((to_y - y * SCALE).abs()) - reach * SCALE
                };
                let (low, high) = ((x - reach, y - reach), (x + reach, y + reach));
                self.fill(low, high, *color, outside);
            }
            Shape::Text(text) => self.text(text),
        }
    }

    /// A line with round ends, or a disk where both are the same.
    fn stroke(&mut self, from: Place, to: Place, width: f64, color: Color) {
        let reach = width / 2.0;
        let low = (from.0.min(to.0) - reach, from.1.min(to.1) - reach);
        let high = (from.0.max(to.0) + reach, from.1.max(to.1) + reach);
        let (start, along) = (scaled(from), (to.0 - from.0, to.1 - from.1));
        let along = scaled(along);
        let length_sq = along.0 * along.0 + along.1 * along.1;
        self.fill(low, high, color, |(x, y)| {
            let (x, y) = (x - start.0, y - start.1);
            let foot = if length_sq > 0.0 {
                ((x * along.0 + y * along.1) / length_sq).clamp(0.0, 1.0)
            } else {
                0.0
            };
            (x - foot * along.0).hypot(y - foot * along.1) - reach * SCALE
        });
    }

    /// Paints what lies between two corners where `outside`, the distance in pixels to the shape's
    /// border, is below 0, and in part where it is about 0.
    fn fill(&mut self, low: Place, high: Place, color: Color, outside: impl Fn(Place) -> f64) {
        let (low, high) = (scaled(low), scaled(high));
        // The casts saturate.
        let range = |low: f64, high: f64, most: usize| {
            (low.floor() - 1.0) as usize..((high.ceil() + 1.0) as usize).min(most)
        };
        for row in range(low.1, high.1, self.height) {
            for col in range(low.0, high.0, self.width) {
                let center = (col as f64 + 0.5, row as f64 + 0.5);
                self.blend(col, row, color, 0.5 - outside(center));
            }
        }
    }

    /// Mixes a color in, by how much of the pixel it covers.
    fn blend(&mut self, col: usize, row: usize, Color(color): Color, coverage: f64) {
        if coverage <= 0.0 || col >= self.width || row >= self.height {
            return;
        }
        let coverage = coverage.min(1.0);
        let start = 3 * (row * self.width + col);
        for (code, new) in self.codes[start..start + 3].iter_mut().zip(color) {
            let mixed = f64::from(*code) + coverage * (f64::from(new) - f64::from(*code));
            *code = mixed.round() as u8;
        }
    }

    fn text(&mut self, text: &Text) {
        let font = Font::of(text.size);
        let (mut x, y) = scaled(text.place);
        let width = font.width(&text.text) + EXPONENTS.width(&text.exponent);
        x -= match text.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let end = self.letters((x, y), font, &text.text, text.color);
        let raised = y - 0.4 * font.ascent();
        self.letters((end, raised), EXPONENTS, &text.exponent, text.color);
    }

    /// Where the text ends.
    fn letters(&mut self, (x, y): Place, font: Font, text: &str, color: Color) -> f64 {
        let top = (y - font.ascent()).round();
        let mut left = x.round();
        for letter in text.chars() {
            let raster = font.raster(letter);
            for (down, row) in raster.rows().enumerate() {
                for (along, &ink) in row.iter().enumerate() {
                    let (col, row) = (left + along as f64, top + down as f64);
                    if col >= 0.0 && row >= 0.0 {
                        let coverage = f64::from(ink) / f64::from(u8::MAX);
                        self.blend(col as usize, row as usize, color, coverage);
                    }
                }
            }
            left += raster.width() as f64;
        }
        left
    }
}

fn scaled((x, y): Place) -> Place {
    (x * SCALE, y * SCALE)
}

/// The dashes of a line.
fn dashes(from: Place, to: Place) -> impl Iterator<Item = (Place, Place)> {
    let (x, y) = (to.0 - from.0, to.1 - from.1);
    let length = x.hypot(y);
    let place = move |at: f64| {
        let along = (at / length).min(1.0);
        (from.0 + along * x, from.1 + along * y)
    };
    let count = (length / (DASH + GAP)).ceil() as usize;
    (0..count).map(move |index| {
        let start = index as f64 * (DASH + GAP);
        (place(start), place(start + DASH))
    })
}

/// Noto Sans Mono in one size.
#[derive(Clone, Copy)]
struct Font {
    weight: FontWeight,
    height: RasterHeight,
}

const EXPONENTS: Font = Font {
    weight: FontWeight::Regular,
    height: RasterHeight::Size20,
};

impl Font {
    fn of(size: Size) -> Self {
        let (weight, height) = match size {
            Size::Title => (FontWeight::Bold, RasterHeight::Size32),
            Size::Normal => (FontWeight::Regular, RasterHeight::Size32),
            Size::Small => (FontWeight::Regular, RasterHeight::Size24),
        };
        Self { weight, height }
    }

    /// A letter, or in place of one that the font lacks a question mark.
    fn raster(self, letter: char) -> RasterizedChar {
        [letter, '?', ' ']
            .into_iter()
            .find_map(|letter| get_raster(letter, self.weight, self.height))
            .expect("the font has ASCII")
    }

    fn width(self, text: &str) -> f64 {
        let widths = text.chars().map(|letter| self.raster(letter).width());
        widths.sum::<usize>() as f64
    }

    /// From the top of the raster to the base line, on which an H stands.
    fn ascent(self) -> f64 {
        let mut rows = self.raster('H').rows();
        let last = rows.rposition(|row| row.iter().any(|&ink| ink > 0));
        last.map_or(0.0, |row| row as f64 + 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::report::plot::chart;
    use crate::commands::report::tests::report;

    fn canvas(shape: Shape) -> (usize, Vec<u8>) {
        let drawing = Drawing {
            width: 20.0,
            height: 10.0,
            title: String::new(),
            shapes: vec![shape],
        };
        let (width, height, codes) = rgb(&drawing);
        assert_eq!((width, height, codes.len()), (40, 20, 3 * 40 * 20));
        (width as usize, codes)
    }

    /// How much black is on the canvas, in units of area.
    fn ink(codes: &[u8]) -> f64 {
        let black = codes.iter().map(|&code| 1.0 - f64::from(code) / 255.0);
        black.sum::<f64>() / 3.0 / (SCALE * SCALE)
    }

    #[test]
    fn shapes_cover_their_area() {
        const BLACK: Color = Color([0; 3]);
        let line = |dashed| Shape::Line {
            places: vec![(3.0, 2.0), (17.0, 8.0)],
            width: 2.0,
            color: BLACK,
            dashed,
        };
        let length = 14.0_f64.hypot(6.0);
        let pi = std::f64::consts::PI;
        let disk = Shape::Disk {
            center: (10.0, 5.0),
            radius: 3.0,
            color: BLACK,
        };
        let square = Shape::Square {
            center: (10.1, 5.2),
            side: 4.0,
            color: BLACK,
        };
        for (shape, area) in [
            (line(false), 2.0 * length + pi),
            // Both dashes have round ends; the second is cut.
            (line(true), 2.0 * (DASH + length - DASH - GAP) + 2.0 * pi),
            (disk, 9.0 * pi),
            (square, 16.0),
        ] {
            let found = ink(&canvas(shape.clone()).1);
            assert!(
                (found / area - 1.0).abs() < 0.02,
                "{shape:?}: {found} of {area}"
            );
        }
    }

    #[test]
    fn shapes_beyond_the_border_are_cut() {
        let (_, codes) = canvas(Shape::Disk {
            center: (-1e6, 5.0),
            radius: 3.0,
            color: Color([0; 3]),
        });
        assert!(codes.iter().all(|&code| code == u8::MAX));
        let (_, codes) = canvas(Shape::Text(Text {
            place: (-5.0, 1.0),
            anchor: Anchor::Start,
            size: Size::Title,
            color: Color([0; 3]),
            text: "beyond any border".to_owned(),
            exponent: "9".to_owned(),
        }));
        assert!(ink(&codes) > 0.0);
    }

    #[test]
    fn the_font_has_all_letters_of_a_chart() {
        for shape in chart::draw(&report()).shapes {
            if let Shape::Text(text) = shape {
                for letter in text.text.chars().chain(text.exponent.chars()) {
                    let font = Font::of(text.size);
                    let found = get_raster(letter, font.weight, font.height);
                    assert!(found.is_some(), "{letter} of {}", text.text);
                }
            }
        }
    }
}
