"""Error over CPU seconds: fronts, errors at equal time, times at equal error, and what the seeds say of them.

The interval of a quantity is exp(log value +- t s), s the bootstrap's standard deviation of its logarithm over the seeds times
sqrt(n / (n - 1)), t Student's for n - 1 degrees of freedom: for a mean it is Student's interval, which the bootstrap's plain
percentiles of so few seeds are far narrower than. Seeds are drawn for all settings together, since they share camera samples.
"""
import functools
import math
import statistics

import numpy as np

from report.curves import along
from report.intervals import student

RESAMPLES = 200
STEP = 0.9  # a front goes on with what is at least 10 % better


class Cell:
    """A setting's trials, one a seed: CPU seconds, bytes and squared errors; `noise` is the truth's own squared error.

    `draw` numbers the draws of seeds: 0 is all of them as they are.
    """

    def __init__(self, setting, rows, plain=False):
        """By relmse, or `plain` by rmse over the truth's mean."""
        self.setting, self.label, self.rows = setting, setting.label, rows
        self.work = np.array([row["build_s"] + row["query_s"] for row in rows])
        square = lambda row, name: (row[f"rmse{name}"] / row["mean"]) ** 2 if plain else row[f"relmse{name}"]
        self.squares = np.array([square(row, "") for row in rows])
        self.noise = square(rows[0], "_noise")
        picks = draws(len(rows))
        self.medians = np.median(self.work[picks], axis=1).tolist()
        self.errors = [error_of(square, self.noise) for square in self.squares[picks].mean(axis=1).tolist()]

    def seconds(self, draw=0):
        return self.medians[draw]

    def error(self, draw=0):
        return self.errors[draw]

    def is_at_noise(self):
        return self.squares.mean() < 1.25 * self.noise

    def median(self, column):
        return statistics.median(row[column] for row in self.rows)


@functools.cache
def draws(seeds):
    """RESAMPLES + 1 rows of seeds' numbers: all of them, then draws with replacement; the same on every run."""
    return np.vstack([np.arange(seeds), np.random.default_rng(1996).integers(0, seeds, (RESAMPLES, seeds))])


def error_of(square, noise):
    """The error without the truth's own; what lies within a quarter of the truth's variance is not told apart from it."""
    return math.sqrt(max(square - noise, noise / 4, 1e-30))


def error_by_truth(error, noise, pixels):
    """The standard error of an error by the truth's own, independent from pixel to pixel: of mean (d^2 + 2 d t + t^2) - noise, halved over the error."""
    return math.sqrt((4 * error ** 2 * noise + 2 * noise ** 2) / pixels) / (2 * error)


def front(points):
    """Of (x, error): those that nothing with less x beats, by x."""
    curve = []
    for x, error in sorted(points):
        if not curve or error < curve[-1][1]:
            curve.append((x, error))
    return curve


def chosen(cells, most):
    """The settings that go on from a search: the front, thinned where a step gains under 10 %, its ends kept; at most `most`."""
    order = sorted(cells, key=lambda cell: (cell.seconds(), cell.error()))
    kept = []
    for cell in order:
        if not kept or cell.error() < STEP * kept[-1].error():
            kept.append(cell)
    while len(kept) > most:
        gains = [math.log(kept[i - 1].error() / kept[i + 1].error()) for i in range(1, len(kept) - 1)]
        del kept[1 + gains.index(min(gains))]
    return kept


def at_time(curve, seconds):
    """The error reached by then; more time than was measured does no harm. None before the first."""
    if not curve or seconds < curve[0][0]:
        return None
    return curve[-1][1] if seconds >= curve[-1][0] else along(curve, seconds)


def at_error(curve, error):
    """The x at which the error is reached; None where it never is. What has it at once takes its first x."""
    if not curve or error < curve[-1][1]:
        return None
    if error >= curve[0][1]:
        return curve[0][0]
    return along([(e, x) for x, e in curve], error)


class Field:
    """The cells of one scene; cells that lack seeds which others have are left out."""

    def __init__(self, cells):
        self.seeds = max((len(cell.rows) for cell in cells), default=0)
        self.cells = [cell for cell in cells if len(cell.rows) == self.seeds]
        self.labels = list(dict.fromkeys(cell.label for cell in self.cells))

    def curve(self, label, draw=0, x=None):
        """The front of a method, over CPU seconds or over x(cell)."""
        return front((x(cell) if x else cell.seconds(draw), cell.error(draw)) for cell in self.cells if cell.label == label)


def quantity(seeds, measure):
    """(value, low, high) of measure(draw); None where it cannot be told. Draws in which it cannot are left out."""
    value = measure(0)
    if value is None or not value > 0:
        return None
    others = [measure(draw) for draw in range(1, RESAMPLES + 1)]
    return interval(value, [other for other in others if other is not None and other > 0], seeds)


def interval(value, resampled, seeds):
    if seeds < 2 or len(resampled) < RESAMPLES // 2:
        return value, 0.0, math.inf
    spread = float(np.std(np.log(resampled))) * math.sqrt(seeds / (seeds - 1))
    reach = math.exp(student(seeds - 1) * spread)
    return value, value / reach, value * reach
