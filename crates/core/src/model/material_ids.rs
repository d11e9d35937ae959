//! The materials of spheres, in little memory.

/// The number of each sphere's material: of the first spheres one by one, then by runs of spheres with the same.
#[derive(Clone, Debug, Default)]
pub(super) struct MaterialIds {
    each: Vec<u32>,
    /// The first sphere of each run, and its material.
    runs: Vec<(usize, u32)>,
    count: usize,
}

/// Fewer spheres make no run of their own: a number is found faster than a run.
const FEWEST: usize = 1024;

impl MaterialIds {
    /// Adds spheres with one material behind those that are there.
    pub(super) fn add(&mut self, count: usize, material: u32) {
        if self.runs.is_empty() && count < FEWEST {
            self.each.resize(self.count + count, material);
        } else if self.runs.last().is_none_or(|run| run.1 != material) {
            self.runs.push((self.count, material));
        }
        self.count += count;
    }

    /// The material of a sphere.
    #[inline]
    pub(super) fn get(&self, sphere: usize) -> u32 {
        match self.each.get(sphere) {
            Some(material) => *material,
            None => self.of_run(sphere),
        }
    }

    fn of_run(&self, sphere: usize) -> u32 {
        assert!(sphere < self.count, "a sphere of this world");
        let after = self.runs.partition_point(|run| run.0 <= sphere);
        self.runs[after - 1].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sphere_keeps_its_material() {
        let mut ids = MaterialIds::default();
        let mut expected = Vec::new();
        let parts = [
            (1, 4),
            (FEWEST - 1, 2),
            (0, 7),
            (FEWEST, 3),
            (5, 3),
            (1, 2),
            (1, 9),
            (3 * FEWEST, 9),
            (2, 0),
        ];
        for (count, material) in parts {
            ids.add(count, material);
            expected.resize(expected.len() + count, material);
        }
        let found: Vec<u32> = (0..expected.len()).map(|sphere| ids.get(sphere)).collect();
        assert_eq!(found, expected);
        assert!(ids.runs.len() < 6);
    }
}
