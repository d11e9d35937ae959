//! Light summed up along chords on which it is not smooth.
//!
//! It bends, or jumps, where a bump turns from a light, or from its half vector: chords are divided
//! there.

use fearless_simd::Simd;

use super::chord::Chord;
use super::primitive::{Lines, NEGLIGIBLE, Noise, Sender, Summed, greatest, ray};
use super::turns::{Look, Seeker, Stops, Turn};
use super::unseen::Unseen;
use crate::exact::classify::active::Terminators;
use crate::exact::edged::rule::{CAUTION, NODES, OF_ODD, RULE};
use crate::exact::points::Points;
use crate::exact::scene::MOST_LIGHTS;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// A part of chords on which light is smooth.
#[derive(Clone, Copy, Debug)]
struct Stretch<S: Simd> {
    start: f64x8<S>,
    end: f64x8<S>,
    /// Whether light may go with a root of the distance to the ends.
    is_eased: bool,
    is_bumpy: bool,
    /// Whether what cells of the noise cost where they meet is known.
    is_followed: bool,
}

/// The closeness of the looks at chords.
#[derive(Clone, Copy, Debug)]
struct Search {
    /// Into so many parts they are divided in any case.
    parts: usize,
    /// Steps of the search in each part.
    looks: usize,
    /// Steps to a turn.
    steps: u32,
}

/// Into how many parts a chord on bumps is divided at most.
const MOST_PARTS: usize = 16;

/// Tolerances that are small enough for a search in earnest.
const FINE: f64 = 4.5e-5;

/// The error of the sum across lines if some of them turn otherwise than others, in what they
/// differ by: where light bends, and where it jumps.
const UNEVEN: f64 = 0.02;
const JUMPY: f64 = 0.2;

