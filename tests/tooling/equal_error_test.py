"""tools/equal_error.py without a sweep: its truth by a closed form, and its ratios by hand."""
import math
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True  # the source folder may be read-only
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

import numpy as np

import equal_error
import pool_truth


def still_water(pool, x, y):
    """Irradiance of the floor under water without waves: the ray is in a plane with the lamp's axis, found by bisection."""
    away = math.hypot(x - pool.lamp[0], y - pool.lamp[1])
    above, below = pool.lamp[2], -pool.floor
    landing = lambda r: r + below * math.tan(math.asin(math.sin(math.atan(r / above)) / pool.ior))
    low, high = 0.0, away
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if landing(middle) < away else (low, middle)
    r, step = (low + high) / 2, 1e-5
    outer = math.cos(math.atan(r / above))
    inner = math.sqrt(1 - (1 - outer**2) / pool.ior**2)
    across = ((outer - pool.ior * inner) / (outer + pool.ior * inner)) ** 2
    along = ((inner - pool.ior * outer) / (inner + pool.ior * outer)) ** 2
    flux = pool.intensity * outer**3 / above**2 * r * (1 - (across + along) / 2)  # per radius and angle
    return flux / (away * (landing(r + step) - landing(r - step)) / (2 * step))


class Truth(unittest.TestCase):
    def test_still_water_has_a_closed_form(self):
        pool = pool_truth.Pool(equal_error.SCENE, 0)
        found = pool.irradiance(256)
        for row, column in ((256, 256), (100, 300), (400, 120), (60, 60)):
            x = pool.corner[0] + (column + 0.5) * pool.pixel
            y = pool.corner[1] - (row + 0.5) * pool.pixel
            self.assertAlmostEqual(found[row, column] / still_water(pool, x, y), 1, delta=1e-3)  # even light in each half cell

    def test_no_flux_is_lost_between_pixels(self):
        generator = np.random.default_rng(1)
        place = [generator.uniform(1, 15, (3, 500)) for _ in range(2)]
        flux = generator.uniform(0, 1, 500)
        edges, points = np.zeros(16 * 18), np.zeros(16 * 16)
        pool_truth.add_triangles(edges, points, 16, place, flux)
        pixels = edges.reshape(16, 18).cumsum(axis=1)
        self.assertAlmostEqual(pixels[:, :16].sum() / flux.sum(), 1, places=9)
        self.assertLess(np.abs(pixels[:, 16:]).max(), 1e-9)
        self.assertGreater(pixels.min(), -1e-9)

    def test_half_a_pixel(self):
        edges, points = np.zeros(4 * 6), np.zeros(16)
        corner = lambda *values: [np.array([value]) for value in values]
        pool_truth.add_triangles(edges, points, 4, [corner(1.0, 2.0, 2.0), corner(1.0, 1.0, 2.0)], np.array([3.0]))
        pixels = edges.reshape(4, 6).cumsum(axis=1)
        self.assertAlmostEqual(pixels[1, 1], 3)
        self.assertAlmostEqual(np.abs(pixels).sum(), 3)

    def test_exr_has_both_layers(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.exr"
            pool_truth.write_exr(path, np.ones((2, 3)))
            data = path.read_bytes()
            self.assertEqual(data[:4], bytes((0x76, 0x2F, 0x31, 0x01)))
            self.assertIn(b"caustic.R", data)
            self.assertEqual(data[-4:], bytes((0, 0, 0x80, 0x3F)))


def trial(method, seconds, error):
    return {"method": method, "settings": f"{seconds} s", "seconds": seconds, "error": error}


class Ratios(unittest.TestCase):
    photons = [trial("photonmap", 1, 0.8), trial("photonmap", 3, 0.9), trial("photonmap", 4, 0.4), trial("photonmap", 16, 0.2)]

    def test_between_measurements_a_power_law_holds(self):
        ratio, bound = equal_error.against(trial("beamtree", 0.5, 0.4 / math.sqrt(2)), equal_error.front(self.photons))
        self.assertAlmostEqual(ratio, 16)
        self.assertFalse(bound)

    def test_an_error_that_was_not_reached_gives_a_lower_bound(self):
        ratio, bound = equal_error.against(trial("beamtree", 0.5, 0.1), equal_error.front(self.photons))
        self.assertEqual((ratio, bound), (32, True))

    def test_an_error_reached_at_once_takes_the_first_time(self):
        self.assertEqual(equal_error.against(trial("beamtree", 2, 0.9), equal_error.front(self.photons)), (0.5, False))

    def test_the_best_setting_makes_the_key(self):
        beams = [trial("beamtree", 1, 0.4), trial("beamtree", 2, 0.1)]
        key, entry = equal_error.contest("folded", beams + self.photons)
        self.assertEqual((key, entry["ratio"], entry["lower_bound"], entry["must_met"]), ("equal_error_sharp_pool", 8, True, None))


if __name__ == "__main__":
    unittest.main()
