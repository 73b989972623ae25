#!/usr/bin/python3
"""Makes README's table, sentences and strip of the methods from records: results/quickstart-2026-11/records.csv and strip/records.csv.

Without options it writes the table and the sentences between README.md's two marks. --check only says whether they are what the
records say. --strip sweeps experiments/sweeps/readme_strip*.json into results/quickstart/strip (only what
is missing; a quarter of an hour in all), keeps their records as strip/records.csv and draws results/pictures/duel.png: needs
build/release or --bench, and Debian's python3-matplotlib. Exit codes: 0 done, 1 the table differs or the sweep failed, 2 bad input or usage.
"""
import argparse
import json
import math
import pathlib
import shutil
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report.program import BENCH, ROOT, Program
from report.records import RecordsError
from report.report_files import report, write
from report_page import scenes
from report_page.sentences import factor, number, picks_within, sentences

RECORDS = ROOT / "results" / "quickstart-2026-11"
README = ROOT / "README.md"
STRIP = ROOT / "results" / "quickstart" / "strip"
PICTURE = ROOT / "results" / "pictures" / "duel.png"
MARKS = ("<!-- quick start: tools/make_readme.py -->\n", "<!-- end of quick start -->\n")
NAMES = {"ring": "mirror ring", "ball_area": "glass ball, area light", "pool": "folded pool"}
SHOWN = ("photonmap", "beamtree")
BUDGET = 2  # CPU seconds of the table's columns
STRIP_BUDGET = 5  # CPU seconds of the strip's pictures
STRIP_SWEEPS = ("readme_strip", "readme_strip_9", "readme_strip_16")
INSETS = ((0.32, 0.44), (0.08, 0.68))  # left upper corners, as shares of the picture
SIDE = 0.16  # of an inset, as a share of the picture's width


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--check", action="store_true", help="change nothing")
    parser.add_argument("--strip", action="store_true", help="draw the strip anew as well")
    parser.add_argument("--bench", type=pathlib.Path, default=BENCH, metavar="PROGRAM",
                        help="(default: build/release/bin/causticbench)")
    return parser.parse_args()


def with_interval(error, half):
    """0.00382 ± 0.00004: the interval to one digit, without a power of ten."""
    return number(error) + (f" ± {half:.{max(0, -math.floor(math.log10(half)))}f}" if half else "")


def seconds(cell):
    """Build + query; light paths that go straight to the camera build nothing."""
    build, query = cell.cost("build_s"), cell.cost("query_s")
    return f"{f'{build:.2g}' if build >= 1e-3 else '<0.001'} + {query:.2g} s"


def field(scene, picks, best, method):
    """The table's words for a method on a scene: its least error within the budget, or why there is none."""
    if method in picks:
        text = with_interval(*picks[method].error("rmse"))
        return (f"**{text}**" if picks[method] in best else text) + f" ({seconds(picks[method])})"
    own = [cell for cell in scene.scored() if cell.method == method]
    if own:
        return f"first after {number(min(cell.cost('work_s') for cell in own))} s"
    return "does not serve it"


def title(scene):
    return NAMES.get(scene.name, scene.title())


def table(folder):
    """The table in Markdown, a line on where its times were measured, what the strip shows, and the sentences."""
    sweep = scenes.Sweep(str(folder))
    found = [scene for scene in scenes.scenes_of([sweep]) if scene.contests()]
    if not found:
        raise RecordsError(f"{folder}: no scene on which two methods have errors and times")
    found.sort(key=lambda scene: list(NAMES).index(scene.name) if scene.name in NAMES else len(NAMES))
    picks = [picks_within(scene, BUDGET) for scene in found]
    best = [scenes.best_of(each.values()) for each in picks]
    methods = sorted({cell.method for scene in found for cell in scene.cells}, key=scenes.rank)
    lines = ["| method | " + " | ".join(f"{title(scene)}, {number(BUDGET)} s" for scene in found) + " |", "|---|" + "---|" * len(found)]
    for method in methods:
        lines.append(f"| `{method}` | " + " | ".join(field(*each, method) for each in zip(found, picks, best)) + " |")
    lines.append("| standard error of the reference | " + " | ".join(
        number(reference_error(scene.cells[0].rows[0])) for scene in found) + " |")
    told = [f"- {sentences(scene, title(scene), BUDGET, SHOWN)}" for scene in found]
    return "\n".join([*lines, "", machine(sweep), strip_line(folder), "", *told]) + "\n"


def strip_line(folder):
    """What the picture shows, in words."""
    scene, = scenes.scenes_of([scenes.Sweep(str(folder / "strip"))])
    cells = strip_cells(scene)
    row = cells[0].rows[0]
    told = "; ".join(f"`{cell.method}` ({cell.settings()}) rmse {with_interval(*cell.error('rmse'))} in {seconds(cell)}" for cell in cells)
    larger, smaller = sorted(cells, key=lambda cell: -cell.error("rmse")[0])
    ratio = larger.error("rmse")[0] / smaller.error("rmse")[0]
    return (f"The picture: {row['width']} × {row['height']} pixels, each method's best within {number(STRIP_BUDGET)} CPU s; {told}. The error of "
            f"`{larger.method}` is at least {factor(ratio)} times that of `{smaller.method}`, since the reference's own error adds to both. {len(cells[0].seeds())} seeds; the reference's standard "
            f"error is {number(reference_error(row))}; {row['cpu']}, causticbench {row['code_version']}.")


def reference_error(row):
    return float(row["reference_stderr"]) * float(row["reference_mean"])


