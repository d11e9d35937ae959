//! Whether there is memory for the pictures of a sequence, asked before it is needed: where there
//! is none, allocating ends the process without a word.

use marbles_core::{Channels, View};

use crate::failure::Failure;
use crate::output::Encoding;

/// What threads and all that is small may take: glibc reserves this many addresses for a thread
/// that allocates, though it uses few of them.
const SMALL_THINGS: u64 = 1 << 27;

/// The pictures of a sequence, all of the same form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) channels: Channels,
    pub(crate) alpha: bool,
}

impl Form {
    /// What `view` is rendered as.
    pub(crate) fn of(view: &View, is_grey: bool, alpha: bool) -> Self {
        Self {
            width: view.width,
            height: view.height,
            channels: if is_grey {
                Channels::Grey
            } else {
                Channels::Rgb
            },
            alpha,
        }
    }

    pub(crate) fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Bytes of one of core's pictures: the channels and the error in double precision, what
    /// stands behind it, and the status.
    fn picture_bytes(&self) -> u64 {
        let colors = match self.channels {
            Channels::Grey => 1,
            Channels::Rgb => 3,
        };
        self.pixels() * (8 * (colors + u64::from(self.alpha) + 1) + 2)
    }

    /// Whether there is memory for so many pictures at a time and the encoding of one.
    ///
    /// All of it is asked for in one piece: systems that promise more than they have still refuse
    /// a piece that is larger than all they have.
    fn fits(&self, pictures: u64, encoding: Encoding) -> bool {
        can_reserve(self.bytes(pictures, encoding))
    }

    fn bytes(&self, pictures: u64, encoding: Encoding) -> u64 {
        pictures * self.picture_bytes() + encoding.memory(self) + SMALL_THINGS
    }
}

/// How many of at most `most` pictures there is memory for, at least `least`.
pub(crate) fn pictures_at_a_time(
    form: &Form,
    encoding: Encoding,
    least: u64,
    most: u64,
) -> Result<u64, Failure> {
    let fitting = (least..=most)
        .rev()
        .find(|&count| form.fits(count, encoding));
    fitting.ok_or_else(|| {
        let Form { width, height, .. } = form;
        let gigabytes = form.bytes(least, encoding) as f64 / 1e9;
        let picture = format!("a picture of {width} x {height} pixels");
        let what = match least {
            1 => format!("rendering and writing {picture}"),
            _ => format!("rendering {picture} while another is written"),
        };
        Failure::Work(format!(
            "{what} needs {gigabytes:.1} GB of memory, more than there is"
        ))
    })
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
    use crate::output::PngOptions;

    const PNG: Encoding = Encoding::Png(PngOptions {
        deep: false,
        rgb: false,
    });

    #[test]
    fn small_pictures_fit_and_the_largest_do_not() {
        let form = |side| Form {
            width: side,
            height: side,
            channels: Channels::Rgb,
            alpha: true,
        };
        assert_eq!(pictures_at_a_time(&form(9), PNG, 2, 3).ok(), Some(3));
        // Larger than scenes allow, and than any address space.
        let failure = pictures_at_a_time(&form(1 << 26), PNG, 2, 3).unwrap_err();
        let Failure::Work(message) = failure else {
            panic!("{failure:?}");
        };
        assert!(message.ends_with("GB of memory, more than there is"));
        assert!(check_pictures(&form(9), 3).is_ok());
        assert!(check_pictures(&form(1 << 26), 3).is_err());
    }
}
