#!/usr/bin/python3
"""Measures what the global photon map gains over path tracing at equal error, and writes results/indirect/README.md.

Runs the sweeps indirect_room.json on one thread and indirect_growth.json on one and on two; their trials stay in
results/indirect/trials (not in git). All take about a quarter of an hour on two quiet cores (estimated).
Ratios are of CPU times of one thread on one machine, without what the other layers cost. `--mitsuba` adds Mitsuba's `path` on the
same room, whose error and time it takes without those of its direct light (needs tools/crosscheck-requirements.txt, so that it
runs by .venv/bin/python). `--quick` looks whether all of it runs, on films too small for its numbers to mean anything.
Exit codes: 0 done, 1 a sweep failed, 2 bad input or usage.
"""
import argparse
import json
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report import indirect_growth, records
from report.program import BENCH, Program, exit_code, machine
from report.report_files import write

SCENE = ROOT / "experiments" / "scenes" / "room.json"
SIZE, SMALL_SIZE = (320, 240), (160, 120)  # of the film: beside the sweep, beside Mitsuba
QUICK_SIZE = (16, 12)  # in place of both
SHADOW_RAYS = (20_000, 200_000, 2_000_000)
# The room with nothing specular: all noise of a path tracer is of direct and indirect light.
DULL = tuple(word for ball in ("glass", "mirror") for word in ("--set", f'/{ball}/bsdf={{"type":"diffuse","reflectance":0.5}}'))
TRUTH_PATHS = 2048  # a pixel
DEPTH = 30  # events of a path by Mitsuba: what is cut off is below 1e-5 of the light
PATHS = 64  # a pixel, here and in Mitsuba
REFERENCE_PATHS = 1024  # a pixel, in the sweep file

PAGE = """# Light between walls

Made by `tools/measure_indirect.py{options}` on {machine} CPU times of one thread, medians over the seeds, of the room
(experiments/scenes/room.json) at 320 x 240, 16 samples a pixel (experiments/sweeps/indirect_room.json). Error and time are those
of the layer `indirect` alone: without the error of the reference ({reference} paths a pixel), and the time without what a picture without that layer costs ({none:.1f} s). Gain: what `pathtrace` would
need for the same error, from the nearest of its rows, since its squared error falls as 1 / s, over the time.

| method | photons | rays a sample | known beforehand at every | rmse | precompute [s] | all [s] | gain |
|---|---|---|---|---|---|---|---|
{rows}
{growth}{mitsuba}## Shadow photons

The room's direct light with `shadow_photons`, on the same camera samples as without (`none`, `gather: 0`): the rays that were spared,
and the error that this made, in the layer `direct`.

| rays of the lamp | shadow rays to trace | spared | rmse [W m⁻² sr⁻¹] | mean ratio |
|---|---|---|---|---|
{shadows}
A shadow ray costs less than asking for the nearest twenty photons in so small a scene ({plain:.1f} s without against {asked:.1f} s with
{most} rays): shadow photons spare rays here, not time.
"""

MITSUBA = """## Beside Mitsuba

Mitsuba {version} (`path`, scalar_rgb, {paths} stratified samples a pixel) and the same room here, 160 x 120, without the pixels at the
lamp. Error and CPU seconds are those of all light but the direct one: of caustics and indirect light here, and of Mitsuba's
picture without what its direct light alone has. Gain: how long Mitsuba takes for the same error, over the time.

| room | by | rms error | s | gain |
|---|---|---|---|---|
{lines}
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--keep", action="store_true", help="take the trials that are there, run only those that are not")
    parser.add_argument("--mitsuba", action="store_true", help="measure Mitsuba's path tracer, too")
    parser.add_argument("--quick", action="store_true", help="small films and one seed: only whether it runs")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="DIR", help="(default: results/indirect, or results/indirect/trials/quick)")
    chosen = parser.parse_args()
    chosen.output = (chosen.output or ROOT / "results" / "indirect" / ("trials/quick" if chosen.quick else ".")).resolve()
    return chosen


def film(size):
    """The words of `render` and `export` that set the film."""
    return tuple(word for name, pixels in zip(("width", "height"), size) for word in ("--set", f"/sensor/film/{name}={pixels}"))


def quick_sweep(sweep, scenes):
    """The sweep with one seed and small films, as many as it has; its scenes from any folder."""
    width, height = QUICK_SIZE
    sweep["scenes"] = [str((scenes / scene).resolve()) for scene in sweep["scenes"]]
    sweep["seeds"] = sweep["seeds"][:1]
    sweep["set"]["width"]["values"] = [width << step for step in range(len(sweep["set"]["width"]["values"]))]
    sweep["set"]["height"]["values"] = [height]
    return sweep


def sweep_name(name, output, quick):
    """The sweep's name, or where it is written to as a quick one."""
    if not quick:
        return name
    folder = ROOT / "experiments" / "sweeps"
    sweep = quick_sweep(json.loads((folder / f"{name}.json").read_text(encoding="utf-8")), folder)
    (output / "trials").mkdir(parents=True, exist_ok=True)
    write(output / "trials" / f"{name}.json", json.dumps(sweep))
    return output / "trials" / name


