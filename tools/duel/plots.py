"""Draws error over CPU seconds, a panel a scene, with intervals; and the tests in trees over their heights."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from duel import curves
from duel.tables import METHODS, shown
from report.plot_panels import COLOURS, LINES, MARKERS
from report.record_plots import STYLE, svg

NOISE = "the truth's own error"
LOOKS = {label: {"color": COLOURS[i], "marker": MARKERS[i], "linestyle": LINES[i % len(LINES)]} for i, label in enumerate(METHODS)}


def intervals(cell):
    """The error, and how far its interval reaches below and above."""
    value, low, high = curves.interval(cell.error(), cell.errors[1:], len(cell.rows))
    return value, value - low, min(high, 100 * value) - value


def panel(ax, scene, field):
    """Every final setting as a mark with its interval; the front as a line."""
    for label in METHODS:
        own = [cell for cell in field.cells if cell.label == label]
        if not own:
            continue
        look = LOOKS[label]
        errors, below, above = zip(*map(intervals, own))
        ax.errorbar([cell.seconds() for cell in own], errors, yerr=(below, above), linestyle="none", marker=look["marker"],
                    color=look["color"], markersize=3.5, elinewidth=0.7, alpha=0.8)
        line = field.curve(label)
        ax.plot(*zip(*line), color=look["color"], linestyle=look["linestyle"], marker=look["marker"], markersize=3.5, label=label)
    noise = field.cells[0].noise ** 0.5
    ax.axhline(noise, color="#888888", linewidth=0.9, linestyle=":", label=NOISE)
    ax.set(xscale="log", yscale="log")
    ax.set_title(scene.title, loc="left")


def overview(results):
    """(SVG, figure): all scenes."""
    found = shown(results)
    columns = 4
    rows = -(-len(found) // columns)
    figure, panels = plt.subplots(rows, columns, figsize=(13, 2.7 * rows + 0.6), squeeze=False)
    for ax, (scene, field) in zip(panels.flat, found):
        panel(ax, scene, field)
    for ax in panels.flat[len(found):]:
        ax.axis("off")
    for ax in panels[:, 0]:
        ax.set_ylabel("error [1]")
    for ax in panels.flat[max(0, len(found) - columns):len(found)]:
        ax.set_xlabel("CPU seconds, build + query")
    handles = {label: handle for ax in panels.flat[:len(found)] for handle, label in zip(*ax.get_legend_handles_labels())}
    names = [label for label in (*METHODS, NOISE) if label in handles]
    figure.legend([handles[name] for name in names], names, loc="lower center", ncols=len(names), handlelength=3)
    figure.tight_layout(rect=(0, 0.5 / (2.7 * rows + 0.6), 1, 1))
    return figure


def single(scene, field):
    figure, ax = plt.subplots(figsize=(5, 4))
    panel(ax, scene, field)
    ax.set(xlabel="CPU seconds, build + query", ylabel="error [1]")
    figure.legend(*ax.get_legend_handles_labels(), loc="lower center", ncols=3, fontsize=7, handlelength=3)
    figure.tight_layout(rect=(0, 0.13, 1, 1))
    return figure


def heights(results):
    """Tests a point over the sum of the trees' heights."""
    figure, ax = plt.subplots(figsize=(5, 3.4))
    for i, (name, what) in enumerate((("casters", "1 to 100 casters"), ("lights", "1 to 64 points of a light"))):
        rows = [row for row in results.counts if row["sweep"] == f"counts_{name}"]
        points = sorted((row["trees"] * row["height"], row["cone_point_tests"] / row["receiver_points"]) for row in rows)
        if points:
            ax.plot(*zip(*points), color=COLOURS[i], marker=MARKERS[i], linestyle=LINES[i], label=what)
    ax.set(xscale="log", yscale="log", xlabel="sum of the trees' heights", ylabel="cone tests a point")
    ax.legend(fontsize=7)
    figure.tight_layout()
    return figure


def write(results, folder):
    """overview.svg and .png, SCENE.png, heights.png."""
    folder.mkdir(parents=True, exist_ok=True)
    matplotlib.rcdefaults()
    with matplotlib.rc_context({**STYLE, "svg.hashsalt": "duel"}):
        figure = overview(results)
        figure.savefig(folder / "overview.png", dpi=110, metadata={"Software": None})
        (folder / "overview.svg").write_text(svg(figure), encoding="utf-8")
        for scene, field in shown(results):
            save(single(scene, field), folder / f"{scene.name}.png")
        if results.counts:
            save(heights(results), folder / "heights.png")


def save(figure, path):
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
