//! The columns of image flags: the cells by which particles have left the first one.
//!
//! # Source
//! The documentation of LAMMPS, `dump custom`.

use super::plan::Plan;
use super::slot::Slot;

impl Plan {
    /// Uses the columns of image flags.
    pub(super) fn take_images(&mut self) -> Result<(), String> {
        for axis in 0..3 {
            let slot = Slot::Image(axis);
            if self.names.find_slot(slot).is_none() {
                let name = slot.names()[0];
                let names = self.names.list();
                let hint = match self.names.find("xu") {
                    Some(_) => {
                        " (`columns: (x: \"xu\", y: \"yu\", z: \"zu\")` uses positions that are unwrapped)"
                    }
                    None => "",
                };
                return Err(format!(
                    "expected image flags in the columns `ix`, `iy` and `iz` for `unwrap`, found no `{name}` among {names}{hint}"
                ));
            }
            self.take(slot, None)?;
        }
        Ok(())
    }
}
