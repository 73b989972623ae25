"""Draws the plots of records.csv (SVG).

In every plot a point is the median over the seeds of one cell and the band or bar its range; or, where that is asked for,
the mean and its 95 % interval.
"""
import dataclasses
import io
import math
import urllib.parse

import matplotlib
import matplotlib.text

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, LogFormatterSciNotation, MaxNLocator, NullFormatter, NullLocator

from report.plot_panels import KINDS, MARKERS, QUANTITIES, Series, arrange, counted, note, set_times, without_photons
from report.records import FORMULAS, UNITS, natural

COLUMN = 3.5  # inches: one column of a two-column page
PAGE = 7.1
PANELS_PER_PAGE = 20
LEFT, RIGHT, TOP, BOTTOM = 0.66, 0.10, 0.52, 0.42  # inches round the axes, the legend apart
LEGEND_ROW = 0.14
GREY = "0.4"
STYLE = {"font.family": "DejaVu Sans", "font.size": 8, "axes.labelsize": 8, "axes.titlesize": 8,
         "xtick.labelsize": 7.5, "ytick.labelsize": 7.5, "legend.fontsize": 7.5, "legend.frameon": False,
         "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.7,
         "xtick.minor.pad": 5, "ytick.minor.pad": 5, "lines.linewidth": 1.2, "lines.markersize": 3.5,
         "axes.titley": 1.0, "svg.fonttype": "path", "svg.hashsalt": "causticbench"}
X_LABELS = {"photons": "stored photons [1]", "alpha": "alpha [1]", "mesh_resolution": "polygons along a side of the mesh [1]"}
FORMATS = ("svg", "pdf", "png")


@dataclasses.dataclass(frozen=True)
class Look:
    """How figures are drawn: the file's format, the width of one panel alone [inch], the exponent of a guide (or None),
    whether the words above the axes are left to the paper's caption, and whether points are means with their intervals."""
    format: str = "svg"
    width: float = COLUMN
    slope: float | None = None
    bare: bool = False
    interval: bool = False
    time: str = ""

    def spread(self, cell, column):
        return cell.mean(column) if self.interval else cell.spread(column)


def make(records, kinds=KINDS, look=Look()):
    """All plots the records carry: [(file name, caption, content)], and [(plot, reason)] for those left out. Of other kinds than
    the usual ones they are all there is."""
    matplotlib.rcdefaults()
    plots, left_out = [], []
    look = dataclasses.replace(look, time=set_times(records.cells))
    with matplotlib.rc_context(STYLE):
        series = Series(records.cells)
        for kind in kinds:
            for scene in records.scenes():
                cells = [cell for cell in records.cells if cell.scene == scene]
                panels, reason = arrange(kind, cells, series)
                if reason:
                    left_out.append((kind.name(), scene, reason))
                for first in range(0, len(panels), PANELS_PER_PAGE):
                    number = f"-{first // PANELS_PER_PAGE + 1}" if len(panels) > PANELS_PER_PAGE else ""
                    figure = draw(kind, scene, panels[first:first + PANELS_PER_PAGE], series, look, cells)
                    name = f"{kind.name()}-{urllib.parse.quote(scene, safe='')}{number}.{look.format}"
                    plots.append((name, f"{scene}: {kind.y} against {QUANTITIES.get(kind.x, kind.x)}; {note(cells, look.interval)}", saved(figure, look.format)))
        if kinds is KINDS:
            cells = [cell for cell in records.cells if cell.spread("mean_ratio")]
            if cells:
                plots.append((f"mean_ratio.{look.format}", "mean_ratio per scene: bars the range over all trials, large marks "
                              "their median, small marks the medians of the cells", saved(draw_energy(cells, series), look.format)))
            else:
                left_out.append(("mean_ratio", None, "no row has a mean_ratio"))
    return plots, left_out


def draw(kind, scene, panels, series, look, others=()):
    columns = 1 if len(panels) == 1 else min(len(panels), columns_for(panels))
    rows = math.ceil(len(panels) / columns)
    cells = [cell for _, members in panels for cell in members]
    levels = [without_photons(kind, members, others, series) if kind.x == "photons" else [] for _, members in panels]
    groups = legend_groups(kind, cells, dict(level for each in levels for level in each), series)
    figure, grid, foot = canvas(rows, columns, groups, look.width if columns == 1 else look.width / COLUMN * PAGE, look.bare)
    axes = [ax for line in grid for ax in line]
    for ax, (title, members), level in zip(axes, panels, levels):
        draw_levels(kind, ax, level, series, look)
        draw_panel(kind, ax, members, series, look)
        ax.set_title(title, loc="left", fontsize=7.5, pad=3)
    set_scales(kind, axes[0], [*cells, *(cell for each in levels for _, cell in each)])
    if look.slope is not None:
        for ax in axes[:len(panels)]:
            draw_slope(ax, look.slope)
    for i, ax in enumerate(axes):
        if i >= len(panels):
            ax.remove()
            continue
        below = i + columns < len(panels)
        ax.tick_params(labelbottom=not below, labelleft=i % columns == 0, which="both")
        if i % columns == 0:
            ax.set_ylabel(f"{kind.y} [{unit(kind.y)}]")
    formula = FORMULAS.get(kind.y, "") + (trust(cells) if kind.y == "rmse" else "")
    words = ("", "") if look.bare else (f"{scene}: {note(cells, look.interval)}", formula)
    label_figure(figure, *words, look.time if kind.x == "time" else X_LABELS.get(kind.x, kind.x), foot, LEFT)
    legends(figure, groups)
    return figure


