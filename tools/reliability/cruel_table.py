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


def say_method(name, rows):
    """One line: scenes, the efforts they took, how sure the floor's light is, and how far a method is off; medians."""
    errors, offs = [], []
    for _, _, _, light, variance, particles, of_particles in rows:
        light, particles = float(light), float(particles)
        if light + particles <= 0:
            continue
        mean = (light + particles) / 2
        errors.append((float(variance) + float(of_particles)) ** 0.5 / mean)
        offs.append((light - particles) / mean)
    efforts = [sum(row[2] == str(effort) for row in rows) for effort in (1, 2, 3)]
    line = f"{name:18}{len(rows):7}{len(errors):7}" + "".join(f"{n:7}" for n in efforts)
    if offs:
        offs.sort()
        # So many places in order are one standard error of a median.
        places, middle = len(offs) ** 0.5 / 2, (len(offs) - 1) / 2
        low, high = offs[max(0, round(middle - places))], offs[min(len(offs) - 1, round(middle + places))]
        line += f"{statistics.median(errors):10.2%}{statistics.median(offs):+10.3%} +- {(high - low) / 2:.3%}"
    print(line)


def say_light(rows):
    by_method = defaultdict(list)
    for row in rows:
        by_method[row[1]].append(row)
    print(f"{len({row[0] for row in rows})} scenes")
    print("method             scenes    lit   efforts: 1, 2, 3      error       off")
    for name, of_method in by_method.items():
        say_method(name, of_method)


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in ("bits", "light"):
        sys.exit(__doc__)
    (say_bits if sys.argv[1] == "bits" else say_light)(read(sys.argv[2]))


if __name__ == "__main__":
    main()
