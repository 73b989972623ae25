"""The duel without rendering: its statistics against closed forms, its sweeps, and committed pages that follow from their records."""
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "tooling")]

try:
    import numpy as np
    import scipy  # noqa: F401  (intervals)
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from duel import contests, folds, measures, race, scores, truth
from duel_statistics import Bounds, Curves, Intervals, Truths, Verdicts, cell  # noqa: F401  (they run here)
from papers.verdict import UNMEASURED

DUEL = contests.Duel()
RESULTS = ROOT / "results" / "duel"


class Scores(unittest.TestCase):
    def test_seeds_come_from_the_pilots_scatter(self):
        self.assertEqual(race.wanted_seeds(0.01, 0.1, 5, 9), 5)
        self.assertEqual(race.wanted_seeds(0.1, 0.1, 5, 9), 7)  # t(6) = 2.447: 0.0925 < log 1.1 = 0.0953 < t(5) 0.1 / sqrt 6
        self.assertEqual(race.wanted_seeds(1, 0.1, 5, 9), 9)

    def test_the_pilot_asks_by_its_upper_quartile(self):
        """Deviations of 0.1, 0.2 ... 0.5 of the mean square: a quarter scatters by more than 0.4, half of it in the error."""
        deviations = (0.1, 0.2, 0.3, 0.4, 0.5)
        cells = [cell("a", 1, [1 - each / math.sqrt(2), 1 + each / math.sqrt(2)]) for each in deviations]
        self.assertAlmostEqual(race.upper_scatter(cells), 0.2)
        rules = {"half_interval": 0.1, "least_seeds": 5, "most_seeds": 30}
        self.assertEqual(race.wanted_of([cells, cells[:1]], rules), race.wanted_seeds(0.2, 0.1, 5, 30))

    def test_a_jackknifed_ratio_of_known_biases(self):
        """Pictures off by 0.2 and by 0.1 everywhere, without noise and with noise that cancels in the products of two seeds."""
        whole = np.ones((4, 4), bool)
        flat = lambda bias, noise: np.random.default_rng(int(10 * bias)).normal(bias, noise, (6, 4, 4))
        alone = lambda made: folds.rms_bias(made, whole)
        value, low, high = folds.jackknifed(alone, flat(0.2, 0), flat(0.1, 0))
        self.assertAlmostEqual(value, 2)
        self.assertAlmostEqual(low, high)
        value, low, high = folds.jackknifed(alone, flat(0.2, 0.02), flat(0.1, 0.01))
        self.assertTrue(1.8 < value < 2.2 and low < value < high, (low, value, high))

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