def unit(column):
    return UNITS.get(column, "W m⁻² sr⁻¹" if column.endswith("rmse") else "1")


def columns_for(panels):
    """As many columns as the last varying parameter has values, if the page holds them, so that rows are comparable."""
    heads = [title.rpartition(", ")[0] for title, _ in panels]
    run = heads.count(heads[0])
    return run if 1 < run <= 5 and heads[0] else 4 if len(panels) > 3 else len(panels)


def canvas(rows, columns, groups, width, bare=False):
    """A figure laid out in inches, and its axes; `foot` is the height kept for the legend."""
    foot = legend_height(groups, width)
    top = 0.1 if bare else TOP
    title = 0.14 if rows * columns > 1 else 0.0
    gap_x, gap_y = 0.12, 0.30
    across = (width - LEFT - RIGHT - gap_x * (columns - 1)) / columns
    up = 1.9 if columns == 1 and rows == 1 else max(1.15, min(1.6, 0.85 * across))
    height = top + title + BOTTOM + foot + rows * up + (rows - 1) * gap_y
    figure = plt.figure(figsize=(width, height))
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True, gridspec_kw={
        "left": LEFT / width, "right": 1 - RIGHT / width, "bottom": (BOTTOM + foot) / height,
        "top": 1 - (top + title - 0.14 * (not bare)) / height,
        "wspace": gap_x / across, "hspace": gap_y / up})
    return figure, grid, foot


def legend_columns(handles, width):
    longest = max(len(handle.get_label()) for handle in handles)
    return max(1, min(len(handles), int((width - 0.1) / (0.5 + 0.062 * longest))))


def legend_rows(handles, width):
    return math.ceil(len(handles) / legend_columns(handles, width))


def legend_height(groups, width):
    return sum(LEGEND_ROW * legend_rows(handles, width) for handles in groups) + 0.08


def legends(figure, groups):
    """One legend per group of handles, stacked under the axes."""
    width, height = figure.get_size_inches()
    y = legend_height(groups, width) - 0.04
    for handles in groups:
        figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, y / height), borderpad=0,
                      borderaxespad=0, ncol=legend_columns(handles, width), handlelength=2.2, columnspacing=1.2,
                      labelspacing=0.25)
        y -= LEGEND_ROW * legend_rows(handles, width)


def label_figure(figure, title, below_title, x, foot, left):
    width, height = figure.get_size_inches()
    figure.text(0.06 / width, 1 - 0.05 / height, title, va="top", weight="bold")
    figure.text(0.06 / width, 1 - 0.20 / height, below_title, va="top", fontsize=7)
    figure.text((left + width - RIGHT) / 2 / width, (foot + 0.04) / height, x, va="bottom", ha="center")


def draw_levels(kind, ax, levels, series, look):
    """Methods without photons: what their best setting reaches, and its range."""
    for key, cell in levels:
        colour, _, line = series.styles[key]
        spread = look.spread(cell, kind.y)
        ax.axhspan(spread.low, spread.high, color=colour, alpha=0.12, linewidth=0)
        ax.axhline(spread.median, color=colour, linestyle=line, linewidth=0.9)


def draw_slope(ax, slope):
    """A guide of that exponent, in the upper right of the axes."""
    if ax.get_xscale() != "log" or ax.get_yscale() != "log":
        return
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    from_x, to_x, top = x0 * (x1 / x0) ** 0.62, x0 * (x1 / x0) ** 0.92, y0 * (y1 / y0) ** 0.95
    fall = (to_x / from_x) ** slope
    start = top if slope < 0 else top / fall
    ax.plot([from_x, to_x], [start, start * fall], color=GREY, linewidth=0.8, zorder=0)
    ax.text(math.sqrt(from_x * to_x), start * math.sqrt(fall), f" slope {slope:g}".replace("-", "−"), color=GREY, fontsize=7,
            va="bottom", ha="left")
    ax.set_xlim(x0, x1)
    ax.set_ylim(y0, y1)


