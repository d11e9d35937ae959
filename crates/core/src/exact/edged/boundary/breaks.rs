//! Places where curves begin or end to be seen.

use fearless_simd::Simd;

use super::arcs::{Front, between, front};
use super::circle::Trace;
use super::events::{INTERVALS, Stretch};
use super::functions::{Function, in_disc, is_beyond, polynomial, value};
use super::setting::{Boundary, Edge, NONE, Setting};
use crate::exact::classify::contents::Kind;
use crate::exact::classify::reach::Reach;

/// Intervals that begin or end at some of the places.
fn beside(lanes: u64) -> u64 {
    (lanes | lanes >> 1) & INTERVALS
}

impl Boundary {
    /// Finds where other spheres begin or end in front of a stretch; returns what is in front of it at the
    /// eight places.
    #[inline(never)]
    pub(super) fn find_breaks<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        stretch: &Stretch<'_>,
        places: &Trace<S>,
    ) -> Front<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let contents = setting.contents;
                let front = front(simd, contents, stretch.curve.own, places);
                let is_side = stretch.curve.is_side();
                if let Some(hider) = front.hider
                    && !is_side
                {
                    // It may come out between two places: parts there are looked at once more.
                    self.find_gaps(simd, setting, stretch, places, (hider, INTERVALS));
                    return front;
                }
                let hidden = front.nearest.simd_lt(places.point.z).to_bitmask();
                let firsts: [f64; 8] = front.first.into();
                let (mut alike, mut covered) = (0, 0);
                for lane in 0..7 {
                    alike |= u64::from(firsts[lane] == firsts[lane + 1]) << lane;
                    covered |= u64::from(firsts[lane] != 0.0) << lane;
                }
                // Nothing comes in sight where one sphere hides both ends.
                let open = if is_side {
                    INTERVALS & !self.crossed(setting, stretch)
                } else {
                    INTERVALS & !(between(hidden) & alike)
                };
                if !is_side {
                    let mut closed = INTERVALS & !open;
                    while closed != 0 {
                        let hider = firsts[closed.trailing_zeros() as usize] as usize - 1;
                        let by_this = closed & front.is(hider);
                        closed &= !by_this;
                        self.find_gaps(simd, setting, stretch, places, (hider, by_this));
                    }
                }
                for (position, active) in contents.active.iter().enumerate() {
                    if stretch.curve.own.contains(&position) {
                        continue;
                    }
                    let mut intervals = open;
                    if setting.goal.parts == 1 {
                        // Where the same is first at both ends, what lies wholly behind it begins behind it.
                        let ball = &active.ball;
                        let is_behind = front.nearest.simd_lt(ball.center.z - ball.radius);
                        let behind = between(is_behind.to_bitmask());
                        intervals &= beside(front.is(position)) | !(alike & covered & behind);
                    }
                    if intervals == 0 {
                        continue;
                    }
                    let values = polynomial(&active.discriminant, places.x, places.y);
                    let function = Function::Contour(position);
                    stretch.roots(simd, setting, function, values, intervals, &mut self.breaks);
                }
                for (index, (kind, conic)) in contents.conics.iter().enumerate() {
                    let Kind::Seam(one, other) = *kind else {
                        continue;
                    };
                    let (function, intervals) = match (
                        stretch.curve.own.contains(&one),
                        stretch.curve.own.contains(&other),
                    ) {
                        (true, true) => continue,
                        (false, false) => {
                            let mut intervals = open;
                            if setting.goal.parts == 1 {
                                intervals &= !alike | beside(front.is(one) | front.is(other));
                            }
                            let values = polynomial(conic, places.x, places.y);
                            let function = Function::Conic(index);
                            stretch.roots(
                                simd,
                                setting,
                                function,
                                values,
                                intervals,
                                &mut self.breaks,
                            );
                            continue;
                        }
                        (true, false) => (Function::Inside(other), beside(front.is(other))),
                        (false, true) => (Function::Inside(one), beside(front.is(one))),
                    };
                    let intervals = intervals & open;
                    if intervals == 0 {
                        continue;
                    }
                    let values = value(simd, setting, function, places);
                    stretch.roots(simd, setting, function, values, intervals, &mut self.breaks);
                }
                if contents.has_outlines() {
                    self.find_outlines(simd, setting, stretch, places, open);
                }
                front
            },
        )
    }

    /// Finds where a stretch comes out of the sphere that hides both ends of some intervals: beside its contour, or
    /// before it, where its own sphere meets that one.
    #[inline(always)]
    fn find_gaps<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        stretch: &Stretch<'_>,
        places: &Trace<S>,
        (hider, intervals): (usize, u64),
    ) {
        let contents = setting.contents;
        let breaks = &mut self.breaks;
        let values = polynomial(&contents.active[hider].discriminant, places.x, places.y);
        stretch.find_dips(
            simd,
            setting,
            Function::Contour(hider),
            values,
            intervals,
            breaks,
        );
        let meets = contents.conics.iter().any(|(kind, _)| match *kind {
            Kind::Seam(one, other) => {
                let own = stretch.curve.own;
                one == hider && own.contains(&other) || other == hider && own.contains(&one)
            }
            _ => false,
        });
        if meets {
            let function = Function::Inside(hider);
            let values = value(simd, setting, function, places);
            stretch.find_dips(simd, setting, function, values, intervals, breaks);
        }
    }

    /// Finds where a piece leaves the outer sides of its own spheres, the cell or the lower side of a
    /// caster; whether any of it may be seen.
    #[inline(always)]
    pub(super) fn find_own_breaks<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        stretch: &Stretch<'_>,
        places: &Trace<S>,
    ) -> bool {
        let curve = stretch.curve;
        if curve.is_side() || matches!(curve.edge, Edge::Limb | Edge::Outline) {
            return true;
        }
        let mut functions = [(Function::Across(0, 0.0), 0.0); 8];
        let mut count = 0;
        for own in curve.own {
            if own != NONE {
                functions[count] = (Function::Facing(own), 1.0);
                count += 1;
            }
        }
        if curve.is_within_outline() && setting.contents.has_outlines() {
            functions[count] = (Function::Outline(curve.own[0]), 1.0);
            count += 1;
        }
        if let Edge::Shadow(light, caster) = curve.edge {
            functions[count] = (Function::Above(light, caster), -1.0);
            functions[count + 1] = (Function::Across(0, -0.5), 1.0);
            functions[count + 2] = (Function::Across(0, 0.5), -1.0);
            functions[count + 3] = (Function::Across(1, -0.5), 1.0);
            functions[count + 4] = (Function::Across(1, 0.5), -1.0);
            count += 5;
        }
        let mut outside = [0; 8];
        for (index, (function, sign)) in functions.iter().enumerate().take(count) {
            let values = value(simd, setting, *function, places);
            outside[index] = (values * *sign).simd_lt(0.0).to_bitmask();
            let known = self.breaks.len();
            stretch.roots(
                simd,
                setting,
                *function,
                values,
                INTERVALS,
                &mut self.breaks,
            );
            if outside[index] == 0xff && self.breaks.len() == known {
                return false;
            }
        }
        if let Edge::Shadow(light, own) = curve.edge {
            // Where it is dark anyway, no shadow ends.
            let lights = setting.scene.lights.len();
            let reach = &setting.contents.reach[curve.own[0] * lights + light];
            let Reach::Past(casters) = reach else {
                return false;
            };
            for caster in casters.clone() {
                if caster == own {
                    continue;
                }
                let inside = in_disc(simd, setting, caster, &places.point);
                let is_beyond = is_beyond(simd, setting, (light, caster), &places.point);
                if (inside.simd_lt(0.0) & is_beyond).to_bitmask() == 0xff {
                    return false;
                }
            }
        }
        true
    }
}
