//! Whether there is memory for what is on its way to files, asked before it is needed: where there
//! is none, allocating ends the process without a word.

use marbles_core::{BAND_ROWS, Channels, View, World};

use crate::base::failure::Failure;
use crate::base::region::Region;
use crate::commands::args::Size;
use crate::formats::Coder;

/// What threads and all that is small may take: glibc reserves this many addresses for a thread
/// that allocates, though it uses few of them.
const SMALL_THINGS: u64 = 1 << 27;

/// What strips between rendering and file may take together, where two of them do not take more:
/// enough to keep many threads busy with wide pictures, and whole pictures of common sizes.
const STRIPS: u64 = 1 << 29;

/// What a thread renders at a time takes less.
const PART: u64 = 1 << 20;

/// The pictures of a sequence, all of the same form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) channels: Channels,
    pub(crate) alpha: bool,
    /// Where this lies in a larger picture; `None` for a whole one.
    pub(crate) part: Option<Region>,
}

impl Form {
    /// Of a sequence without pictures.
    pub(crate) const EMPTY: Self = Self {
        width: 1,
        height: 1,
        channels: Channels::Grey,
        alpha: false,
        part: None,
    };

    /// What `view` of a world is rendered as.
    pub(crate) fn of(view: &View, world: &World, alpha: bool) -> Self {
        Self {
            width: view.width,
            height: view.height,
            channels: Channels::of(world, alpha),
            alpha,
            part: None,
        }
    }

    /// A part of such a picture.
    pub(crate) fn cut(self, region: Region) -> Self {
        Self {
            width: region.window.width,
            height: region.window.height,
            part: (!region.is_all()).then_some(region),
            ..self
        }
    }

    /// Where the first pixel lies in the whole picture: its column and row.
    pub(crate) fn origin(&self) -> (u32, u32) {
        let window = self.part.map(|part| part.window);
        window.map_or((0, 0), |window| (window.col, window.row))
    }

    /// Number of pixels.
    pub(crate) fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Bytes of one of core's pictures as a whole: the channels and the error in double precision,
    /// what stands behind it, and the status.
    fn picture_bytes(&self) -> u64 {
        let colors = match self.channels {
            Channels::Grey => 1,
            Channels::Rgb => 3,
        };
        self.pixels() * (8 * (colors + u64::from(self.alpha) + 1) + 2)
    }

    /// Bytes of the lists of what is seen in which tile, where few spheres are.
    fn list_bytes(&self) -> u64 {
        let tiles = |pixels: u32| u64::from(pixels.div_ceil(BAND_ROWS));
        let Size { width, height } = self.part.map_or(
            Size {
                width: self.width,
                height: self.height,
            },
            |part| part.whole,
        );
        4 * tiles(width) * tiles(height)
    }
}

/// How many strips may be between rendering and file: as many as are useful, or as there is memory
/// for, at least 2.
///
/// All of it is asked for in one piece: systems that promise more than they have still refuse
/// a piece that is larger than all they have.
pub(crate) fn strips_at_a_time(form: &Form, coder: &Coder, threads: usize) -> Result<u64, Failure> {
    const LEAST: u64 = 2;
    let strip = coder.strip_bytes();
    let others = form.list_bytes() + threads as u64 * PART + SMALL_THINGS;
    let bytes = |strips: u64| strips.saturating_mul(strip).saturating_add(others);
    let mut strips = (STRIPS / strip.max(1)).max(LEAST);
    while !can_reserve(bytes(strips)) {
        if strips == LEAST {
            let Form { width, height, .. } = form;
            let gigabytes = bytes(LEAST) as f64 / 1e9;
            return Err(Failure::Work(format!(
                "rendering and writing a picture of {width} x {height} pixels needs \
                 {gigabytes:.1} GB of memory, more than there is"
            )));
        }
        strips = (strips / 2).max(LEAST);
    }
    Ok(strips)
}

/// Refuses pictures for which there is no memory, so many at a time.
pub(crate) fn check_pictures(form: &Form, count: u64) -> Result<(), Failure> {
    let bytes = count * form.picture_bytes() + SMALL_THINGS;
    if can_reserve(bytes) {
        return Ok(());
    }
    let Form { width, height, .. } = form;
    Err(Failure::Work(format!(
        "{count} pictures of {width} x {height} pixels need {:.1} GB of memory, more than there is",
        bytes as f64 / 1e9
    )))
}

fn can_reserve(bytes: u64) -> bool {
    usize::try_from(bytes).is_ok_and(|bytes| reserve::<u8>(bytes).is_ok())
}

/// An empty vector with room for `count` values.
pub(crate) fn reserve<T>(count: usize) -> Result<Vec<T>, String> {
    let mut values = Vec::new();
    match values.try_reserve_exact(count) {
        Ok(()) => Ok(values),
        Err(_) => Err(format!(
            "there is no memory for {:.1} MB",
            count as f64 * size_of::<T>() as f64 / 1e6
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{Encoding, ExrOptions, PngOptions};

    fn form(width: u32, height: u32) -> Form {
        Form {
            width,
            height,
            channels: Channels::Rgb,
            alpha: true,
            part: None,
        }
    }

    const PNG: Encoding = Encoding::Png(PngOptions {
        deep: true,
        rgb: true,
    });
    const EXR: Encoding = Encoding::Exr(ExrOptions {
        float: true,
        error: true,
    });

    /// What is planned for a picture; `None` where there is no memory.
    fn strips(encoding: Encoding, form: &Form) -> Option<u64> {
        strips_at_a_time(form, &Coder::new(encoding, *form), 2).ok()
    }

    #[test]
    fn the_height_of_a_picture_costs_no_strips() {
        for encoding in [PNG, EXR] {
            let [low, high] = [9, 1 << 20].map(|height| form(600, height));
            // The lower one has no whole strip of an EXR file.
            assert!(strips(encoding, &high) > Some(2));
            assert!(strips(encoding, &low) >= strips(encoding, &high));
        }
    }

    #[test]
    fn large_pictures_have_room_in_a_gigabyte() {
        const THREADS: usize = 64;
        let form = form(1 << 15, 1 << 15);
        for encoding in [PNG, EXR] {
            let coder = Coder::new(encoding, form);
            let strips = strips_at_a_time(&form, &coder, THREADS).unwrap();
            let bytes = strips * coder.strip_bytes() + form.list_bytes() + THREADS as u64 * PART;
            assert!(bytes + SMALL_THINGS < 1 << 30, "{bytes}");
        }
    }

    #[test]
    fn the_widest_pictures_do_not_fit() {
        // Wider than scenes allow.
        let form = form(u32::MAX, 1 << 31);
        let failure = strips_at_a_time(&form, &Coder::new(EXR, form), 2).unwrap_err();
        let Failure::Work(message) = failure else {
            panic!("{failure:?}");
        };
        assert!(message.ends_with("GB of memory, more than there is"));
    }

    #[test]
    fn whole_pictures_are_refused_where_they_do_not_fit() {
        assert!(check_pictures(&form(9, 9), 3).is_ok());
        assert!(check_pictures(&form(1 << 26, 1 << 26), 3).is_err());
    }
}
