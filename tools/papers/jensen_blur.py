"""Jensen 1996, figure 2: blur and noise of the caustic over photons and N, and beside an illumination map."""
import dataclasses
import math
import statistics

import numpy as np
from scipy.ndimage import gaussian_filter

from papers.figures import is_diffuse, luminance, mean_of, strip
from papers.jensen_ball import QUANTILE, SCENE, THRESHOLD, Floor
from papers.part import Figure, Part, Table
from papers.verdict import Measured, ratio
from papers.words import spread
from report.records import natural

DARK = 0.02  # of the spot's level
REACH, STEP = 0.1, 0.005  # of the profile across the spot [m]
KINDS = {"photon map, a point's N nearest": {"method": "photonmap", "kernel": "point"},
         "photon map, discs of the photons' own, strata": {"method": "photonmap", "kernel": "photon"},
         "illumination map": {"method": "illuminationmap"}}
PAPERS, OURS, MAP = KINDS


@dataclasses.dataclass
class Errors:
    """Of one map's pictures, one value a disjoint pair of seeds: squares of relative deviations from the most photons."""
    rmse: list
    noise: list
    blur: list


def blur(study):
    trials = study.sweep("figure2_blur")
    scene = study.scene(SCENE)
    maps = [(row["photons"], row["nearest"]) for row in trials.where(seed="1")]
    maps.sort(key=lambda each: tuple(map(natural, each)))
    floors = {each: [Floor(layers, scene) for layers in trials.pictures(photons=each[0], nearest=each[1])] for each in maps}
    nice, most = str(study.paper.number("figure2_photons")), maps[-1]
    usual = most[1]
    counts = [photons for photons, nearest in maps if nearest == usual]
    small, large = (each for each in maps if each[0] == nice and each[1] != usual)
    fewer = (counts[counts.index(nice) - 1], usual)
    weight = weights(floors[most])
    found = {each: errors(floors[each], floors[most], weight) for each in maps}
    part = Part({
        "ball_blur": more_blur(found[fewer], found[nice, usual], f"{int(fewer[0]):,} photons against {int(nice):,}, N = {usual}"),
        "ball_noisy": ratio(found[small].noise, found[nice, usual].noise, "of the squared caustic", note=f"N = {small[1]} against {usual}"),
        "ball_blurred": more_blur(found[large], found[nice, usual], f"N = {large[1]} against {usual}")})
    part.tables.append(table(floors, found, maps))
    edge = lambda each: spread([1000 * edges(floor, peak(floors[most][0]))[1] for floor in floors[each]])
    part.facts["ball_other_blurs"] = f"the edge is {edge(fewer)} mm at {int(fewer[0]):,} photons and {edge((nice, usual))} mm at {int(nice):,}"
    titled = lambda some: [(f"{int(count):,} photons", trials.picture(photons=count, nearest=usual, seed=1)[""]) for count in some]
    level = float(np.percentile(luminance(trials.picture(photons=most[0], seed=1)[""]), 99.8))
    part.figures.append(Figure(
        "figure2_blur", "Figure 2: fewer photons make the caustic more blurred",
        f"The same view with {100 * int(counts[0]) / int(nice):.0f} % of the paper's photons to {int(most[0]) / int(nice):.0f} times as many, at one "
        f"N = {usual} and one exposure. More photons make smaller discs, not less noise.", *strip([titled(counts[:2]), titled(counts[2:])], level)))
    return part


def more_blur(more, less, what):
    """Differences of squares: the blur of many photons cannot be told from 0, so there is no ratio."""
    shown = lambda errors: f"{100 * root(errors.blur):.2g} %"
    return Measured([a - b for a, b in zip(more.blur, less.blur)],
                    note=f"{what}: blur {shown(more)} against {shown(less)}, by disjoint pairs of seeds; blur is the deviation from the most photons "
                    "that pictures of two seeds share")


def root(squares):
    return math.sqrt(max(0.0, statistics.fmean(squares)))


def weights(truths):
    """What deviations are divided by: the caustic, smoothed, and a little where it is dark."""
    mean = np.mean([floor.irradiance for floor in truths], axis=0)
    return 1 / (gaussian_filter(mean, 3) + DARK * np.quantile(mean[truths[0].seen], QUANTILE))


def errors(floors, truths, weight):
    """Pairs of seeds against the means of two other seeds each: four independent pictures, so noise cancels in the product of two deviations."""
    pairs = range(0, len(floors), 2)
    seen = np.logical_and.reduce([floor.seen for floor in [*floors, *truths]])
    light = lambda floor: (floor.irradiance * weight)[seen]
    found = Errors([], [], [])
    for first in pairs:
        left, right = (np.mean([light(truths[other + side]) for other in pairs if other != first], axis=0) for side in (0, 1))
        a, b = light(floors[first]), light(floors[first + 1])
        share = lambda squares: float(squares.mean() / (left * right).mean())
        found.rmse.append(share((a - (left + right) / 2) ** 2))
        found.noise.append(share((a - b) ** 2 / 2))
        found.blur.append(share((a - left) * (b - right) + (a - right) * (b - left)) / 2)
    return found


