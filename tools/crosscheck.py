#!/usr/bin/python3
"""Renders the scenes of experiments/scenes/crosscheck here, in Mitsuba 3 and in POV-Ray 3.7, and compares.

Usage: .venv/bin/python tools/crosscheck.py [--bench PROGRAM] [-o DIR] [--seeds N] [--threads N] [--scene NAME]...
       [--pictures KEPT]

Every estimate is repeated with several seeds; its standard error in each cell of the picture comes from
their spread. Needs tools/crosscheck-requirements.txt; POV-Ray is left out, and said to be, where it is not
installed. Writes tables.md, records.csv and pictures.png to DIR (default: results/crosscheck). Pictures that
are in KEPT are not made again.
"""
import argparse
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

from report import crosscheck_report
import numpy as np
from report.crosscheck_statistics import compare, is_remarkable, of_pictures, relative_error

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "experiments" / "scenes" / "crosscheck"
CAUSTICS = ["ring_point", "ring_area", "ball_point", "ball_area", "pool_point", "pool_area"]
# Closed boxes with a glass ball, of real albedos: the light between their walls, too.
ROOMS = ["room_point", "room_area"]
PLAIN = ["plain_point", "plain_area", "plain_sun", "plain_checker", "plain_mesh", "plain_two"]
# Light paths or camera samples of one seed. Mitsuba's are samples a pixel of a 48 x 36 film.
BUDGET = {
    "lighttrace": {"ring": 2_000_000, "ball": 600_000, "pool": 1_600_000, "room": 1_000_000},
    "pathtrace": {"ring": 4096, "ball": 2560, "pool": 2560, "room": 1024},
    "globalphotonmap": {"room": 100_000},
    "ptracer": {"ring": 1500, "ball_point": 6000, "ball_area": 2500, "pool_point": 5000, "pool_area": 2500, "plain": 2400,
                "room": 400},
    "path": {"ring": 1200, "ball": 2400, "pool": 2400, "plain": 200, "room": 400},
}
# POV-Ray: photons aimed at, and a fixed radius [m] to gather them in. Its default, the nearest 20 to 100,
# gains light where a caustic is folded; results/crosscheck says how much.
POVRAY = {"ball_point": ("200000", "0.01"), "pool_point": ("1000000", "0.02")}
CELL = 6  # pixels
ROOM_DEPTH = 30  # events of a path in a room by Mitsuba: what is cut off is below 1e-5 of the light
GATHER = 64


def estimators(scene):
    if scene in PLAIN:
        return ["none", "ptracer", "path"]
    if scene in ROOMS:
        return ["lighttrace", "ptracer", "globalphotonmap"] + (["pathtrace", "path"] if scene.endswith("area") else [])
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
        chosen = methods(method, scene)
        # Pictures of one seed have the same camera rays, which would hide noise that both have.
        seed += 1000 if method == "pathtrace" else 0
        picture = self.work / "ours.exr"
        # The direct light of lamps with area is as sure as the eye's paths are many.
        eye_samples = {"lighttrace": 1024, "pathtrace": 256}.get(method, 64) if scene.endswith("area") else 64
        self.program("render", SCENES / f"{scene}.json", *chosen, "--spp", eye_samples,
                     "--seed", seed, "--threads", self.threads, "-o", picture)
        return self.layers(picture)

    def exported(self, scene, target, *more):
        folder = self.work / target / scene
        self.program("export", SCENES / f"{scene}.json", "--to", target, "--max-bounces", "16", "-o", folder, *more)
        return folder

    def theirs(self, scene, integrator, seed):
        folder = self.exported(scene, "mitsuba")
        depth = {"max_depth": str(ROOM_DEPTH)} if scene in ROOMS else {}
        loaded = self.mitsuba.load_file(str(folder / "scene.xml"), integrator=integrator, **depth)
        return np.array(self.mitsuba.render(loaded, seed=seed, spp=budget(integrator, scene)), dtype=np.float64)

    def povray(self, scene, *declared):
        """By 81 rays a pixel: the caustic of the ball is finer than a pixel."""
        folder = self.exported(scene, "povray", "--set", "/sensor/sampler/sample_count=81")
        subprocess.run(["povray", "scene.ini", f"+WT{self.threads}", *[f"Declare={each}" for each in declared]],
                       cwd=folder, check=True, capture_output=True)
        return self.layers(folder / "scene.exr")[""][..., :3]


def budget(estimator, scene):
    """Of one seed; 0 where there is nothing to choose."""
    chosen = BUDGET.get(estimator, {})
    return chosen.get(scene, chosen.get(scene.split("_")[0], 0))


def methods(estimator, scene):
    """Words of `render` that say how the caustic is estimated, and in a room the light between its walls."""
    if estimator == "globalphotonmap":
        photons = budget(estimator, scene)
        return ["--method", "photonmap", "--param", f"photons={photons}",
                "--indirect", estimator, "--indirect-param", f"photons={photons}", "--indirect-param", f"gather={GATHER}"]
    parameter = {"lighttrace": "paths", "pathtrace": "spp"}.get(estimator)
    value = f"{parameter}={budget(estimator, scene)}"
    chosen = ["--method", estimator] + (["--param", value] if parameter else [])
    return chosen + (["--indirect", estimator, "--indirect-param", value] if scene in ROOMS else [])


