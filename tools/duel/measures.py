"""What each raced hypothesis of experiments/duel/hypotheses.json compares: one function a hypothesis, which returns its cases."""
import math

import numpy as np

from duel import counted, factors
from duel.factors import BEAMS, COMPLETED, CONES, PHOTONS, SECOND, case
from duel.ranges import Range, estimate, least, middle
from duel.verdicts import Case
from papers.words import short


def each_at_a_second(results, *names):
    return [each for name in names if name in results.fields for each in case(name, factors.factor_of_errors(results.fields[name]))]


def pools(results):
    return each_at_a_second(results, "calm", "folded")


def cusps(results):
    return each_at_a_second(results, "ring", "ball")


def rivals(results):
    return [each for name in results.base() for each in case(name, rivalry(results.fields[name]))]


def rivalry(field):
    """The lesser error of photon map and beam tree over the least of all others, after SECOND."""
    errors = {label: field.at_time(label, SECOND) for label in field.labels if label not in ("none", CONES, COMPLETED)}
    errors = {label: error for label, error in errors.items() if error.is_reached()}
    own, others = ([error for label, error in errors.items() if (label in (PHOTONS, BEAMS)) == ours] for ours in (True, False))
    if not own or not others:
        return None
    a, b = least(own), least(others)
    return estimate(a / b, field.seeds, math.hypot(field.truth_of(a.point[0]), field.truth_of(b.point[0])))


def polyhedral(results):
    """The beam tree's least error: does the photon map get there?"""
    field = results.fields.get("crystal")
    goal = field.least(BEAMS) if field else None
    return [] if goal is None else case("crystal", factors.factor_of_times(field, goal))


def each_at_least_common(results, names, beams=BEAMS):
    return [each for name in names if name in results.fields for each in case(name, factors.factor_at_least_common(results.fields[name], beams))]


def shells(results):
    return each_at_least_common(results, ("bowl2", "bowl4", "bowl8"))


def completed(results):
    return each_at_least_common(results, ("ball", "crystal", "bowl2", "bowl4", "bowl8", "casters"), COMPLETED)


def at_a_second_over(results, name, *scenes):
    """The factor of errors of the first scene over that of the second."""
    fields = results.all_fields(*scenes)
    return case(name, factors.over(*map(factors.errors_at, fields), fields[0].seeds)) if fields else []


def events(results):
    return at_a_second_over(results, "8 over 2 events", "bowl8", "bowl2")


def light_size(results):
    return each_at_a_second(results, "lamp1", "lamp30")


def alpha_photons(results):
    fields = results.all_fields("glossy1", "glossy100")
    if not fields:
        return []
    goal = np.maximum(*(field.least(PHOTONS) for field in fields))
    stored = lambda cell: cell.median("photons_stored")
    ends = [(field.at_error(PHOTONS, goal, stored), factors.truth_of_time(field, PHOTONS, goal, stored)) for field in fields]
    return case("alpha 0.01 over 1", factors.over(*ends, fields[0].seeds), f"at {100 * goal[0]:.2g} % error")


def alpha_winner(results):
    return at_a_second_over(results, "alpha 0.01 over 1", "glossy1", "glossy100")


def resolution(results):
    """At 5 %, as was asked; and, to look at, at the least error that all reach."""
    fields = results.all_fields("folded160", "folded")
    if not fields:
        return []
    asked = factors.over(*(factors.times_at(field, 0.05) for field in fields), fields[0].seeds)
    goal = np.maximum(*map(factors.least_common, fields))
    seen = factors.over(*(factors.times_at(field, goal) for field in fields), fields[0].seeds)
    note = f"; to look at: {seen.text()} at {100 * goal[0]:.2g} %, the least that all reach" if seen else ""
    return case("160 over 64 pixels a side", asked, "the photon map never has 5 %" + note)


def lit_share(results):
    return at_a_second_over(results, "field of view 14 over 80 degrees", "ball_near", "ball_far")


def mesh_order(results):
    """From the search: squares of a pixel, one sample, on the pilot's or the search's seeds."""
    found = []
    for intensity in ("area", "refined"):
        points = mesh_errors(results, "calm", intensity)
        if len(points) > 2:
            slope = -counted.slope(sorted(points.items()))
            found.append(Case(intensity, slope, slope, slope, "errors " + ", ".join(f"{n}: {100 * e:.3g} %" for n, e in sorted(points.items()))))
    return found


def mesh_errors(results, scene, intensity):
    """{mesh: error} of beams that are asked for the squares of pixels, in the search."""
    points = {}
    for cell in results.searched.get(scene, []):
        param = dict(cell.setting.param)
        if cell.label == BEAMS and param.get("intensity") == intensity and "footprint" in param and 32 <= (cell.setting.mesh or 0) <= 256:
            points[cell.setting.mesh] = cell.error()
    return points


def mesh_million(results):
    field = results.fields.get("million")
    return case("million", factors.factor_of_times(field, 0.2)) if field else []


def wanted_error(results):
    found = []
    for name in ("calm", "folded"):
        field = results.fields.get(name)
        if field:
            ends = [factors.times_at(field, error) for error in (0.05, 0.2)]
            found += case(name, factors.over(*ends, field.seeds), "" if np.isfinite(ends[0][0].high[0]) else "the photon map never has 5 %")
    return found


def memory(results):
    found = []
    for name in ("calm", "folded"):
        field = results.fields.get(name)
        if field:
            factor = factors.factor_at_least_common(field, x=lambda cell: cell.median("map_bytes"))
            found += case(name, factor, f"at {100 * factors.least_common(field)[0]:.2g} % error")
    return found


def duvenhage(results):
    """The median over the scenes, our bound and the paper's cones apart. Where beams were tried and none was done in time, the factor
    is below 1: the photon map took seconds."""
    found = []
    for name, beams in (("two_slice", BEAMS), ("the paper's cones", CONES)):
        own, notes = [], []
        for scene in results.base():
            factor = factors.at_least_common(results.fields[scene], beams)
            late = any(row["status"] == "timeout" and (row["scene"], row["label"]) == (scene, beams) for row in results.left_out)
            if factor or late:
                own.append(factor[0] if factor else Range(0.0, 1.0))
                notes.append(f"{scene} {short(float(own[-1].point[0])) if factor else '< 1'}")
        if own:
            found += case(name, estimate(middle(own), results.fields[results.base()[0]].seeds), f"{len(own)} scenes: " + ", ".join(notes))
    return found


def cases_of(hypothesis, results):
    return function_of(hypothesis["id"])(results)


def function_of(name):
    return globals().get(name) or getattr(counted, name)
