#!/usr/bin/python3
"""Reproduces the figures, table cells and claims of the three papers, and writes results/papers/PAPER/.

Usage: tools/reproduce.sh [PAPER]... [--quick | --full] [--program PROGRAM]

PAPER: jensen1996, chuang1995, chen2011; without one, all three. A quick run (the default) takes at most 45 minutes for all on two
quiet cores; --full has more seeds and finer steps. It goes on where it was stopped: what has been rendered is in
results/papers/PAPER/trials. experiments/papers/PAPER.json has the paper's numbers and claims, the sweeps beside it what is
run. Exit codes: 0 done (whether claims hold or not), 1 a run failed, 2 bad input or usage, 130 interrupted.
"""
import argparse
import importlib
import pathlib
import sys
import time

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report import paper as papers_text
from report.program import BENCH, exit_code, machine
from report.records import RecordsError


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("papers", metavar="PAPER", nargs="*", help=f"{', '.join(papers_text.NAMES)} (default: all)")
    sizes = parser.add_mutually_exclusive_group()
    sizes.add_argument("--quick", action="store_true", help="at most 45 minutes for all (the default)")
    sizes.add_argument("--full", action="store_true", help="more seeds, finer steps")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH, help="causticbench (default: build/release/bin)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results" / "papers", metavar="DIR")
    parser.add_argument("--note", default="", help="said of the machine on each page, such as who else used it")
    chosen = parser.parse_args()
    unknown = [name for name in chosen.papers if name not in papers_text.NAMES]
    if unknown:
        parser.error(f"{unknown[0]}: no such paper (known: {', '.join(papers_text.NAMES)})")
    return chosen


def reproduce(name, chosen):
    from papers.entries import entries
    from papers.gallery import write_gallery
    from papers.page import tally, write_page
    from papers.part import Part
    from papers.study import Study

    start = time.monotonic()
    paper = papers_text.Paper(name)
    study = Study(paper, chosen.output, chosen.program.resolve(), chosen.full)
    part = Part()
    for number, module in enumerate(paper.text["parts"], 1):
        study.log(f"part {number} of {len(paper.text['parts'])}: {module}")
        part.add(importlib.import_module(f"papers.{module}").measure(study))
    found = entries(study, part)
    folders = [folder.parent for folder in sorted((study.output / "trials").glob("*/environment.json"))]
    where = machine(folders) + (f" {chosen.note}" if chosen.note else "")
    write_page(study.output, study, found, part, where)
    study.copy_records()
    write_gallery(chosen.output, map(papers_text.Paper, papers_text.NAMES))
    study.log(f"{tally(found)}; {(time.monotonic() - start) / 60:.1f} minutes; {study.output / 'index.html'}")


def run(chosen):
    if not chosen.program.exists():
        raise RecordsError(f"{chosen.program}: not there (tools/build.sh release causticbench, or --program)")
    for name in chosen.papers or papers_text.NAMES:
        reproduce(name, chosen)


def main():
    chosen = arguments()
    return exit_code("reproduce", lambda: run(chosen))


if __name__ == "__main__":
    sys.exit(main())
