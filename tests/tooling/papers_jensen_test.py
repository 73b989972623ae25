"""Jensen's page without rendering: what its sweeps name, what its claims are judged by, its hues and its errors in closed form."""
import json
import pathlib
import statistics
import sys
import tempfile
import types
import unittest
import unittest.mock

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

try:
    import numpy as np
    import scipy  # noqa: F401  (smoothing)
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from papers import jensen_blur, jensen_cognac
from papers.verdict import BY_CONSTRUCTION, FAILS, PARTLY
from report import paper

JENSEN = paper.Paper("jensen1996")
CLAIMS = {claim["id"]: claim for claim in JENSEN.text["claims"]}
VERDICTS = {entry["id"]: entry for entry in json.loads((ROOT / "results" / "papers" / "jensen1996" / "verdicts.json").read_text(encoding="utf-8"))}


class Sweeps(unittest.TestCase):
    def test_photon_maps_name_their_estimate_and_the_order_of_emission(self):
        """A default of the program decides neither: the paper's is the N nearest of a point, and the order decides what balancing saves."""
        for file in (paper.FOLDER / "sweeps").glob("jensen1996_*.json"):
            for method in json.loads(file.read_text(encoding="utf-8"))["methods"]:
                if method["method"] == "photonmap":
                    self.assertLessEqual({"kernel", "emission"}, set(method["param"]), file.name)
        for file in (ROOT / "tools" / "papers").glob("jensen_*.py"):
            if file.name != "jensen_cardioid.py":
                self.assertNotRegex(file.read_text(encoding="utf-8"), r'"--method",\s+"photonmap"', file.name)


    def test_a_map_that_is_read_is_not_told_how_to_emit(self):
        """The program refuses that: the file's photons are there already."""
        ran = []
        with tempfile.TemporaryDirectory() as folder:
            study = types.SimpleNamespace(output=pathlib.Path(folder), paper=JENSEN,
                                          single=lambda name, verb, words, *outputs: [ran.append(words) for _ in outputs])
            with unittest.mock.patch.object(jensen_cognac.exr, "read_layers", lambda file: {"": np.zeros((1, 1, 3))}):
                jensen_cognac.one_map(study)
        self.assertEqual(len(ran), 3)
        for words in ran:
            self.assertIn("kernel=point", words)
            self.assertNotEqual("emission=random" in words, any(word.startswith("load=") for word in words), words)


class Judged(unittest.TestCase):
    def test_what_balancing_saves_is_judged_by_nodes_in_both_orders(self):
        for name in ("ball_unbalanced", "ball_unbalanced_many", "ball_doubled", "ball_saved", "ball_growth", "ball_growth_unbalanced", "ball_flatter",
                     "cognac_unbalanced", "cognac_doubled"):
            for end, order in (("", "at random"), ("_strata", "stratum by stratum")):
                self.assertIn("nodes", CLAIMS[name + end]["unit"])
                self.assertTrue(CLAIMS[name + end]["claim"].endswith(f"photons {order}"), name + end)
                self.assertTrue(any("CPU time" in what for what in VERDICTS[name + end]["beside"]), f"{name}{end}: its times stand beside")

    def test_bytes_that_follow_from_the_papers_photons_are_counted_apart(self):
        for name in ("ring_megabytes", "ball_megabytes", "usual_megabytes", "photon_bytes", "ball_pointers", "ring_fixed"):
            self.assertEqual(VERDICTS[name]["verdict"], BY_CONSTRUCTION, name)

    def test_a_red_caustic_is_judged_by_its_hue(self):
        self.assertEqual(JENSEN.region(CLAIMS["cognac_red"])[1], 15, "half way from red, 0 degrees, to orange, 30")
        self.assertEqual(VERDICTS["cognac_red"]["verdict"], FAILS)
        self.assertGreater(VERDICTS["cognac_red"]["ours"], 15)

    def test_figure_3_without_its_sand_texture_never_holds_whole(self):
        for name in ("cognac_flat", "cognac_flat_views"):
            self.assertIn("texture", CLAIMS[name]["missing"])
            self.assertIn(VERDICTS[name]["verdict"], {PARTLY, FAILS, "undecided"})


class Hues(unittest.TestCase):
    def test_hues_are_angles(self):
        for colour, angle in (((1, 0, 0), 0), ((1, 0.5, 0), 30), ((1, 1, 0), 60), ((0, 1, 0), 120), ((0, 1, 1), -180), ((0, 0, 1), -120), ((1, 0, 0.5), -30)):
            self.assertAlmostEqual(jensen_cognac.hue(colour), angle, msg=colour)
        np.testing.assert_allclose(jensen_cognac.shown((2, 0.428, 0)), (1, 0.5, 0), atol=1e-3)


class Errors(unittest.TestCase):
    def test_the_noise_of_truths_cancels(self):
        """Pictures that are a tenth too bright and scatter by 0.2, against truths that scatter by 0.3."""
        draw = np.random.default_rng(5)
        layers = lambda mean, scatter: {"caustic": np.repeat(draw.normal(mean, scatter, (80, 80, 1)), 3, axis=2), "albedo": np.full((80, 80, 3), 0.5)}
        errors = jensen_blur.Deviations([layers(1, 0.3) for _ in range(3)])
        pictures = [layers(1.1, 0.2) for _ in range(3)]
        self.assertAlmostEqual(statistics.fmean(errors.squares(pictures)), 0.1 ** 2 + 0.2 ** 2, delta=0.01)
        self.assertAlmostEqual(errors.noise(pictures), 0.2 ** 2, delta=0.005)


if __name__ == "__main__":
    unittest.main()
