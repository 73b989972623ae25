"""Jensen 1996, figure 2 and its rows of the table: a glass ball on stone, the caustic's shape, photons, trees, N."""
import json
import math

import numpy as np

from papers.figures import strip, white
from papers.jensen_ring import preprocess
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import short, spread
from report.records import natural

QUANTILE, THRESHOLD = 0.995, 0.3  # what belongs to the spot: above this share of that quantile
DARK = 0.02  # of the same


def table(study):
    trials = study.sweep("figure2")
    few, many = (study.paper.number(name) for name in ("figure2_photons", "figure2_reference_photons"))
    seconds = lambda photons, tree: trials.column("render_cpu_s", method="photonmap", photons=photons, tree=tree)
    prepare = lambda photons, tree="balanced": preprocess(trials, method="photonmap", photons=photons, tree=tree)
    balance = lambda photons: trials.column("balance_cpu_s", method="photonmap", photons=photons, tree="balanced")
    bytes_of = lambda tree: trials.column("map_bytes", method="photonmap", photons=many, tree=tree)[0]
    bare = trials.column("render_cpu_s", method="none")
    saved = ratio(seconds(many, "balanced"), seconds(many, "unbalanced"), "CPU s")
    without = [(a - b) / (c - b) for a, b, c in zip(seconds(many, "balanced"), bare, seconds(many, "unbalanced"))]
    saved.samples = [1 - each for each in saved.samples]
    saved.note = f"less the eye pass without caustic, {spread(bare, 'CPU s')}: {spread([1 - each for each in without])}"
    grown = {tree: ratio(seconds(many, tree), seconds(few, tree), "CPU s") for tree in ("balanced", "unbalanced")}
    part = Part({
        "ball_unbalanced": ratio(seconds(few, "unbalanced"), seconds(few, "balanced"), "CPU s"),
        "ball_unbalanced_many": ratio(seconds(many, "unbalanced"), seconds(many, "balanced"), "CPU s"),
        "ball_saved": saved,
        "ball_growth": grown["balanced"],
        "ball_growth_unbalanced": grown["unbalanced"],
        "ball_flatter": ratio(grown["unbalanced"].samples, grown["balanced"].samples, "times"),
        "ball_preprocess": ratio(prepare(many), prepare(few), "CPU s"),
        "ball_balancing": ratio(balance(many), prepare(many), "CPU s"),
        "ball_megabytes": counted(bytes_of("balanced") / 1e6, "MB"),
        "ball_pointers": counted(bytes_of("unbalanced") / bytes_of("balanced"), "",
                                 f"{bytes_of('unbalanced') / 1e6:.1f} over {bytes_of('balanced') / 1e6:.1f} MB")})
    rows = [[f"{photons:,}", tree, spread(prepare(photons, tree)), spread(seconds(photons, tree)),
             f"{trials.column('map_bytes', photons=photons, tree=tree)[0] / 1e6:.1f}"]
            for photons in (few, many) for tree in ("balanced", "unbalanced")]
    rows.append(["none", "", "", spread(bare), ""])
    part.tables.append(Table("figure2", "Figure 2: photons and trees", ["photons", "tree", "preprocess [CPU s]", "rendering [CPU s]", "MB"], rows,
                             "640 × 480 pixels, 4 rays a pixel, N = 100; median and range of three repeats on one thread. Preprocess: "
                             "photons and tree."))
    return part


