"""Chuang & Cheng 1995: the three counts by each reading of the paper, brute force, Watt's n_s n_d n_l."""
import dataclasses
import json

from papers.part import Part, Table
from papers.verdict import HOLDS, Measured, compare, counted
from papers.words import short
from report.beam_trials import exponent
from report.records import natural

COUNTS = ("cone_point_tests", "beam_point_tests", "beam_point_hits")
FIGURES = {  # claim: what it measures of one picture
    "count_cone_point_tests": lambda own: own[COUNTS[0]], "count_beam_point_tests": lambda own: own[COUNTS[1]],
    "count_beam_point_hits": lambda own: own[COUNTS[2]], "cones_a_beam": lambda own: own[COUNTS[0]] / own[COUNTS[1]],
    "beams_a_hit": lambda own: own[COUNTS[1]] / own[COUNTS[2]], "hits_a_pixel": lambda own: own[COUNTS[2]] / own["camera_rays"]}
UNITS = {"count_beam_point_hits": "hits", "cones_a_beam": "", "beams_a_hit": "", "hits_a_pixel": "hits a pixel"}


@dataclasses.dataclass
class Picture:
    """One picture of the trees, beside that by brute force and the polygons that Watt's method has there."""
    scene: str
    polygons: int
    kind: str
    waves: str
    is_alone: bool
    merging: str
    own: dict
    brute: dict
    receivers: int

    def reading(self):
        """What the paper does not say: polygons, refraction alone or reflection too, how cones are merged."""
        return f"{self.polygons:,} {self.kind}", "alone" if self.is_alone else "and reflection", self.merging


def counters(trials, **wanted):
    row, *_ = trials.where(**wanted)
    return trials.record(row)["counters"]


def pictures_of(study):
    watt = study.sweep("small_pictures")
    found = []
    for name in ("counts", "counts_triangles", "dolphin"):
        trials, kind = study.sweep(name), "triangles" if name == "counts_triangles" else "quads"
        scene = "dolphin" if name == "dolphin" else "pool"
        receivers = counters(watt, scene=f"chuang_{scene}", method="causticpolygons", with_polygons="quads")["receiver_polygons"]
        for row in trials.where(method="beamtree"):
            same = {key: row[key] for key in ("wave_height", "cells", "reflected") if row.get(key)}
            across, along = json.loads(row.get("cells") or "[75, 101]")
            polygons, waves = across * along * (2 if kind == "triangles" else 1), row.get("wave_height") or "1.5"
            found.append(Picture(scene, polygons, kind, waves, row["reflected"] == "0", row["merging"], trials.record(row)["counters"],
                                 counters(trials, method="causticpolygons", **same), receivers))
    return sorted(found, key=lambda each: (each.scene != "pool", each.kind, -each.polygons, not each.is_alone, float(each.waves), each.merging))


def counts(study):
    pictures = pictures_of(study)
    pool = [each for each in pictures if each.scene == "pool"]
    main = [each for each in pool if each.reading() == (f"{study.paper.number('polygons'):,} quads", "alone", "cones")]
    claims = {claim["id"]: claim for claim in study.paper.text["claims"]}
    part = Part({name: judged(study.paper, claims[name], main, pool) for name in FIGURES})
    missed = [abs(each.own[COUNTS[2]] - each.brute[COUNTS[2]]) for each in pictures]
    over = lambda names: [each.brute[COUNTS[1]] / sum(each.own[name] for name in names) for each in pictures]
    ends = lambda values: f"{short(min(values))} to {short(max(values))}"
    part.measured |= {
        "brute_force": counted(max(missed), "hits", f"largest difference of {len(missed)} pictures, pool and dolphin"),
        "beam_tests_spared": counted(min(over(COUNTS[1:2])), "times", (
            f"tests of every beam over a receiver, over those of the tree: {ends(over(COUNTS[1:2]))}; with its cone-point tests "
            f"{ends(over(COUNTS[:2]))}"))}
    part.tables += [counts_table(study.paper, pictures), readings_table(study.paper, claims, pool)]
    part.facts |= matters(pictures, main) | {"all_hold": all_hold(study.paper, claims, main)}
    return part


