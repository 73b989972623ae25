#!/usr/bin/python3
"""Runs the duel of the methods (experiments/duel) and writes its pages: which method is best where, with the numbers.

Usage: tools/duel.sh [--quick | --smoke] [--only SCENE]... [--list | --page] [-o DIR | --keep]

On every scene each method's settings are searched on seeds of their own; what the search chooses runs again on the reported
seeds. It goes on where it was stopped. --quick takes two scenes, at most 15 minutes on two quiet cores; all took 82 minutes beside other
work, two trials at a time (`--jobs 2`). --smoke takes one scene, anew, in less than five minutes. DIR is out/duel (out/duel-quick,
out/duel-smoke), which git ignores; --keep writes results/duel instead, the published pages.
--list prints the scenes; --page makes the pages from the records that are there. Exit codes: 0 done, 1 a run failed, 2 bad input or
usage, 130 interrupted.
"""
import argparse
import os
import pathlib
import shutil
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report.program import BENCH, OWN, exit_code, output_folder
from report.records import RecordsError

SMOKED = OWN / "duel-smoke"


def arguments():
    parser = argparse.ArgumentParser(prog="tools/duel.sh", description=__doc__.split("\n\n")[0], allow_abbrev=False)
    sizes = parser.add_mutually_exclusive_group()
    sizes.add_argument("--quick", action="store_true", help="two scenes, at most 15 minutes on two quiet cores")
    sizes.add_argument("--smoke", action="store_true", help="one scene, less than five minutes on two cores")
    parser.add_argument("--only", action="append", default=[], metavar="SCENE", help="these scenes, or counts (repeatable)")
    parser.add_argument("--list", action="store_true", help="no runs: the scenes")
    parser.add_argument("--page", action="store_true", help="no runs: the pages from the records that are there")
    parser.add_argument("--jobs", type=int, metavar="N", help="trials at a time (default 1; 2 with --smoke)")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH, help="causticbench (default: build/release/bin)")
    folders = parser.add_mutually_exclusive_group()
    folders.add_argument("-o", "--output", type=pathlib.Path, metavar="DIR", help="where results go (default: out/duel)")
    folders.add_argument("--keep", action="store_true", help="results go to results/duel, the published pages")
    parser.add_argument("--check", action="store_true", help="no runs: only whether these words are right")
    chosen = parser.parse_args()
    if (chosen.quick or chosen.smoke) and (chosen.only or chosen.keep):
        parser.error("--quick, --smoke: without --only and --keep")
    if chosen.jobs is not None and chosen.jobs < 1:
        parser.error(f"--jobs {chosen.jobs}: at least 1")
    return settled(chosen)


def settled(chosen):
    """The same with the size of the run by its name, its trials at a time, and the folder of the results."""
    chosen.size = "quick" if chosen.quick else "smoke" if chosen.smoke else ""
    chosen.jobs = chosen.jobs or (min(2, os.cpu_count()) if chosen.smoke else 1)
    usual = {"quick": OWN / "duel-quick", "smoke": SMOKED, "": ROOT / "results" / "duel" if chosen.keep else OWN / "duel"}
    chosen.output = output_folder(chosen.output, usual[chosen.size])
    return chosen


def known_names():
    """The scenes and what else --only takes, with their titles."""
    from duel.contests import Duel

    return {scene.name: scene.title for scene in Duel().scenes} | {"counts": "tests and folds, counted"}


def run(chosen):
    known = known_names()
    unknown = [name for name in chosen.only if name not in known]
    if unknown:
        raise RecordsError(f"--only {unknown[0]}: no such scene (known: {', '.join(known)})")
    if chosen.check:
        return
    if chosen.list:
        return print(*(f"{name}: {title}" for name, title in known.items()), sep="\n")
    if not chosen.page:
        race(chosen)
    from duel import contests, page

    page.write_all(contests.Duel(), chosen.output)


def race(chosen):
    """Runs what has not been run yet."""
    if not chosen.program.exists():
        raise RecordsError(f"{chosen.program}: not there (tools/build.sh release causticbench, or --program)")
    from duel import contests, counts, folds, race as duel_race

    if chosen.smoke and chosen.output == SMOKED:
        shutil.rmtree(SMOKED, ignore_errors=True)  # it runs anew each time
    duel = contests.Duel()
    held = duel_race.Race(duel, chosen.output, chosen.program.resolve(), chosen.jobs, chosen.size, chosen.only)
    held.seeds = held.pilot()
    if not chosen.size and (not chosen.only or "counts" in chosen.only):
        counts.run(held)
        folds.run(held)
    held.run()


def main():
    chosen = arguments()
    return exit_code("duel", lambda: run(chosen))


if __name__ == "__main__":
    sys.exit(main())
