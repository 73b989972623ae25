"""Draws how the two methods fare over each variable that the duel asks of: radius and points of a light, events, alpha, pixels, share that is
lit, mesh, wanted error, memory."""
import matplotlib.pyplot as plt

from duel import measures
from duel.factors import BEAMS, PHOTONS, SECOND
from duel.plots import GREY, LOOKS, bounds, legend, marks, save, style
from duel.ranges import estimate
from duel.tables import ERRORS
from report.plot_panels import COLOURS, MARKERS
from report.record_plots import few_ticks

BOTH = (PHOTONS, BEAMS)
AFTER = f"error after {SECOND:g} CPU second [1]"
# title, name of the variable, {its value: scene}
SWEPT = (("light's size: folded pool", "radius of the lamp [cm]", {1: "lamp1", 10: "lamp10", 30: "lamp30"}),
         ("specular events: glass bowl", "most events followed [1]", {2: "bowl2", 4: "bowl4", 8: "bowl8"}),
         ("alpha of the receiver: ring", "alpha [1]", {0.01: "glossy1", 0.1: "glossy10", 1: "glossy100"}),
         ("resolution: folded pool", "pixels along a side [1]", {64: "folded", 160: "folded160"}),
         ("share that is lit: glass ball", "field of view [degrees]; less is more lit", {14: "ball_near", 40: "ball", 80: "ball_far"}))


def swept(ax, results, title, name, scenes):
    """Both methods' errors after SECOND, with 95 % intervals and what may lie between settings."""
    for label in BOTH:
        points = [(x, *point) for x, scene in scenes.items() for point in error_point(results.fields.get(scene), label)]
        if points:
            draw(ax, points, label)
        else:
            ax.text(0.04, 0.05, f"{label}: no picture by then", transform=ax.transAxes, fontsize=7, color=GREY)
    finish(ax, title, name, AFTER, list(scenes))


def error_point(field, label):
    """[what `reach` has of the error]; nothing where there is no picture."""
    error = field.at_time(label, SECOND) if field else None
    found = estimate(error, field.seeds) if error is not None and error.is_reached() else None
    if found is None:
        return []
    return [reach(found)]


def reach(found):
    """(value, how far its interval reaches below and above, whether it is a bound)."""
    low, high = found.ends()
    return (found.value, 0.0, 0.0, True) if low == 0 else (found.value, max(found.value - low, 0.0), max(high - found.value, 0.0), False)


def draw(ax, points, label):
    look = LOOKS[label]
    x, y, below, above, hides = zip(*points)
    ax.errorbar(x, y, yerr=(below, above), markersize=4, elinewidth=0.8, capsize=2, label=label, **look)
    hidden = [(place, value) for place, value, is_bound in zip(x, y, hides) if is_bound]
    if hidden:
        bounds(ax, hidden)


def finish(ax, title, x, y, ticks=None):
    ax.set(xscale="log", yscale="log", xlabel=x, ylabel=y)
    ax.margins(x=0.12, y=0.05)
    low, high = ax.get_ylim()
    ax.set_ylim(low / 1.4, high * 1.4)
    ax.set_title(title, loc="left")
    few_ticks(ax.yaxis)
    if ticks:
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        ax.minorticks_off()
    else:
        few_ticks(ax.xaxis)


def lines(ax, series, title, x, y, ticks=None):
    """Lines with looks of their own: {name: points}."""
    for i, (name, points) in enumerate(series.items()):
        if points:
            ax.plot(*zip(*points), color=COLOURS[2 + i], marker=MARKERS[2 + i], linestyle=("-", "--", "-.", ":")[i], label=name)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(fontsize=6.5, handlelength=3.5)
    finish(ax, title, x, y, ticks)


def light_samples(ax, results):
    """From the search, one seed: beams asked for the squares of pixels, over the points that stand for the lamp."""
    series = {}
    for scene, radius in (("lamp1", 1), ("lamp10", 10), ("lamp30", 30)):
        own = [cell for cell in results.searched.get(scene, []) if cell.label == BEAMS and "footprint" in dict(cell.setting.param)
               and dict(cell.setting.param)["intensity"] == "area"]
        series[f"lamp of {radius} cm"] = sorted((dict(cell.setting.param)["light_samples"], cell.error()) for cell in own)
        hidden = [(dict(cell.setting.param)["light_samples"], cell.error()) for cell in own if cell.is_bound()]
        if hidden:
            bounds(ax, hidden, "_hidden")
    lines(ax, series, "points of a light: beam tree, search", "light_samples [1]", "error [1]", [1, 4, 16, 64, 256])


def meshes(ax, results):
    series = {f"{scene} pool, {intensity}": sorted(measures.mesh_errors(results, scene, intensity).items())
              for scene in ("calm", "folded") for intensity in ("area", "refined")}
    lines(ax, series, "mesh of the water: beam tree, search", "polygons along a side [1]", "error [1]", [32, 64, 128, 256])


def wanted(ax, results, scene="calm"):
    """CPU seconds to each wanted error: the first setting that has it, down to the last that has not."""
    field = results.fields.get(scene)
    for label in BOTH if field else ():
        times = [(error, field.at_error(label, error)) for error in ERRORS]
        found = [(100 * error, estimate(time, field.seeds)) for error, time in times if time is not None and time.is_reached()]
        if found:
            draw(ax, [(error, *reach(each)) for error, each in found], label)
    finish(ax, "wanted error: calm pool", "wanted error [%]", "CPU seconds [s]", [0.1, 1, 5, 20])


def memory(ax, results, scene="folded"):
    field = results.fields.get(scene)
    for label in BOTH if field else ():
        own = sorted(field.own.get(label, []), key=lambda cell: cell.median("map_bytes"))
        marks(ax, [cell.median("map_bytes") / 1e6 for cell in own], own, LOOKS[label])
        ax.plot([], [], label=label, **LOOKS[label])
    finish(ax, "memory: folded pool, all settings", "built [MB]", "error [1]")


def figure_of(results):
    figure, panels = plt.subplots(3, 3, figsize=(11, 9))
    order = iter(panels.flat)
    for each in SWEPT:
        swept(next(order), results, *each)
    for draw_panel in (light_samples, meshes, wanted, memory):
        draw_panel(next(order), results)
    legend(figure, panels.flat, ncols=4, fontsize=8)
    figure.tight_layout(rect=(0, 0.04, 1, 1))
    return figure


def write(results, folder):
    """variables.png, where any of its scenes was run."""
    if any(scene in results.fields for _, _, scenes in SWEPT for scene in scenes.values()):
        with style(folder):
            save(figure_of(results), folder / "variables.png")
