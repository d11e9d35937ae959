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
    /// The area and the first moments in each band of lines, and the span nearest to the band's centroid.
    pub(crate) bands: [Band; BANDS],
}

/// The bands of lines in which light is computed.
pub(crate) const BANDS: usize = 3;

/// A part of a piece.
#[derive(Clone, Debug, Default)]
pub(crate) struct Band {
    pub(crate) area: f64,
    pub(crate) moment: DVec2,
    /// Spans of the band: their height, begin and end.
    pub(crate) spans: Vec<[f64; 3]>,
}

impl Piece {
    pub(crate) fn new(place: usize) -> Self {
        Self {
            place,
            area: 0.0,
            moment: DVec2::ZERO,
            rough_area: 0.0,
            bands: Default::default(),
        }
    }

    /// Adds a span of a line in a band, whose area is its length times `weight`.
    pub(crate) fn add(&mut self, band: usize, v: f64, [begin, end]: [f64; 2], weight: f64) {
        let area = (end - begin) * weight;
        let moment = DVec2::new(0.5 * (begin + end), v) * area;
        self.area += area;
        self.moment += moment;
        let band = &mut self.bands[band];
        band.area += area;
        band.moment += moment;
        band.spans.push([v, begin, end]);
    }

    /// The places at which light is computed: all of them are seen. Three of them lie on one span, for light near a contour
    /// goes with the square root of the distance from it.
    pub(crate) fn nodes(&self) -> Vec<DVec2> {
        /// Nodes of Gauss's rules with two and three points, in halves of a span from its middle.
        const TWO: [f64; 2] = [-0.577_350_269_189_625_7, 0.577_350_269_189_625_7];
        const THREE: [f64; 3] = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
        let mut nodes = Vec::with_capacity(2 * BANDS + 1);
        let largest = self.bands.iter().map(|band| band.area).fold(0.0, f64::max);
        for band in self.bands.iter().filter(|band| band.area > 0.0) {
            let centroid = band.moment / band.area;
            let distance = |&[v, begin, end]: &[f64; 3]| {
                (v - centroid.y).abs() + (begin - centroid.x).max(centroid.x - end).max(0.0)
            };
            let spans = band.spans.iter();
            let nearest = spans.min_by(|one, other| distance(one).total_cmp(&distance(other)));
            let Some(&[v, begin, end]) = nearest else {
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
