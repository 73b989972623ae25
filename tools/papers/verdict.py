"""Whether a claim holds: the 95 % interval of ours against the region that the claim names."""
import dataclasses
import math
import statistics

from report.intervals import half_interval

HOLDS, FAILS, UNDECIDED, UNMEASURED = "holds", "does not hold", "undecided", "not measured"
BY_CONSTRUCTION, PARTLY = "by construction", "partly"  # what "holds" is called where it cannot fail, and where a part of the claim is not built
LEAST_SAMPLES = 3


@dataclasses.dataclass
class Measured:
    """What was measured for a claim: `samples`, one a seed or repeat, of what the claim compares.

    `top` and `bottom` are what a ratio is made of, in `unit`. `counted` values are the same on every run, so one is enough.
    Without samples `note` says why nothing was measured. `beside` has samples by name that are shown and not judged: times beside
    the counters that decide.
    """
    samples: list
    top: list = dataclasses.field(default_factory=list)
    bottom: list = dataclasses.field(default_factory=list)
    unit: str = ""
    counted: bool = False
    note: str = ""
    section: str = ""
    beside: dict = dataclasses.field(default_factory=dict)


def ratio(top, bottom, unit, **more):
    """Samples of one quantity over those of another, pair by pair."""
    if len(top) != len(bottom):
        raise ValueError(f"{len(top)} values over {len(bottom)}")
    return Measured([a / b for a, b in zip(top, bottom)], list(top), list(bottom), unit, **more)


def pairs(some):
    """Disjoint pairs of what seeds gave: independent samples of what two have in common or differ by."""
    return zip(some[::2], some[1::2])


def in_common(deviations):
    """The mean square that pictures of two seeds have in common, one a disjoint pair: noise of their own cancels."""
    return [float((a * b).mean()) for a, b in pairs(deviations)]


def counted(value, unit="", note=""):
    return Measured([value], unit=unit, counted=True, note=note)


def unmeasured(why):
    return Measured([], note=why)


def interval(samples, is_counted, is_signed=False):
    """Ends of the 95 % interval of the mean; None: too few samples. Counted samples have their range.

    The scale is that of ratios, on which what is never negative scatters evenly. A signed quantity may lie on either side of 0: its
    scale is linear whatever the samples are, for samples that happen to be positive say nothing about the next ones.
    """
    if is_counted:
        return min(samples), max(samples)
    if len(samples) < LEAST_SAMPLES:
        return None
    logarithmic = not is_signed and min(samples) > 0
    values = [math.log(each) for each in samples] if logarithmic else samples
    middle, reach = statistics.fmean(values), half_interval(values)
    ends = (middle - reach, middle + reach)
    return tuple(map(math.exp, ends)) if logarithmic else ends


def judge(measured, region, is_signed=False):
    """(verdict, interval or None)."""
    if not measured.samples:
        return UNMEASURED, None
    ends = interval(measured.samples, measured.counted, is_signed)
    if ends is None:
        return UNDECIDED, None
    return compare(ends, region), ends


def of_claim(verdict, claim):
    """The verdict's word: a claim that cannot fail holds by construction, one of which a part is missing holds partly."""
    if verdict != HOLDS:
        return verdict
    return BY_CONSTRUCTION if "by_construction" in claim else PARTLY if "missing" in claim else HOLDS


def compare(ends, region):
    """The verdict on an interval."""
    low, high = region
    if low <= ends[0] and ends[1] <= high:
        return HOLDS
    return FAILS if ends[1] < low or ends[0] > high else UNDECIDED
