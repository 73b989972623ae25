"""Chen 2011: n² samples regular and jittered, roulette against split, searching the tree, filters, three maps, peers."""
import statistics

import numpy as np

from papers.figures import luminance, strip
from papers.part import Figure, Part, Table
from papers.verdict import counted, ratio, unmeasured
from papers.words import short, spread
from report.records import natural

BLOCK = 8  # pixels


def measure(study):
    part = sampling(study).add(interaction(study)).add(search(study)).add(filters(study)).add(maps(study))
    here = "not run by this script; results/crosscheck compares scenes exported to it, radiance by radiance (tools/crosscheck.py)"
    part.measured |= {"povray": unmeasured(f"POV-Ray is {here}"), "mitsuba": unmeasured(f"Mitsuba 3 is {here}"),
                      "shadow_photons": unmeasured("the program has no shadow photons: shadows are traced"),
                      "guided": unmeasured("the adaptive sampler goes by the scatter of a pixel, not by the map")}
    return part


def moire(layers, level):
    """Deviation, from what it should be, of means over blocks in which the checks are finer than a pixel, over that."""
    light = luminance(layers[""])
    rows = light[72:112, :]  # below the horizon, where a pixel covers several checks
    blocks = rows.reshape(rows.shape[0] // BLOCK, BLOCK, -1, BLOCK).mean(axis=(1, 3))
    return float(np.sqrt(np.mean((blocks / level - 1) ** 2)))


def sampling(study):
    trials = study.sweep("sampling")
    counts = sorted(trials.values("samples"), key=int)
    found = {(count, jitter): [moire(layers, 0.5) for layers in trials.pictures(samples=count, jitter=jitter)]
             for count in counts for jitter in ("false", "true")}
    per_cent = lambda *key: spread([100 * each for each in found[key]], "%")
    rows = [[f"{round(int(count) ** 0.5)}", count, per_cent(count, "false"), per_cent(count, "true")] for count in counts]
    shown = lambda count, jitter: trials.picture(samples=count, jitter=jitter, seed=1)[""]
    pictures = strip([[(f"n² = {count}, regular", shown(count, "false")), (f"n² = {count}, jittered", shown(count, "true"))]
                      for count in counts[:2]], 1.0)
    regular = [statistics.fmean(found[count, "false"]) for count in counts]
    return Part({"moire": ratio(found["4", "false"], found["4", "true"], "moiré"),
                 "oversampling": counted(regular[-1] / regular[0], "", f"regular, {short(regular[0] * 100)} % at one sample, "
                                                                       f"{short(regular[-1] * 100)} % at {counts[-1]}")}, [
        Table("sampling", "n² samples a pixel", ["n", "samples", "moiré, regular", "moiré, jittered"], rows,
              f"A checkerboard far finer than a pixel, which has to be even grey: deviation of means over {BLOCK} x {BLOCK} pixels.")], [
        Figure("sampling", "Regular and jittered samples", "A fine checkerboard to the horizon. Regular samples make patterns of their own "
               "(moiré) where jittered ones make noise.", *pictures)])


def interaction(study):
    trials = study.sweep("interaction")
    mean = {how: [float(layers["caustic"].mean()) for layers in trials.pictures(interaction=how)] for how in ("roulette", "split")}
    stack = {how: np.array([layers["caustic"] for layers in trials.pictures(interaction=how)]) for how in mean}
    noise = {how: float(np.sqrt(values.var(axis=0, ddof=1).mean())) for how, values in stack.items()}
    column = lambda name, how: trials.column(name, interaction=how)
    rows = [[how, *[spread(column(name, how)) for name in ("photons_emitted", "photons_stored", "precompute_cpu_s")], f"{noise[how]:.3g}"]
            for how in mean]
    return Part({"split_same": ratio(mean["split"], mean["roulette"], "mean caustic", note="pairs of seeds")}, [Table(
        "interaction", "Roulette and split", ["interaction", "light paths", "photons", "tracing [CPU s]", "noise of a pixel [W/(m² sr)]"], rows,
        f"The bowl, {len(mean['split'])} seeds. Roulette: a photon is reflected or refracted (Jensen); split: both, each weaker (POV-Ray).")])


def search(study):
    trials = study.sweep("tree")
    counts = sorted(trials.values("photons"), key=natural)
    seconds = {count: trials.column("render_cpu_s", photons=count) for count in counts}
    rows = [[f"{int(count):,}", spread(seconds[count]), spread(ratio(seconds[count], seconds[counts[0]], "").samples)] for count in counts]
    return Part({"logarithmic": ratio(seconds[counts[-1]], seconds[counts[0]], "CPU s")}, [Table(
        "tree", "Searching among more photons", ["photons", "rendering [CPU s]", "over the first"], rows,
        f"160 × 120 pixels, N = 50, {len(seconds[counts[0]])} repeats.")])


def filters(study):
    trials = study.sweep("filters")
    error = {name: trials.column("mask_rmse", filter=name) for name in ("none", "cone", "gaussian")}
    rows = [[name, spread(error[name]), spread(trials.column("rmse", filter=name))] for name in error]
    return Part({"filter_cone": ratio(error["cone"], error["none"], "rmse in the caustic"),
                 "filter_gaussian": ratio(error["gaussian"], error["none"], "rmse in the caustic")}, [Table(
        "filters", "Filtered estimates", ["filter", "rmse where the caustic is bright [W/(m² sr)]", "rmse everywhere"], rows,
        "The bowl, N = 200 of 100,000 photons, against light tracing. The text names no filter: cone and Gaussian are Jensen's of 2001.")])


def maps(study):
    trials = study.sweep("maps")
    picture = lambda gather, diffuse: trials.pictures(indirect_gather=gather, indirect_diffuse_bounces=diffuse)
    two, whole, gathered = picture(0, 2), picture(0, 0), picture(8, 0)
    adds = max(float(np.abs(layers[""] - sum(layers[name] for name in ("direct", "specular", "caustic", "indirect"))).max() / layers[""].max())
               for layers in [*two, *whole, *gathered])
    mean = lambda some: [float(layers["indirect"].mean()) for layers in some]
    first = gathered[0]
    level = float(np.percentile(luminance(first[""]), 97))
    pictures = strip([[("direct", first["direct"]), ("specular", first["specular"]), ("caustic", first["caustic"])],
                      [("multiple diffuse, gathered", first["indirect"]), ("the global map", whole[0]["indirect"]), ("all", first[""])]], level)
    rows = [["the map, paths end at the second diffuse surface", spread(mean(two))], ["the map, paths end by roulette", spread(mean(whole))],
            ["final gathering, 8 rays", spread(mean(gathered))]]
    return Part({"four_parts": counted(adds, "of the brightest pixel"), "second_hit": ratio(mean(two), mean(whole), "mean indirect light")}, [Table(
        "maps", "Light between diffuse surfaces", ["by", "mean of the layer [W/(m² sr)]"], rows,
        f"{len(gathered)} seeds, 160 × 160 pixels.")], [Figure(
            "maps", "Four parts of the light in a room", "Direct light, specular, caustic (its own map) and multiple diffuse reflections (the "
            "global map), and their sum.", *pictures)])
