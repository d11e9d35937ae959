//! The sky of a scene over time, through keys.

use marbles_core::Sky;

use super::channels::{Keys, PointCurve};
use super::error::{FrameError, FrameFault};
use crate::file::{self, Animation, File, Key};
use crate::text::Placed;
use crate::values::{Color, Point};

/// A sky that keys change.
#[derive(Clone, Debug)]
pub(crate) struct SkyMotion {
    above: PointCurve,
    below: PointCurve,
    up: PointCurve,
}

impl SkyMotion {
    /// The motion of the sky that the file describes, which is `rest` where no key names it. `Some(None)` if no key names it
    /// anywhere, and `None` where a fault was reported.
    pub(crate) fn new(file: &File, rest: Option<Sky>) -> Option<Option<Self>> {
        let animation = file.animation.as_ref().and_then(|one| one.value.as_ref());
        let Some(Animation::Keyframes { keys, .. }) = animation else {
            return Some(None);
        };
        let keys: Vec<&Key> = keys.iter().filter_map(|key| key.value.as_ref()).collect();
        let mut skies = keys.iter().filter(|key| key.sky.is_some()).peekable();
        let (Some(rest), Some(_)) = (rest, skies.peek()) else {
            return Some(None);
        };
        for up in skies.filter_map(|key| up(key)) {
            up.direction()?;
        }
        let keys = Keys(keys);
        let radiance = |rest, half: usize| keys.vectors(rest, |key| Some(radiances(key)?[half]?.0));
        Some(Some(Self {
            above: radiance(rest.above(), 0),
            below: radiance(rest.below(), 1),
            up: keys.vectors(rest.up(), |key| Some(up(key)?.get()?.0)),
        }))
    }

    /// Returns whether the sky has a color in some frame.
    pub(crate) fn may_have_color(&self) -> bool {
        self.above.may_have_color() || self.below.may_have_color()
    }

    /// The sky in a frame.
    pub(crate) fn at(&self, frame: i32) -> Result<Sky, FrameError> {
        let time = f64::from(frame);
        let [above, below, up] = [&self.above, &self.below, &self.up].map(|curve| curve.at(time));
        Sky::in_halves(above, below, up).map_err(|_| FrameError {
            frame,
            fault: FrameFault::SkyNowhere,
        })
    }
}

/// The sky that a key names.
fn sky(key: &Key) -> Option<&file::Sky> {
    key.sky.as_ref()?.value.as_ref()
}

/// The radiances above and below that a key names.
fn radiances(key: &Key) -> Option<[Option<Color>; 2]> {
    Some(match sky(key)? {
        file::Sky::Uniform(radiance) => [Some(*radiance); 2],
        file::Sky::Halves(halves) => [halves.above.get(), halves.below.get()],
    })
}

/// The direction up that a key names.
fn up(key: &Key) -> Option<&Placed<Point>> {
    match sky(key)? {
        file::Sky::Uniform(_) => None,
        file::Sky::Halves(halves) => halves.up.as_ref(),
    }
}
