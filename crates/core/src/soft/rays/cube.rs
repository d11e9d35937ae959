//! Directions, sorted by the cells of a cube around their origin.

use glam::{DVec3, Vec3};

/// Cells along an edge of the cube.
const SIDE: usize = 8;

/// The cells of all faces: face by face, row by row.
pub(super) const CELLS: usize = 6 * SIDE * SIDE;

/// What single precision may move a direction by, in halves of an edge.
const SLACK: f64 = 1e-6;

/// The axis across a pair of faces, and those along their rows and columns.
const AXES: [[usize; 3]; 3] = [[0, 1, 2], [1, 0, 2], [2, 0, 1]];

/// The cell of a direction.
#[inline]
pub(super) fn cell_of(direction: Vec3) -> usize {
    const HALF: f32 = 0.5 * SIDE as f32;
    let Vec3 { x, y, z } = direction;
    let (wide, tall, deep) = (x.abs(), y.abs(), z.abs());
    let (pair, across, along, down) = if wide >= tall && wide >= deep {
        (0, x, y, z)
    } else if tall >= deep {
        (1, y, x, z)
    } else {
        (2, z, x, y)
    };
    let face = 2 * pair + usize::from(across < 0.0);
    let scale = HALF / across.abs();
    let place = |part: f32| ((part * scale + HALF) as usize).min(SIDE - 1);
    (face * SIDE + place(down)) * SIDE + place(along)
}

/// Calls `visit` with all cells that have directions within an angle of an axis, and perhaps with some others. The angle is at
/// most a right one, and has this sine.
pub(super) fn for_each_within(axis: DVec3, sine: f64, mut visit: impl FnMut(usize)) {
    for face in 0..6 {
        let [across, along, down] = AXES[face / 2];
        let sign = if face % 2 == 0 { 1.0 } else { -1.0 };
        let forward = sign * axis[across];
        let Some(cols) = places(axis[along], forward, sine) else {
            continue;
        };
        let Some(rows) = places(axis[down], forward, sine) else {
            continue;
        };
        for row in rows[0]..=rows[1] {
            let first = (face * SIDE + row) * SIDE;
            for col in cols[0]..=cols[1] {
                visit(first + col);
            }
        }
    }
}

/// The first and the last line of cells of a face that a cone may reach into, whose axis has these coordinates along the face
/// and toward it.
///
/// On the plane of both coordinates the cone fills the angles around that of its axis up to one whose sine is `sine` over the
/// axis' length there.
fn places(aside: f64, forward: f64, sine: f64) -> Option<[usize; 2]> {
    let length = (aside * aside + forward * forward).sqrt();
    let (mut low, mut high) = (-1.0, 1.0);
    if length > sine {
        let sine = sine / length;
        let cosine = (1.0 - sine * sine).sqrt();
        // Mirrored so that the axis is on the positive side.
        let (x, z) = (aside.abs() / length, forward / length);
        let end = |sine: f64| (x * cosine + z * sine, z * cosine - x * sine);
        let (near, far) = (end(-sine), end(sine));
        if near.1 <= 0.0 {
            return None;
        }
        low = near.0 / near.1;
        // Beyond a right angle it is outside of the face.
        if far.1 > 0.0 && far.0 >= 0.0 {
            high = far.0 / far.1;
        }
        if aside < 0.0 {
            (low, high) = (-high, -low);
        }
    }
    let (low, high) = (low - SLACK, high + SLACK);
    if low > 1.0 || high < -1.0 {
        return None;
    }
    let place = |at: f64| ((at.clamp(-1.0, 1.0) + 1.0) * 0.5 * SIDE as f64) as usize;
    Some([place(low).min(SIDE - 1), place(high).min(SIDE - 1)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_all_directions_of_a_cone_are_visited() {
        let direction = |number: u32| {
            let height = 1.0 - (2.0 * f64::from(number) + 1.0) / 1000.0;
            let (turn, across) = (2.4 * f64::from(number), (1.0 - height * height).sqrt());
            DVec3::new(across * libm::cos(turn), height, across * libm::sin(turn))
        };
        let mut visits = 0;
        for axis in (0..1000).step_by(7).map(direction) {
            for angle in [0.01, 0.1, 0.4, 1.0, 1.5, std::f64::consts::FRAC_PI_2] {
                let mut visited = [false; CELLS];
                for_each_within(axis, libm::sin(angle), |cell| {
                    assert!(!visited[cell]);
                    visited[cell] = true;
                    visits += u32::from(angle == 0.1);
                });
                let inside = (0..1000).map(direction);
                for other in inside.filter(|other| other.dot(axis) >= libm::cos(angle)) {
                    let cell = cell_of(other.as_vec3());
                    assert!(visited[cell], "{axis} {angle} {other}");
                }
            }
        }
        // A cone of 0.1 has some 2 cells' worth of directions, and touches some more.
        assert!(visits < 143 * 10, "{visits}");
    }
}
