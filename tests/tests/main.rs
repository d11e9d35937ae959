//! What crosses the crates of marbles: pictures with known pixels, stated bounds measured,
//! refused scenes with their messages.

mod anchored_roughness;
mod averages;
mod budget;
mod claims;
mod closed_forms;
mod crowds;
mod examples;
mod floors;
mod found;
mod geometry;
mod hits;
mod invariance;
mod layers;
mod mutations;
mod parallel;
mod photometric;
mod pictures;
mod point_lights;
mod previews;
mod promise;
mod python;
mod reference;
mod refused;
mod repeatability;
mod shading;
mod shutter;
mod sidecar;
mod strokes;
mod studio;
mod tolerance;
mod truth;
mod turntable;
mod work;
