"""Chuang & Cheng 1995: how fine polygons and illumination maps have to be, how the load falls on the two steps, other views."""
import math

import numpy as np

from papers.chuang_counts import COUNTS
from papers.figures import luminance, plot
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import short, spread
from report.records import natural

NEAR = 0.25  # error of the smooth and the sharp caustic: what a map has to reach, over the caustic's mean


def finer(study):
    """Polygons for the caustic and for the surface alone: the error of each picture against the finest mesh's."""
    trials = study.sweep("finer")
    sides = sorted({int(row["cells"].strip("[]").split(",")[0]) for row in trials.rows})
    pictures = {side: [trials.picture(method=method, cells=f"[{side},{side}]")[layer] for method, layer in (("beamtree", "caustic"), ("none", ""))]
                for side in sides}
    last = sides.pop()
    finest = pictures[last]
    off = lambda kind: [float(np.abs(luminance(pictures[side][kind] - finest[kind])).mean() / luminance(finest[kind]).mean()) for side in sides]
    caustic, surface = off(0), off(1)
    needed = crossing(sides, caustic, surface[0])
    rows = [[f"{side} × {side}", f"{100 * a:.3g}", f"{100 * b:.3g}", f"{a / b:.3g}"] for side, a, b in zip(sides, caustic, surface)]

    def draw(ax):
        ax.loglog(sides, caustic, "o-", label="the caustic by beams")
        ax.loglog(sides, surface, "s-", label="the surface alone")
        ax.axhline(surface[0], color="0.7", linewidth=0.8)
        ax.set_xticks(sides, labels=map(str, sides))
        ax.set_xticks([], minor=True)
        ax.set_xlabel("cells along a side of the water")
        ax.set_ylabel("mean deviation over the mean")
        ax.legend()

    note = f"the caustic comes as near as the surface of {sides[0]} × {sides[0]} cells with {needed:.0f} × {needed:.0f}"
    return Part({"finer_polygons": counted(needed / sides[0], "sides of polygons", note)}, [Table(
        "finer", "Polygons for the caustic and for the surface", [
            "cells", "deviation of the caustic [%]", "of the picture without caustics [%]", "ratio"], rows,
        "The pool, waves x 1.5, 100 × 100 pixels, 4 rays each; mean deviation from the picture of the finest mesh, "
              f"{last} × {last} cells, over its mean.")], [
        Figure("finer", "Polygons for the caustic and for the surface", "How far pictures are from those of the finest mesh. A mesh that shows the "
               "water well is far too coarse for the light below it: a caustic follows the curvature, the surface its slope.", plot(draw, 5.2, 3.2))])


def crossing(places, values, level):
    """Where falling values meet a level, between places on logarithmic scales; the last place where they do not."""
    for (x0, y0), (x1, y1) in zip(zip(places, values), list(zip(places, values))[1:]):
        if y1 <= level <= y0:
            return math.exp(math.log(x0) + math.log(y0 / level) / math.log(y0 / y1) * math.log(x1 / x0))
    return places[-1] if level < values[-1] else places[0]


def texels(study):
    """Arvo's map: texels that calm and rough water need for one error."""
    trials = study.sweep("texels")
    calm, rough = sorted(trials.values("wave_height"), key=natural)
    sides = sorted({int(trials.value(row, "with_resolution")) for row in trials.rows})
    error = {height: {side: [a / b for a, b in zip(trials.column("rmse", wave_height=height, with_resolution=side),
                                                   trials.column("reference_mean", wave_height=height, with_resolution=side))] for side in sides}
             for height in (calm, rough)}
    seeds = range(len(error[calm][sides[0]]))
    needed = {height: [crossing(sides, [error[height][side][seed] for side in sides], NEAR) for seed in seeds] for height in error}
    short_of = " (a bound from below: the finest map is not near enough)" if min(error[rough][sides[-1]]) > NEAR else ""
    rows = [[f"{side} × {side}", *[spread([100 * each for each in error[height][side]]) for height in (calm, rough)]] for side in sides]
    return Part({"arvo": Measured([(a / b) ** 2 for a, b in zip(needed[rough], needed[calm])],
                                  note=f"waves x {rough} against x {calm}; texels along a side for an error of {100 * NEAR:g} %: "
                                       f"{spread(needed[rough])}{short_of} against {spread(needed[calm])}")}, [Table(
        "texels", "An illumination map's texels", ["texels of the floor", f"error, waves x {calm} [%]", f"waves x {rough} [%]"], rows,
        "Root mean square error against light tracing over the mean, pool_overhead.json, 64 × 64 pixels, 1,000,000 light paths, three seeds. "
        "Beyond the best number each texel has too few light paths.")])


