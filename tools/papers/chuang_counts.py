"""Chuang & Cheng 1995: the three counts, brute force, Watt's n_s n_d n_l, the trees' heights, convergent and divergent beams."""
import json

from papers.figures import plot
from papers.part import Figure, Part, Table
from papers.verdict import counted
from papers.words import short
from report.beam_trials import exponent
from report.records import natural

COUNTS = ("cone_point_tests", "beam_point_tests", "beam_point_hits")


def counters(trials, **wanted):
    row, *_ = trials.where(**wanted)
    return trials.record(row)["counters"]


def counts(study):
    paper = [study.paper.number(name) for name in COUNTS]
    sets = {"quads": study.sweep("counts"), "triangles": study.sweep("counts_triangles"), "dolphin": study.sweep("dolphin")}
    rows, missed, spared = [], [], []
    rows.append(["the paper's", f"{study.paper.number('polygons'):,}", "", "", "cones", *[f"{each:,}" for each in paper], "", "", ""])
    best = None
    for name, trials in sets.items():
        for row in trials.where(method="beamtree"):
            own = trials.record(row)["counters"]
            same = {key: row[key] for key in ("wave_height", "cells", "reflected") if row.get(key)}
            brute = counters(trials, method="causticpolygons", **same)
            missed.append(abs(own["beam_point_hits"] - brute["beam_point_hits"]))
            spared.append(brute["beam_point_tests"] / own["beam_point_tests"])
            found = [own[count] for count in COUNTS]
            off = max(max(a / b, b / a) for a, b in zip(found, paper))
            cells = row.get("cells") or "[75,101]"
            is_pool, alone = name != "dolphin", row["reflected"] == "0"
            if is_pool and alone and row["merging"] == "cones" and polygons(cells, name) == study.paper.number("polygons"):
                best = min(best, (off, found, row), key=lambda each: each[0]) if best else (off, found, row)
            rows.append(["dolphin" if not is_pool else "pool", f"{polygons(cells, name):,} {'triangles' if name == 'triangles' else 'quads'}",
                         row.get("wave_height") or "1.5", "alone" if alone else "and reflection", row["merging"],
                         *[f"{each:,} ({each / number:.2f})" for each, number in zip(found, paper)], f"{found[0] / found[1]:.1f}",
                         f"{found[1] / found[2]:.2f}", f"{brute['beam_point_hits']:,}"])
    _, found, row = best
    note = f"waves x {row['wave_height']}, the height at which the three come nearest"
    lit = int(float(row["lit_points"]))
    part = Part({f"count_{count}": counted(each, "tests" if "tests" in count else "hits", note) for count, each in zip(COUNTS, found)})
    part.measured |= {
        "cones_a_beam": counted(found[0] / found[1], "", note), "beams_a_hit": counted(found[1] / found[2], "", note),
        "hits_a_pixel": counted(found[2] / lit, "hits a lit point", f"{found[2]:,} hits on {lit:,} lit points; {note}"),
        "brute_force": counted(max(missed), "hits", f"largest difference of {len(missed)} pictures, pool and dolphin"),
        "beam_tests_spared": counted(min(spared), "times", f"tests of every beam over a receiver, over those of the tree: {short(min(spared))} "
                                                          f"to {short(max(spared))}")}
    part.tables.append(Table(
        "counts", "The three counts", ["scene", "specular polygons", "waves", "refraction", "merging", "cone-point tests", "beam-point tests",
                                       "successes", "cone / beam", "beam / success", "successes by brute force"], rows,
        "100 × 100 pixels, one ray each; in brackets over the paper's. Brute force: Watt's method with two cells a receiver, in which a "
        "point asks every beam that falls on its part of the receiver. cones: the paper's merging (eqs. 4 to 10); rays: a node's cone "
        "round all its vertex rays."))
    part.facts["count_rows"] = str(len(missed))
    return part


def polygons(cells, name):
    across, along = (int(each) for each in cells.strip("[]").split(","))
    return across * along * (2 if name == "triangles" else 1)


