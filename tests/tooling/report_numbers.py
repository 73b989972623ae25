"""A sweep of random pictures and records with its page in a browser, and what the page's numbers should be: from the records and
from the pictures' values by NumPy and SciPy, not by the page's own scripts."""
import decimal
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
import scipy.stats

import browser
import report_sweep as sweep
from report_page import pictures

ROOT = pathlib.Path(__file__).resolve().parents[2]
ERRORS = ("rmse", "relmse", "bias", "variance", "mean_ratio", "leak_energy", "mask_rmse", "beauty_rmse", "flip", "indirect_rmse")
COSTS = {"work_s": ("precompute_cpu_s", "balance_cpu_s", "indirect_cpu_s", "render_cpu_s"), "build_s": ("precompute_cpu_s", "balance_cpu_s"),
         "query_s": ("render_cpu_s",), "indirect_cpu_s": ("indirect_cpu_s",), "total_s": ("total_s",),
         "photons_stored": ("photons_stored",), "photons_emitted": ("photons_emitted",), "map_bytes": ("map_bytes",),
         "peak_rss_bytes": ("peak_rss_bytes",)}
STDERR_SHARE = 0.137  # reference_stderr of all records


def write_random_sweep(folder):
    """Two scenes, both methods, five seeds: every picture, and nearly every number of every record, differs from the others."""
    random = numpy.random.default_rng(47)
    caustic, rest, unreached = sweep.reference_planes()
    caustic *= random.uniform(0.7, 1.3, unreached.shape).astype(numpy.float32)
    unreached[3, 7] = 0.25
    rows = sweep.write_sweep(folder, scenes=("pool", "ring"))
    shape = caustic.shape
    stderr = {f"{name}.Y": random.uniform(0.005, 0.02, shape[1:]).astype(numpy.float32) for name in ("stderr", "indirect_stderr")}
    sweep.write_exr(folder / "references" / f"{sweep.KEY}.exr",
                    {**lit(caustic, rest, random.uniform(0.2, 0.3, shape)), **stderr, "unreached.Y": unreached})
    mean = float(caustic[:, unreached == 0].mean(dtype=float))
    for row in rows:
        step = float(row["map_bytes"]) / 1000
        if row["seed"] == "1":
            bias = random.normal(0.03, 0.05, shape)  # the same for all seeds of a cell
        colours = caustic + (bias + random.normal(0, 0.05, shape)) / step
        planes = lit(colours, rest, random.uniform(0.2, 0.4, shape))
        if row["method"] == "beamtree":
            planes["unreached.Y"] = numpy.zeros(shape[1:], numpy.float32)
            planes["unreached.Y"][8, 2:4] = 1
        sweep.write_exr(folder / "trials" / row["trial"] / "image.exr", planes)
        flip = random.uniform(0, 1, shape[1:]).astype(numpy.float32)
        sweep.write_exr(folder / "trials" / row["trial"] / "flip.exr", {"flip.Y": flip},
                        texts=[("causticbench.picture_hash", row["picture_hash"])])
        row.update(random_record(random, step), reference_stderr=repr(STDERR_SHARE), reference_mean=repr(mean))
    failed = [{**row, "trial": f"failed-{row['trial']}", "status": "failed", "message": "it ended", "seed": str(100 + i)}
              for i, row in enumerate(rows[:3])]
    sweep.write_table(folder, rows + failed)
    return rows


def lit(caustic, rest, indirect):
    """The planes of a picture of these three layers."""
    planes = sweep.planes_of(caustic.astype(numpy.float32), rest)
    for name, plane in zip("RGB", indirect.astype(numpy.float32)):
        planes[name] = planes[name] + plane
        planes[f"indirect.{name}"] = plane
    return planes


def random_record(random, step):
    values = {name: random.uniform(0.5, 1.5) * 0.1 / step ** 0.6 for name in ERRORS}
    values.update(variance=0.013 / step, bias=random.normal(-0.2, 0.05) / step, mean_ratio=random.normal(1, 0.1))
    for name in ("precompute_cpu_s", "balance_cpu_s", "indirect_cpu_s", "render_cpu_s", "total_s"):
        values[name] = random.uniform(0.8, 1.2) * 0.1 * step
    for name in ("photons_emitted", "photons_stored", "map_bytes", "peak_rss_bytes"):
        values[name] = int(random.uniform(0.8, 1.2) * 1e5 * step)
    values["load_average"] = round(random.uniform(1, 3), 2)
    return {name: repr(value) for name, value in values.items()}


