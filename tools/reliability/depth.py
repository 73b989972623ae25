#!/usr/bin/env python3
"""What paths of 1,000 events, which end by roulette, cost and keep against paths that are cut.

Usage: depth.py BEFORE AFTER SCENE...     two files `causticbench`, of which BEFORE knows no roulette for specular events

Prints a Markdown table: for each scene the processor seconds of `render --method lighttrace` by AFTER as it is, over
BEFORE's with 16 events; and the mean light of AFTER's picture, and of BEFORE's with 16 events, over BEFORE's with 1,000,
with the standard error over seeds.
"""

import os
import statistics
import sys
import tempfile

from mean_ratio import mean_ratio
from timed_run import timed_run

PATHS = 400_000
SEEDS = range(1, 9)
FILM = ("--set", "/sensor/film/width=32", "--set", "/sensor/film/height=24", "--spp", "4")
RUNS = {"after": (), "16": ("max_bounces=16",), "1000": ("max_bounces=1000",)}


def render(program, scene, seed, params, picture):
    """Processor seconds."""
    command = [program, "render", scene, "--method", "lighttrace", "--param", f"paths={PATHS}", "--seed", str(seed)]
    _, seconds = timed_run(command + [word for param in params for word in ("--param", param)] + ["-o", picture, *FILM])
    return seconds


def with_error(values):
    return f"{statistics.mean(values):.4f} ± {statistics.stdev(values) / len(values) ** 0.5:.4f}"


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__.strip())
    before, after, *scenes = sys.argv[1:]
    print("| scene | processor seconds over 16 events | light over 1,000 events | 16 events over 1,000 |\n|---|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        pictures = {name: os.path.join(folder, f"{name}.exr") for name in RUNS}
        for scene in scenes:
            seconds, kept, cut = [], [], []
            for seed in SEEDS:
                spent = {
                    name: render(after if name == "after" else before, scene, seed, params, pictures[name])
                    for name, params in RUNS.items()
                }
                seconds.append(spent["after"] / spent["16"])
                kept.append(mean_ratio(after, pictures["after"], pictures["1000"]))
                cut.append(mean_ratio(after, pictures["16"], pictures["1000"]))
            name = os.path.splitext(os.path.basename(scene))[0]
            print(f"| {name} | {statistics.median(seconds):.3f} | {with_error(kept)} | {with_error(cut)} |", flush=True)


if __name__ == "__main__":
    main()
