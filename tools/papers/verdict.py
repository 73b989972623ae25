"""Whether a claim holds: the 95 % interval of ours against the region that the claim names."""
import dataclasses
import math
import statistics

HOLDS, FAILS, UNDECIDED, UNMEASURED = "holds", "does not hold", "undecided", "not measured"
LEAST_SAMPLES = 3
CONFIDENCE = 0.95


@dataclasses.dataclass
class Measured:
    """What was measured for a claim: `samples`, one a seed or repeat, of what the claim compares.

    `top` and `bottom` are what a ratio is made of, in `unit`. `counted` values are the same on every run, so one is enough.
    Without samples `note` says why nothing was measured.
    """
    samples: list
    top: list = dataclasses.field(default_factory=list)
    bottom: list = dataclasses.field(default_factory=list)
    unit: str = ""
    counted: bool = False
    note: str = ""
    section: str = ""


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


def interval(samples, is_counted):
    """Ends of the interval that leaves out 5 % on each side, on a scale of ratios where all samples are above 0; None: too few."""
    if is_counted:
        return min(samples), max(samples)
    if len(samples) < LEAST_SAMPLES:
        return None
    logarithmic = min(samples) > 0
    values = [math.log(each) for each in samples] if logarithmic else samples
    from scipy.stats import t  # here, for it takes a second to load

    middle = statistics.fmean(values)
    reach = float(t.ppf(CONFIDENCE, len(values) - 1)) * statistics.stdev(values) / math.sqrt(len(values))
    ends = (middle - reach, middle + reach)
    return tuple(map(math.exp, ends)) if logarithmic else ends


def judge(measured, region):
    """(verdict, interval or None)."""
    if not measured.samples:
        return UNMEASURED, None
    ends = interval(measured.samples, measured.counted)
    if ends is None:
        return UNDECIDED, None
    return compare(ends, region), ends


def compare(ends, region):
    """The verdict on an interval."""
    low, high = region
    if low <= ends[0] and ends[1] <= high:
        return HOLDS
    return FAILS if ends[1] < low or ends[0] > high else UNDECIDED
