#!/usr/bin/python3
"""Measures what dispersion costs, and what splitting at the eye and intervals of wavelengths gain, and writes results/crystal/README.md.

Runs the sweeps experiments/sweeps/dispersion_photons.json, split_depth.json and dispersion_beams.json on one thread,
one after another; their trials stay in results/crystal/trials (not in git). Ratios are of CPU times of one thread on one
machine. Needs build/release (tools/build.sh release causticbench). Exit codes: 0 done, 1 a sweep failed, 2 bad input or usage.
"""
import argparse
import math
import pathlib
import statistics
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report import records
from report.program import BENCH, Program, machine
from report.report_files import write

PAGE = """# Crystal and colour

Made by `tools/measure_crystal.py` on {machine} Times are CPU times of one thread, medians over the repeats; what is not measured
here: other machines, area lights, memory.

## Photons with and without dispersion

A ball of BK7 (experiments/sweeps/dispersion_photons.json, 1,000,000 photons): photons traced a second, over those of a ball with one
index.

| emission | without [s] | with [s] | with / without |
|---|---|---|---|
{photons}
## Splitting at the eye

Direct light and what is seen through glass, without caustics, at 4 samples a pixel (experiments/sweeps/split_depth.json, 5 seeds),
against 256. The last column is the error at equal time over that of `split_depth` 0: sqrt(rmse² × s).

| scene | split_depth | rmse | s | error at equal time |
|---|---|---|---|---|
{split}
## Beams by intervals of wavelengths

`beamtree` with `dispersion` bins and intervals (experiments/sweeps/dispersion_beams.json) against `lighttrace`. Errors level off where
they are not of the wavelengths any more. The last column: the time of the cheapest bins whose error is at most 5 % above that of
the intervals, over the intervals' time. On prism and gem most of the time goes into cutting beams at their further surfaces (the eye pass
takes 0.1 to 1 s), and intervals send every ray three times; on gem it ends where `max_beams` has no room, which comes sooner in more parts.

| scene | dispersion | wavelengths | caustic rmse | s | bins over it |
|---|---|---|---|---|---|
{beams}
The time of K intervals is a + b K (least squares). The last column is what they would gain if they cost nothing each (b = 0): the time of the
cheapest bins as good as the best intervals, over a. Where a is not above 0 all of the time is the wavelengths'.

| scene | a [s] | b [s] | bins [s] | bins over a |
|---|---|---|---|---|
{bounds}"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--keep", action="store_true", help="take the trials that are there, run only those that are not")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results" / "crystal", metavar="DIR")
    return parser.parse_args()


def sweep(program, options, name):
    """The sweep's folder, and the rows of its table."""
    folder = options.output / "trials" / name
    program.sweep(name, folder, options.keep)
    return folder, [row for _, row in records.read_rows(folder / "records.csv")[1] if row["status"] == "done"]


def median(rows, column, **where):
    """Of a column's numbers in the rows that hold these values."""
    chosen = [row for row in rows if all(str(row[key]) == str(value) for key, value in where.items())]
    return statistics.median(float(row[column]) for row in chosen)


def photon_lines(rows):
    glasses = sorted({row["glass"] for row in rows}, key=len)
    for emission in ("random", "stratified"):
        plain, law = (median(rows, "precompute_cpu_s", emission=emission, glass=glass) for glass in glasses)
        yield f"| {emission} | {plain:.3f} | {law:.3f} | {plain / law:.2f} |\n"


def split_lines(rows):
    for scene in sorted({row["scene"] for row in rows}):
        first = None
        for depth in sorted({int(row["split_depth"]) for row in rows}):
            where = {"scene": scene, "split_depth": depth}
            error, seconds = median(rows, "beauty_rmse", **where), median(rows, "render_cpu_s", **where)
            cost = math.sqrt(error**2 * seconds)
            first = first or cost
            yield f"| {scene} | {depth} | {error:.4g} | {seconds:.2f} | {cost / first:.2f} |\n"


def beam_times(rows):
    """Of each scene: [(bins or intervals, how many, rmse, CPU seconds)]."""
    for scene in sorted({row["scene"] for row in rows}):
        found = []
        for how, count in sorted({(row["dispersion"], int(row["wavelengths"])) for row in rows}):
            where = {"scene": scene, "dispersion": how, "wavelengths": count}
            seconds = sum(median(rows, phase, **where) for phase in ("precompute_cpu_s", "render_cpu_s"))
            found.append((how, count, median(rows, "rmse", **where), seconds))
        yield scene, found


def cheapest_bins(found, error):
    """Seconds of those whose error is at most 5 % above; None where there are none."""
    return min((each[3] for each in found if each[0] == "bins" and each[2] <= 1.05 * error), default=None)


def beam_lines(times):
    for scene, found in times:
        for how, count, error, seconds in found:
            bins = cheapest_bins(found, error)
            ratio = "" if how == "bins" else f"{bins / seconds:.1f}" if bins else "more"
            yield f"| {scene} | {how} | {count} | {error:.4g} | {seconds:.1f} | {ratio} |\n"


def bound_lines(times):
    for scene, found in times:
        intervals = [each for each in found if each[0] == "intervals"]
        counts, seconds = [each[1] for each in intervals], [each[3] for each in intervals]
        each, fixed = statistics.linear_regression(counts, seconds)
        bins = cheapest_bins(found, min(one[2] for one in intervals))
        gain = f"{bins / fixed:.1f}" if bins and fixed > 0 else ""
        yield f"| {scene} | {round(fixed, 1) + 0.0:.1f} | {each:.2f} | {bins or 0:.1f} | {gain} |\n"


def main():
    options = arguments()
    try:
        program = Program("measure_crystal", options.program)
        dispersion, photons = sweep(program, options, "dispersion_photons")
        splitting, split = sweep(program, options, "split_depth")
        intervals, beams = sweep(program, options, "dispersion_beams")
        times = list(beam_times(beams))
        write(options.output / "README.md",
              PAGE.format(machine=machine([dispersion, splitting, intervals]), photons="".join(photon_lines(photons)),
                          split="".join(split_lines(split)), beams="".join(beam_lines(times)),
                          bounds="".join(bound_lines(times))))
    except records.RecordsError as error:
        print(f"measure_crystal: {error}", file=sys.stderr)
        return 2
    except ChildProcessError as error:
        print(f"measure_crystal: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
