"""Runs the duel: a search over each method's settings on seeds of its own, a pilot that fixes the number of seeds, and the final
runs of what the search chose. What is there is taken as it is; the number of seeds and the choice are written once and kept."""
import json
import math
import statistics
import subprocess
import sys
import time

from duel import contests, curves
from duel.scores import CELL_COLUMNS, COLUMNS, Scored, read_csv, write_csv
from report.records import RecordsError, read_rows
from report.report_files import write

SEARCH, FINAL = "search", "final"
ENVIRONMENT = ("cpu", "threads_available", "compiler", "flags", "build_type", "commit", "dirty", "libraries", "date")
MEMORY = "8000"  # MiB of a trial
LEFT_OUT = ("scene", "label", "settings", "seed", "status", "message")


class Race:
    def __init__(self, duel, output, program, jobs, size="", only=()):
        """`size`: whole, or `quick` or `smoke`, whose rules replace those of the whole; `only`: the names of some scenes."""
        self.duel, self.output, self.program, self.jobs = duel, output, str(program), jobs
        self.whole = not only
        self.rules = duel.rules | duel.rules.get(size, {})
        names = only or self.rules.get("only")
        self.scenes = [scene for scene in duel.scenes if names is None or scene.name in names]
        self.start, self.spent, self.done, self.seeds = time.monotonic(), 0.0, 0, []

    def folder(self, scene):
        return self.output / "trials" / scene.name

    def log(self, text):
        print(f"duel: {text}", file=sys.stderr, flush=True)

    def run(self):
        """All scenes, or those of the size, on the pilot's seeds."""
        for number, scene in enumerate(self.scenes, 1):
            self.log(f"scene {number} of {len(self.scenes)}: {scene.name} ({scene.title}); {self.left(number)}")
            self.race(scene)

    def left(self, number):
        minutes = (time.monotonic() - self.start) / 60
        if number == 1 or not self.done:
            return f"{minutes:.1f} minutes so far"
        return f"{minutes:.1f} minutes so far, about {self.spent / self.done * (len(self.scenes) - number + 1) / 60:.0f} to go"

    def race(self, scene):
        begin = time.monotonic()
        searched = self.search(scene)
        picked = self.choice(scene, searched)
        self.measure(scene, picked, self.seeds, FINAL)
        self.spent, self.done = self.spent + time.monotonic() - begin, self.done + 1

    def search(self, scene):
        return self.measure(scene, self.duel.settings(scene), self.rules["search_seeds"], SEARCH)

    def pilot(self):
        """The seeds of the final runs: as many as the scatter of the search asks for, by the rule in scenes.json. Kept once written,
        which a run of single scenes leaves to a run of all."""
        path, rules = self.output / "pilot.json", self.rules
        if path.is_file():
            wanted = json.loads(path.read_text(encoding="utf-8"))["seeds"]
        else:
            found = {scene.name: fronts(self.search(scene), self.duel) for scene in self.scenes}
            wanted = wanted_of(found.values(), rules) if found else rules["least_seeds"]  # counts alone have no scene
            if self.whole:
                path.parent.mkdir(parents=True, exist_ok=True)
                scatter = {name: upper_scatter(cells) for name, cells in found.items()}
                write(path, json.dumps({"scatter": scatter, "seeds": wanted}, indent=1) + "\n")
        return list(range(rules["first_seed"], rules["first_seed"] + wanted))

    def choice(self, scene, cells):
        """The settings that run again on the reported seeds; kept once written."""
        path = self.output / "chosen" / f"{scene.name}.json"
        if not path.is_file():
            path.parent.mkdir(parents=True, exist_ok=True)
            write(path, json.dumps([[cell.label, cell.setting.text()] for cell in fronts(cells, self.duel)], indent=1, ensure_ascii=False) + "\n")
        names = {tuple(each) for each in json.loads(path.read_text(encoding="utf-8"))}
        return [setting for setting in self.duel.settings(scene) if (setting.label, setting.text()) in names]

    def keep_environment(self, folder):
        """environment.json of the first sweep: compiler, flags, machine."""
        path, kept = self.output / "environment.json", folder / "environment.json"
        if kept.is_file() and not path.is_file():
            about = json.loads(kept.read_text(encoding="utf-8"))
            write(path, json.dumps({name: about[name] for name in ENVIRONMENT}, indent=1) + "\n")

    def measure(self, scene, settings, seeds, phase):
        """Runs the settings, scores them, writes records/SCENE_PHASE.csv; taken from there where all is there. Returns cells."""
        path = self.output / "records" / f"{scene.name}_{phase}.csv"
        wanted = {(setting.label, setting.text(), seed) for setting in settings for seed in seeds}
        rows = read_csv(path) if path.is_file() else []
        left_out = path.with_name(f"{path.stem}_left_out.csv")
        known = rows + (read_csv(left_out, LEFT_OUT) if left_out.is_file() else [])
        if not wanted <= {(row["label"], row["settings"], int(row["seed"])) for row in known}:
            rows, others = self.sweep(scene, settings, seeds, phase)
            write_csv(path, COLUMNS, rows)
            if others:
                write_csv(left_out, LEFT_OUT, others)
        return cells_of(settings, rows)

    def sweep(self, scene, settings, seeds, phase):
        folder = self.folder(scene)
        paths = contests.sweep_files(scene, settings, seeds, self.rules, folder / "sweeps", phase)
        self.log(f"{scene.name}: {phase}, {len(settings)} settings x {len(seeds)} seeds")
        self.run_sweep(paths, folder)
        self.keep_environment(folder)
        scored, records, trials, left_out = Scored(scene, folder), [], {}, []
        for _, row in read_rows(folder / "records.csv")[1]:
            setting = contests.setting_of(row, settings, scene)
            if row["status"] == "done":
                records.append(scored.record(row, setting, phase))
                trials.setdefault(setting, []).append(row["trial"])
            else:
                left_out.append({"scene": scene.name, "label": setting.label, "settings": setting.text(), "seed": row["seed"],
                                 "status": row["status"], "message": row.get("message", "").split(";")[0]})
        if not records:
            raise RecordsError(f"{folder}: no trial is done")
        if len(seeds) > 1:
            write_csv(self.output / "records" / f"{scene.name}_{phase}_spread.csv", CELL_COLUMNS,
                      [scored.spread(setting, own) for setting, own in trials.items() if len(own) > 1])
        order = lambda row: (row["label"], row["settings"], int(row["seed"]))
        return sorted(records, key=order), sorted(left_out, key=order)

    def run_sweep(self, files, folder):
        """A sweep of the program, whose trials that fail become rows."""
        longest = str(self.rules["longest_s"])
        words = ["sweep", *map(str, files), "-o", str(folder), "--jobs", str(self.jobs), "--timeout", longest, "--memory", MEMORY]
        status = subprocess.run([self.program, *words], cwd=contests.ROOT, stdin=subprocess.DEVNULL, stdout=sys.stderr).returncode
        if status not in (0, 1):
            raise ChildProcessError(f"{folder.name}: the sweep ended with exit code {status}")


