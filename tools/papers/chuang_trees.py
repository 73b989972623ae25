"""Chuang & Cheng 1995: single and double cones, the trees' heights, convergent and divergent beams."""
import json

from papers.chuang_counts import COUNTS, counters
from papers.figures import plot
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted
from papers.words import short
from report.beam_trials import exponent
from report.records import natural


def bounds(study):
    trials = study.sweep("bounds")
    waves = sorted(trials.values("wave_height"), key=float)
    kinds = [("single", "cones", ""), ("single", "rays", ""), ("double", "cones", ""), ("double", "rays", ""),
             *[("hybrid", "cones", each) for each in trials.values("spread_threshold")]]
    at = lambda angle: {"spread_threshold": angle} if angle else {}
    own = {(bound, merging, angle, height): counters(trials, bound=bound, merging=merging, wave_height=height, **at(angle))
           for bound, merging, angle in kinds for height in waves}
    rows = [[height, bound, angle, merging, *[f"{found[count]:,}" for count in COUNTS]]
            for (bound, merging, angle, height), found in sorted(own.items(), key=lambda item: float(item[0][3]))]
    over = lambda top, bottom, count: [own[*top, height][count] / own[*bottom, height][count] for height in waves]
    ends = lambda values: f"{short(min(values))} to {short(max(values))}"
    single, single_rays, double, double_rays = kinds[:4]
    note = (f"waves x {', '.join(waves)}; with merging of rays {ends(over(single_rays, double_rays, COUNTS[1]))}; cone-point tests, double over "
            f"single: {ends(over(double, single, COUNTS[0]))} by the paper's merging, {ends(over(double_rays, single_rays, COUNTS[0]))} by rays")
    usual = f"{study.paper.number('spread_threshold'):g}"
    angles = {angle: [over(("hybrid", "cones", angle), ("hybrid", "cones", usual), count) for count in COUNTS[:2]]
              for angle in trials.values("spread_threshold") if angle != usual}
    pool = Measured(over(single, double, COUNTS[1]), unit="beam-point tests, single over double", counted=True, note=note)
    return Part({"double_pool": pool}, [Table(
        "bounds", "Single and double cones", [
            "waves", "bound", "threshold [degrees]", "merging", "cone-point tests", "beam-point tests", "successes"], rows,
        "The pool, 75 x 101 quads, refraction alone. hybrid: single up to the spread of the threshold, double above.")],
        facts={"over_thresholds": "; ".join(f"{angle} degrees: {ends(cone)} and {ends(beam)}" for angle, (cone, beam) in angles.items())})


def heights(study):
    trials = study.sweep("height")
    found = {merging: [(int(row["cells"].strip("[]").split(",")[0]), trials.record(row)["counters"])
                       for row in sorted(trials.where(merging=merging), key=lambda row: natural(row["cells"].strip("[]").split(",")[0]))]
             for merging in ("cones", "rays")}
    a_point = lambda own, count: own[count] / own["camera_rays"]
    rows = [[merging, f"{cells * cells:,}", str(own["height"]), short(a_point(own, COUNTS[0])), f"{a_point(own, COUNTS[0]) / own['height']:.2f}",
             short(a_point(own, COUNTS[1]))] for merging, group in found.items() for cells, own in group]
    measured, steps = {}, {}
    for merging, group in found.items():
        tests, levels = [a_point(own, COUNTS[0]) for _, own in group], [own["height"] for _, own in group]
        steps[merging] = [b - a for a, b in zip(tests, tests[1:])]
        measured[f"height_{merging}"] = counted(exponent(levels, tests), "", "power of the height; one more level costs "
                                                + ", ".join(f"{step:.1f}" for step in steps[merging]) + " tests a point, from the coarsest mesh on")
        measured[f"height_polygons_{merging}"] = counted(exponent([cells * cells for cells, _ in group], tests), "",
                                                         "power of the number of polygons")
    heading = ["merging", "polygons", "height", "cone-point tests a point", "over the height", "beam-point tests a point"]
    return Part(measured, [Table("height", "Cost a point over the tree's height", heading, rows,
                                 "The pool in quads, waves x 1.5, refraction alone: one tree.")],
                [Figure("height", "Cost a point over the height of the tree", "Points: measured; each further level has four times the polygons. "
                        "Dashed: what the paper states, cost in proportion to the height, through the lowest tree. Measured costs grow by nearly the "
                        "same for each level, but along a line that meets the axis at a height above zero.",
                        plot(lambda ax: draw_heights(ax, found), 5.2, 3.2))])


def draw_heights(ax, found):
    for merging, group in found.items():
        levels = [own["height"] for _, own in group]
        tests = [own[COUNTS[0]] / own["camera_rays"] for _, own in group]
        line, = ax.plot(levels, tests, "o-", label=f"merging: {merging}")
        ax.plot([0, levels[-1]], [0, tests[0] / levels[0] * levels[-1]], "--", color=line.get_color(), linewidth=0.9,
                label="in proportion to the height")
    ax.set_xlabel("height of the tree")
    ax.set_ylabel("cone-point tests a point")
    ax.set_xticks(range(levels[-1] + 1))
    ax.set_xlim(0, levels[-1] + 0.3)
    ax.set_ylim(0)
    ax.legend()


def lens(study):
    trials = study.sweep("lens")
    height_of = lambda row: json.loads(row["dome"])[0]["amplitude"]
    own = {(height_of(row), row["bound"]): trials.record(row)["counters"] for row in trials.rows}
    domes = sorted(height for height, bound in own if height > 0 and bound == "single")
    a_hit = lambda found, count: found[count] / found[COUNTS[2]]
    rows = [[f"{abs(height):g}", "convergent" if height > 0 else "divergent", bound, *[f"{found[count]:,}" for count in COUNTS],
             f"{a_hit(found, COUNTS[0]):.1f}", f"{a_hit(found, COUNTS[1]):.2f}"]
            for (height, bound), found in sorted(own.items(), key=lambda item: (abs(item[0][0]), -item[0][0], item[0][1]))]
    compare_at = lambda bound, count: [a_hit(own[dome, bound], count) / a_hit(own[-dome, bound], count) for dome in domes]
    tighter = lambda sign: [own[sign * dome, "single"][COUNTS[1]] / own[sign * dome, "double"][COUNTS[1]] for dome in domes]
    several = lambda values: ", ".join(map(short, values))
    at = f"domes of {', '.join(f'{dome:g}' for dome in domes)} m, from far before the focus to near it"
    return Part({
        "convergent_single": Measured(compare_at("single", COUNTS[0]), unit="cone-point tests a success", counted=True, note=(
            f"{at}: {several(compare_at('single', COUNTS[0]))}; beam-point tests {several(compare_at('single', COUNTS[1]))}; by double cones "
            f"{several(compare_at('double', COUNTS[0]))}")),
        "double_tighter": Measured(tighter(1), unit="beam-point tests, single over double", counted=True, note=(
            f"{at}: {several(tighter(1))}; for divergent beams {several(tighter(-1))}"))}, [Table(
        "lens", "Convergent and divergent beams (figure 5)", [
            "amplitude of the dome [m]", "beams", "bound", "cone-point tests", "beam-point tests", "successes", "cone-point tests a success",
            "beam-point tests a success"], rows,
        "Light through a dome of water and through the same dome turned over; the spreads of their beams are alike.")])


SECTIONS = {"bounds": bounds, "heights": heights, "figure5": lens}
