#!/usr/bin/env python3
"""Renders the scenes of experiments/scenes/crosscheck here, in Mitsuba 3 and in POV-Ray 3.7, and compares.

Usage: .venv/bin/python tools/crosscheck.py [--bench PROGRAM] [-o DIR] [--seeds N] [--threads N] [--scene NAME]...

Every estimate is repeated with several seeds; its standard error in each cell of the picture comes from
their spread. Needs tools/crosscheck-requirements.txt; POV-Ray is left out, and said to be, where it is not
installed. Writes tables.md, records.csv and pictures.png to DIR (default: results/crosscheck).
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import crosscheck_report
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "experiments" / "scenes" / "crosscheck"
CAUSTICS = ["ring_point", "ring_area", "ball_point", "ball_area", "pool_point", "pool_area"]
PLAIN = ["plain_point", "plain_area", "plain_sun", "plain_checker", "plain_mesh", "plain_two"]
# Light paths or camera samples of one seed. Mitsuba's are samples a pixel of a 48 x 36 film.
BUDGET = {
    "lighttrace": {"ring": 400_000, "ball": 400_000, "pool": 400_000},
    "pathtrace": {"ring": 256, "ball": 256, "pool": 256},
    "ptracer": {"ring": 1000, "ball": 1000, "pool": 2500, "plain": 700},
    "path": {"ring": 600, "ball": 600, "pool": 600, "plain": 200},
}
# POV-Ray: photons aimed at, and a fixed radius [m] to gather them in. Its default, the nearest 20 to 100,
# gains light where a caustic is folded; results/crosscheck says how much.
POVRAY = {"ball_point": ("200000", "0.01"), "pool_point": ("1000000", "0.02")}
CELL = 6  # pixels


def estimators(scene):
    if scene in PLAIN:
        return ["none", "ptracer", "path"]
    # A path meets no light without area.
    return ["lighttrace", "ptracer"] + (["pathtrace", "path"] if scene.endswith("area") else [])


class Run:
    """Programs and pictures of one cross-check; adds up what they cost."""

    def __init__(self, bench, work, threads):
        import mitsuba
        mitsuba.set_variant("scalar_rgb")
        mitsuba.set_log_level(mitsuba.LogLevel.Error)
        mitsuba.logger().clear_appenders()  # its progress bars
        self.mitsuba, self.bench, self.work, self.threads = mitsuba, str(bench), work, threads

    def program(self, *arguments):
        subprocess.run([self.bench, *map(str, arguments)], check=True, capture_output=True, text=True)

    def layers(self, file):
        """Layer name ('' = beauty) -> height x width x channels."""
        bitmaps = self.mitsuba.Bitmap(str(file)).split()
        planes = {("" if name == "<root>" else name): np.array(bitmap, dtype=np.float64) for name, bitmap in bitmaps}
        return {name: p.reshape(p.shape[0], p.shape[1], -1) for name, p in planes.items()}

    def ours(self, scene, method, seed):
        parameter = {"lighttrace": "paths", "pathtrace": "spp"}.get(method)
        chosen = ["--param", f"{parameter}={budget(method, scene)}"] if parameter else []
        picture = self.work / "ours.exr"
        self.program("render", SCENES / f"{scene}.json", "--method", method, *chosen, "--spp", 256 if method == "pathtrace" else 64,
                     "--seed", seed, "--threads", self.threads, "-o", picture)
        return self.layers(picture)

    def exported(self, scene, target, *more):
        folder = self.work / target / scene
        self.program("export", SCENES / f"{scene}.json", "--to", target, "-o", folder, *more)
        return folder

    def theirs(self, scene, integrator, seed):
        folder = self.exported(scene, "mitsuba")
        loaded = self.mitsuba.load_file(str(folder / "scene.xml"), integrator=integrator)
        return np.array(self.mitsuba.render(loaded, seed=seed, spp=budget(integrator, scene)), dtype=np.float64)

    def povray(self, scene, *declared):
        """By 81 rays a pixel: the caustic of the ball is finer than a pixel."""
        folder = self.exported(scene, "povray", "--set", "/sensor/sampler/sample_count=81")
        subprocess.run(["povray", "scene.ini", f"+WT{self.threads}", *[f"Declare={each}" for each in declared]],
                       cwd=folder, check=True, capture_output=True)
        return self.layers(folder / "scene.exr")[""][..., :3]


def budget(estimator, scene):
    return BUDGET[estimator][scene.split("_")[0]]


def reached(layers):
    """Pixels that particles can reach: those that see no specular surface."""
    unreached = layers.get("unreached")
    return np.ones(layers[""].shape[:2], bool) if unreached is None else unreached[..., 0] == 0


def cells(picture, mask):
    """Mean radiance of each cell's reached pixels; NaN where there are none."""
    height, width = mask.shape
    shape = (height // CELL, CELL, width // CELL, CELL)
    counted = mask.reshape(shape).sum(axis=(1, 3)).astype(float)
    total = np.where(mask, picture.mean(axis=2), 0).reshape(shape).sum(axis=(1, 3))
    return np.where(counted > 0, total / np.maximum(counted, 1), np.nan).ravel()


def measure(run, scene, seeds):
    """estimator -> (seeds x cells, seeds x mean, mean picture, CPU-free wall seconds), and the mask."""
    mask = reached(run.ours(scene, "lighttrace", 1)) if scene in CAUSTICS else np.ones((36, 48), bool)
    found = {}
    for estimator in estimators(scene):
        start = time.process_time() + children_seconds()
        pictures = []
        for seed in range(1, seeds + 1):
            ours = estimator in ("none", "lighttrace", "pathtrace")
            pictures.append(run.ours(scene, estimator, seed)[""] if ours else run.theirs(scene, estimator, seed))
        by_cell = np.array([cells(p, mask) for p in pictures])
        means = np.array([p[mask].mean() for p in pictures])
        found[estimator] = {"cells": by_cell, "means": means, "picture": np.mean(pictures, axis=0),
                            "cpu_s": time.process_time() + children_seconds() - start}
        print(f"{scene} {estimator}: mean {means.mean():.6g}, {found[estimator]['cpu_s']:.1f} CPU s", file=sys.stderr)
    return found, mask


def children_seconds():
    import resource
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def compare(a, b, generator):
    """Two estimators of one scene: ratio of means with its standard error, and z-scores by cell."""
    n = len(a["means"])
    ratio = a["means"].mean() / b["means"].mean()
    spread = [x["means"].std(ddof=1) / np.sqrt(n) / x["means"].mean() for x in (a, b)]
    difference = a["cells"].mean(axis=0) - b["cells"].mean(axis=0)
    error = np.sqrt(a["cells"].var(axis=0, ddof=1) / n + b["cells"].var(axis=0, ddof=1) / n)
    used = np.isfinite(difference) & (error > 0)
    z = difference[used] / error[used]
    # What the largest of as many t-scores of these degrees of freedom stays below 999 times in 1000.
    drawn = np.abs(generator.standard_t(2 * n - 2, size=(20_000, len(z)))).max(axis=1)
    return {"ratio": ratio, "ratio_error": ratio * np.hypot(*spread), "cells": int(used.sum()),
            "z_rms": float(np.sqrt((z ** 2).mean())), "z_max": float(np.abs(z).max()),
            "z_bound": float(np.quantile(drawn, 0.999)),
            "expected_rms": float(np.sqrt((n - 1) / (n - 2)))}


def povray_rows(run, results):
    rows = []
    for scene, (count, radius) in POVRAY.items():
        if scene not in results:
            continue
        found, mask = results[scene]
        truth = found["lighttrace"]["means"].mean()
        for gathered, declared in (("radius " + radius + " m", [f"Photon_Radius={radius}"]), ("nearest 20 to 100", [])):
            start = children_seconds()
            picture = run.povray(scene, f"Photon_Count={count}", *declared)
            rows.append({"scene": scene, "gathered": gathered, "ratio": picture[mask].mean() / truth,
                         "count": count, "picture": picture, "cpu_s": children_seconds() - start})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bench", default=ROOT / "build/release/bin/causticbench", type=pathlib.Path)
    parser.add_argument("-o", "--output", default=ROOT / "results/crosscheck", type=pathlib.Path)
    parser.add_argument("--seeds", default=12, type=int)
    parser.add_argument("--threads", default=1, type=int)
    parser.add_argument("--scene", action="append", choices=CAUSTICS + PLAIN)
    options = parser.parse_args()
    if not options.bench.is_file():
        sys.exit(f"crosscheck: no program {options.bench} (build it, or give --bench)")
    generator = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as work:
        run = Run(options.bench, pathlib.Path(work), options.threads)
        results = {scene: measure(run, scene, options.seeds) for scene in options.scene or CAUSTICS + PLAIN}
        pairs = []
        for scene, (found, _) in results.items():
            first, *others = estimators(scene)
            for other in others:
                pairs.append({"scene": scene, "estimator": other, "reference": first,
                              **compare(found[other], found[first], generator)})
        rows = povray_rows(run, results) if shutil.which("povray") else None
    options.output.mkdir(parents=True, exist_ok=True)
    crosscheck_report.write(options, results, pairs, rows, run.mitsuba.__version__)
    bad = [p for p in pairs if abs(p["ratio"] - 1) > 0.005 or p["z_max"] > p["z_bound"]]
    bad += [r for r in rows or [] if r["gathered"].startswith("radius") and abs(r["ratio"] - 1) > 0.03]
    for each in bad:
        print("crosscheck: apart:", {k: v for k, v in each.items() if k != "picture"}, file=sys.stderr)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
