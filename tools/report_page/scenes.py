"""The records of one or several sweeps as the page shows them: scenes, the cells of each, and who is best at equal time.

A *scene* here is a scene as it was set, which is what has one reference. A *line* joins the cells of a method that differ
in one number only: photons where there are, else the number with most values.
"""
import json
import os
import statistics

from report import records
from report.intervals import FEWEST_SEEDS, Answer, half_interval, is_worse, log_variance
from report.plot_panels import counted, varying
from report.records import BUILD, CPU_PARTS, PHOTON_PARAMETERS, QUERY, RecordsError, natural

ERRORS = ("rmse", "relmse", "bias", "variance", "mean_ratio", "leak_energy", "mask_rmse", "mask_relmse", "mask_mean_ratio",
          "beauty_rmse", "flip", "indirect_rmse", "indirect_relmse", "indirect_mean_ratio")
OF_ALL_SEEDS = ("variance",)  # one value a cell, which each of its records repeats
COSTS = ("work_s", "build_s", "query_s", "indirect_cpu_s", "total_s", "photons_stored", "photons_emitted", "map_bytes", "peak_rss_bytes")
METHODS = ("photonmap", "beamtree", "causticpolygons", "illuminationmap", "lighttrace", "pathtrace", "none")
LENGTHS = ("footprint", "max_radius")  # numbers that are no work: no line runs along them
COUNTED = (*PHOTON_PARAMETERS, "paths")
PLAN_VERSION = 1


class Sweep:
    """The folder of a sweep: its cells and what was left out of them. `name` tells it from the others of a report."""

    def __init__(self, folder):
        self.folder, self.name = folder, os.path.basename(os.path.abspath(folder))
        self.path = os.path.join(folder, "records.csv")
        check_plan(folder)
        self.header, rows = records.read_rows(self.path)
        self.rows = [row for _, row in rows]
        self.place = {row["trial"]: i for i, row in enumerate(self.rows)}
        self.records = records.read(self.path)
        self.left_out = [row for row in self.rows if row["status"] != "done"]
        for row in self.rows:  # both become names of files
            for name in (row["trial"], row.get("reference", "")):
                if "/" in name or name.startswith("."):
                    raise RecordsError(f'{self.path}: "{name}" is no plain name (of a trial, or of a reference)')


def require_each_once(sweeps):
    """The same trial in two folders would be two cells that nothing tells apart."""
    place = {}
    for sweep in sweeps:
        for row in sweep.rows:
            first = place.setdefault(row["trial"], sweep)
            if first is not sweep:
                raise RecordsError(f"{row['trial']}: is in {first.folder} and in {sweep.folder}; name one of the two")


def name_folders(sweeps):
    """Names them by as many of the last parts of their paths as tell them apart."""
    paths = [os.path.abspath(sweep.folder).split(os.sep) for sweep in sweeps]
    for count in range(1, max(map(len, paths)) + 1):
        names = ["/".join(path[-count:]) for path in paths]
        if len(set(names)) == len(names):
            break
    for sweep, name in zip(sweeps, names):
        sweep.name = name


def check_plan(folder):
    """Refuses a folder that is none, or whose plan is of another version of the program."""
    if not os.path.isdir(folder):
        raise RecordsError(f"{folder}: no such folder (give the folder that a sweep wrote, with records.csv)")
    if not os.path.isfile(os.path.join(folder, "records.csv")):
        raise RecordsError(f"{folder}: no records.csv in it (give the folder that a sweep wrote)")
    path = os.path.join(folder, "plan.json")
    if not os.path.isfile(path):
        return
    try:
        with open(path, encoding="utf-8") as file:
            version = json.load(file).get("version")
    except (OSError, ValueError, AttributeError, RecursionError) as error:
        raise RecordsError(f"{path}: not a plan of a sweep ({error})") from error
    if version != PLAN_VERSION:
        raise RecordsError(f"{path}: records of version {version}; this tool reads version {PLAN_VERSION}")