def watt(study):
    trials = study.sweep("watt")
    rows, powers = [], {}
    numbers = lambda row: [natural(row[key]) for key in ("cells", "receiver_resolution", "light_samples")]
    for row in sorted(trials.where(method="causticpolygons"), key=numbers):
        own = trials.record(row)["counters"]
        beams = counters(trials, method="beamtree", cells=row["cells"], light_samples=row["light_samples"])
        rows.append([f"{own['beams'] // int(row['light_samples']):,}", f"{own['receiver_polygons']:,}", row["light_samples"],
                     f"{own['beam_polygon_tests']:,}", f"{own['beam_polygon_tests'] / own['beams'] / own['receiver_polygons']:g}",
                     f"{beams['cone_point_tests'] + beams['beam_point_tests']:,}"])
    get = lambda **wanted: counters(trials, method="causticpolygons", **{"cells": 32, "receiver_resolution": 8, "light_samples": 1, **wanted})
    first = get()
    for name, more in (("n_s", get(cells=64)), ("n_d", get(receiver_resolution=16)), ("n_l", get(light_samples=4))):
        grown = more["receiver_polygons"] / first["receiver_polygons"] if name == "n_d" else more["beams"] / first["beams"]
        powers[name] = exponent([1, grown], [first["beam_polygon_tests"], more["beam_polygon_tests"]])
    asked = [counters(trials, method="beamtree", cells=32, light_samples=lights)["cone_point_tests"] for lights in (1, 4)]
    trees = counted(exponent([1, 4], asked), "", f"power of the number of trees: {asked[0]:,} cone-point tests for one light, {asked[1]:,} for four")
    return Part({f"watt_{name}": counted(power, "", "of the tests of beam with polygon") for name, power in powers.items()} | {"tree_sum": trees}, [Table(
        "watt", "Watt's tests", ["n_s, beams of a light", "n_d, diffuse polygons", "n_l, lights", "tests of beam with polygon", "over n_s n_d n_l",
                                 "tree: tests of one small picture"], rows,
        "experiments/scenes/pool_area.json: points of an area light serve as lights; beams of reflection and refraction. The tree's tests "
        "are of a picture of 32 x 24 points; Watt's have to be done once for any picture.")])


def bounds(study):
    trials = study.sweep("bounds")
    own = {(bound, merging): counters(trials, bound=bound, merging=merging)
           for bound in ("single", "double", "hybrid") for merging in ("cones", "rays")}
    over = lambda merging: own["single", merging]["beam_point_tests"] / own["double", merging]["beam_point_tests"]
    rows = [[bound, merging, *[f"{found[count]:,}" for count in COUNTS]] for (bound, merging), found in own.items()]
    return Part({"double_tighter": counted(over("cones"), "beam-point tests, single over double",
                                           f"with merging of rays {short(over('rays'))}")}, [Table(
        "bounds", "Single and double cones", ["bound", "merging", "cone-point tests", "beam-point tests", "successes"], rows,
        "The pool, 75 x 101 quads, waves x 1.5, refraction alone. hybrid: single up to a spread of 10 degrees, double above.")])


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

    def draw(ax):
        for merging, group in found.items():
            ax.plot([own["height"] for _, own in group], [a_point(own, COUNTS[0]) for _, own in group], "o-", label=f"merging: {merging}")
        ax.set_xlabel("height of the tree")
        ax.set_ylabel("cone-point tests a point")
        ax.set_xticks([own["height"] for _, own in found["rays"]])
        ax.set_ylim(0)
        ax.legend()

    heading = ["merging", "polygons", "height", "cone-point tests a point", "over the height", "beam-point tests a point"]
    return Part(measured, [Table("height", "Cost a point over the tree's height", heading, rows,
                                 "The pool in quads, waves x 1.5, refraction alone: one tree.")],
                [Figure("height", "Cost a point over the height of the tree", "The paper: the cost is proportional to the sum of the heights, a line "
                        "through the origin. Each further level has four times the polygons.", plot(draw, 5.2, 3))])


def lens(study):
    trials = study.sweep("lens")
    shape_of = lambda row: "convergent" if json.loads(row["dome"])[0]["amplitude"] > 0 else "divergent"
    own = dict(sorted(((shape_of(row), row["bound"]), trials.record(row)["counters"]) for row in trials.rows))
    a_hit = lambda found, count: found[count] / found["beam_point_hits"]
    rows = [[shape, bound, *[f"{found[count]:,}" for count in COUNTS], f"{a_hit(found, COUNTS[0]):.1f}", f"{a_hit(found, COUNTS[1]):.2f}"]
            for (shape, bound), found in own.items()]
    compare = lambda bound, count: a_hit(own["convergent", bound], count) / a_hit(own["divergent", bound], count)
    return Part({"convergent_single": counted(compare("single", COUNTS[0]), "cone-point tests a success",
                                              f"beam-point tests {compare('single', COUNTS[1]):.2f}; by double cones "
                                              f"{compare('double', COUNTS[0]):.2f} and {compare('double', COUNTS[1]):.2f}")}, [Table(
        "lens", "Convergent and divergent beams (figure 5)", ["beams", "bound", "cone-point tests", "beam-point tests", "successes",
                                                              "cone-point tests a success", "beam-point tests a success"], rows,
        "Light through a dome of water and through the same dome turned over; the spreads of their beams are alike.")])


SECTIONS = {"counts": counts, "watt": watt, "bounds": bounds, "heights": heights, "figure5": lens}