def table(floors, found, maps):
    sharp = floors[maps[-1]][0]
    dark = sharp.seen & (sharp.irradiance < DARK * np.quantile(sharp.irradiance[sharp.seen], QUANTILE))
    stray = lambda floor: 100 * float(floor.irradiance[dark].sum() / floor.irradiance[floor.seen].sum())
    middle = peak(sharp)
    per_cent = lambda squares: f"{100 * root(squares):.2g}"
    rows = []
    for each in maps:
        sides = [edges(floor, middle) for floor in floors[each]]
        millimetres = lambda side: spread([1000 * each[side] for each in sides])
        rows.append([f"{int(each[0]):,}", each[1], *map(per_cent, (found[each].rmse, found[each].noise, found[each].blur)),
                     millimetres(0), millimetres(1), spread(list(map(stray, floors[each])))])
    return Table("figure2_blur", "Figure 2: blur and noise over photons and N",
                 ["photons", "N", "rmse [%]", "noise [%]", "blur [%]", "half width [mm]", "edge, 90 to 10 % [mm]", "light in the dark [%]"], rows,
                 f"alpha 0.1, {len(floors[maps[0]])} seeds. Deviations of the caustic on the floor, each divided by the caustic there and "
                 f"{100 * DARK:g} % of the spot: rmse against the mean of other seeds of the most photons, whose own noise is in it; noise from "
                 "pairs of seeds; blur is what the deviations of two seeds share. Width and edge: across the light's direction, summed over "
                 f"{2 * REACH:g} m along it. Dark: below {100 * DARK:g} % of the spot.")


def peak(floor):
    """Where the spot is brightest along x [m]: the middle of its light."""
    spot = floor.seen & (floor.irradiance > THRESHOLD * np.quantile(floor.irradiance[floor.seen], QUANTILE))
    return float(np.average(floor.points[spot][:, 0], weights=floor.irradiance[spot]))


def edges(floor, middle):
    """(full width at half the maximum, mean way from 90 to 10 % on both sides) of the light across the spot [m]."""
    near = floor.seen & (np.abs(floor.points[..., 0] - middle) < REACH)
    y, light = floor.points[near][:, 1], floor.irradiance[near]
    bins = np.arange(y.min(), y.max(), STEP)
    sums, counts = (np.histogram(y, bins, weights=weights)[0] for weights in (light, None))
    profile = sums / np.maximum(counts, 1)
    top = int(np.argmax(profile))
    sides = [profile[top:], profile[top::-1]]
    falls = lambda share: [crossing(side, share * profile[top]) for side in sides]
    return STEP * sum(falls(0.5)), STEP * (sum(falls(0.1)) - sum(falls(0.9))) / 2


def crossing(profile, level):
    """Steps until a profile falls to the level."""
    after = next(i for i in range(1, len(profile)) if profile[i] <= level)
    return after - 1 + (profile[after - 1] - level) / (profile[after - 1] - profile[after])


class Deviations:
    """Errors of pictures, each against two pictures of light tracing, so that the noise of these cancels."""

    def __init__(self, truths):
        self.seen = is_diffuse(truths[0])
        light = luminance(mean_of(truths, "caustic"))
        self.weight = 1 / (gaussian_filter(light, 3) + DARK * np.quantile(light[self.seen], 0.995))[self.seen]
        self.truths = [self.of(layers) for layers in truths]

    def of(self, layers):
        return luminance(layers["caustic"])[self.seen] * self.weight

    def squares(self, pictures):
        """Relative square errors, one a picture."""
        found = []
        for i, layers in enumerate(pictures):
            one, other = (self.truths[(i + step) % len(self.truths)] for step in (1, 2))
            light = self.of(layers)
            found.append(float(((light - one) * (light - other)).mean() / (one * other).mean()))
        return found

    def noise(self, pictures):
        """The part of the square error that is scatter over the seeds."""
        some = [self.of(layers) for layers in pictures]
        return float(np.var(some, axis=0, ddof=1).mean() / statistics.fmean(float((one * other).mean()) for one, other in zip(self.truths, self.truths[1:])))


def illumination(study):
    trials = study.sweep("illumination")
    errors = Deviations(trials.pictures(method="lighttrace"))
    column = {PAPERS: "nearest", OURS: "nearest", MAP: "resolution"}
    found, rows = {}, []
    for kind, wanted in KINDS.items():
        for value in sorted({row[column[kind]] for row in trials.where(**wanted)}, key=float):
            pictures = trials.pictures(**wanted, **{column[kind]: value})
            squares = errors.squares(pictures)
            found[kind, value] = [math.sqrt(max(0.0, each)) for each in squares]
            noise = errors.noise(pictures)
            blur = math.sqrt(max(0.0, statistics.fmean(squares) - noise))
            rows.append([kind, value, spread([100 * each for each in found[kind, value]]), f"{100 * math.sqrt(noise):.3g}", f"{100 * blur:.3g}"])
    best = {kind: min((each for each in found if each[0] == kind), key=lambda each: statistics.fmean(found[each])) for kind in KINDS}
    per_cent = lambda each: [100 * value for value in found[each]]
    against = lambda each, **more: ratio(per_cent(each), per_cent(best[MAP]), "% of the light",
                                         note=f"N = {each[1]} against {best[MAP][1]} texels a side, {paths:,} light paths each, on a diffuse floor", **more)
    paths = int(trials.where(method="illuminationmap")[0]["emitted"])
    ours = {f"the same with discs of the photons' own and strata, N = {best[OURS][1]}": against(best[OURS]).samples}
    measured = {"map_less_noisy": against(best[PAPERS], beside=ours), "map_less_noisy_usual": against((PAPERS, "100"))}
    table = Table("illumination", "Figure 2 on a diffuse floor: photon map and illumination map", ["method", "N or texels a side", "error [%]", "noise [%]", "blur [%]"], rows,
                  f"{len(trials.values('seed'))} seeds. Errors of the caustic on the floor against light tracing, each divided by the light there, smoothed, and "
                  f"{100 * DARK:g} % of the brightest; noise is their scatter over the seeds, blur the rest.")
    return Part(measured, [table])


SECTIONS = {"figure2-blur": blur, "illumination": illumination}