def median(rows, column):
    return statistics.median(float(row[column]) for row in rows)


def measured(rows, without):
    """(method, photons, gather, precompute, spp) -> rmse, seconds before the picture, seconds in all.

    The squared error of path tracing with n paths is s/n, and s/m more by a reference of m paths, which is taken off.
    """
    keys = ("indirect", "indirect_photons", "indirect_gather", "indirect_precompute", "indirect_spp")
    cells = {}
    for row in rows:
        if row["indirect"]:
            cells.setdefault(tuple(row.get(key, "") for key in keys), []).append(row)
    squares = {key: median(of, "indirect_rmse") ** 2 for key, of in cells.items()}
    of_reference = statistics.median(squares[key] / (REFERENCE_PATHS / int(key[-1]) + 1) for key in cells if key[0] == "pathtrace")
    return {key: (max(squares[key] - of_reference, 0.01 * of_reference) ** 0.5, median(of, "indirect_s"),
                  median(of, "cpu_s") - without) for key, of in cells.items()}


def nearest_paths(cells, error):
    """The seconds of path tracing for an error."""
    paths = [(rmse, all_s) for key, (rmse, _, all_s) in cells.items() if key[0] == "pathtrace"]
    rmse, seconds = min(paths, key=lambda each: abs(each[0] - error))
    return seconds * (rmse / error) ** 2


def table(cells):
    for (method, photons, gather, known, spp), (rmse, before, seconds) in cells.items():
        rays = gather if method == "globalphotonmap" else f"{int(spp) // 16} paths"
        yield (f"| {method} | {photons} | {rays} | {known} | {rmse:.4g} | {before:.1f} | {seconds:.1f} "
               f"| {nearest_paths(cells, rmse) / seconds:.1f} |\n")


def picture(program, file, *words):
    """Renders the room into the file; what the program says, and its CPU seconds."""
    start = child_seconds()
    done = subprocess.run([program.path, "render", str(SCENE), *words, "--threads", "1", "-o", str(file)], capture_output=True, text=True)
    if done.returncode != 0:
        raise ChildProcessError(f"render: {done.stderr.strip()}")
    return done.stderr, child_seconds() - start


def child_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def shadow_lines(program, folder, size):
    """The lines of the table, and the seconds without and with the most shadow photons."""
    words = (*film(size), "--method", "none", "--indirect", "globalphotonmap", "--indirect-param", "photons=1000", "--indirect-param", "gather=0")
    all_rays = pathlib.Path(folder) / "all.exr"
    _, plain = picture(program, all_rays, *words)
    lines = []
    for rays in SHADOW_RAYS:
        file = pathlib.Path(folder) / f"{rays}.exr"
        told, asked = picture(program, file, *words, "--indirect-param", f"shadow_photons={rays}")
        traced, spared = (int(re.search(rf"(\d+) {what}", told)[1]) for what in ("shadow rays", "spared by shadow photons"))
        compared = program.run("compare", file, all_rays, "--layer", "direct", stdout=subprocess.PIPE)
        error, ratio = (float(re.search(rf"{what}\s+(\S+)", compared)[1]) for what in ("rmse", "mean_ratio"))
        lines.append(f"| {rays:,} | {traced + spared:,} | {100 * spared / (traced + spared):.1f} % | {error:.3g} | {ratio:.5f} |\n")
    return lines, plain, asked


def variance(pictures, mask):
    """Mean variance of a picture's values, from two of other seeds."""
    import numpy
    first, second = pictures
    return float(numpy.mean((first - second)[mask] ** 2)) / 2


def off_the_lamp(pictures):
    """The pixels that do not see the lamp, nor a neighbour: its rim scatters more than all the rest."""
    import numpy
    seen = numpy.pad(sum(each["specular"] for each in pictures).sum(axis=-1) > 0, 1)
    height, width = seen.shape[0] - 2, seen.shape[1] - 2
    return ~numpy.any([seen[y:y + height, x:x + width] for y in range(3) for x in range(3)], axis=0)


def layers_of(mitsuba, file):
    import numpy
    return {name: numpy.array(each, dtype=float) for name, each in mitsuba.Bitmap(str(file)).split()}


def not_direct(layers):
    return layers["caustic"] + layers["indirect"]


