"""Tests tools/report/indirect_growth.py on records whose shares and gains are known."""
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "tools"))

from report import indirect_growth


def keep(folder, name, swept, phases, seed=0):
    """A record whose wall seconds are half of its CPU seconds where `folder` is of two threads."""
    place = pathlib.Path(folder) / "trials" / name
    place.mkdir(parents=True)
    threads = 2 if pathlib.Path(folder).name == "two" else 1
    record = {"status": "done", "swept": swept, "seed": seed, "load": {"average": float(threads)},
              "phases": {phase: {"cpu": seconds * threads ** 0.5, "wall": seconds / threads} for phase, seconds in phases.items()}}
    (place / "record.json").write_text(json.dumps(record), encoding="utf-8")


class IndirectGrowth(unittest.TestCase):
    def test_takes_the_film_off_and_compares_threads(self):
        film = {"width": 20, "height": 10}
        room = {**film, "indirect_photons": 200_000, "indirect_gather": 16}
        with tempfile.TemporaryDirectory() as folder:
            for each in (pathlib.Path(folder) / "one", pathlib.Path(folder) / "two"):
                keep(each, "film", film, {"render": 1})
                keep(each, "film-again", film, {"render": 1})  # a repeat, no other seed
                for seed, gather in enumerate((4, 5, 9)):  # the median counts
                    keep(each, f"room{seed}", room, {"indirect/trace": 2, "indirect/balance": 1, "indirect/precompute": 2, "render": 1 + gather}, seed)
            text = indirect_growth.section(pathlib.Path(folder) / "one", pathlib.Path(folder) / "two")
        self.assertIn("| 200,000 | 16 | 200 | 2.00 (20 %) | 1.00 (10 %) | 2.00 (20 %) | 5.00 (50 %) | 10.00 |\n", text)
        self.assertIn("two threads take 5.0 s where one takes 10.0 s: 2.00 times", text)
        self.assertIn("seconds of two threads are 1.41 times those of one", text)
        self.assertIn("load average 1.0 to 2.0", text)
        self.assertIn("medians over 1 seeds", text)


if __name__ == "__main__":
    unittest.main()
