"""tools/bench_peers.py without peers: its ratios by hand, its edits of exports, its splat, and that the committed page follows from its records."""
import math
import pathlib
import shutil
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import numpy as np

from peers import contest, contestants, page, scores, truths

RESULTS = ROOT / "results" / "bench"


def record(name, setting, seed, seconds, relmse, **more):
    return {"scene": "s", "contestant": name, "setting": setting, "phase": scores.FINAL, "seed": seed, "status": scores.DONE, "cpu_s": seconds,
            "relmse": relmse, "relmse_noise": 0.0, "mse": relmse, "mse_noise": 0.0, "mean_ratio": 1.0, "load": 1.0, **more}


class Ratios(unittest.TestCase):
    def test_ten_times_the_time_everywhere_is_ten(self):
        ours = [(0.1 * 2 ** i, 0.5 / 2 ** i) for i in range(6)]
        peer = [(10 * seconds, error) for seconds, error in ours]
        found = scores.common(ours, peer)
        self.assertAlmostEqual(found.value, 10)
        self.assertAlmostEqual(found.at, ours[-1][1])
        self.assertAlmostEqual(scores.common(peer, ours).value, 0.1)

    def test_a_peer_that_stops_early_is_asked_for_its_own_least_error_and_bounds_the_rest(self):
        ours, peer = [(0.5, 0.1), (1.0, 0.01)], [(4.0, 0.2), (8.0, 0.1)]
        self.assertAlmostEqual(scores.common(ours, peer).value, 16)
        later = scores.after_a_second(ours, peer)
        self.assertEqual((later.kind, later.at), ("bound", 0.01))
        self.assertAlmostEqual(later.value, 8)

    def test_the_law_draws_an_unbiased_peer_on_exactly(self):
        of = lambda error: 2 + 0.03 / error ** 2  # seconds
        found = scores.by_law([(0.5, 0.1), (1.0, 0.01)], [(of(error), error) for error in (0.3, 0.1)])
        self.assertAlmostEqual(found.value / of(0.01), 1)
        self.assertIsNone(scores.by_law([(1.0, 0.2)], [(of(error), error) for error in (0.3, 0.1)]))  # it was there

    def test_a_cell_takes_the_median_time_and_the_mean_square_without_the_truths_noise(self):
        rows = [record("povray", "a", seed, seconds, square, relmse_noise=0.01) for seed, seconds, square in ((1, 3.0, 0.05), (2, 1.0, 0.02), (3, 2.0, 0.08))]
        cell, = scores.cells(rows, "s", scores.FINAL)
        self.assertEqual(cell.seconds, 2)
        self.assertAlmostEqual(cell.error, math.sqrt(0.04))
        self.assertAlmostEqual(cell.range[0], 0.1)

    def test_a_setting_that_lacks_a_seed_or_a_picture_is_left_out(self):
        rows = [record("povray", "a", seed, 1.0, 0.1) for seed in (1, 2)] + [record("povray", "b", 1, 1.0, 0.1)]
        rows.append(record("povray", "b", 2, "", "", status="over 40 s"))
        self.assertEqual([cell.setting for cell in scores.cells(rows, "s", scores.FINAL)], ["a"])

    def test_ours_is_the_better_of_both_methods_and_the_range_that_of_the_seeds(self):
        rows = []
        for seed in (1, 2, 3):
            rows += [record("photonmap", "p", seed, 1.0, 0.04), record("beamtree", "b", seed, 2.0, 0.01), record("povray", "v", seed, 10.0 * seed, 0.04)]
        cells = scores.cells(rows, "s", scores.FINAL)
        self.assertEqual(scores.curve(cells, contest.OURS), [(1.0, 0.2), (2.0, 0.1)])
        found = scores.with_range(scores.common, cells, "povray")
        for value, wanted in ((found.value, 20), (found.low, 10), (found.high, 30)):
            self.assertAlmostEqual(value, wanted)

    def test_a_mark_counts_what_was_measured_apart_from_bounds(self):
        mark = {"peer": "povray", "least": 20, "scenes": 2, "among": ["a", "b", "c"]}
        ratios = {("a", "povray"): scores.Ratio(25, 0.1), ("b", "povray"): scores.Ratio(5, 0.1)}
        limits = {("a", "povray"): scores.Ratio(90, 0.01, "bound"), ("b", "povray"): scores.Ratio(21, 0.01, "bound")}
        self.assertEqual(scores.verdict(mark, ratios, limits), (["a"], ["b"]))

    def test_scores_by_hand(self):
        truth = truths.Truth(np.array([[1.0, 3.0], [9.0, 0.0]]), np.full((2, 2), 0.1), np.array([[True, True], [False, False]]))
        found = truth.score(np.array([[1.2, 3.0], [0.0, 7.0]]))
        self.assertAlmostEqual(found["relmse"], 0.04 / (1 + 0.04) / 2)
        self.assertAlmostEqual(found["mse"], 0.02 / 4)
        self.assertAlmostEqual(found["mean_ratio"], 4.2 / 4)


