"""Plots (SVG) of results/beamtree."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

from report.beam_report import AXES, BOUNDS, GROWING, by_resolution, resolved, sweep_time, thresholds
from report.beam_trials import microseconds_range, select
from report.plot_panels import COLOURS, LINES, MARKERS, counted
from report.record_plots import GREY, PAGE, STYLE, few_ticks, svg


def panels(count):
    figure, axes = plt.subplots(1, count, figsize=(PAGE, 2.6), squeeze=False)
    figure.subplots_adjust(left=0.085, right=0.985, bottom=0.17, top=0.90, wspace=0.3 + 0.05 * count)
    return figure, list(axes[0])


def label(ax, title, x, y):
    ax.set_title(title, loc="left", fontsize=7.5, pad=3)
    ax.set_xlabel(x)
    ax.set_ylabel(y)


def bounds(scenes):
    """`scenes`: name -> cells. Tests and time a point over the threshold of `hybrid`, and what each other bound takes."""
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, axes = panels(2 * len(scenes))
        figure.subplots_adjust(bottom=0.30, top=0.90)
        for i, (scene, cells) in enumerate(scenes.items()):
            eye_pass = select(cells, method="none")[0]
            tests = lambda cell: (cell.per_point("cone_point_tests"),) * 3
            time = lambda cell: microseconds_range(cell, eye_pass)
            for ax, quantity, y in ((axes[2 * i], tests, "cone-point tests a point"), (axes[2 * i + 1], time, "µs a point")):
                draw_thresholds(ax, cells, quantity)
                label(ax, scene, "spread_threshold [°]", y)
        figure.legend(*axes[0].get_legend_handles_labels(), loc="lower center", ncols=1 + len(BOUNDS), handlelength=3)
        return svg(figure)


def draw_thresholds(ax, cells, quantity):
    """`quantity`: (median, low, high) of a cell; a time without a lower bound (a low of 0 or less) has no lower end."""
    hybrid = thresholds(cells)
    middle, low, high = zip(*(quantity(cell) for cell in hybrid))
    ax.errorbar([float(cell.value("spread_threshold")) for cell in hybrid], middle,
                yerr=[[m - max(l, 1e-9) for m, l in zip(middle, low)], [h - m for m, h in zip(middle, high)]],
                linestyle=LINES[0], marker=MARKERS[0], color=COLOURS[0], elinewidth=0.7, label="hybrid")
    for bound, colour, line in zip(BOUNDS, COLOURS[1:], ("--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))):
        m, l, h = quantity(select(cells, bound=bound)[0])
        ax.axhline(m, linestyle=line, color=colour, label=bound)
        ax.axhspan(max(l, 1e-9), h, color=colour, alpha=0.15, linewidth=0)
    ax.set_yscale("log")  # bounds differ by factors
    few_ticks(ax.yaxis)


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
            middle, low, high = zip(*(microseconds_range(cell, e) for cell, e in zip(group, eye)))
            axes[1].errorbar(x, middle, yerr=[[m - l for m, l in zip(middle, low)], [h - m for m, h in zip(middle, high)]],
                             marker=marker, color=colour, elinewidth=0.7, label=bound)
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
            few_ticks(ax.xaxis)
            ax.xaxis.set_major_formatter(lambda value, _: counted(value))
            few_ticks(ax.yaxis)
            label(ax, "", f"{axis.symbol}: {axis.words}", "time of building [ms]")
        figure.subplots_adjust(bottom=0.30)
        marks = [{"marker": mark, "color": colour} for mark, colour in zip(MARKERS[:2], COLOURS)]
        figure.legend([Line2D([], [], **look) for look in (*marks, {"linestyle": ":", "color": GREY})],
                      ["causticpolygons: beams through polygons", "beamtree: trees over the beams", "slope 1"],
                      loc="lower center", ncols=3)
        return svg(figure)