def cells_of(settings, rows, plain=False):
    groups = {}
    for row in rows:
        groups.setdefault((row["label"], row["settings"]), []).append(row)
    return [curves.Cell(setting, groups[setting.label, setting.text()], plain) for setting in settings if (setting.label, setting.text()) in groups]


def fronts(cells, duel):
    """What each method's search chooses, method by method."""
    labels = dict.fromkeys(cell.label for cell in cells)
    return [cell for label in labels for cell in curves.chosen([each for each in cells if each.label == label], duel.kept(label))]


def scatter_of(cell):
    """The standard deviation of the logarithm of a trial's error, from its squared error's."""
    if len(cell.squares) < 2:
        return 0.0
    return float(cell.squares.std(ddof=1) / cell.squares.mean() / 2)


def upper_scatter(cells):
    """The upper quartile of the settings' scatter: a quarter of them scatter more."""
    scatter = [scatter_of(cell) for cell in cells if scatter_of(cell) > 0]
    return statistics.quantiles(scatter, n=4, method="inclusive")[2] if len(scatter) > 1 else sum(scatter)


def wanted_of(groups, rules):
    """Seeds for the scene that scatters most."""
    return wanted_seeds(max(map(upper_scatter, groups)), rules["half_interval"], rules["least_seeds"], rules["most_seeds"])


def wanted_seeds(scatter, half_interval, least, most):
    """The fewest seeds for which Student's 95 % half interval of the mean is below `half_interval`, within bounds."""
    from report.intervals import student

    for n in range(max(least, 2), most):
        if student(n - 1) * scatter / math.sqrt(n) <= math.log1p(half_interval):
            return n
    return most
