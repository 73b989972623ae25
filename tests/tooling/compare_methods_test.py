"""tools/compare_methods.py on records made by hand: intervals, bias and variance, curves, ties.

Exits with 77 where SciPy is missing.
"""
import csv
import json
import math
import os
import pathlib
import random
import statistics
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

try:
    import scipy
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

import compare_methods as tool
from report import intervals, records

COLUMNS = ("trial", "status", "scene", "method", "seed", "repeat", "threads", "isa", "photons_stored", "nearest", "alpha",
           "mesh_resolution", "render_cpu_s", "indirect_cpu_s", "total_s", "rmse", "relmse", "variance", "mean_ratio", "reference",
           "reference_stderr", "reference_mean", "code_version", "effort", "pencils_traced", "flux_share_rest")


def rows(method, efforts, errors, seeds=5, scatter=0.01, reference="lighttrace:1"):
    """`errors`: rmse by effort; seeds scatter about it by equal steps, seconds are the effort."""
    for effort, error in zip(efforts, errors):
        for seed in range(seeds):
            step = 0 if seeds == 1 else scatter * error * (2 * seed / (seeds - 1) - 1)
            yield dict(zip(COLUMNS, [f"{method}{effort}s{seed}", "done", "pool", method, str(seed), "1", "1", "plain", "",
                                     "", "", "", str(effort), "", str(effort), repr(error + step), "0.1", repr(error**2 / 2),
                                     "1", reference, "0.01", "1", "v", str(effort), "", ""]))


def outputs(*records):
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "records.csv"), "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            for some in records:
                writer.writerows(some)
        tool.write_all(folder, folder)
        return {name: pathlib.Path(folder, name).read_text(encoding="utf-8")
                for name in ("statistics.csv", "statistics.md", "equal_time.md", "equal_error.md")}


