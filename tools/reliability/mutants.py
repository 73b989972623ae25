#!/usr/bin/python3
"""Mutates sources and counts how many mutants the tests notice.

All mutants are compiled at once into a copy of the sources (mutant schemata): each site asks at run time whether its
mutant is on. Every test runs once without a mutant, which says how long it takes and which sites it reaches; then each
mutant meets the tests that reach it, until one fails, dies or takes ten times its time and 5 s more. Results are kept
in DIR/build/mutants.jsonl, a line a trial, and a run that is stopped goes on there. What survived is tried again by a
run with more seconds, labels or tests: that is the next round.
Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import dataclasses
import json
import pathlib
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "reliability"))

from mutation import page, suite  # noqa: E402
from mutation.drawing import Parser, draw  # noqa: E402
from mutation.sandbox import Sandbox  # noqa: E402
from mutation.sites import Site  # noqa: E402
from mutation.tree import Tree  # noqa: E402
from mutation.trial import Trials  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("files", nargs="+", metavar="FILE", help="sources and headers, from the root of the sources")
    parser.add_argument("--seed", type=int, default=1, help="of the draw (default: 1)")
    parser.add_argument("--count", type=int, default=1000, help="mutants to draw (default: 1000)")
    parser.add_argument("--first", type=int, metavar="N", help="judge only the first N of those drawn")
    parser.add_argument("--tree", type=pathlib.Path, required=True, metavar="DIR", help="the copy; kept for the next time")
    parser.add_argument("--memory", type=pathlib.Path, default=pathlib.Path("/dev/shm/caustics_mutants"), metavar="DIR",
                        help="where tests write (default: /dev/shm/caustics_mutants)")
    parser.add_argument("--labels", default="unit,statistical,agreement", help="of the tests, as ctest knows them")
    parser.add_argument("--budget", type=float, default=30, help="seconds of tests for a mutant (default: 30)")
    parser.add_argument("--slowest", type=float, default=10, help="tests that take longer are left out (default: 10 s)")
    parser.add_argument("--judged", type=pathlib.Path, metavar="FILE",
                        help="what survivors are: lines of number, class and reason with tabs between; not tried again")
    parser.add_argument("--jobs", type=int, default=2, help="compilers at once (default: 2)")
    return parser.parse_args()


def sites_of(options, tree, kept):
    """The drawn sites that compile: those of the run before, or new ones, and the build that holds them."""
    asked = {"files": options.files, "seed": options.seed, "count": options.count}
    if kept.exists():
        before = json.loads(kept.read_text(encoding="utf-8"))
        if before["asked"] != asked:
            raise ValueError(f"{kept} is of another draw; take it away for a new one")
        return [Site(**site) for site in before["sites"]]
    tree.copy()
    tree.configure()
    sites, places = draw(Parser(ROOT, tree.path, tree.build), options.files, options.seed, options.count, options.jobs)
    print(f"{len(sites)} sites of {places} places drawn", flush=True)
    # A copy that was never built does not know its tests: everything is built then.
    programs = sorted({pathlib.Path(test.program).name for test in suite.listed(tree.build, labels(options))})
    sites = tree.compile(sites, options.files, programs)
    kept.write_text(json.dumps({"asked": asked, "places": places,
                                "sites": [dataclasses.asdict(site) for site in sites]}), encoding="utf-8")
    return sites


def labels(options):
    return set(options.labels.split(","))


def tests_of(options, tree, kept):
    """The tests of the labels that pass without a mutant, with their times and reach; those not tried before are tried."""
    known = {row["name"]: row for row in json.loads(kept.read_text(encoding="utf-8"))} if kept.exists() else {}
    tests = suite.listed(tree.build, labels(options))
    new = [test for test in tests if test.name not in known]
    boxes = [Sandbox(options.memory / f"first{i}", tree.path) for i in range(options.jobs)]

    def try_part(i):
        return [(test, suite.try_out(test, boxes[i], options.slowest)) for test in new[i::options.jobs]]

    with ThreadPoolExecutor(options.jobs) as pool:
        for test, trouble in (pair for part in pool.map(try_part, range(options.jobs)) for pair in part):
            if trouble:
                print(f"left out: {test.name} {trouble}", flush=True)
            else:
                known[test.name] = {**dataclasses.asdict(test), "reached": sorted(test.reached)}
                known[test.name]["since"] = time.time()
    kept.write_text(json.dumps(list(known.values())), encoding="utf-8")
    rows = [known[test.name] for test in tests if test.name in known]
    return [suite.Test(**{**row, "reached": frozenset(row["reached"])}) for row in rows]


def judge_all(options, tree, sites, tests, words):
    """Judges what has no line in the results yet, and what survived where there is more to ask, unless there is a word on
    it; a line a trial."""
    results = tree.build.parent / "mutants.jsonl"
    lines = results.read_text(encoding="utf-8").splitlines() if results.exists() else []
    rows = list(map(json.loads, lines))
    last = {row["number"]: row for row in rows}
    trials = Trials(tests, Sandbox(options.memory / "trial", tree.path), options.budget)
    for site in sites:
        if site.number in last:
            trials.remember(site, last[site.number]["by"])
    with results.open("a", encoding="utf-8") as file:
        for site in sites[:options.first]:
            row = None if site.number in words else trials.judge(site, last.get(site.number))
            if row:
                rows.append(row)
                file.write(json.dumps(row) + "\n")
                file.flush()
    return rows


def main():
    options = arguments()
    options.tree, options.memory = options.tree.resolve(), options.memory.resolve()
    tree = Tree(ROOT, options.tree, options.jobs)
    (tree.path / "build").mkdir(parents=True, exist_ok=True)
    try:
        sites = sites_of(options, tree, tree.path / "build" / "mutant_sites.json")
        tests = tests_of(options, tree, tree.path / "build" / "mutant_tests.json")
        words = page.words(options.judged) if options.judged else {}
        print(page.text(sites, judge_all(options, tree, sites, tests, words), words))
    except (ValueError, OSError, subprocess.CalledProcessError) as error:
        print(f"mutants: error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
