"""One cheap row of each table in results/ made anew from the sweep file that is kept for it: what it counts is the same.

Usage: committed_tables_test.py PROGRAM. A sweep that names too little, so that a default decides, changes its counts when
the default changes; here that shows. Times and errors are not compared.
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from report import beam_report
from report import beam_trials

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve() if __name__ == "__main__" else None
IDENTITY = ("scene", "method", "seed", "photons", "nearest", "alpha", "mesh_resolution", "adaptive", "intensity", "pixel_footprint", "emitted", "paths",
            "spp")
# Not map_bytes: what a tree takes is of the version that the records name.
COUNTED = ("photons_emitted", "photons_stored", "camera_rays", "beams", "nodes")


def timed(title):
    return "ms" in title or "µs" in title


def untimed(heading, row):
    return tuple(field for title, field in zip(heading, row) if not timed(title))


def table_of(mark):
    """The rows of results/beamtree's table of that name, without their times, by their heading."""
    page = (ROOT / "results" / "beamtree" / "README.md").read_text(encoding="utf-8")
    block = page.partition(f"<!-- {mark} -->\n")[2].partition("\n\n")[0].partition("<!--")[0]
    split = lambda line: [field.strip() for field in line.strip("|").split("|")]
    lines = block.splitlines()
    heading = split(lines[0])
    return heading, {untimed(heading, split(line)) for line in lines[2:]}


class CommittedTables(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def sweep(self, name, **filters):
        """The folder of the trials of a sweep that pass the filters; without its reference, which takes minutes."""
        own = json.loads((ROOT / "experiments" / "sweeps" / f"{name}.json").read_text(encoding="utf-8"))
        own.pop("reference", None)
        own["scenes"] = [str((ROOT / "experiments" / "sweeps" / scene).resolve()) for scene in own["scenes"]]
        own["repeats"] = 1
        (self.folder / "sweep.json").write_text(json.dumps(own))
        words = [word for key, value in filters.items() for word in ("--filter", f"{key}={value}")]
        out = tempfile.mkdtemp(dir=self.folder)  # a folder keeps what other filters of the same sweep chose
        done = subprocess.run([PROGRAM, "sweep", self.folder / "sweep.json", "-o", out, *words], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return out

    def beams(self, name, **filters):
        cell, = beam_trials.read(self.sweep(name, **filters))
        return cell

    def assert_is_a_row(self, mark, row):
        heading, rows = table_of(mark)
        self.assertIn(untimed(heading, row), rows)

    def test_the_papers_counts(self):
        cell = self.beams("beam_counts", wave_height=3, bound="hybrid", merging="rays")
        row = beam_report.counts([cell]).splitlines()[-1]
        self.assertEqual([cell.counters[name] for name in beam_report.COUNTS], [2224512, 96498, 13681])
        self.assert_is_a_row("counts", [field.strip() for field in row.strip("|").split("|")])

    def test_counts_of_quads(self):
        cell = self.beams("beam_counts_quads", resolution=75, wave_height=2)
        row = beam_report.counts([cell]).splitlines()[-1]
        self.assert_is_a_row("counts", [field.strip() for field in row.strip("|").split("|")])

    def test_the_reproduced_counts(self):
        folder = ROOT / "experiments" / "papers" / "sweeps"
        own = json.loads((folder / "chuang1995_counts.json").read_text(encoding="utf-8"))
        own["scenes"] = [str((folder / scene).resolve()) for scene in own["scenes"]]
        own["methods"] = own["methods"][:1]
        (self.folder / "sweep.json").write_text(json.dumps(own))
        filters = ("wave_height=1.5", "cells=[75,75]", "reflected=0", "merging=cones")
        words = [word for each in filters for word in ("--filter", each)]
        done = subprocess.run([PROGRAM, "sweep", self.folder / "sweep.json", "-o", self.folder / "out", *words], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "out" / "records.csv", newline="", encoding="utf-8") as file:
            row, = csv.DictReader(file)
        kept = json.loads((ROOT / "results" / "papers" / "chuang1995" / "tables.json").read_text(encoding="utf-8"))
        table, = [each for each in kept["tables"] if each["name"] == "counts"]
        old, = [each for each in table["rows"] if each[:5] == ["pool", "5,625 quads", "1.5", "alone", "cones"]]
        self.assertEqual([f"{int(float(row[name])):,}" for name in beam_report.COUNTS], [field.split()[0] for field in old[5:8]])

    def test_bounds(self):
        for place in ("pool", "ring"):
            cell = self.beams(f"beam_bounds_{place}", bound="sphere_swept")
            self.assert_is_a_row(f"bounds {place}", ["sphere_swept", "", *beam_report.point_costs(cell, cell)])

    def test_height(self):
        cell = self.beams("beam_height", bound="sphere_swept", resolution=4)
        self.assert_is_a_row("height", ["sphere_swept", f"{cell.counters['polygons']:,}", str(cell.counters["height"]),
                                        *beam_report.point_costs(cell, cell)])

    def test_watts_polygons(self):
        for axis, name, filters in zip(beam_report.AXES, ("ns", "nd", "nl"), (
                {"resolution": 8}, {"receiver_resolution": 4}, {"light_samples": 1})):
            cell = self.beams(f"beam_watt_{name}", method="causticpolygons", **filters)
            self.assert_is_a_row("watt", beam_report.watt_row(axis, cell))

    def assert_trials_are_kept(self, kept, sweeps, seed=1):
        """One trial of each sweep is made again and counts what the kept table says; parameters tell its row."""
        with open(ROOT / "results" / kept / "records.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        for name, filters in sweeps:
            folder = self.sweep(name, seed=seed, **filters)
            with open(pathlib.Path(folder, "records.csv"), newline="", encoding="utf-8") as file:
                row, = csv.DictReader(file)
            same = [old for old in table if all(old.get(key, "") == row.get(key, "") for key in IDENTITY)]
            self.assertEqual(len(same), 1, name)
            self.assertEqual({key: row[key] for key in COUNTED}, {key: same[0][key] for key in COUNTED}, name)

    def test_the_photon_maps_sweeps(self):
        few = {"photons": 10000}
        self.assert_trials_are_kept("photons-2026-11", (
            ("photons_ring", {**few, "alpha": 1, "nearest": 20}), ("photons_ring_area", few),
            ("photons_pool", {**few, "scene": "pool", "mesh_resolution": 4}), ("photons_ball", {**few, "nearest": 20})))

    def test_the_quick_start(self):
        self.assert_trials_are_kept("quickstart-2026-11", (
            ("quickstart_ring_1", {"method": "beamtree", "mesh_resolution": 16}),
            ("quickstart_ring_1", {"method": "causticpolygons", "mesh_resolution": 16}),
            ("quickstart_ring_1", {"method": "photonmap", "photons": 30000}),
            ("quickstart_pool", {"method": "beamtree", "intensity": "area", "pixel_footprint": "true"})), seed=2)


if __name__ == "__main__":
    unittest.main()
