"""The duel without rendering: its statistics against closed forms, its sweeps, and committed pages that follow from their records."""
import json
import math
import pathlib
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

try:
    import numpy as np
    import scipy  # noqa: F401  (intervals)
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from duel import contests, curves, measures, race, scores, truth, verdicts
from papers.verdict import FAILS, HOLDS, UNDECIDED, UNMEASURED

DUEL = contests.Duel()
RESULTS = ROOT / "results" / "duel"


def cell(label, seconds, squares, noise=0.0, **param):
    setting = contests.Setting(label, label, "points", 4, None, tuple(sorted(param.items())))
    rows = [{"build_s": seconds / 2, "query_s": seconds / 2, "relmse": square, "relmse_noise": noise, "seed": i, "map_bytes": 1e6 * seconds}
            for i, square in enumerate(squares)]
    return curves.Cell(setting, rows)


class Statistics(unittest.TestCase):
    def test_the_bootstrap_of_a_mean_is_students_interval(self):
        """The bootstrap's variance of a mean is (n - 1) / n of the estimate's: widened by n / (n - 1) it is Student's."""
        values = np.array([1.0, 1.1, 0.95, 1.02, 1.07])
        made = cell("a", 1, values ** 2)
        means = values[curves.draws(5)].mean(axis=1)
        _, low, high = curves.interval(means[0], means[1:], 5)
        half = 2.776445 * values.std(ddof=1) / math.sqrt(5)
        self.assertAlmostEqual(math.log(high / low) / 2, half / values.mean(), delta=0.15 * half)
        self.assertEqual(len(made.errors), curves.RESAMPLES + 1)

    def test_the_interval_covers_the_truth(self):
        """Means of 5 normal logarithms: 95 % of 400 intervals, by the binomial's 4 standard deviations."""
        random = np.random.default_rng(5)
        picks = curves.draws(5)
        hits = 0
        for _ in range(400):
            values = np.exp(random.normal(0, 0.05, 5))
            means = np.exp(np.log(values)[picks].mean(axis=1))
            _, low, high = curves.interval(means[0], means[1:], 5)
            hits += low <= 1 <= high
        self.assertGreater(hits, 400 * 0.95 - 4 * math.sqrt(400 * 0.95 * 0.05))

    def test_a_ratio_of_two_methods_is_exact_without_scatter(self):
        field = curves.Field([cell("photonmap", 1, [0.04] * 5), cell("photonmap", 4, [0.01] * 5), cell("beamtree", 1, [0.01] * 5)])
        found = curves.quantity(field.seeds, lambda draw: measures.errors_at(field, draw, 2.0))
        self.assertAlmostEqual(found[0], math.sqrt(2))  # halfway of a power -1/2 between 0.2 and 0.1
        self.assertAlmostEqual(found[1], found[2])
        self.assertAlmostEqual(measures.factor_at_least_common(field)[0], 4)
        value, low, high = measures.times_with_bound(curves.Field([cell("photonmap", 2, [0.04] * 5), cell("beamtree", 1, [0.01] * 5)]), 0.1001)
        self.assertEqual((value, low, high), (2, 2, math.inf))

    def test_the_truths_own_error_is_taken_off(self):
        self.assertAlmostEqual(curves.error_of(0.05 ** 2 + 0.03 ** 2, 0.03 ** 2), 0.05)
        self.assertAlmostEqual(curves.error_of(0.9 * 0.03 ** 2, 0.03 ** 2), 0.015)  # no better than half of it

    def test_fronts_hold_what_nothing_faster_beats(self):
        self.assertEqual(curves.front([(3, 0.2), (1, 0.5), (2, 0.6), (4, 0.1)]), [(1, 0.5), (3, 0.2), (4, 0.1)])
        self.assertIsNone(curves.at_time([(1, 0.5)], 0.9))
        self.assertEqual(curves.at_time([(1, 0.5)], 9), 0.5)
        self.assertIsNone(curves.at_error([(1, 0.5)], 0.4))
        self.assertEqual(curves.at_error([(1, 0.5)], 0.6), 1)

    def test_a_search_keeps_the_ends_and_what_gains_a_tenth(self):
        cells = [cell("a", seconds, [error ** 2]) for seconds, error in ((1, 1.0), (2, 0.95), (3, 0.5), (4, 0.3), (5, 0.29), (6, 0.1))]
        kept = lambda most: [each.seconds() for each in curves.chosen(cells, most)]
        self.assertEqual(kept(9), [1, 3, 4, 6])
        self.assertEqual(kept(3), [1, 4, 6])

    def test_seeds_come_from_the_pilots_scatter(self):
        self.assertEqual(race.wanted_seeds(0.01, 0.1, 5, 9), 5)
        self.assertEqual(race.wanted_seeds(0.1, 0.1, 5, 9), 7)  # t(6) = 2.447: 0.0925 < log 1.1 = 0.0953 < t(5) 0.1 / sqrt 6
        self.assertEqual(race.wanted_seeds(1, 0.1, 5, 9), 9)

    def test_scores_are_the_programs(self):
        """relmse by hand on two pixels, and noise from the truth's standard error."""
        r = np.array([[[1.0] * 3, [3.0] * 3]])
        about = scores.Truth(r, np.array([[0.1, 0.2]]), np.ones((1, 2), bool))
        relmse, noise, rmse, rmse_noise, mean, ratio = about.score(np.array([[[1.5] * 3, [3.0] * 3]]), np.ones((1, 2), bool))
        self.assertAlmostEqual(relmse, 0.5 * 0.25 / (1 + 0.04))
        self.assertAlmostEqual(noise, 0.5 * (0.01 / 1.04 + 0.04 / 9.04))
        self.assertAlmostEqual(rmse, math.sqrt(0.125))
        self.assertAlmostEqual(rmse_noise, math.sqrt(0.025))
        self.assertEqual((mean, ratio), (2, 1.125))

    def test_folds_of_a_closed_form(self):
        """x -> x^2 - 1/4 folds at x = 0: the line at place 40 of 100 pixels."""
        class Water:
            half_size = (1, 1)

            def rays(self, x, y):
                return None, (100 * (0.4 + 0.5 * x * x), 50 + 49 * y), None
        away = truth.fold_distance(Water(), 100, 801)
        self.assertAlmostEqual(float(away[50, 40]), 0.5, delta=0.2)
        self.assertAlmostEqual(float(away[50, 70]), 30.5, delta=0.2)