class Comparison(unittest.TestCase):
    def test_interval_is_students(self):
        self.assertAlmostEqual(tool.half_interval([1.0, 2.0, 3.0]), 4.30265 / math.sqrt(3), places=5)
        self.assertIsNone(tool.half_interval([1.0]))
        for degrees, t in ((1, 12.706), (15, 2.131), (16, 2.120), (30, 2.042), (120, 1.980)):  # from printed tables
            self.assertAlmostEqual(intervals.student(degrees), t, places=3)
        seventeen = [float(i) for i in range(17)]
        self.assertAlmostEqual(tool.half_interval(seventeen), 2.1199 * statistics.stdev(seventeen) / math.sqrt(17), places=3)

    def test_bias_and_variance_and_the_references_error_add_up_to_the_mean_square(self):
        text = outputs(rows("a", [1], [0.5], scatter=0))["statistics.csv"]
        row = next(csv.DictReader(text.splitlines()))
        self.assertAlmostEqual(float(row["variance"]), 0.125)
        self.assertAlmostEqual(float(row["reference_square"]), 1e-4)
        self.assertAlmostEqual(float(row["bias_square"]), 0.25 - 0.125 - 1e-4)
        self.assertAlmostEqual(float(row["efficiency"]), 4)

    def test_pure_and_completed_beams_are_rows_of_their_own(self):
        by = lambda column, value, name: [{**row, column: value, "trial": name + row["trial"]}
                                          for row in rows("beamtree", (1, 2), (0.3, 0.2))]
        written = outputs(rows("beamtree", (1, 2), (0.4, 0.3)), by("pencils_traced", "5000", "p"), by("flux_share_rest", "0.1", "r"))
        own = list(csv.DictReader(written["statistics.csv"].splitlines()))
        self.assertEqual(sorted({row["completed_by"] for row in own}), ["", "pencils", "photons"])
        self.assertEqual(len(own), 6)
        for table in ("equal_time.md", "equal_error.md"):
            for name in ("beamtree", "beamtree, completed by pencils", "beamtree, completed by photons"):
                self.assertIn(f"\n| {name} |", written[table])

    def test_an_unknown_measure_is_no_swept_parameter(self):
        def cells(column, value, plan=None, more={}):
            with tempfile.TemporaryDirectory() as folder:
                some = [{**row, column: value(row), **{name: other(row) for name, other in more.items()}} for row in rows("a", [1, 2], [0.5, 0.3])]
                with open(os.path.join(folder, "records.csv"), "w", newline="", encoding="utf-8") as file:
                    writer = csv.DictWriter(file, (*COLUMNS, column, *more))
                    writer.writeheader()
                    writer.writerows(some)
                if plan is not None:
                    pathlib.Path(folder, "plan.json").write_text(json.dumps({"swept": plan}), encoding="utf-8")
                return records.read(os.path.join(folder, "records.csv"))
        psnr = cells("psnr", lambda row: repr(30 + int(row["seed"]) + float(row["rmse"])))
        self.assertEqual([len(cell.records) for cell in psnr.cells], [5, 5])
        self.assertNotIn("psnr", psnr.parameters)
        # Nor are two of them, which tell every row apart by each other.
        two = cells("ssim", lambda row: repr(1 / (2 + int(row["seed"]) + float(row["rmse"]))), more={"psnr": lambda row: row["rmse"]})
        self.assertEqual([len(cell.records) for cell in two.cells], [5, 5])
        self.assertIn("waves", cells("waves", lambda row: row["effort"]).parameters)
        # The plan knows, whatever the values are.
        self.assertNotIn("waves", cells("waves", lambda row: row["effort"], ["effort"]).parameters)

    def test_a_bias_that_chance_explains_is_marked(self):
        clear, unclear = rows("a", [1], [0.5], scatter=0), rows("b", [1], [0.5], scatter=1)
        text = outputs(clear, unclear)["statistics.md"]
        line = {name: next(line for line in text.splitlines() if line.startswith(f"| pool | {name}")) for name in "ab"}
        self.assertIn("| 0.12 ± 0 |", line["a"])
        self.assertRegex(line["b"], r"\| 0\.25 ± 0\.2 † \|")  # squares 0, 1/16, 1/4, 9/16, 1: mean 3/8, stderr 0.18
        self.assertIn("not distinguishable from 0", text)

    def test_errors_of_the_references_size_are_marked(self):
        text = outputs(rows("a", [1, 2], [0.5, 0.012], scatter=0))["statistics.md"]
        marked = [line for line in text.splitlines() if "\\*" in line and line.startswith("| pool")]
        self.assertEqual(len(marked), 1)
        self.assertIn("0.012", marked[0])

    def test_curve_leaves_out_what_something_faster_beats(self):
        curve = tool.front([tool.Point(1, 4), tool.Point(3, 5), tool.Point(2, 2), tool.Point(4, 1)])
        self.assertEqual([(point.seconds, point.error) for point in curve], [(1, 4), (2, 2), (4, 1)])

    def test_between_neighbours_runs_a_power_law(self):
        curve = [tool.Point(1, 8), tool.Point(4, 4), tool.Point(16, 2)]  # error = 8 / sqrt(seconds)
        self.assertAlmostEqual(tool.equal_time(curve, 2).value, 8 / math.sqrt(2))
        self.assertAlmostEqual(tool.equal_error(curve, 5).value, 2.56)
        self.assertIsNone(tool.equal_time(curve, 0.5))
        self.assertEqual(tool.equal_time(curve, 100).value, 2)
        self.assertIsNone(tool.equal_error(curve, 1))
        self.assertEqual(tool.equal_error(curve, 9).value, 1)

    def test_variance_between_neighbours_is_that_of_the_power_law(self):
        generator = random.Random(3)
        ends = [(1.0, 8.0), (16.0, 2.0)]
        sigma = 0.01
        curve = [tool.Point(s, e, sigma ** 2, sigma ** 2, 9) for s, e in ends]
        for question, place in ((tool.equal_time, 3.0), (tool.equal_error, 3.0)):
            drawn = [math.log(question([tool.Point(s * generator.lognormvariate(0, sigma), e * generator.lognormvariate(0, sigma))
                                        for s, e in ends], place).value) for _ in range(4000)]
            told = sum(variance for variance, _ in question(curve, place).terms)
            self.assertAlmostEqual(told / statistics.variance(drawn), 1, delta=0.1)

    def test_one_of_forty_equals_is_called_worse(self):
        """Two methods of the same law: what is called worse is called so by chance, in 1 of 40 cases on either side."""
        generator = random.Random(4)
        draw = lambda: [math.exp(generator.gauss(0, 0.1)) for _ in range(5)]
        answer = lambda values: tool.Answer(statistics.mean(values), ((tool.log_variance(values), len(values) - 1),))
        wrong = sum(tool.is_worse(answer(draw()), answer(draw())) for _ in range(2000))
        self.assertAlmostEqual(wrong / 2000, 0.025, delta=4 * math.sqrt(0.025 / 2000))

    def test_no_error_and_tiny_errors_have_no_worse_ones_by_chance(self):
        """Zeros have no logarithm: they tie with each other, and all else is above them. The unit of an error changes nothing."""
        usual = [1.0, 1.1, 1.2, 1.3, 1.4]
        for unit in (1e-300, 1e-12, 1e150):
            self.assertAlmostEqual(tool.log_variance([unit * each for each in usual]), tool.log_variance(usual))
        self.assertEqual(tool.log_variance([0.0] * 5), 0)
        answer = lambda value: tool.Answer(value, ((0.01, 4),))
        self.assertFalse(tool.is_worse(answer(0.0), answer(0.0)))
        self.assertTrue(tool.is_worse(answer(1e-300), answer(0.0)))
        self.assertTrue(tool.is_worse(answer(1e150), answer(1e-300)))
        text = outputs(rows("one", [1, 4], [4e-300, 2e-300]), rows("two", [1, 4], [4e-300, 2e-300]))["equal_time.md"]
        for name in ("one", "two"):
            self.assertEqual(next(line for line in text.splitlines() if line.startswith(f"| {name}")).count("**"), 2 * tool.STEPS)

    def test_three_seeds_call_no_winner(self):
        text = outputs(rows("good", [1, 4], [0.4, 0.2], seeds=3), rows("poor", [1, 4], [0.8, 0.4]))
        for name in ("equal_time.md", "equal_error.md"):
            self.assertIn("Too few seeds (3, not 5)", text[name])
            self.assertNotIn("**", text[name])

    def test_repeats_are_no_seeds(self):
        """Three repeats of each of two seeds: the table of two seeds, with no winner, and the median of all times."""
        two = [list(rows(name, [1, 4], errors, seeds=2)) for name, errors in (("good", [0.4, 0.2]), ("poor", [0.8, 0.4]))]
        repeated = [[{**row, "repeat": str(i), "trial": f"{row['trial']}r{i}", "render_cpu_s": repr(float(row["effort"]) * (0.5 + 0.5 * i))}
                     for row in own for i in (1, 2, 3)] for own in two]
        text, wanted = outputs(*repeated), outputs(*two)
        column = lambda tables, name: [row[name] for row in csv.DictReader(tables["statistics.csv"].splitlines())]
        for name in ("seeds", "rmse_mean", "rmse_half_interval_95", "bias_square_stderr"):
            self.assertEqual(column(text, name), column(wanted, name), name)
        self.assertEqual(column(text, "seeds"), ["2"] * 4)
        self.assertEqual(column(text, "cpu_s_median"), ["1.5", "6.0"] * 2)
        for name in ("equal_time.md", "equal_error.md"):
            self.assertIn("Too few seeds (2, not 5)", text[name])
            self.assertNotIn("**", text[name])

    def test_indirect_light_takes_its_time(self):
        lit = [{**row, "indirect_cpu_s": "3"} for row in rows("a", [1], [0.5], scatter=0)]
        row = next(csv.DictReader(outputs(lit)["statistics.csv"].splitlines()))
        self.assertEqual(row["cpu_s_median"], "4.0")
        self.assertAlmostEqual(float(row["efficiency"]), 1)

    def test_a_swept_parameter_with_the_name_of_a_column_has_one_of_its_own(self):
        cells = [tool.Scored(tool.records.Cell("pool", "a", {"efficiency": effort}, list(rows("a", [1], [0.5])))) for effort in "12"]
        for row, effort in zip(csv.DictReader(tool.statistics_csv(cells).splitlines()), "12"):
            self.assertEqual(row["swept_efficiency"], effort)
            self.assertAlmostEqual(float(row["efficiency"]), 4, places=2)

    def test_the_better_method_alone_is_bold(self):
        text = outputs(rows("good", [1, 4], [0.4, 0.2]), rows("poor", [1, 4], [0.8, 0.4]))["equal_time.md"]
        good, poor = (next(line for line in text.splitlines() if line.startswith(f"| {name}")) for name in ("good", "poor"))
        self.assertEqual(good.count("**"), 2 * tool.STEPS)
        self.assertNotIn("**", poor)

    def test_what_the_seeds_do_not_tell_is_a_tie(self):
        text = outputs(rows("one", [1, 4], [0.4, 0.2], scatter=0.5), rows("two", [1, 4], [0.41, 0.205], scatter=0.5))
        for name in ("equal_time.md", "equal_error.md"):
            for method in ("one", "two"):
                line = next(line for line in text[name].splitlines() if line.startswith(f"| {method}"))
                self.assertEqual(line.count("**"), 2 * tool.STEPS, text[name])

    def test_scenes_set_differently_are_not_compared(self):
        text = outputs(rows("one", [1, 4], [0.4, 0.2]), rows("two", [1, 4], [0.4, 0.2], reference="lighttrace:2"))
        self.assertEqual(text["equal_time.md"].count("Fewer than two methods"), 2)

    def test_the_same_records_give_the_same_bytes(self):
        make = lambda: outputs(rows("one", [1, 4], [0.4, 0.2], scatter=0.3), rows("two", [1, 4], [0.5, 0.2], scatter=0.3))
        self.assertEqual(make(), make())


if __name__ == "__main__":
    unittest.main()
