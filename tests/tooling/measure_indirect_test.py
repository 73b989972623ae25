"""Tests what tools/measure_indirect.py sweeps with --quick, and its gains on records whose errors are known."""
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import measure_indirect


class MeasureIndirect(unittest.TestCase):
    def test_a_quick_sweep_has_all_methods_on_small_films(self):
        for name in ("indirect_room", "indirect_growth"):
            whole = json.loads((ROOT / "experiments" / "sweeps" / f"{name}.json").read_text(encoding="utf-8"))
            with tempfile.TemporaryDirectory() as folder:
                path = measure_indirect.sweep_name(name, pathlib.Path(folder), True)
                quick = json.loads(path.with_name(f"{name}.json").read_text(encoding="utf-8"))
            self.assertEqual(quick["indirect"], whole["indirect"])
            self.assertEqual(quick.get("reference"), whole.get("reference"))
            self.assertEqual(len(quick["seeds"]), 1)
            for way in ("width", "height"):
                values = quick["set"][way]["values"]
                self.assertEqual(len(set(values)), len(whole["set"][way]["values"]))
                self.assertLess(max(values), 40)
            for scene in quick["scenes"]:
                self.assertTrue(pathlib.Path(scene).is_file(), scene)
            self.assertEqual(measure_indirect.sweep_name(name, pathlib.Path(folder), False), name)

    def test_gains_are_those_of_known_errors(self):
        # s = 16 at one path; the reference of 1024 paths adds 16 / 1024 to each squared error.
        row = lambda indirect, square, seconds, **own: {"indirect": indirect, "indirect_rmse": str((square + 16 / 1024) ** 0.5),
                                                        "indirect_s": "0", "cpu_s": str(seconds + 1), **own}
        cells = measure_indirect.measured([row("", 0, 0), row("pathtrace", 1, 2, indirect_spp="16"),
                                           row("globalphotonmap", 0.25, 4, indirect_photons="9", indirect_gather="4")], 1)
        lines = list(measure_indirect.table(cells))
        self.assertIn("| pathtrace |  | 1 paths |  | 1 | 0.0 | 2.0 | 1.0 |", lines[0])
        self.assertIn("| globalphotonmap | 9 | 4 |  | 0.5 | 0.0 | 4.0 | 2.0 |", lines[1])  # 8 s of paths for half the error


if __name__ == "__main__":
    unittest.main()
