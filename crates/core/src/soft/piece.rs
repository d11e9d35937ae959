//! The part of a cell in which one sphere is seen.

use glam::DVec2;

use crate::model::color::Color;

/// The part of a cell in which one sphere is seen, without the light on it.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The place of the sphere among the candidates.
    pub(crate) place: usize,
    /// The area, and its first moments.
    pub(crate) area: f64,
    pub(crate) moment: DVec2,
    /// The area by a rule with half of the lines.
    pub(crate) rough_area: f64,
    spans: Vec<PieceSpan>,
}

/// The bands of lines in which light is computed.
const BANDS: usize = 3;

/// A part of a line.
#[derive(Clone, Copy, Debug)]
struct PieceSpan {
    v: f64,
    ends: [f64; 2],
    /// The area that it stands for.
    area: f64,
}

/// A part of a piece.
#[derive(Clone, Debug, Default)]
struct Band {
    area: f64,
    moment: DVec2,
}

impl PieceSpan {
    fn moment(&self) -> DVec2 {
        DVec2::new(0.5 * (self.ends[0] + self.ends[1]), self.v) * self.area
    }
}

impl Piece {
    pub(crate) fn new(place: usize) -> Self {
        Self {
            place,
            area: 0.0,
            moment: DVec2::ZERO,
            rough_area: 0.0,
            spans: Vec::new(),
        }
    }

    /// Adds a span of a line, whose area is its length times `weight`.
    pub(crate) fn add(&mut self, v: f64, ends: [f64; 2], weight: f64) {
        let area = (ends[1] - ends[0]) * weight;
        let span = PieceSpan { v, ends, area };
        self.area += area;
        self.moment += span.moment();
        self.spans.push(span);
    }

    /// The places at which light is computed: all of them are seen. Three of them lie on one span, for light near a contour
    /// goes with the square root of the distance from it.
    pub(crate) fn nodes(&self) -> Vec<DVec2> {
        /// Nodes of Gauss's rules with two and three points, in halves of a span from its middle.
        const TWO: [f64; 2] = [-0.577_350_269_189_625_7, 0.577_350_269_189_625_7];
        const THREE: [f64; 3] = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
        let mut nodes = Vec::with_capacity(2 * BANDS + 1);
        let heights = self.spans.iter().map(|span| span.v);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        let number = |v: f64| {
            let band = (v - low) / (high - low) * BANDS as f64;
            (band as usize).min(BANDS - 1)
        };
        let mut bands: [Band; BANDS] = Default::default();
        for span in &self.spans {
            let band = &mut bands[number(span.v)];
            band.area += span.area;
            band.moment += span.moment();
        }
        let largest = bands.iter().map(|band| band.area).fold(0.0, f64::max);
        for (index, band) in bands.iter().enumerate() {
            let centroid = band.moment / band.area;
            let distance = |&PieceSpan {
                                v,
                                ends: [begin, end],
                                ..
                            }: &PieceSpan| {
                (v - centroid.y).abs() + (begin - centroid.x).max(centroid.x - end).max(0.0)
            };
            let spans = self.spans.iter().filter(|span| number(span.v) == index);
            let nearest = spans.min_by(|one, other| distance(one).total_cmp(&distance(other)));
            let Some(&PieceSpan {
                v,
                ends: [begin, end],
                ..
            }) = nearest
            else {
                continue;
            };
            let places: &[f64] = if band.area == largest { &THREE } else { &TWO };
            let (middle, half) = (0.5 * (begin + end), 0.5 * (end - begin));
            nodes.extend(
                places
                    .iter()
                    .map(|place| DVec2::new(middle + half * place, v)),
            );
        }
        nodes
    }
}

/// The claim of few nodes, in parts of the largest difference from their mean, and of a plane, in parts of the largest
/// difference from it. From searches.
const OF_FEW: f64 = 3.0;
const OF_PLANE: f64 = 4.0;

/// The mean over a piece of light that is known at some nodes, and an estimate of its error: from the plane that fits best.
pub(crate) fn mean_of_fit(centroid: DVec2, nodes: &[DVec2], light: &[Color]) -> (Color, f64) {
    let count = nodes.len() as f64;
    let middle = nodes.iter().sum::<DVec2>() / count;
    let mean = light.iter().sum::<Color>() / count;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    let (mut xl, mut yl) = (Color::ZERO, Color::ZERO);
    for (node, light) in nodes.iter().zip(light) {
        let DVec2 { x, y } = *node - middle;
        xx += x * x;
        xy += x * y;
        yy += y * y;
        xl += (*light - mean) * x;
        yl += (*light - mean) * y;
    }
    let determinant = xx * yy - xy * xy;
    let is_plane = nodes.len() > 3 && determinant > 1e-3 * (xx + yy) * (xx + yy);
    let (along_x, along_y) = if is_plane {
        (
            (xl * yy - yl * xy) / determinant,
            (yl * xx - xl * xy) / determinant,
        )
    } else {
        (Color::ZERO, Color::ZERO)
    };
    let at = |place: DVec2| mean + along_x * (place.x - middle.x) + along_y * (place.y - middle.y);
    let mut largest = Color::ZERO;
    for (node, light) in nodes.iter().zip(light) {
        largest = largest.max((*light - at(*node)).abs());
    }
    let error = largest * if is_plane { OF_PLANE } else { OF_FEW };
    (at(centroid), error.max_element())
}
