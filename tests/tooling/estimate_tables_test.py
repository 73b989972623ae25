"""tools/estimate_tables.py on records made by hand: a heat map for everything else that varies, and no silence.

Exits with 77 where matplotlib is missing.
"""
import csv
import itertools
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "estimate_tables.py"
sys.path.insert(0, str(ROOT / "tools"))

try:
    import matplotlib
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from report import estimate_heat_maps, records
from report.estimate_cells import Estimate
from report import record_plots

COLUMNS = ("trial", "status", "scene", "method", "seed", "repeat", "threads", "isa", "photons_stored", "nearest", "alpha",
           "mesh_resolution", "render_cpu_s", "total_s", "rmse", "relmse", "mean_ratio", "reference_stderr",
           "reference_mean", "code_version", "photons", "filter", "estimator", "adaptive")


def row(photons, nearest, alpha="", filter="", estimator="", adaptive="", relmse=None, mesh=""):
    """A trial whose sqrt(relmse) tells which one it is."""
    error = relmse or 1e-6 * photons + 1e-3 * (nearest or 7) + float(alpha or 0)
    trial = "-".join(map(str, (photons, nearest, alpha, filter, estimator, adaptive, mesh)))
    return dict(zip(COLUMNS, [trial, "done", "ring", "photonmap", "1", "1", "1", "plain", "",
                              str(nearest or ""), str(alpha), mesh, "1", "1", "0.1", repr(error ** 2), "1", "0.01", "1", "v",
                              str(photons), filter, estimator, adaptive]))


class EstimateTables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.font_cache = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.font_cache.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_tool(self, rows):
        with open(self.folder / "records.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
        return subprocess.run([sys.executable, TOOL, self.folder], capture_output=True, text=True, cwd=self.folder,
                              env={**os.environ, "MPLCONFIGDIR": self.font_cache.name})

    def maps(self, rows):
        done = self.run_tool(rows)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, sorted(path.name for path in (self.folder / "report").glob("heat_map-*.svg"))

    def test_each_alpha_has_a_map_of_its_own(self):
        product = itertools.product((1000, 10000), (20, 60), ("1", "0.1"))
        output, maps = self.maps([row(p, n, alpha=a, filter="none") for p, n, a in product])
        self.assertEqual(maps, ["heat_map-ring-alpha-0.1.svg", "heat_map-ring-alpha-1.svg"])
        self.assertIn("left out: filters.md", output)

    def test_each_mesh_and_filter_has_a_map_of_its_own(self):
        product = itertools.product((1000, 10000), (20, 60), ("", "cone"), ("4", "16"))
        _, maps = self.maps([row(p, n, filter=f, mesh=m) for p, n, f, m in product])
        self.assertEqual(maps, [f"heat_map-ring-mesh_resolution-{m}-filter-{f}.svg" for m in (16, 4) for f in ("cone", "none")])

    def test_one_estimator_keeps_the_scenes_name(self):
        rows = [row(p, n, filter="epanechnikov") for p in (1000, 10000) for n in (20, 60)]
        rows += [row(p, None, filter="epanechnikov", adaptive="true") for p in (1000, 10000)]
        output, maps = self.maps(rows + [row(1000, n, filter="cone") for n in (20, 60)])
        self.assertEqual(maps, ["heat_map-ring.svg"])
        self.assertIn("heat map of ring, filter cone (a map wants two of each: 1 numbers of photons)", output)
        table = (self.folder / "report" / "adaptive.md").read_text(encoding="utf-8")
        self.assertIn("## ring, filter epanechnikov", table)
        self.assertIn("| 1000 | 20 | 0.021 | 0.008 | 0.38 |", table)

    def test_the_tables_do_not_choose_between_alphas(self):
        rows = [row(100000, n, alpha=a, filter="none", estimator=e) for n in (20, 60) for a in ("1", "0.1") for e in ("raw", "")]
        self.maps(rows)
        table = (self.folder / "report" / "filters.md").read_text(encoding="utf-8")
        self.assertEqual(re.findall("## (.*)", table), ["ring, alpha 0.1", "ring, alpha 1"])
        self.assertIn("| raw | none | 20 | 1.120 |", table)

    def test_repeats_are_no_seeds(self):
        """A seed that ran three times counts once in an error; every run's time counts."""
        trials = [{**row(1000, 20, relmse=error), "rmse": repr(error), "seed": seed, "repeat": repeat, "render_cpu_s": seconds,
                   "indirect_cpu_s": "10"}
                  for seed, repeat, error, seconds in (("1", "1", 0.1, "1"), ("1", "2", 0.1, "2"), ("1", "3", 0.1, "3"),
                                                       ("2", "1", 0.3, "4"), ("3", "1", 0.5, "5"))]
        cell = Estimate(records.Cell("ring", "photonmap", {"photons": "1000"}, trials))
        self.assertAlmostEqual(cell.error, 0.3)
        self.assertAlmostEqual(cell.square, (0.01 + 0.09 + 0.25) / 3)
        self.assertEqual(cell.seconds, 13)

    def test_nothing_to_draw_is_an_error_with_its_reason(self):
        done = self.run_tool([row(1000, 20), row(1000, 60)])
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("1 numbers of photons", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertFalse((self.folder / "report").exists() or (self.folder / "results").exists())

    def test_a_place_taken_twice_is_an_error(self):
        class Cell:
            photons, nearest, adaptive, parameters = 1000, 20, False, {"alpha": "1"}
        with self.assertRaisesRegex(estimate_heat_maps.RecordsError, "two cells with 1000 photons and N 20"):
            estimate_heat_maps.draw("ring", [Cell(), Cell()])


class Ticks(unittest.TestCase):
    def test_a_log_axis_has_several_labels(self):
        for low in (0.013, 0.5, 0.99, 1.01, 3.3, 47):
            for ratio in (1.3, 2, 4, 10, 30, 60, 99, 101, 1e4):
                ticks = record_plots.nice_log_ticks(low, low * ratio)
                self.assertGreaterEqual(len(ticks), 2, (low, ratio))
                self.assertLessEqual(len(ticks), 9, (low, ratio))
                self.assertTrue(all(low <= tick * (1 + 1e-9) and tick <= low * ratio * (1 + 1e-9) for tick in ticks), ticks)
        self.assertEqual(record_plots.nice_log_ticks(0.9, 60), [1, 2, 5, 10, 20, 50])
        self.assertEqual(record_plots.nice_log_ticks(0.5, 2e3), [1, 10, 100, 1000])


class Interpreter(unittest.TestCase):
    def test_the_tools_agree(self):
        """Debian's Python, which alone sees Debian's packages, whatever another one is first in PATH."""
        first = {path.name: path.read_text(encoding="utf-8").splitlines()[0] for path in (ROOT / "tools").iterdir()
                 if path.is_file()}
        wrong = {name: line for name, line in first.items() if line.startswith("#!") and "python" in line
                 and line != "#!/usr/bin/python3"}
        self.assertEqual(wrong, {})

    def test_what_has_an_interpreter_can_be_run(self):
        files = [path for path in (ROOT / "tools").rglob("*") if path.is_file() and path.suffix != ".pyc"]
        first = {path: path.read_bytes()[:2] == b"#!" for path in files}
        self.assertEqual([path.name for path, runs in first.items() if runs != os.access(path, os.X_OK)], [])


if __name__ == "__main__":
    unittest.main()
