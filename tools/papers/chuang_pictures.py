"""Chuang & Cheng 1995, figures 14 to 17: a pool and a dolphin in it, with and without caustics; the same as Watt's."""
import matplotlib.pyplot as plt
import numpy as np

from papers.figures import luminance, png, srgb, strip, white
from papers.part import Figure, Part
from papers.verdict import Measured, counted
from papers.words import short
from report import exr

SCENES = {"chuang_pool": "pool", "chuang_dolphin": "dolphin"}
NUMBERS = {("chuang_pool", "beamtree"): 14, ("chuang_pool", "none"): 15, ("chuang_dolphin", "beamtree"): 16, ("chuang_dolphin", "none"): 17}
INK = "0.35"


def pictures(study):
    large, small = study.sweep("pictures"), study.sweep("small_pictures")
    shown = {key: large.picture(scene=key[0], method=key[1])[""] for key in NUMBERS}
    as_printed = {key: small.picture(scene=key[0], method=key[1], **({} if key[1] == "none" else {"with_polygons": "quads"}))[""] for key in NUMBERS}
    level = {"beamtree": white(*[shown[scene, "beamtree"] for scene in SCENES]),
             "none": max(float(np.percentile(luminance(shown[scene, "none"]), 99.9)) for scene in SCENES)}
    plate = plate_of(shown, level)
    contrast = {key: float(np.percentile(luminance(picture), 99) / np.median(luminance(picture))) for key, picture in shown.items()}
    over = [contrast[scene, "beamtree"] / contrast[scene, "none"] for scene in SCENES]
    row = next(each for each in large.rows if each["method"] == "beamtree")
    side, rays = large.record(row)["scene"]["resolved"]["sensor"]["film"]["width"], row["spp"] if row.get("spp") else large.record(row)["spp"]
    brighter = f"The pictures without caustics are exposed {level['beamtree'] / level['none']:.1f} times as long."
    return Part({"without": Measured(over, unit="contrast, with over without", counted=True, note=(
        "brightest hundredth over the median, with and without: " + ", ".join(
            f"{what} {short(contrast[scene, 'beamtree'])} and {short(contrast[scene, 'none'])}" for scene, what in SCENES.items())))}, [], [
        Figure("figures14-17", "Figures 14 to 17: a pool and a dolphin, with and without caustics",
               "Left: backward beam tracing through 75 x 101 quads of water. Right: ray tracing alone, where light goes straight through the "
               f"water, weakened by its surface. {side} × {side} pixels, {rays} rays each; the waves 1.5 times those of pool_waves.json. {brighter} "
               "The dolphin is made by tools/make_dolphin.py; the light on it is found at its points, and it is not divided into cells.", *plate),
        Figure("figures14-17_small", "Figures 14 to 17 at the paper's size",
               f"The same pictures with the paper's 100 × 100 pixels of one ray, enlarged three times. {brighter}",
               *plate_of({key: enlarged(picture, 3) for key, picture in as_printed.items()}, level))])


def plate_of(shown, level):
    """(PNG, EXR) of the four figures, one scene a row; with and without caustics have a white of their own."""
    return strip([[(f"Fig. {NUMBERS[scene, method]}: {what}, {words}", shown[scene, method], level[method])
                   for method, words in (("beamtree", "with caustics"), ("none", "without"))] for scene, what in SCENES.items()])


def same_as_watt(study):
    """Largest difference of the caustic layer, over its largest value; with quads and with triangles."""
    small = study.sweep("small_pictures")
    differences, rows, notes = {}, [], {}
    for polygons in ("quads", "triangles"):
        for scene, what in SCENES.items():
            beams, watt = (small.picture(scene=scene, method=method, with_polygons=polygons)["caustic"] for method in ("beamtree", "causticpolygons"))
            scale = float(beams.max())
            difference = (beams - watt) / scale
            differences.setdefault(polygons, []).append(float(np.abs(difference).max()))
            parting = [int((np.abs(difference).max(axis=2) > least).sum()) for least in (1e-6, 0)]
            notes.setdefault(polygons, []).append(f"{what} {parting[0]} pixels by more than a millionth of it, {parting[1]} at all")
            rows.append((f"{what}, {polygons}", beams, watt, difference))
    caption = ("Caustic layer, 100 x 100 pixels, the size of the paper's pictures, one ray each; the pool is 2 m wide. Third column: the light by "
               "beams less that by Watt's method, over the brightest pixel, on a scale that ends at the largest difference of all; white is equal. "
               + "; ".join(f"{polygons}: {', '.join(words)}" for polygons, words in notes.items()) + ".")
    return Part({f"same_as_watt_{polygons}": counted(max(values), "of the brightest pixel", "parting: " + "; ".join(notes[polygons]))
                 for polygons, values in differences.items()}, [], [
        Figure("watt", "The caustic component, by beams and by Watt's method", caption, draw_differences(rows),
               exr.encode(np.vstack([np.hstack([beams, watt]) for _, beams, watt, _ in rows]).astype(np.float32)))])


def draw_differences(rows):
    """PNG: beams, Watt's and their difference, framed, with the scale of the differences."""
    largest = max(float(np.abs(difference).max()) for *_, difference in rows) or 1.0
    figure, axes = plt.subplots(len(rows), 3, figsize=(6.6, 2.25 * len(rows) + 0.6), dpi=150, layout="constrained")
    for row, (name, beams, watt, difference) in zip(axes, rows):
        level = white(beams)
        for ax, picture, title in zip(row, (beams, watt), (f"{name}: beams", "Watt's polygons")):
            ax.imshow(srgb(picture / level), interpolation="none")
            ax.set_title(title, fontsize=8.5)
        greatest = np.take_along_axis(difference, np.abs(difference).argmax(axis=2)[..., None], axis=2)[..., 0]
        drawn = row[2].imshow(greatest, cmap="bwr", vmin=-largest, vmax=largest, interpolation="none")
        row[2].set_title(f"difference, at most {np.abs(difference).max():.1g}", fontsize=8.5)
    for ax in axes.flat:
        ax.set_xticks([])
        ax.set_yticks([])
        for edge in ax.spines.values():
            edge.set_color(INK)
            edge.set_linewidth(0.6)
    bar = figure.colorbar(drawn, ax=axes, location="bottom", fraction=0.02, aspect=50, pad=0.01)
    bar.set_label("difference over the brightest pixel", fontsize=8.5)
    bar.ax.tick_params(labelsize=8)
    return png(figure)


def enlarged(picture, times=2):
    return picture.repeat(times, axis=0).repeat(times, axis=1)


SECTIONS = {"figures14-17": pictures, "same-as-watt": same_as_watt}
