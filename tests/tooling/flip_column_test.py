"""tools/flip_column.py: pairs of pictures whose FLIP is known, and an untouched table where it is not installed.

With the argument `external` exits with 77 where its packages are missing.
"""
import contextlib
import csv
import io
import json
import math
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

import flip_column as tool
from report import records

try:
    import flip_evaluator  # noqa: F401
    import numpy
    import OpenEXR
    from report import exr
    from report_page import pictures
    MISSING = None
except ImportError as error:
    MISSING = f"{error} (pip install -r tools/flip-requirements.txt)"


def luma(linear):
    """L* of a grey."""
    return 116 * linear ** (1 / 3) - 16 if linear > (6 / 29) ** 3 else linear * (29 / 3) ** 3


def aces(x):
    """The tone curve of Narkowicz, as FLIP scales it."""
    x *= 0.6
    return min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14))


# HyAB of the farthest colours, sRGB's green (L* 87.73, a* -86.18, b* 83.18) and blue (32.30, 79.19, -107.86), a* and b*
# times L* / 100 after Hunt (Andersson et al. 2020, sec. 4.1.3).
FARTHEST = (87.73 - 32.30) + math.hypot(-0.8773 * 86.18 - 0.3230 * 79.19, 0.8773 * 83.18 + 0.3230 * 107.86)


def flip_of_greys(first, second):
    """Of two pictures of one grey each (no edges, no hue): HyAB is the difference of L*, to the power of 0.7, of which
    0.4 of the most is mapped to 0.95; HDR-FLIP is the largest over the exposures, here two, one stop apart."""
    start = math.log2(2.1188 / first)
    most = 0.0
    for exposure in (start, start + 1):
        shown = [luma(aces(grey * 2 ** exposure)) for grey in (first, second)]
        error = abs(shown[0] - shown[1]) ** 0.7
        knee, top = 0.4 * FARTHEST ** 0.7, FARTHEST ** 0.7
        most = max(most, 0.95 * error / knee if error < knee else 0.95 + 0.05 * (error - knee) / (top - knee))
    return most


def write_picture(file, beauty, caustic, unreached=None):
    planes = {}
    for prefix, layer in (("", beauty), ("caustic.", caustic)):
        for index, channel in enumerate("RGB"):
            planes[prefix + channel] = numpy.ascontiguousarray(layer[..., index], dtype=numpy.float32)
    if unreached is not None:
        planes["unreached.Y"] = unreached.astype(numpy.float32)
    file.parent.mkdir(parents=True, exist_ok=True)
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, planes).write(str(file))


