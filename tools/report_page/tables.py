"""The tables of the page as CSV, with all digits, and as LaTeX (booktabs) for one or two columns of a paper."""
import csv
import decimal
import io
import math
import re

from report.record_tables import tex
from report.records import RecordsError, marked, table_head
from report_page.scenes import COSTS, ERRORS, rank, seeds_text

KNOWN = ERRORS + COSTS
USUAL = ("rmse", "work_s")
MOST_PLACES = 6  # after the point; beyond them a power of ten says it
NARROW = 2  # columns of numbers that fit beside the labels in one column of a paper
RADIANCE = r"$\mathrm{W\,m^{-2}\,sr^{-1}}$"
TEX_UNITS = {"rmse": RADIANCE, "mask_rmse": RADIANCE, "beauty_rmse": RADIANCE, "indirect_rmse": RADIANCE, "indirect_cpu_s": "CPU seconds",
             "work_s": "CPU seconds", "build_s": "CPU seconds", "query_s": "CPU seconds",
             "total_s": "seconds", "map_bytes": "bytes", "peak_rss_bytes": "bytes"}


def check_columns(names):
    unknown = [name for name in names if name not in KNOWN]
    if unknown:
        raise RecordsError(f"--columns: unknown column {unknown[0]} (known: {', '.join(KNOWN)})")
    twice = [name for at, name in enumerate(names) if name in names[:at]]
    if twice:
        raise RecordsError(f"--columns: {twice[0]} is named twice")


def all_of(scenes, columns):
    """[(file name, text)]."""
    made = [("cells.csv", cells_csv(scenes)), ("equal_time.csv", equal_time_csv(scenes)),
            ("equal_time.tex", equal_time_tex(scenes))]
    return made + list(zip(file_names(scenes), (cells_tex(scene, columns) for scene in scenes)))


def file_names(scenes):
    """Of the scenes' LaTeX tables: no two are one, whatever signs their titles have."""
    names = []
    for scene in scenes:
        name = re.sub(r"[^A-Za-z0-9.]+", "_", scene.title()).strip("_")
        while f"cells-{name}.tex" in names:
            name += "_2"
        names.append(f"cells-{name}.tex")
    return names


