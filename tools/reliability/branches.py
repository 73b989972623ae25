#!/usr/bin/env python3
"""Which outcomes of conditions the tests meet: builds preset `coverage` (clang++), runs the tests, prints a table.

What a child process that ends at once reaches is not counted, nor is what the kernels of instruction sets that this
processor lacks would do."""
import argparse
import fnmatch
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What computes light, and what keeps records; a * goes through folders.
SOURCES = """core/material/*.cpp core/light_path/*.cpp core/light_path/*.h core/math/sampling.h
photonmap/*.cpp photonmap/tree/*.h beamtree/*.cpp beamtree/light/*.h beamtree/slices/*.h
experiments/picture/metrics.cpp experiments/plan/record.cpp experiments/plan/trial_store.cpp experiments/run/*.cpp
experiments/sweep/*.cpp""".split()
LABELS = "unit|agreement|statistical|cli"


def run(command, **more):
    subprocess.run(command, check=True, cwd=ROOT, **more)


def programs(build):
    return sorted(path for path in [*build.glob("tests/test_*"), build / "bin/causticbench"]
                  if path.is_file() and os.access(path, os.X_OK))


def measure(build, profiles, labels):
    """Runs the tests; their counts end up in one file."""
    profiles.mkdir(parents=True, exist_ok=True)
    for old in profiles.glob("*.profraw"):
        old.unlink()
    counts = {"LLVM_PROFILE_FILE": str(profiles / "%8m.profraw")}
    code = subprocess.run(["ctest", "--test-dir", build, "-L", labels, "--parallel", str(os.cpu_count()), "--timeout",
                           "3600", "--output-on-failure"], cwd=ROOT, env=os.environ | counts).returncode
    if code != 0:
        print("branches: some tests fail; the table is of what they met", file=sys.stderr)
    run(["llvm-profdata", "merge", "-sparse", *profiles.glob("*.profraw"), "-o", profiles / "all.profdata"])


def exported(build, profiles):
    first, *others = programs(build)
    objects = [argument for program in others for argument in ("-object", program)]
    found = subprocess.run(["llvm-cov", "export", "-instr-profile", profiles / "all.profdata", first, *objects],
                           check=True, cwd=ROOT, stdout=subprocess.PIPE)
    return json.loads(found.stdout)["data"][0]["files"]


def outcomes(file, text):
    """Of each place of a condition in the text, how often it was true and false in all of its instances; those that the
    compiler decides are none."""
    found = {}
    for line, column, end, end_column, true, false, *_ in file.get("branches", []):
        if "if constexpr" in text[line - 1] or "requires" in text[line - 1]:
            continue
        before = found.get((line, column, end, end_column), (0, 0))
        found[line, column, end, end_column] = (before[0] + true, before[1] + false)
    return found


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("sources", nargs="*", default=SOURCES, help="patterns of paths; default: what computes light")
    arguments.add_argument("--labels", default=LABELS, help=f"of tests (default {LABELS})")
    arguments.add_argument("--missing", action="store_true", help="lists what no test meets")
    arguments.add_argument("--again", action="store_true", help="reads the counts of the last run")
    given = arguments.parse_args()
    build = ROOT / "build/coverage"
    profiles = build / "profiles"
    if not given.again:
        run(["bash", "tools/setup.sh", "clang", "llvm"])
        run(["bash", "tools/build.sh", "coverage"])
        measure(build, profiles, given.labels)
    rows = []
    missing = []
    for file in exported(build, profiles):
        try:
            path = str(pathlib.Path(file["filename"]).relative_to(ROOT))
        except ValueError:
            continue
        if not any(fnmatch.fnmatch(path, pattern) for pattern in given.sources):
            continue
        text = (ROOT / path).read_text().splitlines()
        places = outcomes(file, text)
        met = sum((true > 0) + (false > 0) for true, false in places.values())
        rows.append((path, 2 * len(places), met))
        for (line, column, end, end_column), (true, false) in sorted(places.items()):
            for name, count in (("true", true), ("false", false)):
                if count == 0:
                    condition = text[line - 1][column - 1:end_column - 1 if end == line else None]
                    missing.append(f"{path}:{line}: never {name}: {condition}")
    print("| source | outcomes | met |\n|---|--:|--:|")
    for path, count, met in sorted(rows):
        if count:
            print(f"| `{path}` | {count} | {100 * met / count:.1f} % |")
    total, met = sum(row[1] for row in rows), sum(row[2] for row in rows)
    print(f"| **all** | {total} | {100 * met / max(1, total):.1f} % |")
    if given.missing:
        print("", *missing, sep="\n")


if __name__ == "__main__":
    main()
