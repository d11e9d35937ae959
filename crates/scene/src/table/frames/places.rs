//! The places of frames in a table: one after another, and any of them again.

use std::io;

use super::super::error::TableError;
use super::super::format::Format;
use super::super::npy;
use super::Frames;

/// The place of a frame in a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct FramePlace {
    /// The byte at which it begins, of the decompressed file.
    position: u64,
    /// The lines before it.
    lines: u64,
}

impl Frames<'_> {
    /// Passes over the next frame; returns whether there was one.
    pub(crate) fn skip(&mut self) -> Result<bool, TableError> {
        if !self.may_be_several() {
            return Ok(!std::mem::replace(&mut self.is_at_end, true));
        }
        if self.format == Format::Npy {
            let array = match &self.array {
                Some(array) => array,
                None => self.array.insert(npy::Array::new(&mut self.input)?),
            };
            let is_one = array.skip(&mut self.input)?;
            if !is_one {
                array.check_end(&mut self.input)?;
            }
            return Ok(is_one);
        }
        if let Some(trajectory) = &mut self.trajectory {
            return trajectory.skip(&mut self.input);
        }
        self.open_collection()?;
        if let Some(collection) = &self.collection {
            let is_one = self.input.number < collection.frames();
            self.input.number += u64::from(is_one);
            return Ok(is_one);
        }
        if self.format == Format::Gsd {
            let input = &mut self.input;
            let frames = Self::gsd(&mut self.gsd, input)?.frames;
            let is_one = input.number < frames;
            input.number += u64::from(is_one);
            return Ok(is_one);
        }
        let Some(header) = self.header()? else {
            return Ok(false);
        };
        header.skip(&mut self.input)?;
        self.previous = Some(header);
        Ok(true)
    }

    /// Says whether another frame follows. What follows and is no frame is noted as left out.
    pub(crate) fn has_more(&mut self) -> bool {
        if let Some(array) = &self.array {
            return array.tables > 1;
        }
        if let Some(file) = &self.gsd {
            return self.input.number < file.frames;
        }
        if let Some(collection) = &self.collection {
            return self.input.number < collection.frames();
        }
        if self.is_at_end {
            return false;
        }
        let next = match &mut self.trajectory {
            Some(trajectory) => match trajectory.has_more(&mut self.input) {
                Ok(has_more) => return has_more,
                Err(error) => Err(error),
            },
            None => self.header(),
        };
        match next {
            Ok(next) => self.next = next,
            Err(TableError::Fault(mut fault)) => {
                fault.message = format!("no frame follows the first one here: {}", fault.message);
                self.input.leave_out(fault);
            }
            // What cannot be read is told where the file is read to its end.
            Err(_) => {}
        }
        self.next.is_some()
    }

    /// The place of the next frame, before anything of it was read.
    pub(crate) fn place(&self) -> FramePlace {
        FramePlace {
            position: self.input.position,
            lines: self.input.number,
        }
    }

    /// Continues with the frame at this place, which must not lie before the next one in a compressed file.
    pub(crate) fn go_to(&mut self, place: FramePlace) -> io::Result<()> {
        (self.next, self.is_at_end) = (None, false);
        if self.format == Format::Npy && self.array.is_none() {
            self.array = npy::Array::new(&mut self.input).ok();
        }
        // What is wrong with it is told when it is read.
        let _ = self.open_collection();
        if matches!(self.format, Format::MmCif | Format::Pdb | Format::Vasp) {
            // The columns and the cell are told once, before the first frame.
            match place.lines {
                0 => self.previous = None,
                _ if self.previous.is_none() => self.previous = self.header().ok().flatten(),
                _ => {}
            }
        }
        let is_ahead = place.position > self.input.position;
        if self.format == Format::Xyz && self.previous.is_none() && is_ahead {
            // The first frame decides what numbers of atoms mean.
            self.previous = self.header().ok().flatten();
        }
        // The first table's place is that of the header before it.
        let start = self.array.as_ref().map_or(0, npy::Array::start);
        self.input.skip_to(place.position.max(start), place.lines)
    }
}
