"""What those hypotheses compare whose numbers are counted, or come of pictures seed by seed, instead of raced."""
import math

import numpy as np

from duel.factors import case
from duel.ranges import Found
from duel.verdicts import Case

STEEP = -0.55  # of light tracing's error over paths


def slope(points):
    x, y = zip(*points)
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def counted(name, value, note=""):
    return [Case(name, value, value, value, note)]


def rows_of(results, sweep, **wanted):
    return [row for row in results.counts if row["sweep"] == sweep and all(row[key] == value for key, value in wanted.items())]


def tree_heights(results):
    found = []
    for name in ("casters", "lights"):
        rows = rows_of(results, f"counts_{name}")
        points = [(row["trees"] * row["height"], row["cone_point_tests"] / row["receiver_points"]) for row in rows]
        if len(points) > 2:
            found += counted(name, slope(points), "sum of heights: tests a point " + ", ".join(f"{x:.0f}: {y:.3g}" for x, y in sorted(points)))
    return found


def diffuse_detail(results):
    found = []
    for method, tests in (("beamtree", lambda row: row["cone_point_tests"] / row["receiver_points"]),
                          ("causticpolygons", lambda row: row["beam_polygon_tests"])):
        points = [(row["receiver_triangles"], tests(row)) for row in rows_of(results, "counts_floor", method=method)]
        if len(points) > 2:
            found += counted(method, slope(points))
    return found


def convergent(results):
    tests = {row["swept"]: row["cone_point_tests"] / row["beam_point_hits"] for row in rows_of(results, "counts_mirror")}
    if not tests:
        return []
    ratios = {shape: tests[f"{shape} single"] / tests[f"{shape} double"] for shape in ("concave", "flat", "convex")}
    note = ", ".join(f"{shape} {ratio:.3g}" for shape, ratio in ratios.items())
    return counted("concave over convex", ratios["concave"] / ratios["convex"], f"single over double: {note}")


def twenty_times(results):
    found = []
    for tree in ("balanced", "packed"):
        few, many = ([row["query_s"] for row in rows_of(results, "counts_photons", swept=f"{photons} {tree}")] for photons in (250000, 5000000))
        if len(few) > 1 and len(few) == len(many):
            logs = np.log(np.array(many) / np.array(few))
            found += case(tree, Found.exact(math.exp(logs.mean()), float(logs.std(ddof=1)) / math.sqrt(len(logs)), len(logs) - 1))
    return found


def blur_or_noise(results):
    from scipy.stats import spearmanr

    own = {row["nearest"]: row for row in results.spreads if row["method"] == "photonmap"}
    if len(own) < 3:
        return []
    order = sorted(own)
    return [each for name, key in (("bias", "bias_square"), ("variance", "variance"))
            for each in counted(name, float(spearmanr(order, [own[n][key] for n in order])[0]),
                                ", ".join(f"N = {n}: {own[n][key]:.3g}" for n in order))]


def folds(results):
    """The ratio of ratios that was asked for. The note has what it hides: the far bias alone."""
    if not results.folds:
        return []
    value, low, high = results.folds["decay"]
    photons, beams = far_biases(results)
    note = f"{results.folds['note']}; far alone: {photons:.3g} and {beams:.3g} of the mean, {photons / beams:.3g} times"
    return [Case("folded", value, low, high, note)]


def far_biases(results):
    """rms bias 3 to 6 pixels from a fold over the truth's mean: photon map with N = 100, beams at points."""
    of = lambda method, n: next(row["rms_bias_far"] for row in results.spreads if row["method"] == method and row["nearest"] == n)
    return of("photonmap", 100), of("beamtree", 0)


def theory(results):
    """Slopes of light tracing with random paths, from the search, which has them on all scenes; and squared errors of all trials below
    the truth's own by more than chance, which has its variance from as many pixels, at 5 % for all settings together."""
    fall = slopes(results)
    flagged = [f"{name}: light tracing's error ~ paths^{steep:.2f}" for name, steep in fall.items() if steep < STEEP]
    every = [(name, field.pixels, cell) for name, field in results.fields.items()
             for cell in (*field.cells, *results.searched.get(name, [])) if cell.label != "none"]
    flagged += [f"{name}: {cell.label}, {cell.setting.text()}: below the truth's own error"
                for name, pixels, cell in every if is_too_good(cell.squares.mean(), cell.noise, pixels, len(every))]
    if not results.fields:
        return []
    lowest = min(cell.squares.mean() / cell.noise for _, _, cell in every if cell.noise)
    note = ", ".join(f"{name} {steep:.3f}" for name, steep in fall.items())
    return counted("all scenes", len(flagged), "; ".join(flagged) or f"slopes of light tracing: {note}; "
                   f"least squared error over the truth's own: {lowest:.3g} of {len(every)} settings")


def slopes(results):
    """{scene: slope of light tracing's log error over log paths}, with random paths: strata may fall faster."""
    found = {}
    for name, cells in results.searched.items():
        paths = [(dict(cell.setting.param), cell) for cell in cells if cell.label == "lighttrace" and not cell.is_at_noise()]
        points = [(param["paths"], cell.error()) for param, cell in paths if "emission" not in param]
        if len(points) > 1:
            found[name] = slope(points)
    return found


def is_too_good(square, noise, pixels, of):
    """Whether a squared error lies below the truth's own, one-sided at 5 % over so many tries; a mean over pixels has the deviation
    noise sqrt(2 / pixels)."""
    from scipy.stats import norm

    return bool(noise > 0 and (noise - square) / (noise * math.sqrt(2 / pixels)) > norm.isf(0.05 / of))