def csv_text(rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([[marked(each) if isinstance(each, str) else each for each in row] for row in rows])
    return text.getvalue()


def of_several_folders(scenes):
    """Whether tables have a column that says which folder a cell is from."""
    return len({name for scene in scenes for name in scene.folders()}) > 1


def cells_csv(scenes):
    several = of_several_folders(scenes)
    names = list(dict.fromkeys(name for scene in scenes for cell in scene.cells for name in cell.parameters))
    measured = [f"{name}{what}" for name in ERRORS for what in ("", "_half_interval_95")] + list(COSTS)
    rows = [table_head(names, [*["folder"] * several, "scene", "method"], ["seeds", *measured])]
    for scene in scenes:
        for cell in scene.cells:
            errors = [number for name in ERRORS for number in cell.error(name) or (None, None)]
            costs = [cell.cost(name) for name in COSTS]
            rows.append([*[cell.sweep.name] * several, scene.title(), cell.method, *(cell.parameters.get(name, "") for name in names),
                         len(cell.seeds()), *("" if number is None else repr(number) for number in errors + costs)])
    return csv_text(rows)


def contest_rows(scene):
    """(CPU seconds allowed, method, its best cell until then, whether it is among the best) of the contest shown first."""
    chosen = scene.usual_contest()
    if chosen is None:
        return []
    seconds, picks, best = scene.contests()[chosen]
    return [(seconds, method, picks[method], picks[method] in best)
            for method in sorted(picks, key=rank)]


def equal_time_csv(scenes):
    several = of_several_folders(scenes)
    rows = [[*["folder"] * several, "scene", "cpu_s_allowed", "method", "settings", "seeds", "rmse", "rmse_half_interval_95", "work_s",
             "build_s", "query_s", "among_best"]]
    for scene in scenes:
        for seconds, method, cell, best in contest_rows(scene):
            error, half = cell.error("rmse")
            rows.append([*[cell.sweep.name] * several, scene.title(), repr(seconds), method, cell.label, len(cell.seeds()), repr(error),
                         "" if half is None else repr(half), *(repr(cell.cost(name)) for name in COSTS[:3]),
                         "yes" if best else ""])
    return csv_text(rows)


def number_tex(value, half=None, digits=3):
    """0.0532 ± 0.0040 to the digits that the interval leaves, else so many digits."""
    if value is None:
        return "--"
    return f"${with_interval_tex(value, half) if half else rounded_tex(value, digits)}$"


def rounded_tex(value, digits):
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    return f"{mantissa} \\cdot 10^{{{int(power)}}}" if power else mantissa


def with_interval_tex(value, half):
    """The interval to two digits, the value to as many places: plainly, as (7.42 ± 0.20) · 10⁻⁷ where that has too many
    zeros, and where the interval is far below the value each in digits of its own."""
    places = 1 - math.floor(math.log10(half))
    if max(abs(value), half) < 10 ** MOST_PLACES and places <= MOST_PLACES:
        return f"{value:.{max(0, places)}f} \\pm {half:.{max(0, places)}f}"
    power = math.floor(math.log10(max(abs(value), half)))
    places = max(0, places + power)
    if places > MOST_PLACES:
        return rf"{rounded_tex(value, MOST_PLACES + 1)} \pm {rounded_tex(half, 2)}"
    mantissas = [f"{decimal.Decimal(each).scaleb(-power):.{places}f}" for each in (value, half)]
    return rf"({mantissas[0]} \pm {mantissas[1]}) \cdot 10^{{{power}}}"


def head_tex(name):
    return tex(name.removesuffix("_s"))


def settings_tex(cell):
    """A cell's settings in the short words of papers."""
    return re.sub(r"nearest (\d+)", r"$N = \1$", tex(cell.settings().replace("mesh_resolution", "mesh")))


def units_tex(columns):
    """Units are in the caption, since a column of a paper is narrow."""
    return "; ".join(f"{head_tex(name)} in {TEX_UNITS[name]}" for name in columns if name in TEX_UNITS)


def tabular(columns, head, rows, wide, caption):
    kind = "table*" if wide else "table"
    lines = [r"% Needs \usepackage{booktabs}", rf"\begin{{{kind}}}", r"\centering\footnotesize\setlength{\tabcolsep}{3pt}",
             rf"\caption{{{caption}}}", rf"\begin{{tabular}}{{@{{}}{columns}@{{}}}}", r"\toprule",
             " & ".join(head) + r" \\", r"\midrule", *(" & ".join(row) + r" \\" for row in rows), r"\bottomrule",
             r"\end{tabular}", rf"\end{{{kind}}}"]
    return "\n".join(lines) + "\n"


def cells_tex(scene, columns):
    rows = []
    for method in sorted({cell.method for cell in scene.cells}, key=rank):
        rows.append([rf"\multicolumn{{{len(columns) + 1}}}{{@{{}}l}}{{\textit{{{tex(method)}}}}}"])
        for cell in (cell for cell in scene.cells if cell.method == method):
            fields = [number_tex(*(cell.error(name) or (None,))) if name in ERRORS else number_tex(cell.cost(name))
                      for name in columns]
            rows.append([settings_tex(cell), *fields])
    caption = (f"{tex(scene.title())}: mean over {seeds_text(scene.cells)} $\\pm$ half its 95\\,\\% interval (Student); times and "
               f"sizes are medians. {units_tex(columns)}.")
    return tabular("l" + "r" * len(columns), ["settings", *map(head_tex, columns)], rows, len(columns) > NARROW, caption)


def equal_time_tex(scenes):
    """Method x scene: rmse, with build and query apart."""
    columns = {scene.title(): contest_rows(scene) for scene in scenes if contest_rows(scene)}
    methods = sorted({method for rows in columns.values() for _, method, _, _ in rows}, key=rank)
    head = ["method", *(rf"{tex(title)} ({rows[0][0]:.2g}\,s)" for title, rows in columns.items())]
    rows = []
    for method in methods:
        fields = []
        for entries in columns.values():
            own = next(((cell, best) for _, name, cell, best in entries if name == method), None)
            if own is None:
                fields.append("--")
                continue
            text = number_tex(*own[0].error("rmse"))
            text = rf"\boldmath{{{text}}}" if own[1] else text
            build, query = (number_tex(own[0].cost(name), digits=2) for name in ("build_s", "query_s"))
            fields.append(rf"{text} ({build}\,+\,{query}\,s)")
        rows.append([tex(method), *fields])
    caption = ("RMSE of each method's best setting within the CPU time named at the scene, with that setting's CPU seconds of "
               "build + query; bold: the best and all that the seeds do not tell from it, where there are five seeds.")
    return tabular("l" + "l" * len(columns), head, rows, len(columns) > 1, caption)
