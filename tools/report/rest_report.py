"""Beams of several events that photons complete (rest: photons) beside the photon map, as a page of tables."""
from equal_error import against, front, ratio_text

PHASES = ("precompute_cpu_s", "balance_cpu_s", "render_cpu_s")
PAGE = """# Beams completed by photons

Made by `tools/measure_beams.py --rest` on {machine}

80 × 60 pixels of 4 samples against `lighttrace` (2 million paths), one seed; an rmse holds the reference's own error too. Light: the
mean of the caustic layer over the reference's, so 1 is the whole light. Of the light on casters, `left out` is what `prune` and
`max_beams` leave out, and `lost` what nothing carries. The last two columns are the photon map's time for a row's error over the row's
own time: below 1 the photon map is faster; "≥" where its largest trial did not reach that error. Few pixels of a focus make most of
the rmse and move the light, at random, as samples fall into them; relmse counts dark and bright pixels alike.
{tables}"""
TABLE = """
## {scene}

Standard error of a pixel of the reference over its mean: {noise:.3g}.

| method | max_beams | photons | light | left out | lost | CPU s | rmse | relmse | photon map's time for the rmse | for the relmse |
|---|---|---|---|---|---|---|---|---|---|---|
{lines}"""


def number(row, column):
    return float(row.get(column) or 0)


def measured(row):
    beams = row["method"] == "beamtree"
    return {"method": row["method"] + (", rest: photons" if beams and row["rest"] == "photons" else ""),
            "max_beams": row["max_beams"] if beams else "", "photons": row["rest_photons"] if beams else row["photons"],
            "seconds": sum(number(row, phase) for phase in PHASES), "rmse": number(row, "rmse"), "relmse": number(row, "relmse"),
            "light": number(row, "mean_ratio"), "beams": beams,
            "left_out": number(row, "flux_share_pruned") + number(row, "flux_share_over_budget"),
            "lost": 1 - number(row, "flux_share_captured")}


def times(trial, photons, metric):
    """The photon map's time for a trial's error over the trial's own."""
    by = lambda one: {"seconds": one["seconds"], "error": one[metric]}
    ratio, bound = against(by(trial), front(by(one) for one in photons))
    return ratio_text({"ratio": ratio, "lower_bound": bound})


def line(trial, photons):
    cells = ["", "", "", ""]
    if trial["beams"]:
        cells = [f"{trial['left_out']:.3f}", f"{trial['lost']:.3f}", times(trial, photons, "rmse"), times(trial, photons, "relmse")]
    return (f"| {trial['method']} | {trial['max_beams']} | {trial['photons']} | {trial['light']:.3f} | {cells[0]} | {cells[1]} "
            f"| {trial['seconds']:.2f} | {trial['rmse']:.4g} | {trial['relmse']:.3g} | {cells[2]} | {cells[3]} |\n")


def table(scene, rows):
    trials = [measured(row) for row in rows]
    photons = [trial for trial in trials if not trial["beams"]]
    return TABLE.format(scene=scene, noise=number(rows[0], "reference_stderr"),
                        lines="".join(line(trial, photons) for trial in trials))


def page(rows, machine):
    """`rows` of records that are done; `machine` says where."""
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    tables = "".join(table(scene, [row for row in rows if row["scene"] == scene]) for scene in scenes)
    return PAGE.format(machine=machine, tables=tables)
