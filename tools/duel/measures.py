"""What each hypothesis of experiments/duel/hypotheses.json compares: one function a hypothesis, which returns its cases.

A factor of times is the photon map's CPU seconds over the beam tree's at the same error, a factor of errors the photon map's
error over the beam tree's in the same CPU seconds: above 1 the beam tree wins.
"""
import math
import statistics

import numpy as np

from duel import curves
from duel.verdicts import Case
from report.curves import along

PHOTONS, BEAMS, CONES = "photonmap", "beamtree", "beamtree, cones"
SECOND = 1.0


class Results:
    """Cells of the final runs by scene, rows of counts, and spreads over seeds; a scene that was not run is not in `fields`."""

    def __init__(self, duel, fields, searched, spreads, counts, folds=None):
        self.duel, self.fields, self.searched, self.spreads, self.counts, self.folds = duel, fields, searched, spreads, counts, folds

    def base(self):
        return [scene.name for scene in self.duel.scenes if scene.is_base() and scene.name in self.fields]


def case(name, found, note=""):
    return [] if found is None else [Case(name, *found, note)]


def errors_at(field, draw, seconds=SECOND, top=PHOTONS, bottom=BEAMS):
    a, b = (curves.at_time(field.curve(label, draw), seconds) for label in (top, bottom))
    return a / b if a and b else None


def times_at(field, draw, error, x=None):
    a, b = (curves.at_error(field.curve(label, draw, x), error) for label in (PHOTONS, BEAMS))
    return a / b if a and b else None


def least_common(field, bottom=BEAMS):
    """The least error that both reach."""
    both = [field.curve(label) for label in (PHOTONS, bottom)]
    return max(curve[-1][1] for curve in both) if all(both) else None


def factor_of_errors(results, name, seconds=SECOND):
    if name not in results.fields:
        return []
    field = results.fields[name]
    return case(name, curves.quantity(field.seeds, lambda draw: errors_at(field, draw, seconds)))


def times_with_bound(field, error, beams=BEAMS, photons=PHOTONS):
    """The factor of times at an error as a Case's numbers; a bound where one of the two never reaches it, None where neither does."""
    ends = [field.curve(label) for label in (photons, beams)]
    if not all(ends):
        return None
    a, b = (curves.at_error(curve, error) for curve in ends)
    if a is None and b is None:
        return None
    if a is None:
        bound = ends[0][-1][0] / b
        return (bound, bound, math.inf)
    if b is None:
        bound = a / ends[1][-1][0]
        return (bound, 0.0, bound)

    def ratio(draw):
        top, bottom = (curves.at_error(field.curve(label, draw), error * (1 + 1e-9)) for label in (photons, beams))
        return top / bottom if top and bottom else None
    return curves.quantity(field.seeds, ratio)


def factor_at_least_common(field, beams=BEAMS):
    """The factor of times at the least error that both reach, in each draw of its own."""
    def ratio(draw):
        photons, other = (field.curve(label, draw) for label in (PHOTONS, beams))
        if not photons or not other:
            return None
        error = max(photons[-1][1], other[-1][1]) * (1 + 1e-9)
        return curves.at_error(photons, error) / curves.at_error(other, error)
    return curves.quantity(field.seeds, ratio)


def over(results, names, seconds=SECOND):
    """The factor of errors of the first scene over that of the second."""
    if any(name not in results.fields for name in names):
        return None
    fields = [results.fields[name] for name in names]

    def ratio(draw):
        a, b = (errors_at(field, draw, seconds) for field in fields)
        return a / b if a and b else None
    return curves.quantity(fields[0].seeds, ratio)


def pools(results):
    return [each for name in ("calm", "folded") for each in factor_of_errors(results, name)]


def cusps(results):
    return [each for name in ("ring", "ball") for each in factor_of_errors(results, name)]


def rivals(results):
    found = []
    for name in results.base():
        field = results.fields[name]

        def ratio(draw):
            errors = {label: curves.at_time(field.curve(label, draw), SECOND) for label in field.labels if label not in ("none", CONES)}
            own = [errors[label] for label in (PHOTONS, BEAMS) if errors.get(label)]
            others = [error for label, error in errors.items() if error and label not in (PHOTONS, BEAMS)]
            return min(own) / min(others) if own and others else None
        found += case(name, curves.quantity(field.seeds, ratio))
    return found


def polyhedral(results):
    """The beam tree's least error: does the photon map get there?"""
    field = results.fields.get("crystal")
    curve = field.curve(BEAMS) if field else []
    return case("crystal", times_with_bound(field, curve[-1][1] * (1 + 1e-9))) if curve else []


def shells(results):
    return [each for name in ("bowl2", "bowl4", "bowl8") if name in results.fields
            for each in case(name, factor_at_least_common(results.fields[name]))]


def events(results):
    return case("8 over 2 events", over(results, ("bowl8", "bowl2")))


def light_size(results):
    return [each for name in ("lamp1", "lamp30") for each in factor_of_errors(results, name)]


