"""Beams of several events that photons complete (rest: photons) beside the photon map, as a page of tables."""
from equal_error import against, front, ratio_text

PHASES = ("precompute_cpu_s", "balance_cpu_s", "render_cpu_s")
PAGE = """# Beams completed by photons

Made by `tools/measure_beams.py --rest` on {machine} 80 × 60 pixels of 4 samples against `lighttrace` (2 million paths), one seed. An rmse holds the
reference's own error too. Light: the mean of the caustic layer over the reference's, so 1 is the whole light. Of the light on casters, `left out` is what `prune` and
`max_beams` leave out, and `lost` what nothing carries. The last column is the photon map's time for a row's error over the row's own
time: below 1 the photon map is faster; "≥" where its largest trial did not reach that error.
{tables}"""
TABLE = """
## {scene}

Standard error of a pixel of the reference over its mean: {noise:.3g}.

| method | max_beams | photons | light | left out | lost | CPU s | rmse | photon map's time for it |
|---|---|---|---|---|---|---|---|---|
{lines}"""


def number(row, column):
    return float(row.get(column) or 0)


def measured(row):
    beams = row["method"] == "beamtree"
    return {"method": row["method"] + (", rest: photons" if beams and row["rest"] == "photons" else ""),
            "max_beams": row["max_beams"] if beams else "", "photons": row["rest_photons"] if beams else row["photons"],
            "seconds": sum(number(row, phase) for phase in PHASES), "error": number(row, "rmse"),
            "light": number(row, "mean_ratio"), "beams": beams,
            "left_out": number(row, "flux_share_pruned") + number(row, "flux_share_over_budget"),
            "lost": 1 - number(row, "flux_share_captured")}


def line(trial, photons):
    ratio = left_out = lost = ""
    if trial["beams"]:
        times, bound = against(trial, photons)
        ratio = ratio_text({"ratio": times, "lower_bound": bound})
        left_out, lost = f"{trial['left_out']:.3f}", f"{trial['lost']:.3f}"
    return (f"| {trial['method']} | {trial['max_beams']} | {trial['photons']} | {trial['light']:.3f} | {left_out} | {lost} "
            f"| {trial['seconds']:.2f} | {trial['error']:.4g} | {ratio} |\n")


def table(scene, rows):
    trials = [measured(row) for row in rows]
    photons = front(trial for trial in trials if not trial["beams"])
    return TABLE.format(scene=scene, noise=number(rows[0], "reference_stderr"),
                        lines="".join(line(trial, photons) for trial in trials))


def page(rows, machine):
    """`rows` of records that are done; `machine` says where."""
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    tables = "".join(table(scene, [row for row in rows if row["scene"] == scene]) for scene in scenes)
    return PAGE.format(machine=machine, tables=tables)
