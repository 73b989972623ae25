#!/usr/bin/python3
"""Plants the faults of tests/faults/faults.json one by one into a scratch copy and sees each one caught.

A fault is a text of one source file, what is put in its place, and the test program (with a filter) that has to
fail then. First the unchanged copy must pass. Prints a table: fault, file, the tests that caught it.
Exit codes: 0 all were caught, 1 some were not, 2 bad input or usage.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
FAULTS = ROOT / "tests" / "faults" / "faults.json"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--only", action="append", metavar="WORD", help="faults whose text has this word; repeatable")
    parser.add_argument("--list", action="store_true", help="only list them")
    parser.add_argument("-C", "--copy", type=pathlib.Path, metavar="DIR",
                        help="scratch copy, kept for the next time (default: a temporary one)")
    parser.add_argument("-j", "--jobs", default="2", help="of the build (default: 2)")
    return parser.parse_args()


def copy_sources(target):
    """The files that git knows, as they are in the working tree."""
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, names.split("\0")):
        source, place = ROOT / name, target / name
        place.parent.mkdir(parents=True, exist_ok=True)
        if source.is_file() and (not place.exists() or place.read_bytes() != source.read_bytes()):
            shutil.copyfile(source, place)
            shutil.copymode(source, place)


def build(copy, target, jobs):
    """None, or what the compiler said."""
    command = ["cmake", "--build", "--preset", "ci", "--target", target, "-j", jobs]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True)
    return None if done.returncode == 0 else done.stdout[-2000:] + done.stderr[-2000:]


def failures(copy, fault):
    """The tests that fail, an empty list when none does."""
    program = copy / "build" / "ci" / "tests" / fault["target"]
    done = subprocess.run([program, f"--gtest_filter={fault['filter']}"], cwd=copy, capture_output=True, text=True)
    failed = list(dict.fromkeys(re.findall(r"^\[  FAILED  \] (\w\S*\.[^\s,]+)", done.stdout, re.MULTILINE)))
    if done.returncode != 0 and not failed:
        return [f"the program ends with {done.returncode}"]
    return failed if done.returncode != 0 else []


def plant(copy, fault):
    """Puts the fault in; returns the text that was there."""
    file = copy / fault["file"]
    text = file.read_text(encoding="utf-8")
    if text.count(fault["find"]) != 1:
        sys.exit(f"plant_faults: error: {fault['file']}: {text.count(fault['find'])} places read \"{fault['find']}\" "
                 "instead of one (the source has changed: change tests/faults/faults.json)")
    file.write_text(text.replace(fault["find"], fault["plant"]), encoding="utf-8")
    return text


def caught_by(copy, fault, jobs):
    before = plant(copy, fault)
    try:
        complaint = build(copy, fault["target"], jobs)
        return ["the compiler"] if complaint else failures(copy, fault)
    finally:
        (copy / fault["file"]).write_text(before, encoding="utf-8")


def require_sound(copy, faults, jobs):
    for target, filters in sorted({(fault["target"], fault["filter"]) for fault in faults}):
        print(f"plant_faults: unchanged {target} {filters}", file=sys.stderr, flush=True)
        complaint = build(copy, target, jobs)
        failed = [complaint] if complaint else failures(copy, {"target": target, "filter": filters})
        if failed:
            sys.exit(f"plant_faults: error: {target} fails without any fault: {', '.join(failed)}")


def run(copy, faults, jobs):
    copy_sources(copy)
    subprocess.run(["cmake", "--preset", "ci", "-DCAUSTICS_BATCHES=OFF"], cwd=copy, check=True, stdout=subprocess.DEVNULL)
    require_sound(copy, faults, jobs)
    print("| fault | file | caught by |\n|---|---|---|", flush=True)
    missed = 0
    for fault in faults:
        found = caught_by(copy, fault, jobs)
        missed += not found
        names = ", ".join(found[:3]) + (f" and {len(found) - 3} more" if len(found) > 3 else "")
        print(f"| {fault['fault']} | {fault['file']} | {names or '**nothing**'} |", flush=True)
    return missed


def main():
    options = arguments()
    faults = [fault for fault in json.loads(FAULTS.read_text(encoding="utf-8"))
              if not options.only or any(word in fault["fault"] for word in options.only)]
    if not faults:
        print("plant_faults: error: no fault has that word (see --list)", file=sys.stderr)
        return 2
    if options.list:
        print("\n".join(fault["fault"] for fault in faults))
        return 0
    if options.copy:
        return 1 if run(options.copy.resolve(), faults, options.jobs) else 0
    with tempfile.TemporaryDirectory() as folder:
        return 1 if run(pathlib.Path(folder) / "causticbench", faults, options.jobs) else 0


if __name__ == "__main__":
    sys.exit(main())
