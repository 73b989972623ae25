"""Error over CPU seconds: fronts, errors at equal time, times at equal error, and what the seeds say of them.

The interval of a quantity is exp(log value +- t s), s the bootstrap's standard deviation of its logarithm over the seeds times
sqrt(n / (n - 1)), t Student's for n - 1 degrees of freedom: for a mean it is Student's interval, where the plain percentiles of
five seeds cover 84 % instead of 95 %. Seeds are drawn for all settings together, since they share camera samples.
"""
import math
import statistics

import numpy as np

from report.curves import along
from report.intervals import student

RESAMPLES = 400
STEP = 0.9  # a front goes on with what is at least 10 % better


class Cell:
    """A setting's trials: CPU seconds, bytes and squared errors, one a seed; `noise` is the truth's own squared error."""

    def __init__(self, setting, rows):
        self.setting, self.label, self.rows = setting, setting.label, rows
        self.work = np.array([row["build_s"] + row["query_s"] for row in rows])
        self.squares = np.array([row["relmse"] for row in rows])
        self.noise = rows[0]["relmse_noise"]
        self.seeds = [row["seed"] for row in rows]

    def seconds(self, seeds=slice(None)):
        return float(np.median(self.work[seeds]))

    def error(self, seeds=slice(None)):
        return error_of(float(self.squares[seeds].mean()), self.noise)

    def is_at_noise(self):
        return self.squares.mean() < 1.25 * self.noise

    def bytes(self):
        return statistics.median(row["map_bytes"] for row in self.rows)


def error_of(square, noise):
    """The error without the truth's own; what lies within a quarter of the truth's variance is not told apart from it."""
    return math.sqrt(max(square - noise, noise / 4, 1e-30))


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
    """The cells of one scene, whose curves are drawn anew for each draw of seeds."""

    def __init__(self, cells):
        self.cells = cells
        self.labels = list(dict.fromkeys(cell.label for cell in cells))
        self.seeds = min(len(cell.seeds) for cell in cells) if cells else 0

    def curve(self, label, draw=slice(None), x=None):
        own = [cell for cell in self.cells if cell.label == label]
        return front((x(cell, draw) if x else cell.seconds(draw), cell.error(draw)) for cell in own)

    def draws(self):
        """The whole, then resamples of the seeds; the same on every run."""
        yield slice(None)
        random = np.random.default_rng(1996)
        for _ in range(RESAMPLES):
            yield random.integers(0, self.seeds, self.seeds)


def quantity(fields, measure):
    """(value, low, high) of measure(draws by field); None where it cannot be told. Missing resamples widen nothing, they are left out."""
    values = [measure(draw) for draw in zip(*(field.draws() for field in fields))]
    if values[0] is None or not values[0] > 0:
        return None
    return interval(values[0], [value for value in values[1:] if value is not None and value > 0], min(field.seeds for field in fields))


def interval(value, resampled, seeds):
    if seeds < 2 or len(resampled) < 2:
        return value, 0.0, math.inf
    spread = float(np.std(np.log(resampled))) * math.sqrt(seeds / (seeds - 1))
    reach = math.exp(student(seeds - 1) * spread)
    return value, value / reach, value * reach
