"""One paper's runs: sweeps and single commands of causticbench, each run once, with what it cost."""
import csv
import dataclasses
import hashlib
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time

from report import exr
from report.records import RecordsError, canonical

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES, SWEEPS = (ROOT / "experiments" / "papers" / kind for kind in ("scenes", "sweeps"))


@dataclasses.dataclass
class Cost:
    """Of commands: the first of each name, their seconds whenever they ran, and what they wrote."""
    command: str = ""
    seconds: float = 0.0
    bytes: int = 0


class Study:
    """Runs what a paper's claims ask for; what is there already is taken as it is."""

    def __init__(self, paper, output, program, full):
        self.paper, self.program, self.full = paper, str(program), full
        self.output = output.resolve() / paper.name
        self.scenes, self.sweeps = SCENES, SWEEPS
        self.costs, self.done, self.answers = {}, {}, {}

    def log(self, text):
        print(f"reproduce: {self.paper.name}: {text}", file=sys.stderr, flush=True)

    def run(self, words):
        done = subprocess.run([self.program, *map(str, words)], cwd=ROOT, stdin=subprocess.DEVNULL, stdout=sys.stderr)
        if done.returncode != 0:
            raise ChildProcessError(f"{shlex.join(map(str, words))}: exit code {done.returncode}")

    @staticmethod
    def scene(path):
        """A scene file of the project, as it is written."""
        return json.loads((ROOT / path).read_text(encoding="utf-8"))

    def sweep(self, name):
        """The trials of experiments/papers/sweeps/PAPER_NAME.json; in a quick run those that PAPER.json filters.

        Two at a time where no claim is about their times.
        """
        if name in self.done:
            return self.done[name]
        folder = self.output / "trials" / name
        chosen = [] if self.full else self.paper.text["quick"].get(name, [])
        filters = [word for each in chosen for word in ("--filter", each)]
        jobs = min(2, os.cpu_count()) if name in self.paper.text["two_at_a_time"] else 1
        words = ["sweep", SWEEPS / f"{self.paper.name}_{name}.json", "-o", folder, *filters, *(["--jobs", str(jobs)] if jobs > 1 else [])]
        self.log(f"sweep {name}")
        self.run(words)
        trials = Trials(folder, chosen)
        self.keep(name, words, sum(trials.column("elapsed_s")) / jobs)
        self.done[name] = trials
        return trials

    def single(self, name, verb, words, *outputs):
        """A command with `-o` files in trials/NAME; skipped where they are there and the command is the same."""
        folder = self.output / "trials" / name
        folder.mkdir(parents=True, exist_ok=True)
        files = [folder / each for each in outputs]
        full = [verb, *words, *[word for file in files for word in ("-o", file)]]
        note = folder / f"{outputs[0]}.json"
        digest = hashlib.sha256(inputs(words)).hexdigest()
        kept = json.loads(note.read_text()) if note.is_file() else {}
        if kept.get("digest") != digest or not all(file.is_file() for file in files):
            self.log(f"{verb} {name}/{outputs[0]}")
            start = time.monotonic()
            self.run(full)
            kept = {"digest": digest, "seconds": time.monotonic() - start}
            note.write_text(json.dumps(kept) + "\n")
        self.keep(name, full, kept["seconds"])
        self.answers |= {f"{name}_{file.name}": file for file in files if file.suffix == ".csv"}
        return files

    def keep(self, name, words, seconds):
        """Adds up what the commands of one name cost; the first stands for them."""
        cost = self.costs.setdefault(name, Cost(shown(words)))
        cost.seconds += seconds
        cost.bytes = sum(file.stat().st_size for file in (self.output / "trials" / name).rglob("*") if file.is_file())

    def cost(self, names):
        """Of what a claim is measured from."""
        found = [self.costs[name] for name in names if name in self.costs]
        return Cost("; ".join(each.command for each in found), sum(each.seconds for each in found), sum(each.bytes for each in found))

    def minutes(self):
        """Of all commands, whenever they ran."""
        return sum(cost.seconds for cost in self.costs.values()) / 60

    def folders(self):
        """Of the sweeps that ran."""
        return [trials.folder for _, trials in sorted(self.done.items())]

    def cpu_minutes(self):
        """Of the sweeps' renderings, on however many processors."""
        return sum(sum(trials.column("cpu_s")) for trials in self.done.values()) / 60

    def copy_records(self, partial):
        """The tables of sweeps and probes, to be kept; those of other sections stay where only some ran."""
        folder = self.output / "records"
        if not partial:
            shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(exist_ok=True)
        for name, file in self.answers.items():
            shutil.copyfile(file, folder / name)
        for name, trials in self.done.items():
            trials.write(folder / f"{name}.csv")


def inputs(words):
    """What a command depends on: its words, and the files among them."""
    parts = []
    for word in map(str, words):
        parts.append(word.replace(str(ROOT), ""))
        if os.path.isfile(word):
            parts.append(pathlib.Path(word).read_text(encoding="utf-8", errors="replace"))
    return "\0".join(parts).encode()


def shown(words):
    """A command as a reader types it in the project's folder."""
    return shlex.join(["build/release/bin/causticbench", *[str(word).replace(f"{ROOT}/", "") for word in words]])


class Trials:
    """The trials of one sweep that are done, by the values that tell them apart."""

    def __init__(self, folder, filters=()):
        self.folder = folder
        chosen = {}
        for each in filters:
            key, value = each.split("=", 1)
            chosen.setdefault(key, []).append(value)
        with open(folder / "records.csv", newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            self.kept = [row for row in reader if all(row[key] in values for key, values in chosen.items())]
            self.heading = reader.fieldnames
        unfinished = [row["trial"] for row in self.kept if row["status"] != "done"]
        if unfinished:
            raise RecordsError(f"{folder}: trial {unfinished[0]} is not done (its log.txt says why)")
        self.rows = sorted(self.kept, key=lambda row: (int(row["seed"]), int(row["repeat"])))

    def write(self, path):
        """The rows that were chosen, in the table's order: what a longer run left in the folder is no part of this one."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self.heading, lineterminator="\n")
            writer.writeheader()
            writer.writerows(self.kept)

    def where(self, **wanted):
        """Rows that hold these values, by seed and repeat; with_NAME is a parameter of the method that shares its name with a column."""
        fits = lambda row: all(canonical(self.value(row, key)) == canonical(str(value)) for key, value in wanted.items())
        found = [row for row in self.rows if fits(row)]
        if not found:
            raise RecordsError(f"{self.folder}: no trial with {wanted}")
        return found

    def value(self, row, key):
        if key.startswith("with_"):
            return str(self.record(row)["method"]["parameters"].get(key[len("with_"):], ""))
        return row.get(key, "")

    def column(self, name, **wanted):
        return [float(row[name]) for row in self.where(**wanted)]

    def values(self, name):
        """What a column holds, each once, in the order of numbers."""
        return sorted({row[name] for row in self.rows if row[name]}, key=lambda text: (len(text), text))

    def record(self, row):
        return json.loads((self.folder / "trials" / row["trial"] / "record.json").read_text(encoding="utf-8"))

    def picture(self, **wanted):
        """Layers of the first trial's picture."""
        return self.pictures(**wanted)[0]

    def reference(self, **wanted):
        """Layers of the picture that the first trial is held against."""
        return exr.read_layers(self.folder / "references" / f"{self.where(**wanted)[0]['reference'].split(':')[1]}.exr")

    def pictures(self, **wanted):
        return [exr.read_layers(self.folder / "trials" / row["trial"] / "image.exr") for row in self.where(**wanted)]
