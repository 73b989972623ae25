"""The duel's statistics against known answers: run by duel_test.py."""
import math
import unittest

import numpy as np

from duel import contests, counted, curves, factors, ranges, tables, verdicts
from papers.verdict import FAILS, HOLDS, UNDECIDED, UNMEASURED


def cell(label, seconds, squares, noise=0.0, scene="a", **param):
    setting = contests.Setting(label, label, "points", 4, None, tuple(sorted(param.items())))
    times = seconds if isinstance(seconds, (list, tuple)) else [seconds] * len(squares)
    rows = [{"scene": scene, "build_s": time / 2, "query_s": time / 2, "relmse": square, "relmse_noise": noise, "seed": i, "map_bytes": 1e6 * time,
             "mean_ratio": 1 - 0.1 * i} for i, (square, time) in enumerate(zip(squares, times))]
    return curves.Cell(setting, rows)


def flat(label, seconds, error, noise=0.0, **param):
    """A cell without scatter."""
    return cell(label, seconds, [error ** 2 + noise] * 5, noise, **param)


class Intervals(unittest.TestCase):
    def test_the_bootstrap_of_a_mean_is_students_interval(self):
        """The bootstrap's variance of a mean is (n - 1) / n of the estimate's: widened by n / (n - 1) it is Student's."""
        values = np.array([1.0, 1.1, 0.95, 1.02, 1.07])
        means = values[ranges.draws(5)].mean(axis=1)
        low, high = ranges.estimate(ranges.Range(means, means), 5).ends()
        half = 2.776445 * values.std(ddof=1) / math.sqrt(5)
        self.assertAlmostEqual(math.log(high / low) / 2, half / values.mean(), delta=0.05 * half)

    def test_the_interval_covers_the_truth(self):
        """Means of 5 normal logarithms: 95 % of 400 intervals, by the binomial's 4 standard deviations."""
        random = np.random.default_rng(5)
        hits = 0
        for _ in range(400):
            means = np.exp(random.normal(0, 0.05, 5)[ranges.draws(5)].mean(axis=1))
            low, high = ranges.estimate(ranges.Range(means, means), 5).ends()
            hits += low <= 1 <= high
        self.assertGreater(hits, 400 * 0.95 - 4 * math.sqrt(400 * 0.95 * 0.05))

    def test_the_interval_of_a_ratio_covers_the_ratio(self):
        """Two methods whose squared errors scatter by 20 % about 0.04 and 0.01, on seeds of their own: the ratio of errors is 2."""
        random = np.random.default_rng(7)
        hits = 0
        for _ in range(200):
            squares = lambda mean: list(mean * (1 + random.normal(0, 0.2, 5)))
            field = curves.Field([cell("photonmap", 1, squares(0.04)), cell("beamtree", 1, squares(0.01))])
            low, high = factors.factor_of_errors(field).ends()
            hits += low <= 2 <= high
        self.assertGreater(hits, 200 * 0.95 - 4 * math.sqrt(200 * 0.95 * 0.05))

    def test_draws_are_the_same_on_every_run_and_other_ones_of_each_scene(self):
        self.assertEqual(ranges.draws(5, "ring").shape, (ranges.RESAMPLES + 1, 5))
        self.assertTrue((ranges.draws(5, "ring")[0] == np.arange(5)).all())
        self.assertTrue((ranges.draws(5, "ring") == ranges.draws.__wrapped__(5, "ring")).all())
        self.assertLess((ranges.draws(5, "ring")[1:] == ranges.draws(5, "ball")[1:]).mean(), 0.3)  # a fifth by chance

    def test_an_interval_widens_with_what_it_may_not_leave_out(self):
        found = ranges.Found.exact(2.0, 0.1, 4)
        self.assertAlmostEqual(found.ends()[1], 2 * math.exp(2.776445 * 0.1), 5)
        self.assertAlmostEqual(found.ends(0.01)[0], 2 / math.exp(4.604095 * 0.1), 5)

    def test_draws_that_miss_leave_an_end_open(self):
        """One seed of five has all of the error: without it the goal is reached, so draws with it twice miss."""
        photons = [flat("photonmap", 0.5, 0.5, photons=1, nearest=5), cell("photonmap", 2, [0.01, 0.01, 0.01, 0.01, 0.09], photons=2, nearest=9)]
        field = curves.Field([*photons, flat("beamtree", 1, 0.1, mesh_resolution=1)])
        found = factors.factor_of_times(field, math.sqrt(0.027))
        self.assertEqual(found.ends()[1], math.inf)
        self.assertTrue(found.text().startswith("> "))
        self.assertEqual(factors.factor_at_least_common(field).ends()[0], 2)  # a goal of each draw's own is never missed


