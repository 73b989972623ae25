#!/usr/bin/python3
"""Reproduces the figures, table cells and claims of the three papers, and writes a page for each.

Usage: tools/reproduce.sh [PAPER]... [--quick | --full | --smoke] [--only SECTION]... [-o DIR | --keep]
       tools/reproduce.sh [PAPER]... --list | --pages | --compare

PAPER: jensen1996, chuang1995, chen2011; without one, all three. A quick run (the default) takes some 45 minutes for all on two
quiet cores; --full has more seeds and finer steps; --smoke runs one section of one scene anew in less than five minutes. Other runs go
on where they were stopped: what has been rendered is in DIR/PAPER/trials. DIR is out/papers (out/papers-smoke with --smoke), which
git ignores; --keep writes results/papers instead, the published pages. experiments/papers/PAPER.json has the paper's numbers and claims,
the sweeps beside it what is run. --list prints the sections. --only runs single sections and keeps the rows of the others, where DIR
has any; --pages runs nothing and writes the pages anew from verdicts.json and tables.json; --compare holds DIR's records to those that
the last commit publishes.
Exit codes: 0 done (whether claims hold or not), 1 a run failed, 2 bad input or usage, 130 interrupted.
"""
import argparse
import csv
import importlib
import io
import pathlib
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
COMPARED = ("picture_hash", "beam_point_hits", "photons_stored")
SMOKE = ("chen2011", "prism")  # one scene, three seeds, judged by a closed form
sys.path.insert(0, str(ROOT / "tools"))

from report import paper as papers_text
from report.program import BENCH, OWN, exit_code, machine, output_folder
from report.records import RecordsError

SMOKED = OWN / "papers-smoke"


def arguments():
    parser = argparse.ArgumentParser(prog="tools/reproduce.sh", description=__doc__.split("\n\n")[0], allow_abbrev=False)
    parser.add_argument("papers", metavar="PAPER", nargs="*", help=f"{', '.join(papers_text.NAMES)} (default: all)")
    sizes = parser.add_mutually_exclusive_group()
    sizes.add_argument("--quick", action="store_true", help="some 45 minutes for all (the default)")
    sizes.add_argument("--full", action="store_true", help="more seeds, finer steps")
    sizes.add_argument("--smoke", action="store_true", help=f"one section ({' '.join(SMOKE)}), less than five minutes")
    parser.add_argument("--only", action="append", default=[], metavar="SECTION", help="this section (repeatable); the rest is kept")
    parser.add_argument("--list", action="store_true", help="no runs: the sections of the papers")
    parser.add_argument("--pages", action="store_true", help="no runs: the pages from what is there")
    parser.add_argument("--compare", action="store_true", help="no runs: the records beside those of the last commit, by trial")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH, help="causticbench (default: build/release/bin)")
    folders = parser.add_mutually_exclusive_group()
    folders.add_argument("-o", "--output", type=pathlib.Path, metavar="DIR", help="where results go (default: out/papers)")
    folders.add_argument("--keep", action="store_true", help="results go to results/papers, the published pages")
    parser.add_argument("--note", default="", help="said of the machine on each page, such as who else used it")
    parser.add_argument("--check", action="store_true", help="no runs: only whether these words are right")
    chosen = parser.parse_args()
    if chosen.smoke and (chosen.papers or chosen.only or chosen.keep):
        parser.error("--smoke: without a paper, --only and --keep")
    if sum((bool(chosen.only), chosen.pages, chosen.compare, chosen.list)) > 1:
        parser.error("--only, --list, --pages, --compare: one of them")
    if chosen.compare and chosen.full:
        parser.error("--compare: without --full")
    unknown = [name for name in chosen.papers if name not in papers_text.NAMES]
    if unknown:
        parser.error(f"{unknown[0]}: no such paper (known: {', '.join(papers_text.NAMES)})")
    return settled(chosen)


