"""Verdicts against the kept records they are made from, read here without the tools that made them."""
import csv
import json
import math
import pathlib
import unittest

RESULTS = pathlib.Path(__file__).resolve().parents[2] / "results" / "papers"


class Records(unittest.TestCase):
    def rows(self, paper, name, **wanted):
        """Rows of a kept table that hold these values, by seed and repeat."""
        with open(RESULTS / paper / "records" / f"{name}.csv", newline="", encoding="utf-8") as file:
            found = [row for row in csv.DictReader(file) if all(row[key] == value for key, value in wanted.items())]
        self.assertTrue(found, (paper, name, wanted))
        return sorted(found, key=lambda row: (int(row["seed"]), int(row["repeat"])))

    def column(self, paper, name, column, **wanted):
        return [sum(float(row[each]) for each in column.split("+")) for row in self.rows(paper, name, **wanted)]

    def entry(self, paper, claim):
        entries = json.loads((RESULTS / paper / "verdicts.json").read_text(encoding="utf-8"))
        return next(entry for entry in entries if entry["id"] == claim)

    def values(self, paper, claim):
        return self.entry(paper, claim)["values"]

    def expect(self, paper, claim, wanted):
        found = self.values(paper, claim)
        self.assertEqual(len(found), len(wanted), claim)
        for a, b in zip(found, wanted):
            self.assertTrue(math.isclose(a, b, rel_tol=1e-5), f"{claim}: {a} is not {b}")

    def expect_ratio(self, paper, claim, name, column, top, bottom, **both):
        over = zip(self.column(paper, name, column, **top, **both), self.column(paper, name, column, **bottom, **both))
        self.expect(paper, claim, [a / b for a, b in over])

    def test_jensens_figure_1(self):
        ends = {"alpha": "0.01"}, {"alpha": "1"}
        self.expect_ratio("jensen1996", "ring_time", "figure1", "render_cpu_s", *ends, method="photonmap", max_samples="256")
        self.expect_ratio("jensen1996", "ring_fixed", "figure1_counts", "nodes_visited", *ends, max_samples="4")
        a_ray = lambda alpha: [nodes / rays for nodes, rays in zip(*(self.column("jensen1996", "figure1_counts", column, alpha=alpha, max_samples="256")
                                                                     for column in ("nodes_visited", "camera_rays")))]
        self.expect("jensen1996", "ring_reason", [a / b for a, b in zip(a_ray("0.01"), a_ray("1"))])
        for alpha, before in (("0.5", "1"), ("0.1", "0.5"), ("0.01", "0.1")):
            for claim, column in (("ring_time", "render_cpu_s"), ("ring_rays", "camera_rays")):
                self.expect_ratio("jensen1996", f"{claim}_{alpha}", "figure1", column, {"alpha": alpha}, {"alpha": before}, method="photonmap", max_samples="256")

    def test_jensens_figure_2(self):
        few, many = "250677", "5036126"
        tree = lambda photons, kind: {"photons": photons, "tree": kind}
        for end, order in (("", "random"), ("_strata", "stratified")):
            for claim, top, bottom in (("ball_unbalanced", tree(few, "unbalanced"), tree(few, "balanced")),
                                       ("ball_unbalanced_many", tree(many, "unbalanced"), tree(many, "balanced")),
                                       ("ball_growth", tree(many, "balanced"), tree(few, "balanced"))):
                self.expect_ratio("jensen1996", f"{claim}{end}", "figure2_orders", "nodes_visited", top, bottom, emission=order)
            nodes = [self.column("jensen1996", "figure2_orders", "nodes_visited", emission=order, **tree(many, kind)) for kind in ("balanced", "unbalanced")]
            self.expect("jensen1996", f"ball_saved{end}", [1 - a / b for a, b in zip(*nodes)])
        both = {"method": "photonmap"}
        self.expect_ratio("jensen1996", "ball_preprocess", "figure2", "precompute_cpu_s+balance_cpu_s", tree(many, "balanced"), tree(few, "balanced"), **both)
        self.expect("jensen1996", "ball_megabytes", [self.column("jensen1996", "figure2", "map_bytes", **tree(many, "balanced"), **both)[0] / 1e6])

    def test_chuangs_counts(self):
        pool = {"method": "beamtree", "cells": "[75,101]", "merging": "cones", "reflected": "0"}
        rows = sorted(self.rows("chuang1995", "counts", **pool), key=lambda row: float(row["wave_height"]))
        sweep = json.loads((RESULTS.parents[1] / "experiments" / "papers" / "sweeps" / "chuang1995_counts.json").read_text(encoding="utf-8"))
        heights = sweep["set"]["wave_height"]["values"]
        self.assertEqual([float(row["wave_height"]) for row in rows], heights)
        self.assertLess(min(heights), 1.5, "the claims are judged on both sides of the heights at which they hold")
        self.assertGreater(max(heights), 3)
        for count in ("cone_point_tests", "beam_point_tests", "beam_point_hits"):
            self.expect("chuang1995", f"count_{count}", [float(row[count]) for row in rows])
        self.expect("chuang1995", "cones_a_beam", [float(row["cone_point_tests"]) / float(row["beam_point_tests"]) for row in rows])

    def test_chens_searches(self):
        bare = self.column("chen2011", "tree", "render_cpu_s", method="none")
        most = max((row["nearest"] for row in self.rows("chen2011", "tree") if row["nearest"]), key=int)
        less = lambda photons: [a - b for a, b in zip(self.column("chen2011", "tree", "render_cpu_s", photons=photons, nearest=most), bare)]
        beside = self.entry("chen2011", "logarithmic")["beside"]["CPU time of the searches, more over fewer photons"]["values"]
        visited = lambda photons: self.column("chen2011", "tree", "nodes_visited", photons=photons, nearest=most)[0]
        self.expect("chen2011", "logarithmic", [visited("1000000") / visited("10000")])
        for found, a, b in zip(beside, less("1000000"), less("10000"), strict=True):
            self.assertTrue(math.isclose(found, a / b, rel_tol=1e-5))

    def test_chens_filters_are_judged_at_the_studys_n(self):
        several = sorted({row["nearest"] for row in self.rows("chen2011", "filters") if row["nearest"]}, key=int)
        for kind in ("cone", "gaussian"):
            self.expect_ratio("chen2011", f"filter_{kind}", "filters", "mask_rmse", {"filter": kind}, {"filter": "none"}, nearest="100")
            note = self.entry("chen2011", f"filter_{kind}")["note"]
            self.assertEqual([n for n in several if f"at N = {n}" not in note], [], "every N is shown")

    def test_chens_light_is_scored_against_light_tracing(self):
        tables = json.loads((RESULTS / "chen2011" / "tables.json").read_text(encoding="utf-8"))["tables"]
        headings = {table["name"]: " ".join(table["heading"]) for table in tables}
        self.assertNotIn("over photons", " ".join(headings.values()))
        for name in ("bowls", "events", "peers"):
            self.assertIn("over light tracing", headings[name])

    def test_watts_powers_are_of_tests(self):
        usual = {"method": "causticpolygons", "repeat": "1"}
        heading = self.rows("chuang1995", "watt", **usual)[0]
        self.assertIn("receiver_resolution", heading)
        for name in ("watt_n_s", "watt_n_d", "watt_n_l"):
            entry = self.entry("chuang1995", name)
            self.assertEqual((entry["verdict"], entry["counted"], list(entry["beside"])), ("by construction", True, ["power of the CPU time"]))

    def test_every_sweep_that_is_named_is_kept(self):
        for folder in sorted(RESULTS.glob("*/records")):
            commands = " ".join(entry["command"] for entry in json.loads((folder.parent / "verdicts.json").read_text(encoding="utf-8")))
            named = {pathlib.PurePath(word).name for word in commands.split() if "/trials/" in word and not word.endswith((".exr", ".csv"))}
            swept = {name for name in named if f"sweeps/{folder.parent.name}_{name}.json" in commands}
            self.assertEqual({name for name in swept if not (folder / f"{name}.csv").is_file()}, set(), folder)
            for file in folder.glob("*.csv"):
                self.assertNotIn(str(pathlib.Path(__file__).resolve().parents[2]), file.read_text(encoding="utf-8"), file)


if __name__ == "__main__":
    unittest.main()