class Curves(unittest.TestCase):
    def test_a_ratio_of_two_methods_is_exact_without_scatter(self):
        photons = [flat("photonmap", 1, 0.2, photons=100), flat("photonmap", 4, 0.1, photons=400)]
        field = curves.Field([*photons, flat("beamtree", 1, 0.1)])
        found = factors.factor_of_errors(field, 2.0)
        self.assertAlmostEqual(found.value, math.sqrt(2))  # halfway of a power -1/2 between 0.2 and 0.1
        self.assertAlmostEqual(*found.ends())
        self.assertAlmostEqual(factors.factor_at_least_common(field).value, 4)
        found = factors.factor_of_times(curves.Field([flat("photonmap", 2, 0.2), flat("beamtree", 1, 0.1)]), 0.1001)
        self.assertEqual(found.ends()[1], math.inf)

    def test_between_settings_of_other_kinds_nothing_is_known(self):
        """Photons and N differ: at 2 s it has what was done at 1 s, and no less than what is done at 4 s; 0.15 takes from 1 to 4 s."""
        field = curves.Field([flat("photonmap", 1, 0.2, photons=100, nearest=20), flat("photonmap", 4, 0.1, photons=400, nearest=80)])
        error, time = field.at_time("photonmap", 2.0), field.at_error("photonmap", 0.15)
        self.assertAlmostEqual(error.high[0], 0.2)
        self.assertAlmostEqual(error.low[0], 0.1)
        self.assertEqual((time.low[0], time.high[0]), (1, 4))
        self.assertEqual(tables.error_words(field, "photonmap", 2.0), "≤ 20 %")
        self.assertEqual(tables.error_words(field, "photonmap", 5.0), f"10 % {tables.CARRIED}")
        self.assertIsNone(tables.error_words(field, "photonmap", 0.5))
        self.assertEqual(tables.time_words(field, "photonmap", 0.15), "≤ 4 s")
        self.assertEqual(tables.time_words(field, "photonmap", 0.2), "1 s")  # it has just that
        self.assertEqual(tables.time_words(field, "photonmap", 0.3), "≤ 1 s")
        self.assertIsNone(tables.time_words(field, "photonmap", 0.05))

    def test_a_power_law_joins_neighbours_in_one_parameter_of_work(self):
        cells = [flat("photonmap", n, 1 / n, photons=100 * n) for n in (1, 2, 8)] + [flat("photonmap", 3, 0.2, photons=100, nearest=5)]
        pairs = [(a.seconds(), b.seconds()) for a, b in curves.neighbours(cells)]
        self.assertEqual(pairs, [(1, 2), (2, 8)])
        self.assertAlmostEqual(curves.Field(cells[:3]).at_error("photonmap", 0.25).point[0], 4, 5)

    def test_times_that_scatter_count_as_done(self):
        field = curves.Field([flat("photonmap", 1.04, 0.2), flat("photonmap", 1.06, 0.1)])
        self.assertAlmostEqual(field.at_time("photonmap", 1.0).high[0], 0.2)

    def test_fronts_hold_what_nothing_faster_beats(self):
        self.assertEqual(curves.front([(3, 0.2), (1, 0.5), (2, 0.6), (4, 0.1)]), [(1, 0.5), (3, 0.2), (4, 0.1)])
        self.assertIsNone(curves.at_time([(1, 0.5)], 0.9))
        self.assertEqual(curves.at_time([(1, 0.5)], 9), 0.5)
        self.assertIsNone(curves.at_error([(1, 0.5)], 0.4))
        self.assertEqual(curves.at_error([(1, 0.5)], 0.6), 1)

    def test_crossings_that_last_no_longer_than_times_scatter_are_none(self):
        found = [("open", 1.0), ("photon map", 1.02), ("open", 2.0), ("photon map", 2.01)]
        self.assertEqual(tables.lasting(found), [("photon map", 1.02)])

    def test_a_search_keeps_the_ends_and_what_gains_a_tenth(self):
        cells = [cell("a", seconds, [error ** 2]) for seconds, error in ((1, 1.0), (2, 0.95), (3, 0.5), (4, 0.3), (5, 0.29), (6, 0.1))]
        kept = lambda most: [each.seconds() for each in curves.chosen(cells, most)]
        self.assertEqual(kept(9), [1, 3, 4, 6])
        self.assertEqual(kept(3), [1, 4, 6])

    def test_a_search_breaks_the_ties_that_the_truth_makes_by_the_plain_error(self):
        cells = [cell("a", seconds, [square], 0.01) for seconds, square in ((1, 0.0121), (2, 0.011), (3, 0.0115))]
        self.assertEqual({each.error() for each in cells}, {0.05})
        self.assertEqual([each.seconds() for each in curves.chosen(cells, 9)], [1, 2])


