"""Chen 2011: chromatic dispersion. The fringe of a prism against its closed form; colour of crystal glass."""
import json
import math

import numpy as np

from papers.figures import luminance, strip, white
from papers.jensen_ball import Floor
from papers.part import Figure, Part, Table
from papers.verdict import Measured, ratio
from papers.words import spread

# Sellmeier's law of SF10 (Schott): B, C [um^2]; the faces that light passes; the lamp; of experiments/scenes/prism.json.
SF10 = ((1.61625977, 0.0127534559), (0.259229334, 0.0581983954), (1.07762317, 116.60768))
SHORTEST, LONGEST = 380, 730  # nm


def measure(study):
    return fringe(study).add(colour(study))


def index(nm):
    square = (nm / 1000) ** 2
    return math.sqrt(1 + sum(b * square / (square - c) for b, c in SF10))


def bent(way, normal, eta):
    """Snell's law for a unit direction, a unit normal against it, and n before over n behind."""
    cosine = -way @ normal
    return eta * way + (eta * cosine - math.sqrt(1 - eta * eta * (1 - cosine * cosine))) * normal


def landing(scene, nm):
    """x on the table of the lamp's axis at a wavelength [m]."""
    view = scene["lamp"]["to_world"][0]["look_at"]
    place, target = np.array(view["origin"]), np.array(view["target"])
    way = (target - place) / np.linalg.norm(target - place)
    lift = np.array(scene["prism"]["to_world"][0]["translate"])
    n = index(nm)
    for face, eta in ((scene["prism"]["planes"][0], 1 / n), (scene["prism"]["planes"][1], n)):
        normal, distance = np.array(face[:3]), face[3] + np.array(face[:3]) @ lift
        place = place + (distance - place @ normal) / (way @ normal) * way
        way = bent(way, normal if way @ normal < 0 else -normal, eta)
    return float((place - place[2] / way[2] * way)[0])


def channel_weights(nm):
    """Red, green and blue of a wavelength: the CIE's observer by the fits of Wyman et al. 2013, in linear sRGB, not below 0."""
    lobe = lambda middle, below, above: math.exp(-0.5 * ((nm - middle) / (below if nm < middle else above)) ** 2)
    x = 1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2)
    y = 0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1)
    z = 1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)
    to_rgb = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])
    return np.maximum(to_rgb @ (x, y, z), 0)


def fringe(study):
    trials = study.sweep("prism")
    scene = json.loads((study.scenes.parents[1] / "scenes" / "prism.json").read_text(encoding="utf-8"))
    waves = np.arange(SHORTEST, LONGEST + 1)
    weights = np.array([channel_weights(nm) for nm in waves])
    places = np.array([landing(scene, nm) for nm in waves])
    theirs = (weights * places[:, None]).sum(axis=0) / weights.sum(axis=0)
    ours = []
    for layers in trials.pictures():
        x = Floor(layers, scene).points[..., 0]
        area = np.abs(floor_area(layers, scene))
        near = np.abs(x - theirs[1]) < 0.2
        ours.append([float((x * area * layers["caustic"][..., k])[near].sum() / (area * layers["caustic"][..., k])[near].sum()) for k in range(3)])
    widths = [1000 * abs(each[0] - each[2]) for each in ours]
    width = 1000 * abs(theirs[0] - theirs[2])
    rows = [[name, f"{1000 * theirs[k]:.2f}", spread([1000 * each[k] for each in ours])] for k, name in enumerate(("red", "green", "blue"))]
    rows.append(["red to blue", f"{width:.2f}", spread(widths)])
    picture = strip([[("", trials.picture(seed=1)[""])]])
    return Part({"fringe": Measured([each / width for each in widths], note=f"{spread(widths, 'mm')} from the middle of the red to that of the blue; "
                                    f"in closed form {width:.2f} mm")}, [Table(
        "prism", "The fringe of a prism of SF10", ["channel", "middle in closed form [mm]", "middle in the picture [mm]"], rows,
        "Where the light falls on the table, along x. Closed form: Snell's law at both faces for the lamp's axis, Sellmeier's law, weighed "
        "by the CIE's observer.")], [Figure("prism", "Chromatic dispersion", "White light through a prism of SF10: a rainbow whose width is that of the "
                                            "closed form.", *picture)])


def floor_area(layers, scene):
    """The table's area that each pixel sees, but for a factor."""
    points = Floor(layers, scene).points
    down, across = np.gradient(points, axis=0), np.gradient(points, axis=1)
    return down[..., 0] * across[..., 1] - down[..., 1] * across[..., 0]


def colour(study):
    """How coloured the caustic is: the mean distance of its channels from grey, over its light."""
    trials = study.sweep("glass")
    names = {("dispersive" if "abbe" in row["index"] else f"n = {row['index']}"): row["index"] for row in trials.rows}

    def chroma(layers):
        light = layers["caustic"]
        grey = light.mean(axis=2, keepdims=True) * light.mean(axis=(0, 1)) / light.mean()
        return float(np.abs(light - grey).sum() / light.sum())

    found = {name: [chroma(layers) for layers in trials.pictures(index=index)] for name, index in names.items()}
    rows = [[name, spread(values)] for name, values in sorted(found.items())]
    contrast = {name: [float(luminance(layers["caustic"]).std() / luminance(layers["caustic"]).mean()) for layers in trials.pictures(index=names[name])]
                for name in ("n = 1.5", "n = 1.7")}
    level = white(trials.picture(index=names["dispersive"], seed=1)[""])
    shown = [(name, trials.picture(index=index, seed=1)[""].repeat(2, axis=0).repeat(2, axis=1)) for name, index in sorted(names.items(), reverse=True)]
    return Part({"rainbows": ratio(found["dispersive"], found["n = 1.7"], "colour"),
                 "higher_index": ratio(contrast["n = 1.7"], contrast["n = 1.5"], "contrast")}, [Table(
        "glass", "Colour of the cut bowl's caustic", ["glass", "mean distance from grey over the light"], rows, "Noise of photons of one wavelength is "
        "colour too; without dispersion all photons are white.")], [Figure(
            "glass", "The cut bowl of ordinary and of crystal glass", "n = 1.5, n = 1.7, and n = 1.7 with Abbe's number 30: higher index, more distortion; "
            "dispersion, rainbows.", *strip([shown], level))])
