//! Errors of the renderer, and its claims.

use std::ops::ControlFlow;
use std::path::Path;

use glam::{DVec4, Vec4Swizzles};
use marbles_core::{Image, Lens, Method, Renderer, Settings, View};
use rayon::prelude::*;

use super::pixels::{self, ExactPixel};

/// A ratio of true and claimed error counts only if the claim is at least this many times the error of the exact value,
/// which then changes a ratio of 1/1000 by at most a tenth.
const TELLING: f64 = 1e4;

/// The results of a scene's pixels at a tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// The number of compared pixels.
    pub pixels: usize,
    /// The number of pixels over the tolerance that are not reported as such.
    pub broken: usize,
    /// The number of those that are over three times the tolerance.
    pub badly_broken: usize,
    /// The number of pixels that are reported as over the tolerance.
    pub unmet: usize,
    /// The number of pixels with errors larger than claimed, among those that are not reported.
    pub beyond_claim: usize,
    /// The largest error among the pixels that are not reported.
    pub worst: f64,
    /// The median ratio of true and claimed error over pixels with edges, as far as the exact values are precise
    /// enough.
    pub honesty: f64,
}

/// The parts of a pixel that are judged.
struct Judged {
    has_edge: bool,
    error: f64,
    claimed: f64,
    is_unmet: bool,
    uncertain: f64,
}

/// Renders the pixels of a scene's file, as pictures of one pixel each, or as one whole picture.
///
/// Every other pixel is rendered with its background instead of alpha.
pub fn score(scene: &Path, tolerance: f64, whole: bool) -> Score {
    let exact = pixels::read(scene);
    let scene = pixels::load(scene);
    let view = scene.view(1).expect("every scene has a first frame");
    let world = scene.world();
    let renderer = Renderer::new(world);
    let render = |view: &View, alpha: bool| {
        let settings = Settings {
            method: Method::Tolerance(tolerance),
            alpha,
        };
        let go = |_| ControlFlow::Continue(());
        renderer
            .render_with_progress(view, &settings, &go)
            .expect("not stopped")
    };
    let image = whole.then(|| render(&view, true));
    let one = |(index, pixel): (usize, &ExactPixel)| {
        if let Some(image) = &image {
            return judged(image, (pixel.col, pixel.row), pixel.value, pixel);
        }
        let alpha = index % 2 == 0;
        let image = render(&single_pixel(&view, pixel.col, pixel.row), alpha);
        let expected = if alpha {
            pixel.value
        } else {
            let background = world.background * (1.0 - pixel.value.w);
            (pixel.value.xyz() + background).extend(1.0)
        };
        judged(&image, (0, 0), expected, pixel)
    };
    let judged: Vec<Judged> = exact.par_iter().enumerate().map(one).collect();
    summarize(&judged, tolerance)
}

fn judged(image: &Image, (col, row): (u32, u32), expected: DVec4, exact: &ExactPixel) -> Judged {
    let found = DVec4::from_array(image.rgba(col, row));
    Judged {
        has_edge: exact.has_edge,
        error: (found - expected).abs().max_element(),
        claimed: image.error(col, row),
        is_unmet: image.status(col, row).is_over_tolerance(),
        // The files are rounded, and the background adds its own rounding.
        uncertain: exact.error + 1e-13,
    }
}

fn summarize(judged: &[Judged], tolerance: f64) -> Score {
    let met = || judged.iter().filter(|pixel| !pixel.is_unmet);
    let over = |factor: f64| {
        let beyond = |pixel: &&Judged| pixel.error > factor * tolerance + pixel.uncertain;
        met().filter(beyond).count()
    };
    let mut ratios: Vec<f64> = met()
        .filter(|pixel| pixel.has_edge && pixel.claimed > TELLING * pixel.uncertain)
        .map(|pixel| pixel.error / pixel.claimed)
        .collect();
    ratios.sort_by(f64::total_cmp);
    Score {
        pixels: judged.len(),
        broken: over(1.0),
        badly_broken: over(3.0),
        unmet: judged.len() - met().count(),
        beyond_claim: met()
            .filter(|pixel| pixel.error > pixel.claimed + pixel.uncertain)
            .count(),
        worst: met().map(|pixel| pixel.error).fold(0.0, f64::max),
        honesty: ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN),
    }
}

/// The view whose only pixel is pixel (col, row) of `view`.
pub fn single_pixel(view: &View, col: u32, row: u32) -> View {
    let center = view.cell_center(u64::from(col), u64::from(row), 1);
    View {
        lens: Lens {
            width: view.pixel_size().x,
            shift: center,
            ..view.lens
        },
        width: 1,
        height: 1,
        ..*view
    }
}
