"""tests/faults/faults.json: every fault still fits the sources, so that tools/plant_faults.py can plant it."""
import json
import pathlib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Faults(unittest.TestCase):
    def test_each_fits_one_place_and_changes_it(self):
        faults = json.loads((ROOT / "tests/faults/faults.json").read_text(encoding="utf-8"))
        self.assertGreaterEqual(len(faults), 15)
        for fault in faults:
            with self.subTest(fault["fault"]):
                text = (ROOT / fault["file"]).read_text(encoding="utf-8")
                self.assertEqual(text.count(fault["find"]), 1)
                self.assertNotEqual(fault["find"], fault["plant"])
                self.assertRegex(fault["target"], "^test_[a-z_]+$")


if __name__ == "__main__":
    unittest.main()
