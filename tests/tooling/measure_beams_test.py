"""tools/measure_beams.py without a sweep: exponents, ratios and marks by hand."""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

from report import beam_report
from report import beam_trials
import measure_beams
from report import records
from report import rest_report


def cell(method="beamtree", parameters=None, counters=None, render=1.0, build=0.5):
    phase = "precompute/polygons" if method == "causticpolygons" else "precompute/tree"
    spread = lambda seconds: records.Spread(seconds, seconds, seconds)
    return beam_trials.Measured("pool", method, parameters or {}, {"camera_rays": 1000, **(counters or {})}, 10**6,
                                {"render": spread(render), phase: spread(build)})


def counted(ratio, **parameters):
    counters = {name: round(ratio * paper) for name, paper in zip(beam_report.COUNTS, beam_report.PAPER)}
    defaults = {"polygons": "triangles", "resolution": "61", "bound": "hybrid", "merging": "rays", "wave_height": "2"}
    return cell(parameters={**defaults, **parameters}, counters={"polygons": 7442, **counters})


class Tables(unittest.TestCase):
    def test_exponents(self):
        self.assertAlmostEqual(beam_trials.exponent([1, 2, 4, 8], [3, 12, 48, 192]), 2)
        self.assertAlmostEqual(beam_trials.exponent([5, 7, 11], [4, 4, 4]), 0)

    def test_time_a_point_is_that_beyond_the_eye_pass(self):
        self.assertAlmostEqual(beam_trials.microseconds(cell(render=1.5), cell("none", render=1.0)), 500)

    def test_counts_within_a_factor_of_two_are_marked(self):
        for ratio, near in ((0.4, False), (0.51, True), (1.9, True), (2.1, False)):
            self.assertIs(beam_report.is_near_the_paper(counted(ratio)), near)
        text = beam_report.counts([counted(3, wave_height="3"), counted(1, wave_height="1")])
        rows = text.splitlines()
        self.assertIn("1,293,973", rows[2])
        self.assertIn("1,293,973 (**1.00**)", rows[3])
        self.assertIn("3,881,919 (3.00)", rows[4])

    def test_the_hybrids_thresholds_come_in_order(self):
        tests = {name: 5000 for name in beam_report.COUNTS}
        cells = [cell(parameters={"bound": bound}, counters=tests) for bound in beam_report.BOUNDS]
        cells += [cell(parameters={"bound": "hybrid", "spread_threshold": t}, counters=tests) for t in ("10", "5")]
        rows = beam_report.bounds(cells + [cell("none", render=0.9)]).splitlines()
        self.assertEqual([row.split("|")[2].strip() for row in rows[6:]], ["5°", "10°"])
        self.assertIn("| 5 | 5 | 5 | 100.00 | 500 | 1.00 |", rows[2])

    def test_watts_cost_grows_with_each_number(self):
        made = lambda n: cell("causticpolygons", {"resolution": str(n), "receiver_resolution": str(n), "light_samples": str(n)},
                              {"polygons": n, "receiver_polygons": n, "beams": n, "beam_polygon_tests": 7 * n,
                               "caustic_polygons": n, "beam_point_tests": 1000 * n}, build=float(n * n))
        text = beam_report.watt([[made(2), made(4), made(8)]] * 3)
        for axis in beam_report.AXES:
            self.assertIn(f"| causticpolygons | {axis.symbol} ({axis.words}) | 1.00 | 2.00 | 1.00 |", text)


class Page(unittest.TestCase):
    def test_blocks_are_replaced_and_missing_ones_named(self):
        page = "a\n<!-- one -->\nold\n<!-- end of one -->\nb\n"
        self.assertEqual(measure_beams.fill(page, {"one": "new"}), page.replace("old", "new"))
        with self.assertRaisesRegex(records.RecordsError, "two"):
            measure_beams.fill(page, {"two": "new"})

    def test_the_page_has_every_mark(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        page = (root / "results" / "beamtree" / "README.md").read_text(encoding="utf-8")
        names = ("machine", "counts", "bounds pool", "bounds ring", "height", "watt")
        measure_beams.fill(page, {name: "" for name in names})
        for name in measure_beams.SWEEPS:
            self.assertTrue((root / "experiments" / "sweeps" / f"beam_{name}.json").exists(), name)


def map_trial(count, seconds, rmse):
    return {"method": "photonmap", "photons": count, "nearest": "60", "seed": "1", "precompute_cpu_s": seconds, "rmse": rmse, "relmse": float(rmse) ** 2, "mean_ratio": "1.0",
            "reference_stderr": "0.01", "scene": "bowl"}


def beam_trial(rest, seconds, rmse):
    return {"method": "beamtree", "rest": rest, "seed": "1", "rest_photons_stored": "300", "max_beams": "50", "precompute_cpu_s": seconds / 2,
            "render_cpu_s": seconds / 2, "rmse": rmse, "relmse": 0.2, "mean_ratio": "0.9", "flux_share_captured": "0.7",
            "flux_share_pruned": "0.1", "flux_share_over_budget": "0.15"}


class CompletedBeams(unittest.TestCase):
    def lines(self, *rows):
        found = rest_report.table("bowl", [map_trial("1000", 1, "0.4"), map_trial("9000", 9, "0.1"), *rows])
        return [line for line in found.splitlines() if line.startswith("| beamtree")]

    def test_ratio_is_the_photon_maps_time_for_the_error(self):
        # 0.2 lies in the middle of 0.4 and 0.1 as powers go: 3 s.
        [line] = self.lines(beam_trial("photons", 6.0, "0.2"))
        self.assertIn("rest: photons | points | 50 | 300 stored | 0.900 | 0.250 | 0.300 | 6.00 | 0.2 | 0.2 | 0.5 |", line)

    def test_an_error_that_the_photon_map_never_had_gives_a_bound(self):
        [line] = self.lines(beam_trial("none", 3.0, "0.05"))
        self.assertIn("| ≥ 3 |", line)

    def test_seeds_of_one_setting_are_one_row(self):
        first, second = beam_trial("photons", 2.0, "0.3"), dict(beam_trial("photons", 4.0, "0.4"), seed="2")
        [line] = self.lines(dict(first, pixel_footprint="true"), dict(second, pixel_footprint="true"))
        self.assertIn("| averaged | 50 | 300 stored | 0.900 | 0.250 | 0.300 | 3.00 | 0.3536 |", line)

    def test_the_best_rows_are_told(self):
        text = rest_report.table("bowl", [map_trial("1000", 1, "0.4"), map_trial("9000", 9, "0.1"), beam_trial("photons", 6.0, "0.2"),
                                          beam_trial("none", 3.0, "0.05")])
        self.assertIn("their best rows: ≥ 3 in rmse,", text)

    def test_the_page_tells_seeds_and_rows(self):
        text = rest_report.page([map_trial("1000", 1, "0.4"), map_trial("2000", 2, "0.3")], "a machine")
        self.assertIn("Each row is of\n1 seeds", text)
        self.assertIn("the best of its 2 rows", text)

    def test_scene_and_noise_are_named(self):
        text = rest_report.table("bowl", [map_trial("1000", 1, "0.4")])
        self.assertIn("## bowl", text)
        self.assertIn("0.01", text)


if __name__ == "__main__":
    unittest.main()
