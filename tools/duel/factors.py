"""Factors between photon map and beam tree on the duel's scenes, as ranges over draws of seeds and as what is found of them.

A factor of times is the photon map's CPU seconds over the beam tree's at the same error, a factor of errors the photon map's
error over the beam tree's in the same CPU seconds: above 1 the beam tree wins.
"""
import math

import numpy as np

from duel.ranges import estimate
from duel.verdicts import Case

PHOTONS, BEAMS, CONES, COMPLETED = "photonmap", "beamtree", "beamtree, cones", "beamtree, completed"
SECOND = 1.0


class Results:
    """Cells of the final runs by scene, rows of counts, and spreads over seeds; a scene that was not run is not in `fields`."""

    def __init__(self, duel, fields, searched, spreads, counts, folds=None, left_out=()):
        self.duel, self.fields, self.searched, self.spreads, self.counts, self.folds = duel, fields, searched, spreads, counts, folds
        self.left_out = left_out

    def base(self):
        return [scene.name for scene in self.duel.scenes if scene.is_base() and scene.name in self.fields]

    def all_fields(self, *names):
        """The fields of these scenes; None where one was not run."""
        return [self.fields[name] for name in names] if all(name in self.fields for name in names) else None


def case(name, found, note=""):
    """No case, where nothing is found."""
    return [] if found is None else [Case.of(name, found, note)]


def errors_at(field, seconds=SECOND, top=PHOTONS, bottom=BEAMS):
    """(Range of the ratio, the truth's part of its logarithm's deviation); None where one has no picture by then."""
    a, b = field.at_time(top, seconds), field.at_time(bottom, seconds)
    if a is None or b is None or not (a.is_reached() and b.is_reached()):
        return None
    return a / b, math.hypot(field.truth_of(a.point[0]), field.truth_of(b.point[0]))


def factor_of_errors(field, seconds=SECOND, top=PHOTONS, bottom=BEAMS):
    found = errors_at(field, seconds, top, bottom)
    return found and estimate(found[0], field.seeds, found[1])


def times_at(field, error, beams=BEAMS, photons=PHOTONS, x=None):
    """(Range of the ratio of times, or of x, at an error, the truth's part); None where neither has it or one is not known."""
    a, b = (field.at_error(label, error, x) for label in (photons, beams))
    if a is None or b is None or not (a.is_reached() or b.is_reached()):
        return None
    return a / b, math.hypot(*(truth_of_time(field, label, error, x) for label in (photons, beams)))


def truth_of_time(field, label, error, x=None):
    """What one standard deviation of the truth's own error makes of the logarithm of the time to an error."""
    error = float(np.asarray(error, float).flat[0])
    more = error * (1 + field.truth_of(error))
    first, second = (field.at_error(label, each, x) for each in (error, more))
    if first is None or second is None or not (first.is_reached() and second.is_reached()):
        return 0.0
    return float(np.log(first.high[0] / second.high[0]))


def factor_of_times(field, error, beams=BEAMS, photons=PHOTONS, x=None):
    found = times_at(field, error, beams, photons, x)
    return found and estimate(found[0], field.seeds, found[1])


def least_common(field, beams=BEAMS):
    """The least error that both reach, draw by draw."""
    both = [field.least(label) for label in (PHOTONS, beams)]
    return None if any(each is None for each in both) else np.maximum(*both)


def at_least_common(field, beams=BEAMS, x=None):
    """The factor of times, or of x, at the least error that both reach, as times_at; in each draw of its own."""
    goal = least_common(field, beams)
    return None if goal is None else times_at(field, goal, beams, x=x)


def factor_at_least_common(field, beams=BEAMS, x=None):
    found = at_least_common(field, beams, x)
    return found and estimate(found[0], field.seeds, found[1])


def over(top, bottom, seeds):
    """One factor over another, each with its truth's part."""
    return None if top is None or bottom is None else estimate(top[0] / bottom[0], seeds, math.hypot(top[1], bottom[1]))