def machine(sweep):
    done = [row for row in sweep.rows if row["status"] == "done"]
    loads = sorted(float(row["load_average"]) for row in done)
    several = lambda name: ", ".join(sorted({row[name] for row in done}))
    seeds = len({row["seed"] for row in done})
    built = json.loads((RECORDS / "environment.json").read_text(encoding="utf-8"))
    minutes = sum(float(row["cpu_s"]) for row in done) / 60
    return (f"{seeds} seeds, {len(done)} trials, {minutes:.0f} CPU minutes in all; {several('cpu')}, {several('isa')}, {several('threads')} threads a trial, load average "
            f"{loads[0]:.0f} to {loads[-1]:.0f} by other work; causticbench {several('code_version')}, {built['compiler']}, {built['flags']}"
            + ("." if "NDEBUG" in built["flags"] else ", assertions on."))


def with_block(text, block):
    """README with the block between its marks."""
    before, first, rest = text.partition(MARKS[0])
    _, second, after = rest.partition(MARKS[1])
    if not first or not second:
        raise RecordsError(f"{README}: lacks the marks {MARKS[0].strip()} and {MARKS[1].strip()}")
    return before + first + block + second + after


def make_strip(bench):
    files = [ROOT / "experiments" / "sweeps" / f"{name}.json" for name in STRIP_SWEEPS]
    Program("make_readme", bench).run("sweep", *files, "-o", STRIP, stdout=sys.stderr)
    (RECORDS / "strip").mkdir(parents=True, exist_ok=True)
    shutil.copyfile(STRIP / "records.csv", RECORDS / "strip" / "records.csv")
    draw_strip()


def strip_cells(scene):
    """The photon map's and the beam tree's cells of least error within the strip's budget."""
    picks = picks_within(scene, STRIP_BUDGET)
    missing = [method for method in SHOWN if method not in picks]
    if missing:
        raise RecordsError(f"readme_strip: no records of {' and '.join(missing)} within {number(STRIP_BUDGET)} CPU s")
    return [picks[method] for method in SHOWN]


def draw_strip():
    """Reference, photon map and beam tree in one picture, with two insets each."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy
    from report import exr
    from report_page import pictures

    scene, = scenes.scenes_of([scenes.Sweep(str(STRIP))])
    key = scene.reference.partition(":")[2]
    reference = STRIP / "references" / f"{key}.exr"
    paths = json.loads(exr.read(reference)[1]["causticbench.parameters"])["paths"]
    shown = [(pictures.read(reference)[0], "reference", f"particle tracing, {paths / 1e6:g} million paths")]
    for cell in strip_cells(scene):
        layers, _ = pictures.read(STRIP / "trials" / cell.rows[0]["trial"] / "image.exr")
        error, half = cell.error("rmse")
        name = {"photonmap": "photon map", "beamtree": "beam tree"}[cell.method]
        shown.append((layers, name, f"{cell.cost('work_s'):.2g} CPU s, rmse {with_interval(error, half)}"))
    rest = shown[0][0]["rest"]
    whole = [numpy.moveaxis(numpy.maximum(layers["caustic"] + rest, 0), 0, 2) for layers, _, _ in shown]
    luminance = whole[0] @ numpy.array([0.2126, 0.7152, 0.0722])
    white = float(numpy.percentile(luminance[luminance > 0], 99))
    height, width = luminance.shape
    side = round(SIDE * width)
    colours = ("#ff9d00", "#00b7ff")
    figure = plt.figure(figsize=(12, 12 / 3 * height / width + 2.45), dpi=100, facecolor="white")
    grid = figure.add_gridspec(2, 6, left=0.004, right=0.996, top=0.995, bottom=0.085, wspace=0.03, hspace=0.03,
                               height_ratios=[2 * height / width, 1])
    for i, (picture, (_, name, words)) in enumerate(zip(whole, shown)):
        tone = srgb(picture / white)
        axes = figure.add_subplot(grid[0, 2 * i:2 * i + 2])
        axes.imshow(tone, interpolation="nearest")
        axes.set_axis_off()
        for n, (x, y) in enumerate(INSETS):
            left, top = round(x * width), round(y * height)
            axes.add_patch(plt.Rectangle((left, top), side, side, fill=False, edgecolor=colours[n], linewidth=2, linestyle=("-", "--")[n]))
            inset = figure.add_subplot(grid[1, 2 * i + n])
            inset.imshow(tone[top:top + side, left:left + side], interpolation="nearest")
            inset.set_xticks([]), inset.set_yticks([])
            for edge in inset.spines.values():
                edge.set(edgecolor=colours[n], linewidth=2.5, linestyle=("-", "--")[n])
        figure.text((i + 0.02) / 3 if i else 0.006, 0.045, name, weight="bold", size=13)
        figure.text((i + 0.02) / 3 if i else 0.006, 0.012, words, size=11)
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE, metadata={"Software": ""})


def srgb(linear):
    import numpy

    x = numpy.clip(linear, 0, 1)
    return numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def main():
    chosen = arguments()
    differs = []

    def make():
        if chosen.strip:
            make_strip(chosen.bench)
        text = README.read_text(encoding="utf-8")
        wanted = with_block(text, table(RECORDS))
        if text == wanted:
            return
        differs.append(True)
        if not chosen.check:
            write(README, wanted)

    try:
        code = report("make_readme", "the table and the strip", README, make)
    except ChildProcessError as error:
        print(f"make_readme: {error}", file=sys.stderr)
        return 1
    if code == 0 and chosen.check and differs:
        print("make_readme: README.md's table is not what results/quickstart-2026-11/records.csv says (run tools/make_readme.py)",
              file=sys.stderr)
        return 1
    return code


if __name__ == "__main__":
    sys.exit(main())
