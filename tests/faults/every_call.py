#!/usr/bin/python3
"""Makes every call of the program for memory or to the system fail in turn, and sees that nothing else does.

Usage: every_call.py PROGRAM CALL_FAULTS.so [--quick] [--study NAME]... [--error NAME]... [--every N] [--violations FILE]

Each case is one command with one failing call: its nth allocation without memory (ENOMEM), or its nth call to the
system with a chosen error, or only half done. It must end by itself with an exit code of the program and a message or a
row; leave no file under a final name that is not whole, and lose nothing; and the same command without faults must then
complete with the results of an undisturbed run. --quick takes a few calls of each command, drawn with the seed.
"""
import argparse
import collections
import errno
import json
import pathlib
import random
import shutil
import signal
import sys
import tempfile
import time

import studies
from fork_server import ForkServer
from studies import STUDIES, leftovers

ERRORS = {"ENOMEM": ("memory", errno.ENOMEM), "EIO": ("io", errno.EIO), "ENOSPC": ("io", errno.ENOSPC),
          "EINTR": ("io", errno.EINTR), "EMFILE": ("io", errno.EMFILE), "half": ("io", -1),
          "full disk": ("room", errno.ENOSPC), "no memory": ("memory", errno.ENOMEM)}
LASTING = ("full disk", "no memory")  # from the nth call on
EVERY = {"EIO": 1, "ENOSPC": 4, "EINTR": 4, "EMFILE": 4, "half": 4, "full disk": 1}  # so manyth call
MOST = {"ENOMEM": 150, "no memory": 30}  # allocations of a command, evenly spread
QUICK = 2


def fault_of(name):
    kind, number = ERRORS[name]
    return {"kind": kind, "error": number, "sticky": name in LASTING}


def has_died(run):
    """Without memory: libraries promise not to throw where they ask for some (results/reliability/faults.md says which).
    Nothing may be lost or half-written then, as ever."""
    return run.code in (-signal.SIGABRT, -signal.SIGSEGV) and run.fired > 0 and run.path == "" and run.call in (
        "malloc", "calloc", "realloc", "posix_memalign", "aligned_alloc", "memalign", "mmap")


class Case:
    """A command with one fault, and the same without."""

    def __init__(self, server, study, template, whole, folder):
        self.server, self.study, self.template, self.whole, self.folder = server, study, template, whole, folder

    def run(self, fault):
        """Returns the run and what is wrong."""
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(self.template, self.folder, symlinks=True)
        before = self.study.kept(self.folder)
        run = self.server.run(self.folder, *self.study.arguments, timeout=20, **fault)
        wrong = self.ended_badly(run)
        if not self.says_what_is_missing(run):
            wrong += self.study.wrong(self.folder, self.whole)
        wrong += self.lost(before)
        if run.code == 0:
            wrong += self.silently_other(run)
        wrong += self.cannot_go_on(run)
        return run, wrong

    def ended_badly(self, run):
        if run.hung:
            return ["hangs"]
        if has_died(run):
            return []
        if run.code < 0:
            return [f"signal {-run.code}"]
        if run.code not in (0, 1, 2, 3):
            return [f"exit code {run.code}"]
        speechless = run.call == "fwrite" or run.path.endswith((".err", ".out"))
        if run.code != 0 and run.fired == 1 and not speechless and "error: " not in run.err and "failed: " not in run.err \
                and ": left: " not in run.err and f"{self.study.name}: " not in run.err:
            return [f"exit code {run.code} without a message"]
        return []

    def lost(self, before):
        after = self.study.kept(self.folder)
        return [f"{name}: lost" for name, bytes_of in before.items() if bytes_of and after.get(name) != bytes_of]

    @staticmethod
    def says_what_is_missing(run):
        """Pictures that cannot be read may be left out of what is made of them, with a line that names them."""
        return run.code == 0 and ("note: " in run.err or "warning: " in run.err)

    def silently_other(self, run):
        try:
            results = self.study.results(self.folder)
        except (OSError, ValueError) as error:
            return [f"exit code 0, but {error!r}"]
        if results == self.whole:
            return []
        if self.says_what_is_missing(run) and studies.without_derived(results) == studies.without_derived(self.whole):
            return []
        return ["exit code 0, but other results"]

    def cannot_go_on(self, before):
        # What was made, and could not be said to be on the disk, is whole as well.
        if before.code == 0 or self.study.is_whole(self.folder, self.whole):
            self.study.discard(self.folder)
        run = self.server.run(self.folder, *self.study.again(self.folder))
        if run.code != 0:
            return [f"does not go on: exit code {run.code}: {run.err.strip()[-300:]}"]
        if self.study.results(self.folder) != self.whole:
            return ["goes on to other results"]
        left = leftovers(self.folder)
        return [f"left behind: {', '.join(left)}"] if left else []