def judged(paper, claim, main, pool):
    """Ours at all heights of the waves; the note has the window of heights in which the claim holds, and how other readings fare."""
    values = [FIGURES[claim["id"]](each.own) for each in main]
    verdict = lambda value: compare((value, value), paper.region(claim))
    others = [verdict(FIGURES[claim["id"]](each.own)) for each in pool if each not in main]
    theirs = paper.value(claim)
    each = ", ".join(f"{height.waves}: {short(value)} ({short(value / theirs)} of the paper's)" for height, value in zip(main, values))
    return Measured(values, unit=UNITS.get(claim["id"], "tests"), counted=True, note=(
        f"{window([height.waves for height in main], [verdict(value) == HOLDS for value in values])}; waves x {each}; of {len(others)} pictures by "
        f"other readings (polygons, reflection, merging) {others.count(HOLDS)} would hold"))


def all_hold(paper, claims, main):
    """The window of heights in which all claims of FIGURES hold together."""
    at = lambda own, name: compare((FIGURES[name](own),) * 2, paper.region(claims[name])) == HOLDS
    return window([each.waves for each in main], [all(at(each.own, name) for name in FIGURES) for each in main])


def window(heights, holds):
    """At which of the heights, in rising order, a claim holds, as words."""
    inside = [height for height, each in zip(heights, holds) if each]
    if not inside:
        return f"holds at none of the heights from x {heights[0]} to x {heights[-1]}"
    first, last = heights.index(inside[0]), heights.index(inside[-1])
    if last - first + 1 > len(inside):
        return f"holds at waves x {', '.join(inside)} of {', '.join(heights)}"
    beyond = [f"x {heights[place]}" for place in (first - 1, last + 1) if 0 <= place < len(heights)]
    held = f"holds from waves x {inside[0]} to x {inside[-1]}" if len(inside) > 1 else f"holds at waves x {inside[0]}"
    return f"{held}, and not at {' and '.join(beyond)}" if beyond else f"{held}, all that were tried"


def a_pixel(own, pixels):
    return " / ".join(f"{own[count] / pixels:.3g}" for count in COUNTS)


def counts_table(paper, pictures):
    theirs = {count: paper.number(count) for count in COUNTS}
    rows = [["the paper's", f"{paper.number('polygons'):,}", "", "", "cones", *[f"{each:,}" for each in theirs.values()],
             a_pixel(theirs, paper.number("pixels")), *[short(theirs[a] / theirs[b]) for a, b in zip(COUNTS, COUNTS[1:])], "", ""]]
    for each in pictures:
        polygons, refraction, merging = each.reading()
        rows.append([each.scene, polygons, each.waves, refraction, merging,
                     *[f"{each.own[count]:,} ({each.own[count] / theirs[count]:.2f})" for count in COUNTS],
                     a_pixel(each.own, each.own["camera_rays"]), f"{each.own[COUNTS[0]] / each.own[COUNTS[1]]:.1f}",
                     f"{each.own[COUNTS[1]] / each.own[COUNTS[2]]:.2f}", f"{each.brute[COUNTS[2]]:,}",
                     f"{each.brute['beams']:,} x {each.receivers:,} = {each.brute['beams'] * each.receivers:,}"])
    return Table("counts", "The three counts", [
        "scene", "specular polygons", "waves", "refraction", "merging", "cone-point tests", "beam-point tests", "successes", "all three a pixel",
        "cone / beam", "beam / success", "successes by brute force", "Watt's n_s n_d"], rows,
        "100 × 100 pixels, one ray each; in brackets over the paper's. Brute force: Watt's method with two cells a receiver, in which a "
        "point asks every beam that falls on its part of the receiver. n_s n_d: Watt's tests of beam with polygon for this picture, beams times "
        "the polygons of pool and dolphin with 16 x 16 cells a wall. cones: the paper's merging (eqs. 4 to 10); rays: a node's cone round all its "
        "vertex rays.")


def readings_table(paper, claims, pool):
    rows = []
    for reading in dict.fromkeys(each.reading() for each in pool):
        own = [each.own for each in pool if each.reading() == reading]
        cells = []
        for name, of in FIGURES.items():
            values, region = [of(each) for each in own], paper.region(claims[name])
            theirs = paper.value(claims[name])
            held = sum(compare((value, value), region) == HOLDS for value in values)
            cells.append(f"{min(values) / theirs:.2f} to {max(values) / theirs:.2f} ({held} of {len(values)})")
        rows.append([*reading, *cells])
    return Table("readings", "The three counts by each reading of the paper", [
        "specular polygons", "refraction", "merging", "cone-point tests", "beam-point tests", "successes", "cone / beam", "beam / success",
        "hits a pixel"], rows,
        "Ours over the paper's, least to greatest over the heights of the waves; in brackets at how many of them the claim would hold. "
        "The first row is the one that is judged.")