def write_sweep(folder, trials, columns=()):
    """records.csv and the records of trials, each with the reference `key`; one has no reference."""
    header = [*records.REQUIRED, "reference", *columns]
    with open(folder / "records.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, header, lineterminator="\n")
        writer.writeheader()
        for trial in trials:
            writer.writerow({"trial": trial, "status": "done", "scene": "pool, calm", "method": "none", "seed": "1",
                             "reference": "lighttrace:key"})
            place = folder / "trials" / trial
            place.mkdir(parents=True)
            (place / "record.json").write_text(json.dumps({"trial": trial, "reference": {"key": "key"}}))
        writer.writerow({"trial": "alone", "status": "done", "scene": "pool", "method": "none", "seed": "1"})
    (folder / "records.jsonl").write_text("".join(json.dumps({"trial": trial, "flip": None}) + "\n"
                                                  for trial in [*trials, "alone"]))


def column(folder):
    with open(folder / "records.csv", newline="", encoding="utf-8") as file:
        return {row["trial"]: row["flip"] for row in csv.DictReader(file)}


class WithoutThePackages(unittest.TestCase):
    def test_says_so_and_changes_nothing(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_sweep(folder, ["a"], columns=["flip"])
            before = (folder / "records.csv").read_bytes()
            said = io.StringIO()
            with mock.patch.dict(sys.modules, {"flip_evaluator": None}), contextlib.redirect_stderr(said), \
                    mock.patch.object(sys, "argv", ["flip_column", name]):
                self.assertEqual(tool.main(), 0)
            self.assertEqual((folder / "records.csv").read_bytes(), before)
            self.assertEqual(column(folder), {"a": "", "alone": ""})
            self.assertIn("flip-requirements.txt", said.getvalue())


@unittest.skipIf(MISSING, MISSING)
class WithThePackages(unittest.TestCase):
    def setUp(self):
        name = tempfile.TemporaryDirectory()
        self.addCleanup(name.cleanup)
        self.folder = pathlib.Path(name.name)

    def grey(self, value, side=32):
        return numpy.full((side, side, 3), value, dtype=numpy.float32)

    def run_tool(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(said), mock.patch.object(sys, "argv", ["flip_column", str(self.folder)]):
            code = tool.main()
        return code, said.getvalue()

    def test_pairs_of_greys_have_the_value_of_the_formula(self):
        # The reference: 0.3 direct and 0.2 caustic; trials with other caustics, and with noise in the direct light.
        write_sweep(self.folder, ["same", "brighter", "darker"])
        write_picture(self.folder / "references" / "key.exr", self.grey(0.5), self.grey(0.2))
        for trial, caustic in (("same", 0.2), ("brighter", 0.25), ("darker", 0.05)):
            write_picture(self.folder / "trials" / trial / "image.exr", self.grey(9), self.grey(caustic))
        self.assertEqual(self.run_tool(), (0, ""))
        found = column(self.folder)
        self.assertEqual(found["alone"], "")
        self.assertEqual(float(found["same"]), 0)
        self.assertAlmostEqual(float(found["brighter"]), flip_of_greys(0.5, 0.55), delta=1e-3)
        self.assertAlmostEqual(float(found["darker"]), flip_of_greys(0.5, 0.35), delta=1e-3)
        record = json.loads((self.folder / "trials" / "darker" / "record.json").read_text())
        self.assertEqual(repr(record["flip"]), found["darker"])
        lines = [json.loads(line) for line in (self.folder / "records.jsonl").read_text().splitlines()]
        self.assertEqual([line["flip"] for line in lines if line["trial"] == "darker"], [record["flip"]])

    def test_the_map_is_kept_and_names_its_picture(self):
        write_sweep(self.folder, ["a"])
        write_picture(self.folder / "references" / "key.exr", self.grey(0.5), self.grey(0.2))
        caustic = self.grey(0.2)
        caustic[:16] = 0.3
        place = self.folder / "trials" / "a"
        write_picture(place / "image.exr", self.grey(0.5), caustic)
        (place / "record.json").write_text(json.dumps({"reference": {"key": "key"}, "picture_hash": "abc"}))
        self.assertEqual(self.run_tool(), (0, ""))
        values = pictures.read_flip(place / "flip.exr", "abc")
        self.assertEqual(values.shape, (1, 32, 32))
        self.assertAlmostEqual(float(values.mean(dtype=float)), float(column(self.folder)["a"]), places=7)
        self.assertGreater(values[0, :8].min(), 10 * values[0, 24:].max())
        self.assertEqual([path.name for path in sorted(place.iterdir())], ["flip.exr", "image.exr", "record.json"])
        with self.assertRaisesRegex(exr.PictureError, "of another picture"):
            pictures.read_flip(place / "flip.exr", "abd")

    def test_pixels_that_are_not_reached_count_nothing(self):
        write_sweep(self.folder, ["a"], columns=["flip"])
        caustic, unreached = self.grey(0.2), numpy.zeros((32, 32))
        write_picture(self.folder / "references" / "key.exr", self.grey(0.5), caustic)
        caustic[8:16], unreached[8:16] = 5, 1
        write_picture(self.folder / "trials" / "a" / "image.exr", self.grey(0.5), caustic, unreached)
        self.assertEqual(self.run_tool()[0], 0)
        self.assertEqual(column(self.folder)["a"], "0.0")

    def test_a_black_reference_has_no_value(self):
        write_sweep(self.folder, ["a"])
        write_picture(self.folder / "references" / "key.exr", self.grey(0), self.grey(0))
        write_picture(self.folder / "trials" / "a" / "image.exr", self.grey(1), self.grey(1))
        self.assertEqual(self.run_tool()[0], 0)
        self.assertEqual(column(self.folder)["a"], "")

    def test_half_a_picture_may_be_black(self):
        write_sweep(self.folder, ["a"])
        beauty, caustic = self.grey(0), self.grey(0)
        beauty[12:18, 12:18] = 1
        write_picture(self.folder / "references" / "key.exr", beauty, caustic)
        caustic[12:18, 12:18] = 0.1
        write_picture(self.folder / "trials" / "a" / "image.exr", beauty, caustic)
        self.assertEqual(self.run_tool()[0], 0)
        self.assertTrue(0 < float(column(self.folder)["a"]) < 0.1)

    def test_a_missing_reference_is_named(self):
        write_sweep(self.folder, ["a"])
        code, said = self.run_tool()
        self.assertEqual(code, 2)
        self.assertIn("key.exr", said)


if __name__ == "__main__":
    if sys.argv[1:] == ["external"]:
        if MISSING:
            print(f"skipped: {MISSING}")
            sys.exit(77)
        sys.argv.pop()
    unittest.main()
