"""Chen 2011: chromatic dispersion. The fringe of a prism against its closed form; colour of crystal glass."""
import json
import math

import matplotlib.pyplot as plt
import numpy as np
from scipy.interpolate import griddata

from papers.figures import STYLE, is_diffuse, luminance, mean_of, png, srgb, strip, white
from papers.jensen_ball import Floor
from papers.part import Figure, Part, Table
from papers.verdict import Measured, in_common, ratio
from papers.words import short, spread

# Sellmeier's law of SF10 (Schott): B, C [um^2]; the faces that light passes; the lamp; of experiments/scenes/prism.json.
SF10 = ((1.61625977, 0.0127534559), (0.259229334, 0.0581983954), (1.07762317, 116.60768))
SHORTEST, LONGEST = 380, 730  # nm


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
    scene = trials.record(trials.rows[0])["scene"]["resolved"]
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
    mean = {layer: mean_of(trials.pictures(), layer) for layer in ("", "caustic")}
    picture = drawn(mean, Floor(trials.picture(), scene).points, theirs), strip([[("", mean[""])]])[1]
    return Part({"fringe": Measured([each / width for each in widths], note=f"{spread(widths, 'mm')} from the middle of the red to that of the blue; "
                                    f"in closed form {width:.2f} mm")}, [Table(
        "prism", "The fringe of a prism of SF10", ["channel", "middle in closed form [mm]", "middle in the picture [mm]"], rows,
        "Where the light falls on the table, along x. Closed form: Snell's law at both faces for the lamp's axis, Sellmeier's law, weighed "
        "by the CIE's observer.")], [Figure("prism", "Chromatic dispersion", "White light through a prism of SF10. Above, the scene: the lamp's "
                                            "light falls on the prism from above and is bent to the right. Below, the rainbow from straight above, and its "
                                            "light along the table in red, green and blue; dashed, the middle of each channel in closed form.", *picture)])


def drawn(mean, points, theirs):
    """PNG of the scene, and of the rainbow along x with the places of the closed form."""
    middle = 1000 * float(theirs[1])
    x, y = 1000 * points[..., 0], 1000 * points[..., 1]
    across = (np.abs(y) < 40) & (x > middle - 120) & (x < middle + 180)
    edges = np.linspace(middle - 120, middle + 180, 64)
    sums = [np.histogram(x[across], edges, weights=mean["caustic"][..., k][across])[0] for k in range(3)]
    counts = np.maximum(np.histogram(x[across], edges)[0], 1)
    above = griddata((x[across], y[across]), mean["caustic"][across], tuple(np.meshgrid(np.linspace(edges[0], edges[-1], 400), np.linspace(-20, 20, 64))))
    level = float(np.nanpercentile(luminance(above), 99))
    with plt.rc_context(STYLE):
        figure, (scene, strip_of, curve) = plt.subplots(3, 1, figsize=(6.4, 6.2), dpi=150, layout="constrained", height_ratios=(3.1, 0.9, 2))
        scene.imshow(srgb(mean[""][15:250, 20:560] / float(np.percentile(luminance(mean[""]), 99.7))), interpolation="bicubic")
        scene.axis("off")
        strip_of.imshow(srgb(np.nan_to_num(above) / level), extent=(edges[0], edges[-1], -20, 20), origin="lower", aspect="auto", interpolation="bilinear")
        strip_of.set(xlim=(edges[0], edges[-1]), ylim=(-20, 20), ylabel="y [mm]")
        strip_of.tick_params(labelbottom=False)
        for values, place, colour, name in zip(sums, theirs, ("#c0392b", "#2e8b57", "#2c5fb3"), ("red", "green", "blue")):
            curve.plot((edges[1:] + edges[:-1]) / 2, values / counts, color=colour, label=name)
            curve.axvline(1000 * place, color=colour, linestyle="--", linewidth=1)
        curve.set(xlim=(edges[0], edges[-1]), ylim=(0, None), xlabel="x on the table [mm]", ylabel="light [W/(m² sr)]")
        curve.legend()
        return png(figure)


def floor_area(layers, scene):
    """The table's area that each pixel sees, but for a factor."""
    points = Floor(layers, scene).points
    down, across = np.gradient(points, axis=0), np.gradient(points, axis=1)
    return down[..., 0] * across[..., 1] - down[..., 1] * across[..., 0]


def colour(study):
    """The caustic's colour that independent seeds share, and how far light is moved from where it would go unbent."""
    trials = study.sweep("glass")
    names = {("dispersive" if "abbe" in row["index"] else f"n = {row['index']}"): row["index"] for row in trials.rows}
    pictures = {name: trials.pictures(index=index, method="photonmap") for name, index in names.items()}
    shared = {name: shared_colour(pictures[name]) for name in names}
    straight = {name: trials.picture(index=index, method="none") for name, index in names.items()}
    moved = {name: [displaced(layers, straight[name]) for layers in pictures[name]] for name in names}
    rows = [[name, spread(shared[name]), spread(moved[name])] for name in sorted(names)]
    mean = {name: mean_of(pictures[name]) for name in names}
    return Part({"rainbows": Measured([a - b for a, b in zip(shared["dispersive"], shared["n = 1.7"])],
                                      note="squared distance from grey over the squared light, multiplied over disjoint pairs of seeds, so that noise is "
                                           "not taken for colour"),
                 "higher_index": ratio(moved["n = 1.7"], moved["n = 1.5"], "of the light")}, [Table(
        "glass", "The cut bowl by index and dispersion", ["glass", "colour that two seeds share", "light moved"], rows,
        "Light moved: half the mean difference from light that goes straight through the glass, over that light, on the table.")], [Figure(
            "glass", "The cut bowl of ordinary and of crystal glass",
            f"n = 1.5, n = 1.7, and n = 1.7 with Abbe's number 30: another index moves the light elsewhere; dispersion makes rainbows. Means of "
            f"{len(pictures['dispersive'])} seeds.",
            *strip([[(name, mean[name]) for name in sorted(names)]], white(mean["dispersive"])))],
        {"colour_by_abbe": by_abbe(study.sweep("glass_abbe"), shared["dispersive"])})


def shared_colour(pictures):
    """The squared colour that two seeds have in common."""
    return in_common([hue(layers) for layers in pictures])


def by_abbe(trials, middle):
    """The colour at other numbers of Abbe's over that at the one of the scene."""
    median = sorted(middle)[len(middle) // 2]
    of = lambda index: shared_colour(trials.pictures(index=index))[0] / median
    return " and ".join(f"{short(of(index))} times at {short(json.loads(index)['V_d'])}" for index in trials.values("index"))


def hue(layers):
    """The caustic less its grey, over its mean light."""
    light = layers["caustic"]
    grey = light.mean(axis=2, keepdims=True) * light.mean(axis=(0, 1)) / light.mean()
    return (light - grey) / light.mean()


def displaced(layers, straight):
    table = is_diffuse(layers)
    ours, theirs = luminance(layers[""])[table], luminance(straight[""])[table]
    return float(np.abs(ours - theirs).sum() / theirs.sum() / 2)


SECTIONS = {"prism": fringe, "crystal": colour}