class Bounds(unittest.TestCase):
    NOISE = 0.04 ** 2

    def test_the_truths_own_error_is_taken_off(self):
        self.assertAlmostEqual(curves.error_of(0.05 ** 2 + 0.03 ** 2, 0.03 ** 2), 0.05)
        self.assertAlmostEqual(curves.error_of(0.9 * 0.03 ** 2, 0.03 ** 2), 0.015)  # no better than half of it

    def test_what_the_truth_hides_is_a_bound_in_errors_factors_and_verdicts(self):
        field = curves.Field([flat("photonmap", 1, 0.1, self.NOISE), flat("beamtree", 1, 0.01, self.NOISE)])
        beams = field.own["beamtree"][0]
        self.assertTrue(beams.is_bound())
        self.assertEqual((beams.low[0], beams.high[0]), (0, 0.02))
        self.assertEqual(tables.error_words(field, "beamtree", 1), "< 2 %")
        found = factors.factor_of_errors(field)
        self.assertEqual(tables.factor(found), "> 5")
        judged = lambda region: verdicts.judge_case(verdicts.Case.of("c", found), region)
        self.assertEqual((judged({"above": 4}), judged({"above": 6}), judged({"below": 2})), (HOLDS, UNDECIDED, FAILS))
        self.assertEqual(tables.time_words(field, "beamtree", 0.015), "?")
        self.assertEqual(tables.best(field, 1), ["beamtree"])

    def test_two_bounds_leave_a_ratio_open(self):
        field = curves.Field([flat("photonmap", 1, 0.01, self.NOISE), flat("beamtree", 1, 0.005, self.NOISE)])
        self.assertEqual(tables.factor(factors.factor_of_errors(field)), "not known")
        self.assertEqual(sorted(tables.best(field, 1)), ["beamtree", "photonmap"])

    def test_scenes_without_a_result_count_on_their_side_of_a_median(self):
        known = [ranges.Range(value, value) for value in (3.0, 5.0, 20.0)]
        found = ranges.estimate(ranges.middle([*known, ranges.Range(0.0, 1.0), ranges.Range(0.0, 1.0)]), 5)
        self.assertEqual(found.ends(), (3, 3))  # of 20, 5, 3 and two below 1; without those it would be 5

    def test_ties_are_exact_and_what_is_undecided_is_open(self):
        text = lambda low, high, spread: tables.factor(ranges.Found(1.1, low, high, (spread, spread), 4))
        self.assertTrue(text(1.1, 1.1, 0.1).endswith(", a tie"))
        self.assertTrue(text(0.5, 1.1, 0.1).endswith(", open"))
        self.assertTrue(text(1.1, 1.1, 1.0).endswith(", open"))
        self.assertEqual(text(1.1, 1.1, 0.001), "1.1")

    def test_light_found_is_the_median_of_the_seeds(self):
        field = curves.Field([flat("photonmap", 1, 0.1)])
        self.assertEqual(tables.light_words(field, "photonmap", 1), "0.80 (0.60 to 1.00)")
        self.assertIsNone(tables.light_words(field, "beamtree", 1))