def draw_panel(kind, ax, cells, series, look):
    for key, group in series.split(cells).items():
        colour, marker, line = series.styles[key]
        group = sorted(group, key=kind.x_of)
        x = [kind.x_of(cell) for cell in group]
        spreads = [look.spread(cell, kind.y) for cell in group]
        y = [spread.median for spread in spreads]
        if kind.x == "time":
            ax.plot(x, y, linestyle=line, color=colour, linewidth=0.7)
            for cell, spread in zip(group, spreads):
                bars(ax, look.spread(cell, "time_s"), spread, colour, *(photon_mark(cell) or (marker, 4.5)))
        else:
            ax.plot(x, y, linestyle=line, marker=marker, color=colour)
            low, high = [spread.low for spread in spreads], [spread.high for spread in spreads]
            if len(x) > 1:
                ax.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0)
            else:
                ax.vlines(x, low, high, color=colour, linewidth=0.8)
    if kind.y == "rmse":
        draw_reference_error(kind, ax, cells)
    elif kind.y == "mean_ratio":
        ax.axhline(1, color=GREY, linewidth=0.7, zorder=0)


def trust(cells):
    """How well the reference is known, as words for the line under the title."""
    shares = [spread.median for spread in (cell.spread("reference_stderr") for cell in cells) if spread]
    if not shares:
        return ""
    ends = dict.fromkeys(f"{100 * share:.2g}" for share in (min(shares), max(shares)))
    return f";  stderr(r) = {'–'.join(ends)} % of mean(r)"


def draw_reference_error(kind, ax, cells):
    """The reference's own standard error: below it differences mean nothing."""
    at = {}
    for cell in cells:
        if cell.reference_error():
            at.setdefault(kind.x_of(cell), []).append(cell.reference_error())
    levels = {level for several in at.values() for level in several}
    if len(levels) == 1 or kind.x in ("photons", "time"):
        for level in sorted(levels):
            ax.axhline(level, color=GREY, linestyle=":", linewidth=1)
    elif levels:
        ax.plot(sorted(at), [max(at[x]) for x in sorted(at)], color=GREY, linestyle=":", linewidth=1)


def photon_mark(cell):
    """Marker and size that stand for a number of photons, the same in every panel and plot; None without photons."""
    spread = cell.spread("photons_stored")
    if not spread or spread.median <= 0:
        return None
    step = round(2 * math.log10(spread.median))
    return MARKERS[step % (len(MARKERS) - 1)], 2.5 + 0.35 * max(0, step - 6)


def bars(ax, x, y, colour, marker, size):
    ax.errorbar([x.median], [y.median], xerr=[[x.median - x.low], [x.high - x.median]],
                yerr=[[y.median - y.low], [y.high - y.median]], color=colour, marker=marker, markersize=size,
                elinewidth=0.7, linestyle="none")


def legend_groups(kind, cells, levels, series):
    handles, marked, dotted = [], [], []
    for key, group in series.split(cells).items():
        colour, marker, line = series.styles[key]
        by_photons = kind.x == "time" and any(photon_mark(cell) for cell in group)
        handles.append(Line2D([], [], color=colour, marker=None if by_photons else marker, linestyle=line,
                              label=series.label(key)))
    for key, cell in levels.items():
        colour, _, line = series.styles[key]
        best = [f"{name} {cell.parameters[name]}" for name in series.work if name in cell.parameters]
        handles.append(Line2D([], [], color=colour, linestyle=line, linewidth=0.9, label=f"{series.label(key)} ({', '.join([*best, 'no photons'])})"))
    if kind.x == "time":
        marks = {}
        for cell in cells:
            if photon_mark(cell):
                marks.setdefault(photon_mark(cell), []).append(cell.spread("photons_stored").median)
        for (marker, size), counts in sorted(marks.items(), key=lambda item: item[1]):
            ends = dict.fromkeys((counted(min(counts)), counted(max(counts))))
            marked.append(Line2D([], [], color=GREY, marker=marker, markersize=size, linestyle="none",
                                 label=f"{'–'.join(ends)} photons"))
    if kind.y == "rmse" and any(cell.reference_error() for cell in cells):
        dotted.append(Line2D([], [], color=GREY, linestyle=":", linewidth=1, label="standard error of the reference"))
    return [group for group in (handles, marked, dotted) if group]


def set_scales(kind, ax, cells):
    """Scales and ticks of all panels, which share the axes of the first."""
    x = sorted({kind.x_of(cell) for cell in cells} - {None})
    if x[0] > 0:
        ax.set_xscale("log")
    if kind.y != "mean_ratio" and min(cell.spread(kind.y).low for cell in cells) > 0:
        ax.set_yscale("log")
        few_ticks(ax.yaxis)
    if kind.x == "photons":
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: counted(value)))
        ax.xaxis.set_minor_locator(NullLocator())
    elif kind.x == "time" and x[0] > 0:
        few_ticks(ax.xaxis)
    elif len(x) <= 6:
        ax.xaxis.set_major_locator(FixedLocator(x))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_locator(NullLocator())


