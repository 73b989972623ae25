"""The duel's tables of errors and times: who wins at equal time and at equal error, where curves cross, light found, memory."""
import math

import numpy as np

from duel import factors
from duel.curves import SLACK
from duel.factors import BEAMS, COMPLETED, CONES, PHOTONS
from papers.part import Table

TIMES = (0.1, 0.3, 1, 3)  # CPU seconds
ERRORS = (0.2, 0.05, 0.01, 0.001)
METHODS = (PHOTONS, BEAMS, CONES, COMPLETED, "causticpolygons", "illuminationmap", "lighttrace")
CARRIED, HIDDEN = "†", "hidden by the truth's own error"
MARKS = ("<: a bound, the truth's own error hides what is less. ≤: of the last setting that is done; none between it and the next was tried. "
         "†: the slowest setting was done before, so its error is carried on; more work was not tried. A factor is of measured settings; its "
         "interval spans what may lie between them. A tie: the interval holds 1; open: nothing is decided.")


def percent(error):
    return f"{100 * error:.3g} %"


def seconds(value):
    return f"{value:.2g} s" if value < 1 else f"{value:.3g} s"


def factor(found):
    """A factor with its interval: a tie is called one, and so is what nothing decides."""
    if found is None:
        return "–"
    low, high = found.ends()
    if not found.is_tie():
        return found.text() + (f", {HIDDEN}" if found.is_hidden() else "")
    return found.text() + (", a tie" if found.low == found.high and 0.5 < low and high < 2 else "" if (low, high) == (0, math.inf) else ", open")


def shown(results):
    return [(scene, results.fields[scene.name]) for scene in results.duel.scenes if scene.name in results.fields]


def error_words(field, label, time):
    """A method's error by then; None where it has no picture."""
    error = field.at_time(label, time)
    if error is None or not error.is_reached():
        return None
    bound = "< " if error.low[0] == 0 else "≤ " if error.low[0] < error.high[0] else ""
    return bound + percent(error.point[0]) + (f" {CARRIED}" if time > field.last(label) * SLACK else "")


def best(field, time):
    """The methods that are best at a time: the least error, and all that seeds, truth and settings do not separate from it."""
    errors = {label: field.at_time(label, time) for label in field.labels if label != "none"}
    errors = {label: float(error.point[0]) for label, error in errors.items() if error.is_reached()}
    if not errors:
        return []
    first = min(errors, key=errors.get)
    worse = lambda found: found.ends()[0] > 1 and not found.is_hidden()
    return sorted((label for label in errors if label == first or not worse(factors.factor_of_errors(field, time, label, first))), key=errors.get)


def light_words(field, label, time):
    """The light of the picture over the truth's, of the setting that is best by then: median over the seeds, and range."""
    done = field.done(label, time)
    if not done:
        return None
    ratios = [row["mean_ratio"] for row in min(done, key=lambda cell: (cell.error(), cell.raw())).rows]
    low, middle, high = (f"{value:.2f}" for value in (min(ratios), float(np.median(ratios)), max(ratios)))
    return middle if low == high else f"{middle} ({low} to {high})"


def winners(results, time, plain=False):
    """One row a scene: each method's error after so many CPU seconds, the best in bold; `plain` by rmse."""
    rows = []
    for scene, field in shown(results):
        field = results.plain[scene.name] if plain else field
        first = best(field, time)
        words = [error_words(field, label, time) for label in METHODS]
        cells = [f"**{word}**" if word and label in first else word or "–" for label, word in zip(METHODS, words)]
        found = "; ".join(light_words(field, label, time) or "–" for label in (PHOTONS, BEAMS))
        rows.append([scene.title, *cells, factor(factors.factor_of_errors(field, time)), found])
    heading = ["scene", *METHODS, "photon map's error over the beam tree's", "light found by photon map; beam tree"]
    name = f"equal_time_{time:g}{'_rmse' if plain else ''}".replace(".", "_")
    note = ("Bold: the least, and all that is not separated from it. –: no setting is done by then, or the method does not serve the scene. " +
            MARKS +
            " Light found is that of the setting which is best by then, over the truth's (range over the seeds): 1 is all of it.")
    return Table(name, f"{'rmse over the mean' if plain else 'Error'} after {time:g} CPU second{'s' * (time != 1)}", heading, rows, note)