class World:
    """The sweep, its page as the tools make it, and a browser that shows it, or shows it with something else in its text."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.sweep = pathlib.Path(self.folder.name) / "sweep"
        self.rows = write_random_sweep(self.sweep)
        self.sound = self.made_by(ROOT / "tools")
        self.data = json.loads(re.search(r'id="data">(.*?)</script>', self.sound, re.S)[1])
        self.browser = browser.Browser(1600, 1000)
        self.shown = None
        self.show(self.sound)

    def close(self):
        self.browser.close()
        self.folder.cleanup()

    def made_by(self, tools):
        """The text of the page by the tools of a folder."""
        page = pathlib.Path(self.folder.name) / "made.html"
        subprocess.run([sys.executable, tools / "make_report.py", self.sweep, "-o", page], check=True, capture_output=True)
        return page.read_text(encoding="utf-8")

    def made_with(self, fault):
        """The text of the page with a fault planted in the tools."""
        source = (ROOT / fault["file"]).read_text(encoding="utf-8")
        assert source.count(fault["find"]) == 1, f"{fault['file']}: {source.count(fault['find'])} places read {fault['find']}"
        planted = source.replace(fault["find"], fault["plant"])
        if fault["file"].endswith(".js"):
            assert source in self.sound
            return self.sound.replace(source, planted)
        tools = pathlib.Path(self.folder.name) / "tools"
        shutil.rmtree(tools, ignore_errors=True)
        for name in ("report", "report_page"):
            shutil.copytree(ROOT / "tools" / name, tools / name)
        shutil.copy(ROOT / "tools" / "make_report.py", tools)
        (tools.parent / fault["file"]).write_text(planted, encoding="utf-8")
        return self.made_by(tools)

    def show(self, text):
        """Opens a page, unless it is open."""
        if text == self.shown:
            return
        self.shown = text
        page = pathlib.Path(self.folder.name) / "report.html"
        page.write_text(text, encoding="utf-8")
        self.browser.open("about:blank")
        self.browser.open(page.as_uri())

    def cell(self, method, step, scene="pool"):
        """The records of a cell, a seed each."""
        return [row for row in self.rows if row["trial"].startswith(f"{scene}-{method}-{step}-s")]

    def values(self, number):
        """A picture of the sound page, by its number."""
        text = re.search(rf'id="p{number}">([^<]*)<', self.sound)[1]
        return pictures.unpacked(self.data["pictures"][number], text)

    def layer(self, place, name, seed=0):
        """A layer of a cell's picture, or of the reference, of the first scene as three planes of doubles."""
        scene = self.data["scenes"][0]
        layers = scene["reference"]["layers"] if place == "ref" else scene["cells"][place]["pictures"][seed]
        values = self.values(layers[name])
        return numpy.repeat(values, 3, axis=0) if len(values) == 1 and name in ("caustic", "indirect") else values


def mean_and_half(values):
    """Mean and half its 95 % interval."""
    return float(numpy.mean(values)), float(scipy.stats.t.ppf(0.975, len(values) - 1) * scipy.stats.sem(values))


def short(number, digits=4):
    """A number as the page writes it."""
    if number is None or math.isnan(number):
        return "–"
    if number == 0:
        return "0"
    plain = 1e-4 <= abs(number) < 1e6
    number = float(decimal.Context(prec=digits, rounding=decimal.ROUND_HALF_UP).create_decimal(number))
    if plain:
        text = f"{number:#.{digits}g}"
    else:
        text = f"{number:.{digits - 1}e}"
    text, _, power = text.partition("e")
    text = text.removesuffix(".").replace("-", "−")
    return f"{text} · 10{str(int(power)).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}" if power else text


def number(text):
    """The text of a number on the page."""
    text = text.strip().replace("−", "-")
    power = re.fullmatch("(.*?)(?: · )?10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", text)
    if not power:
        return float(text)
    return float(power[1] or 1) * 10.0 ** int(power[2].translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")))


class Axes:
    """The axes of a plot, read from the places and the texts of its ticks."""

    def __init__(self, ticks, log_x, log_y):
        self.x = Axis([(text, x) for text, x, _, anchor in ticks if anchor == "middle"], log_x)
        self.y = Axis([(text, y - 4) for text, _, y, anchor in ticks if anchor == "end"], log_y)


class Axis:
    def __init__(self, ticks, is_log):
        self.log = is_log
        values = numpy.array([number(text) for text, _ in ticks])
        places = numpy.array([place for _, place in ticks])
        assert len(values) >= 2, ticks
        self.slope, self.start = numpy.polyfit(places, numpy.log(values) if is_log else values, 1)
        left = (numpy.log(values) if is_log else values) - self.slope * places - self.start
        assert numpy.abs(left).max() < 1e-3 * numpy.abs(self.slope * (places[-1] - places[0])), f"ticks stand at {ticks}"

    def at(self, place):
        """The value at a place of the drawing."""
        value = self.slope * numpy.asarray(place) + self.start
        return numpy.exp(value) if self.log else value
