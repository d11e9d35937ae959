//! The areas in which the spheres of a cell are seen, by boxes: as averages are, without light.

use fearless_simd::Simd;

use super::average::Setting;
use super::contours::Contours;
use super::division::{FIRST, FIRST_SIZE, HALVES, SHARE};
use super::eight_boxes::Eight;

/// Shares of a cell, and estimates of their errors, for each of its active spheres.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shares {
    pub(crate) of_spheres: Vec<[f64; 2]>,
    contours: Contours,
    /// The middles of boxes of one size, and those that are left of them.
    boxes: Vec<[f64; 2]>,
    left: Vec<[f64; 2]>,
    /// The shares and errors in eight boxes, sphere by sphere.
    found: Vec<[Eight; 2]>,
    /// Those in each box that was just done.
    known: Vec<[f64; 2]>,
    /// The work on cells since it was asked for, in the unit of tests.
    pub(crate) tests: u64,
}

/// Times that eight boxes are measured before the cell is given up.
const MOST_EIGHTS: usize = 40;

/// The tests in the time in which eight boxes are measured, for each sphere: about, from cells with two.
const TESTS_OF_EIGHT: usize = 16;

impl Shares {
    /// Measures a cell to an error that all shares together may have; returns whether that succeeded.
    pub(super) fn measure<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        tolerance: f64,
    ) -> bool {
        let spheres = setting.contents.active.len();
        self.of_spheres.clear();
        self.of_spheres.resize(spheres, [0.0; 2]);
        self.boxes.clear();
        let first = (0..8).map(|lane| FIRST.map(|places| places[lane]));
        self.boxes.extend(first);
        let mut size = FIRST_SIZE;
        let (mut claimed, mut eights) = (0.0, 0);
        loop {
            let more = self.boxes.len().div_ceil(8);
            eights += more;
            if eights > MOST_EIGHTS {
                return false;
            }
            self.tests += (more * spheres * TESTS_OF_EIGHT) as u64;
            self.average(simd, setting, size);
            let area = size[0] * size[1];
            let claims: f64 = self.known.iter().map(|[_, error]| error * area).sum();
            let allowed = tolerance - claimed;
            let limit = if claims <= allowed {
                f64::INFINITY
            } else {
                SHARE * allowed / (self.boxes.len() as f64 * area)
            };
            self.left.clear();
            for (index, &middle) in self.boxes.iter().enumerate() {
                let of_box = &self.known[index * spheres..][..spheres];
                let error: f64 = of_box.iter().map(|[_, error]| error).sum();
                if error > limit {
                    self.left.push(middle);
                    continue;
                }
                claimed += error * area;
                for (sum, [share, error]) in self.of_spheres.iter_mut().zip(of_box) {
                    sum[0] += share * area;
                    sum[1] += error * area;
                }
            }
            if self.left.is_empty() {
                return true;
            }
            // Halves across the longer side.
            let longer = usize::from(size[1] > size[0]);
            self.boxes.clear();
            for middle in &self.left {
                for [along, _] in HALVES {
                    let mut half = *middle;
                    half[longer] += along * size[longer];
                    self.boxes.push(half);
                }
            }
            size[longer] *= 0.5;
        }
    }

    /// Measures all boxes.
    fn average<S: Simd>(&mut self, simd: S, setting: &Setting<'_, '_>, size: [f64; 2]) {
        self.known.clear();
        let Self {
            boxes,
            found,
            known,
            contours,
            ..
        } = self;
        for group in boxes.chunks(8) {
            let mut middles = [[0.0; 8]; 2];
            for lane in 0..8 {
                let [x, y] = group[lane.min(group.len() - 1)];
                middles[0][lane] = x;
                middles[1][lane] = y;
            }
            setting.areas(simd, middles, size, contours, found);
            for lane in 0..group.len() {
                let of_spheres = found.iter();
                known.extend(of_spheres.map(|[share, error]| [share[lane], error[lane]]));
            }
        }
    }
}
