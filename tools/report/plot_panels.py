"""Which plots records.csv carries, and which cells make up their panels and lines.

A line is one method with its N (photons in the estimate); what else varies makes panels.
"""
import dataclasses

from report.records import PHOTON_PARAMETERS, as_number, cpu_seconds, natural

QUANTITIES = {"photons": "stored photons", "time": "time", "alpha": "alpha", "mesh_resolution": "mesh_resolution"}
WORK = ("paths", "mesh_resolution")  # what a line runs along, where only some methods have it
# Okabe and Ito's palette without its yellow: distinct to every kind of colour vision.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKERS = "osD^vPX*"
LINES = ("-", "--", "-.", (0, (5, 1, 1, 1, 1, 1)))  # series differ by more than colour


@dataclasses.dataclass(frozen=True)
class Kind:
    """One plot per scene: a metric against a quantity."""
    y: str
    x: str

    def name(self):
        return f"{self.y}_vs_{self.x}"

    def x_of(self, cell):
        """The cell's place on the x axis, or None where the quantity does not apply to it."""
        if self.x in ("photons", "time"):
            spread = cell.spread("photons_stored" if self.x == "photons" else "time_s")
            return spread.median if spread else None
        return as_number(cell.parameters[self.x]) if self.x in cell.parameters else None

    def parameters_on_axes(self):
        """The parameters that x or the marks show, so that they make no panels."""
        return PHOTON_PARAMETERS if self.x in ("photons", "time") else (self.x,)


KINDS = (Kind("rmse", "photons"), Kind("rmse", "time"), Kind("rmse", "alpha"), Kind("relmse", "alpha"),
         Kind("rmse", "mesh_resolution"), Kind("mean_ratio", "mesh_resolution"))


def set_times(cells):
    """Gives each record the time that plots are over, `time_s`, and returns what that is: CPU seconds of build and query, which
    other work on the machine hardly changes, where all records have them, else the wall time of the trial."""
    rows = [record for cell in cells for record in cell.records]
    if all(record.get("render_cpu_s") for record in rows):
        for record in rows:
            record["time_s"] = repr(cpu_seconds(record))
        return "CPU time of build and query [s]"
    for record in rows:
        record["time_s"] = record["total_s"]
    return "wall time of the whole trial [s]"


class Series:
    """Which line a cell belongs to, and how that line looks in every plot of the report.

    A line is a method and its N, and those parameters that vary within methods and that only some methods have; along
    `work`, which are such parameters too, it runs.
    """

    def __init__(self, cells):
        methods = sorted({cell.method for cell in cells}, key=natural)
        own = [name for name in varying(cells) if name not in PHOTON_PARAMETERS + ("nearest",)
               and one_sided(name, cells, methods)]
        self.work = [name for name in own if name in WORK]
        self.own_parameters = [name for name in own if name not in WORK and varies_within(name, cells, methods)]
        self.ignored = [name for name in own if name not in WORK and name not in self.own_parameters]
        self.one_method = len(methods) == 1
        keys = sorted({self.key(cell) for cell in cells}, key=lambda key: [natural(part) for part in key])
        self.styles = {key: (COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)],
                             LINES[i % len(LINES)]) for i, key in enumerate(keys)}

    def key(self, cell):
        return (cell.method, *(cell.parameters.get(name, "") for name in ("nearest", *self.own_parameters)))

    def label(self, key):
        method, nearest, *others = key
        words = [f"N = {nearest}"] if nearest else []
        words += [{"true": name, "false": f"not {name}"}.get(value, f"{name} {value}")
                  for name, value in zip(self.own_parameters, others) if value]
        return ", ".join(words) if self.one_method and words else ", ".join([method, *words])

    def split(self, cells):
        """{key: cells} in the order of the styles."""
        groups = {key: [cell for cell in cells if self.key(cell) == key] for key in self.styles}
        return {key: group for key, group in groups.items() if group}