class Cell:
    """A cell of the records with its sweep, its costs summed up, and what the page calls it."""

    def __init__(self, cell, sweep):
        self.scene, self.method, self.parameters = cell.scene, cell.method, cell.parameters
        self.sweep = sweep
        self.rows = sorted(cell.records, key=lambda row: (natural(row["seed"]), natural(row["repeat"])))
        self.reference = self.rows[0].get("reference", "")
        self.label, self.line = cell.method, (cell.method,)

    def settings(self):
        """Its label without the method; a dash where nothing tells the method's cells apart."""
        return self.label.removeprefix(self.method).removeprefix(", ") or "–"

    def values(self, column):
        """The column's numbers, a row each; [] where it does not apply to all rows. Build, query and their sum are CPU
        seconds."""
        parts = {"build_s": BUILD, "query_s": QUERY, "work_s": CPU_PARTS}.get(column)
        if parts is None:
            return numbers(row.get(column) for row in self.rows)
        if not any(row.get(part) for row in self.rows for part in parts):
            return []
        return [records.cpu_seconds(row, parts) for row in self.rows]

    def by_seed(self, column):
        """The column's numbers, a seed each: repeats make the same picture again."""
        first = {}
        for row, value in zip(self.rows, self.values(column)):
            first.setdefault(row["seed"], value)
        return list(first.values())

    def seeds(self):
        return list(dict.fromkeys(row["seed"] for row in self.rows))

    def error(self, column):
        """(mean, half its 95 % interval or None) over the seeds, or None. What all seeds together have has no interval."""
        values = self.by_seed(column)
        if not values:
            return None
        return (statistics.mean(values), None if column in OF_ALL_SEEDS else half_interval(values))

    def cost(self, column):
        """The median over seeds and repeats, or None."""
        values = self.values(column)
        return statistics.median(values) if values else None

    def answer(self):
        """Its rmse, for Welch's test."""
        errors = self.by_seed("rmse")
        return Answer(statistics.mean(errors), ((log_variance(errors), len(errors) - 1),) if len(errors) > 1 else ())


def rank(method):
    """Where a method stands in lists: the two that the project compares first, then the others."""
    return (METHODS.index(method) if method in METHODS else len(METHODS), method)


def numbers(texts):
    texts = list(texts)
    return [float(text) for text in texts] if all(texts) else []


class Scene:
    """A scene as it was set: its title, its cells, and what constant settings it has."""

    def __init__(self, name, reference, cells):
        self.name, self.reference, self.cells = name, reference, cells
        self.settings = {}
        name_cells(self)

    def title(self):
        return ", ".join([self.name, *(f"{name} {value}" for name, value in self.settings.items())])

    def scored(self):
        return [cell for cell in self.cells if cell.by_seed("rmse") and cell.cost("work_s") is not None]

    def seeds(self):
        """The fewest that a cell has."""
        return min(len(cell.seeds()) for cell in self.cells)

    def folders(self):
        return list(dict.fromkeys(cell.sweep.name for cell in self.cells))

    def contests(self):
        """[(CPU seconds, {method: its best cell until then}, the best and all that the seeds do not tell from it)], one for
        each time at which a cell is done and two methods have one. With too few seeds nobody is called the best."""
        found = []
        cells = sorted((cell for cell in self.scored() if cell.method != "none"), key=lambda cell: cell.cost("work_s"))
        picks = {}
        for cell in cells:
            before = picks.get(cell.method)
            if before is None or cell.error("rmse")[0] < before.error("rmse")[0]:
                picks[cell.method] = cell
                if found and found[-1][0] == cell.cost("work_s"):
                    found.pop()
                if len(picks) > 1:
                    found.append((cell.cost("work_s"), dict(picks), best_of(picks.values())))
        return found

    def usual_contest(self):
        """Which of the contests is shown first: when one of the first two methods is at its best, and both have a cell."""
        contests = self.contests()
        if not contests:
            return None
        first = sorted(contests[-1][1], key=rank)[:2]
        least = lambda method: min((cell for cell in self.scored() if cell.method == method),
                                   key=lambda cell: cell.error("rmse")[0]).cost("work_s")
        goal = min(least(method) for method in first)
        return next(i for i, (seconds, picks, _) in enumerate(contests)
                    if seconds >= goal and all(method in picks for method in first) or i + 1 == len(contests))


def seeds_text(cells):
    """How many seeds the cells have: 5 seeds, 2 to 3 seeds."""
    fewest, most = (extreme(len(cell.seeds()) for cell in cells) for extreme in (min, max))
    return (f"{fewest} to {most}" if fewest < most else f"{most}") + (" seeds" if most > 1 else " seed")


