#!/usr/bin/python3
"""Races both methods against POV-Ray, Mitsuba and plain splatting: error over CPU time on five scenes; writes results/bench/peers.md.

Usage: tools/bench_peers.py [--bench PROGRAM] [--mitsuba PYTHON] [--only SCENE]... [--page] [-o DIR] [--trials DIR]

Every contestant runs on one thread; its settings are searched on a seed of their own (tools/peers/contest.json), and the front of what was found
runs again on three others. It goes on where it was stopped. POV-Ray, and a Python with Mitsuba (tools/crosscheck-requirements.txt; its
llvm variant needs an LLVM of 16 or later, DRJIT_LIBLLVM_PATH), are left out, and said to be, where they are not installed. --page makes the
page from the records that are there. Exit codes: 0 done, 1 a run failed, 2 bad input or usage, 130 interrupted.
"""
import argparse
import csv
import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report.program import BENCH, exit_code, processor
from report.records import RecordsError


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bench", type=pathlib.Path, default=BENCH, metavar="PROGRAM", help="(default: build/release/bin/causticbench)")
    parser.add_argument("--mitsuba", type=pathlib.Path, default=ROOT / ".venv/bin/python", metavar="PYTHON", help="(default: .venv/bin/python)")
    parser.add_argument("--only", action="append", default=[], metavar="SCENE", help="these scenes (repeatable)")
    parser.add_argument("--page", action="store_true", help="no runs: the page from the records that are there")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/bench", metavar="DIR", help="(default: results/bench)")
    parser.add_argument("--trials", type=pathlib.Path, metavar="DIR", help="where truths are kept (default: DIR/trials/peers)")
    return parser.parse_args()


class Race:
    """Trials and their records, which are taken where they are there."""

    def __init__(self, held, programs, path, trials):
        from peers import scores

        self.held, self.programs, self.path, self.trials, self.scores = held, programs, path, trials, scores
        self.records = scores.read(path) if path.is_file() else []
        self.known = {(row["scene"], row["contestant"], row["setting"], row["phase"], row["seed"]) for row in self.records}
        self.absent = programs.absent()
        self.about = {}

    def run(self, scenes):
        for number, scene in enumerate(scenes, 1):
            from peers import truths

            log(f"scene {number} of {len(scenes)}: {scene.name}, its truth")
            truth, self.about[scene.name] = truths.of_scene(scene, self.programs, self.trials)
            names = [name for name in self.held.names if name not in self.absent and self.held.settings(scene, name)]
            for name in names:
                self.measure(scene, truth, name, self.held.settings(scene, name), self.held.text["search_seeds"], self.scores.SEARCH)
            for name in names:
                self.measure(scene, truth, name, self.picked(scene, name), self.held.text["seeds"], self.scores.FINAL)

    def picked(self, scene, name):
        from peers import contest

        found = [cell for cell in self.scores.cells(self.records, scene.name, self.scores.SEARCH) if cell.name == name]
        chosen = self.scores.chosen(found, scene.text.get("keep", self.held.text["keep"]))
        return [setting for setting in self.held.settings(scene, name) if contest.words(setting) in chosen]

    def measure(self, scene, truth, name, settings, seeds, phase):
        from peers import contest

        for setting in settings:
            for seed in seeds:
                key = (scene.name, name, contest.words(setting), phase, seed)
                if key not in self.known:
                    self.keep(key, self.trial(scene, truth, name, setting, seed))

    def trial(self, scene, truth, name, setting, seed):
        from peers import contestants

        try:
            seconds, picture = self.programs.trial(name, scene, setting, seed)
        except contestants.TooLong:
            return {"status": f"over {self.programs.longest} s", "load": round(os.getloadavg()[0], 1)}
        return {"status": self.scores.DONE, "cpu_s": round(seconds, 4), **truth.score(picture), "load": round(os.getloadavg()[0], 1)}

    def keep(self, key, found):
        row = dict.fromkeys(self.scores.COLUMNS, "") | dict(zip(("scene", "contestant", "setting", "phase", "seed"), key)) | found
        new = not self.path.is_file()
        with open(self.path, "a", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self.scores.COLUMNS, lineterminator="\n")
            if new:
                writer.writeheader()
            writer.writerow({name: f"{value:.6g}" if isinstance(value, float) else value for name, value in row.items()})
        self.known.add(key)
        self.records.append(row)
        error = f"{found['relmse'] ** 0.5:.3g} in {found['cpu_s']:.2f} s" if found["status"] == self.scores.DONE else found["status"]
        log(f"{key[0]} {key[1]} ({key[2]}), {key[3]} {key[4]}: {error}")


def log(text):
    print(f"bench_peers: {text}", file=sys.stderr, flush=True)


def environment(programs, about, absent):
    """Machine, versions and truths, for the page."""
    first = lambda *command: (subprocess.run(command, capture_output=True, text=True).stdout.strip().splitlines() or ["?"])[0]
    found = {"cpu": processor(), "processors": os.cpu_count(), "date": datetime.date.today().isoformat(), "causticbench": first(programs.bench, "--version")}
    if "povray" not in absent:
        text = subprocess.run([programs.povray, "--version"], capture_output=True, text=True)
        found["povray"] = next((line for line in (text.stdout + text.stderr).splitlines() if "POV-Ray" in line), "?").strip()
    if "mitsuba" not in absent:
        found["mitsuba"] = first(programs.mitsuba, "-c", "import mitsuba, drjit; print(f'Mitsuba {mitsuba.__version__}, Dr.Jit {drjit.__version__}')")
    if "splat" not in absent:
        found["compiler"] = first(programs.compiler, "--version")
    return {"environment": found, "absent": absent, "truths": about}


def race(chosen):
    from peers import contest, contestants
    from report.report_files import write

    held = contest.Contest()
    unknown = [name for name in chosen.only if name not in [scene.name for scene in held.scenes]]
    if unknown:
        raise RecordsError(f"--only {unknown[0]}: no such scene (known: {', '.join(scene.name for scene in held.scenes)})")
    if not chosen.bench.exists():
        raise RecordsError(f"{chosen.bench}: not there (tools/build.sh release causticbench, or --bench)")
    trials = chosen.trials or chosen.output / "trials" / "peers"
    trials.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        programs = contestants.Contestants(chosen.bench.resolve(), chosen.mitsuba.absolute(), pathlib.Path(work), held.text["longest_s"])
        for name, why in programs.absent().items():
            log(f"{name} is left out: {why}")
        run = Race(held, programs, chosen.output / "peers.csv", trials)
        run.run([scene for scene in held.scenes if not chosen.only or scene.name in chosen.only])
        path = chosen.output / "peers.json"
        known = json.loads(path.read_text(encoding="utf-8"))["truths"] if path.is_file() else {}
        write(path, json.dumps(environment(programs, {**known, **run.about}, run.absent), indent=1) + "\n")


def run(chosen):
    if not chosen.page:
        race(chosen)
    from peers import page

    page.write_all(chosen.output)


def main():
    chosen = arguments()
    return exit_code("bench_peers", lambda: run(chosen))


if __name__ == "__main__":
    sys.exit(main())
