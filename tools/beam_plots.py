"""Plots (SVG) of results/beamtree."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from beam_report import AXES, BOUNDS, GROWING, by_resolution, resolved, sweep_time, thresholds
from beam_trials import microseconds, select
from plot_panels import COLOURS, LINES, MARKERS
from record_plots import GREY, PAGE, STYLE, few_ticks, svg


def panels(count):
    figure, axes = plt.subplots(1, count, figsize=(PAGE, 2.6), squeeze=False)
    figure.subplots_adjust(left=0.075, right=0.985, bottom=0.17, top=0.90, wspace=0.3 + 0.05 * count)
    return figure, list(axes[0])


def label(ax, title, x, y):
    ax.set_title(title, loc="left", fontsize=7.5, pad=3)
    ax.set_xlabel(x)
    ax.set_ylabel(y)


def bounds(scenes):
    """`scenes`: name -> cells. Tests and time a point over the threshold of `hybrid`."""
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, axes = panels(2 * len(scenes))
        for i, (scene, cells) in enumerate(scenes.items()):
            eye_pass = select(cells, method="none")[0]
            tests = lambda cell: cell.per_point("cone_point_tests")
            time = lambda cell: microseconds(cell, eye_pass)
            for ax, quantity, y in ((axes[2 * i], tests, "cone-point tests a point"), (axes[2 * i + 1], time, "µs a point")):
                draw_thresholds(ax, cells, quantity)
                label(ax, scene, "spread_threshold [°]", y)
        axes[0].legend(loc="best")
        return svg(figure)


def draw_thresholds(ax, cells, quantity):
    hybrid = thresholds(cells)
    ax.plot([float(cell.value("spread_threshold")) for cell in hybrid], [quantity(cell) for cell in hybrid],
            LINES[0], marker=MARKERS[0], color=COLOURS[0], label="hybrid")
    for bound, colour, line in zip(BOUNDS, COLOURS[1:], ("--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))):
        ax.axhline(quantity(select(cells, bound=bound)[0]), linestyle=line, color=colour, label=bound)
    ax.set_ylim(bottom=0)


def heights(cells):
    """Tests and time a point over the tree's height."""
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, axes = panels(2)
        for bound, colour, marker in zip(GROWING, COLOURS, MARKERS):
            group = resolved(by_resolution(select(cells, bound=bound)))
            eye = [select(cells, method="none", resolution=cell.value("resolution"))[0] for cell in group]
            x = [cell.counters["height"] for cell in group]
            axes[0].plot(x, [cell.per_point("cone_point_tests") for cell in group], marker=marker, color=colour, label=bound)
            axes[1].plot(x, [microseconds(cell, e) for cell, e in zip(group, eye)], marker=marker, color=colour, label=bound)
        for ax, y in zip(axes, ("cone-point tests a point", "µs a point")):
            label(ax, "pool", "height of the tree", y)
            ax.set_ylim(bottom=0)
        axes[0].legend(loc="best")
        return svg(figure)


def watt(groups):
    """Time of building over each of n_s, n_d and n_l."""
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, axes = panels(len(AXES))
        for ax, axis, cells in zip(axes, AXES, groups):
            for method, colour, marker in zip(("causticpolygons", "beamtree"), COLOURS, MARKERS):
                group = sorted(select(cells, method=method), key=axis.of) if axis.symbol != "n_d" or method != "beamtree" else []
                if group:
                    ax.plot([axis.of(cell) for cell in group], [1e3 * sweep_time(cell) for cell in group], marker=marker,
                            color=colour, label=method)
            first = min(select(cells, method="causticpolygons"), key=axis.of)
            ends = [axis.of(first), max(axis.of(cell) for cell in select(cells, method="causticpolygons"))]
            ax.plot(ends, [1e3 * sweep_time(first) * n / ends[0] for n in ends], ":", color=GREY, label="slope 1")
            ax.set_xscale("log")
            ax.set_yscale("log")
            few_ticks(ax.yaxis)
            label(ax, "", f"{axis.symbol}: {axis.words}", "sweep or tree [ms]")
        axes[0].legend(loc="best")
        return svg(figure)
