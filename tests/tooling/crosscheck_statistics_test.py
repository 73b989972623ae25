"""tools/report/crosscheck_statistics.py on pictures made by hand: chance is unremarkable, faults of 1 % and of one cell are not.

Exits with 77 where NumPy is missing.
"""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

try:
    import numpy
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from report import crosscheck_statistics as tool

SEEDS, SIDE = 12, 6
tool.DRAWS = 10_000
MASK = numpy.ones((36, 48), bool)
MASK[:7, :13] = False  # two cells and parts of others


def estimator(generator, noise, factor=1.0, cell=1.0):
    """What an estimator of the same picture gives by its seeds; pixels of one cell times `cell`."""
    truth = 1 + 0.5 * numpy.sin(numpy.arange(36 * 48)).reshape(36, 48, 1) * numpy.ones(3)
    truth[18:24, 24:30] *= cell
    return tool.of_pictures([factor * truth * (1 + noise * generator.standard_normal(truth.shape)) for _ in range(SEEDS)],
                            MASK, SIDE)


class CrossCheckStatistics(unittest.TestCase):
    def setUp(self):
        self.generator = numpy.random.default_rng(5)

    def compare(self, a, b):
        return tool.compare(a, b, self.generator)

    def test_cells_hold_the_mean_of_their_pixels(self):
        picture = numpy.arange(36 * 48, dtype=float).reshape(36, 48, 1) * numpy.ones(3)
        found = tool.cells(picture, MASK, SIDE)
        self.assertEqual(found.shape, (48,))
        self.assertTrue(numpy.isnan(found[0]))
        self.assertAlmostEqual(found[9], picture[6:12, 6:12].mean(axis=2)[MASK[6:12, 6:12]].mean())

    def test_chance_is_unremarkable_and_p_values_are_even(self):
        pairs = [self.compare(estimator(self.generator, 0.1), estimator(self.generator, noise))
                 for noise in (0.1, 0.3, 0.02) for _ in range(8)]
        self.assertFalse([pair for pair in pairs if tool.is_remarkable(pair, pairs)])
        for name in ("p_squares", "p_largest"):
            self.assertTrue(0.3 < numpy.mean([pair[name] for pair in pairs]) < 0.7, name)
        self.assertTrue(all(abs(pair["ratio"] - 1) < 4.5 * pair["ratio_error"] for pair in pairs))
        self.assertTrue(all(pair["cells"] == 46 for pair in pairs))

    def test_one_per_cent_is_found(self):
        pair = self.compare(estimator(self.generator, 0.1, factor=1.01), estimator(self.generator, 0.1))
        self.assertGreater((pair["ratio"] - 1) / pair["ratio_error"], 5)
        self.assertTrue(tool.is_remarkable(pair, [pair]))

    def test_one_cell_is_found(self):
        pair = self.compare(estimator(self.generator, 0.1, cell=1.1), estimator(self.generator, 0.1))
        self.assertTrue(tool.is_remarkable(pair, [pair] * 24))
        self.assertLess(abs(pair["ratio"] - 1), 0.005)

    def test_the_ratio_of_the_caustics_leaves_the_direct_light_out(self):
        a, b = estimator(self.generator, 0.01, factor=1.02), estimator(self.generator, 0.01)
        b["direct"] = 0.8 * b["means"].mean()
        pair = self.compare(a, b)
        self.assertAlmostEqual(pair["caustic_ratio"], 1.1, delta=0.01)
        self.assertAlmostEqual(pair["caustic_error"] / pair["ratio_error"], 5, delta=0.5)


if __name__ == "__main__":
    unittest.main()
