//! What a plot is made of, before it is an SVG or a PNG.

/// Shapes in the order of painting, on white.
///
/// Lengths are the pixels of an SVG; x goes right, y goes down from the top left corner.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) title: String,
    pub(super) shapes: Vec<Shape>,
}

pub(super) type Place = (f64, f64);

#[derive(Clone, Debug)]
pub(super) enum Shape {
    Line {
        places: Vec<Place>,
        width: f64,
        color: Color,
        dashed: bool,
    },
    Disk {
        center: Place,
        radius: f64,
        color: Color,
    },
    /// A square that stands on its side.
    Square {
        center: Place,
        side: f64,
        color: Color,
    },
    Text(Text),
}

/// A line of text, with its base line at `place`.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub(super) place: Place,
    pub(super) anchor: Anchor,
    pub(super) size: Size,
    pub(super) color: Color,
    pub(super) text: String,
    /// What follows the text, smaller and higher.
    pub(super) exponent: String,
}

/// Which part of a text is at its place.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Size {
    Title,
    Normal,
    Small,
}

/// Codes of sRGB.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct Color(pub(super) [u8; 3]);

impl Drawing {
    /// Adds a straight line.
    pub(super) fn line(&mut self, from: Place, to: Place, width: f64, color: Color) {
        self.shapes.push(Shape::Line {
            places: vec![from, to],
            width,
            color,
            dashed: false,
        });
    }

    /// Adds a text.
    pub(super) fn text(
        &mut self,
        place: Place,
        anchor: Anchor,
        size: Size,
        color: Color,
        text: &str,
    ) {
        self.shapes.push(Shape::Text(Text {
            place,
            anchor,
            size,
            color,
            text: text.to_owned(),
            exponent: String::new(),
        }));
    }
}