class Contest(unittest.TestCase):
    def setUp(self):
        self.held = contest.Contest()

    def test_reported_seeds_are_not_searched_and_marks_name_what_is_there(self):
        self.assertFalse(set(self.held.text["seeds"]) & set(self.held.text["search_seeds"]))
        self.assertGreaterEqual(len(self.held.text["seeds"]), 3)
        names = {scene.name for scene in self.held.scenes}
        for mark in self.held.text["marks"]:
            self.assertLessEqual(set(mark["among"]), names)
            self.assertIn(mark["peer"], self.held.names)

    def test_every_setting_has_its_own_name(self):
        for scene in self.held.scenes:
            for name in self.held.names:
                settings = self.held.settings(scene, name)
                self.assertEqual(len({contest.words(each) for each in settings}), len(settings))

    def test_the_cone_holds_the_caster_and_is_narrow(self):
        lamp = [-1.2, 0.4, 1.6]
        axis, angle = contest.cone({"sphere": [0, 0, 0.35, 0.3]}, lamp)
        exact = math.degrees(math.asin(0.3 / math.dist(lamp, (0, 0, 0.35))))
        self.assertGreater(angle, exact * 0.9999)
        self.assertLess(angle, exact * 1.01)

    def test_exports_of_another_kind_are_refused(self):
        scene = self.held.scenes[2]
        for edit in (contestants.povray_options, contestants.aimed_lamp):
            with self.assertRaises(ChildProcessError):
                edit("something else", scene)

    def test_the_lamp_is_aimed_and_the_floor_dark(self):
        given = ('<default name="spp" value="4"/> <integer name="rr_depth" value="$max_depth"/> <sampler type="stratified"> <boolean/> </sampler> '
                 '<emitter type="point"> <point name="position" value="0 0 1"/> </emitter> <rgb name="reflectance" value="0.5 0.5 0.5"/>')
        made = contestants.aimed_lamp(given, self.held.scenes[2])
        for wanted in ('type="spot"', '0.0005 0.0005 0.0005', 'type="independent"', 'value="$roulette"'):
            self.assertIn(wanted, made)
        self.assertNotIn("stratified", made)


@unittest.skipUnless(shutil.which("c++"), "no C++ compiler")
class Splat(unittest.TestCase):
    def test_the_pools_quadrature_and_the_splat_agree(self):
        scene = contest.Scene({**contest.Contest().scenes[1].text, "size": [16, 16]})
        with tempfile.TemporaryDirectory() as work:
            programs = contestants.Contestants("causticbench", None, pathlib.Path(work), 60)
            radiance, error = truths.made(contest.Scene({**scene.text, "truth": {"quadrature": 256}}), programs)
            splat = programs.trial("splat", scene, (("samples", 1000000),), 1)[1]
        self.assertAlmostEqual(splat.mean() / radiance.mean(), 1, delta=1e-3)
        self.assertLess(np.abs(splat - radiance).max() / radiance.mean(), 0.02)


class Committed(unittest.TestCase):
    def test_the_page_follows_from_its_records(self):
        self.assertEqual((RESULTS / "peers.md").read_text(encoding="utf-8"), page.text(page.Results(RESULTS)))

    def test_each_final_setting_was_found_by_the_search_and_ran_on_all_seeds(self):
        records = scores.read(RESULTS / "peers.csv")
        of = lambda phase: {(row["scene"], row["contestant"], row["setting"]) for row in records if row["phase"] == phase}
        self.assertLessEqual(of(scores.FINAL), of(scores.SEARCH))
        wanted = set(contest.Contest().text["seeds"])
        for key in of(scores.FINAL):
            seeds = {row["seed"] for row in records if (row["scene"], row["contestant"], row["setting"]) == key and row["phase"] == scores.FINAL}
            self.assertEqual(seeds, wanted, key)


if __name__ == "__main__":
    unittest.main()