def reached(layers):
    """Pixels that particles can reach: those that see no specular surface."""
    unreached = layers.get("unreached")
    return np.ones(layers[""].shape[:2], bool) if unreached is None else unreached[..., 0] == 0


def cpu_seconds():
    """Of this process and of the programs that it has run."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def estimate(run, scene, estimator, seed, kept):
    """A picture, the caustic in it if it is ours, and the CPU seconds; from the file in `kept` where it is there."""
    file = kept / f"{scene}-{estimator}-{budget(estimator, scene)}-{seed}.npz"
    if not file.is_file():
        start = cpu_seconds()
        if estimator in ("none", "lighttrace", "pathtrace", "globalphotonmap"):
            layers = run.ours(scene, estimator, seed)
            made = {"picture": layers[""], "caustic": layers["caustic"] + layers.get("indirect", 0)}
        else:
            made = {"picture": run.theirs(scene, estimator, seed)}
        part = file.with_suffix(".part.npz")
        np.savez_compressed(part, **made, cpu_s=cpu_seconds() - start)
        part.rename(file)
    with np.load(file) as found:
        return dict(found)


def measure(run, scene, seeds, kept):
    """estimator -> its means by seed and cell, mean picture and CPU seconds; and the mask."""
    mask = reached(run.ours(scene, "lighttrace", 1)) if scene in CAUSTICS + ROOMS else np.ones((36, 48), bool)
    found = {}
    for estimator in estimators(scene):
        made = [estimate(run, scene, estimator, seed, kept) for seed in range(1, seeds + 1)]
        pictures = [each["picture"] for each in made]
        found[estimator] = {**of_pictures(pictures, mask, CELL), "picture": np.mean(pictures, axis=0),
                            "cpu_s": sum(float(each["cpu_s"]) for each in made)}
        if estimator == "lighttrace":
            found[estimator]["direct"] = np.mean([(each["picture"] - each["caustic"])[mask].mean() for each in made])
        means = found[estimator]["means"]
        print(f"{scene} {estimator}: mean {means.mean():.6g} to {100 * relative_error(means):.2f} %, "
              f"{found[estimator]['cpu_s']:.1f} CPU s", file=sys.stderr, flush=True)
    return found, mask


def povray_rows(run, results):
    rows = []
    for scene, (count, radius) in POVRAY.items():
        if scene not in results:
            continue
        found, mask = results[scene]
        reference = found["lighttrace"]
        for gathered, declared in (("radius " + radius + " m", [f"Photon_Radius={radius}"]), ("nearest 20 to 100", [])):
            start = cpu_seconds()
            picture = run.povray(scene, f"Photon_Count={count}", *declared)
            mean, truth = picture[mask].mean(), reference["means"].mean()
            rows.append({"scene": scene, "gathered": gathered, "ratio": mean / truth,
                         "caustic_ratio": (mean - reference["direct"]) / (truth - reference["direct"]),
                         "count": count, "picture": picture, "cpu_s": cpu_seconds() - start})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bench", default=ROOT / "build/release/bin/causticbench", type=pathlib.Path)
    parser.add_argument("-o", "--output", default=ROOT / "results/crosscheck", type=pathlib.Path)
    parser.add_argument("--seeds", default=12, type=int)
    parser.add_argument("--threads", default=1, type=int)
    parser.add_argument("--scene", action="append", choices=CAUSTICS + ROOMS + PLAIN)
    parser.add_argument("--pictures", metavar="KEPT", type=pathlib.Path)
    options = parser.parse_args()
    if not options.bench.is_file():
        sys.exit(f"crosscheck: no program {options.bench} (build it, or give --bench)")
    generator = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as work:
        kept = options.pictures or pathlib.Path(work)
        kept.mkdir(parents=True, exist_ok=True)
        run = Run(options.bench, pathlib.Path(work), options.threads)
        results = {scene: measure(run, scene, options.seeds, kept) for scene in options.scene or CAUSTICS + ROOMS + PLAIN}
        pairs = []
        for scene, (found, _) in results.items():
            first, *others = estimators(scene)
            for other in others:
                pairs.append({"scene": scene, "estimator": other, "reference": first,
                              **compare(found[other], found[first], generator)})
        rows = povray_rows(run, results) if shutil.which("povray") else None
    options.output.mkdir(parents=True, exist_ok=True)
    crosscheck_report.write(options, results, pairs, rows, run.mitsuba.__version__)
    exact = [p for p in pairs if p["estimator"] != "globalphotonmap"]
    bad = [p for p in exact if max(abs(p["ratio"] - 1), abs(p["caustic_ratio"] - 1)) > 0.005 or is_remarkable(p, exact)]
    # Density estimates are biased.
    bad += [p for p in pairs if p not in exact and abs(p["ratio"] - 1) > 0.02]
    bad += [r for r in rows or [] if r["gathered"].startswith("radius") and abs(r["caustic_ratio"] - 1) > 0.03]
    for each in bad:
        print("crosscheck: apart:", {k: v for k, v in each.items() if k != "picture"}, file=sys.stderr)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
