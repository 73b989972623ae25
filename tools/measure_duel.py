#!/usr/bin/python3
"""Runs the duel of the methods (experiments/duel) and writes results/duel: which method is best where, with the numbers.

Usage: tools/duel.sh [--quick] [--only SCENE]... [--page]

On every scene each method's settings are searched on seeds of their own; what the search chooses runs again on the reported
seeds. It goes on where it was stopped. --quick takes two scenes, at most 15 minutes on two quiet cores; all took 82 minutes beside other
work, two trials at a time (`--jobs 2`).
--page makes the pages from the records that are there. Exit codes: 0 done, 1 a run failed, 2 bad input or usage, 130 interrupted.
"""
import argparse
import pathlib
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report.program import BENCH, exit_code
from report.records import RecordsError


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="two scenes, at most 15 minutes on two quiet cores")
    parser.add_argument("--only", action="append", default=[], metavar="SCENE", help="these scenes, or counts (repeatable)")
    parser.add_argument("--page", action="store_true", help="no runs: the pages from the records that are there")
    parser.add_argument("--jobs", type=int, default=1, help="trials at a time (default 1)")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH, help="causticbench (default: build/release/bin)")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="DIR", help="(default: results/duel, or results/duel/trials/quick)")
    parser.add_argument("--check", action="store_true", help="no runs: only whether these words are right")
    return parser.parse_args()


def run(chosen, output):
    from duel import contests, counts, folds, page, race

    duel = contests.Duel()
    known = [scene.name for scene in duel.scenes] + ["counts"]
    unknown = [name for name in chosen.only if name not in known]
    if unknown:
        raise RecordsError(f"--only {unknown[0]}: no such scene (known: {', '.join(known)})")
    if not chosen.page:
        if not chosen.program.exists():
            raise RecordsError(f"{chosen.program}: not there (tools/build.sh release causticbench, or --program)")
        held = race.Race(duel, output, chosen.program.resolve(), chosen.jobs, chosen.quick)
        if chosen.only:
            held.scenes = [scene for scene in duel.scenes if scene.name in chosen.only]
        held.seeds = held.pilot()
        if not chosen.quick and (not chosen.only or "counts" in chosen.only):
            counts.run(held)
            folds.run(held)
        held.run()
    page.write_all(duel, output, chosen.quick)


def main():
    chosen = arguments()
    if chosen.check:
        return 0
    output = (chosen.output or ROOT / "results" / "duel" / ("trials/quick" if chosen.quick else ".")).resolve()
    return exit_code("duel", lambda: run(chosen, output))


if __name__ == "__main__":
    sys.exit(main())
