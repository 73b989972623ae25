"""The duel's tables: who wins at equal time and at equal error, where curves cross, bias and variance, settings, what was left out."""
from duel import curves, measures
from duel.measures import BEAMS, CONES, PHOTONS
from papers.part import Table
from papers.words import short

TIMES = (0.1, 0.3, 1, 3)  # CPU seconds
ERRORS = (0.2, 0.05, 0.01, 0.001)
TRUTHS = 10  # a difference has to be so many times what the truth's own error makes of it
METHODS = (PHOTONS, BEAMS, CONES, "causticpolygons", "illuminationmap", "lighttrace")


def percent(error):
    return f"{100 * error:.3g} %"


def seconds(value):
    return f"{value:.2g} s" if value < 1 else f"{value:.3g} s"


def factor(found):
    """A factor with its interval; a tie is called one."""
    if found is None:
        return "–"
    value, low, high = found
    if high == float("inf") and low == value:
        return f"> {short(value)}"
    if low == 0 and high == value:
        return f"< {short(value)}"
    return f"{short(value)} ({short(low)} to {short(high)})" + (", a tie" if low <= 1 <= high else "")


def shown(results):
    return [(scene, results.fields[scene.name]) for scene in results.duel.scenes if scene.name in results.fields]


def best(field, time, pixels):
    """({method: error}, the methods that are best, ties included) at a time."""
    errors = {label: curves.at_time(field.curve(label), time) for label in field.labels if label != "none"}
    errors = {label: error for label, error in errors.items() if error}
    if not errors:
        return errors, []
    first = min(errors, key=errors.get)
    tied = [label for label in errors if label == first or is_tie(field, label, first, time)
            or errors[label] - errors[first] < TRUTHS * curves.error_by_truth(errors[first], field.cells[0].noise, pixels)]
    return errors, sorted(tied, key=errors.get)


def is_tie(field, label, first, time):
    found = curves.quantity(field.seeds, lambda draw: measures.errors_at(field, draw, time, label, first))
    return found is not None and found[1] <= 1


def winners(results, time, plain=False):
    """One row a scene: each method's error after so many CPU seconds, the best in bold; `plain` by rmse."""
    rows = []
    for scene, field in shown(results):
        field = results.plain[scene.name] if plain else field
        errors, first = best(field, time, scene.size[0] * scene.size[1])
        cells = [(f"**{percent(errors[label])}**" if label in first else percent(errors[label])) if label in errors else "–" for label in METHODS]
        found = curves.quantity(field.seeds, lambda draw: measures.errors_at(field, draw, time))
        rows.append([scene.title, *cells, factor(found)])
    heading = ["scene", *METHODS, "photon map's error over the beam tree's"]
    name = f"equal_time_{time:g}{'_rmse' if plain else ''}".replace(".", "_")
    return Table(name, f"{'rmse over the mean' if plain else 'Error'} after {time:g} CPU second{'s' * (time != 1)}", heading, rows,
                 "Bold: the least, and all that the seeds or the truth do not tell from it. –: no setting is done by then, or the method does not serve the scene.")


def wanted(results):
    """CPU seconds to each wanted error."""
    rows = []
    for scene, field in shown(results):
        for error in ERRORS:
            times = [curves.at_error(field.curve(label), error) for label in METHODS]
            if any(times):
                rows.append([scene.title, percent(error), *(seconds(time) if time else "–" for time in times), factor(measures.times_with_bound(field, error))])
    return Table("equal_error", "CPU seconds to a wanted error", ["scene", "error", *METHODS, "photon map's time over the beam tree's"], rows,
                 "–: not reached by what was measured. A factor with < or > is a bound: one of the two never got there.")


def crossings(results):
    """Where photon map and beam tree change places along their curves."""
    rows = [[scene.title, scene.decides, "; ".join(changes(field)) or "–"] for scene, field in shown(results)]
    return Table("crossings", "Where the curves of photon map and beam tree cross", ["scene", "what decides", "the better of the two, by CPU seconds"], rows,
                 "Along the fronts, a power law between settings; without intervals.")


def changes(field):
    a, b = field.curve(PHOTONS), field.curve(BEAMS)
    if not a or not b:
        return []
    start, end = max(a[0][0], b[0][0]), max(a[-1][0], b[-1][0])
    steps = [start * (end / start) ** (i / 200) for i in range(201)] if end > start else [start]
    found, name = [], None
    for time in steps:
        photons, beams = curves.at_time(a, time), curves.at_time(b, time)
        better = "photon map" if photons < beams else "beam tree"
        if better != name:
            found.append(f"{better} from {seconds(time)}")
            name = better
    return found


def memory(results):
    """MB of what each built, at the least error that photon map and beam tree both reach."""
    rows = []
    for scene, field in shown(results):
        goal = measures.least_common(field)
        if goal is None:
            continue
        goal *= 1 + 1e-9
        of = lambda label: curves.at_error(field.curve(label, 0, lambda cell: cell.median("map_bytes")), goal)
        photons, beams = of(PHOTONS), of(BEAMS)
        rows.append([scene.title, percent(goal), *(f"{value / 1e6:.3g}" for value in (photons, beams)), short(photons / beams)])
    return Table("memory", "Memory at the least error that both reach", ["scene", "error", "photon map, MB", "beam tree, MB", "ratio"], rows)


def parts(results):
    """bias^2 and variance of each method's most accurate setting."""
    rows = []
    for scene, field in shown(results):
        for label in METHODS:
            own = [cell for cell in field.cells if cell.label == label]
            if not own:
                continue
            cell = min(own, key=lambda cell: cell.error())
            spread = results.spread_of(scene.name, label, cell.setting.text())
            if spread:
                rows.append([scene.title, label, cell.setting.text(), percent(cell.error()) + (" *" if cell.is_at_noise() else ""),
                             f"{spread['bias_square']:.2g}", f"{spread['variance']:.2g}", f"{spread['noise']:.1g}",
                             f"{cell.median('build_s'):.2g} + {cell.median('query_s'):.2g}"])
    return Table("parts", "Bias² and variance of each method's most accurate setting",
                 ["scene", "method", "setting", "error", "bias²", "variance", "truth's own error²", "CPU s, build + query"], rows,
                 "In the measure of relmse: error² = bias² + variance. bias² is unbiased, so it may come out below 0. * the truth's own error is most of what was measured.")


def settings(results):
    """What the search tried, and what it chose."""
    rows = []
    for scene, field in shown(results):
        tried = results.searched.get(scene.name, [])
        for label in METHODS:
            own = sorted((cell for cell in field.cells if cell.label == label), key=lambda cell: cell.seconds())
            if own:
                count = sum(cell.label == label for cell in tried)
                rows.append([scene.title, label, own[0].setting.asks, f"{len(own)} of {count}", "; ".join(cell.setting.text() for cell in own)])
    return Table("settings", "Settings that the search chose", ["scene", "method", "asked", "chosen", "settings, fastest first"], rows)


def left_out(results):
    """Settings that gave no picture, with the reason."""
    groups = {}
    for row in results.left_out:
        groups.setdefault((row["scene"], row["label"], row["status"], row["message"]), set()).add(row["settings"])
    title = {scene.name: scene.title for scene in results.duel.scenes}
    rows = [[title[scene], label, str(len(own)), status, message] for (scene, label, status, message), own in sorted(groups.items())]
    return Table("left_out", "What gave no picture", ["scene", "method", "settings", "status", "why"], rows)


def everything(results):
    return [*(winners(results, time) for time in TIMES), winners(results, 1, True), wanted(results), crossings(results), memory(results), parts(results), settings(results), left_out(results)]
