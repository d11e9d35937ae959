//! Decides exactly whether rays meet a sphere, and prints the distances: those of rays that touch it, or nearly so.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use std::error::Error;

use marbles_core::glam::DVec3;
use marbles_core::{Ray, Sphere};

fn main() -> Result<(), Box<dyn Error>> {
    let sphere = Sphere::new(DVec3::new(0.0, 0.0, 1e6), 1.0)?;
    for height in [0.0, 0.5, 1.0_f64.next_down(), 1.0, 1.0_f64.next_up()] {
        let ray = Ray {
            origin: DVec3::new(0.0, height, 0.0),
            direction: DVec3::Z,
        };
        match sphere.hit(&ray) {
            Some(hit) => println!("{height:.17}: hit at {:.9}", hit.t),
            None => println!("{height:.17}: miss"),
        }
    }
    Ok(())
}
