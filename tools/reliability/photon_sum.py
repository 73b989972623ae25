#!/usr/bin/env python3
"""The light of the photon map's pictures over that of `lighttrace`.

Usage: photon_sum.py PROGRAM SCENE...     a file `causticbench`, and scenes

Prints a Markdown table: for each scene, each number of photons and two kernels the mean light of the caustic in pictures of
36 samples a pixel over that of `lighttrace`, in pixels that `lighttrace` reaches, with the standard error over seeds of both.
"""

import math
import os
import statistics
import subprocess
import sys
import tempfile

from mean_ratio import mean_ratio

PHOTONS = (40_000, 400_000)
SEEDS = range(1, 26)
KERNELS = {"default": (), "kernel=point": ("kernel=point",)}
PATHS = 8_000_000
TRUTH_SEEDS = range(101, 109)


def render(program, scene, method, seed, params, picture):
    command = [program, "render", scene, "--method", method, "--seed", str(seed), "--spp", "36", "-o", picture]
    subprocess.run(command + [word for param in params for word in ("--param", param)], check=True, capture_output=True)


def mean_and_error(values):
    return statistics.mean(values), statistics.stdev(values) / math.sqrt(len(values))


def ratios(program, scene, folder):
    """(photons, kernel, ratio, standard error) of each setting."""
    yardstick = os.path.join(folder, "yardstick.exr")
    picture = os.path.join(folder, "picture.exr")
    render(program, scene, "lighttrace", TRUTH_SEEDS[0], [f"paths={PATHS}"], yardstick)

    def light(method, seeds, params):
        values = []
        for seed in seeds:
            render(program, scene, method, seed, params, picture)
            values.append(mean_ratio(program, picture, yardstick))
        return mean_and_error(values)

    truth, truth_error = light("lighttrace", TRUTH_SEEDS, [f"paths={PATHS}"])
    for photons in PHOTONS:
        for kernel, params in KERNELS.items():
            mean, error = light("photonmap", SEEDS, [f"photons={photons}", *params])
            yield photons, kernel, mean / truth, mean / truth * math.hypot(error / mean, truth_error / truth)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    program, *scenes = sys.argv[1:]
    print("| scene | photons | kernel | light over `lighttrace`'s | standard errors from 1 |\n|---|--:|---|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            name = os.path.splitext(os.path.basename(scene))[0]
            for photons, kernel, ratio, error in ratios(program, scene, folder):
                print(f"| {name} | {photons:,} | {kernel} | {ratio:.4f} ± {error:.4f} | {abs(ratio - 1) / error:.1f} |", flush=True)


if __name__ == "__main__":
    main()
