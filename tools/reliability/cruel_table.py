#!/usr/bin/env python3
"""cruel_table.py bits|light TABLE: what cruel_scenes.sh compared, from the table that it keeps."""

import statistics
import sys
from collections import defaultdict

def read(path):
    with open(path, encoding="utf-8") as table:
        return [line.rstrip("\n").split("\t") for line in table]


def say_bits(rows):
    print(f"{len(rows)} scenes, {sum(int(row[1]) for row in rows)} comparisons")


WORDS = ("holds", "converges", "fails", "unsure")


def say_method(name, rows):
    """One line: scenes, those with light, the four answers among these, median error, CPU seconds a scene."""
    lit = [row for row in rows if float(row[4]) > 0]
    counts = "".join(f"{sum(row[2] == word for row in lit):10}" for word in WORDS)
    error = statistics.median(float(row[6]) for row in lit) if lit else 0
    seconds = sum(float(row[7]) for row in rows) / len(rows)
    print(f"{name:18}{len(rows):7}{len(lit):7}{counts}{error:9.2%}{seconds:9.2f}")


def say_light(rows):
    by_method = defaultdict(list)
    for row in rows:
        by_method[row[1]].append(row)
    scenes = {row[0] for row in rows}
    seconds = sum(float(row[7]) for row in rows)
    print(f"{len(scenes)} scenes, {seconds / max(1, len(scenes)):.1f} CPU s each")
    print("method             scenes    lit" + "".join(f"{word:>10}" for word in WORDS) + "    error  CPU s")
    for name, of_method in by_method.items():
        say_method(name, of_method)
    for row in rows:
        if row[2] in ("fails", "converges"):
            print(f"seed {row[0]}, {row[1]} {row[2]}: {row[8]}")


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in ("bits", "light"):
        sys.exit(__doc__)
    (say_bits if sys.argv[1] == "bits" else say_light)(read(sys.argv[2]))


if __name__ == "__main__":
    main()
