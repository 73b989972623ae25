"""Cells of records.csv as the tables of the photon map's estimate see them: what was estimated how, and its errors."""
import math
import statistics

from report import records

ESTIMATE = ("photons", "nearest", "adaptive", "filter", "estimator")  # what tables and heat maps compare


class Estimate:
    """A cell of the records: what the estimate was, its errors against the reference, and its cost."""

    def __init__(self, cell):
        own = self.parameters = cell.parameters
        self.scene, self.method = cell.scene, cell.method
        self.photons = int(own["photons"]) if "photons" in own else None
        self.nearest = int(own["nearest"]) if "nearest" in own else None
        self.resolution = int(own["resolution"]) if "resolution" in own else None
        self.filter = own.get("filter", "none")
        self.raw = own.get("estimator") == "raw"
        self.adaptive = own.get("adaptive") == "true"
        self.passes = int(own.get("passes", 1))
        rows = [repeats[0] for repeats in records.by_seed(cell.records).values()]
        errors = [math.sqrt(float(row["relmse"])) for row in rows]
        self.error, self.least, self.greatest = statistics.median(errors), min(errors), max(errors)
        shares = [float(row["rmse"]) / float(row["reference_mean"]) for row in rows]
        self.rmse = statistics.median(shares)
        self.square = statistics.mean(share * share for share in shares)
        self.seconds = statistics.median(map(records.cpu_seconds, cell.records))
        self.used = mean_used(rows)

    def estimator(self):
        """The filter, and whether it is unbiased, as titles say it."""
        return f"filter {self.filter}" + (", raw" if self.raw else "")


def mean_used(rows):
    """The mean number of photons that an estimate was made from, or None where that was not counted."""
    used, gathers = (sum(float(row[name]) for row in rows if row.get(name)) for name in ("used_photons", "gathers"))
    return used / gathers if used and gathers else None


def settings(cells):
    """{title: the photon maps of one scene as it was set}: whatever varies beside the estimate sets them apart.

    A parameter that adaptive estimates alone have sets nothing apart.
    """
    parts = {}
    for scene in sorted({cell.scene for cell in cells}):
        own = [cell for cell in cells if cell.scene == scene and cell.method == "photonmap" and cell.photons]
        fixed_ones = [cell for cell in own if not cell.adaptive] or own
        names = dict.fromkeys(name for cell in fixed_ones for name in cell.parameters if name not in ESTIMATE)
        varying = [name for name in names if len({cell.parameters.get(name) for cell in own}) > 1]
        order = lambda cell: [records.natural(cell.parameters.get(name, "")) for name in varying]
        for cell in sorted(own, key=order):
            words = [f"{name} {cell.parameters[name]}" for name in varying if name in cell.parameters]
            parts.setdefault(", ".join([scene, *words]), []).append(cell)
    return parts


def best(cells):
    """The cell of the least error, and that of the least rmse."""
    return min(cells, key=lambda cell: cell.error), min(cells, key=lambda cell: cell.rmse)


def fixed(cells, **wanted):
    """The photon maps with a given N that have these attributes."""
    return [cell for cell in cells if cell.nearest is not None and not cell.adaptive
            and all(getattr(cell, name) == value for name, value in wanted.items())]
