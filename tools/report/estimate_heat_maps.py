"""Draws a heat map: error over photons and N, with the adaptive N's results above the fixed ones where there are any (SVG)."""
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.colors import LogNorm
from matplotlib.ticker import NullFormatter

from report.record_plots import STYLE, nice_log_ticks, svg
from report.records import RecordsError

QUANTITIES = (("error", "sqrt(relmse)"), ("rmse", "rmse / mean"))
ADAPTIVE = "adaptive"


def why_none(cells):
    """Why there is no map of these cells, or ""."""
    counts = {cell.nearest for cell in cells if not cell.adaptive and cell.nearest}
    photons = {cell.photons for cell in cells}
    few = [f"{len(values)} {name}" for name, values in (("N", counts), ("numbers of photons", photons)) if len(values) < 2]
    return f"a map wants two of each: {', '.join(few)}" if few else ""


def draw(title, cells):
    """The SVG's text for cells of one estimator on a scene as it was set."""
    table = {}
    for cell in cells:
        place = (cell.photons, ADAPTIVE if cell.adaptive else cell.nearest)
        if place in table:
            raise RecordsError(f"{title}: two cells with {place[0]} photons and N {place[1]}: {table[place].parameters} and "
                               f"{cell.parameters}")
        table[place] = cell
    rows = sorted({row for _, row in table if row != ADAPTIVE}) + [ADAPTIVE] * any(row == ADAPTIVE for _, row in table)
    photons = sorted({count for count, _ in table})
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, panels = plt.subplots(1, len(QUANTITIES), figsize=(7.1, 1.15 + 0.26 * len(rows)), layout="constrained")
        figure.suptitle(title, x=0.01, ha="left", weight="bold", fontsize=8)
        for axes, (quantity, label) in zip(panels, QUANTITIES):
            values = {place: getattr(cell, quantity) for place, cell in table.items()}
            image = draw_panel(axes, values, photons, rows)
            bar = figure.colorbar(image, ax=axes, pad=0.02, fraction=0.06)
            bar.set_label(f"{label} [1], darker is worse")
            bar.ax.minorticks_off()
            bar.ax.yaxis.set_minor_formatter(NullFormatter())
            bar.set_ticks(nice_log_ticks(*image.get_clim()))
            bar.ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        return svg(figure)


def draw_panel(axes, values, photons, rows):
    grid = [[values.get((count, row), float("nan")) for count in photons] for row in rows]
    image = axes.imshow(grid, origin="lower", aspect="auto", cmap="viridis_r",
                        norm=LogNorm(min(values.values()), max(values.values())))
    for x, count in enumerate(photons):
        fixed = [values[count, row] for row in rows if row != ADAPTIVE and (count, row) in values]
        for y, row in enumerate(rows):
            value = values.get((count, row))
            if value is None:
                continue
            red, green, blue, _ = image.cmap(float(image.norm(value)))
            dark = 0.2126 * red + 0.7152 * green + 0.0722 * blue < 0.45
            best = row != ADAPTIVE and value == min(fixed)
            axes.text(x, y, f"{value:.3f}", ha="center", va="center", fontsize=6.5, color="white" if dark else "black",
                      weight="bold" if best or row == ADAPTIVE else "normal")
    if ADAPTIVE in rows:
        axes.axhline(len(rows) - 1.5, color="white", linewidth=2)
    axes.set_xticks(range(len(photons)), [f"{count:,}" for count in photons])
    axes.set_yticks(range(len(rows)), [str(row) for row in rows])
    axes.set_xlabel("photons")
    axes.set_ylabel("N (bold: the best of a column)")
    return image