def load(study):
    """How the load falls on the two steps: building the tree, and asking it."""
    trials = study.sweep("load")
    first, second = (trials.column(name) for name in ("precompute_cpu_s", "render_cpu_s"))
    large = study.sweep("pictures")
    far = [row for row in large.rows if row["method"] == "beamtree"]
    share = [float(row["render_cpu_s"]) / (float(row["render_cpu_s"]) + float(row["precompute_cpu_s"])) for row in far]
    return Part({"second_step": ratio(second, [a + b for a, b in zip(first, second)], "CPU s",
                                      note=f"100 × 100 pixels of one ray; in the figures' 600 × 600 pixels of 4 rays {spread(share)}: the tree is "
                                           "built once, whatever the picture's size")})


def memory(study):
    """Bytes of Watt's map and of Arvo's over those of the tree for the same water."""
    small, maps, least = study.sweep("small_pictures"), study.sweep("texels"), study.sweep("counts")
    tree = {(scene, polygons): small.column("map_bytes", scene=scene, method="beamtree", with_polygons=polygons)[0]
            for scene in small.values("scene") for polygons in ("quads", "triangles")}
    watt = [small.column("map_bytes", scene=scene, method="causticpolygons", with_polygons=polygons)[0] / own
            for (scene, polygons), own in tree.items()]
    coarse = [least.column("map_bytes", method=method, wave_height=1.5, cells="[75,101]", reflected=1)[0]
              for method in ("causticpolygons", "beamtree")]
    side = max(int(maps.value(row, "with_resolution")) for row in maps.rows)
    scene = small.record(small.where(scene="chuang_pool", method="beamtree")[0])["scene"]["resolved"]
    walls = sum(isinstance(each, dict) and each.get("type") == "rectangle" for each in scene.values())
    arvo = walls * maps.column("map_bytes", with_resolution=side)[0]
    quads = tree["chuang_pool", "quads"]
    return Part({
        "memory_watt": Measured(watt, unit="bytes, Watt's over the tree's", counted=True, note=(
            f"{', '.join(f'{scene} in {polygons} {short(each)}' for (scene, polygons), each in zip(tree, watt))}, with 16 cells along a "
            f"wall; chuang_pool in quads with 2 cells {short(coarse[0] / coarse[1])}")),
        "memory_arvo": counted(arvo / quads, "bytes, Arvo's over the tree's", (
            f"maps of {side} × {side} texels on floor and walls, {walls} of them, take {short(arvo / 1e6)} MB, the trees of the pool's quads "
            f"{short(quads / 1e6)} MB"))})


def eyes(study):
    """The three counts from other places: how much the view matters, which the paper does not give."""
    trials = study.sweep("eyes")
    views = [trials.record(row)["counters"] for row in trials.rows]
    over = lambda name: [own[name] / own["receiver_points"] / (study.paper.number(name) / study.paper.number("pixels")) for own in views]
    heights = study.sweep("counts").where(method="beamtree", merging="cones", cells="[75,101]", reflected="0")
    by_height = lambda name: [study.sweep("counts").record(row)["counters"][name] / study.paper.number(name) for row in heights]
    words = lambda some: ", ".join(f"{short(min(some(name)))} to {short(max(some(name)))}" for name in COUNTS)
    seen = min(own["receiver_points"] / own["camera_rays"] for own in views)
    return Part(facts={"counts_over_views": words(over), "counts_over_heights": words(by_height), "least_seen": f"{100 * seen:.0f} %"})


SECTIONS = {"finer-polygons": finer, "texels": texels, "load": load, "memory": memory, "eyes": eyes}
