"""Error over CPU seconds: what each setting has, errors at equal time, times at equal error.

Between two settings nothing is known, so a method has at a time what its settings done by then have. Only where two neighbours
differ in nothing but one parameter of work (more photons, say) is there a setting for each time between: a power law joins them.
"""
import functools
import math
import statistics

import numpy as np

from duel.ranges import RESAMPLES, Range, draws
from report.curves import along

STEP = 0.9  # a front takes what is at least 10 % better
WORK = ("photons", "paths", "emitted", "light_samples", "mesh_resolution", "passes")  # of the settings' parameters
SLACK = 1.05  # a setting is done at a time that it takes at most so much longer than: CPU times scatter


class Cell:
    """A setting's trials, one a seed: CPU seconds, bytes and squared errors; `noise` is the truth's own squared error.

    Arrays run over draws of seeds: 0 is all of them as they are. An error that the truth hides lies between `low`, 0, and `high`.
    """

    def __init__(self, setting, rows, plain=False):
        """By relmse, or `plain` by rmse over the truth's mean."""
        self.setting, self.label, self.rows = setting, setting.label, rows
        self.work = np.array([row["build_s"] + row["query_s"] for row in rows])
        square = lambda row, name: (row[f"rmse{name}"] / row["mean"]) ** 2 if plain else row[f"relmse{name}"]
        self.squares = np.array([square(row, "") for row in rows])
        self.noise = square(rows[0], "_noise")
        picks = draws(len(rows), rows[0].get("scene", ""))
        self.times = np.median(self.work[picks], axis=1)
        squares = self.squares[picks].mean(axis=1)
        self.high = error_of(squares, self.noise)
        self.low = np.where(squares - self.noise < self.noise / 4, 0.0, self.high)

    def seconds(self):
        return float(self.times[0])

    def error(self):
        return float(self.high[0])

    def raw(self):
        """The error with the truth's own in it: it orders settings where `error` is a bound."""
        return math.sqrt(float(self.squares.mean()))

    def is_bound(self):
        return bool(self.low[0] == 0)

    def is_at_noise(self):
        return self.squares.mean() < 1.25 * self.noise

    def median(self, column):
        return statistics.median(row[column] for row in self.rows)


def error_of(square, noise):
    """The error without the truth's own, of one squared error or of many; what lies within a quarter of the truth's variance cannot be
    separated from it."""
    return np.sqrt(np.maximum(np.maximum(square - noise, noise / 4), 1e-30))


def error_by_truth(error, noise, pixels):
    """The standard error of an error by the truth's own, independent from pixel to pixel: of mean (d^2 + 2 d t + t^2) - noise, halved over
    the error."""
    return math.sqrt((4 * error ** 2 * noise + 2 * noise ** 2) / pixels) / (2 * error)


def front(points):
    """Of (x, error): those that nothing with less x beats, by x."""
    curve = []
    for x, error in sorted(points):
        if not curve or error < curve[-1][1]:
            curve.append((x, error))
    return curve


def chosen(cells, most):
    """The settings that go on from a search: the front, thinned where a step gains under 10 %, its ends kept; at most `most`.
    Among errors that the truth hides, which are equal, the one with the truth's own in it decides."""
    order = sorted(cells, key=lambda cell: (cell.seconds(), cell.error(), cell.raw()))
    kept = []
    for cell in order:
        if not kept or cell.error() < STEP * kept[-1].error() or cell.error() == kept[-1].error() and cell.raw() < kept[-1].raw():
            kept.append(cell)
    while len(kept) > most:
        gain = lambda i, error: math.log(error(kept[i - 1]) / error(kept[i + 1]))
        gains = [(gain(i, lambda cell: cell.error()), gain(i, Cell.raw)) for i in range(1, len(kept) - 1)]
        del kept[1 + gains.index(min(gains))]
    return kept


def at_time(curve, seconds):
    """The error that a power law between all points of a front has by then. None before the first."""
    if not curve or seconds < curve[0][0]:
        return None
    return curve[-1][1] if seconds >= curve[-1][0] else along(curve, seconds)


def at_error(curve, error):
    """The x at which such a front has the error; None where it never has. What has it at once takes its first x."""
    if not curve or error < curve[-1][1]:
        return None
    if error >= curve[0][1]:
        return curve[0][0]
    return along([(e, x) for x, e in curve], error)


def work_of(setting):
    """({parameter of work: value}, all else) of a setting."""
    param = dict(setting.param)
    work = {name: param.pop(name) for name in WORK if name in param}
    return {**work, "spp": setting.spp, "mesh": setting.mesh or 0}, tuple(sorted(param.items()))


def is_pair(a, b):
    """Whether two settings differ in one parameter of work alone."""
    (work, rest), (other, others) = work_of(a), work_of(b)
    return rest == others and work.keys() == other.keys() and sum(work[name] != other[name] for name in work) == 1


def between(x, x0, x1, y0, y1):
    """y at x by a power law from (x0, y0) to (x1, y1), draw by draw; inf outside. A y of 0 on one side is 0 at once."""
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.log(x / x0) / np.log(x1 / x0)
        part = np.where((part >= 0) & (part <= 1), part, np.nan)
        y = np.where((y0 > 0) & (y1 > 0), np.exp(np.log(y0) + part * np.log(y1 / y0)), 0.0)
        return np.where(np.isnan(part), np.inf, y)