class Truths(unittest.TestCase):
    def test_the_standard_error_by_the_truth_is_that_of_many_truths(self):
        """Pictures of 500 pixels off by 0.1, held against 2,000 noisy truths."""
        noise, pixels = 0.05, 500
        own = np.random.default_rng(2).normal(0, noise, (2000, pixels))
        errors = np.sqrt(((0.1 + own) ** 2).mean(axis=1) - noise ** 2)
        self.assertAlmostEqual(errors.std(), curves.error_by_truth(0.1, noise ** 2, pixels), delta=0.1 * errors.std())

    def test_a_factor_is_hidden_below_ten_times_what_the_truth_makes_of_it(self):
        pair = lambda pixels: curves.Field([flat("photonmap", 1, 0.1, 0.05 ** 2), flat("beamtree", 1, 0.05, 0.05 ** 2)], pixels)
        small, large = (factors.factor_of_errors(pair(pixels)) for pixels in (300, 30000))
        self.assertTrue(small.is_hidden())
        self.assertFalse(large.is_hidden())
        self.assertIn(tables.HIDDEN, tables.factor(small))
        self.assertEqual(verdicts.judge_case(verdicts.Case.of("c", small), {"above": 1}), UNDECIDED)
        self.assertEqual(verdicts.judge_case(verdicts.Case.of("c", large), {"above": 1}), HOLDS)
        self.assertEqual(verdicts.judge_case(verdicts.Case.of("c", small), {"below": 100}), HOLDS)  # far from the end that is asked for
        low, high = small.ends()
        self.assertGreater(math.log(high / low) / 2, ranges.student(4) * small.truth * 0.99)  # the truth's part is in the interval

    def test_what_is_too_good_is_flagged_and_chance_is_not(self):
        """Perfect pictures of 400 pixels against 400 noisy truths: one in twenty of such families may be flagged, hardly more than one of it."""
        noise, pixels = 0.01, 400
        squares = (np.random.default_rng(4).normal(0, math.sqrt(noise), (400, pixels)) ** 2).mean(axis=1)
        self.assertLessEqual(sum(counted.is_too_good(square, noise, pixels, 400) for square in squares), 1)
        self.assertTrue(counted.is_too_good(0.7 * noise, noise, pixels, 400))
        self.assertFalse(counted.is_too_good(0.0, 0.0, pixels, 400))


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

    def test_all_cases_at_once_are_judged_by_wider_intervals(self):
        case = verdicts.Case.of("c0", ranges.Found.exact(2.0, 0.2, 4))
        judged = lambda outside: verdicts.judge({"region": {"above": 1}}, [case], outside)[0]
        self.assertEqual((judged(0.05), judged(0.05 / 43)), (HOLDS, UNDECIDED))

    def test_values_intervals_and_bounds_in_words(self):
        words = [ranges.words(*each) for each in ((2, 1, 3), (2, 1.5, math.inf), (2, 0, 3), (2, 0, math.inf), (2, 2, 2))]
        self.assertEqual(words, ["2 (1 to 3)", "> 1.5", "< 3", "not known", "2"])
