"""Every number that the report's page shows or draws, against NumPy and SciPy, and a fault of 1 % in each, which must be noticed.

tests/faults/report_faults.json lists the faults: a text of one file of the page or of the tools that make it, what is put in its
place, and the test that has to fail then. `report_numbers_test.py --faults` prints a table of them and of what noticed each.
Exits with 77, and says so, where Debian's chromium, NumPy or SciPy is not installed.
"""
import json
import math
import pathlib
import re
import statistics
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.path.insert(0, str(ROOT / "tests" / "tooling"))

import browser

try:
    import numpy
    import scipy.stats
except ImportError as error:
    print(f"SKIPPED, the report's numbers are NOT CHECKED: {error}")
    sys.exit(77)
if browser.PROGRAM is None:
    print("SKIPPED, the report's numbers are NOT CHECKED: needs the Debian package chromium")
    sys.exit(77)

import report_sweep as sweep
from report_numbers import COSTS, ERRORS, STDERR_SHARE, Axes, World, mean_and_half, number, short

FAULTS = json.loads((ROOT / "tests" / "faults" / "report_faults.json").read_text(encoding="utf-8"))
WIDTH, HEIGHT = sweep.WIDTH, sweep.HEIGHT
CLOSE = 1e-4  # of the page's floats; texts have four digits

PLOT = """((id) => { const svg = byId(id).querySelector("svg"), read = (e, name) => Number(e.getAttribute(name));
    const interval = (e) => e?.classList.contains("interval") ? e.getAttribute("d").match(/[\\d.-]+/g).map(Number).slice(1) : null;
    return {ticks: [...svg.querySelectorAll(":scope > text.tick")].map((e) => [e.textContent, read(e, "x"), read(e, "y"), e.getAttribute("text-anchor")]),
      spots: [...svg.querySelectorAll(".spot")].map((e) => [e.querySelector("title").textContent, read(e.querySelector("circle"), "cx"),
        read(e.querySelector("circle"), "cy"), interval(e.previousElementSibling)]),
      lines: [...svg.querySelectorAll(":scope > path.line")].map((e) => e.getAttribute("d").match(/[\\d.]+/g).map(Number)),
      levels: [...svg.querySelectorAll(".level")].map((e) => [read(e, "y1"), e.nextElementSibling.textContent])}; })"""