def nice_log_ticks(low, high):
    """1, 2 and 5 of each decade below two decades, all whole digits where those are too few; else powers of ten."""
    for digits in ((1,), (1, 2, 5), range(1, 10)):
        ticks = [digit * 10.0 ** power for power in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
                 for digit in digits]
        ticks = [tick for tick in ticks if low <= tick * (1 + 1e-9) and tick <= high * (1 + 1e-9)]
        if len(ticks) >= 3:
            return ticks
    return ticks if len(ticks) > 1 else [tick for tick in MaxNLocator(4).tick_values(low, high) if low <= tick <= high]


def few_ticks(axis):
    """Labels that a short range has several of and a long one not too many."""
    ticks = nice_log_ticks(*axis.get_view_interval())
    powers = all(math.log10(tick) == round(math.log10(tick)) for tick in ticks)
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(LogFormatterSciNotation() if powers else FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def draw_energy(cells, series):
    """mean_ratio of each scene and line: a wrong factor (π, 2, a lost layer) stands far from 1."""
    scenes = sorted({cell.scene for cell in cells}, key=natural)
    keys = list(series.split(cells))
    handles = [Line2D([], [], color=series.styles[key][0], marker=series.styles[key][1], linestyle="-",
                      label=series.label(key)) for key in keys]
    foot = legend_height([handles], COLUMN)
    rows = [(scene, key) for scene in scenes for key in keys]
    left, pitch = 0.25 + 0.06 * max(len(scene) for scene in scenes), 0.13
    tall = pitch * (len(rows) + len(scenes) + 1)
    height = tall + TOP + BOTTOM + foot
    figure = plt.figure(figsize=(COLUMN, height))
    ax = figure.add_axes([left / COLUMN, (BOTTOM + foot) / height, 1 - (left + RIGHT) / COLUMN, tall / height])
    ticks = []
    y = 0.0
    for scene in scenes:
        y += 1
        ticks.append(y + (len(keys) - 1) / 2)
        for key in keys:
            draw_energy_row(ax, y, [c for c in cells if c.scene == scene and series.key(c) == key], series.styles[key])
            y += 1
    ax.axvline(1, color=GREY, linewidth=0.7, zorder=0)
    low, high = ax.get_xlim()
    for value, name in ((math.pi, "π"), (1 / math.pi, "1/π")):
        if low < value < high:
            ax.axvline(value, color=GREY, linewidth=0.7, linestyle=":", zorder=0)
            ax.text(value, 0.1, name, ha="center", va="bottom", color=GREY, fontsize=7)
    ax.set_ylim(y, 0)
    ax.set_yticks(ticks, [scene.replace("$", r"\$") for scene in scenes])
    ax.tick_params(axis="y", length=0)
    ax.ticklabel_format(axis="x", useOffset=False)
    label_figure(figure, "energy: range and median over all trials", FORMULAS["mean_ratio"], "mean_ratio [1]", foot,
                 left)
    legends(figure, [handles])
    return figure


def draw_energy_row(ax, y, cells, style):
    if not cells:
        return
    colour, marker, _ = style
    values = sorted(float(record["mean_ratio"]) for cell in cells for record in cell.records if record["mean_ratio"])
    middle = (values[(len(values) - 1) // 2] + values[len(values) // 2]) / 2
    ax.plot([values[0], values[-1]], [y, y], color=colour, linewidth=2.5, alpha=0.3, solid_capstyle="butt")
    ax.plot([cell.spread("mean_ratio").median for cell in cells], [y] * len(cells), "o", color=colour, markersize=2,
            markeredgewidth=0)
    ax.plot([middle], [y], marker, color=colour, markersize=4.5)


def saved(figure, form):
    """The figure as SVG text, or as the bytes of a PDF or a PNG (of 300 pixels an inch)."""
    file = io.StringIO() if form == "svg" else io.BytesIO()
    for label in figure.findobj(matplotlib.text.Text):
        if "$" in label.get_text():  # of a name; those of ticks come later, by drawing
            label.set_parse_math(False)
    about = {"svg": {"Date": None, "Creator": "causticbench"}, "pdf": {"CreationDate": None, "Creator": "causticbench", "Producer": None},
             "png": {"Software": "causticbench"}}[form]
    figure.savefig(file, format=form, dpi=300, metadata=about)
    plt.close(figure)
    return file.getvalue()


def svg(figure):
    return saved(figure, "svg")
