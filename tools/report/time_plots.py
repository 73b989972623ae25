"""Draws errors over time, one panel a scene (SVG)."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from report.plot_panels import COLOURS, LINES, MARKERS
from report.record_plots import PAGE, STYLE, few_ticks, svg

COLUMNS = 3  # of the legend


def draw(curves_by_scene, error="sqrt(relmse)"):
    """`curves_by_scene`: {scene: {method: [(seconds, error)]}}, or (seconds, error, low, high) with the seeds' range."""
    names = sorted({name for curves in curves_by_scene.values() for name in curves})
    looks = {name: {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)], "linestyle": LINES[i % len(LINES)]}
             for i, name in enumerate(names)}
    foot = 0.62 + 0.16 * -(-len(names) // COLUMNS)  # inches
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, panels = plt.subplots(1, len(curves_by_scene), figsize=(PAGE, 2.4 + foot), squeeze=False, sharey=True)
        for ax, (scene, curves) in zip(panels[0], curves_by_scene.items()):
            for name, curve in curves.items():
                draw_curve(ax, curve, name, looks[name])
            ax.set_xscale("log")
            ax.set_yscale("log")
            ax.set_title(scene, loc="left")
            ax.set_xlabel("CPU time [s]")
        for ax in panels[0]:
            few_ticks(ax.xaxis)
        few_ticks(panels[0][0].yaxis)
        panels[0][0].set_ylabel(f"{error} [1]")
        lines = {label: handle for ax in panels[0] for handle, label in zip(*ax.get_legend_handles_labels())}
        figure.legend([lines[name] for name in names], names, loc="lower center", ncols=COLUMNS, handlelength=3)
        figure.subplots_adjust(left=0.08, right=0.985, bottom=foot / (2.4 + foot), top=0.92, wspace=0.12)
        return svg(figure)


def draw_curve(ax, curve, name, look):
    seconds, errors, *ends = zip(*curve)
    ax.plot(seconds, errors, markersize=3.5, label=name, **look)
    if ends:
        ax.vlines(seconds, *ends, color=look["color"], linewidth=0.7)