class Contests(unittest.TestCase):
    def test_every_hypothesis_has_a_measure_and_names_its_scenes(self):
        names = {scene.name for scene in DUEL.scenes} | {f"counts_{name}" for name in ("casters", "lights", "floor", "mirror", "photons")}
        for hypothesis in DUEL.hypotheses:
            self.assertTrue(callable(measures.function_of(hypothesis["id"])), hypothesis["id"])
            for key in ("question", "hypothesis", "says", "refuted_if", "metric", "region", "swept"):
                self.assertTrue(hypothesis[key], hypothesis["id"])
            if isinstance(hypothesis["scenes"], list):
                self.assertLessEqual(set(hypothesis["scenes"]), names, hypothesis["id"])

    def test_the_search_has_seeds_of_its_own(self):
        rules = DUEL.rules
        reported = set(range(rules["first_seed"], rules["first_seed"] + rules["most_seeds"]))
        self.assertFalse(reported & {*rules["search_seeds"], rules["reference_seed"]})
        self.assertFalse({*rules["search_seeds"]} & {rules["reference_seed"]})

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
        around = [each for each in DUEL.settings(DUEL.scene("ring")) if "footprint" in dict(each.param)]
        self.assertEqual({(each.method, each.asks) for each in around}, {("photonmap", "squares round points")})

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

    def test_pages_of_one_scene_say_which_and_name_the_rest_as_not_measured(self):
        from duel import page

        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "records").mkdir()
            for file in (RESULTS / "records").glob("folded_*.csv"):
                shutil.copy(file, pathlib.Path(folder) / "records")
            text = page.rendered(page.Records(DUEL, pathlib.Path(folder)))["README.md"]
        self.assertIn("**This run has 1 of 20 scenes: folded pool.**", text)
        self.assertNotIn("nan", text.split())
        self.assertNotIn("This run has", self.texts["README.md"])

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
            by_the_search = {(each.label, each.setting.text()) for each in race.fronts(self.results.searched[name], DUEL)}
            self.assertEqual(chosen, by_the_search, name)

    def test_no_trial_was_left_out_of_the_reported_seeds(self):
        """Every chosen setting on every seed is in the records, or is left out by name."""
        seeds = range(1, json.loads((RESULTS / "pilot.json").read_text(encoding="utf-8"))["seeds"] + 1)
        lacking = {}
        for path in sorted((RESULTS / "records").glob("*_final.csv")):
            name = path.stem.removesuffix("_final")
            chosen = {tuple(each) for each in json.loads((RESULTS / "chosen" / f"{name}.json").read_text(encoding="utf-8"))}
            done = {(row["label"], row["settings"], row["seed"]) for row in scores.read_csv(path)}
            lacking[name] = {(*each, seed) for each in chosen for seed in seeds} - done
            named = {(row["label"], row["settings"], int(row["seed"])) for row in self.results.left_out if row["scene"] == name}
            self.assertLessEqual(lacking[name], named, name)

    def test_every_changed_verdict_has_its_reason(self):
        found = json.loads(self.texts["verdicts.json"])
        self.assertEqual({entry["id"] for entry in found if "before" in entry}, set(DUEL.judged["anew"]))
        self.assertEqual({entry["id"] for entry in found if "exploratory" in entry}, set(DUEL.judged["exploratory"]))

    def test_hypotheses_that_came_with_their_results_are_exploratory(self):
        """As git tells: the commit that brings a hypothesis must not bring results, or the page has to say so."""
        git = lambda *words: subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True)
        if git("rev-parse", "--is-shallow-repository").stdout.strip() != "false":
            self.skipTest("no history of commits")
        file, known, late = "experiments/duel/hypotheses.json", set(), set()
        for commit in git("log", "--reverse", "--format=%H", "--", file).stdout.split():
            new = {each["id"] for each in json.loads(git("show", f"{commit}:{file}").stdout)["hypotheses"]} - known
            if "results/duel/" in git("show", "--format=", "--name-only", commit).stdout:
                late |= new
            known |= new
        self.assertIn("completed", late)
        self.assertLessEqual(late, set(DUEL.judged["exploratory"]))
        self.assertIn("committed\nwith its results", self.texts["README.md"])

    def test_plots_are_there_and_the_page_shows_only_those(self):
        for name in (*self.results.fields, "variables"):
            self.assertTrue((RESULTS / "plots" / f"{name}.png").is_file(), name)
        for link in re.findall(r"\]\(([\w./-]+)\)", self.texts["README.md"]):
            self.assertTrue((RESULTS / link).exists(), link)

    def test_no_page_names_a_path_of_a_machine(self):
        for name, text in self.texts.items():
            self.assertNotIn(str(ROOT), text, name)
        self.assertNotRegex(self.texts["README.md"], r"\{[a-z_0-9]+[ }]|not said")
        self.assertNotRegex(self.texts["README.md"], r"(?m)^[^|\n]+\| scene \|")  # no table within a line


class CommandLine(unittest.TestCase):
    def run_tool(self, *words):
        return subprocess.run([sys.executable, ROOT / "tools" / "measure_duel.py", *words], capture_output=True, text=True)

    def test_unknown_scenes_and_missing_programs_are_named(self):
        done = self.run_tool("--only", "nowhere")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertIn("known: ring, folded", done.stderr)
        done = self.run_tool("--quick", "--program", "/nowhere/causticbench")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))

    def chosen(self, *words):
        import measure_duel

        with unittest.mock.patch.object(sys, "argv", ["measure_duel.py", *words]):
            return measure_duel.arguments()

    def test_runs_go_into_folders_of_the_user_unless_they_are_to_be_kept(self):
        for words, folder in (((), "out/duel"), (("--quick",), "out/duel-quick"), (("--smoke",), "out/duel-smoke"), (("--keep",), "results/duel")):
            self.assertEqual(self.chosen(*words).output, ROOT / folder)
        with unittest.mock.patch.dict(os.environ, CAUSTICS_CALLED_FROM="/elsewhere"):
            self.assertEqual(self.chosen("-o", "mine").output, pathlib.Path("/elsewhere/mine"))

    def test_a_smoke_run_has_one_scene_and_a_run_of_single_scenes_asks_no_other_for_its_seeds(self):
        duel = contests.Duel()
        held = lambda *size: [scene.name for scene in race.Race(duel, pathlib.Path("nowhere"), "causticbench", 1, *size).scenes]
        self.assertEqual(held("smoke"), ["folded"])
        self.assertEqual(held("quick"), ["ring", "folded"])
        self.assertEqual(held("", ["lens"]), ["lens"])
        self.assertEqual(held(), [scene.name for scene in duel.scenes])
        with tempfile.TemporaryDirectory() as folder:
            lone = race.Race(duel, pathlib.Path(folder), "causticbench", 1, "", ["counts"])
            self.assertEqual(lone.pilot(), list(range(1, 6)))
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [], "the seeds of all scenes are for a run of all")


if __name__ == "__main__":
    unittest.main()