class Numbers(unittest.TestCase):
    world = None  # shared by all tests, and by planted faults

    def setUp(self):
        if Numbers.world is None:
            Numbers.world = World()
            unittest.addModuleCleanup(Numbers.world.close)
        self.browser = self.world.browser
        self.browser.console.clear()
        self.world.show(self.world.sound if not isinstance(self, Planted) else self.world.shown)
        self.set(**self.run_script("defaults"))
        self.cells = self.run_script("scene().cells.map((cell) => ({method: cell.method, label: cell.label, step: cell.parameters.photons / 1000 || cell.parameters.mesh_resolution / 16}))")
        self.beams, self.photons = 1, 3  # their numbers in the first scene
        _, self.rest, _ = sweep.reference_planes()

    def tearDown(self):
        self.assertEqual([text for text in self.browser.console if "willReadFrequently" not in text], [])  # that is of the tests' reading

    def run_script(self, script):
        return self.browser.run(script)

    def settle(self):
        self.run_script("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))).then(() => true)")
        self.browser.wait_for("!document.querySelector('[aria-busy]')")

    def set(self, **state):
        self.run_script(f"change({json.dumps(state)})")
        self.settle()

    def text(self, selector):
        return self.run_script(f"document.querySelector({json.dumps(selector)}).textContent")

    def texts(self, selector):
        return self.run_script(f"[...document.querySelectorAll({json.dumps(selector)})].map((e) => e.textContent)")

    def same(self, found, wanted, share=CLOSE, least=0.0):
        """Numbers, or lists of them, are alike to a share of each; None and NaN stand in the same places."""
        numpy.testing.assert_allclose(numpy.array(found, dtype=float), numpy.array(wanted, dtype=float), rtol=share, atol=least)

    def values(self, script):
        """The planes of a picture that a script makes; NaN goes through JSON as null."""
        planes = self.run_script(f"Promise.resolve({script}).then((image) => image.planes.map((plane) => [...plane].map((x) => Number.isNaN(x) ? null : x)))")
        return numpy.array([[math.nan if x is None else x for x in plane] for plane in planes]).reshape(len(planes), HEIGHT, WIDTH)

    def layer(self, place, name="caustic", seed=0):
        return self.world.layer(place, name, seed)

    def seeds(self, i, name="caustic"):
        return numpy.stack([self.layer(i, name, seed) for seed in range(5)])

    def counted(self, *cells):
        mask = self.layer("ref", "unreached")[0] == 0
        for i in cells:
            if self.cells[i]["method"] == "beamtree":
                mask &= self.layer(i, "unreached")[0] == 0
        return mask

    def rows(self, i, scene="pool"):
        return self.world.cell(self.cells[i]["method"], int(self.cells[i]["step"]), scene)

    def error(self, i, name, scene="pool"):
        mean, half = mean_and_half([float(row[name]) for row in self.rows(i, scene)])
        return (mean, None) if name == "variance" else (mean, half)

    def cost(self, i, name, scene="pool"):
        return statistics.median(sum(float(row[part]) for part in COSTS[name]) for row in self.rows(i, scene))

    def stderr_of_reference(self):
        return STDERR_SHARE * float(self.rows(0)[0]["reference_mean"])

    def test_pictures_have_their_values(self):
        for i in range(0, len(self.world.data["pictures"]), 5):
            self.same(self.values(f"picture({i})"), self.world.values(i), 1e-6)

    def test_pixels_that_are_not_reached_are_not_counted(self):
        for cells in ((), (self.beams,), (self.photons,)):
            found = self.run_script(f"countedPixels({json.dumps([str(i) for i in cells])}).then((counted) => [...counted])")
            self.assertEqual(found, self.counted(*cells).astype(int).ravel().tolist())
        self.assertIn(f" Greyed: {(~self.counted()).sum()} pixels", self.text("#contest-text"))

    def test_cells_have_means_intervals_and_medians(self):
        for s, scene in enumerate(("pool", "ring")):
            for i, cell in enumerate(self.run_script(f"page.scenes[{s}].cells")):
                for name in ERRORS:
                    mean, half = self.error(i, name, scene)
                    self.same(cell["errors"][name][0], mean, 1e-9)
                    self.same(cell["errors"][name][1], half, 1e-6)
                for name in COSTS:
                    self.same(cell["costs"][name], self.cost(i, name, scene), 1e-9)
                self.same(cell["references_error"], self.stderr_of_reference(), 1e-9)
        self.same(self.run_script("page.student"), [scipy.stats.t.ppf(0.975, degrees) for degrees in range(1, 101)], 1e-6)

    def test_the_table_has_the_cells_numbers(self):
        names = [*ERRORS, *COSTS]
        self.set(columns=".".join(names))
        rows = self.run_script("[...document.querySelectorAll('#table tbody tr')].map((row) => Object.fromEntries([...row.querySelectorAll('td[data-column]')].map((e) => [e.dataset.column, e.textContent])))")
        self.assertEqual(len(rows), 10)
        for at, row in enumerate(rows):
            scene, i = ("pool", "ring")[at // 5], at % 5
            for name in ERRORS:
                mean, half = self.error(i, name, scene)
                self.assertEqual(row[name], short(mean) + (f" ± {short(half, 2)}" if half else ""))
            for name in COSTS:
                self.assertEqual(row[name], short(self.cost(i, name, scene)))
            self.assertEqual(row["seeds"], "5")
        self.assertIn("10 of 10 rows", self.text("#table-count"))

    def contests(self):
        """[(CPU seconds, {method: cell})] of the first scene."""
        found, picks = [], {}
        for i in sorted(range(5), key=lambda i: self.cost(i, "work_s")):
            method = self.cells[i]["method"]
            if method not in picks or self.error(i, "rmse")[0] < self.error(picks[method], "rmse")[0]:
                picks[method] = i
                if len(picks) > 1:
                    found.append((self.cost(i, "work_s"), dict(picks)))
        return found

    def test_equal_time_is_told_by_its_numbers(self):
        contests, noisy = self.contests(), set()
        self.assertGreater(len(contests), 1)
        self.assertEqual(self.run_script("scene().contests.length"), len(contests))
        for at, (seconds, picks) in enumerate(contests):
            self.set(contest=str(at))
            self.same(self.run_script("shownContest().seconds"), seconds, 1e-9)
            self.assertEqual(self.text("#budget-text"), f"{short(seconds, 3)} CPU s")
            self.assertIn(f"within {short(seconds, 3)} CPU seconds", self.text("#contest-text"))
            noise = min(self.error(i, "rmse")[0] for i in picks.values()) < 2 * self.stderr_of_reference()
            self.assertEqual(f"An rmse near {short(self.stderr_of_reference(), 3)}" in self.text("#contest-text"), noise)
            noisy.add(noise)
            reference, *tiles = self.run_script("[...document.querySelectorAll('#strip figcaption')].map((e) => [...e.querySelectorAll('span')].map((line) => line.textContent))")
            self.assertIn(f"standard error of a pixel {short(self.stderr_of_reference(), 3)}", reference[1])
            for i, tile in zip((picks["photonmap"], picks["beamtree"]), tiles, strict=True):
                mean, half = self.error(i, "rmse")
                self.assertEqual(tile[1], f"rmse {short(mean)} ± {short(half, 2)}")
                build, query, indirect = (short(self.cost(i, name), 3) for name in ("build_s", "query_s", "indirect_cpu_s"))
                self.assertEqual(tile[2], f"build {build} + query {query} + indirect {indirect} CPU s")
                mean, half = self.error(i, "indirect_rmse")
                self.assertEqual(tile[3], f"indirect rmse {short(mean)} ± {short(half, 2)}")
        self.assertEqual(noisy, {False, True})

    def test_the_head_counts(self):
        self.assertIn(f"{WIDTH} × {HEIGHT} pixels, 5 cells, 5 seeds", self.text("#scene-text"))
        self.assertEqual(self.texts("#not-done li"), ["3 trials of photonmap: failed: it ended"])
        loads = sorted(float(row["load_average"]) for row in self.world.rows)
        self.assertIn(f"load average {loads[0]:.1f} to {loads[-1]:.1f}", self.text("#machines"))

    def test_numbers_are_written_to_their_digits(self):
        cases = [(x * 10.0 ** power, digits) for x in (1.0, -2.3456789, 9.99951) for power in range(-8, 9) for digits in (1, 2, 3, 4)] + [(0.0, 4)]
        self.assertEqual(self.run_script(f"{json.dumps(cases)}.map(([x, digits]) => short(x, digits))"), [short(*case) for case in cases])

    def formulas(self, x, r, e, mask):
        """The error formulas as they are printed, a mean over channels; e and mean(r) as in the text."""
        mean = r[:, mask].mean()
        difference = x - r
        return {"signed": difference, "absolute": abs(difference), "square": difference ** 2, "relative": abs(difference) / (r + e * mean),
                "signed_relative": difference / (r + e * mean), "relative_square": difference ** 2 / (r ** 2 + e * mean ** 2),
                "symmetric": abs(difference) / (abs(x) + abs(r) + e * mean)}

    def test_error_maps_follow_their_formulas(self):
        for i in (self.beams, self.photons):
            mask = self.counted(i)
            for e in (0.01, 0.7):
                wanted = self.formulas(self.layer(i), self.layer("ref"), e, mask)
                for name, planes in wanted.items():
                    self.set(formula=name, epsilon=str(e), show="error", pictures=f"ref.{i}")
                    values = numpy.where(mask, planes.mean(axis=0), math.nan)
                    self.same(self.values(f"errorOf('{i}', REFERENCE)")[0], values, CLOSE, 1e-7)
                    caption = self.texts(".panes figcaption")[1]
                    self.same(number(caption.partition("mean of the map ")[2]), values[mask].mean(), 1e-3, 1e-7)
        self.assertEqual(set(self.run_script("Object.keys(FORMULAS)")), set(wanted))

    def test_a_map_between_two_pictures(self):
        mask = self.counted(self.beams, self.photons)
        self.set(formula="relative", against=str(self.beams), epsilon="0.3")
        wanted = self.formulas(self.layer(self.photons), self.layer(self.beams), 0.3, mask)["relative"].mean(axis=0)
        self.same(self.values(f"errorOf('{self.photons}', '{self.beams}')")[0], numpy.where(mask, wanted, math.nan), CLOSE, 1e-7)

    def test_maps_over_seeds(self):
        for i in (self.beams, self.photons):
            every, r, mask = self.seeds(i), self.layer("ref"), self.counted(i)
            mean, variance = every.mean(axis=0), every.var(axis=0, ddof=1).mean(axis=0)
            shown = lambda show: self.run_script(f"state.show = '{show}'") and self.values(f"shownImage('{i}')")
            self.same(shown("mean"), mean)
            self.same(shown("variance")[0], variance)
            self.same(shown("bias")[0], numpy.where(mask, (mean - r).mean(axis=0), math.nan), CLOSE, 1e-7)
            bias2 = ((mean - r) ** 2).mean(axis=0) - variance / 5 - self.layer("ref", "stderr")[0] ** 2
            self.same(shown("bias2")[0], numpy.where(mask, bias2, math.nan), CLOSE, 1e-7)
            self.same(shown("flip")[0], numpy.where(mask, self.layer(i, "flip")[0], math.nan))
        self.run_script("state.show = 'picture'")

    def test_whole_pictures_are_their_layers_sum(self):
        for place in ("ref", self.photons):
            wanted = self.layer(place) + self.world.values(self.world.data["scenes"][0]["rest"]) + self.layer(place, "indirect")
            self.same(self.values(f"wholePicture('{place}')"), wanted)

    def test_captions_tell_error_and_time(self):
        for layer, name, word in (("caustic", "rmse", "rmse"), ("indirect", "indirect_rmse", "indirect rmse")):
            self.set(layer=layer, pictures=f"ref.{self.beams}.{self.photons}")
            for i, caption in zip((self.beams, self.photons), self.texts(".panes figcaption")[1:]):
                mean, half = self.error(i, name)
                self.assertIn(f" · {word} {short(mean)} ± {short(half, 2)} · {short(self.cost(i, 'work_s'), 3)} CPU s", caption)

    def test_means_of_regions_have_their_pixels(self):
        mask = self.counted(self.photons)
        error = (self.layer(self.photons) - self.layer("ref")).mean(axis=0)
        for x0, y0, x1, y1 in ((0, 0, 4, 3), (5, 2, 9, 11), (15, 11, 15, 11)):
            inside = numpy.zeros_like(mask)
            inside[y0:y1 + 1, x0:x1 + 1] = True
            found = self.run_script(f"errorOf('{self.photons}', REFERENCE).then((map) => meanOfMap(map, [{x0}, {y0}, {x1}, {y1}]))")
            self.same(found["mean"], error[mask & inside].mean(), CLOSE, 1e-7)
            self.assertEqual(found["count"], (mask & inside).sum())

    def rings(self, i):
        """(frequency, total, variance) of each ring of the error's spectrum, by NumPy's transform."""
        errors = [(each - self.layer("ref")).mean(axis=0) * self.counted(i) for each in self.seeds(i)]
        power = numpy.stack([numpy.fft.fft2(error) / error.size for error in errors])
        across, down = numpy.meshgrid(numpy.fft.fftfreq(WIDTH), numpy.fft.fftfreq(HEIGHT))
        frequency = numpy.hypot(across, down)
        ring = numpy.minimum(23, (frequency / math.sqrt(0.5) * 24 + 1e-9).astype(int))
        total, variance = (abs(power) ** 2).mean(axis=0), (abs(power - power.mean(axis=0)) ** 2).sum(axis=0) / 4
        return [(frequency[ring == k].mean(), total[ring == k].sum(), variance[ring == k].sum()) for k in sorted(set(ring.ravel()))]

    def test_the_spectrum_is_that_of_the_transform(self):
        for i in (self.beams, self.photons):
            found = self.run_script(f"errorSpectrum({i})")
            self.same([[ring["frequency"], ring["total"], ring["variance"]] for ring in found], self.rings(i), CLOSE, 1e-12)
            self.same([ring["bias2"] for ring in found], [total - variance for _, total, variance in self.rings(i)], CLOSE, 1e-9)
            self.same(sum(ring["total"] for ring in found), numpy.mean([((each - self.layer("ref")).mean(axis=0)[self.counted(i)] ** 2).sum() / WIDTH / HEIGHT for each in self.seeds(i)]))

    def plot(self, id, log_x, log_y):
        drawn = self.run_script(f"{PLOT}('{id}')")
        drawn["axes"] = Axes(drawn["ticks"], log_x, log_y)
        places = [round(each, 1) for line in drawn["lines"] for each in line]
        self.same(places, [each for _, x, y, _ in drawn["spots"] for each in (x, y)], 0, 0.051)  # lines join the points
        return drawn

    def test_the_spectrum_is_drawn_at_its_axes(self):
        self.set(pictures=f"ref.{self.beams}.{self.photons}", right=str(self.photons))
        drawn = self.plot("spectrum", False, True)
        wanted = [(f"{self.cells[i]['label']}: {name}", frequency, value, sum(ring[1] for ring in self.rings(i)))
                  for i in (self.beams, self.photons) for at, name in enumerate(("bias² + variance", "variance", "bias²"))
                  for frequency, total, variance in self.rings(i) if at == 0 or i == self.photons
                  for value in [(total, variance, total - variance)[at]] if value > 0]
        self.assertEqual(len(drawn["spots"]), len(wanted))
        for (title, x, y, _), (name, frequency, value, everything) in zip(drawn["spots"], wanted):
            self.assertTrue(title.startswith(name), f"{title} is not of {name}")
            self.same(drawn["axes"].x.at(x), frequency, 1e-3, 1e-4)
            self.same(drawn["axes"].y.at(y), value, 1e-3)
            said = re.search(r" (\S+(?: · \S+)?) at (\S+) per pixel; all rings together (.+)$", title)
            self.assertEqual(said.group(2, 3), (short(frequency, 3), short(everything)))
            self.same(number(said[1]), value, 1e-3)

    def test_slopes_are_least_squares_of_the_logarithms(self):
        points = [(10, 0.31), (25, 0.22), (90, 0.137), (270, 0.061), (1000, 0.052)]
        for count in (3, 4, 5):
            x, y = numpy.log(points[:count]).T
            wanted = scipy.stats.linregress(x, y)
            found = self.run_script(f"fittedSlope({json.dumps([{'x': x, 'y': y} for x, y in points[:count]])})")
            self.same([found["slope"], found["error"]], [wanted.slope, wanted.stderr], 1e-9)
        for cost in ("work_s", "map_bytes"):
            self.set(cost=cost)
            legend = self.texts("#curve-legend .line-switch")
            for line, cells in (("photonmap", (2, 3, 4)), ("beamtree", (0, 1))):
                wanted = scipy.stats.linregress(*numpy.log([(self.cost(i, cost), self.error(i, "rmse")[0]) for i in cells]).T)
                error = f" ± {short(wanted.stderr, 2)}" if len(cells) > 2 else ""
                self.assertIn(f"{line} slope {short(wanted.slope, 3)}{error}", legend)

    def test_curves_are_drawn_at_their_axes(self):
        for metric, cost in [(name, "work_s") for name in ERRORS] + [("rmse", name) for name in (*COSTS, "parameter:photons")]:
            with self.subTest(metric=metric, cost=cost):
                self.set(metric=metric, cost=cost)
                for id in ("curve", "opening-curve"):
                    self.check_curve(id, metric, cost)

    def check_curve(self, id, metric, cost):
        drawn = self.plot(id, True, not metric.endswith("mean_ratio"))
        cells = [i for i, cell in enumerate(self.cells) if cost in COSTS or cell["method"] == "photonmap"]
        self.assertEqual(len(drawn["spots"]), len(cells))
        for title, x, y, interval in drawn["spots"]:
            i = next(i for i in cells if title.startswith(self.cells[i]["label"] + ": "))
            mean, half = self.error(i, metric)
            mean = abs(mean)
            place = self.cost(i, cost) if cost in COSTS else 1000 * self.cells[i]["step"]
            self.same(drawn["axes"].x.at(x), place, 1e-4)
            self.same(drawn["axes"].y.at(y), mean, 1e-4)
            ends = "" if half is None else f" (95 %: {short(mean - half)} to {short(mean + half)})"
            self.assertIn(f": {short(mean)}{ends} at {short(place)} ", title)
            if half is not None:
                low, high = sorted(drawn["axes"].y.at(end) for end in interval)
                self.same(high, mean + half, 1e-3)
                if low > 1.02 * drawn["axes"].y.at(314 if id == "curve" else 284):  # else it is cut at the frame
                    self.same(low, mean - half, 1e-3)
        if metric == "rmse":
            (at, words), = drawn["levels"]
            self.same(drawn["axes"].y.at(at), self.stderr_of_reference(), 1e-4)
        if metric == "mean_ratio":
            (at, words), = drawn["levels"]
            self.same(drawn["axes"].y.at(at), 1, 1e-4)

    REGIONS = (("5,6", ""), ("", "4,2,9,8"))

    def test_the_probe_tells_means_of_pixel_and_region(self):
        for pixel, region in self.REGIONS:
            for layer, own in (("caustic", "stderr"), ("indirect", "indirect_stderr")):
                self.set(pixel=pixel, region=region, layer=layer, seed="2")
                x0, y0, x1, y1 = map(int, (region or f"{pixel},{pixel}").split(","))
                part = numpy.s_[..., y0:y1 + 1, x0:x1 + 1]
                errors = self.layer("ref", own)[0][part]
                deviation = math.sqrt((errors ** 2).sum()) / errors.size
                middle = self.layer("ref", layer)[part].mean(axis=(1, 2))
                rows = self.run_script("[...document.querySelectorAll('#probe-table tbody tr')].map((row) => [...row.children].map((e) => e.textContent))")
                self.assertEqual(rows[0], ["reference", *map(short, middle), f"{short(middle.mean())} ± {short(deviation, 2)}", "", ""])
                for i, row in enumerate(rows[1:]):
                    found = self.layer(i, layer, 2)[part].mean(axis=(1, 2))
                    difference = found.mean() - middle.mean()
                    signed = lambda x, digits=4: ("+" if x > 0 else "") + short(x, digits)
                    self.assertEqual(row[1:], [*map(short, found), short(found.mean()), signed(difference), f"{signed(difference / deviation, 2)} σ"])
                if region:
                    self.assertIn(f"{(x1 - x0 + 1) * (y1 - y0 + 1)} pixels", self.text("#probe-place"))

    def test_the_probes_convergence_is_drawn_at_its_axes(self):
        for pixel, region in self.REGIONS:
            x0, y0, x1, y1 = map(int, (region or f"{pixel},{pixel}").split(","))
            inside = numpy.zeros((HEIGHT, WIDTH), bool)
            inside[y0:y1 + 1, x0:x1 + 1] = True
            errors, r, mask = self.layer("ref", "stderr")[0][inside], self.layer("ref"), self.counted() & inside
            for place in ("error", "value"):
                self.set(pixel=pixel, region=region, place=place)
                drawn = self.plot("probe-curve", True, place == "error")
                self.assertEqual(len(drawn["spots"]), 5)
                for title, x, y, interval in drawn["spots"]:
                    i = next(i for i in range(5) if title.startswith(self.cells[i]["label"] + ": "))
                    values = [each[:, inside].mean() if place == "value" else math.sqrt(((each - r)[:, mask] ** 2).mean()) for each in self.seeds(i)]
                    mean, half = mean_and_half(values)
                    self.same(drawn["axes"].x.at(x), self.cost(i, "work_s"), 1e-4)
                    self.same(drawn["axes"].y.at(y), mean, 1e-3)
                    self.assertIn(f": {short(mean)} (95 %: {short(mean - half)} to {short(mean + half)}) at ", title)
                    self.same(max(drawn["axes"].y.at(end) for end in interval), mean + half, 2e-3)
                (at, words), = drawn["levels"]
                deviation = math.sqrt((errors ** 2).sum()) / errors.size
                self.same(drawn["axes"].y.at(at), r[:, inside].mean() if place == "value" else math.sqrt((errors ** 2).mean()), 1e-3)
                if place == "value":
                    self.assertEqual(words, f"reference ± {short(deviation, 2)}")

    def test_the_distribution_counts_pixels(self):
        for formula in ("absolute", "signed"):
            self.set(formula=formula, right=str(self.photons), pictures=f"ref.{self.photons}", spread="")
            mask = self.counted(self.photons)
            values = self.formulas(self.layer(self.photons), self.layer("ref"), 0.01, mask)[formula].mean(axis=0)[mask]
            high = numpy.sort(abs(values))[math.floor(0.995 * (len(values) - 1))]
            low = -high if formula == "signed" else 0
            step = (high - low) / 48
            counts = numpy.bincount(numpy.clip(((values - low) // step).astype(int), 0, 47), minlength=48)
            labels = self.run_script("[...document.querySelectorAll('#spread g')].map((e) => e.getAttribute('aria-label'))")
            self.assertEqual([int(label.split()[0]) for label in labels], counts.tolist())
            for k, label in enumerate(labels):
                start, end = label.removesuffix(" and above").removesuffix(" and below").partition(" from ")[2].split(" to ")
                self.same([number(start), number(end)], [low + k * step, low + (k + 1) * step], 6e-3, 1e-9)
            self.assertIn(f": {len(values)} pixels", self.text("#spread"))
            self.check_bars(counts, low, step)
            chosen = int(numpy.argmax(counts))
            self.set(spread=str(chosen))
            self.assertEqual(self.run_script("viewer.spread.length"), counts[chosen])

    def check_bars(self, counts, low, step):
        """Bars stand on the axis of values, and are as high as the axis of counts says."""
        ticks = self.run_script("[...document.querySelectorAll('#spread svg > text.tick')].map((e) => [e.textContent, Number(e.getAttribute('x')), Number(e.getAttribute('y')), e.getAttribute('text-anchor')])")
        bars = self.run_script("[...document.querySelectorAll('#spread .bar')].map((e) => ['x', 'y', 'height'].map((name) => Number(e.getAttribute(name))))")
        across = Axes([tick for tick in ticks if tick[3] == "middle"] * 2 + [["1", 0, 4, "end"], ["2", 0, 5, "end"]], False, False).x
        self.same(across.at([x for x, _, _ in bars]), [low + k * step for k in range(48)], 1e-3, 1e-3 * step)
        tall = {int(number(text)): 220 - 40 + 4 - y for text, _, y, anchor in ticks if anchor == "end"}
        unit = (220 - 28 - 40) / (1 + math.log10(counts.max()))
        for count, height in tall.items():
            self.same(height, unit * (1 + math.log10(count)), 1e-6)
        self.same([height for _, _, height in bars], [unit * (1 + math.log10(count)) if count else 0 for count in counts], 1e-6)

    def luminance(self, image):
        return 0.2126 * image[0] + 0.7152 * image[1] + 0.0722 * image[2]

    def test_the_pointer_reads_values(self):
        for x, y in ((9, 7), (4, 2)):
            self.set(show="picture", pictures=f"ref.{self.photons}")
            self.run_script(f"hoverPixel({x}, {y})")
            one, other = (short(self.luminance(self.layer(place))[y, x]) for place in ("ref", self.photons))
            self.assertEqual(self.text("#status"), f"pixel ({x}, {y})  1: {one}   2: {other}")
            self.set(show="error", formula="absolute")
            self.run_script(f"hoverPixel({x}, {y})")
            error = abs(self.layer(self.photons) - self.layer("ref")).mean(axis=0)[y, x]
            self.same(number(self.text("#status").partition("2: ")[2]), error, 1e-3)

    def exposure(self, image):
        bright = numpy.sort(self.luminance(image)[self.luminance(image) > 0])
        return -math.log2(bright[min(len(bright) - 1, math.floor(0.99 * len(bright)))])

    def test_pictures_are_exposed_as_they_say(self):
        usual = self.exposure(self.layer("ref"))
        self.set(pictures=f"ref.{self.photons}")
        for typed in ("", "-1.5", "0.25"):
            self.set(exposure=typed)
            stops = float(typed) if typed else usual
            self.same(self.run_script("viewer.exposure"), stops, 1e-6)
            self.assertIn(f"exposure {short(stops, 3)} stops", self.text("#scale"))
            self.assertIn(f"white at {short(2 ** -stops, 3)} W", self.text("#scale"))
            linear = numpy.clip(2 ** stops * self.layer(self.photons), 0, 1)
            wanted = 255 * numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
            self.check_colours(f"viewer.images.get('{self.photons}').canvas", numpy.where(self.counted(self.photons), wanted, math.nan))
        dark = numpy.linspace(0, 0.02, 400)
        wanted = numpy.floor(0.5 + 255 * numpy.where(dark <= 0.0031308, 12.92 * dark, 1.055 * dark ** (1 / 2.4) - 0.055))
        self.assertEqual(self.run_script(f"{json.dumps(dark.tolist())}.map(srgb)"), wanted.astype(int).tolist())

    def check_colours(self, canvas, wanted):
        """The painted pixels are the colours, to the rounding of a byte; NaN is not looked at."""
        found = numpy.array(self.run_script(f"[...{canvas}.getContext('2d').getImageData(0, 0, {WIDTH}, {HEIGHT}).data]"), float)
        found = found.reshape(HEIGHT, WIDTH, 4)[..., :3].transpose(2, 0, 1)
        seen = ~numpy.isnan(wanted)
        self.assertLess(abs(found - wanted)[seen].max(), 0.51)

    def sequential(self, t):
        """Green's helix (2011) round the grey line."""
        angle, swing = 2 * math.pi * (0.15 + 0.9 * t), 0.75 * t * (1 - t)
        cos, sin = numpy.cos(angle), numpy.sin(angle)
        helix = numpy.stack([t + swing * (-0.14861 * cos + 1.78277 * sin), t + swing * (-0.29227 * cos - 0.90649 * sin), t + swing * 1.97294 * cos])
        return 255 * numpy.clip(helix, 0, 1)

    def diverging(self, t):
        x, bright = numpy.minimum(1, abs(t)), numpy.sqrt(numpy.minimum(1, abs(t)))
        below, above = numpy.stack([0.35 * x, 0.72 * bright, bright]), numpy.stack([bright, 0.62 * bright, 0.18 * x])
        return 20 + 235 * numpy.where(t < 0, below, above)

    def test_false_colours_have_their_scale(self):
        shares = set()
        self.set(show="error", pictures=str(self.photons), formula="absolute", tone="false")
        mask = self.counted(self.photons)
        for formula, scale in (("absolute", "log"), ("square", "log"), ("absolute", "linear"), ("signed", "log")):
            self.set(formula=formula, scale=scale)
            values = self.formulas(self.layer(self.photons), self.layer("ref"), 0.01, mask)[formula].mean(axis=0)
            sizes = numpy.sort(abs(values[mask]))
            high = sizes[math.floor(0.995 * (len(sizes) - 1))]
            low = min(high / 10, max(high * 1e-4, sizes[math.floor(0.05 * len(sizes))])) if scale == "log" else 0
            ticks = self.texts("#scale text")
            if formula == "signed":
                t = numpy.clip(values / high, -1, 1)
                self.assertEqual(ticks, [f"−{short(high, 3)}", "0", f"+{short(high, 3)}"])
                self.check_colours(f"viewer.images.get('{self.photons}').canvas", numpy.where(mask, self.diverging(t), math.nan))
                continue
            t = numpy.log(values / low) / math.log(high / low) if scale == "log" else values / high
            middle = math.sqrt(low * high) if scale == "log" else high / 2
            self.assertEqual(ticks, [("≤ " if scale == "log" else "") + short(low, 3), short(middle, 3), short(high, 3)])
            self.same(self.run_script("[viewer.range.low, viewer.range.high]"), [low, high], CLOSE, 1e-12)
            shares.add(round(low / high, 4))
            self.check_colours(f"viewer.images.get('{self.photons}').canvas", numpy.where(mask, self.sequential(numpy.clip(t, 0, 1)), math.nan))

        self.assertEqual(len(shares), 3, "a tenth, a percentile, and nothing")
        wide = [[10.0 ** (-k / 10) for k in range(100)]]
        self.same(self.run_script(f"((range) => range.low / range.high)(usualRange([{{planes: {wide}}}], false, true))"), 1e-4, 1e-9)

    def test_the_scale_bar_has_the_maps_colours(self):
        for signed in ("true", "false"):
            found = self.run_script(f"[...scaleBar({{signed: {signed}, log: false, low: 0, high: 1}}, 320, '').querySelectorAll('rect')].map((e) => [Number(e.getAttribute('x')), ...e.getAttribute('fill').match(/\\d+/g).map(Number)])")
            t = (numpy.arange(64) + 0.5) / 64
            colours = self.diverging(2 * t - 1) if signed == "true" else self.sequential(t)
            self.same([each[0] for each in found], numpy.arange(64) * 5, 1e-9)
            self.assertLess(abs(numpy.array([each[1:] for each in found]).T - colours).max(), 0.51)

    def test_places_on_the_screen_are_pixels(self):
        self.set(pictures=str(self.photons), view="5.25,6.75,3.000")
        found = self.run_script("""(() => { const pane = viewer.panes[0], box = pane.canvas.getBoundingClientRect(), at = view(pane.canvas);
            const look = (x, y) => { const left = pane.canvas.width / 2 + (x - at.x) * at.zoom, top = pane.canvas.height / 2 + (y - at.y) * at.zoom;
              return [pixelAt(pane, {clientX: box.left + left * box.width / pane.canvas.width, clientY: box.top + top * box.height / pane.canvas.height}),
                [...pane.canvas.getContext("2d").getImageData(Math.round(left), Math.round(top), 1, 1).data], at.zoom / at.fit]; };
            return [look(4.5, 5.5), look(6.9, 7.1)]; })()""")
        painted = numpy.array(self.run_script(f"[...viewer.images.get('{self.photons}').canvas.getContext('2d').getImageData(0, 0, {WIDTH}, {HEIGHT}).data]")).reshape(HEIGHT, WIDTH, 4)
        for (place, colour, zoom), (x, y) in zip(found, ((4.5, 5.5), (6.9, 7.1))):
            self.same(place, [x, y], 1e-6)
            self.assertEqual(colour, painted[int(y), int(x)].tolist())
            self.same(zoom, 3, 1e-9)

    def test_insets_are_where_the_reference_changes_most(self):
        r, mask = self.luminance(self.layer("ref")), self.counted()
        shown = numpy.minimum(2 ** -self.exposure(self.layer("ref")), r)
        change = numpy.zeros((HEIGHT, WIDTH))
        whole = mask[:-1, :-1] & mask[:-1, 1:] & mask[1:, :-1]
        change[:-1, :-1] = (abs(shown[:-1, 1:] - shown[:-1, :-1]) + abs(shown[1:, :-1] - shown[:-1, :-1])) * whole
        side = max(4, round(min(WIDTH, HEIGHT) / 5))
        corners = [(x, y) for y in range(0, HEIGHT - side + 1, 2) for x in range(0, WIDTH - side + 1, 2)]
        total = lambda x, y: change[y:y + side, x:x + side].sum()
        found = self.run_script("referencePicture('caustic').then(async (r) => insets(r, await countedPixels([])))")
        self.same(total(*found[0]), max(total(*corner) for corner in corners), 1e-5)
        apart = [(x, y) for x, y in corners if abs(x - found[0][0]) >= side or abs(y - found[0][1]) >= side]
        self.same(total(*found[1]), max(total(*corner) for corner in apart), 1e-5)


class Planted(Numbers):
    """The same, of the page that is shown already."""


def notices(fault):
    """The complaint of a test about the page with a fault planted, empty where it is content."""
    Numbers.world.show(Numbers.world.made_with(fault))
    result = unittest.TestResult()
    Planted(fault["test"]).run(result)
    if result.errors:
        raise RuntimeError(f"{fault['fault']}: no test of a number, but the page fails:\n{result.errors[0][1]}")
    return "".join(next(line.strip() for line in text.splitlines() if re.match(r"AssertionError|Not equal|Mismatched| [xy]: ", line) )
                   for _, text in result.failures)


class Faults(unittest.TestCase):
    def test_a_fault_of_one_percent_is_noticed_in_every_number(self):
        if Numbers.world is None:
            Numbers("setUp").setUp()
        for fault in FAULTS:
            with self.subTest(fault["fault"]):
                self.assertTrue(notices(fault), f"{fault['test']} is content")
        self.assertEqual({fault["test"] for fault in FAULTS} ^ {name for name in dir(Numbers) if name.startswith("test_")}, set())


def print_faults():
    """The table of all faults; returns how many were not noticed."""
    Numbers("setUp").setUp()
    print("| fault | file | noticed by | as |\n|---|---|---|---|")
    missed = 0
    for fault in FAULTS:
        said = notices(fault)
        missed += not said
        print(f"| {fault['fault']} | {fault['file']} | {fault['test'] if said else '**nothing**'} | {said[:80].replace('|', '/')} |", flush=True)
    Numbers.world.close()
    return missed


def load_tests(loader, _, pattern):
    return unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in (Numbers, Faults))


if __name__ == "__main__":
    if sys.argv[1:] == ["--faults"]:
        sys.exit(1 if print_faults() else 0)
    unittest.main()
