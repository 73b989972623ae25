"""Draws the heat map of one scene: error over photons and N, with the adaptive N's results beside the fixed ones (SVG)."""
import io

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.colors import LogNorm

from record_plots import STYLE

QUANTITIES = (("error", "sqrt(relmse)"), ("rmse", "rmse / mean"))


def draw(cells):
    """The SVG's text, or "" where the scene has no such trials."""
    own = [cell for cell in cells if cell.method == "photonmap" and not cell.raw and cell.filter == "epanechnikov"]
    counts = sorted({cell.nearest for cell in own if not cell.adaptive})
    photons = sorted({cell.photons for cell in own})
    if len(counts) < 2 or len(photons) < 2:
        return ""
    rows = [*counts, "adaptive"]
    table = {(cell.photons, "adaptive" if cell.adaptive else cell.nearest): cell for cell in own}
    matplotlib.rcdefaults()
    with matplotlib.rc_context(STYLE):
        figure, panels = plt.subplots(1, len(QUANTITIES), figsize=(7.1, 0.8 + 0.28 * len(rows)))
        for axes, (quantity, label) in zip(panels, QUANTITIES):
            draw_panel(axes, table, photons, rows, quantity)
            axes.set_title(f"{cells[0].scene}: {label}")
        figure.tight_layout()
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
        plt.close(figure)
    return text.getvalue()


def draw_panel(axes, table, photons, rows, quantity):
    values = {place: getattr(cell, quantity) for place, cell in table.items()}
    grid = [[values.get((count, row), float("nan")) for count in photons] for row in rows]
    axes.imshow(grid, origin="lower", aspect="auto", cmap="viridis_r",
                norm=LogNorm(min(values.values()), max(values.values())))
    for x, count in enumerate(photons):
        fixed = [values[count, row] for row in rows[:-1] if (count, row) in values]
        for y, row in enumerate(rows):
            value = values.get((count, row))
            if value is None:
                continue
            best = row != "adaptive" and value == min(fixed)
            axes.text(x, y, f"{value:.3f}", ha="center", va="center", fontsize=6.5,
                      color="white", weight="bold" if best or row == "adaptive" else "normal",
                      bbox={"facecolor": "0.2", "edgecolor": "none", "pad": 1, "alpha": 0.45})
    axes.axhline(len(rows) - 1.5, color="white", linewidth=2)
    axes.set_xticks(range(len(photons)), [f"{count:,}" for count in photons])
    axes.set_yticks(range(len(rows)), [str(row) for row in rows])
    axes.set_xlabel("photons")
    axes.set_ylabel("N")
