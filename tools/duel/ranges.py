"""Values over draws of seeds that may be bounds, and the 95 % intervals of their ratios.

The interval of a ratio is exp(log value +- t s): s² is the bootstrap's variance of its logarithm over the seeds times n / (n - 1),
plus that which the truth's own error gives it; t is Student's for n - 1 degrees of freedom. For a mean it is Student's interval,
which the bootstrap's plain percentiles of so few seeds are far narrower than. Of a value that is known within ends each has its own s.
"""
import dataclasses
import functools
import math
import zlib

import numpy as np

from papers.words import short
from report.intervals import OUTSIDE, student

RESAMPLES = 2000
ROUNDING = 1e-20  # variances of logarithms that are none
TRUTHS = 10  # a difference has to be so many times what the truth's own error makes of it


@functools.cache
def draws(seeds, stream=""):
    """RESAMPLES + 1 rows of seeds' numbers: all of them, then draws with replacement. The same on every run; each stream has its own."""
    random = np.random.default_rng([1996, zlib.crc32(stream.encode())])
    return np.vstack([np.arange(seeds), random.integers(0, seeds, (RESAMPLES, seeds))])


class Range:
    """What a value lies between, draw by draw; `point` is the value where it is known, else the end that is. Nothing known: 0 to inf."""

    def __init__(self, low, high):
        self.low, self.high = (np.broadcast_to(np.asarray(end, float), (RESAMPLES + 1,)) for end in (low, high))
        self.point = np.where(np.isfinite(self.high), self.high, self.low)

    def __truediv__(self, other):
        with np.errstate(divide="ignore", invalid="ignore"):
            low, high = self.low / other.high, self.high / other.low
            made = Range(np.nan_to_num(low, nan=0.0, posinf=np.inf), np.where(np.isnan(high), np.inf, high))
            made.point = self.point / other.point
        return made

    def is_known(self):
        """Whether anything is, of all seeds."""
        return bool(self.point[0] > 0 and np.isfinite(self.point[0]))

    def is_reached(self):
        """Whether all seeds together have it."""
        return bool(np.isfinite(self.high[0]))


def least(ranges):
    """The least of several, draw by draw."""
    ranges = list(ranges)
    return Range(np.min([each.low for each in ranges], axis=0), np.min([each.high for each in ranges], axis=0))


def middle(ranges):
    """Their median, draw by draw: of a bound that is known to be on one side, that side is all that counts."""
    made = Range(np.median([each.low for each in ranges], axis=0), np.median([each.high for each in ranges], axis=0))
    made.point = np.median([each.point for each in ranges], axis=0)
    return made


@dataclasses.dataclass(frozen=True)
class Found:
    """A ratio of all seeds with what makes its interval: the ends of what it lies between, 0 or inf where nothing bounds it, and the
    standard deviation of each end's logarithm."""
    value: float
    low: float
    high: float
    spreads: tuple
    degrees: int
    truth: float = 0.0  # the standard deviation of its logarithm by the truth's own error

    @classmethod
    def exact(cls, value, spread, degrees):
        return cls(value, value, value, (spread, spread), degrees)

    def ends(self, outside=OUTSIDE):
        below, above = (math.exp(min(student(self.degrees, outside) * spread, 500.0)) if spread else 1.0 for spread in self.spreads)
        return self.low / below, self.high * above

    def is_hidden(self, place=1.0):
        """Whether the truth's own error hides on which side of a place it lies: its distance is below TRUTHS times what the truth makes of it."""
        if place <= 0 or not math.isfinite(place) or self.low <= place <= self.high:
            return False
        near = self.low if self.low > place else self.high
        return abs(math.log(near / place)) < TRUTHS * self.truth

    def is_tie(self):
        low, high = self.ends()
        return low <= 1 <= high

    def text(self):
        return words(self.value, *self.ends())


def words(value, low, high):
    """A value with its interval, or as a bound."""
    if low == high or (0 < low and high < math.inf and short(low) == short(high)):
        return short(value)
    if low == 0 and high == math.inf:
        return "not known"
    if high == math.inf:
        return f"> {short(low)}"
    if low == 0:
        return f"< {short(high)}"
    return f"{short(value)} ({short(low)} to {short(high)})"


def estimate(ratio, seeds, truth=0.0):
    """The Found of a Range; None where nothing is known of it. A draw in which an end is open counts: where they are more than
    OUTSIDE / 2, it is open."""
    if ratio is None or not ratio.is_known():
        return None
    ends, spreads = [], []
    for drawn, open_end in ((ratio.low, 0.0), (ratio.high, math.inf)):
        closed = drawn[1:][np.isfinite(drawn[1:]) & (drawn[1:] > 0)]
        is_open = seeds < 2 or drawn[0] == open_end or len(closed) < (1 - OUTSIDE / 2) * RESAMPLES
        ends.append(open_end if is_open else float(drawn[0]))
        own = 0.0 if is_open else float(np.log(closed).var()) * seeds / (seeds - 1)
        spreads.append(0.0 if is_open else math.sqrt((own if own > ROUNDING else 0.0) + truth ** 2))
    return Found(float(ratio.point[0]), *ends, tuple(spreads), seeds - 1, truth)
