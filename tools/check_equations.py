#!/usr/bin/python3
"""Sees that each equation that a README lists is named where the code computes it, and in a test.

Usage: check_equations.py [ROOT]       check the tree at ROOT (default: the folder above this one)
       check_equations.py --self-test  take each kind of mention out of a copy of the list and see it missed

The list is the rows `| [KEY (n)] |` of photonmap/README.md and beamtree/README.md. A row whose third column
begins with "not used:" says why the code has none. A mention is `[KEY (n)]`; `[KEY (a)] to [KEY (b)]` is all
from a to b. In code it counts where it stands in a .cpp, beside what computes.
"""
import pathlib
import re
import sys

LISTS = ("photonmap/README.md", "beamtree/README.md")
CODE = ("core", "photonmap", "beamtree")
TESTS = ("tests",)
ROW = re.compile(r"^\| \[(\w+) \((\d+)\)\] \|[^|]*\| *([^|]*)\|", re.MULTILINE)
RANGE = re.compile(r"\[(\w+) \((\d+)\)\](?:\s|/)+to(?:\s|/)+\[\1 \((\d+)\)\]")
ONE = re.compile(r"\[(\w+) \((\d+)\)\]")


def mentioned(text):
    """The equations {(key, number)} that a text names."""
    found = {(key, int(number)) for key, number in ONE.findall(text)}
    for key, first, last in RANGE.findall(text):
        found.update((key, number) for number in range(int(first), int(last) + 1))
    return found


def read(root, folders, suffixes):
    """The texts of all sources in some folders."""
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in suffixes:
                yield path.read_text(encoding="utf-8")


def complaints(lists, code, tests):
    """What is wrong, one line an equation."""
    in_code = set().union(*map(mentioned, code))
    in_tests = set().union(*map(mentioned, tests))
    listed = set()
    for key, number, where in ROW.findall(lists):
        equation = (key, int(number))
        listed.add(equation)
        name = f"[{key} ({number})]"
        if not where.startswith("not used:") and equation not in in_code:
            yield f"{name}: no line of code names it, and its row does not say why"
        if not where.startswith("not used:") and equation not in in_tests:
            yield f"{name}: no test names it"
    for key, number in sorted((in_code | in_tests) - listed):
        yield f"[{key} ({number})]: named in code or tests, but in no README's list"


def self_test():
    """Every way to miss an equation must be seen, and nothing else."""
    lists = "| [A (1)] | what | file | test |\n| [A (2)] | what | not used: why | – |\n| [A (3)] | what | file | test |\n"
    right = list(complaints(lists, ["// [A (1)] to [A (3)]"], ["// [A (1)], [A (3)]"]))
    cases = [(["// [A (1)]"], ["// [A (1)], [A (3)]"]), (["// [A (1)], [A (3)]"], ["// [A (1)]"]),
             (["// [A (1)], [A (3)], [A (4)]"], ["// [A (1)], [A (3)]"])]
    seen = sum(len(list(complaints(lists, *case))) == 1 for case in cases)
    print(f"self-test: {seen} of {len(cases)} planted mistakes found")
    return 0 if seen == len(cases) and not right else 1


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if len(arguments) > 1 or arguments and arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent
    lists = "".join((root / name).read_text(encoding="utf-8") for name in LISTS)
    wrong = list(complaints(lists, read(root, CODE, (".cpp",)), read(root, TESTS, (".cpp", ".h"))))
    for line in wrong:
        print(line)
    print(f"check_equations: {len(ROW.findall(lists))} equations, {len(wrong)} complaints")
    return 1 if wrong or not ROW.findall(lists) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