def light(results):
    """Light found by every method after a second."""
    rows = [[scene.title, *(light_words(field, label, 1) or "–" for label in METHODS)] for scene, field in shown(results)]
    return Table("light", "Light found after 1 CPU second", ["scene", *METHODS], rows,
                 "The mean of the picture over the truth's, of the setting that is best in error by then: median and range over the seeds. "
                 "1 is all of the light.")


def time_words(field, label, error):
    """CPU seconds of the first setting that has the error."""
    if label not in field.own:
        return None
    time = field.at_error(label, error)
    if time is None:
        return "?"
    if not time.is_reached():
        return None
    return ("≤ " if time.low[0] < time.high[0] else "") + seconds(time.high[0])


def wanted(results):
    """CPU seconds to each wanted error."""
    rows = []
    for scene, field in shown(results):
        for error in ERRORS:
            times = [time_words(field, label, error) for label in METHODS]
            if any(time not in (None, "?") for time in times):
                rows.append([scene.title, percent(error), *(time or "–" for time in times), factor(factors.factor_of_times(field, error))])
    return Table("equal_error", "CPU seconds to a wanted error", ["scene", "error", *METHODS, "photon map's time over the beam tree's"], rows,
                 "≤: of the first setting that has the error; none between it and the one before was tried. Without ≤: two settings that differ "
                 "in nothing but one parameter of work have it between them. –: not reached by what was measured. ?: below what the truth can "
                 "show. A factor with < or > is a bound; its interval spans what may lie between settings.")


def crossings(results):
    """Where photon map and beam tree change places along their curves."""
    rows = [[scene.title, scene.decides, "; ".join(changes(field)) or "–"] for scene, field in shown(results)]
    heading = ["scene", "what decides", "the better of the two, by CPU seconds"]
    return Table("crossings", "Where the curves of photon map and beam tree cross", heading, rows,
                 "A method is called the better one from where the 95 % interval of the factor leaves out 1 and the truth's own error does not "
                 "hide it; elsewhere it is open.")


def changes(field):
    """Who is better from when on, where that is decided."""
    if PHOTONS not in field.own or BEAMS not in field.own:
        return []
    start = max(min(cell.seconds() for cell in field.own[label]) for label in (PHOTONS, BEAMS))
    end = max(field.last(label) for label in (PHOTONS, BEAMS))
    steps = [start * (end / start) ** (i / 60) for i in range(61)] if end > start else [start]
    found, name = [], None
    for time in steps:
        better = better_of(factors.factor_of_errors(field, time))
        if better != name:
            found.append((better, time))
            name = better
    return [f"{name} from {seconds(time)}" for name, time in lasting(found)]


def lasting(found):
    """Without what lasts no longer than times scatter, and without repeats."""
    kept = []
    for (name, time), following in zip(found, [time for _, time in found[1:]] + [math.inf]):
        if following > time * SLACK and not (kept and kept[-1][0] == name):
            kept.append((name, time))
    return kept


def better_of(found):
    if found is None or found.is_tie() or found.is_hidden():
        return "open"
    return "beam tree" if found.low > 1 else "photon map"


def memory(results):
    """MB of what each built, at the least error that photon map and beam tree both reach."""
    rows = []
    built = lambda cell: cell.median("map_bytes")
    for scene, field in shown(results):
        goal = factors.least_common(field)
        if goal is None:
            continue
        megabytes = [f"{field.at_error(label, goal, built).high[0] / 1e6:.3g}" for label in (PHOTONS, BEAMS)]
        rows.append([scene.title, percent(goal[0]), *megabytes, factor(factors.factor_at_least_common(field, x=built))])
    return Table("memory", "Memory at the least error that both reach", ["scene", "error", "photon map, MB", "beam tree, MB", "ratio"], rows,
                 "Of the first measured setting that has the error; the ratio's interval spans what may lie between settings.")