class Verdicts(unittest.TestCase):
    def judge(self, region, *cases):
        return verdicts.judge({"region": region}, [verdicts.Case(f"c{i}", *each) for i, each in enumerate(cases)])[0]

    def test_a_case_outside_refutes_and_a_bound_counts(self):
        self.assertEqual(self.judge({"above": 2}, (3, 2.5, 3.5), (4, 4, math.inf)), HOLDS)
        self.assertEqual(self.judge({"above": 2}, (3, 2.5, 3.5), (1, 0.9, 1.1)), FAILS)
        self.assertEqual(self.judge({"above": 2}, (3, 1.5, 3.5)), UNDECIDED)
        self.assertEqual(self.judge({"below": 2}, (3, 3, math.inf)), FAILS)
        self.assertEqual(self.judge({"cases": {"c0": {"above": 1}, "c1": {"below": 1}}}, (2, 1.5, 3), (0.5, 0.4, 0.6)), HOLDS)
        self.assertEqual(self.judge({"above": 2}), UNMEASURED)


class Contests(unittest.TestCase):
    def test_every_hypothesis_has_a_measure_and_names_its_scenes(self):
        names = {scene.name for scene in DUEL.scenes} | {f"counts_{name}" for name in ("casters", "lights", "floor", "mirror", "photons")}
        for hypothesis in DUEL.hypotheses:
            self.assertTrue(callable(getattr(measures, hypothesis["id"])), hypothesis["id"])
            for key in ("question", "hypothesis", "says", "refuted_if", "metric", "region", "swept"):
                self.assertTrue(hypothesis[key], hypothesis["id"])
            if isinstance(hypothesis["scenes"], list):
                self.assertLessEqual(set(hypothesis["scenes"]), names, hypothesis["id"])

    def test_the_search_has_seeds_of_its_own(self):
        rules = DUEL.rules
        reported = set(range(rules["first_seed"], rules["first_seed"] + rules["most_seeds"]))
        self.assertFalse(reported & {*rules["search_seeds"], *rules["pilot_seeds"], rules["reference_seed"]})
        self.assertFalse({*rules["search_seeds"], *rules["pilot_seeds"]} & {rules["reference_seed"]})

    def test_settings_are_told_apart_and_found_again(self):
        for scene in DUEL.scenes:
            settings = DUEL.settings(scene)
            self.assertEqual(len({(each.label, each.text()) for each in settings}), len(settings), scene.name)
            for each in settings:
                row = {"trial": "t", "method": each.method, "spp": str(each.spp), "nearest": "", "mesh_resolution": ""}
                row |= {name: str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)
                        for name, value in each.param}
                if each.mesh is not None:
                    row[contests.mesh_column(scene, each)] = str(each.mesh)
                self.assertIs(contests.setting_of(row, settings, scene), each)

    def test_lengths_are_of_the_scenes_pixel(self):
        settings = [each for each in DUEL.settings(DUEL.scene("folded")) if "footprint" in dict(each.param)]
        self.assertEqual({dict(each.param)["footprint"] for each in settings}, {DUEL.scene("folded").pixel})
        self.assertEqual({each.asks for each in settings}, {"the pixel"})
        self.assertFalse([each for each in DUEL.settings(DUEL.scene("ring")) if "footprint" in dict(each.param)])

    def test_the_pools_pixel_is_what_the_camera_sees(self):
        for name in ("folded", "calm", "million", "folded160"):
            scene = DUEL.scene(name)
            sensor = scene.resolved()["sensor"]
            look = sensor["to_world"][0]["look_at"]
            side = 2 * (look["origin"][2] + 1) * math.tan(math.radians(sensor["fov"]) / 2) / scene.size[0]
            self.assertAlmostEqual(scene.pixel, side, 5, name)


