#!/usr/bin/python3
"""Measures what time the packed photon map needs for the beam tree's error, and writes equal_error.md, .json and .svg.

A folded and a calm pool, seen straight from above the floor on 512 x 512 pixels (experiments/scenes/pool_overhead.json); runs
the sweeps experiments/sweeps/equal_error_*.json on one thread, whose trials stay beside the results (not in git).
The truth is a quadrature that shares no code with the program (pool_truth.py), held against `lighttrace` on the way. Times
are CPU times of everything: photons or beams, trees, and the eye pass. Needs build/release (tools/build.sh release
causticbench) and numpy. Exit codes: 0 done, 1 a sweep failed, 2 bad input or usage.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report import records
from report.curves import along
from report.program import BENCH, Program
from report.report_files import write

SCENE = ROOT / "experiments" / "scenes" / "pool_overhead.json"
POOLS = {"folded": "2.5", "calm": "1"}  # and how many times as high their waves are
MARKS = {"folded": ("equal_error_sharp_pool", 10, 50), "calm": ("equal_error_smooth_pool", None, 5)}
CELLS = {False: 4096, True: 2048}  # of the truth, along each side; quick
LONGEST = 600  # seconds of a trial
BLOCKS = 64  # of the film, where the truth is held against lighttrace


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--keep", action="store_true", help="take the trials and truths that are there, run only those that are not")
    parser.add_argument("--quick", action="store_true", help="10 million photons at most, and a coarser truth: a first look")
    parser.add_argument("--bench", type=pathlib.Path, default=BENCH,
                        metavar="PROGRAM", help="(default: build/release/bin/causticbench)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results" / "bench", metavar="DIR",
                        help="(default: results/bench)")
    return parser.parse_args()


class Comparing(Program):
    def sweep(self, name, folder, keep):
        super().sweep(name, folder, keep, "--timeout", LONGEST)

    def compare(self, picture, reference):
        return json.loads(self.run("compare", picture, reference, "--json", stdout=subprocess.PIPE))


def truth_of(program, pool, folder, cells, keep):
    """The path of the truth's picture, and how it was made and checked."""
    path, about = folder / f"truth_{pool}.exr", folder / f"truth_{pool}_{cells}.json"
    if not (keep and path.exists() and about.exists()):
        about.unlink(missing_ok=True)
        write(about, json.dumps(make_truth(program, pool, folder, cells, path)))
    return path, json.loads(about.read_text(encoding="utf-8"))


def make_truth(program, pool, folder, cells, path):
    """Writes the truth's picture, and holds it against lighttrace."""
    import pool_truth  # here, so that a missing numpy differs from bad records

    print(f"equal_error: truth, {pool}", file=sys.stderr, flush=True)
    fine, error = pool_truth.Pool(SCENE, float(POOLS[pool])).radiance_with_error(cells)
    mean = float(fine.mean())
    blocks, traced = (folder / f"{kind}_{pool}.exr" for kind in ("blocks", "lighttrace"))
    pool_truth.write_exr(path, fine)
    pool_truth.write_exr(blocks, pool_truth.binned(fine, BLOCKS))
    program.run("render", SCENE, "--method", "lighttrace", "--param", "paths=2000000", "--param", "max_bounces=1", "--set",
                f"/water/to_world/0/scale/2={POOLS[pool]}", "--set", f"/sensor/film/width={BLOCKS}", "--set",
                f"/sensor/film/height={BLOCKS}", "--threads", 1, "-o", traced, stdout=sys.stderr, stderr=subprocess.DEVNULL)
    found = program.compare(blocks, traced)
    noise = found["reference_stderr"] * mean
    own = math.sqrt(float((error ** 2).mean()))
    return {"cells": cells, "own_error": own / mean, "mean": mean,
            "lighttrace_difference": found["metrics"]["rmse"] / mean, "lighttrace_stderr": noise / mean,
            "lighttrace_mean_ratio": found["metrics"]["mean_ratio"]}


def settings(row):
    if row["method"] == "beamtree":
        return f"{row['resolution']} x {row['resolution']} cells"
    how = (f"radius {row['radius']} m" if row.get("radius") else "adaptive N" if row.get("adaptive") == "true"
           else f"N = {row['nearest']}")
    return f"{float(row['photons']):,.0f} photons, {how}"


def measured(program, folder, row, truth):
    """One trial: method, settings, CPU seconds, rmse over the mean radiance."""
    found = program.compare(folder / "trials" / row["trial"] / "image.exr", truth[0])["metrics"]
    return {"method": row["method"], "settings": settings(row), "seconds": records.cpu_seconds(row),
            "error": found["rmse"] / truth[1]["mean"], "relative_error": math.sqrt(found["relmse"]),
            "mean_ratio": found["mean_ratio"], "spp": int(row["spp"])}


def front(trials):
    """Those that nothing faster beats, by time."""
    best = []
    for trial in sorted(trials, key=lambda trial: (trial["seconds"], trial["error"])):
        if not best or trial["error"] < best[-1]["error"]:
            best.append(trial)
    return best


def against(beam, photons):
    """The photon map's time for a beam tree's error over the beam tree's own, and whether it is only a lower bound."""
    curve = [(trial["error"], trial["seconds"]) for trial in photons]
    if beam["error"] >= curve[0][0]:
        return curve[0][1] / beam["seconds"], False
    reached = along(curve, beam["error"])
    return ((reached or curve[-1][1]) / beam["seconds"], reached is None)