def stacked(cells):
    """Times, high and low, setting by setting and draw by draw."""
    return tuple(np.stack([getattr(cell, name) for cell in cells]) for name in ("times", "high", "low"))


def least_way(ways):
    return np.min([*ways, np.full(1, np.inf).repeat(RESAMPLES + 1)], axis=0)


def is_front(places, errors):
    """Whether nothing at a lesser or equal place has less error, setting by setting and draw by draw."""
    return np.stack([~np.any((places <= place) & (errors < error), axis=0) for place, error in zip(places, errors)])


class Field:
    """The cells of one scene of so many pixels; cells that lack seeds which others have are left out."""

    def __init__(self, cells, pixels=math.inf):
        self.seeds = max((len(cell.rows) for cell in cells), default=0)
        self.cells = [cell for cell in cells if len(cell.rows) == self.seeds]
        self.labels = list(dict.fromkeys(cell.label for cell in self.cells))
        self.noise, self.pixels = (self.cells[0].noise if self.cells else 0.0), pixels
        self.limit = math.sqrt(self.noise) / 2  # the least error that the truth can show
        self.own = {label: [cell for cell in self.cells if cell.label == label] for label in self.labels}
        self.joined = {label: neighbours(own) for label, own in self.own.items()}

    def done(self, label, seconds):
        """The settings of a method that are done by then."""
        return [cell for cell in self.own.get(label, []) if cell.seconds() <= seconds * SLACK]

    def last(self, label):
        """CPU seconds of the slowest setting: more time was not measured."""
        return max(cell.seconds() for cell in self.own[label])

    @functools.lru_cache(maxsize=64)  # of all fields together
    def at_time(self, label, seconds):
        """The error's Range by then; None where the method has no setting here. Before the first: no less than that has. High is the least of what is
        done and of what a power law gives; low is the same, or the error of the front's next setting where none is between."""
        own = self.own.get(label, [])
        if not own:
            return None
        times, high, low = stacked(own)
        done = times <= seconds * SLACK
        step, least = (np.min(np.where(done, end, np.inf), axis=0) for end in (high, low))
        way, way_low = (least_way(between(seconds, a.times, b.times, getattr(a, end), getattr(b, end)) for a, b in self.joined[label])
                        for end in ("high", "low"))
        later = np.where(~done & (high < step), times, np.inf)
        following = np.take_along_axis(low, later.argmin(axis=0)[None], axis=0)[0]
        inside = np.where(np.isfinite(later.min(axis=0)), np.minimum(following, least), least)
        is_between = way < step
        most = np.where(is_between, way, step)
        first = np.take_along_axis(low, times.argmin(axis=0)[None], axis=0)[0]
        return Range(np.where(np.isfinite(most), np.where(is_between, way_low, inside), first), most)

    def at_error(self, label, error, x=None):
        """The Range of CPU seconds, or of x(cell), that the error takes; what never has it takes more than the longest. None without a
        setting, or where the error is below what the truth can show of the method. High is the first that has it; low is the same by a power
        law or where it has just that error, else the front's last that has more; what has less at once may take less."""
        own = self.own.get(label, [])
        error = np.asarray(error, float) * (1 + 1e-9)
        if not own or (error.flat[0] < self.limit and any(cell.is_bound() for cell in own)):
            return None
        of = (lambda cell: np.full(cell.times.shape, float(x(cell)))) if x else (lambda cell: cell.times)
        places, high = np.stack([of(cell) for cell in own]), stacked(own)[1]
        step = np.min(np.where(high <= error, places, np.inf), axis=0)
        way = least_way(between(error, a.high, b.high, of(a), of(b)) for a, b in self.joined[label])
        before = np.max(np.where((high > error) & (places < step) & is_front(places, high), places, 0.0), axis=0)
        first = np.minimum(step, way)
        at_it = np.any((places == step) & (high >= error * (1 - 1e-8)), axis=0)  # a setting has just this error
        low = np.where((way <= step) | at_it, first, before)
        return Range(np.where(np.isfinite(first), low, places.max(axis=0)), first)

    def least(self, label):
        """The least error of a method, draw by draw; None without."""
        own = self.own.get(label, [])
        return np.min([cell.high for cell in own], axis=0) if own else None

    def truth_of(self, error):
        """The standard deviation of the logarithm of an error by the truth's own error."""
        return error_by_truth(error, self.noise, self.pixels) / error if self.noise else 0.0

    def front(self, label):
        """The settings that nothing faster beats, fastest first."""
        found = []
        for cell in sorted(self.own.get(label, []), key=Cell.seconds):
            if not found or cell.error() < found[-1].error():
                found.append(cell)
        return found


def neighbours(cells):
    """Pairs of settings that differ in one parameter of work, with none between them."""
    found = []
    for a in cells:
        for b in cells:
            if is_pair(a.setting, b.setting):
                name, low, high = step(a.setting, b.setting)
                steps = [step(a.setting, cell.setting) for cell in cells if is_pair(a.setting, cell.setting)]
                others = [value for other, _, value in steps if other == name]
                if low < high and not any(low < value < high for value in others):
                    found.append((a, b))
    return found


def step(a, b):
    """(name, value of a, value of b) of the parameter of work in which they differ."""
    mine, other = work_of(a)[0], work_of(b)[0]
    return next((name, mine[name], other[name]) for name in mine if mine[name] != other[name])
