"""Draws errors over time, one panel a scene (SVG)."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from plot_panels import COLOURS, MARKERS
from record_plots import PAGE, STYLE, svg


def draw(curves_by_scene, error="sqrt(relmse)"):
    """`curves_by_scene`: {scene: {method: [(seconds, error)]}}."""
    names = sorted({name for curves in curves_by_scene.values() for name in curves})
    marks = {name: (COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]) for i, name in enumerate(names)}
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, panels = plt.subplots(1, len(curves_by_scene), figsize=(PAGE, 3.2), squeeze=False, sharey=True)
        for ax, (scene, curves) in zip(panels[0], curves_by_scene.items()):
            for name, curve in curves.items():
                colour, marker = marks[name]
                ax.loglog(*zip(*curve), color=colour, marker=marker, markersize=3.5, label=name)
            ax.set_title(scene, loc="left")
            ax.set_xlabel("CPU time [s]")
        panels[0][0].set_ylabel(error)
        lines = {label: handle for ax in panels[0] for handle, label in zip(*ax.get_legend_handles_labels())}
        figure.legend([lines[name] for name in names], names, loc="lower center", ncols=3)
        figure.subplots_adjust(left=0.08, right=0.985, bottom=0.32, top=0.92, wspace=0.12)
        return svg(figure)
