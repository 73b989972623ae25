"""Draws error over CPU seconds, a panel a scene, with intervals; and the tests in trees over their heights."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.markers import CARETDOWN

from duel.curves import is_pair
from duel.ranges import Range, estimate
from duel.tables import METHODS, shown
from report.plot_panels import COLOURS, MARKERS
from report.record_plots import STYLE, few_ticks, svg

LIMIT, BOUND = "least error that the truth can show", "a bound: may be less"
GREY = "0.45"
LINES = ("-", "--", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (2, 1)), (0, (1, 1)), (0, (8, 2)))  # no two methods share one
LOOKS = {label: {"color": COLOURS[i], "marker": MARKERS[i], "linestyle": LINES[i]} for i, label in enumerate(METHODS)}
TIME, ERROR = "CPU seconds, build + query", "error [1]"


def intervals(cell):
    """The error, and how far its interval reaches below and above; a bound has none below."""
    ends = estimate(Range(cell.low, cell.high), len(cell.rows))
    if ends is None or cell.is_bound():
        return cell.error(), 0.0, 0.0
    low, high = ends.ends()
    return cell.error(), cell.error() - max(low, cell.error() / 100), min(high, 100 * cell.error()) - cell.error()


def marks(ax, places, cells, look):
    """Settings with their intervals; bounds have arrows."""
    errors, below, above = zip(*map(intervals, cells))
    ax.errorbar(places, errors, yerr=(below, above), linestyle="none", marker=look["marker"], color=look["color"], markersize=3.5,
                elinewidth=0.7, alpha=0.8)
    hidden = [(x, cell.error()) for x, cell in zip(places, cells) if cell.is_bound()]
    if hidden:
        bounds(ax, hidden)


def bounds(ax, points, label=BOUND):
    """Arrows that point down from bounds."""
    x, y = zip(*points)
    ax.errorbar(x, y, yerr=[0.18 * value for value in y], uplims=True, linestyle="none", color="black", elinewidth=1, capsize=3, label=label)


def panel(ax, scene, field):
    """Every final setting as a mark with its interval; the front as a line."""
    for label in METHODS:
        own = field.own.get(label, [])
        if own:
            look = LOOKS[label]
            marks(ax, [cell.seconds() for cell in own], own, look)
            ax.plot(*zip(*path(field.front(label))), color=look["color"], linestyle=look["linestyle"], label=label)
    scales(ax, [cell.error() for cell in field.cells if cell.label in METHODS], field.limit)
    ax.set_title(scene.title, loc="left")


def path(front):
    """A front as a line: steps, since nothing is known between settings, but straight where they differ in one parameter of work alone."""
    points = [(front[0].seconds(), front[0].error())]
    for before, cell in zip(front, front[1:]):
        if not is_pair(before.setting, cell.setting):
            points.append((cell.seconds(), before.error()))
        points.append((cell.seconds(), cell.error()))
    return points


def scales(ax, errors, limit=0.0):
    """Log scales over what was measured; the truth's limit only where it lies among it."""
    ax.set(xscale="log", yscale="log")
    low, high = min(errors), max(errors)
    ax.set_ylim(low / 1.6, high * 1.6)
    if limit > low / 1.6:
        ax.axhline(limit, color=GREY, linewidth=0.9, linestyle=":", label=LIMIT)
    few_ticks(ax.yaxis)
    few_ticks(ax.xaxis)


def legend(figure, panels, **more):
    handles = {label: handle for ax in panels for handle, label in zip(*ax.get_legend_handles_labels())}
    looks = {label: {"markersize": 4, **look} for label, look in LOOKS.items()}
    looks[BOUND] = {"marker": CARETDOWN, "linestyle": "none", "color": "black"}
    handles.update({label: Line2D([], [], **looks[label]) for label in handles.keys() & looks.keys()})
    names = [label for label in (*METHODS, LIMIT, BOUND) if label in handles]
    figure.legend([handles[name] for name in names], names, loc="lower center", handlelength=4, **more)


def overview(results):
    """All scenes."""
    found, columns = shown(results), 4
    rows = -(-len(found) // columns)
    figure, panels = plt.subplots(rows, columns, figsize=(13, 2.7 * rows + 0.6), squeeze=False)
    for ax, (scene, field) in zip(panels.flat, found):
        panel(ax, scene, field)
    for ax in panels.flat[len(found):]:
        ax.axis("off")
    for ax in panels[:, 0]:
        ax.set_ylabel(ERROR)
    for ax in panels.flat[max(0, len(found) - columns):len(found)]:
        ax.set_xlabel(TIME)
    legend(figure, panels.flat[:len(found)], ncols=4, fontsize=9)
    figure.tight_layout(rect=(0, 0.6 / (2.7 * rows + 0.6), 1, 1))
    return figure


def single(scene, field):
    figure, ax = plt.subplots(figsize=(5.6, 4.4))
    panel(ax, scene, field)
    ax.set(xlabel=TIME, ylabel=ERROR)
    legend(figure, [ax], ncols=3, fontsize=7)
    figure.tight_layout(rect=(0, 0.16, 1, 1))
    return figure


def heights(results):
    """Tests a point over the sum of the trees' heights."""
    figure, ax = plt.subplots(figsize=(5, 3.4))
    for i, (name, what) in enumerate((("casters", "1 to 100 casters"), ("lights", "1 to 64 points of a light"))):
        rows = [row for row in results.counts if row["sweep"] == f"counts_{name}"]
        points = sorted((row["trees"] * row["height"], row["cone_point_tests"] / row["receiver_points"]) for row in rows)
        if points:
            ax.plot(*zip(*points), color=COLOURS[i], marker=MARKERS[i], linestyle=LINES[i], label=what)
    ax.set(xscale="log", yscale="log", xlabel="sum of the trees' heights [1]", ylabel="cone tests a point [1]")
    few_ticks(ax.xaxis)
    few_ticks(ax.yaxis)
    ax.legend(fontsize=7)
    figure.tight_layout()
    return figure


def write(results, folder):
    """overview.svg and .png, SCENE.png, heights.png."""
    with style(folder):
        figure = overview(results)
        figure.savefig(folder / "overview.png", dpi=110, metadata={"Software": None})
        (folder / "overview.svg").write_text(svg(figure), encoding="utf-8")
        for scene, field in shown(results):
            save(single(scene, field), folder / f"{scene.name}.png")
        if results.counts:
            save(heights(results), folder / "heights.png")


def style(folder):
    folder.mkdir(parents=True, exist_ok=True)
    matplotlib.rcdefaults()
    return matplotlib.rc_context({**STYLE, "svg.hashsalt": "duel"})


def save(figure, path):
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
