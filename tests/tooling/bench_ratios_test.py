"""tools/bench_ratios without benchmarks: ratios by hand from made-up measurements, marks, and what is kept."""
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "bench_ratios"


def load():
    loader = importlib.machinery.SourceFileLoader("bench_ratios", str(TOOL))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench_ratios", loader))
    loader.exec_module(module)
    return module


bench_ratios = load()
keys = bench_ratios.bench_keys
ABOUT = {"isa": "avx2", "machine": {"cpu": "some", "cores": 2}, "commit": "abc", "quick": False}


def key_named(name):
    return next(key for key in keys.KEYS if key.name == name)


class Ratios(unittest.TestCase):
    def test_geometric_mean_over_the_benchmarks_that_match(self):
        runs = {"knn/a": {"nanoflann": 8.0, "packed": 1.0}, "knn/b": {"nanoflann": 4.0, "packed": 2.0},
                "tile/a": {"nanoflann": 1e9, "packed": 1.0}}
        self.assertAlmostEqual(keys.Ratio("nanoflann", "packed", "knn/").of(runs), 4.0)
        with self.assertRaises(KeyError):
            keys.Ratio("nanoflann", "packed", "nothing/").of(runs)

    def test_median_spread_and_marks_by_instruction_set(self):
        key = key_named("packed_knn_vs_nanoflann")
        for isa, met in (("avx2", True), ("avx512", False), ("plain", None)):
            entry = bench_ratios.entry_of(key, {"": [5.0, 7.0, 6.0]}, isa, ABOUT)
            self.assertEqual((entry["median"], entry["min"], entry["max"], entry["runs"]), (6, 5, 7, 3))
            self.assertIs(entry["must_met"], met)
            self.assertIs(entry["goal_met"], False)

    def test_a_key_meets_its_mark_when_every_part_does(self):
        key = key_named("query_cost_20x_photons")
        parts = {part: [1.2] for part in key.parts}
        self.assertTrue(bench_ratios.entry_of(key, parts, "avx2", ABOUT)["must_met"])
        parts["rendering balanced"] = [1.6]
        entry = bench_ratios.entry_of(key, parts, "avx2", ABOUT)
        self.assertFalse(entry["must_met"])
        self.assertFalse(entry["parts"]["rendering balanced"]["must_met"])
        self.assertTrue(entry["parts"]["rendering packed"]["must_met"])
        self.assertAlmostEqual(entry["median"], 1.2)  # of the queries alone

    def test_two_threads_are_compared_with_what_the_raw_rays_gain(self):
        run = {"trace_1": 3.0, "trace_2": 2.0, "replay_1": 4.0, "replay_2": 2.0}
        key = key_named("tracing_two_threads")
        self.assertAlmostEqual(key.parts["random"].of({"tracing_threads/ball65k/random": run}), 0.75)

    def test_emissions_are_compared_across_benchmarks(self):
        runs = {"tracing/ball65k/random": {"trace": 3.0}, "tracing/ball65k/stratified": {"trace": 1.5}}
        self.assertAlmostEqual(key_named("stratified_vs_random_emission").parts[""].of(runs), 2.0)

    def test_the_table_says_what_is_met(self):
        key = key_named("shading_vs_tables")
        text = bench_ratios.table({key.name: bench_ratios.entry_of(key, {"": [2.5]}, "avx512", ABOUT)})
        self.assertIn("| `shading_vs_tables` |", text)
        self.assertIn("| 2.50 | 2.50 – 2.50 | ≥ 2 met | ≥ 3 **not met** |", text)

    def test_every_key_is_written_and_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            results = {key.name: bench_ratios.entry_of(key, {part: [2.0, 3.0] for part in key.parts}, "avx512",
                                                       ABOUT) for key in keys.KEYS}
            bench_ratios.write(results, pathlib.Path(folder))
            self.assertEqual(json.loads((pathlib.Path(folder) / "ratios.json").read_text()), results)
            self.assertEqual(sorted(path.name for path in pathlib.Path(folder).iterdir()),
                             ["ratios.json", "ratios.md"])

    def test_bad_usage_is_refused(self):
        for words in (["--only", "nothing"], ["--isa", "neon"], ["--repetitions", "0"]):
            done = subprocess.run([sys.executable, TOOL, *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, words)


if __name__ == "__main__":
    unittest.main()