impl Sender<'_, '_> {
    /// Light with kinks, or jumps.
    #[inline(never)]
    pub(super) fn kinked<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        noise: &mut Noise,
    ) -> Summed<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let middle = ray(simd, self.cell, lines.x * 0.0, lines.y * 0.0);
                let negligible = NEGLIGIBLE * self.tolerance;
                let size = self.cell.size;
                let jumps = self
                    .finish
                    .jumps(simd, self.scene, &middle, size, negligible);
                let jumps = jumps.to_bitmask() != 0;
                let search = self.search(chord, jumps);
                let mut stops = Stops::default();
                let (is_even, unseen) = self.find(simd, chord, lines, &search, &mut stops, noise);
                let is_bumpy = self.active.terminators == Terminators::Anywhere;
                let turns = stops.most();
                let zero = f64x8::splat(simd, 0.0);
                let is_followed = is_bumpy && self.is_followed(&search);
                let mut missed = zero;
                if is_followed {
                    missed = self.jumps(simd, chord, lines, search.parts, &mut stops, noise);
                }
                let cutoffs = lines.lights & self.cutoffs;
                self.divide_at_cutoffs(simd, chord, lines, cutoffs, &mut stops);
                let most = stops.most();
                if !is_bumpy && most == 0 {
                    let mut sum = self.smooth(simd, chord, lines, noise);
                    sum.samples += stops.samples;
                    return sum;
                }
                // A power that is not whole begins like a root.
                let is_fractional = turns >= search.parts && !self.finish.has_whole_exponent();
                let is_eased = is_fractional || cutoffs != 0;
                let mut sum = Summed {
                    light: [zero; 3],
                    doubt: missed,
                    samples: stops.samples,
                    // Edges are cut at terminators that are no bumps'.
                    unevenness: match (is_even || !is_bumpy, jumps) {
                        (true, _) => 0.0,
                        (false, false) => UNEVEN,
                        (false, true) => JUMPY,
                    },
                    tip: self.tip(simd, lines.lights, &unseen, jumps),
                };
                let mut start = zero - 1.0;
                for index in 0..=most {
                    let end: f64x8<S> = f64x8::from_array(simd, stops.at(index));
                    let stretch = Stretch {
                        start,
                        end,
                        is_eased,
                        is_bumpy,
                        is_followed,
                    };
                    self.add_stretch(simd, chord, lines, &stretch, noise, &mut sum);
                    start = end;
                }
                if is_bumpy {
                    // What is there without light is not counted here.
                    let albedo = self.scene.world.albedo(self.active.sphere);
                    let constant = albedo * self.scene.ambient;
                    for channel in 0..self.scene.channels {
                        sum.light[channel] -= chord.length() * constant[channel];
                    }
                }
                sum
            },
        )
    }

    fn search<S: Simd>(&self, chord: &Chord<S>, jumps: bool) -> Search {
        /// Cells of the noise that a part may span.
        const MOST_CELLS: f64 = 0.5;
        let (mut looks, mut steps): (usize, u32) = if self.tolerance > FINE {
            (4, 4)
        } else {
            (8, 7)
        };
        if jumps {
            (looks, steps) = (2 * looks, steps + 3);
        }
        if self.active.terminators != Terminators::Anywhere {
            // A chord crosses a terminator twice at most.
            looks = 2;
        }
        let cells = greatest(chord.way_sq()).sqrt() * self.finish.shading_normal.cells();
        let parts = (cells / MOST_CELLS).ceil().clamp(1.0, MOST_PARTS as f64) as usize;
        Search {
            parts,
            looks: looks.div_ceil(parts).max(2),
            steps,
        }
    }

    /// Whether chords span so few cells of the noise that they are looked at where these meet.
    fn is_followed(&self, search: &Search) -> bool {
        /// Parts of half a cell.
        const MOST: usize = 4;
        let [exponent, _] = self.finish.reflectance.exponents();
        search.parts <= MOST && exponent >= 1.0 && !self.scene.has_near_lights
    }

    /// The light where a surface turns to lights by so much between lines that it averts itself on, and beyond the
    /// outermost of them.
    #[inline(never)]
    fn tip<S: Simd>(&self, simd: S, lights: u64, unseen: &Unseen, jumps: bool) -> f64 {
        /// The area of a corner behind the outermost line, over that of what lies between lines: it is a tenth as high.
        /// Four times as much, as it may be wider than it is high.
        const OF_ENDS: f64 = 0.04;
        let light = |beyond: f64| self.light_beyond(simd, lights, beyond, jumps);
        light(unseen.between) + OF_ENDS * light(unseen.at_ends)
    }

    /// The light where a surface faces lights by so much, or no light where it does not face them.
    fn light_beyond<S: Simd>(&self, simd: S, lights: u64, beyond: f64, jumps: bool) -> f64 {
        if beyond <= 0.0 {
            return 0.0;
        }
        let reflectance = &self.finish.reflectance;
        let power = simd.vectorize(
            #[inline(always)]
            || {
                reflectance
                    .diffuse
                    .of_clamped(f64x8::splat(simd, beyond.min(1.0)))[0]
            },
        );
        let mut light = 0.0;
        for index in set_bits(lights) {
            let [diffuse, highlight] = reflectance.brightest(self.scene.lights[index].intensity);
            light += diffuse * power + if jumps { highlight } else { 0.0 };
        }
        light
    }

    /// Finds where the chords are to be divided; whether all of them begin alike and are so at like places, and how far
    /// n·l may go beyond zero where no chord is.
    #[inline(always)]
    fn find<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        search: &Search,
        stops: &mut Stops,
        noise: &mut Noise,
    ) -> (bool, Unseen) {
        let count = search.parts * search.looks;
        for part in 1..search.parts {
            let at = 2.0 * part as f64 / search.parts as f64 - 1.0;
            for lane in 0..8 {
                stops.note(lane, at);
            }
        }
        let nothing = Look {
            sigma: lines.y * 0.0,
            value: f64x8::splat(simd, f64::NAN),
        };
        let kinds = if self.finish.has_blunt_highlight() {
            2
        } else {
            1
        };
        let mut looks = [[[nothing; 2]; MOST_LIGHTS]; 2];
        let mut unseen = Unseen::default();
        let mut is_alike = true;
        stops.samples += 8 * (count + 1) as u64;
        for index in 0..=count {
            let at = 2.0 * index as f64 / count as f64 - 1.0;
            let sigma = f64x8::splat(simd, at);
            let (points, normal) = self.normal_at(simd, chord, lines, sigma, noise);
            for (light, in_camera) in self.scene.lights.iter().enumerate() {
                if lines.lights >> light & 1 == 0 {
                    continue;
                }
                for (kind, looks) in looks.iter_mut().enumerate().take(kinds) {
                    let turn = Turn {
                        toward: in_camera.toward,
                        near: in_camera.near,
                        of_spot: kind == 1,
                    };
                    let value = turn.value(&normal, &points);
                    let here = Look { sigma, value };
                    if index == 0 {
                        // Where chords cease to begin in the dark.
                        let below = value.simd_lt(0.0).to_bitmask();
                        is_alike &= below == 0 || below == 0xff;
                    }
                    unseen.add(&value.into());
                    let seeker = Seeker {
                        sender: self,
                        chord,
                        lines,
                        turn,
                        steps: search.steps,
                    };
                    let [before, last] = looks[light];
                    let turned = (last.value * value).simd_lt(0.0).to_bitmask();
                    seeker.note(simd, turned, &last, &here, stops, noise);
                    if index >= 2 {
                        let three = [before, last, here];
                        seeker.note_dip(simd, &three, stops, noise);
                    }
                    looks[light] = [last, here];
                }
            }
        }
        let mut counts = stops.counts[..NODES].iter();
        let is_even = is_alike && counts.all(|&count| count == stops.counts[0]);
        (is_even, unseen)
    }

    /// The points of chords, and the normals that light is computed with there.
    #[inline(always)]
    pub(super) fn normal_at<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        sigma: f64x8<S>,
        noise: &mut Noise,
    ) -> (Points<S>, Vectors<S>) {
        let (x, _) = chord.at(sigma);
        let points = self.points(simd, x, lines.y);
        let mut normal = [points.normal];
        self.finish.perturb(simd, self.scene, &mut normal, noise);
        (points, normal[0])
    }

    /// Adds the light between two parameters.
    #[inline(never)]
    fn add_stretch<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        stretch: &Stretch<S>,
        noise: &mut Noise,
        sum: &mut Summed<S>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let start = stretch.start;
                let width = (stretch.end - start).max(zero);
                if greatest(width) == 0.0 {
                    return;
                }
                let mut lit = [0; MOST_LIGHTS];
                for (light, lit) in lit.iter_mut().enumerate() {
                    *lit = if lines.lights >> light & 1 == 1 {
                        0xff
                    } else {
                        0
                    };
                }
                let mut points = [Points::nowhere(simd); NODES];
                let mut normals = [points[0].normal; NODES];
                let mut shares = [zero; NODES];
                for node in 0..NODES {
                    let s = RULE.nodes[node];
                    let (at, slope) = if stretch.is_eased {
                        (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s))
                    } else {
                        (s, 1.0)
                    };
                    let (x, there) = chord.at(start + width * at);
                    points[node] = self.points(simd, x, lines.y);
                    normals[node] = points[node].normal;
                    shares[node] = width * there * slope;
                }
                self.finish.perturb(simd, self.scene, &mut normals, noise);
                for (points, normal) in points.iter_mut().zip(&normals) {
                    points.normal = *normal;
                }
                sum.samples += 8 * NODES as u64;
                let (mut apart, mut odd, mut whole) = ([zero; 3], [zero; 3], [zero; 3]);
                let (mut lowest, mut highest) = (zero + f64::INFINITY, zero - f64::INFINITY);
                for node in 0..NODES {
                    let (finish, points) = (self.finish, &points[node]);
                    // Where terminators are edges, highlights go on beyond them.
                    let light = if stretch.is_bumpy {
                        let normal = &normals[node];
                        finish.radiance(simd, self.scene, points, normal, &lit, None)
                    } else {
                        finish.unclamped(simd, self.scene, points, [lines.lights, lines.diffuse])
                    };
                    let (fine, coarse) = (RULE.fine[node], RULE.coarse[node]);
                    let mut gauge = zero;
                    for channel in 0..self.scene.channels {
                        let light = light[channel] * shares[node];
                        whole[channel] += light * fine;
                        apart[channel] += light * (fine - coarse);
                        odd[channel] += light * RULE.odd[node];
                        gauge += light;
                    }
                    lowest = lowest.min(gauge);
                    highest = highest.max(gauge);
                }
                let one = zero + 1.0;
                let spread = highest - lowest;
                let mut largest = zero;
                for channel in 0..self.scene.channels {
                    sum.light[channel] += whole[channel];
                    let odd = odd[channel] * OF_ODD;
                    let difference = (apart[channel] * apart[channel] + odd * odd).sqrt();
                    let ratio = (difference * CAUTION / (spread + f64::MIN_POSITIVE)).min(one);
                    let estimate = (spread * ratio * ratio.sqrt()).min(difference);
                    // The noise has no third derivative where its cells meet.
                    largest = largest.max(if stretch.is_bumpy && !stretch.is_followed {
                        difference
                    } else {
                        estimate
                    });
                }
                sum.doubt += largest;
            },
        )
    }
}
