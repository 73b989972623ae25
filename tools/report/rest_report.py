"""Beams of several events that photons complete (rest: photons) beside the photon map, as a page of tables."""
import math

from equal_error import against, front, ratio_text
from report.records import CPU_PARTS

PAGE = """# Beams completed by photons

Made by `tools/measure_beams.py --rest` on {machine}

80 × 60 pixels of 16 samples against `lighttrace` (20 million paths); an rmse holds the reference's own error too. Each row is of
{seeds} seeds: errors are their root mean square, seconds (one thread) and shares their mean. Light: the
mean of the caustic layer over the reference's, so 1 is the whole light. Pixels: the irradiance is asked at the points that the samples see, or averaged
over the pixel (`pixel_footprint` of beams; `footprint` of the photon map, a square as wide as a pixel in the middle of the picture). Of the light on casters, `left out` is what `prune` and
`max_beams` leave out, and `lost` what nothing carries. The last two columns are the photon map's time for a row's error (the best of its {photon_rows} rows) over the row's
own time: below 1 the photon map is faster; "≥" where none of its rows reached that error. Few pixels of a focus make most of
the rmse of points and move the light, at random, as samples fall into them; relmse counts dark and bright pixels alike.
{tables}"""
TABLE = """
## {scene}

Standard error of a pixel of the reference over its mean: {noise:.3g}.

| method | pixels | max_beams | photons | light | left out | lost | CPU s | rmse | relmse | photon map's time for the rmse | for the relmse |
|---|---|---|---|---|---|---|---|---|---|---|---|
{lines}"""


SETTINGS = ("method", "rest", "max_beams", "photons", "nearest", "footprint", "pixel_footprint")


def number(row, column):
    return float(row.get(column) or 0)


def averaged(rows):
    """What the seeds of one setting have in common, as a row."""
    mean = lambda column: sum(number(row, column) for row in rows) / len(rows)
    squares = lambda column: math.sqrt(sum(number(row, column) ** 2 for row in rows) / len(rows))
    beams = rows[0]["method"] == "beamtree"
    return {"method": rows[0]["method"] + (", rest: photons" if beams and rows[0]["rest"] == "photons" else ""),
            "pixels": "averaged" if rows[0].get("pixel_footprint") or rows[0].get("footprint") else "points",
            "max_beams": rows[0]["max_beams"] if beams else "",
            "photons": f"{mean('rest_photons_stored'):.0f} stored" if beams else f"{rows[0]['photons']}, N = {rows[0]['nearest']}",
            "seconds": sum(mean(part) for part in CPU_PARTS), "rmse": squares("rmse"), "relmse": mean("relmse"),
            "light": mean("mean_ratio"), "beams": beams, "left_out": mean("flux_share_pruned") + mean("flux_share_over_budget"),
            "lost": 1 - mean("flux_share_captured")}


def settings(rows):
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row.get(column) for column in SETTINGS), []).append(row)
    return [averaged(group) for group in groups.values()]


def contest(trial, photons, metric):
    """The photon map's time for a trial's error over the trial's own."""
    by = lambda one: {"seconds": one["seconds"], "error": one[metric]}
    ratio, bound = against(by(trial), front(by(one) for one in photons))
    return {"ratio": ratio, "lower_bound": bound}


def times(trial, photons, metric):
    return ratio_text(contest(trial, photons, metric))


def best(trials, photons):
    """What the best rows of beams reach, a sentence."""
    if not trials:
        return ""
    parts = [ratio_text(max((contest(trial, photons, metric) for trial in trials), key=lambda one: one["ratio"]))
             + f" in {metric}" for metric in ("rmse", "relmse")]
    return "\nThe photon map's time over that of beams, their best rows: " + ", ".join(parts) + ".\n"


def line(trial, photons):
    cells = ["", "", "", ""]
    if trial["beams"]:
        cells = [f"{trial['left_out']:.3f}", f"{trial['lost']:.3f}", times(trial, photons, "rmse"), times(trial, photons, "relmse")]
    return (f"| {trial['method']} | {trial['pixels']} | {trial['max_beams']} | {trial['photons']} | {trial['light']:.3f} | {cells[0]} "
            f"| {cells[1]} | {trial['seconds']:.2f} | {trial['rmse']:.4g} | {trial['relmse']:.3g} | {cells[2]} | {cells[3]} |\n")


def table(scene, rows):
    trials = settings(rows)
    photons = [trial for trial in trials if not trial["beams"]]
    return TABLE.format(scene=scene, noise=number(rows[0], "reference_stderr"),
                        lines="".join(line(trial, photons) for trial in trials)
                        + best([trial for trial in trials if trial["beams"]], photons))


def page(rows, machine):
    """`rows` of records that are done; `machine` says where."""
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    tables = "".join(table(scene, [row for row in rows if row["scene"] == scene]) for scene in scenes)
    photon_rows = sum(not trial["beams"] for trial in settings([row for row in rows if row["scene"] == scenes[0]]))
    return PAGE.format(machine=machine, tables=tables, seeds=len({row["seed"] for row in rows}), photon_rows=photon_rows)