def settled(chosen):
    """The same with --smoke's section and the folder of the results."""
    usual = papers_text.PUBLISHED if chosen.keep else SMOKED if chosen.smoke else OWN / "papers"
    chosen.output = output_folder(chosen.output, usual)
    if chosen.smoke and not chosen.list:
        paper, section = SMOKE
        chosen.papers, chosen.only = [paper], [] if chosen.pages or chosen.compare else [section]
    chosen.papers = chosen.papers or list(papers_text.NAMES)
    return chosen


def reproduce(name, chosen):
    from papers import kept
    from papers.page import tally, write_gallery, write_page
    from papers.part import Part
    from papers.study import Study

    start = time.monotonic()
    paper = papers_text.Paper(name)
    study = Study(paper, chosen.output, chosen.program.resolve(), chosen.full)
    sections = kept.sections(importlib.import_module(f"papers.{module}") for module in paper.text["parts"])
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


def sections_of(name):
    """The sections of a paper, in their order."""
    from papers.kept import section_names

    return [section for module in papers_text.Paper(name).text["parts"] for section in section_names(module)]


def check(chosen):
    """Raises where --only names what no chosen paper has, and where --pages finds no earlier run."""
    known = {name: sections_of(name) for name in chosen.papers}
    for section in chosen.only:
        if not any(section in own for own in known.values()):
            raise RecordsError(f"--only {section}: no such section (known: {'; '.join(f'{name}: ' + ', '.join(own) for name, own in known.items())})")
    for name in chosen.papers:
        if chosen.pages and not (chosen.output / name / "tables.json").is_file():
            raise RecordsError(f"{chosen.output / name}: no earlier run (run tools/reproduce.sh {name} first, or choose its folder by -o)")


def print_sections(names):
    for name in names:
        paper = papers_text.Paper(name)
        print(f"{name}: {paper.text['author']}, {paper.text['title']}", *(f"  {section}" for section in sections_of(name)), sep="\n")


def compare(names, output):
    """Counts trials whose picture, beam-point hits or photons are not those that the last commit publishes."""
    files = sorted(path for name in names for path in (output / name / "records").glob("*.csv"))
    if not files:
        raise RecordsError(f"--compare: {output}: no records (run tools/reproduce.sh first, or choose its folder by -o)")
    for file in files:
        published = papers_text.PUBLISHED.relative_to(ROOT) / file.relative_to(output)
        shown = subprocess.run(["git", "-C", ROOT, "show", f"HEAD:{published}"], capture_output=True, text=True)
        if shown.returncode != 0:
            raise RecordsError(f"{file}: the last commit has no {published}")
        before, now = by_trial(shown.stdout), by_trial(file.read_text(encoding="utf-8"))
        both = before.keys() & now.keys()
        differ = sorted(trial for trial in both if before[trial] != now[trial])
        print(f"{file.relative_to(output)}: {len(both)} trials in both, {len(differ)} differ, {len(before.keys() ^ now.keys())} in one only", *differ)


def by_trial(text):
    rows = csv.DictReader(io.StringIO(text))
    return {row["trial"]: [row.get(name, "") for name in COMPARED] for row in rows if "trial" in row and "picture_hash" in row}


def run(chosen):
    check(chosen)
    if chosen.check:
        return
    if chosen.list:
        return print_sections(chosen.papers)
    if chosen.compare:
        return compare(chosen.papers, chosen.output)
    if not chosen.program.exists() and not chosen.pages:
        raise RecordsError(f"{chosen.program}: not there (tools/build.sh release causticbench, or --program)")
    if chosen.smoke and chosen.output == SMOKED:
        shutil.rmtree(SMOKED, ignore_errors=True)  # it runs anew each time
    for name in chosen.papers:
        if not chosen.only or set(chosen.only) & set(sections_of(name)):
            reproduce(name, chosen)


def main():
    chosen = arguments()
    return exit_code("reproduce", lambda: run(chosen))


if __name__ == "__main__":
    sys.exit(main())
