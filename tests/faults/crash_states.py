#!/usr/bin/python3
"""Rebuilds what crashes of the machine may leave of small pieces of work, and sees that each goes on with nothing lost.

Usage: crash_states.py PROGRAM CALL_FAULTS.so OPEN_SWEEPS [--quick] [--study NAME]... [--pairs N] [--seed N]

The changes that a command makes on the disk are written down by the preloaded library; crash_model.py says which states
a crash may leave. Every different state is rebuilt in memory (/dev/shm). Folders of sweeps are opened by OPEN_SWEEPS, with
the runner's own code; of all states that come out alike after that, the program itself completes one.
  lost   a trial is not there, though the runner had gone on to something else; or a result, though the command had ended
  half   something that is taken for whole is not
  stuck  the same command does not complete with the results of an undisturbed run
"""
import argparse
import collections
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import crash_model
import studies
from fork_server import ForkServer

QUICK_PAIRS, PAIRS = 2, 400
EXAMPLES = 5  # of violations to print


class Opener:
    """Opens folders as the runner does."""

    def __init__(self, program, sweep):
        self.process = subprocess.Popen([str(program), str(sweep)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def open(self, folder):
        self.process.stdin.write(f"{folder}\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"the opener died of {folder}")
        return json.loads(line)

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class Place:
    """Rebuilds trees below a folder. Contents are links to one file each: the program replaces files, it does not
    write into them, except locks."""

    def __init__(self, folder):
        self.folder, self.store = folder / "state", folder / "contents"
        self.store.mkdir(parents=True)

    def put(self, tree, contents):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir()
        for name in sorted(tree):
            path = f"{self.folder}/{name}"
            if tree[name] is None:
                os.mkdir(path)
            elif name.endswith(".lock"):
                pathlib.Path(path).write_bytes(contents[tree[name]])
            else:
                os.link(self.stored(tree[name], contents), path)

    def stored(self, digest, contents):
        path = f"{self.store}/{digest.hex()}"
        if not os.path.exists(path):
            pathlib.Path(path).write_bytes(contents[digest])
        return path

    def tree(self):
        found = {}
        for above, folders, files in os.walk(self.folder):
            for name in (*folders, *files):
                path = os.path.join(above, name)
                content = None if name in folders else hashlib.sha256(pathlib.Path(path).read_bytes()).digest()
                found[os.path.relpath(path, self.folder)] = content
        return found


def below(tree, folder):
    """What is in a folder of a tree, and the folder itself."""
    return {name: content for name, content in tree.items() if name == folder or name.startswith(folder + "/")}


class SweepChecks:
    """Of a sweep's folder `out`."""

    def __init__(self, study, trace, opener):
        self.opener, self.trace = opener, trace
        self.final = trace.tree(len(trace.changes), {})
        self.trials = {name.split("/")[2] for name in self.final if name.count("/") == 2 and name.startswith("out/trials/")}
        self.safe_from = {trial: self.passed_by(trial) for trial in self.trials}
        # Before the command has replaced it, an earlier whole one is as good.
        start = trace.tree(0, {})
        self.earlier = {trial: below(start, f"out/trials/{trial}") for trial in self.trials}
        self.earlier_hidden = {trial: below(start, f"out/trials/.old-{trial}") for trial in self.trials}

    def passed_by(self, trial):
        """The number of changes after which the runner had gone on to something else than storing it."""
        changes = self.trace.changes
        stored = [number for number, change in enumerate(changes)
                  if change.what == "rename" and change.names[1][1] == trial]
        if not stored:
            return 0
        following = stored[-1] + 1
        while following < len(changes) and changes[following].what in ("sync", "unlink", "rmdir"):
            following += 1
        return following + 1

    def required(self, after):
        return {trial for trial, number in self.safe_from.items() if after >= number} | \
               {trial for trial in self.trials if self.earlier[trial] or self.earlier_hidden[trial]}

    def look(self, place):
        """(what is there, what is wrong with it, what the state amounts to)."""
        opened = self.opener.open(place.folder / "out")
        tree = place.tree()
        wrong = [f"cannot be opened: {opened['error']}"] if "error" in opened else []
        wrong += [f"broken record: {flaw}" for flaw in opened.get("broken", {}).values()]
        there = set()
        for trial in opened.get("trials", {}):
            if self.is_whole(tree, trial):
                there.add(trial)
            else:
                wrong.append(f"half a trial: {trial}")
        for key, flaw in opened.get("references", {}).items():
            if flaw or tree[f"out/references/{key}.exr"] != self.final[f"out/references/{key}.exr"]:
                wrong.append(f"half a reference: {flaw}")
        return there, wrong, crash_model.digest_of({name: content for name, content in tree.items()
                                                    if not name.endswith(".lock")})

    def is_whole(self, tree, trial):
        name = f"out/trials/{trial}"
        hidden = {file.replace(".old-", "", 1): content for file, content in self.earlier_hidden[trial].items()}
        return below(tree, name) in (below(self.final, name), self.earlier[trial], hidden)

    def lacks_at_the_end(self, tree):
        names = [name for name in self.final if name.startswith(("out/references/", "out/report/")) or
                 name in ("out/records.csv", "out/records.jsonl", "out/plan.json", "out/environment.json")]
        return [name for name in names if tree.get(name, "") != self.final[name]]


class FileChecks:
    """Of files and folders that are whole or absent."""

    def __init__(self, study, trace, _):
        self.final = trace.tree(len(trace.changes), {})
        self.start = trace.tree(0, {})
        self.outputs = getattr(study, "files", None) or (study.output,)

    def required(self, _):
        return set()

    def look(self, place):
        tree = place.tree()
        wrong = []
        for output in self.outputs:
            found = self.of(tree, output)
            if found and found not in (self.of(self.final, output), self.of(self.start, output)):
                wrong.append(f"half of {output}")
        # What is left of one that was stopped counts by what the next one looks at.
        part = below(tree, f"{self.outputs[0]}.part")
        left = (bool(part), len(part) > 1, f"{self.outputs[0]}.part/.lock" in part)
        whole = {name: content for output in self.outputs for name, content in self.of(tree, output).items()}
        return set(), wrong, crash_model.digest_of(whole) + repr(left).encode()

    @staticmethod
    def of(tree, output):
        return {name: content for name, content in below(tree, output).items() if not name.endswith("/.lock")}

    def lacks_at_the_end(self, tree):
        return [output for output in self.outputs if self.of(tree, output) != self.of(self.final, output)]


class Hunt:
    """All states of one study."""

    def __init__(self, study, server, opener_program, scratch, options):
        self.study, self.server, self.scratch, self.options = study, server, scratch, options
        shutil.rmtree(scratch, ignore_errors=True)
        self.template, case = scratch / "template", scratch / "case"
        study.prepare(server, self.template)
        shutil.copytree(self.template, case)
        before = crash_model.snapshot(case)
        changes = scratch / "changes"
        run = server.run(case, *study.arguments, root=case, trace=changes)
        if run.code != 0:
            raise SystemExit(f"{study.name}: exit code {run.code}: {run.err}")
        self.whole = study.results(case)
        self.trace = crash_model.Trace(str(case), before).read(changes)
        self.require_true_model(case)
        self.is_sweep = isinstance(study, studies.Sweep)
        self.opener = Opener(opener_program, self.template / "sweep.json") if self.is_sweep else None
        self.checks = (SweepChecks if self.is_sweep else FileChecks)(study, self.trace, self.opener)
        self.place = Place(scratch)
        self.seen, self.outcomes = {}, {}
        self.states, self.counts, self.examples = 0, collections.Counter(), collections.defaultdict(list)

    def require_true_model(self, case):
        """With nothing missing, the changes make what is on the disk."""
        model = self.trace.tree(len(self.trace.changes), {})
        place = Place(self.scratch / "model")
        place.folder = case
        if model != place.tree():
            names = {name for name in {**model, **place.tree()} if model.get(name, "") != place.tree().get(name, "")}
            raise SystemExit(f"{self.study.name}: the trace does not explain {names}")

    def run(self):
        generator = random.Random(self.options.seed)
        ended = len(self.trace.changes)
        for after, left_out in self.trace.states(generator, self.options.pairs):
            self.states += 1
            tree = self.trace.tree(after, left_out)
            state = crash_model.digest_of(tree)
            if state not in self.seen:
                self.seen[state] = self.look(tree, after, left_out)
            missing = self.checks.required(after) - self.seen[state]
            if missing:
                self.report("lost", after, left_out, sorted(missing))
            if after == ended and (lacks := self.checks.lacks_at_the_end(tree)):
                self.report("lost", after, left_out, lacks)
        for tree, after, left_out in self.outcomes.values():
            self.go_on(tree, after, left_out)
        if self.opener:
            self.opener.close()
        return self

    def look(self, tree, after, left_out):
        self.place.put(tree, self.trace.contents)
        there, wrong, outcome = self.checks.look(self.place)
        if wrong:
            self.report("half", after, left_out, wrong)
        self.outcomes.setdefault(outcome, (tree, after, left_out))
        return there

    def go_on(self, tree, after, left_out):
        self.place.put(tree, self.trace.contents)
        folder = self.place.folder
        if not self.is_sweep and not self.checks.lacks_at_the_end(tree):
            self.study.discard(folder)
        run = self.server.run(folder, *self.study.again(folder))
        if run.code != 0:
            self.report("stuck", after, left_out, [f"exit code {run.code}: {run.err.strip()[-300:]}"])
        elif self.study.results(folder) != self.whole:
            self.report("stuck", after, left_out, ["other results"])
        elif left := studies.leftovers(folder):
            if self.is_sweep:
                self.report("stuck", after, left_out, left)

    def report(self, kind, after, left_out, what):
        self.counts[kind] += 1
        if len(self.examples[kind]) < EXAMPLES:
            changes = [f"{variant} {self.told(number)}" for number, variant in left_out.items()]
            last = self.told(after - 1) if after else "the start"
            self.examples[kind].append(f"{kind}: after {last}, {'; '.join(changes) or 'nothing missing'}: {what}")

    def told(self, number):
        change = self.trace.changes[number]
        return f"{number} {change.what} " + " ".join(name for _, name, _ in change.names)

    def row(self):
        syncs = sum(change.what == "sync" for change in self.trace.changes)
        return (f"| {self.study.name} | {len(self.trace.changes) - syncs} | {syncs} | {self.states} | {len(self.seen)} | "
                f"{len(self.outcomes)} | {self.counts['lost']} | {self.counts['half']} | {self.counts['stuck']} |")


HEAD = """| command | changes | fsyncs | states | different | outcomes completed | lost | half | stuck |
|---|--:|--:|--:|--:|--:|--:|--:|--:|"""
STUDIES = [study for study in studies.STUDIES if study.name not in ("photon map loaded", "report")]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("opener", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--study", action="append", choices=[study.name for study in STUDIES])
    parser.add_argument("--pairs", type=int, help="most states with two changes missing, for each instant")
    parser.add_argument("--seed", type=int, default=1996)
    options = parser.parse_args()
    options.pairs = options.pairs or (QUICK_PAIRS if options.quick else PAIRS)
    return options


def main():
    options = arguments()
    memory = pathlib.Path("/dev/shm")
    hunts, started = [], time.monotonic()
    with tempfile.TemporaryDirectory(prefix="causticbench-crashes-", dir=memory if memory.is_dir() else None) as scratch:
        server = ForkServer(options.program.resolve(), options.library.resolve(), scratch)
        print(HEAD, flush=True)
        for study in STUDIES:
            if options.study and study.name not in options.study:
                continue
            hunts.append(Hunt(study, server, options.opener.resolve(), pathlib.Path(scratch) / "study", options).run())
            print(hunts[-1].row(), flush=True)
            for example in (text for examples in hunts[-1].examples.values() for text in examples):
                print(f"    {example}", flush=True)
        server.close()
    wrong = sum(sum(hunt.counts.values()) for hunt in hunts)
    print(f"{sum(hunt.states for hunt in hunts)} states, {sum(len(hunt.seen) for hunt in hunts)} different, {wrong} wrong, "
          f"{time.monotonic() - started:.0f} s")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
