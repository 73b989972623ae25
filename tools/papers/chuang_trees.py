"""Chuang & Cheng 1995: single and double cones, their necks by eq. 2, the trees' heights, convergent and divergent beams."""
import itertools
import json

import numpy as np

from papers.chuang_accuracy import Overhead, rays_of_cells
from papers.chuang_counts import COUNTS, counters
from papers.figures import plot
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted
from papers.words import short
from report.beam_trials import exponent
from report.records import natural

STEPS = 60  # of the iteration, at most
NEAR = 1e-4  # a bracket that is so short, over the beam's length, ends the iteration
PLACES = 33  # along a beam, where its narrowest is looked for


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


def circle(points):
    """Radius of the smallest circle round each set of points; (points, 2, sets)."""
    candidates = [(points[a] + points[b]) / 2 for a, b in itertools.combinations(range(len(points)), 2)]
    candidates += [circumcentre(*points[list(three)]) for three in itertools.combinations(range(len(points)), 3)]
    reach = [np.linalg.norm(points - centre, axis=1).max(axis=0) for centre in candidates]
    return np.nanmin(reach, axis=0)


def circumcentre(a, b, c):
    """Circumcentres of triangles, whose corners are (2, sets); NaN where the points lie on a line."""
    b, c = b - a, c - a
    with np.errstate(divide="ignore", invalid="ignore"):
        twice = 2 * (b[0] * c[1] - b[1] * c[0])
        bb, cc = (b**2).sum(axis=0), (c**2).sum(axis=0)
        return a + np.where(twice == 0, np.nan, np.stack([c[1] * bb - b[1] * cc, b[0] * cc - c[0] * bb]) / twice)


class Widths:
    """Radius of the circle round a beam's corner rays across its axis, at shares of the way to the floor."""

    def __init__(self, starts, rays, axes, floor):
        across = np.cross(axes, np.where(np.abs(axes[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]]))
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        self.frame = np.stack([across, np.cross(axes, across)])
        self.starts, self.rays, self.axes = starts - starts[0], rays, axes
        self.length = ((floor - starts[..., 2]) / rays[..., 2] * (rays * axes).sum(axis=2)).max(axis=0)

    def __call__(self, share):
        depth = share * self.length
        along = (depth - (self.starts * self.axes).sum(axis=2)) / (self.rays * self.axes).sum(axis=2)
        places = self.starts + along[..., None] * self.rays
        return circle((places[:, None] * self.frame[None]).sum(axis=3))


def printed(widths):
    """(beams on which eq. 2 has a bracket, beams on which it ends by the two next brackets that are printed), each as a mask."""
    t1, t2, t3 = (np.full_like(widths.length, share) for share in (0, 0.5, 1))
    wide1, wide2, wide3 = (widths(share) for share in (t1, t2, t3))
    has_bracket = (wide1 > wide2) & (wide3 > wide2)
    going, ended = has_bracket.copy(), np.zeros_like(has_bracket)
    for _ in range(STEPS):
        ended |= going & (t3 - t1 <= NEAR)
        new = (wide1 * t3 + wide3 * t1) / (wide1 + wide3)
        wide = widths(new)
        beyond, before = (new > t2) & (wide < wide2), (new < t2) & (wide > wide2)
        going &= ~ended & (beyond | before)
        beyond, before = beyond & going, before & going
        t1, wide1 = np.where(beyond, (t2, wide2), (t1, wide1))
        t2, wide2 = np.where(beyond, (new, wide), (t2, wide2))
        t3, wide3 = np.where(before, (new, wide), (t3, wide3))
    return has_bracket, ended


def has_neck(widths):
    """Beams that are narrower somewhere between water and floor than at either end."""
    narrowest = np.argmin([widths(share) for share in np.linspace(0, 1, PLACES)], axis=0)
    return (narrowest > 0) & (narrowest < PLACES - 1)


def necks(study):
    """Every quad of the pool's water, at each height of the waves that the counts have."""
    across, along = (int(each) for each in study.sweep("accuracy").values("cells")[0].strip("[]").split(","))
    rows, found = [], []
    for waves in sorted(study.sweep("counts").values("wave_height"), key=natural):
        pool = Overhead(float(waves), 1)
        widths = Widths(*rays_of_cells(pool, across, along), pool.floor)
        neck, (bracket, ended) = has_neck(widths), printed(widths)
        found.append(float((neck & bracket).sum() / neck.sum()))
        rows.append([waves, *[f"{100 * share:.3g}" for share in (neck.mean(), found[-1], (neck & ended).sum() / neck.sum())]])
    notes = "; ".join(f"{waves}: {bracket} % have the bracket, {ended} % end by the cases that are printed" for waves, _, bracket, ended in rows)
    return Part({"neck_search": Measured(found, unit="of the beams with a neck", counted=True, note=f"waves x {notes}")}, [Table(
        "necks", "The search for a beam's neck (eq. 2)", [
            "waves", "beams with a neck between water and floor [%]", "of these: bracket of eq. 2 [%]", "of these: ends by the printed cases [%]"], rows,
        f"{across} x {along} quads of water, refracted rays at their corners. The bracket as printed: the beam is narrower in the middle than at the water and at "
        "the floor. The paper prints two of the four cases for the next bracket; the claim is judged by the bracket alone, as if the other two were there. "
        "The program finds necks by another search (beamtree/README.md).")])


SECTIONS = {"bounds": bounds, "heights": heights, "figure5": lens, "necks": necks}