class Table:
    """Cases and what came of them, a row for each command and error."""
    OUTCOMES = ("0", "1", "2", "3", "died")

    def __init__(self):
        self.rows, self.violations = [], []

    def add(self, study, error, calls, stride, cases, outcomes, violations):
        self.rows.append((study, error, calls, stride, cases, outcomes, len(violations)))
        self.violations += [{"study": study, "error": error, **each} for each in violations]

    def text(self):
        lines = ["| command | fails with | calls | every | cases | exit 0 | 1 | 2 | 3 | died | violations |",
                 "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
        for study, error, calls, stride, cases, outcomes, wrong in self.rows:
            ends = " | ".join(str(outcomes[code]) for code in self.OUTCOMES)
            lines.append(f"| {study} | {error} | {calls} | {stride} | {cases} | {ends} | {wrong} |")
        return "\n".join(lines) + "\n"


class Hunt:
    def __init__(self, server, scratch, options):
        self.server, self.scratch, self.options = server, scratch, options
        self.generator = random.Random(options.seed)
        self.table = Table()

    def study(self, study):
        template, folder = self.scratch / "template", self.scratch / "case"
        shutil.rmtree(template, ignore_errors=True)
        study.prepare(self.server, template)
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(template, folder, symlinks=True)
        undisturbed = self.server.run(folder, *study.arguments)
        if undisturbed.code != 0:
            raise SystemExit(f"{study.name}: exit code {undisturbed.code} without faults: {undisturbed.err}")
        case = Case(self.server, study, template, study.results(folder), folder)
        for name in self.options.error or ERRORS:
            self.errors(study, case, name)

    def errors(self, study, case, name):
        # Of the Python that makes reports, only what it does with the files of the study.
        fault = fault_of(name)
        if study.name == "report" and fault["kind"] == "memory":
            return
        fault["root"] = case.folder if study.name == "report" or fault["kind"] == "room" else ""
        calls = case.run(dict(fault, nth=0))[0].count
        numbers = self.chosen(name, calls)
        outcomes, violations = collections.Counter(), []
        for nth in numbers:
            run, wrong = case.run(dict(fault, nth=nth))
            outcomes["died" if has_died(run) else str(run.code)] += 1
            if wrong:
                violations.append({"nth": nth, "call": run.call, "path": run.path, "code": run.code, "wrong": wrong,
                                   "err": run.err[-400:]})
        stride = numbers[1] - numbers[0] if len(numbers) > 1 and not self.options.quick else "-"
        self.table.add(study.name, name, calls, stride, len(numbers), outcomes, violations)
        print(self.table.text().splitlines()[-1], flush=True)
        for each in violations[:20]:
            print("   ", json.dumps(each), flush=True)

    def chosen(self, name, calls):
        if self.options.quick:
            return sorted(self.generator.sample(range(1, calls + 1), min(QUICK, calls)))
        stride = self.options.every * (EVERY[name] if name in EVERY else max(1, calls // MOST[name]))
        # The errors that take turns begin at different calls.
        return list(range(1 + list(ERRORS).index(name) % stride, calls + 1, stride))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--study", action="append", choices=[study.name for study in STUDIES])
    parser.add_argument("--error", action="append", choices=list(ERRORS))
    parser.add_argument("--every", type=int, default=1, help="only every Nth of the calls that are chosen")
    parser.add_argument("--seed", type=int, default=1996)
    parser.add_argument("--violations", type=pathlib.Path, help="writes them there, as JSON")
    return parser.parse_args()


def main():
    options = arguments()
    started = time.monotonic()
    memory = pathlib.Path("/dev/shm")
    place = memory if memory.is_dir() else None
    with tempfile.TemporaryDirectory(prefix="causticbench-faults-", dir=place) as scratch:
        server = ForkServer(options.program.resolve(), options.library.resolve(), scratch)
        hunt = Hunt(server, pathlib.Path(scratch), options)
        for study in STUDIES:
            if not options.study or study.name in options.study:
                hunt.study(study)
        server.close()
    if options.violations:
        options.violations.write_text(json.dumps(hunt.table.violations, indent=1))
    cases = sum(row[4] for row in hunt.table.rows)
    print(f"{cases} cases, {len(hunt.table.violations)} with something wrong, {time.monotonic() - started:.0f} s")
    return 1 if hunt.table.violations else 0


if __name__ == "__main__":
    sys.exit(main())
