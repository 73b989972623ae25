"""The numbers of the page's prose: what experiments/duel/page.md has in braces, from the records.

{error SCENE METHOD SECONDS}, {factor SCENE SECONDS}, {light SCENE METHOD SECONDS}, {case HYPOTHESIS CASE}, {verdict HYPOTHESIS},
{before HYPOTHESIS}, {last SCENE METHOD} (seconds of the slowest setting), {search SCENE METHOD: SETTING}, {fold METHOD N COLUMN},
{time SCENE METHOD PERCENT}, {common SCENE} (the factor of times at the least error that both reach), and the facts below by their names.
"""
import re
import statistics

from duel import counted, factors, lists, race, tables
from duel.curves import SLACK
from duel.ranges import RESAMPLES, TRUTHS
from papers.words import short

KINDS = ("error", "rmse", "factor", "light", "case", "verdict", "before", "last", "search", "fold", "time", "common")
ABSENT = "not measured"


def filled(words, results, found, facts):
    for name, text in facts.items():
        words = words.replace("{" + name + "}", text)
    return re.sub(rf"\{{({'|'.join(KINDS)}) ([^}}]+)\}}", lambda place: number(results, found, *place.groups()), words)


def number(results, found, kind, words):
    if kind in ("case", "verdict", "before"):
        name, _, case = words.partition(" ")
        if kind != "case":
            return found[name]["verdict"] if kind == "verdict" or "before" not in found[name] else found[name]["before"]["verdict"]
        return next((each["measured"] for each in found[name]["cases"] if each["case"] == case), ABSENT)
    if kind == "fold":
        method, nearest, column = words.rsplit(" ", 2)
        row = next((row for row in results.spreads if row["method"] == method and row["nearest"] == int(nearest)), None)
        return short(row[column]) if row else ABSENT
    scene, _, rest = words.partition(" ")
    field = (results.plain if kind == "rmse" else results.fields).get(scene)
    return of_field(results, field, kind, scene, rest) if field else ABSENT


def of_field(results, field, kind, scene, rest):
    if kind == "common":
        return tables.factor(factors.factor_at_least_common(field))
    if kind == "last":
        return tables.seconds(field.last(rest)) if rest in field.own else ABSENT
    if kind == "search":
        method, _, setting = rest.partition(": ")
        cell = next((cell for cell in results.searched[scene] if (cell.label, cell.setting.text()) == (method, setting)), None)
        return tables.percent(cell.error()) if cell else ABSENT
    method, _, last = rest.rpartition(" ")
    value = float(last)
    if kind == "factor":
        return tables.factor(factors.factor_of_errors(field, value))
    if kind == "time":
        return tables.time_words(field, method, value / 100) or "no time"
    words = tables.light_words(field, method, value) if kind == "light" else tables.error_words(field, method, value)
    return (words or "no picture yet").removesuffix(f" {tables.CARRIED}")


def facts(results):
    """{name: text} of what is no table."""
    search = {name: len(cells[0].rows) for name, cells in results.searched.items() if cells}
    tried = [count for cells in results.searched.values() for label in tables.METHODS[:2] if (count := sum(cell.label == label for cell in cells))]
    title = {scene.name: scene.title for scene in results.duel.scenes}
    more = ", ".join(title[name] for name, seeds in search.items() if seeds > 1)
    far = far_words(*counted.far_biases(results)) if results.spreads else [ABSENT] * 3
    noisy = lists.too_noisy(results)
    scatter = [cell.work.std(ddof=1) / cell.work.mean() for field in results.fields.values() for cell in field.cells if field.seeds > 1]
    return {"machine": results.machine(), "seeds": str(max(field.seeds for field in results.fields.values())), "scenes": str(len(results.fields)),
            "search_more": f"{max(search.values())} on {more}" if more else "no more anywhere",
            "most_tried": str(max(tried)), "least_tried": str(min(tried)),
            "noisy": "; ".join(noisy) or "none", **dict(zip(("far_over", "far_photons", "far_beams"), far)),
            "scatter": f"{100 * statistics.quantiles(scatter, n=10)[-1]:.2g} %" if len(scatter) > 1 else "not known", "limit": limit(results),
            "quartile_seeds": quartile_seeds(results),
            "resamples": f"{RESAMPLES:,}", "truth_times": str(TRUTHS), "slack": f"{100 * (SLACK - 1):.0f} %",
            "slopes": slopes(results), "bright": bright(results)}


def far_words(photons, beams):
    return [short(photons / beams), short(photons), short(beams)]


def slopes(results):
    fall = counted.slopes(results).values()
    return f"{min(fall):.3f} to {max(fall):.3f} on {len(fall)} scenes" if fall else ABSENT


def bright(results):
    """On how many scenes light tracing alone is best by plain rmse."""
    best = [tables.best(field, factors.SECOND) for field in results.plain.values()]
    return f"{sum(labels == ['lighttrace'] for labels in best)} of {len(best)} scenes"


def limit(results):
    """The wall time after which a trial was given up."""
    words = {re.sub(r"^no result after ", "", row["message"]) for row in results.left_out if row["status"] == "timeout"}
    return ", ".join(sorted(words)) or "the limit"


def quartile_seeds(results):
    """How many seeds the pilot's upper quartile asks for, over the scenes that the search ran several seeds on."""
    several = [cells for cells in results.searched.values() if cells and len(cells[0].rows) > 1]
    return str(race.wanted_of([race.fronts(cells, results.duel) for cells in several], results.duel.rules)) if several else "not known"
