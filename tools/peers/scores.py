"""What records say: errors over CPU seconds, fronts, and the peers' times over ours at equal error.

A record is one trial. A cell is a setting's trials on the reported seeds: median CPU seconds, and the root of the mean squared error without the
truth's own. Ours is the front over photon map and beam tree together.
"""
import csv
import dataclasses
import statistics

from duel import curves
from peers.contest import OURS

COLUMNS = ("scene", "contestant", "setting", "phase", "seed", "status", "cpu_s", "relmse", "relmse_noise", "mse", "mse_noise", "mean_ratio", "load")
TEXTS = ("scene", "contestant", "setting", "phase", "status")
SEARCH, FINAL, DONE = "search", "final", "done"
RELATIVE, PLAIN = "relmse", "mse"
SECOND = 1.0  # CPU s, the time at which ours sets the error that peers are asked for
UNBIASED = ("mitsuba",)  # at random; the splat is stratified, and gains more


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: value if name in TEXTS or value == "" else float(value) for name, value in row.items()} for row in csv.DictReader(file)]


class Cell:
    def __init__(self, rows, measure):
        self.name, self.setting, self.rows = rows[0]["contestant"], rows[0]["setting"], sorted(rows, key=lambda row: row["seed"])
        self.seconds = statistics.median(row["cpu_s"] for row in rows)
        self.error = error([row[measure] for row in rows], rows[0][f"{measure}_noise"])
        self.range = [error([extreme(row[measure] for row in rows)], rows[0][f"{measure}_noise"]) for extreme in (min, max)]
        self.seconds_range = [extreme(row["cpu_s"] for row in rows) for extreme in (min, max)]
        self.mean_ratio = statistics.fmean(row["mean_ratio"] for row in rows)

    def of_seed(self, index, measure):
        row = self.rows[index]
        return row["cpu_s"], error([row[measure]], row[f"{measure}_noise"])


def error(squares, noise):
    return curves.error_of(statistics.fmean(squares), noise)


def cells(records, scene, phase, measure=RELATIVE):
    groups = {}
    for row in records:
        if row["scene"] == scene and row["phase"] == phase and row["status"] == DONE:
            groups.setdefault((row["contestant"], row["setting"]), []).append(row)
    most = max((len(rows) for rows in groups.values()), default=0)
    return [Cell(rows, measure) for rows in groups.values() if len(rows) == most]


def chosen(found, keep):
    thinned = lambda own: curves.chosen([_Point(cell.seconds, cell.error, cell.setting) for cell in own], keep)
    return {point.setting for point in thinned(found)}


@dataclasses.dataclass
class _Point:
    x: float
    y: float
    setting: str

    def seconds(self):
        return self.x

    def error(self):
        return self.y


def curve(found, names, index=None, measure=RELATIVE):
    """The front of some contestants: of the cells, or of one seed's trials."""
    points = [(cell.seconds, cell.error) if index is None else cell.of_seed(index, measure) for cell in found if cell.name in names]
    return curves.front(points)


@dataclasses.dataclass
class Ratio:
    """The peer's CPU seconds over ours at an error. `kind`: measured; bound (the peer never got there: at least its longest time); law (its own
    error over time, unbiased, drawn on)."""
    value: float
    at: float
    kind: str = "measured"
    low: float = 0.0
    high: float = 0.0


def common(ours, peer):
    """At the least error that both reach; None without curves."""
    if not ours or not peer:
        return None
    goal = max(ours[-1][1], peer[-1][1]) * (1 + 1e-9)
    return Ratio(curves.at_error(peer, goal) / curves.at_error(ours, goal), goal)


def after_a_second(ours, peer):
    """At the error that ours has after SECOND: a bound where the peer never has it."""
    goal = curves.at_time(ours, SECOND)
    if goal is None or not peer:
        return None
    mine, theirs = curves.at_error(ours, goal * (1 + 1e-9)), curves.at_error(peer, goal)
    return Ratio((theirs or peer[-1][0]) / mine, goal, "measured" if theirs else "bound")


def by_law(ours, peer):
    """The same, where the peer's squared error falls as one over its work: seconds = start + work / error², through its ends."""
    goal = curves.at_time(ours, SECOND)
    if goal is None or len(peer) < 2 or goal >= peer[-1][1]:
        return None
    (first, e0), (last, e1) = peer[0], peer[-1]
    work = (last - first) / (e1 ** -2 - e0 ** -2)
    return Ratio((last + work * (goal ** -2 - e1 ** -2)) / curves.at_error(ours, goal * (1 + 1e-9)), goal, "law")


def with_range(measured, found, peer, measure=RELATIVE):
    """A ratio of the cells, with the least and the greatest of the seeds taken one by one."""
    whole = measured(curve(found, OURS), curve(found, (peer,)))
    if whole is None:
        return None
    seeds = min(len(cell.rows) for cell in found)
    own = [measured(curve(found, OURS, i, measure), curve(found, (peer,), i, measure)) for i in range(seeds)]
    values = [each.value for each in own if each is not None] or [whole.value]
    return dataclasses.replace(whole, low=min(values), high=max(values))


def verdict(mark, ratios, limits):
    """(scenes that reach a mark at the least common error, scenes that reach it only at smaller errors by a bound)."""
    sure = [name for name in mark["among"] if ratios.get((name, mark["peer"])) and ratios[name, mark["peer"]].value >= mark["least"]]
    beyond = [name for name in mark["among"] if name not in sure and limits.get((name, mark["peer"])) and limits[name, mark["peer"]].value >= mark["least"]]
    return sure, beyond
