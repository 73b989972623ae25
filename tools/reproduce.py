#!/usr/bin/python3
"""Reproduces the figures, table cells and claims of the three papers, and writes results/papers/PAPER/.

Usage: tools/reproduce.sh [PAPER]... [--quick | --full] [--only SECTION]... [--pages | --compare] [--program PROGRAM]

PAPER: jensen1996, chuang1995, chen2011; without one, all three. A quick run (the default) takes some 45 minutes for all on two
quiet cores; --full has more seeds and finer steps. It goes on where it was stopped: what has been rendered is in
results/papers/PAPER/trials. experiments/papers/PAPER.json has the paper's numbers and claims, the sweeps beside it what is
run. --only runs single sections (the last table of a page names them) and keeps the other rows; --pages runs nothing and writes the
pages anew from verdicts.json and tables.json; --compare holds records/*.csv to those of the last commit.
Exit codes: 0 done (whether claims hold or not), 1 a run failed, 2 bad input or usage, 130 interrupted.
"""
import argparse
import csv
import importlib
import io
import pathlib
import subprocess
import sys
import time

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
COMPARED = ("picture_hash", "beam_point_hits", "photons_stored")
sys.path.insert(0, str(ROOT / "tools"))

from report import paper as papers_text
from report.program import BENCH, exit_code, machine
from report.records import RecordsError


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("papers", metavar="PAPER", nargs="*", help=f"{', '.join(papers_text.NAMES)} (default: all)")
    sizes = parser.add_mutually_exclusive_group()
    sizes.add_argument("--quick", action="store_true", help="some 45 minutes for all (the default)")
    sizes.add_argument("--full", action="store_true", help="more seeds, finer steps")
    parser.add_argument("--only", action="append", default=[], metavar="SECTION", help="this section (repeatable); the rest is kept")
    parser.add_argument("--pages", action="store_true", help="no runs: the pages from what is there")
    parser.add_argument("--compare", action="store_true", help="no runs: the kept records beside those of the last commit, by trial")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH, help="causticbench (default: build/release/bin)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results" / "papers", metavar="DIR")
    parser.add_argument("--note", default="", help="said of the machine on each page, such as who else used it")
    parser.add_argument("--check", action="store_true", help="no runs: only whether these words are right")
    chosen = parser.parse_args()
    if chosen.only and chosen.pages:
        parser.error("--only and --pages: one of the two")
    if chosen.compare and (chosen.only or chosen.pages or chosen.full or not chosen.output.resolve().is_relative_to(ROOT)):
        parser.error("--compare: alone, and of records in this project")
    unknown = [name for name in chosen.papers if name not in papers_text.NAMES]
    if unknown:
        parser.error(f"{unknown[0]}: no such paper (known: {', '.join(papers_text.NAMES)})")
    return chosen


def reproduce(name, chosen):
    from papers import kept
    from papers.page import tally, write_gallery, write_page
    from papers.part import Part
    from papers.study import Study

    start = time.monotonic()
    paper = papers_text.Paper(name)
    study = Study(paper, chosen.output, chosen.program.resolve(), chosen.full)
    sections = sections_of(paper)
    wanted = [each for each in sections if each in chosen.only] if partial(chosen) else list(sections)
    part = Part()
    for number, section in enumerate(wanted, 1):
        study.log(f"section {number} of {len(wanted)}: {section}")
        part.add(sections[section](study).of(section))
    where = f"{machine(study.folders())} {chosen.note}".strip() if study.done else ""  # nothing was timed without a sweep
    rows, pieces = kept.of_some(study, part, where, list(sections), wanted) if partial(chosen) else kept.of_whole_run(study, part, where)
    write_page(study.output, paper, rows, pieces, part.figures)
    study.copy_records(partial(chosen))
    write_gallery(chosen.output, map(papers_text.Paper, papers_text.NAMES))
    study.log(f"{tally(rows)}; {(time.monotonic() - start) / 60:.1f} minutes; {study.output / 'index.html'}")


def partial(chosen):
    return chosen.pages or bool(chosen.only)


def sections_of(paper):
    from papers.kept import sections

    return sections(importlib.import_module(f"papers.{module}") for module in paper.text["parts"])


def check_sections(chosen, names):
    """Raises where --only names what no chosen paper has, or where there is no earlier run to put a section's rows into."""
    known = {name: sections_of(papers_text.Paper(name)) for name in names}
    for section in chosen.only:
        if not any(section in own for own in known.values()):
            raise RecordsError(f"--only {section}: no such section (known: {'; '.join(f'{name}: ' + ', '.join(own) for name, own in known.items())})")
    for name in names:
        if partial(chosen) and not (chosen.output / name / "tables.json").is_file():
            raise RecordsError(f"{chosen.output / name}: no earlier run (run tools/reproduce.sh {name} first, without --only and --pages)")


def compare(names, output):
    """Counts trials whose picture, beam-point hits or photons are not those of the last commit."""
    for file in sorted(path for name in names for path in (output / name / "records").glob("*.csv")):
        shown = subprocess.run(["git", "-C", ROOT, "show", f"HEAD:{file.relative_to(ROOT)}"], capture_output=True, text=True)
        if shown.returncode != 0:
            raise RecordsError(f"{file}: the last commit has no such file")
        before, now = by_trial(shown.stdout), by_trial(file.read_text(encoding="utf-8"))
        both = before.keys() & now.keys()
        differ = sorted(trial for trial in both if before[trial] != now[trial])
        print(f"{file.relative_to(output)}: {len(both)} trials in both, {len(differ)} differ, {len(before.keys() ^ now.keys())} in one only", *differ)


def by_trial(text):
    rows = csv.DictReader(io.StringIO(text))
    return {row["trial"]: [row.get(name, "") for name in COMPARED] for row in rows if "trial" in row and "picture_hash" in row}


def run(chosen):
    if chosen.compare:
        return compare(chosen.papers or papers_text.NAMES, chosen.output.resolve())
    if not chosen.program.exists() and not chosen.pages:
        raise RecordsError(f"{chosen.program}: not there (tools/build.sh release causticbench, or --program)")
    names = chosen.papers or papers_text.NAMES
    check_sections(chosen, names)
    for name in names:
        if not chosen.only or set(chosen.only) & set(sections_of(papers_text.Paper(name))):
            reproduce(name, chosen)


def main():
    chosen = arguments()
    return 0 if chosen.check else exit_code("reproduce", lambda: run(chosen))


if __name__ == "__main__":
    sys.exit(main())
