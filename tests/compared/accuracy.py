"""How far pictures are from the reference, and how long a method takes to an error."""

from dataclasses import dataclass, field
from statistics import median

import numpy as np

# The reference is used where it claims at most this error.
REFERENCE_ERROR = 1e-6
# Of settings measured last, by which the time to a smaller error is extrapolated.
EXTRAPOLATED_FROM = 4
# Nothing is extrapolated to more than so many times the longest measured time.
FARTHEST = 100


@dataclass
class Measured:
    """A setting of a method on a scene."""

    label: str
    rms: float
    largest: float
    times: list[float] = field(default_factory=list)

    @property
    def seconds(self) -> float:
        return median(self.times)


@dataclass(frozen=True)
class Reference:
    picture: np.ndarray
    is_known: np.ndarray

    def errors(self, picture: np.ndarray) -> tuple[float, float]:
        """The root mean square of the errors of all channels of all pixels, and the largest one."""
        errors = np.abs(picture - self.picture)[self.is_known]
        return float(np.sqrt((errors**2).mean())), float(errors.max())

    def alignment(self, picture: np.ndarray) -> tuple[float, float]:
        """By which factor a picture is brighter, and by how many pixels it is moved, in the sense of least squares."""
        down, right, _ = np.gradient(self.picture)
        terms = np.stack([self.picture.ravel(), right.ravel(), down.ravel()], axis=1)
        factor, *shift = np.linalg.lstsq(terms, picture.ravel(), rcond=None)[0]
        return float(factor), float(np.hypot(*shift))


def time_to(goal: float, settings: list[Measured], error: str) -> tuple[float, str] | None:
    """The time of the coarsest setting within an error; `*` where it is extrapolated; None where it is out of reach."""
    for setting in settings:
        if getattr(setting, error) <= goal:
            return setting.seconds, setting.label
    last = settings[-EXTRAPOLATED_FROM:]
    errors = np.log([getattr(setting, error) for setting in last])
    times = np.log([setting.seconds for setting in last])
    if len(last) < EXTRAPOLATED_FROM:
        return None
    slope = -np.polyfit(times, errors, 1)[0]
    missing = errors[-1] - np.log(goal)
    if slope <= 0 or missing > slope * np.log(FARTHEST):
        return None
    return float(np.exp(times[-1] + missing / slope)), "\\*"
