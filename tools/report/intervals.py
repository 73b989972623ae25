"""What seeds tell: 95 % intervals, and whether one value is above another by more than chance."""
import dataclasses
import math
import statistics

FEWEST_SEEDS = 5  # below, no method is called the best
OUTSIDE = 0.05  # a two-sided interval leaves out so much: the one confidence of the project


@dataclasses.dataclass(frozen=True)
class Answer:
    """A value with the terms of its logarithm's variance, each with its degrees of freedom."""
    value: float
    terms: tuple = ()


def student(degrees, outside=OUTSIDE):
    """Student's t for a two-sided interval that leaves out a share `outside`, half of it on each side."""
    from scipy.special import stdtrit  # here, so that a broken table is named even without SciPy

    return float(stdtrit(degrees, 1 - outside / 2))


def half_interval(values):
    """Half the 95 % interval of the mean; None of one value."""
    if len(values) < 2:
        return None
    return student(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))


def log_variance(values):
    """Of the logarithm of the mean, to first order; 0 for one value, and for zeros, which have no logarithm."""
    mean = statistics.mean(values)
    if len(values) < 2 or mean == 0:
        return 0.0
    return statistics.variance([value / mean for value in values]) / len(values)  # as shares: no square leaves the doubles


def is_worse(mine, best):
    """Whether a value is above another by more than chance, by Welch's t with Satterthwaite's degrees of freedom. All that is
    not 0 is above 0."""
    terms = [(variance, degrees) for variance, degrees in mine.terms + best.terms if variance > 0]
    variance = sum(variance for variance, _ in terms)
    if variance == 0 or best.value == 0:
        return mine.value > best.value
    degrees = variance ** 2 / sum(variance ** 2 / degrees for variance, degrees in terms)
    return math.log(mine.value) - math.log(best.value) > student(degrees) * math.sqrt(variance)
