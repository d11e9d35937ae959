//! Pixels with a contour and no other edge: light on plain surfaces is the product of the normals' integral with its
//! direction.

use fearless_simd::Simd;

use super::boundary::Goal;
use super::cell::{EdgedPixel, FINER, Workspace};
use crate::edges::cell::Cell;
use crate::exact::classify::occluder_cache::OccluderCache;
use crate::exact::classify::reach::Reach;
use crate::exact::part::{GiveUp, Part};
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;

impl Workspace {
    /// Whether mean normals know what a pixel sees: nothing but the contour of a sphere, under the only light.
    pub(crate) fn knows_mean_normals(&self, pixel: &EdgedPixel<'_, '_>) -> bool {
        pixel.context.normals.is_some() && self.contents.is_contour_alone()
    }

    /// The average of a pixel that sees nothing but the contour of a plain sphere, under its only light, which reaches
    /// all or nothing of what is seen; where it meets the tolerance.
    ///
    /// # Accuracy
    /// An estimate: that of the integral in any direction, and of the area.
    pub(crate) fn by_mean_normals<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        _: &mut OccluderCache,
        _: GiveUp,
    ) -> Result<Part, GiveUp> {
        let context = pixel.context;
        let contents = &self.contents;
        let finish = Finish::new(&context.scene, contents.active[0].sphere, contents.pixel);
        let (normals, light) = context.normals_on(&finish).ok_or(GiveUp::Unknown)?;
        let reflectance = &finish.reflectance;
        let ambient = reflectance.albedo * context.scene.ambient;
        let [brightest, _] = reflectance.brightest(light.intensity);
        let of_area = (ambient - context.background).abs().max_element();
        let contrast = brightest + of_area;
        let tolerance = context.tolerance_of_normals(contrast);
        let is_lit = !matches!(contents.reach[0], Reach::Nowhere);

        let known = self.normals.outlined.iter();
        let known = known
            .rev()
            .find(|known| known.0 == pixel.key && known.1 == tolerance);
        let found = match known {
            Some((_, _, found)) => *found,
            None => {
                let found = self.integral_of_normals(simd, normals, &pixel.whole(), tolerance);
                self.normals.outlined.push((pixel.key, tolerance, found));
                found
            }
        };
        let found = found.ok_or(GiveUp::Unknown)?;
        let mut value = context.background * (1.0 - found.covered) + ambient * found.covered;
        if is_lit {
            let color = reflectance.albedo * light.intensity;
            value += color * found.value.dot(light.toward).max(0.0);
        }
        let part = Part {
            value,
            covered: found.covered,
            error: found.error * contrast + pixel.moved(self.contrast),
            rounding: found.rounding * contrast,
        };
        if part.error <= context.tolerance {
            Ok(part)
        } else {
            Err(GiveUp::Unknown)
        }
    }

    /// The integral of the normals over a cell that sees one sphere, and its area; if its error is within the
    /// tolerance.
    fn integral_of_normals<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        tolerance: f64,
    ) -> Option<Part> {
        self.contents.of_normals(&mut self.normals.contents);
        for &parts in FINER[0] {
            let goal = Goal {
                tolerance,
                background: Color::ZERO,
                contrast: 1.0,
                of_coverage: 1.0,
                parts,
                units: self.budget.of_part(),
            };
            let contents = &self.normals.contents;
            let boundary = &mut self.boundary;
            let found = simd.vectorize(
                #[inline(always)]
                || boundary.integrate(simd, scene, cell, contents, &goal),
            );
            self.work.samples += std::mem::take(&mut boundary.work).samples;
            self.work.lines += std::mem::take(&mut boundary.lines);
            if let Ok(part) = found
                && part.error <= tolerance
            {
                return Some(part);
            }
        }
        None
    }
}
