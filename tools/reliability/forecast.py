#!/usr/bin/env python3
"""What `info` foretells of each method's picture, beside what the picture takes.

Usage: forecast.py PROGRAM SCENE...     a file `causticbench`, and scene files

Prints a Markdown table of processor seconds and of the most memory, for all methods by their defaults, on one thread. Pictures
that are foretold to take more than a minute, or "at least" some time, are not made. Those that take more than five times as
long are ended. The last line counts those within a factor of 2.
"""

import os
import re
import subprocess
import sys
import tempfile

MOST_SECONDS = 60
TOO_LONG = 5  # times as long as foretold, and five seconds
COST = re.compile(r"^  (\w+) +yes, (at least )?([\d.e+]+) CPU s and ([\d.e+]+) MB", re.MULTILINE)


def foretold(program, scene):
    """Of each method that serves the scene: its name, whether it takes at least so much, processor seconds, and megabytes."""
    text = subprocess.run([program, "info", scene], check=True, capture_output=True, text=True).stdout
    return [(name, bool(least), float(seconds), float(megabytes)) for name, least, seconds, megabytes in COST.findall(text)]


def taken(command, limit):
    """Processor seconds of a command that is ended by a limit of them, and its most megabytes."""
    command = ["prlimit", f"--cpu={limit}", *command]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status != 0 and used.ru_utime < 0.9 * limit:
        sys.exit(f"failed: {' '.join(command)}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    print("| scene | method | foretold [CPU s] | took | took over foretold | foretold [MB] | took | took over foretold |\n"
          "|---|---|--:|--:|--:|--:|--:|--:|")
    ratios = []
    for scene in sys.argv[2:]:
        name = os.path.splitext(os.path.basename(scene))[0]
        for method, is_least, seconds, megabytes in foretold(sys.argv[1], scene):
            if is_least or seconds > MOST_SECONDS:
                print(f"| {name} | {method} | {'at least ' if is_least else ''}{seconds:.3g} | | | {megabytes:.3g} | | |", flush=True)
                continue
            with tempfile.TemporaryDirectory() as folder:
                took, most = taken([sys.argv[1], "render", scene, "--method", method, "--threads", "1",
                                    "-o", os.path.join(folder, "a.exr")], round(TOO_LONG * (seconds + 1)))
            ratios.append((took / seconds, most / megabytes))
            print(f"| {name} | {method} | {seconds:.3g} | {took:.3g} | {ratios[-1][0]:.2f} | "
                  f"{megabytes:.3g} | {most:.3g} | {ratios[-1][1]:.2f} |", flush=True)
    for which, what in ((0, "Seconds"), (1, "Memory")):
        near = sum(0.5 <= ratio[which] <= 2 for ratio in ratios)
        print(f"\n{what}: {near} of {len(ratios)} within a factor of 2.")


if __name__ == "__main__":
    main()