@unittest.skipUnless((RESULTS / "verdicts.json").is_file(), "no duel has been run")
class Pages(unittest.TestCase):
    """What is committed in results/duel follows from its records."""

    @classmethod
    def setUpClass(cls):
        from duel import page

        cls.results = page.Records(DUEL, RESULTS)
        cls.texts = page.rendered(cls.results)

    def test_pages_and_tables_follow_from_the_records(self):
        for name, text in self.texts.items():
            self.assertEqual((RESULTS / name).read_text(encoding="utf-8"), text, name)

    def test_every_hypothesis_has_its_verdict(self):
        found = json.loads((RESULTS / "verdicts.json").read_text(encoding="utf-8"))
        self.assertEqual([entry["id"] for entry in found], [each["id"] for each in DUEL.hypotheses])
        for entry in found:
            self.assertEqual(entry["verdict"] == UNMEASURED, not entry["cases"], entry["id"])

    def test_reported_settings_are_those_that_the_search_chose(self):
        for name, field in self.results.fields.items():
            chosen = {tuple(each) for each in json.loads((RESULTS / "chosen" / f"{name}.json").read_text(encoding="utf-8"))}
            reported = {(each.label, each.setting.text()) for each in field.cells}
            lost = {(row["label"], row["settings"]) for row in self.results.left_out if row["scene"] == name}
            self.assertEqual(chosen - reported, chosen & lost, f"{name}: only what has no result is not reported")
            self.assertLessEqual(reported, chosen, name)
            fronts = {(each.label, each.setting.text()) for each in race.fronts(self.results.searched[name], DUEL)}
            self.assertEqual(chosen, fronts, name)

    def test_no_trial_was_left_out_of_the_reported_seeds(self):
        seeds = json.loads((RESULTS / "pilot.json").read_text(encoding="utf-8"))["seeds"]
        for name, field in self.results.fields.items():
            for each in field.cells:
                self.assertEqual(len(each.rows), seeds, f"{name}: {each.setting.text()}")

    def test_plots_are_there_and_the_page_shows_only_those(self):
        for name in self.results.fields:
            self.assertTrue((RESULTS / "plots" / f"{name}.png").is_file(), name)
        for link in re.findall(r"\]\(([\w./-]+)\)", self.texts["README.md"]):
            self.assertTrue((RESULTS / link).exists(), link)

    def test_no_page_names_a_path_of_a_machine(self):
        for name, text in self.texts.items():
            self.assertNotIn(str(ROOT), text, name)
        self.assertNotRegex(self.texts["README.md"], r"\{[a-z_0-9]+\}")


class CommandLine(unittest.TestCase):
    def run_tool(self, *words):
        return subprocess.run([sys.executable, ROOT / "tools" / "measure_duel.py", *words], capture_output=True, text=True)

    def test_unknown_scenes_and_missing_programs_are_named(self):
        done = self.run_tool("--only", "nowhere")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertIn("known: ring, folded", done.stderr)
        done = self.run_tool("--quick", "--program", "/nowhere/causticbench")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))


if __name__ == "__main__":
    unittest.main()
