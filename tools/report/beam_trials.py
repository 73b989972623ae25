"""What the sweeps beam_*.json measured: counters of records, CPU times, costs a point, and fitted exponents."""
import dataclasses
import json
import math
import os

from report import records


@dataclasses.dataclass
class Measured:
    """One cell of a sweep: its parameters, its counters, and the spread of its CPU times by phase [s]."""
    scene: str
    method: str
    parameters: dict
    counters: dict
    bytes: int
    cpu: dict

    def value(self, name):
        """A parameter as the sweep or the method's default has it, as text."""
        return self.parameters.get(name, "")

    def per_point(self, counter):
        """A counter over the number of camera rays, each of which asks for the light of one point."""
        return self.counters[counter] / self.counters["camera_rays"]

    def build(self):
        """CPU time of the beams and of what is built over them, median over repeats [s]."""
        return sum(spread.median for phase, spread in self.cpu.items() if phase.startswith("precompute/"))


def read(folder):
    """The cells of a sweep's folder; raises RecordsError where a trial is missing or repeats do not count alike."""
    table = records.read(os.path.join(folder, "records.csv"))
    if table.left_out:
        raise records.RecordsError(f"{folder}: trials that are not done: {table.left_out}")
    return [measured(folder, cell) for cell in table.cells]


def measured(folder, cell):
    trials = [load(os.path.join(folder, "trials", record["trial"], "record.json")) for record in cell.records]
    first = trials[0]
    if any(trial["counters"] != first["counters"] for trial in trials):
        raise records.RecordsError(f"{folder}: repeats of {cell.records[0]['trial']} count differently")
    phases = {phase: [trial["phases"][phase]["cpu"] for trial in trials] for phase in first["phases"]}
    parameters = {**{name: records.canonical(str(value)) for name, value in first["method"]["parameters"].items()},
                  **cell.parameters}
    return Measured(cell.scene, cell.method, parameters, first["counters"], first["memory"].get("map_bytes"),
                    {phase: records.Spread(sorted(times)[len(times) // 2], min(times), max(times))
                     for phase, times in phases.items()})


def load(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        raise records.RecordsError(f"{path}: {error}") from error


def select(cells, **wanted):
    """Cells with these parameters; `method` and `scene` count as parameters."""
    fits = lambda cell: all((getattr(cell, name) if name in ("method", "scene") else cell.value(name)) == str(value)
                            for name, value in wanted.items())
    return [cell for cell in cells if fits(cell)]


def microseconds(cell, eye_pass):
    """CPU time a point beyond that of the same eye pass with the method `none` [us]."""
    return microseconds_range(cell, eye_pass)[0]


def microseconds_range(cell, eye_pass):
    """The same and its ends over the repeats: (median, low, high) [us]."""
    own, other = cell.cpu["render"], eye_pass.cpu["render"]
    ends = (own.median - other.median, own.low - other.high, own.high - other.low)
    return tuple(1e6 * seconds / cell.counters["camera_rays"] for seconds in ends)


def exponent(x, y):
    """p of the least-squares fit y = c x^p."""
    u = [math.log(value) for value in x]
    v = [math.log(value) for value in y]
    mean_u, mean_v = sum(u) / len(u), sum(v) / len(v)
    return (sum((a - mean_u) * (b - mean_v) for a, b in zip(u, v)) / sum((a - mean_u) ** 2 for a in u))