def alpha_photons(results):
    names = ("glossy1", "glossy100")
    if any(name not in results.fields for name in names):
        return []
    fields = [results.fields[name] for name in names]
    stored = lambda cell: cell.median("photons_stored")
    goal = max(field.curve(PHOTONS, x=stored)[-1][1] for field in fields) * (1 + 1e-9)

    def ratio(draw):
        a, b = (curves.at_error(field.curve(PHOTONS, draw, stored), goal) for field in fields)
        return a / b if a and b else None
    return case(f"alpha 0.01 over 1 at {100 * goal:.2g} % error", curves.quantity(fields[0].seeds, ratio))


def alpha_winner(results):
    return case("alpha 0.01 over 1", over(results, ("glossy1", "glossy100")))


def resolution(results):
    names = ("folded160", "folded")
    if any(name not in results.fields for name in names):
        return []
    fields = [results.fields[name] for name in names]
    goal = max(0.05, *(least_common(field) or 0.05 for field in fields)) * (1 + 1e-9)

    def ratio(draw):
        a, b = (times_at(field, draw, goal) for field in fields)
        return a / b if a and b else None
    return case(f"160 over 64 pixels a side at {100 * goal:.2g} % error", curves.quantity(fields[0].seeds, ratio))


def lit_share(results):
    return case("field of view 14 over 80 degrees", over(results, ("ball_near", "ball_far")))


def mesh_order(results):
    """From the search: squares of a pixel, one sample, on the pilot's or the search's seeds."""
    found = []
    for intensity in ("area", "refined"):
        points = {}
        for cell in results.searched.get("calm", []):
            param = dict(cell.setting.param)
            if cell.label == BEAMS and param.get("intensity") == intensity and "footprint" in param and 32 <= cell.setting.mesh <= 256:
                points[cell.setting.mesh] = cell.error()
        if len(points) > 2:
            slope = -float(np.polyfit(np.log(list(points)), np.log(list(points.values())), 1)[0])
            found.append(Case(intensity, slope, slope, slope, "errors " + ", ".join(f"{n}: {100 * e:.3g} %" for n, e in sorted(points.items()))))
    return found


def mesh_million(results):
    field = results.fields.get("million")
    return case("million", times_with_bound(field, 0.2)) if field else []


def wanted_error(results):
    found = []
    for name in ("calm", "folded"):
        field = results.fields.get(name)
        if not field or least_common(field) > 0.05:
            curve = field.curve(PHOTONS) if field else []
            if curve and curve[-1][1] < 0.2 and field.curve(BEAMS)[-1][1] < 0.05:  # never at 5 %: a bound over the factor at 20 %
                bound = times_with_bound(field, 0.05)[0] / times_with_bound(field, 0.2)[0]
                found.append(Case(name, bound, bound, math.inf, "the photon map never reaches 5 %"))
            continue

        def ratio(draw):
            a, b = (times_at(field, draw, error) for error in (0.05, 0.2))
            return a / b if a and b else None
        found += case(name, curves.quantity(field.seeds, ratio))
    return found


def memory(results):
    found = []
    for name in ("calm", "folded"):
        field = results.fields.get(name)
        if field and least_common(field):
            goal = least_common(field) * (1 + 1e-9)
            found += case(name, curves.quantity(field.seeds, lambda draw: times_at(field, draw, goal, lambda cell: cell.median("map_bytes"))), f"at {100 * goal:.2g} % error")
    return found


def duvenhage(results):
    """The median over the scenes, our bound and the paper's cones apart; its ends are the medians of the scenes' ends."""
    found = []
    for name, beams in (("two_slice", BEAMS), ("the paper's cones", CONES)):
        own = [factor for factor in (factor_at_least_common(results.fields[scene], beams) for scene in results.base()) if factor]
        if own:
            middle = lambda i: float(statistics.median(factor[i] for factor in own))
            found.append(Case(name, middle(0), middle(1), middle(2), "scenes " + ", ".join(f"{factor[0]:.2g}" for factor in sorted(own))))
    return found


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
            reach = curves.student(len(logs) - 1) * logs.std(ddof=1) / math.sqrt(len(logs))
            found.append(Case(tree, *(math.exp(logs.mean() + step) for step in (0, -reach, reach))))
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
    return [] if not results.folds else case("folded", results.folds["decay"], results.folds["note"])


def theory(results):
    flagged, note = [], []
    for name, field in results.fields.items():
        paths = [(dict(cell.setting.param), cell) for cell in field.cells if cell.label == "lighttrace" and not cell.is_at_noise()]
        points = [(param["paths"], cell.error()) for param, cell in paths if "emission" not in param]  # strata may fall faster
        if len(points) > 1:
            steep = slope(points)
            note.append(f"{name} {steep:.3f}")
            if steep < -0.55:
                flagged.append(f"{name}: light tracing's error ~ paths^{steep:.2f}")
        for cell in field.cells:
            if cell.label != "none" and cell.squares.mean() < 0.8 * cell.noise:
                flagged.append(f"{name}: {cell.label}, {cell.setting.text()}: below the truth's own error")
    if not results.fields:
        return []
    return counted("all scenes", len(flagged), "; ".join(flagged) or "slopes of light tracing: " + ", ".join(note))


def cases_of(hypothesis, results):
    return globals()[hypothesis["id"]](results)