def matters(pictures, main):
    """Facts: what each choice changes, as ratios of the three counts, over all pairs of pictures that differ in nothing else."""
    def change(chosen, other):
        found = [[b.own[count] / a.own[count] for count in COUNTS] for a in pictures for b in pictures if chosen(a) and other(a, b)]
        return ", ".join(f"{short(min(column))} to {short(max(column))}" for column in zip(*found))

    same = lambda a, b, *but: all(getattr(a, name) == getattr(b, name) for name in ("scene", "polygons", "kind", "waves", "is_alone", "merging")
                                  if name not in but)
    first = main[0]
    grid = lambda a, b: same(a, b, "polygons", "kind")
    of_first = lambda a: (a.scene, a.polygons, a.kind) == ("pool", first.polygons, first.kind)
    return {
        "fewer_quads": change(of_first, lambda a, b: grid(a, b) and b.kind == "quads" and b.polygons < a.polygons),
        "in_triangles": change(of_first, lambda a, b: grid(a, b) and b.kind == "triangles"),
        "with_reflection": change(lambda a: a.is_alone and a.scene == "pool" and a.merging == first.merging,
                                  lambda a, b: same(a, b, "is_alone") and not b.is_alone),
        "by_rays": change(lambda a: a.merging == "cones" and a.is_alone, lambda a, b: same(a, b, "merging") and b.merging == "rays"),
        "on_dolphin": change(of_first, lambda a, b: same(a, b, "scene") and b.scene == "dolphin")}


def watt(study):
    trials = study.sweep("watt")
    rows = []
    numbers = lambda row: [natural(row[key]) for key in ("cells", "receiver_resolution", "light_samples")]
    for row in sorted((each for each in trials.where(method="causticpolygons") if each["repeat"] == "1"), key=numbers):
        own = trials.record(row)["counters"]
        beams = counters(trials, method="beamtree", cells=row["cells"], light_samples=row["light_samples"])
        rows.append([f"{own['beams'] // int(row['light_samples']):,}", f"{own['receiver_polygons']:,}", row["light_samples"],
                     f"{own['beam_polygon_tests']:,}", f"{own['beam_polygon_tests'] / own['beams'] / own['receiver_polygons']:g}",
                     f"{beams['cone_point_tests'] + beams['beam_point_tests']:,}"])
    part = Part(watts_powers(trials))
    asked = [counters(trials, method="beamtree", cells=32, light_samples=lights)["cone_point_tests"] for lights in (1, 4)]
    trees = counted(exponent([1, 4], asked), "", f"power of the number of trees: {asked[0]:,} cone-point tests for one light, {asked[1]:,} for four")
    part.measured["tree_sum"] = trees
    part.tables.append(Table(
        "watt", "Watt's tests", ["n_s, beams of a light", "n_d, diffuse polygons", "n_l, lights", "tests of beam with polygon", "over n_s n_d n_l",
                                 "tree: tests of one small picture"], rows,
        "experiments/scenes/pool_area.json: points of an area light serve as lights; beams of reflection and refraction. The tests are n_s n_d n_l "
        "by construction, and the claims are judged by them; the power of the CPU time that they take stands beside. The tree's tests are of a "
        "picture of 32 x 24 points; Watt's have to be done once for any picture."))
    return part


def watts_powers(trials):
    """How the tests of beams with all polygons grow with each of the three numbers; beside them their CPU time, one sample a repeat."""
    def of(**wanted):
        usual = {"cells": 32, "receiver_resolution": 8, "light_samples": 4}
        found = [trials.record(row) for row in trials.where(method="causticpolygons", **(usual | wanted))]
        return [each["phases"]["precompute/polygons"]["cpu"] for each in found], found[0]["counters"]

    measured = {}
    for name, less, more in (("n_s", of(), of(cells=64)), ("n_d", of(), of(receiver_resolution=16)), ("n_l", of(light_samples=1), of())):
        key = "receiver_polygons" if name == "n_d" else "beams"
        grown = more[1][key] / less[1][key]
        tests = [side[1]["beam_polygon_tests"] for side in (less, more)]
        measured[f"watt_{name}"] = counted(exponent([1, grown], tests), "", (
            f"{tests[0]:,} tests, and {tests[1]:,} with {short(grown)} times as many; {short(min(less[0]))} to {short(max(less[0]))} CPU s, and "
            f"{short(min(more[0]))} to {short(max(more[0]))}"))
        measured[f"watt_{name}"].beside = {"power of the CPU time": [exponent([1, grown], [a, b]) for a, b in zip(less[0], more[0])]}
    return measured


SECTIONS = {"counts": counts, "watt": watt}