def ours_of(program, folder, mitsuba, room, size):
    """{name: (squared error, seconds)} of caustic and indirect light by two ways, and the pixels that were compared."""
    import numpy

    def render(name, *words):
        file = pathlib.Path(folder) / f"{name}.exr"
        seconds = picture(program, file, *room, *film(size), "--spp", "16", *words)[1]
        return layers_of(mitsuba, file), seconds
    _, without = render("none", "--method", "none")
    made = [render(f"paths{seed}", "--seed", str(seed), *paths(PATHS)) for seed in (1, 2)]
    mask = off_the_lamp([layers for layers, _ in made])
    of_paths = variance([not_direct(layers) for layers, _ in made], mask)
    truth, _ = render("truth", "--seed", "9", *paths(TRUTH_PATHS))
    caustic = () if room == DULL else ("--param", "photons=200000", "--param", "tree=packed")
    mapped, mapped_s = render("mapped", "--method", "photonmap" if caustic else "none", *caustic, "--indirect",
                              "globalphotonmap", "--indirect-param", "gather=16")
    of_map = float(numpy.mean((not_direct(mapped) - not_direct(truth))[mask] ** 2)) - of_paths * PATHS / TRUTH_PATHS
    return {"`pathtrace`": (of_paths, statistics.median(seconds for _, seconds in made) - without),
            "`photonmap`, `globalphotonmap`": (of_map, mapped_s - without)}, mask


def paths(count):
    return ("--method", "pathtrace", "--param", f"spp={count}", "--indirect", "pathtrace", "--indirect-param", f"spp={count}")


def mitsuba_of(program, folder, mitsuba, room, size, mask):
    """The same of Mitsuba's `path`: what its direct light alone has is taken off both."""
    import numpy
    program.run("export", SCENE, *film(size), *room, "--to", "mitsuba", "--max-bounces", "16", "-o",
                pathlib.Path(folder) / "mitsuba", stderr=subprocess.DEVNULL)
    of_depth = {}
    for depth in (2, DEPTH):
        loaded = mitsuba.load_file(str(pathlib.Path(folder) / "mitsuba" / "scene.xml"), integrator="path", max_depth=str(depth))
        pictures, seconds = [], []
        for seed in (1, 2):
            start = time.process_time()
            pictures.append(numpy.array(mitsuba.render(loaded, seed=seed, spp=PATHS), dtype=float))
            seconds.append(time.process_time() - start)
        of_depth[depth] = variance(pictures, mask), statistics.median(seconds)
    return tuple(all_light - direct for all_light, direct in zip(of_depth[DEPTH], of_depth[2]))


def mitsuba_section(program, size):
    import mitsuba
    mitsuba.set_variant("scalar_rgb")
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    mitsuba.logger().clear_appenders()  # its progress bars
    lines = []
    for name, room in (("as it is", ()), ("both balls diffuse", DULL)):
        with tempfile.TemporaryDirectory() as folder:
            found, mask = ours_of(program, folder, mitsuba, room, size)
            theirs = mitsuba_of(program, folder, mitsuba, room, size, mask)
        for who, (square, seconds) in {"Mitsuba's `path`": theirs, **found}.items():
            ratio = theirs[0] * theirs[1] / (square * seconds)
            lines.append(f"| {name} | {who} | {square ** 0.5:.3g} | {seconds:.1f} | {ratio:.2g} |\n")
    return MITSUBA.format(version=mitsuba.__version__, paths=PATHS, lines="".join(lines))


def measure(options):
    program = Program("measure_indirect", options.program.resolve())
    folder = options.output / "trials" / "indirect_room"
    program.sweep(sweep_name("indirect_room", options.output, options.quick), folder, options.keep)
    rows = [row for _, row in records.read_rows(folder / "records.csv")[1] if row["status"] == "done"]
    without = median([row for row in rows if not row["indirect"]], "cpu_s")
    cells = measured(rows, without)
    growth = [options.output / "trials" / f"indirect_growth_{threads}" for threads in (1, 2)]
    for threads, each in enumerate(growth, 1):
        program.sweep(sweep_name("indirect_growth", options.output, options.quick), each, options.keep, "--threads", threads)
    size, small = (QUICK_SIZE, QUICK_SIZE) if options.quick else (SIZE, SMALL_SIZE)
    with tempfile.TemporaryDirectory() as work:
        shadows, plain, asked = shadow_lines(program, work, size)
    mitsuba = mitsuba_section(program, small) if options.mitsuba else ""
    flags = "".join(f" --{name}" for name in ("mitsuba", "quick") if getattr(options, name))
    write(options.output / "README.md",
          PAGE.format(options=flags, machine=machine([folder]), none=without, reference=REFERENCE_PATHS,
                      rows="".join(table(cells)), growth=indirect_growth.section(*growth), mitsuba=mitsuba,
                      shadows="".join(shadows), plain=plain, asked=asked, most=f"{SHADOW_RAYS[-1]:,}"))


def main():
    options = arguments()
    return exit_code("measure_indirect", lambda: measure(options))


if __name__ == "__main__":
    sys.exit(main())
