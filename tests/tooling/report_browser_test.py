"""The report in a real browser: every control is used, nothing complains, nothing is asked for, and the numbers are right.

Exits with 77, and says so, where Debian's chromium, NumPy or SciPy is not installed.
"""
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.path.insert(0, str(ROOT / "tests" / "tooling"))

import browser

try:
    import numpy
    import scipy  # noqa: F401
except ImportError as error:
    print(f"SKIPPED, the report is NOT CHECKED in a browser: {error}")
    sys.exit(77)
if browser.PROGRAM is None:
    print("SKIPPED, the report is NOT CHECKED in a browser: needs the Debian package chromium")
    sys.exit(77)

import report_sweep as sweep

SETTLED = ("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 40))))"
           ".then(() => true)")
VARIANCE = 2.5 * 0.005 ** 2  # of the seeds 1 to 5 of write_sweep, at step 1


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.folder.name)
        cls.rows = sweep.write_sweep(folder / "sweep", scenes=("ring", "pool"))
        sweep.add_indirect(folder / "sweep", cls.rows)
        sweep.add_flip(folder / "sweep", cls.rows, ("beamtree",))
        cls.lost = cls.rows[0]["trial"]  # ring, photonmap, 1000 photons, seed 1... of the scene shown second
        (folder / "sweep" / "trials" / cls.lost / "image.exr").unlink()
        cls.page = folder / "report.html"
        subprocess.run([sys.executable, ROOT / "tools" / "make_report.py", folder / "sweep", "-o", cls.page], check=True,
                       capture_output=True)
        cls.browser = browser.Browser(1600, 1000)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.folder.cleanup()

    def setUp(self):
        self.open("")

    def tearDown(self):
        self.assertEqual(self.browser.console, [])
        self.assertEqual({url.partition("#")[0] for url in self.browser.requests if not url.startswith("data:")} - {"about:blank"},
                         {self.page.as_uri()})

    def open(self, fragment):
        self.browser.open("about:blank")
        self.browser.open(self.page.as_uri() + fragment)
        self.browser.wait_for("byId('strip').dataset.ready && byId('viewer').dataset.ready && true")
        self.settle()

    def run_script(self, script):
        return self.browser.run(script)

    def settle(self):
        self.run_script(SETTLED)
        self.browser.wait_for("!document.querySelector('[aria-busy]')")

    def press(self, *keys, modifiers=0):
        for key in keys:
            self.browser.press(key, modifiers)
        self.settle()

    def choose(self, name, value):
        self.run_script(f"(() => {{ const e = byId({json.dumps(name)}); e.value = {json.dumps(value)};"
                        " e.dispatchEvent(new Event('input', {bubbles: true})); e.dispatchEvent(new Event('change', {bubbles: true})); })()")
        self.settle()

    def click(self, selector):
        self.browser.drag(*[self.browser.place_of(selector)] * 2)
        self.settle()

    def state(self, name):
        return self.run_script(f"state.{name}")

    def text(self, selector):
        return self.run_script(f"document.querySelector({json.dumps(selector)}).textContent")

    def close_to(self, found, wanted, share=2e-3):
        self.assertLess(abs(found - wanted), share * abs(wanted), f"{found} is not {wanted}")

    def test_every_option_of_every_control_is_drawn(self):
        selects = self.run_script("[...document.querySelectorAll('select[id]')].map((e) => [e.id, [...e.options].map((o) => o.value)])")
        self.assertGreater(len(selects), 12)
        for name, values in selects:
            for value in [*values, values[0]]:
                if value:
                    self.choose(name, value)
        for name in ("exposure", "epsilon", "low", "high"):
            for value in ("0.5", ""):
                self.choose(f"type-{name}", value)
                self.assertEqual(self.state(name), value)

    def test_every_button_does_something(self):
        self.run_script("window.kept = []; download = (name, text) => kept.push([name, text]); undefined")
        count = self.run_script("document.querySelectorAll('button').length")
        self.assertGreater(count, 40)
        for i in range(count):
            self.run_script(f"document.querySelectorAll('button')[{i}]?.click()")
        self.settle()
        names = {name for name, _ in self.run_script("kept")}
        self.assertTrue({"strip.svg", "curves.svg", "table.csv"} <= names, names)

    def test_records_are_shown_to_the_last_digit(self):
        self.choose("choose-rows", "records")
        self.run_script("change({columns: page.tables[0].header.join('.')})")
        self.settle()
        head = self.run_script("[...document.querySelectorAll('#table thead th')].map((e) => e.textContent)")
        body = self.run_script("[...document.querySelectorAll('#table tbody tr')].map((r) => [...r.children].map((e) => e.textContent))")
        with open(self.page.parent / "sweep" / "records.csv", newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.assertEqual([name.partition(" [")[0] for name in head[:-1]], header)
        self.assertEqual([row[:-1] for row in body], rows)

    def test_the_table_sorts_and_filters(self):
        self.click("#table thead th:nth-child(6) button")
        self.assertEqual(self.state("sort"), "rmse:up")
        means = lambda: [float(text.split(" ")[0]) for text in self.run_script("[...document.querySelectorAll('td[data-column=rmse]')].map((e) => e.textContent)")]
        self.assertEqual(means(), sorted(means()))
        self.click("#table thead th:nth-child(6) button")
        self.assertEqual(means(), sorted(means(), reverse=True))
        self.choose("filter", "beamtree pool")
        self.assertEqual(len(means()), 2)
        self.assertIn("2 of 10 rows", self.text("#table-count"))
        self.assertEqual(self.run_script("[...document.querySelectorAll('tr.tied td[data-column=best]')].map((e) => e.textContent)"), ["★"])

    def test_an_error_maps_mean_is_the_records_rmse(self):
        rows = [row for row in self.rows if row["scene"] == "pool" and row["seed"] == "2"]
        for i, cell in enumerate(self.run_script("scene().cells.map((cell) => cell.pictures[1].trial)")):
            row = next(row for row in rows if row["trial"] == cell)
            self.run_script("change({seed: 1, formula: 'square', show: 'error'})")
            square = self.run_script(f"errorOf('{i}', REFERENCE).then((map) => meanOfMap(map))")
            self.assertEqual(square["count"], sweep.WIDTH * sweep.HEIGHT - 3)
            self.close_to(math.sqrt(square["mean"]), float(row["rmse"]), 1e-2)
            self.run_script("change({formula: 'signed'})")
            mean = self.run_script(f"errorOf('{i}', REFERENCE).then((map) => meanOfMap(map))")["mean"]
            self.close_to(mean, float(row["bias"]) * float(row["reference_mean"]), 1e-2)

    def test_bias_and_variance_over_seeds_are_those_of_the_pictures(self):
        for i, cell in enumerate(self.run_script("scene().cells.map((cell) => [cell.method, cell.costs.map_bytes])")):
            method, step = cell[0], cell[1] / 1000
            bias = (0.02 if method == "photonmap" else 0.01) / step
            variance = VARIANCE / step ** 2
            found = self.run_script(f"""(async () => {{
                const found = await seedStatistics({i}), r = await referencePicture("caustic"), own = await referencePicture("stderr");
                const bias2 = biasSquare(found, r, own, await countedPixels([{i}]));
                return [meanOfMap(found.variance).mean, meanOfMap(bias2).mean, found.count]; }})()""")
            self.assertEqual(found[2], 5)
            self.close_to(found[0], variance, 5e-2)
            self.close_to(found[1], bias ** 2 - variance / 5 - 1e-6, 1e-2)

    def test_the_spectrum_adds_up_to_the_mean_square(self):
        for i, cell in enumerate(self.run_script("scene().cells.map((cell) => [cell.method, cell.costs.map_bytes])")):
            squares = [float((error.astype(float) ** 2).mean()) for error in self.errors_of(*cell)]
            rings = self.run_script(f"errorSpectrum({i})")
            self.close_to(sum(ring["total"] for ring in rings), sum(squares) / 5, 1e-2)
            for ring in rings:
                self.assertAlmostEqual(ring["bias2"], ring["total"] - ring["variance"], delta=1e-12)
            for ring, power in zip(rings, self.powers(self.errors_of(*cell)), strict=True):
                self.assertAlmostEqual(ring["total"], power, delta=2e-2 * power + 1e-3 * sum(squares) / 5)  # halves round
            self.close_to(sum(ring["variance"] for ring in rings), VARIANCE / (cell[1] / 1000) ** 2 * (192 - 3) / 192, 5e-2)

    def errors_of(self, method, map_bytes):
        """Picture less reference of each of a cell's seeds, means over channels; 0 where the reference does not reach."""
        caustic, _, unreached = sweep.reference_planes()
        return [(sweep.picture_of(method, seed, int(map_bytes / 1000))[0] - caustic).mean(axis=0) * (unreached == 0) for seed in range(1, 6)]

    def powers(self, errors):
        """The mean squared error over the seeds by ring of frequency, by NumPy's transform; rings without a frequency are left out."""
        rings = numpy.zeros(24)
        across, down = numpy.meshgrid(*(numpy.fft.fftfreq(n) for n in (sweep.WIDTH, sweep.HEIGHT)))
        ring = numpy.minimum(23, (numpy.hypot(across, down) / math.sqrt(0.5) * 24 + 1e-9).astype(int))
        for error in errors:
            numpy.add.at(rings, ring, abs(numpy.fft.fft2(error) / error.size) ** 2 / 5)
        return rings[numpy.bincount(ring.ravel(), minlength=24) > 0]

    def test_the_transform_is_that_of_a_wave(self):
        found = self.run_script("""(() => { const map = Float64Array.from({length: 12 * 8}, (_, i) => Math.cos(2 * Math.PI * (3 * (i % 12) / 12 + 2 * Math.floor(i / 12) / 8)));
            const {re, im} = transform(map, 12, 8); return [...re].map((x, i) => Math.hypot(x, im[i])); })()""")
        peaks = {i: value for i, value in enumerate(found) if value > 1e-9}
        self.assertEqual(set(peaks), {2 * 12 + 3, 6 * 12 + 9})
        for value in peaks.values():
            self.assertAlmostEqual(value, 0.5)

    def test_slopes_are_those_of_powers(self):
        found = self.run_script("fittedSlope([1, 10, 100, 1000].map((x) => ({x, y: 7 * x ** -0.5})))")
        self.assertAlmostEqual(found["slope"], -0.5)
        self.assertAlmostEqual(found["error"], 0)
        # Errors of write_sweep fall as 1 / work of the sizes 1, 2, 4, nearly.
        self.choose("choose-curve-cost", "map_bytes")
        self.assertRegex(self.text("#curve-legend"), r"photonmap slope −1\.00 ± ")
        self.assertRegex(self.text("#curve-legend"), r"beamtree slope −1\.00")

    def test_lines_are_toggled(self):
        drawn = lambda: self.run_script("document.querySelectorAll('#curve .line').length")
        before = drawn()
        self.click("#curve-legend .line-switch")
        self.assertEqual(drawn(), before - 1)
        self.assertEqual(self.state("hidden"), "photonmap")
        self.click("#curve-legend .line-switch")
        self.assertEqual(drawn(), before)

    def test_hovering_a_point_tells_its_numbers(self):
        place = self.browser.place_of("#curve .spot")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=place[0], y=place[1])
        self.assertRegex(self.text("#status"), r"photonmap, 1k photons: 0\.02\d+ \(95 %: .* to .*\) at 0\.\d+ CPU time \[CPU s\]")
        self.click("#curve .spot")
        self.assertIn("2", self.state("pictures").split("."))

    def test_a_click_probes_a_pixel_beside_the_reference(self):
        self.click(".pane canvas")
        x, y = map(int, self.state("pixel").split(","))
        caustic, _, _ = sweep.reference_planes()
        self.browser.wait_for("document.querySelectorAll('#probe-table tbody tr').length > 2")
        first, second = self.run_script("[...document.querySelectorAll('#probe-table tbody tr')].slice(0, 2).map((r) => [...r.children].map((e) => e.textContent))")
        self.close_to(float(first[1]), float(caustic[0, y, x]))
        self.close_to(float(first[4].split(" ± ")[0]), float(caustic[:, y, x].mean()))
        self.assertEqual(first[4].split(" ± ")[1], "0.0010")
        picture, _ = sweep.picture_of("beamtree", 1, 1)
        self.assertEqual(second[0], "■ beamtree, mesh_resolution 16")
        self.close_to(float(second[4]), float(picture[:, y, x].mean()))
        self.assertTrue(second[6].endswith(" σ"))
        self.browser.wait_for("byId('probe-curve').dataset.ready && document.querySelectorAll('#probe-curve .spot').length === 5")
        self.choose("choose-place", "value")
        self.assertIn("reference ± 0.0010", self.text("#probe-curve"))

    def test_a_drawn_region_converges(self):
        start, end = (self.browser.place_of(".pane canvas", *place) for place in ((0.3, 0.3), (0.6, 0.7)))
        self.browser.drag(start, end, modifiers=8)
        self.settle()
        x0, y0, x1, y1 = map(int, self.state("region").split(","))
        self.assertLess(x0, x1)
        self.assertLess(y0, y1)
        self.assertIn(f"region ({x0}, {y0}) to ({x1}, {y1})", self.text("#probe-place"))
        self.browser.wait_for("document.querySelectorAll('#probe-curve .spot').length === 5")
        self.assertEqual(self.state("view"), "")

    def test_zoom_and_place_are_the_same_in_all_panes(self):
        panes = self.run_script("viewer.panes.length")
        self.assertEqual(panes, 3)
        x, y = self.browser.place_of(".pane canvas", 0.25, 0.25)
        self.turn_wheel((x, y), -600, modifiers=2)
        zoom = float(self.state("view").split(",")[2])
        self.assertGreater(zoom, 1.5)
        self.browser.drag((x, y), (x + 40, y + 20))
        self.settle()
        shown = lambda: self.run_script("viewer.panes.map((pane) => { const v = view(pane.canvas); return [v.x, v.y, v.zoom]; })")
        self.assertEqual(shown(), [shown()[0]] * 3)
        kept = self.state("view")
        for mode in ("flip", "split"):
            self.press("m")
            for key in ("n", "n"):
                self.press(key)
                self.assertEqual((self.state("mode"), self.state("view")), (mode, kept))
                self.assertEqual(shown(), [shown()[0]] * len(shown()))
        self.press("m", "0")
        self.assertEqual(self.state("view"), "")

    def turn_wheel(self, place, pixels, modifiers=0):
        self.browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=place[0], y=place[1], deltaX=0, deltaY=pixels, modifiers=modifiers)
        self.settle()

    def test_the_wheel_over_a_picture_scrolls_the_page(self):
        for selector, ways in ((".pane canvas", (200, -200)), ("#strip .tile canvas", (200,))):  # the strip is the page's head
            for pixels in ways:
                with self.subTest(selector, pixels=pixels):
                    place, before = self.browser.place_of(selector), self.run_script("scrollY")
                    self.turn_wheel(place, pixels)
                    self.browser.wait_for(f"(scrollY - {before}) * {pixels} > 0", seconds=5)
                    self.assertEqual(self.state("view"), "")

    def test_the_wheel_with_control_zooms_about_the_pointer(self):
        place = self.browser.place_of(".pane canvas", 0.25, 0.5)
        under_pointer = f"pixelAt(viewer.panes[0], {{clientX: {place[0]}, clientY: {place[1]}}})"
        before, scrolled = self.run_script(under_pointer), self.run_script("scrollY")
        self.turn_wheel(place, -400, modifiers=2)
        self.close_to(float(self.state("view").split(",")[2]), math.exp(400 * 0.0015))
        for found, wanted in zip(self.run_script(under_pointer), before):
            self.assertAlmostEqual(found, wanted, delta=0.02)
        self.turn_wheel(place, 4000, modifiers=2)
        self.assertEqual((self.state("view"), self.run_script("scrollY")), ("", scrolled))
        self.assertIn("Ctrl + wheel zooms", self.text("#viewer"))

    def test_the_keys_are_shown_on_the_screen(self):
        shown = """(() => { const box = byId("help").getBoundingClientRect(), within = [...document.querySelectorAll("#help dt")];
            return byId("help").open && box.width > 0 && box.left >= 0 && box.top >= 0 && box.right <= innerWidth && box.bottom <= innerHeight
              && within.length > 10 && byId("help").contains(document.elementFromPoint(box.left + 20, box.top + 20)); })()"""
        for width, height in ((1600, 1000), (700, 500)):
            self.browser.resize(width, height)
            for place in (0, 1e6):
                self.run_script(f"scrollTo(0, {place})")
                self.assertFalse(self.run_script(shown))
                self.press("?")
                self.assertTrue(self.run_script(shown), f"{width} x {height}, scrolled to {place}")
                before = self.state("mode")
                self.press("m")
                self.assertNotEqual(self.state("mode"), before, "keys work while they are shown")
                self.press("Escape")
                self.assertFalse(self.run_script("byId('help').open"))
        self.browser.resize(1600, 1000)
        self.click("#show-keys")
        self.assertTrue(self.run_script(shown))
        self.click("#hide-keys")
        self.press("?", "?")
        self.assertFalse(self.run_script("byId('help').open"))

    # The parts that wait for pictures, and what of each differs between the scenes of this sweep.
    WAITING = ("strip", "contest-text", "panes", "meaning", "scale", "probe-table", "probe-curve", "spread", "spectrum")
    LOOKS = """(() => Object.fromEntries(%s.map((id) => { const own = getComputedStyle(byId(id));
        return [id, {clear: Number(own.opacity) > 0.5, text: byId(id).textContent}]; })))()""" % json.dumps(WAITING)

    def test_nothing_of_another_scene_stands_under_the_new_name(self):
        self.run_script("change({pixel: '5,5', spread: '3'})")
        self.settle()
        before = self.run_script(self.LOOKS)
        self.assertTrue(all(each["clear"] for each in before.values()), before)
        self.move_mouse(self.browser.place_of("#curve .spot"))
        self.move_mouse((2, 2))
        self.assertIn("photonmap, 1k photons", self.text("#status"))
        self.run_script("""(() => { const decoded = picture; window.gate = new Promise((done) => { window.open_gate = done; });
            picture = (id) => window.gate.then(() => decoded(id)); })()""")
        self.run_script("(() => { const e = byId('choose-scene'); e.value = '1'; e.dispatchEvent(new Event('change', {bubbles: true})); })()")
        self.run_script(SETTLED)
        self.run_script("change({view: '4.00,4.00,2.000'}); window.dispatchEvent(new Event('resize')); undefined")
        self.run_script(SETTLED)
        waiting = self.run_script(self.LOOKS)
        self.assertEqual({name: each for name, each in waiting.items() if each["clear"]}, {})
        for name, each in waiting.items():
            if not name.startswith("probe"):  # has no pixel any more
                self.assertEqual(each["text"], before[name]["text"], "the same, but dimmed")
        self.assertEqual((self.text("#status"), self.run_script("viewer.spread")), ("", None))
        self.assertFalse(self.keeps_plots(), "a plot of the scene before is no file of the new one")
        self.assertIn("ring", self.text("#curve"))
        self.run_script("window.open_gate()")
        self.settle()
        after = self.run_script(self.LOOKS)
        self.assertTrue(all(each["clear"] for each in after.values()), after)
        self.assertIn("no such file", self.run_script(f"pictureOf('{self.cell_of('photonmap')}').hole"))
        self.assertTrue(self.keeps_plots())

    def keeps_plots(self):
        """True where the buttons that keep strip and spectrum give files."""
        self.run_script("window.kept = []; download = (name, text) => kept.push([name, text]); undefined")
        self.run_script("byId('save-strip').click(); document.querySelector('#spectrum-controls button').click()")
        return len(self.run_script("kept")) == 2

    def test_what_is_stale_is_dimmed_before_anything_is_computed(self):
        """All pictures are decoded already: only a frame of its own lets the dimmed parts be seen."""
        self.choose("choose-scene", "1")
        self.choose("choose-scene", "0")
        self.run_script("""(() => { window.frames = []; const look = () => { frames.push([state.scene, document.querySelectorAll("[aria-busy]").length]);
            if (frames.length < 60) requestAnimationFrame(look); }; requestAnimationFrame(look); byId("choose-scene").value = "1";
            byId("choose-scene").dispatchEvent(new Event("change")); })()""")
        self.browser.wait_for("frames.length >= 60")
        seen = self.run_script("frames")
        self.assertIn(["1", 10], seen)
        self.assertEqual(seen[-1], ["1", 0])

    def move_mouse(self, place):
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=place[0], y=place[1])

    def test_a_part_that_takes_long_is_dimmed_in_the_same_scene(self):
        self.run_script("""(() => { const decoded = picture; window.gate = new Promise((done) => { window.open_gate = done; });
            picture = (id) => window.gate.then(() => decoded(id)); change({seed: '2'}); })()""")
        self.browser.wait_for("Number(getComputedStyle(byId('panes')).opacity) < 0.5", seconds=5)
        self.assertEqual(self.run_script("getComputedStyle(byId('curve')).opacity"), "1", "curves need no pictures")
        self.run_script("window.open_gate()")
        self.settle()
        self.assertEqual(self.run_script("getComputedStyle(byId('panes')).opacity"), "1")

    def test_pictures_flip_and_split(self):
        self.press("m")
        self.assertEqual((self.state("mode"), self.run_script("viewer.panes.length")), ("flip", 1))
        captions = []
        for key in ("1", "2", "3", " ", " ", "n", "p"):
            self.press(key)
            captions.append(self.text(".pane figcaption")[:12])
        self.assertEqual([caption[0] for caption in captions], ["1", "2", "3", "2", "3", "1", "3"])
        self.press("m")
        self.assertEqual(self.state("mode"), "split")
        place = self.browser.place_of(".pane canvas")
        self.browser.drag(place, (place[0] + 100, place[1]))
        self.settle()
        self.assertGreater(float(self.state("split")), 0.55)
        self.press("ArrowLeft", modifiers=1)
        self.choose("split-at", "0.25")
        self.assertEqual(self.state("split"), "0.25")

    def test_it_is_used_by_keyboard_alone(self):
        self.press("e")
        self.assertEqual(self.state("show"), "error")
        self.assertIn("x − r, r: reference", self.text("#meaning"))
        self.press("e", "f")
        self.assertEqual(self.state("tone"), "false")
        self.assertTrue(self.run_script("document.querySelector('#scale svg') !== null"))
        self.press("f", "]", "]")
        brighter = float(self.state("exposure"))
        self.press("[")
        self.assertAlmostEqual(float(self.state("exposure")), brighter - 0.5)
        self.press("+", "+", "-", "h", "j", "k", "l", "0", "s", "t", "?", "r", "r")
        self.assertEqual((self.state("seed"), self.state("theme"), self.state("view")), ("1", "light", ""))
        self.press("ArrowRight", "ArrowDown")
        x, y = map(int, self.state("pixel").split(","))
        self.press("ArrowLeft", modifiers=8)
        self.assertEqual(self.state("pixel"), f"{max(0, x - 10)},{y}")
        unreachable = self.run_script("[...document.querySelectorAll('button, select, input, canvas[tabindex], .spot[role=button]')].filter((e) => e.tabIndex < 0).length")
        self.assertEqual(unreachable, 0)
        self.run_script("document.querySelector('#curve .spot').focus()")
        self.press("Enter")
        self.assertNotEqual(self.state("pictures"), "")

    def test_commands_and_hashes_are_copied(self):
        self.run_script("window.copied = []; copy = async (text) => copied.push(text); undefined")
        self.choose("choose-rows", "records")
        self.choose("filter", "pool-beamtree-1-s3")
        self.click("#table tbody tr .copy")
        self.click("#table tbody tr .copy + .copy")
        row = next(row for row in self.rows if row["trial"] == "pool-beamtree-1-s3")
        self.assertEqual(self.run_script("copied"), [
            "causticbench render pool.json --method beamtree --seed 3 --threads 1 --isa plain -o pool-beamtree-1-s3.exr", row["picture_hash"]])
        self.run_script("document.activeElement.blur()")
        self.press("2", "c")
        self.assertIn("--method photonmap", self.run_script("copied")[2])

    def test_the_clipboard_gets_the_text(self):
        self.run_script("copy('a b', null)")
        self.assertEqual(self.text("#status"), "copied: a b")

    def test_a_link_brings_the_state_back(self):
        self.press("m", "2", "e", "]")
        self.choose("choose-formula", "relative_square")
        self.choose("filter", "beam")
        link = self.run_script("location.hash")
        before = self.run_script("({...state})")
        self.open(link)
        self.assertEqual(self.run_script("({...state})"), before)
        self.assertEqual(self.run_script("byId('filter').value"), "beam")
        self.open("#scene=99&nonsense=1&mode=flip")
        self.assertEqual((self.state("scene"), self.state("mode")), ("0", "flip"))

    def test_exposure_and_colours_are_those_of_their_formulas(self):
        self.choose("type-exposure", "-1")
        caustic, _, _ = sweep.reference_planes()
        x, y = 9, 7
        found = self.run_script(f"[...viewer.images.get('ref').canvas.getContext('2d').getImageData({x}, {y}, 1, 1).data].slice(0, 3)")
        for value, linear in zip(found, 0.5 * caustic[:, y, x].astype(float)):
            wanted = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
            self.assertLessEqual(abs(value - 255 * wanted), 1)
        self.assertIn("exposure −1.00 stops", self.text("#scale"))
        lightness = self.run_script("Array.from({length: 65}, (_, i) => sequential(i / 64)).map(([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b)")
        self.assertEqual(lightness, sorted(lightness), "false colours are in order without their hue")
        self.choose("choose-tone", "false")
        self.choose("type-low", "0.1")
        self.choose("type-high", "0.4")
        self.assertEqual(self.run_script("[...document.querySelectorAll('#scale text')].map((e) => e.textContent)"), ["≤ 0.100", "0.200", "0.400"])
        self.press("e")
        self.assertEqual(self.run_script("[...document.querySelectorAll('#scale text')].map((e) => e.textContent)"), ["−0.400", "0", "+0.400"])

    def test_formula_and_epsilon_are_printed(self):
        self.press("e")
        self.choose("choose-formula", "relative_square")
        self.choose("type-epsilon", "0.02")
        self.assertIn("(x − r)² / (r² + ε mean(r)²), ε = 0.02", self.text("#meaning"))
        self.assertIn("ε = 0.02", self.text("#spread"))
        found = self.run_script("errorOf('4', REFERENCE).then((map) => meanOfMap(map).mean)")
        caustic, _, unreached = sweep.reference_planes()
        label = self.run_script("scene().cells[4].label")
        picture, _ = sweep.picture_of("photonmap", 1, {"1k": 1, "2k": 2, "4k": 4}[label.split()[1]])
        r, x = (each[:, unreached == 0].astype(float) for each in (caustic, picture))
        self.close_to(found, float(((x - r) ** 2 / (r ** 2 + 0.02 * r.mean() ** 2)).mean()), 1e-2)

    def test_a_map_of_two_methods_is_their_difference(self):
        beams, photons = self.cell_of("beamtree"), self.cell_of("photonmap")
        self.run_script("change({seed: 1, formula: 'square'})")
        found = self.run_script(f"errorOf('{photons}', '{beams}').then((map) => meanOfMap(map).mean)")
        _, _, unreached = sweep.reference_planes()
        steps = self.run_script(f"[{photons}, {beams}].map((i) => scene().cells[i].costs.map_bytes / 1000)")
        one, other = (sweep.picture_of(method, 2, int(step))[0] for method, step in zip(("photonmap", "beamtree"), steps))
        self.close_to(found, float(((one - other)[:, unreached == 0].astype(float) ** 2).mean()), 1e-2)

    def test_intervals_are_drawn_at_their_ends(self):
        drawn = self.run_script("""[...document.querySelectorAll('#curve .spot')].map((spot) => [spot.querySelector('title').textContent,
            Number(spot.querySelector('circle').getAttribute('cy')), spot.previousElementSibling.getAttribute('d')])""")
        self.assertGreater(len(drawn), 4)
        number = r"([\d.e−-]+)"
        read = lambda text: [float(each.replace("−", "-")) for each in re.search(rf": {number} \(95 %: {number} to {number}\)", text).groups()]
        (first, top, _), (last, bottom, _) = min(drawn, key=lambda each: each[1]), max(drawn, key=lambda each: each[1])
        scale = (bottom - top) / math.log(read(last)[0] / read(first)[0])
        for text, _, path in drawn:
            for value, at in zip(read(text)[1:], re.fullmatch(r"M[\d.]+,([\d.]+)V([\d.]+)", path).groups(), strict=True):
                self.assertAlmostEqual(float(at), top + scale * math.log(value / read(first)[0]), delta=2)

    def test_a_bar_of_the_distribution_marks_its_pixels(self):
        self.browser.wait_for("document.querySelectorAll('#spread .bar').length > 10")
        i = self.run_script("[...document.querySelectorAll('#spread g')].findIndex((e) => /^[1-9]/.test(e.getAttribute('aria-label')))")
        self.run_script(f"document.querySelectorAll('#spread g')[{i}].dispatchEvent(new Event('click'))")
        self.settle()
        count = int(self.run_script(f"document.querySelectorAll('#spread g')[{i}].getAttribute('aria-label')").split()[0])
        self.assertEqual(self.run_script("viewer.spread.length"), count)

    def test_a_missing_picture_is_a_hole_with_its_reason(self):
        self.choose("choose-scene", "1")
        self.assertEqual(self.run_script("scene().name"), "ring")
        cell = self.run_script(f"scene().cells.findIndex((cell) => cell.pictures.some((p) => p.trial === '{self.lost}'))")
        self.run_script(f"change({{pictures: 'ref.{cell}', mode: 'side', pixel: '3,3'}})")
        self.settle()
        self.assertEqual(self.run_script(f"viewer.images.get('{cell}').hole"), f"the picture of {self.lost}: no such file")
        self.browser.wait_for("/no such file/.test(byId('probe-table').textContent)")

    def cell_of(self, method):
        return str(self.run_script(f"scene().cells.findIndex((cell) => cell.method === '{method}')"))

    def test_flip_is_a_map(self):
        beams, photons = self.cell_of("beamtree"), self.cell_of("photonmap")
        self.run_script(f"change({{pictures: 'ref.{beams}.{photons}'}})")
        self.choose("choose-show", "flip")
        self.assertIn("HDR-FLIP [1]", self.text("#meaning"))
        found = self.run_script(f"[...viewer.images.get('{beams}').planes[0]]")
        for i, value in enumerate(found):
            if i < 3:
                self.assertTrue(value is None or math.isnan(value), value)  # not reached
            else:
                self.assertAlmostEqual(value, i % sweep.WIDTH / (sweep.WIDTH - 1), delta=1e-3)
        self.assertEqual(self.run_script("[viewer.range.low, viewer.range.high]"), [0, 1])
        self.assertRegex(self.text(".panes figure:nth-child(2) figcaption"), "mean of the map 0.50")
        self.assertIn("no FLIP (tools/flip_column.py)", self.run_script(f"viewer.images.get('{photons}').hole"))

    def test_a_map_has_the_references_picture_beside_it(self):
        self.choose("choose-show", "error")
        self.assertIn("reference (lighttrace), its picture", self.text(".pane figcaption"))
        self.assertNotEqual(self.run_script("viewer.images.get('ref').planes[0][100]"), 0)
        self.assertNotEqual(self.run_script("leftKey()"), "ref")
        self.choose("choose-against", self.cell_of("beamtree"))
        self.assertNotIn("its picture", self.text(".pane figcaption"))

    def test_indirect_light_is_shown_and_scored_alone(self):
        self.choose("choose-layer", "indirect")
        self.assertIn("indirect layer", self.text("#meaning"))
        self.choose("choose-show", "error")
        for seed in (0, 3):
            self.choose("choose-seed", str(seed))
            mean = self.run_script("errorOf('0', REFERENCE).then((map) => meanOfMap(map).mean)")
            self.assertAlmostEqual(mean, 0.01 * (seed + 1), delta=1e-3)
        self.assertIn("indirect rmse 0.03000 ±", self.text(".panes figure:nth-child(2) figcaption"))
        self.run_script("change({pixel: '5,5'})")
        self.browser.wait_for("/ ± 0.0020/.test(byId('probe-table').textContent)")
        self.choose("choose-metric", "indirect_rmse")
        self.assertIn("indirect_rmse [W m⁻² sr⁻¹]", self.text("#curve"))
        self.choose("choose-layer", "beauty")
        self.choose("choose-show", "picture")
        caustic, rest, _ = sweep.reference_planes()
        found = self.run_script("viewer.images.get('ref').planes[1][100]")
        self.close_to(found, float((caustic[1] + rest).flat[100]) + 0.25)

    def test_plots_have_their_legends(self):
        self.browser.wait_for("byId('spectrum').dataset.ready && true")
        for name in ("photonmap", "beamtree"):
            self.assertIn(name, self.text("#spectrum"))
            self.assertIn(name, self.text("#curve-legend"))

    def test_equal_time_follows_the_time_allowed(self):
        for i in range(self.run_script("scene().contests.length")):
            self.choose("budget", str(i))
            picks = self.run_script(f"Object.values(scene().contests[{i}].picks).map((pick) => scene().cells[pick].label)")
            shown = [text for text in self.run_script("[...document.querySelectorAll('#strip figcaption')].map((e) => e.textContent)")[1:]]
            self.assertEqual(len(shown), len(picks))
        self.click("#strip .tile canvas")
        self.assertNotEqual(self.state("crops"), "")

    def test_plots_and_strip_are_whole_svg_files(self):
        self.run_script("window.kept = []; download = (name, text) => kept.push([name, text]); undefined")
        for selector in ("#save-strip", "#save-curve", "#spread-controls button", "#spectrum-controls button"):
            self.click(selector)
        kept = self.run_script("kept")
        self.assertEqual([name for name, _ in kept], ["strip.svg", "curves.svg", "distribution.svg", "spectrum.svg"])
        for name, text in kept:
            with self.subTest(name):
                root = xml.etree.ElementTree.fromstring(text)
                self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
                self.assertEqual("var(" in text, False)
                self.assertGreater(len(root.findall(".//{*}text")), 5)
        self.assertTrue(all(name in kept[1][1] for name in (">photonmap<", ">beamtree<")), "the curves' file has its legend")
        images = xml.etree.ElementTree.fromstring(kept[0][1]).findall(".//{*}image")
        self.assertEqual(len(images), 3 * 3)
        self.assertTrue(all(image.get("href").startswith("data:image/png") for image in images))

    def test_themes_and_print(self):
        colour = lambda: self.run_script("getComputedStyle(document.body).backgroundColor")
        self.choose_theme("dark")
        self.assertEqual(colour(), "rgb(22, 23, 24)")
        self.choose_theme("light")
        self.assertEqual(colour(), "rgb(255, 255, 255)")
        self.browser.call("Emulation.setEmulatedMedia", media="print")
        self.assertEqual(self.run_script("getComputedStyle(document.querySelector('.controls')).display"), "none")
        self.assertEqual(self.run_script("getComputedStyle(document.querySelector('header')).position"), "static")
        self.assertEqual(self.run_script("[...document.querySelectorAll('.scroll')].filter((e) => getComputedStyle(e).overflowX !== 'visible').length"), 0)
        self.browser.call("Emulation.setEmulatedMedia", media="")

    def test_no_colour_is_without_a_second_sign(self):
        lines = self.run_script("[...document.querySelectorAll('#curve .mark')].map((e) => [getComputedStyle(e).stroke, e.getAttribute('d')])")
        by_colour = {}
        for colour, shape in lines:
            by_colour.setdefault(colour, set()).add(shape)
        self.assertGreater(len(by_colour), 1)
        shapes = [shape for own in by_colour.values() for shape in own]
        self.assertEqual(len(shapes), len(set(shapes)), "two colours share a marker")

    def choose_theme(self, theme):
        self.run_script(f"change({{theme: '{theme}'}})")
        self.settle()

    def test_nothing_is_wider_than_the_window(self):
        for width, height in ((1600, 1000), (1280, 720), (700, 900)):
            self.browser.resize(width, height)
            self.settle()
            self.assertLessEqual(self.run_script("document.documentElement.scrollWidth"), width)
        self.browser.resize(1600, 1000)


if __name__ == "__main__":
    unittest.main()
