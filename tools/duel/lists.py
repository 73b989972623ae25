"""The duel's tables of what its numbers rest on: truths, bias and variance, settings tried and chosen, what was left out."""
import math

from duel import factors
from duel.curves import Cell
from duel.tables import HIDDEN, METHODS, percent, shown
from papers.part import Table

SQUARES = ("bias_square", "variance", "noise")


def truths(results):
    """How well each truth is known, and what it hides."""
    rows = []
    for scene, field in shown(results):
        bounds = [f"{label}: {cell.setting.text()}" for label in METHODS for cell in field.own.get(label, []) if cell.is_bound()]
        found = factors.factor_of_errors(field)
        how = "quadrature" if scene.quadrature() else f"light tracing, {scene.truth['paths']:,} paths"
        better = "–" if found is None or found.is_tie() else HIDDEN if found.is_hidden() else "shown"
        rows.append([scene.title, how, percent(math.sqrt(field.noise)), percent(field.limit), "; ".join(bounds) or "–", better])
    heading = ["scene", "truth", "its own error", "least error it can show", "settings that are bounds", "who is better after 1 s"]
    return Table("truths", "How well the truths are known", heading, rows,
                 "A measured squared error within a quarter of the truth's own is a bound: < half of the truth's own error. Who is better is shown "
                 "where the difference is at least ten times what the truth's own error makes of it; –: not decided, or one has no picture.")


def too_noisy(results):
    """Titles of scenes whose truth makes a bound of what was measured, or hides who is better."""
    return [row[0] for row in truths(results).rows if row[4] != "–" or row[5] == HIDDEN]


def parts(results):
    """bias^2 and variance of each method's most accurate setting."""
    rows = []
    for scene, field in shown(results):
        for label in METHODS:
            own = field.own.get(label, [])
            if not own:
                continue
            cell = min(own, key=lambda cell: (cell.error(), cell.raw()))
            spread = results.spread_of(scene.name, label, cell.setting.text())
            if spread:
                error = ("< " if cell.is_bound() else "") + percent(cell.error()) + (" *" if cell.is_at_noise() else "")
                rows.append([scene.title, label, cell.setting.text(), error, *(f"{spread[name]:.2g}" for name in SQUARES),
                             f"{cell.median('build_s'):.2g} + {cell.median('query_s'):.2g}", f"{cell.median('mean_ratio'):.3f}"])
    return Table("parts", "Bias² and variance of each method's most accurate setting",
                 ["scene", "method", "setting", "error", "bias²", "variance", "truth's own error²", "CPU s, build + query", "light found"], rows,
                 "In the measure of relmse: error² = bias² + variance. bias² is unbiased, so it may come out below 0. "
                 "* the truth's own error is most of what was measured.")


def settings(results):
    """What the search tried, and what it chose."""
    rows = []
    for scene, field in shown(results):
        tried = results.searched.get(scene.name, [])
        for label in METHODS:
            own = sorted(field.own.get(label, []), key=Cell.seconds)
            if own:
                count = sum(cell.label == label for cell in tried)
                rows.append([scene.title, label, own[0].setting.asks, f"{len(own)} of {count}", "; ".join(cell.setting.text() for cell in own)])
    return Table("settings", "Settings that the search chose", ["scene", "method", "asked", "chosen", "settings, fastest first"], rows)


def left_out(results):
    """Settings that gave no picture, with the reason."""
    groups = {}
    for row in results.left_out:
        groups.setdefault((row["scene"], row["label"], row["status"], row["message"]), []).append(row["settings"])
    title = {scene.name: scene.title for scene in results.duel.scenes}
    rows = [[title[scene], label, str(len(set(own))), str(len(own)), status, message]
            for (scene, label, status, message), own in sorted(groups.items())]
    return Table("left_out", "What gave no picture", ["scene", "method", "settings", "trials", "status", "why"], rows)
