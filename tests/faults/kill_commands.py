#!/usr/bin/python3
"""Kills the program, or one of its children, by SIGKILL at random moments, on the file system of a folder.

Usage: kill_commands.py PROGRAM CALL_FAULTS.so --folder FOLDER --log FILE [--kills N] [--seed N] [--seconds N]

After each kill every file under a final name must be whole and no finished trial lost or made again; then the same
command must complete with the results of an undisturbed run, killed again now and then on its way. Each kill is a line of
the log; started again with that log, it goes on to N.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import shutil
import signal
import sys
import time

import studies
from fork_server import ForkServer


class LongSweep(studies.Sweep):
    """Eight trials."""
    name = "sweep of 8"

    def prepare(self, server, folder):
        studies.write_inputs(folder, seeds=range(1, 9))


class TwoJobs(LongSweep):
    name = "sweep of 8, two at a time"
    arguments = (*studies.Sweep.arguments, "--jobs", "2")


KINDS = (LongSweep(), TwoJobs(), studies.Resumed(), studies.Forced(), studies.Merge(), studies.Reference(),
         studies.SavePhotons())
AGAIN = 0.4  # of the runs that go on are killed as well


def children(process):
    try:
        return [int(child) for child in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        return []


class Victim:
    """One command, prepared and timed once."""

    def __init__(self, study, server, folder):
        self.study, self.server = study, server
        self.template, self.folder = folder / "template", folder / "work"
        shutil.rmtree(folder, ignore_errors=True)
        study.prepare(server, self.template)
        self.renew()
        started = time.monotonic()
        server.run(self.folder, *study.arguments)
        self.seconds = time.monotonic() - started
        self.whole = study.results(self.folder)
        self.renew()

    def renew(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(self.template, self.folder)

    def kill(self, generator):
        """Kills one run; returns what was hit ("runner", "child" or "") and what is wrong then."""
        before = self.study.kept(self.folder)
        process = self.server.begin(self.folder, *self.study.again(self.folder))
        time.sleep(generator.uniform(0, 1.1 * self.seconds))
        hit = ""
        victims = children(process) if generator.random() < 0.4 else []
        for victim in victims or [process]:
            try:
                os.kill(victim, signal.SIGKILL)
                hit = "child" if victims else "runner"
            except ProcessLookupError:
                pass
        run = self.server.end(process)
        if run.code == 0 or run.hung:
            hit = "" if run.code == 0 and hit != "child" else hit
        wrong = ["hangs"] if run.hung else []
        wrong += self.study.wrong(self.folder, self.whole)
        after = self.study.kept(self.folder)
        wrong += [f"{name}: lost, or made again" for name in before if after.get(name) != before[name]]
        return hit, wrong

    def complete(self):
        """What is wrong with the same command, undisturbed."""
        whole = self.study.is_whole(self.folder, self.whole)
        run = None if whole else self.server.run(self.folder, *self.study.again(self.folder))
        if run and run.code != 0:
            return [f"does not go on: exit code {run.code}: {run.err[-300:]}"]
        if self.study.results(self.folder) != self.whole:
            return ["goes on to other results"]
        left = [] if whole else studies.leftovers(self.folder / self.study.output)
        self.renew()
        return [f"left behind: {', '.join(left)}"] if left else []


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--folder", type=pathlib.Path, required=True)
    parser.add_argument("--log", type=pathlib.Path, required=True)
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1996)
    parser.add_argument("--seconds", type=float, default=1e9, help="stops after so many, to be started again")
    return parser.parse_args()


def lines_of(log):
    return [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []


def main():
    options = arguments()
    known = lines_of(options.log)
    done = sum(bool(line["hit"]) for line in known)
    generator = random.Random(f"{options.seed} {done}")
    options.folder.mkdir(parents=True, exist_ok=True)
    server = ForkServer(options.program.resolve(), options.library.resolve(), options.folder.resolve())
    victims = [Victim(study, server, options.folder.resolve() / f"study{number}") for number, study in enumerate(KINDS)]
    started = time.monotonic()
    with open(options.log, "a", encoding="utf-8") as log:
        while done < options.kills and time.monotonic() - started < options.seconds:
            victim = generator.choice(victims)
            hit, wrong = victim.kill(generator)
            if wrong or generator.random() >= AGAIN:
                wrong += victim.complete()
            done += bool(hit)
            line = {"command": victim.study.name, "hit": hit, "wrong": wrong}
            log.write(json.dumps(line) + "\n")
            log.flush()
            if wrong:
                print(json.dumps(line), flush=True)
    server.close()
    report(lines_of(options.log))
    return 1 if any(line["wrong"] for line in lines_of(options.log)) else 0


def report(lines):
    print("| command | runner killed | child killed | ended before | wrong |\n|---|--:|--:|--:|--:|")
    for name in dict.fromkeys(line["command"] for line in lines):
        hits = collections.Counter(line["hit"] for line in lines if line["command"] == name)
        wrong = sum(bool(line["wrong"]) for line in lines if line["command"] == name)
        print(f"| {name} | {hits['runner']} | {hits['child']} | {hits['']} | {wrong} |")
    print(f"{sum(bool(line['hit']) for line in lines)} kills, {sum(bool(line['wrong']) for line in lines)} with something wrong")


if __name__ == "__main__":
    sys.exit(main())
