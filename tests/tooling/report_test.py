"""tools/make_report.py from outside: what the page holds is what the records and pictures hold; holes; errors in one line.

Exits with 77 where NumPy or SciPy is missing.
"""
import csv
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.path.insert(0, str(ROOT / "tests" / "tooling"))

try:
    import numpy
    import scipy  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

import make_report
import report_sweep as sweep
from report import exr, record_tables, records
from report_page import page, pictures, scenes, tables

TOOL = ROOT / "tools" / "make_report.py"


class Exr(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "a.exr"

    def test_every_kind_reads_back(self):
        noise = numpy.random.default_rng(1)
        for kind in ("<f4", "<f2", "<u4"):
            for compression in (0, 2, 3):
                for smooth in (True, False):
                    values = numpy.arange(37 * 5).reshape(37, 5) if smooth else noise.integers(0, 2047, (37, 5))
                    planes = {"R": values.astype(kind), "a.b": (values // 2).astype(kind)}
                    with self.subTest(kind=kind, compression=compression, smooth=smooth):
                        sweep.write_exr(self.path, planes, compression, kind, [("note", "ü")])
                        found, texts = exr.read(self.path)
                        self.assertEqual(sorted(found), sorted(planes))
                        for name, plane in planes.items():
                            self.assertTrue(numpy.array_equal(found[name], plane), name)
                        self.assertEqual(texts["note"], "ü")

    @unittest.skipUnless(shutil.which("oiiotool"), "needs oiiotool")
    def test_a_kept_reference_reads_as_openimageio_reads_it(self):
        path = ROOT / "experiments" / "references" / "16cfc114e245802d.exr"
        text = subprocess.run(["oiiotool", "--dumpdata", path], capture_output=True, text=True, check=True).stdout
        found, _ = exr.read(path)
        names = ("R", "G", "B", "caustic.R", "caustic.G", "caustic.B", "stderr.Y", "unreached.Y")
        lines = re.findall(r"Pixel \((\d+), (\d+)\): (.*)", text)
        self.assertEqual((len(lines), set(found)), (128 * 96, set(names)))
        for x, y, values in lines:
            for name, value in zip(names, map(float, values.split())):
                self.assertAlmostEqual(float(found[name][int(y), int(x)]), value, delta=1e-8 + 1e-6 * abs(value))

    def test_damage_is_named(self):
        sweep.write_exr(self.path, {"R": numpy.sin(numpy.arange(1200)).reshape(40, 30) // 0.1})
        whole = self.path.read_bytes()
        for what, data in (("no OpenEXR file", b"no picture"), ("no OpenEXR file", b""), ("cut short", whole[:len(whole) // 2]),
                           ("cut short", whole[:60]), ("damaged", whole[:-100] + bytes(100)),
                           ("tiles or several parts", whole[:5] + b"\x02" + whole[6:])):
            with self.subTest(what, size=len(data)):
                self.path.write_bytes(data)
                with self.assertRaisesRegex(exr.PictureError, what):
                    exr.read(self.path)

    def test_what_never_ends_is_no_picture(self):
        os.mkfifo(self.path)
        device = self.path.with_name("device.exr")
        device.symlink_to("/dev/zero")
        for path in (self.path, device, self.path.parent):
            with self.assertRaisesRegex(exr.PictureError, "^no regular file$"):
                exr.read(path)
        link = self.path.with_name("link.exr")
        sweep.write_exr(self.path.with_name("b.exr"), {"R": numpy.ones((4, 4))})
        link.symlink_to("b.exr")
        self.assertEqual(list(exr.read(link)[0]), ["R"])

    def test_every_cut_of_a_file_is_an_error_of_one_kind(self):
        sweep.write_exr(self.path, {"R": numpy.ones((4, 4))})
        whole = self.path.read_bytes()
        for size in range(len(whole)):
            self.path.write_bytes(whole[:size])
            with self.assertRaises(exr.PictureError):
                exr.read(self.path)


class Packing(unittest.TestCase):
    def test_values_are_the_halves_of_their_scaled_selves(self):
        for largest in (1e-6, 0.7, 3e6):
            values = (numpy.random.default_rng(2).random((3, 9, 7)) * largest).astype(numpy.float32)
            about, text = pictures.packed(values)
            halves = numpy.ldexp(values.astype(float), about["scale"]).astype(numpy.float16)
            self.assertTrue(numpy.array_equal(pictures.unpacked(about, text), numpy.ldexp(halves.astype(float), -about["scale"])))
            self.assertLess(float(halves.max()), 2 ** 14 + 1)
            self.assertLess(numpy.abs(pictures.unpacked(about, text) - values).max() / largest, 2 ** -11)

    def test_equal_channels_are_kept_once(self):
        plane = numpy.ones((4, 5), numpy.float32)
        self.assertEqual(pictures.packed(numpy.stack([plane] * 3))[0]["planes"], 1)
        self.assertEqual(pictures.packed(numpy.stack([plane, plane, 2 * plane]))[0]["planes"], 3)


class Numbers(unittest.TestCase):
    def test_no_size_of_a_number_loses_its_digits(self):
        for value, half, text in ((0.37091, 0.00999, r"$0.3709 \pm 0.0100$"), (123.4, 45.6, r"$123 \pm 46$"),
                                  (7.418e-7, 1.998e-8, r"$(7.42 \pm 0.20) \cdot 10^{-7}$"),
                                  (7.418e-300, 1.998e-301, r"$(7.42 \pm 0.20) \cdot 10^{-300}$"),
                                  (7418179.4, 199783.0, r"$(7.42 \pm 0.20) \cdot 10^{6}$"),
                                  (-7.418e-7, 1.998e-8, r"$(-7.42 \pm 0.20) \cdot 10^{-7}$"),
                                  (0.0, 3e-8, r"$(0.0 \pm 3.0) \cdot 10^{-8}$"),
                                  (1.0123, 2.2e-16, r"$1.0123 \pm 2.2 \cdot 10^{-16}$"),
                                  (3.5483e-7, None, r"$3.55 \cdot 10^{-7}$"), (0.0, 0.0, "$0$"), (None, None, "--")):
            self.assertEqual(tables.number_tex(value, half), text)


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.output = self.folder / "report.html"
        self.sweep = self.folder / "sweep"
        self.rows = sweep.write_sweep(self.sweep)

    def run_tool(self, *words):
        return subprocess.run([sys.executable, TOOL, *words, "-o", self.output], capture_output=True, text=True, encoding="utf-8")

    def page(self, *words):
        done = self.run_tool(*(words or (self.sweep,)))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.notes = done.stderr
        self.text = self.output.read_text(encoding="utf-8")
        return json.loads(re.search(r'id="data">(.*?)</script>', self.text, re.S)[1])

    def refuses(self, *words, directory=None):
        done = self.run_tool(directory or self.sweep)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse(self.output.exists())

    def picture(self, data, number):
        text = re.search(rf'id="p{number}">([^<]*)<', self.text)[1]
        return pictures.unpacked(data["pictures"][number], text)

    def test_every_record_is_there_to_the_last_digit(self):
        data = self.page()
        with open(self.sweep / "records.csv", newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.assertEqual((data["tables"][0]["header"], data["tables"][0]["rows"]), (header, rows))

    def test_the_same_folder_gives_the_same_bytes(self):
        self.page()
        first = self.text
        self.page()
        self.assertTrue(first == self.text)

    def test_cells_have_means_and_students_intervals(self):
        cell = next(cell for cell in self.page()["scenes"][0]["cells"] if cell["label"] == "photonmap, 1k photons")
        own = [float(row["rmse"]) for row in self.rows if row["method"] == "photonmap" and row["photons"] == "1000"]
        mean, half = cell["errors"]["rmse"]
        self.assertEqual(mean, statistics.mean(own))
        deviation = numpy.std(own, ddof=1)
        self.assertAlmostEqual(half, 2.7764451 * deviation / 5 ** 0.5, places=9)
        self.assertEqual(cell["errors"]["variance"], [0.25, None])
        self.assertAlmostEqual(cell["costs"]["build_s"], 0.1)
        self.assertAlmostEqual(cell["costs"]["query_s"], 0.203)
        self.assertAlmostEqual(cell["costs"]["work_s"], 0.303)

    def test_pixels_are_those_of_the_pictures(self):
        data = self.page()
        scene, = data["scenes"]
        for cell in scene["cells"]:
            step = {"1k": 1, "2k": 2, "4k": 4}[cell["label"].split()[1]] if cell["method"] == "photonmap" \
                else int(cell["parameters"]["mesh_resolution"]) // 16
            for picture in cell["pictures"]:
                values, _ = sweep.picture_of(cell["method"], int(picture["seed"]), step)
                found = self.picture(data, picture["caustic"])
                scale = data["pictures"][picture["caustic"]]["scale"]
                halves = numpy.ldexp(numpy.ldexp(values.astype(float), scale).astype(numpy.float16).astype(float), -scale)
                self.assertTrue(numpy.array_equal(found, halves), cell["label"])
        caustic, rest, unreached = sweep.reference_planes()
        layers = scene["reference"]["layers"]
        self.assertTrue(numpy.array_equal(self.picture(data, layers["unreached"])[0], unreached))
        self.assertLess(numpy.abs(self.picture(data, layers["caustic"]) - caustic).max(), 1e-3)
        self.assertLess(numpy.abs(self.picture(data, scene["rest"]) - rest).max(), 1e-6)
        self.assertAlmostEqual(float(self.picture(data, layers["stderr"])[0, 0, 0]), 0.001, delta=1e-6)

    def test_each_picture_has_its_command_and_hash(self):
        picture = self.page()["scenes"][0]["cells"][0]["pictures"][0]
        self.assertEqual(picture["command"], "causticbench render ring.json --method beamtree --seed 1 --threads 1 --isa plain "
                         "-o ring-beamtree-1-s1.exr")
        self.assertEqual(picture["hash"], self.rows[15]["picture_hash"])

    def test_equal_time_takes_the_best_within_the_time(self):
        scene, = self.page()["scenes"]
        for contest in scene["contests"]:
            for method, pick in contest["picks"].items():
                within = [cell for cell in scene["cells"] if cell["method"] == method and cell["costs"]["work_s"] <= contest["seconds"]]
                self.assertEqual(scene["cells"][pick]["errors"]["rmse"][0], min(cell["errors"]["rmse"][0] for cell in within))
        chosen = scene["contests"][scene["contest"]]
        self.assertEqual(set(chosen["picks"]), {"photonmap", "beamtree"})
        self.assertEqual({scene["cells"][i]["label"] for i in chosen["best"]}, {"beamtree, mesh_resolution 32"})

    def test_flip_is_there_where_its_column_is_filled(self):
        self.assertNotIn("flip", self.page()["errors"])
        for row in self.rows:
            row["flip"] = "0.125"
        sweep.write_table(self.sweep, self.rows)
        data = self.page()
        self.assertIn("flip", data["errors"])
        self.assertEqual(data["scenes"][0]["cells"][0]["errors"]["flip"], [0.125, 0.0])

    def test_flip_maps_are_kept_beside_their_pictures(self):
        sweep.add_flip(self.sweep, self.rows)
        first, second = (self.sweep / "trials" / self.rows[i]["trial"] / "flip.exr" for i in (15, 16))
        first.unlink()
        second.write_bytes((self.sweep / "trials" / self.rows[0]["trial"] / "flip.exr").read_bytes())
        data = self.page()
        found = data["scenes"][0]["cells"][0]["pictures"]
        self.assertIn("no such file", found[0]["flip"]["hole"])
        self.assertIn("of another picture (run tools/flip_column.py again)", found[1]["flip"]["hole"])
        self.assertLess(numpy.abs(self.picture(data, found[2]["flip"])[0] - numpy.linspace(0, 1, sweep.WIDTH)).max(), 1e-3)

    def test_indirect_light_is_a_layer_of_its_own(self):
        sweep.add_indirect(self.sweep, self.rows)
        data = self.page()
        scene, = data["scenes"]
        _, rest, _ = sweep.reference_planes()
        self.assertLess(numpy.abs(self.picture(data, scene["rest"]) - rest).max(), 1e-6)
        self.assertAlmostEqual(float(self.picture(data, scene["reference"]["layers"]["indirect"])[0, 0, 0]), 0.25, delta=1e-4)
        self.assertAlmostEqual(float(self.picture(data, scene["reference"]["layers"]["indirect_stderr"])[0, 0, 0]), 0.002, delta=1e-5)
        cell = scene["cells"][0]
        for each in cell["pictures"]:
            self.assertAlmostEqual(float(self.picture(data, each["indirect"])[0, 0, 0]), 0.25 + 0.01 * int(each["seed"]), delta=1e-4)
        self.assertAlmostEqual(cell["errors"]["indirect_rmse"][0], 0.03)
        self.assertEqual(cell["costs"]["indirect_cpu_s"], 0.5)

    def test_cells_are_named_by_what_tells_them_apart(self):
        some = types.SimpleNamespace(folder="a")
        cell = lambda method, **parameters: types.SimpleNamespace(method=method, parameters=parameters, sweep=some)
        scene = types.SimpleNamespace(cells=[
            cell("none"), cell("none", indirect="pathtrace", indirect_spp="4"),
            cell("none", indirect="globalphotonmap", indirect_gather="4", indirect_photons="20000"),
            cell("none", indirect="globalphotonmap", indirect_gather="16", indirect_photons="20000"),
            cell("beamtree", intensity="area"), cell("beamtree", intensity="area", footprint="0.02"), cell("beamtree", intensity="refined")])
        scenes.name_cells(scene)
        self.assertEqual([cell.label for cell in scene.cells], [
            "none", "none, indirect pathtrace", "none, indirect globalphotonmap (gather 4)", "none, indirect globalphotonmap (gather 16)",
            "beamtree, intensity area", "beamtree, intensity area, footprint 0.02", "beamtree, intensity refined"])
        self.assertEqual(scene.cells[2].line, scene.cells[3].line, "a line along the rays")
        self.assertNotEqual(scene.cells[4].line, scene.cells[5].line, "none along a length")

    def test_too_few_seeds_have_no_best(self):
        shutil.rmtree(self.sweep)
        sweep.write_sweep(self.sweep, seeds=(1, 2, 3))
        scene, = self.page()["scenes"]
        self.assertEqual([contest["best"] for contest in scene["contests"]], [[]] * len(scene["contests"]))
        self.assertFalse(any(cell["tied"] for cell in scene["cells"]))

    def test_no_error_at_all_is_a_tie(self):
        """Of a black setting: both methods have no error, or one has none and the other next to none."""
        for tiny, best in (("0", {"photonmap", "beamtree"}), ("1e-310", {"photonmap"})):
            for row in self.rows:
                row["rmse"] = "0" if row["method"] == "photonmap" else tiny
            sweep.write_table(self.sweep, self.rows)
            scene, = self.page(self.sweep, "--tables", self.folder / "tables")["scenes"]
            contest = scene["contests"][scene["contest"]]
            self.assertEqual({scene["cells"][i]["method"] for i in contest["best"]}, best)
            self.assertEqual({cell["method"] for cell in scene["cells"] if cell["tied"]}, best)

    def test_the_file_asks_for_nothing(self):
        self.page()
        self.assertEqual(re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', self.text), [])
        own = self.text.replace("http://www.w3.org/2000/svg", "")
        self.assertEqual(re.findall("http(?!-equiv)|@import", own), [])
        self.assertTrue("default-src 'none'" in self.text)

    def test_names_cannot_end_the_script(self):
        self.rows[0]["message"] = "</script><script>alert(1)</script>"
        sweep.write_table(self.sweep, self.rows)
        data = self.page()
        self.assertIn("</script><script>alert(1)</script>", data["tables"][0]["rows"][0])
        self.assertEqual(self.text.count("<script>"), 1)

    def test_missing_and_damaged_pictures_are_holes(self):
        trial = lambda i: self.sweep / "trials" / self.rows[i]["trial"] / "image.exr"
        trial(0).unlink()
        trial(1).write_bytes(trial(2).read_bytes()[:500])
        small = numpy.ones((3, 2), numpy.float32)
        sweep.write_exr(trial(3), sweep.planes_of(numpy.stack([small] * 3), small))
        wrong = numpy.stack([small] * 3)
        wrong[1, 2, 1] = numpy.nan
        sweep.write_exr(trial(4), sweep.planes_of(wrong, small))
        scene, = self.page()["scenes"]
        holes = {picture["trial"]: picture["hole"] for cell in scene["cells"] for picture in cell["pictures"] if "hole" in picture}
        for i, word in enumerate(("no such file", "damaged, or cut short", "2 x 3 pixels beside others of 16 x 12",
                                  "not finite at pixel (1, 2)")):
            position = i if i < 2 else i + 1
            self.assertIn(word, holes[self.rows[position]["trial"]])
            self.assertIn(self.rows[position]["trial"], self.notes)
        self.assertEqual(len(holes), 4)
        self.assertEqual(len(scene["cells"]), 5)

    def test_a_picture_of_another_trial_is_a_hole(self):
        row, parameters = {"method": "photonmap", "seed": "2", "spp": "4"}, {"nearest": "50", "tree": "packed", "alpha": "0.1"}
        said = {"method": "photonmap", "seed": "2", "spp": "4"}
        texts = lambda given, **known: {f"causticbench.{name}": value for name, value in
                                        (said | {"parameters": json.dumps(given)} | known).items()}
        page.require_own(texts({"nearest": 50, "tree": "packed"}), row, parameters)
        page.require_own({}, row, parameters)
        pool = {"mesh_resolution": "128"}
        water = "causticbench render pool.json --method photonmap --set /water/resolution=128 --param mesh_resolution=64"
        page.require_own(texts({"mesh_resolution": 64}, command=water), row, pool)
        for command in (water.replace("128", "256"), "causticbench render 'pool.json --set /water/resolution=128", ""):
            with self.assertRaisesRegex(exr.PictureError, "of mesh_resolution 64 in place of 128"):
                page.require_own(texts({"mesh_resolution": 64}, command=command), row, pool)
        for given, known, words in (({"nearest": 20}, {}, "of nearest 20 in place of 50"), ({}, {"seed": "1"}, "of seed 1 in place of 2"),
                                    ({"tree": "balanced"}, {}, "of tree balanced"), ({}, {"method": "beamtree"}, "of method beamtree"),
                                    ({}, {"parameters": "[1"}, "no JSON object"), ({}, {"parameters": "[1]"}, "no JSON object")):
            with self.assertRaisesRegex(exr.PictureError, words):
                page.require_own(texts(given, **known), row, parameters)

    def test_a_missing_reference_is_a_hole(self):
        (self.sweep / "references" / f"{sweep.KEY}.exr").unlink()
        scene, = self.page()["scenes"]
        self.assertIn("in none of the folders of references", scene["reference"]["hole"])
        self.assertIn("pictures", scene["cells"][0])

    def test_a_pipe_in_the_place_of_a_picture_is_a_hole(self):
        path = self.sweep / "trials" / self.rows[0]["trial"] / "image.exr"
        path.unlink()
        os.mkfifo(path)
        self.page()
        self.assertIn(f"the picture of {self.rows[0]['trial']}: no regular file", self.notes)

    def test_a_reference_that_errors_are_not_against_is_a_hole(self):
        reference = self.page()["scenes"][0]["reference"]
        self.assertEqual((self.notes, "hole" in reference), ("", False))
        mean = float(self.rows[0]["reference_mean"])
        for judged, changed, count in ((mean * (1 + 1e-12), 1, 0), (mean * (1 + 1e-6), 1, 1), (2 * mean, len(self.rows), len(self.rows))):
            for row in self.rows[:changed]:
                row["reference_mean"] = repr(judged)
            sweep.write_table(self.sweep, self.rows)
            reference = self.page()["scenes"][0]["reference"]
            words = f"the errors of {count} of {len(self.rows)} trials are against another picture, of mean {judged:.7g}"
            self.assertEqual(words in self.notes and words in reference.get("hole", ""), count > 0)
            self.assertEqual("run the sweep again, which takes errors anew" in self.notes, count > 0)
            self.assertEqual("layers" in reference, count == 0)

    def test_kept_sweeps_have_the_references_that_their_errors_are_against(self):
        for name in ("quickstart-2026-11", "photons-2026-11"):
            for scene in scenes.scenes_of([scenes.Sweep(ROOT / "results" / name)]):
                path = ROOT / "experiments" / "references" / f"{scene.reference.partition(':')[2]}.exr"
                self.assertIsNone(page.judged_by_another(scene, page.mean_of(pictures.read(path)[0])), path)

    def test_what_does_not_fit_is_left_out_loudly(self):
        sweep.add_indirect(self.sweep, self.rows)
        data = self.page(self.sweep, "--megabytes", "0.008")
        self.assertGreater(data["left_out"], 0)
        self.assertIn(f"{data['left_out']} pictures left out to stay within 0.008 MB", self.notes)
        kept = [[isinstance(picture.get("caustic"), int) for picture in cell["pictures"]] for cell in data["scenes"][0]["cells"]]
        self.assertTrue(all(cell[0] for cell in kept), "first seeds come first")
        self.assertLess(self.bytes_of_pictures(), 8000)
        wanted, = re.findall(r"--megabytes (\S+) keeps all", self.notes)
        self.assertEqual(float(wanted), data["megabytes_wanted"])
        self.assertEqual(self.page(self.sweep, "--megabytes", wanted)["left_out"], 0)
        self.assertAlmostEqual(self.bytes_of_pictures() / 1e6, float(wanted), delta=0.01)

    def bytes_of_pictures(self):
        return sum(len(text) for text in re.findall(r'id="p\d+">([^<]*)<', self.text))

    def test_the_quick_starts_page_leaves_no_picture_out(self):
        """Even if nothing of its pictures could be deflated: three halves a pixel, in base64, of each trial and of six layers a reference."""
        script = (ROOT / "tools" / "quickstart.sh").read_text(encoding="utf-8")
        words = re.findall(r'"\$bench" report ([^|]*)\|\|', script)[0].replace('"', "").split()
        with unittest.mock.patch.object(sys, "argv", ["report", *words]):
            allowed = make_report.arguments().megabytes
        most = 0
        for scene in scenes.scenes_of([scenes.Sweep(ROOT / "results" / "quickstart-2026-11")]):
            path = ROOT / "experiments" / "references" / f"{scene.reference.partition(':')[2]}.exr"
            count = 6 + sum(len(cell.seeds()) for cell in scene.cells)
            most += count * exr.read(path)[0]["R"].size * 3 * 2 * 4 / 3
        self.assertGreater(allowed * 1e6, most)

    def test_several_folders_are_one_page(self):
        other = self.folder / "other"
        sweep.write_sweep(other, scenes=("pool",))
        data = self.page(self.sweep, other)
        self.assertEqual([scene["name"] for scene in data["scenes"]], ["pool", "ring"])
        self.assertEqual([table["folder"] for table in data["tables"]], ["sweep", "other"])

    def test_light_that_a_caustic_lacks_is_told_from_1_percent_on(self):
        shares = {"caustic_missed_by_cut": "0.117", "caustic_missed_by_pruning": "0.009"}
        rows = [{**row, **shares} for row in self.rows]
        with open(self.sweep / "records.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        missed = self.page(self.sweep)["scenes"][0]["missed"]
        self.assertEqual({text.split(": ")[1] for text in missed}, {"the caustic lacks 11.7 % cut at max_bounces"})
        self.assertIn("the caustic lacks 11.7 % cut at max_bounces.",
                      record_tables.summary_md(records.read(self.sweep / "records.csv")))

    def test_a_sum_that_is_none_of_chance_is_told(self):
        def missed(ratio, error):
            rows = [{**row, "caustic_sum": ratio, "caustic_sum_error": error} for row in self.rows]
            with open(self.sweep / "records.csv", "w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, rows[0])
                writer.writeheader()
                writer.writerows(rows)
            return {text.split(": ")[1] for text in self.page(self.sweep)["scenes"][0]["missed"]}
        self.assertEqual(missed("1.083", "0.02"), {"the picture has 1.08 of the light that arrives where the camera sees it"})
        self.assertEqual(missed("0.87", "0.02"), {"the picture has 0.87 of the light that arrives where the camera sees it"})
        self.assertEqual(missed("1.083", "0.03"), set())
        self.assertEqual(missed("1.009", "0.001"), set())

    def test_trials_that_are_not_done_are_named_with_their_reason(self):
        self.rows[0].update(status="unsupported", message="no way")
        sweep.write_table(self.sweep, self.rows)
        scene, = self.page()["scenes"]
        self.assertEqual(scene["not_done"], [{"trial": self.rows[0]["trial"], "status": "unsupported", "method": "photonmap", "message": "no way"}])

    def test_tables(self):
        tables = self.folder / "tables"
        self.page(self.sweep, "--tables", tables, "--columns", "rmse,work_s,bias")
        self.assertEqual({path.name for path in tables.iterdir()}, {"cells.csv", "equal_time.csv", "equal_time.tex", "cells-ring.tex"})
        with open(tables / "cells.csv", newline="", encoding="utf-8") as file:
            cells = list(csv.DictReader(file))
        own = [float(row["rmse"]) for row in self.rows if row["method"] == "photonmap" and row["photons"] == "4000"]
        cell = next(cell for cell in cells if cell["photons"] == "4000")
        self.assertEqual(cell["rmse"], repr(statistics.mean(own)))
        self.assertEqual((cell["variance"], cell["variance_half_interval_95"]), ("0.25", ""))
        text = (tables / "cells-ring.tex").read_text(encoding="utf-8")
        self.assertIn(r"\toprule", text)
        self.assertIn(r"\begin{table*}", text)
        self.assertIn("mesh 32", text)
        rows = [line for line in text.splitlines() if line.endswith(r"\\") and "multicolumn" not in line]
        self.assertEqual({line.count(" & ") for line in rows}, {3})
        self.assertRegex((tables / "equal_time.tex").read_text(encoding="utf-8"), r"beamtree & \\boldmath\{\$0\.\d+ \\pm")

    def test_one_setting_in_two_folders_is_two_cells_of_different_names(self):
        """Folders of one name, of two and of three seeds: nothing is merged, and everything says which it is from."""
        places = [self.folder / name / "run" for name in ("a", "b")]
        for place, seeds in zip(places, ((1, 2), (3, 4, 5))):
            sweep.write_sweep(place, seeds=seeds)
        made = self.folder / "tables"
        data = self.page(*places, "--tables", made)
        scene, = data["scenes"]
        labels = [cell["label"] for cell in scene["cells"]]
        self.assertEqual(len(labels), len(set(labels)))
        self.assertEqual(sorted(label for label in labels if "1k" in label),
                         ["photonmap, 1k photons, from a/run", "photonmap, 1k photons, from b/run"])
        self.assertEqual([table["folder"] for table in data["tables"]], ["a/run", "b/run"])
        with open(made / "cells.csv", newline="", encoding="utf-8") as file:
            self.assertEqual({(row["folder"], row["seeds"]) for row in csv.DictReader(file)}, {("a/run", "2"), ("b/run", "3")})
        with open(made / "equal_time.csv", newline="", encoding="utf-8") as file:
            self.assertTrue({row["folder"] for row in csv.DictReader(file)} <= {"a/run", "b/run"})
        self.assertIn(r"mean over 2 to 3 seeds $\pm$", (made / "cells-ring.tex").read_text(encoding="utf-8"))
        self.assertEqual((scene["seeds"], scene["seeds_text"]), (2, "2 to 3 seeds"))

    def test_no_scene_takes_the_name_of_another(self):
        """The same scene held against two references; and settings whose file names would be one."""
        other = self.folder / "other"
        rows = sweep.write_sweep(other, seeds=(6, 7))
        for row in rows:
            row["reference"] = "lighttrace:another"
        sweep.write_table(other, rows)
        made = self.folder / "tables"
        data = self.page(self.sweep, other, "--tables", made)
        self.assertEqual([scene["title"] for scene in data["scenes"]],
                         [f"ring, reference lighttrace:{sweep.KEY}", "ring, reference lighttrace:another"])
        self.assertEqual(len(list(made.glob("cells-*.tex"))), 2)
        titled = [types.SimpleNamespace(title=lambda text=text: text) for text in ("ring, z -1", "ring, z 1")]
        self.assertEqual(tables.file_names(titled), ["cells-ring_z_1.tex", "cells-ring_z_1_2.tex"])

    def test_swept_parameters_with_the_name_of_a_column_have_one_of_their_own(self):
        rows = [{**row, "work_s": "7", "seeds": "8", "folder": "9", "swept_seeds": "10"} for row in self.rows]
        with open(self.sweep / "records.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        made = self.folder / "tables"
        self.page(self.sweep, "--tables", made)
        with open(made / "cells.csv", newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            row = next(reader)
        self.assertEqual(len(reader.fieldnames), len(set(reader.fieldnames)))
        self.assertEqual([row[name] for name in ("swept_work_s", "swept_seeds", "folder", "swept_swept_seeds", "seeds")],
                         ["7", "8", "9", "10", "5"])
        self.assertNotEqual(row["work_s"], "7")
        summary = next(csv.reader(record_tables.summary_csv(records.read(self.sweep / "records.csv")).splitlines()))
        self.assertEqual((len(summary), summary.count("swept_seeds")), (len(set(summary)), 1))

    def test_unknown_columns_and_sizes_are_refused(self):
        done = self.run_tool(self.sweep, "--columns", "rmse,speed")
        self.assertEqual(done.returncode, 2)
        self.assertIn('unknown column speed (known: rmse, ', done.stderr)
        self.assertEqual(self.run_tool(self.sweep, "--megabytes", "-1").returncode, 2)

    def test_bad_folders_are_refused(self):
        self.refuses("no such folder", directory=self.folder / "nowhere")
        self.refuses("no records.csv", directory=self.folder)

    def test_no_link_is_replaced_by_the_page(self):
        self.output.symlink_to(self.folder / "page")
        self.refuses("report.html: is a symbolic link")
        self.assertTrue(self.output.is_symlink())

    def test_no_pipe_is_replaced_by_the_page(self):
        os.mkfifo(self.output)
        done = self.run_tool(self.sweep)
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
        self.assertIn("report.html: is no regular file", done.stderr)
        self.assertTrue(self.output.is_fifo())

    def test_pages_are_html(self):
        self.output = self.folder / "report.csv"
        self.refuses("report.csv: pages are written as .html")

    def test_a_file_in_the_place_of_the_tables_is_refused_before_the_page_is_written(self):
        done = self.run_tool(self.sweep, "--tables", self.sweep / "records.csv")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
        self.assertIn("records.csv: no folder for tables", done.stderr)
        self.assertFalse(self.output.exists())

    def test_a_trial_in_two_folders_is_refused_by_name(self):
        other = self.folder / "other"
        shutil.copytree(self.sweep, other)
        for second in (other, self.sweep):
            done = self.run_tool(self.sweep, second)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
            self.assertIn(f"{self.rows[0]['trial']}: is in {self.sweep} and in {second}", done.stderr)
            self.assertFalse(self.output.exists())

    def test_the_apostrophe_before_a_formula_is_no_part_of_the_text(self):
        for row in self.rows:
            row["scene"] = "'=ring"
        self.rows[0]["message"] = "'plain'"
        sweep.write_table(self.sweep, self.rows)
        data = self.page()
        self.assertEqual([scene["name"] for scene in data["scenes"]], ["=ring"])
        row = dict(zip(data["tables"][0]["header"], data["tables"][0]["rows"][0]))
        self.assertEqual((row["scene"], row["message"]), ("=ring", "'plain'"))
        self.assertEqual([records.plain(text) for text in ("'-a", "'+a", "'@a", "'\t", "'\r", "'", "''=", "-1")],
                         ["-a", "+a", "@a", "\t", "\r", "'", "'=", "-1"])
        for text in ("-a", "=1+1", "'=1", "''@a", "'plain'", "-1.5", "ring", ""):
            self.assertEqual(records.plain(records.marked(text)), text)

    def test_broken_records_are_refused(self):
        self.rows[3]["rmse"] = "nan"
        sweep.write_table(self.sweep, self.rows)
        self.refuses("line 5", 'column rmse is "nan"')
        self.rows[3]["rmse"] = "1e300"
        sweep.write_table(self.sweep, self.rows)
        self.refuses("line 5", 'column rmse is "1e300", expected a number whose square is finite')
        self.rows[3]["rmse"] = "0.1"
        for column, text, expected in (("peak_rss_bytes", "x", "a finite number"), ("map_bytes", "1e400", "a finite number"),
                                       ("load_average", "idle", "a finite number"), ("photons", "abc", "a finite number"),
                                       ("photons", "nan", "a finite number"), ("photons", "inf", "a finite number"),
                                       ("photons", "-5", "a number > 0"), ("photons", "0", "a number > 0"),
                                       ("render_cpu_s", "-1", "a number ≥ 0"), ("map_bytes", "-1", "a number ≥ 0")):
            rows = [dict(row) for row in self.rows]
            rows[3][column] = text
            sweep.write_table(self.sweep, rows)
            self.refuses("records.csv: line 5", f'column {column} is "{text}", expected {expected}')

    def test_trials_have_names_of_their_own(self):
        for name, words in ((self.rows[1]["trial"], f"lines 3 and 5 are both of the trial {self.rows[1]['trial']}"),
                            ("", "line 5 (trial without a name): column trial is empty")):
            self.rows[3]["trial"] = name
            sweep.write_table(self.sweep, self.rows)
            self.refuses(words)

    def test_names_that_lead_elsewhere_are_refused(self):
        for name in ("trial", "reference"):
            rows = [dict(row) for row in self.rows]
            rows[2][name] = "../../elsewhere"
            sweep.write_table(self.sweep, rows)
            self.refuses('"../../elsewhere" is no plain name')

    def test_a_pictures_command_is_words_for_a_shell(self):
        caustic, rest, _ = sweep.reference_planes()
        for command, wanted in (("causticbench render a; rm b $(c)", "causticbench render 'a;' rm b '$(c)' --threads 1"),
                                ("causticbench --set '/a={\"b\": 1}'", "causticbench --set '/a={\"b\": 1}' --threads 1"),
                                ("sh -c 'rm b'", "# the picture's command does more than render it"),
                                ("causticbench render a --param save=b", "# the picture's command does more"),
                                ("causticbench render a -o /b", "# the picture's command does more"),
                                ("causticbench 'open", "# the picture's command is broken")):
            sweep.write_exr(self.sweep / "trials" / self.rows[15]["trial"] / "image.exr", sweep.planes_of(caustic, rest),
                            texts=[("causticbench.command", command)])
            self.assertTrue(self.page()["scenes"][0]["cells"][0]["pictures"][0]["command"].startswith(wanted))

    def test_another_version_is_refused(self):
        (self.sweep / "plan.json").write_text('{"version": 2}')
        self.refuses("plan.json", "version 2", "reads version 1")
        for text in ("{", "[" * 100_000):
            (self.sweep / "plan.json").write_text(text)
            self.refuses("plan.json", "not a plan")


if __name__ == "__main__":
    unittest.main()