def best_of(cells):
    """The cell with the least rmse and those that are not above it by more than chance; none with too few seeds."""
    cells = list(cells)
    if not cells or min(len(cell.by_seed("rmse")) for cell in cells) < FEWEST_SEEDS:
        return []
    best = min((cell.answer() for cell in cells), key=lambda answer: answer.value)
    return [cell for cell in cells if not is_worse(cell.answer(), best)]


def name_cells(scene):
    """Labels that tell the scene's cells apart, and the line that each is on."""
    for method in sorted({cell.method for cell in scene.cells}):
        own = [cell for cell in scene.cells if cell.method == method]
        names = [name for name in varying(own) if tells_apart(name, own)]
        work = work_parameter(own, names)
        folders = len({cell.sweep.folder for cell in own}) > 1
        for cell in own:
            words = [f"{counted(cell.parameters[name])} {name}" if name in COUNTED else spelt(name, cell.parameters[name])
                     for name in sorted(names, key=lambda name: name != work) if name in cell.parameters and not of_indirect(name)]
            place = (f"from {cell.sweep.name}",) if folders else ()
            cell.label = ", ".join([method, *words, *indirect_words(cell, names), *place])
            others = [name for name in names if name != work]
            cell.line = (method, *(spelt(name, cell.parameters[name]) for name in others
                                   if name in cell.parameters and not of_indirect(name)), *indirect_words(cell, others), *place)
            cell.work_parameter = work if work in cell.parameters else None


def of_indirect(name):
    return name == "indirect" or name.startswith("indirect_")


def tells_apart(name, cells):
    """Whether a number of the indirect method differs between cells of that method."""
    if not name.startswith("indirect_"):
        return True
    values = {}
    for cell in cells:
        values.setdefault(cell.parameters.get("indirect"), set()).add(cell.parameters.get(name))
    return any(len(each) > 1 for each in values.values())


def indirect_words(cell, names):
    """What makes the cell's light between diffuse surfaces, where the cells differ in that."""
    method = cell.parameters.get("indirect") if "indirect" in names else None
    words = [spelt(name.removeprefix("indirect_"), cell.parameters[name]) for name in names
             if name.startswith("indirect_") and name in cell.parameters]
    if not words:
        return [f"indirect {method}"] if method else []
    return [f"indirect {method} ({', '.join(words)})" if method else f"indirect ({', '.join(words)})"]


def spelt(name, value):
    return {"true": name, "false": f"not {name}"}.get(value, f"{name} {value}")


def work_parameter(cells, names):
    """The parameter along which a line runs, or None."""
    for name in COUNTED:
        if name in names:
            return name
    counts = {name: len({cell.parameters.get(name) for cell in cells}) for name in names
              if name not in LENGTHS and all(records.as_number(cell.parameters.get(name, "0")) is not None for cell in cells)}
    return max(counts, key=counts.get) if counts else None


def scenes_of(sweeps):
    """Every scene as it was set, in a natural order, with the settings that tell scenes of one name apart. The same settings in
    two folders are two cells, since each has its own variance and its own machine."""
    name_folders(sweeps)
    groups = {}
    for sweep in sweeps:
        for cell in sweep.records.cells:
            own = Cell(cell, sweep)
            groups.setdefault((own.scene, own.reference), []).append(own)
    found = [Scene(name, reference, cells) for (name, reference), cells in groups.items()]
    for scene in found:
        scene.settings = settings(scene, [other for other in found if other.name == scene.name])
    titles = [scene.title() for scene in found]
    for scene, title in zip(found, titles):
        if titles.count(title) > 1:  # set alike, but held against different references
            scene.settings["reference"] = scene.reference
    return sorted(found, key=lambda scene: [natural(scene.name)] + [natural(value) for value in scene.settings.values()])


def settings(scene, namesakes):
    """The parameters that all cells of the scene share and other scenes of its name have not."""
    if len(namesakes) == 1:
        return {}
    names = dict.fromkeys(name for other in namesakes for cell in other.cells for name in cell.parameters)
    values = lambda other, name: {cell.parameters.get(name) for cell in other.cells}
    return {name: scene.cells[0].parameters[name] for name in names
            if name in scene.cells[0].parameters and len(values(scene, name)) == 1
            and any(values(other, name) != values(scene, name) for other in namesakes)}