def sensitivity(study):
    trials = study.sweep("figure2_nearest")
    few, many = (study.paper.number(name) for name in ("figure2_photons", "figure2_reference_photons"))
    rows, saved = [], []
    for nearest in sorted(trials.values("nearest"), key=natural):
        seconds = lambda photons, tree: trials.column("render_cpu_s", nearest=nearest, photons=photons, tree=tree)
        over = lambda a, b: ratio(a, b, "").samples
        first = over(seconds(few, "unbalanced"), seconds(few, "balanced"))
        second = over(seconds(many, "unbalanced"), seconds(many, "balanced"))
        rows.append([nearest, spread(first), spread(second), spread([1 - 1 / each for each in second]),
                     spread(over(seconds(many, "balanced"), seconds(few, "balanced"))),
                     spread(over(seconds(many, "unbalanced"), seconds(few, "unbalanced")))])
        saved += [1 - 1 / each for each in second]
    return Part(tables=[Table("figure2_nearest", "Figure 2: how much N matters",
                              ["N", "unbalanced / balanced, fewer photons", "unbalanced / balanced, more photons", "share saved there",
                               "more / fewer photons, balanced", "more / fewer photons, unbalanced"], rows,
                              f"CPU times of rendering; {few:,} and {many:,} photons, 320 × 240 pixels.")],
                facts={"ball_saved_over_n": f"{short(min(saved))} to {short(max(saved))} for N = {rows[0][0]} to {rows[-1][0]}"})


class Floor:
    """Where on the floor, z = 0, a picture's pixels look, and which of them see it first."""

    def __init__(self, layers, scene):
        sensor = scene["sensor"]
        view = sensor["to_world"][0]["look_at"]
        origin, forward = np.array(view["origin"]), np.subtract(view["target"], view["origin"])
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, view["up"])
        right /= np.linalg.norm(right)
        up = np.cross(right, forward)
        height, width = layers[""].shape[:2]
        half = math.tan(math.radians(sensor["fov"]) / 2)
        x = (2 * (np.arange(width) + 0.5) / width - 1) * half
        y = (1 - 2 * (np.arange(height) + 0.5) / height) * half * height / width
        rays = forward + x[None, :, None] * right + y[:, None, None] * up
        way = -origin[2] / rays[..., 2]
        self.points = (origin + way[..., None] * rays)[..., :2]
        albedo = layers["albedo"]
        self.seen = (rays[..., 2] < 0) & (albedo.max(axis=2) < 0.9)  # glass has an albedo of 1
        self.irradiance = np.where(self.seen, (layers["caustic"] / np.maximum(albedo, 1e-3)).mean(axis=2), 0)


def curvature(floor):
    """The spot's parabola y = c x² along its principal axes: c var x / sqrt(var y), 0 for an oval."""
    spot = floor.seen & (floor.irradiance > THRESHOLD * np.quantile(floor.irradiance[floor.seen], QUANTILE))
    points = floor.points[spot] - floor.points[spot].mean(axis=0)
    _, axes = np.linalg.eigh(np.cov(points.T))
    if axes[0, 1] < 0:
        axes[:, 1] *= -1  # along x, away from the lamp
    along = points @ axes[:, 1]
    across = points @ np.array([-axes[1, 1], axes[0, 1]])
    bend = np.polyfit(along, across, 2)[0]
    return float(bend * along.var() / math.sqrt(across.var()))


def shape(study):
    trials = study.sweep("figure2_shape")
    scene = json.loads((study.scenes / "jensen_ball.json").read_text(encoding="utf-8"))
    bends = {alpha: [curvature(Floor(layers, scene)) for layers in trials.pictures(alpha=alpha)] for alpha in ("1", "0.1")}
    size = lambda alpha: [abs(each) for each in bends[alpha]]
    note = f"index {spread(bends['0.1'])} at alpha 0.1, {spread(bends['1'])} at alpha 1"
    shown = {alpha: trials.picture(alpha=alpha, seed=1) for alpha in bends}
    pictures = strip([[(f"alpha = {alpha}", halved(shown[alpha]["caustic"]), white(shown[alpha]["caustic"])) for alpha in ("1", "0.1")]])
    whole = study.sweep("figure2_overview").picture()[""]
    return Part({
        "ball_curved": Measured(size("0.1"), note=note),
        "ball_oval": Measured(size("1"), note=note),
        "ball_bends": Measured([a - b for a, b in zip(size("0.1"), size("1"))], note=note)}, [], [
        Figure("figure2", "Figure 2: the caustic of a glass ball on glossy stone",
               f"alpha = 0.1, {study.paper.number('figure2_photons'):,} photons, N = 100, 4 rays a pixel. The lamp stands 30 degrees high, at "
               "the right; the eye looks across its light.", *strip([[("alpha = 0.1", whole)]])),
        Figure("figure2_shape", "Figure 2: oval at alpha 1, curved at alpha 0.1",
               "The caustic alone on the floor, each at its own exposure. The index in the table fits a parabola to the spot, on the "
               "floor, not in the picture: perspective does not bend it.", *pictures)])


