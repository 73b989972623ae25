"""Draws every contestant's error over CPU time, one panel a scene, as a PNG."""
import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

from peers import scores
from report.plot_panels import COLOURS, LINES, MARKERS

SIZE, COLUMNS, DOTS = (10.5, 6.6), 3, 110  # inches, panels a row, dots an inch


def draw(results, path):
    names = results.held.names
    matplotlib.rcdefaults()
    with matplotlib.rc_context({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3}):
        figure, panels = plt.subplots(-(-len(results.scenes) // COLUMNS), COLUMNS, figsize=SIZE, squeeze=False)
        free = list(panels.flat)
        for scene, ax in zip(results.scenes, free):
            panel(ax, scene, results, names)
        for ax in free[len(results.scenes):]:
            ax.set_axis_off()
        lines = {label: line for ax in free for line, label in zip(*ax.get_legend_handles_labels())}
        free[-1].legend(lines.values(), lines.keys(), loc="center", frameon=False, handlelength=3)
        figure.tight_layout()
        figure.savefig(path, dpi=DOTS, metadata={"Software": None})
        plt.close(figure)


def panel(ax, scene, results, names):
    cells = results.cells(scene)
    for number, name in enumerate(names):
        points = scores.curve(cells, (name,))
        if points:
            ax.plot(*zip(*points), label=results.held.titles[name], color=COLOURS[number % len(COLOURS)], marker=MARKERS[number % len(MARKERS)],
                    linestyle=LINES[number % len(LINES)], markersize=4)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_title(scene.title, loc="left")
    ax.set_xlabel("CPU time [s]")
    ax.set_ylabel("error, √relmse [1]")