def contest(pool, trials):
    key, must, goal = MARKS[pool]
    photons = front(trial for trial in trials if trial["method"] == "photonmap")
    beams = [dict(trial, ratio=ratio, lower_bound=bound) for trial in trials if trial["method"] == "beamtree"
             for ratio, bound in [against(trial, photons)]]
    best = max(beams, key=lambda trial: trial["ratio"])
    # A lower bound below the mark shows nothing.
    met = lambda mark: None if mark is None or (best["lower_bound"] and best["ratio"] < mark) else best["ratio"] >= mark
    return key, {"pool": pool, "ratio": best["ratio"], "lower_bound": best["lower_bound"], "beam": best["settings"],
                 "must": must, "must_met": met(must), "goal": goal, "goal_met": met(goal), "beams": beams,
                 "photons": [trial for trial in trials if trial["method"] == "photonmap"],
                 "front": [trial["settings"] for trial in photons]}


def ratio_text(entry):
    return ("≥ " if entry["lower_bound"] else "") + f"{entry['ratio']:.3g}"


def table(results, about, quick):
    lines = ["# Time to equal error", "", about + (" Quick: 10 million photons at most." if quick else ""), "", "| key | pool | beam tree | photon map's time over the beam tree's | must | goal |",
             "|---|---|---|---|---|---|"]
    said = {True: "met", False: "**not met**", None: "open: the photon map never got there"}
    mark = lambda value, met: "" if value is None else f"≥ {value} {said[met]}"
    lines += [f"| `{key}` | {one['pool']} | {one['beam']} | {ratio_text(one)} | {mark(one['must'], one['must_met'])} "
              f"| {mark(one['goal'], one['goal_met'])} |" for key, one in results.items()]
    for one in results.values():
        truth = one["truth"]
        lines += ["", f"## The {one['pool']} pool", "",
                  f"Truth: {truth['cells']} x {truth['cells']} cells, own error {truth['own_error']:.2g} of the mean. On "
                  f"{BLOCKS} x {BLOCKS} blocks it differs from `lighttrace` by {truth['lighttrace_difference']:.3g}, whose standard "
                  f"error there is {truth['lighttrace_stderr']:.3g}; means {truth['lighttrace_mean_ratio']:.5f}.", "",
                  "| method | settings | samples a pixel | CPU s | rmse / mean | sqrt(relmse) | mean ratio | photon map's time for it |",
                  "|---|---|---|---|---|---|---|---|"]
        for trial in one["beams"] + one["photons"]:
            over = f"{ratio_text(trial)} x" if "ratio" in trial else ""
            lines.append(f"| {trial['method']} | {trial['settings']} | {trial['spp']} | {trial['seconds']:.2f} "
                         f"| {trial['error']:.4f} | {trial['relative_error']:.4f} | {trial['mean_ratio']:.4f} | {over} |")
    return "\n".join(lines) + "\n"


def condition(folder):
    """One line on where and in which state the times were taken."""
    found = json.loads((folder / "environment.json").read_text(encoding="utf-8"))
    return (f"{found['cpu']}, one thread, {found['compiler']}, commit {found['commit']}; load average {found['load'].split()[0]} "
            f"when the photon maps began ({found['date'][:10]}).")


def measure(program, chosen):
    trials = chosen.output / "trials"
    trials.mkdir(parents=True, exist_ok=True)
    rows = []
    names = ["equal_error_beams", "equal_error_photons"] + ["equal_error_many_photons"] * (not chosen.quick)
    for name in names:
        program.sweep(name, trials / name, chosen.keep)
        rows += [(trials / name, row) for _, row in records.read_rows(trials / name / "records.csv")[1]
                 if row["status"] == "done"]
    results = {}
    for pool, waves in POOLS.items():
        truth = truth_of(program, pool, trials, CELLS[chosen.quick], chosen.keep)
        key, entry = contest(pool, [measured(program, folder, row, truth) for folder, row in rows
                                    if float(row["waves"]) == float(waves)])
        results[key] = dict(entry, truth=truth[1])
    return results, condition(trials / "equal_error_photons")


def plot(results):
    from report import time_plots  # here, so that a missing matplotlib differs from bad records

    curve = lambda trials: [(trial["seconds"], trial["error"]) for trial in front(trials)]
    return time_plots.draw({f"{one['pool']} pool": {"beamtree, refined": curve(one["beams"]),
                                                    "photonmap, its best": curve(one["photons"])}
                            for one in results.values()}, "rmse / mean radiance")


def main():
    chosen = arguments()
    try:
        results, about = measure(Comparing("equal_error", chosen.bench), chosen)
        write(chosen.output / "equal_error.svg", plot(results))
        write(chosen.output / "equal_error.json", json.dumps(results, indent=2, ensure_ascii=False) + "\n")
        write(chosen.output / "equal_error.md", table(results, about, chosen.quick))
    except records.RecordsError as error:
        print(f"equal_error: {error}", file=sys.stderr)
        return 2
    except (ChildProcessError, ImportError, OSError) as error:
        print(f"equal_error: {error}", file=sys.stderr)
        return 1
    print(f"equal_error: {chosen.output / 'equal_error.md'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
