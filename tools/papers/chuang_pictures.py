"""Chuang & Cheng 1995, figures 14 to 17: a pool and a dolphin in it, with and without caustics; the same as Watt's."""
import numpy as np

from papers.figures import signed, strip, white
from papers.part import Figure, Part
from papers.verdict import counted

SCENES = {"chuang_pool": "the pool", "chuang_dolphin": "a dolphin under the water"}


def pictures(study):
    large = study.sweep("pictures")
    shown = {(scene, method): large.picture(scene=scene, method=method)[""] for scene in SCENES for method in ("beamtree", "none")}
    level = white(*[shown[scene, "beamtree"] for scene in SCENES])
    plate = strip([[(f"{what}, with caustics", shown[scene, "beamtree"]), (f"{what}, without", shown[scene, "none"])]
                   for scene, what in SCENES.items()], level)
    lights = {scene: float(large.picture(scene=scene, method="beamtree")["caustic"].sum()) for scene in SCENES}
    black = {scene: float(large.picture(scene=scene, method="none")["caustic"].sum()) for scene in SCENES}
    return Part({"without": counted(max(black.values()) / min(lights.values()), "caustic light without over with")}, [], [Figure(
        "figures14-17", "Figures 14 to 17: a pool and a dolphin, with and without caustics",
        "Left: backward beam tracing through 75 x 101 quads of water. Right: ray tracing alone, where light goes straight through the "
        "water, weakened by its surface. 600 x 600 pixels, 4 rays each, one exposure; the waves 1.5 times those of pool_waves.json. The "
        "dolphin is made by tools/make_dolphin.py: the body is not divided for the caustics on it.", *plate)])


def same_as_watt(study):
    """Largest difference of the caustic layer, over its largest value; with quads and with triangles."""
    small = study.sweep("small_pictures")
    differences, rows, notes = {}, [], {}
    for polygons in ("quads", "triangles"):
        for scene, what in SCENES.items():
            beams, watt = (small.picture(scene=scene, method=method, with_polygons=polygons)["caustic"] for method in ("beamtree", "causticpolygons"))
            difference, scale = beams - watt, float(beams.max())
            largest = float(np.abs(difference).max()) / scale
            differences.setdefault(polygons, []).append(largest)
            notes.setdefault(polygons, []).append(f"{what}: {int((np.abs(difference).max(axis=2) > 1e-6 * scale).sum())} pixels")
            level = white(beams)
            rows.append([(f"{scene.partition('_')[2]}, {polygons}: beams", enlarged(beams), level), ("Watt's polygons", enlarged(watt), level),
                         (f"difference, {largest:.1g} at most", enlarged(signed(difference, 1e-6 * scale)), 1.0)])
    figure = Figure("watt", "The caustic component, by beams and by Watt's method",
                    "100 x 100 pixels, the size of the paper's pictures, one ray each. The third column shows the difference, red and blue from "
                    "a millionth of the brightest pixel on. With quads the two part at some points of walls near the water's edge.", *strip(rows))
    return Part({f"same_as_watt_{polygons}": counted(max(values), "of the brightest pixel", "parting by more than a millionth of it, "
                                                + ", ".join(notes[polygons])) for polygons, values in differences.items()}, [], [figure])


def enlarged(picture, times=2):
    return picture.repeat(times, axis=0).repeat(times, axis=1)


SECTIONS = {"figures14-17": pictures, "same-as-watt": same_as_watt}
