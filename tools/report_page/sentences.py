"""The sentences under README's table of the methods: who is nearest to the reference within the time, by what factor, and
when the photon map or the beam tree reaches the same error. Every number in them comes from the records.
"""
from report_page import scenes


def picks_within(scene, allowed):
    """{method: its cell of least error among those that take at most so many CPU seconds}."""
    picks = {}
    for cell in scene.scored():
        if cell.method != "none" and cell.cost("work_s") <= allowed:
            picks[cell.method] = min(picks.get(cell.method, cell), cell, key=error)
    return picks


def error(cell):
    return cell.error("rmse")[0]


def number(value):
    return f"{value:.3g}"


def factor(ratio):
    """Two digits: 1.4, 12, 140."""
    return f"{ratio:.2g}" if ratio < 9.95 else f"{float(f'{ratio:.2g}'):.0f}"


def names(methods):
    *first, last = [f"`{method}`" for method in methods]
    return f"{', '.join(first)} and {last}" if first else last


def sentences(scene, title, allowed, compared):
    """The paragraph of one scene; `compared` are the methods that are told of even where they are not the best."""
    picks = picks_within(scene, allowed)
    if not picks:
        return f"**{title}**: no method has a picture within {number(allowed)} s."
    ranked = sorted(picks.values(), key=error)
    best = [cell for cell in ranked if cell in scenes.best_of(picks.values())] or ranked[:1]
    told = [f"**{title}**, {number(allowed)} s: {who_is_best(best, ranked)}"]
    told += [later(scene, method, best[0], allowed) for method in compared if method not in {cell.method for cell in best}]
    return " ".join(told)


def who_is_best(best, ranked):
    rest = [cell for cell in ranked if cell not in best]
    one = len(best) == 1
    start = (f"{names(cell.method for cell in best)} {'has' if one else 'have'} the least error"
             + ("" if one else ", and the seeds do not separate them"))
    if not rest:
        return start + "."
    return f"{start}; that of {names([rest[0].method])}, the next, is {factor(error(rest[0]) / error(best[0]))} times as large."


def later(scene, method, best, allowed):
    """When a method that is not the best within the time reaches the error of the best, or how near it comes."""
    own = sorted((cell for cell in scene.scored() if cell.method == method), key=lambda cell: cell.cost("work_s"))
    if not own:
        return f"`{method}` does not serve this scene."
    reached = next((cell for cell in own if error(cell) <= error(best)), None)
    if reached:
        return f"`{method}` reaches that error with a setting that takes {number(reached.cost('work_s'))} s."
    nearest = min(own, key=error)
    return (f"No measured setting of `{method}` reaches it: its least error, {number(error(nearest))} after "
            f"{number(nearest.cost('work_s'))} s, is {factor(error(nearest) / error(best))} times as large.")