def varying(cells):
    names = dict.fromkeys(name for cell in cells for name in cell.parameters)
    return [name for name in names if len({cell.parameters.get(name) for cell in cells}) > 1]


def varies_within(name, cells, methods):
    return any(len({cell.parameters.get(name) for cell in cells if cell.method == method}) > 1 for method in methods)


def one_sided(name, cells, methods):
    """Whether some methods never have this parameter."""
    having = {cell.method for cell in cells if name in cell.parameters}
    return 0 < len(having) < len(methods)


def arrange(kind, cells, series):
    """The panels of one plot, [(title, cells)], or the reason why there are none."""
    cells = [cell for cell in cells if kind.x_of(cell) is not None and cell.spread(kind.y)]
    quantity = QUANTITIES.get(kind.x, kind.x)
    if not cells:
        return [], f"no row has {quantity} and {kind.y}"
    if len({kind.x_of(cell) for cell in cells}) < 2:
        return [], f"fewer than two values of {quantity}"
    names = [name for name in varying(cells)
             if name not in (*kind.parameters_on_axes(), "nearest", *series.own_parameters, *series.ignored)
             and not (kind.x in ("photons", "time") and name in series.work)]
    panels = {}
    # A method without photons is compared with every number of photons, so it is drawn in all of their panels.
    photons = [name for name in names if name in PHOTON_PARAMETERS]
    everywhere = [cell for cell in cells if photons and cell.photon_parameter() is None]
    for cell in cells:
        if cell not in everywhere:
            panels.setdefault(tuple(cell.parameters.get(name, "") for name in names), []).append(cell)
    for cell in everywhere:
        for key, members in panels.items():
            if all(key[i] == cell.parameters.get(name, "") for i, name in enumerate(names) if name not in photons):
                members.append(cell)
    panels = {key: members for key, members in panels.items() if shows_change(kind, members, series)}
    if not panels:
        return [], f"no two values of {quantity} with all else equal"
    keys = sorted(panels, key=lambda key: [natural(part) for part in key])
    return [(panel_title(names, key, len(keys)), panels[key]) for key in keys], None


def without_photons(kind, members, cells, series):
    """The series that have no place on an axis of photons, each with its best cell beside a panel's: [(key, cell)]."""
    names = [name for name in varying(cells) if name not in (*PHOTON_PARAMETERS, "nearest", *series.own_parameters, *series.ignored,
                                                         *series.work)]
    settings = [{name: member.parameters.get(name) for name in names} for member in members]
    beside = [cell for cell in cells if kind.x_of(cell) is None and cell.spread(kind.y) and cell.method != "none"
              and any(all(cell.parameters.get(name, value) == value for name, value in each.items()) for each in settings)]
    return [(key, min(group, key=lambda cell: cell.spread(kind.y).median)) for key, group in series.split(beside).items()]


def shows_change(kind, cells, series):
    groups = [cells] if kind.x == "time" else series.split(cells).values()
    return any(len({kind.x_of(cell) for cell in group}) > 1 for group in groups)


def panel_title(names, key, panels):
    words = [f"{name} {counted(value) if name in PHOTON_PARAMETERS else value}"
             for name, value in zip(names, key) if value]
    return ", ".join(words) if words or panels == 1 else f"{', '.join(names)}: not set"


def note(cells, interval=False):
    seeds = sorted({cell.seeds() for cell in cells})
    if seeds == [1]:
        return "one seed"
    return f"{'mean and its 95 % interval' if interval else 'median and range'} over {'–'.join(str(n) for n in dict.fromkeys((seeds[0], seeds[-1])))} seeds"


def counted(value):
    """Photon counts as a person says them: 10k, 1M."""
    number = float(value)
    for unit, size in (("M", 1e6), ("k", 1e3)):
        if number >= size:
            return f"{number / size:.3g}{unit}"
    return f"{number:.3g}"