def halved(picture):
    """Means over two by two pixels."""
    return (picture[::2, ::2] + picture[1::2, ::2] + picture[::2, 1::2] + picture[1::2, 1::2]) / 4


def blur(study):
    """Fewer photons at one N: wider discs, so light where it should be dark."""
    trials = study.sweep("figure2_blur")
    scene = json.loads((study.scenes / "jensen_ball.json").read_text(encoding="utf-8"))
    counts = sorted(trials.values("photons"), key=natural)
    floors = {count: [Floor(layers, scene) for layers in trials.pictures(photons=count)] for count in counts}
    sharp = floors[counts[-1]][0]
    dark = sharp.seen & (sharp.irradiance < DARK * np.quantile(sharp.irradiance[sharp.seen], QUANTILE))
    stray = {count: [float(floor.irradiance[dark].sum() / floor.irradiance[floor.seen].sum()) for floor in floors[count]] for count in counts}
    middle = peak(sharp)
    widths = {count: [half_width(floor, middle) for floor in floors[count]] for count in counts}
    nice = str(study.paper.number("figure2_photons"))
    fewer = counts[counts.index(nice) - 1]
    rows = [[f"{int(count):,}", spread([100 * each for each in stray[count]]), spread([1000 * each for each in widths[count]])] for count in counts]
    titled = lambda some: [(f"{int(count):,} photons", trials.picture(photons=count, seed=1)[""]) for count in some]
    return Part({"ball_blur": ratio(stray[fewer], stray[nice], "of the light in the dark",
                                    note="the width of the spot does not show it: it is wider than the discs of the estimates")}, [Table(
        "figure2_blur", "Figure 2: blur over photons", ["photons", "light in the dark [%]", "width of the spot [mm]"], rows,
        f"N = 100, alpha 0.1. Dark: below {100 * DARK:g} % of the spot in the picture of the most photons. Width: across the light's direction, "
        "where the light summed over 0.2 m along it falls to a half.")],
        [Figure("figure2_blur", "Figure 2: fewer photons make the caustic more blurred",
                "The same view with 1 % of the paper's photons to four times as many, at one N = 100 and one exposure.",
                *strip([titled(counts[:2]), titled(counts[2:])]))])


def peak(floor):
    """Where the spot is brightest along x [m]: the middle of its light."""
    spot = floor.seen & (floor.irradiance > THRESHOLD * np.quantile(floor.irradiance[floor.seen], QUANTILE))
    return float(np.average(floor.points[spot][:, 0], weights=floor.irradiance[spot]))


def half_width(floor, middle, reach=0.1, step=0.005):
    """Full width at half the maximum of the light across the spot [m]."""
    near = floor.seen & (np.abs(floor.points[..., 0] - middle) < reach)
    y, light = floor.points[near][:, 1], floor.irradiance[near]
    bins = np.arange(y.min(), y.max(), step)
    sums, counts = (np.histogram(y, bins, weights=weights)[0] for weights in (light, None))
    profile = sums / np.maximum(counts, 1)
    top = int(np.argmax(profile))
    half = profile[top] / 2
    left = next(i for i in range(top, -1, -1) if profile[i] <= half)
    right = next(i for i in range(top, len(profile)) if profile[i] <= half)
    between = lambda low, high: low + (half - profile[low]) / (profile[high] - profile[low]) * (high - low)
    return step * (between(right - 1, right) - between(left, left + 1))


SECTIONS = {"figure2-table": table, "figure2-nearest": sensitivity, "figure2-shape": shape, "figure2-blur": blur}
