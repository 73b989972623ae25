"""Tables (Markdown) and plots (SVG) of results/beamtree, from what beam_trials reads."""
import dataclasses
import statistics
from report.beam_trials import exponent, microseconds, select
from report.paper import Paper

COUNTS = ("cone_point_tests", "beam_point_tests", "beam_point_hits")
CHUANG = Paper("chuang1995")
PAPER = tuple(CHUANG.number(name) for name in COUNTS)
COUNT_HEADING = ["cone-point tests", "beam-point tests", "successes"]
POINT_HEADING = ["cone-point tests a point", "beam-point tests a point", "successes a point"]
BOUNDS = ("single", "double", "sphere_swept", "two_slice")
GROWING = ("hybrid", "sphere_swept", "two_slice")  # with the mesh


def table(heading, rows):
    line = lambda fields: "| " + " | ".join(fields) + " |"
    return "\n".join([line(heading), "|" + "---|" * len(heading)] + [line(row) for row in rows])


def short(value):
    return f"{value:,}" if isinstance(value, int) else f"{value:.3g}"


def ratios(cell):
    return [cell.counters[name] / paper for name, paper in zip(COUNTS, PAPER)]


def is_near_the_paper(cell):
    """Each of the three counts within a factor of two."""
    return all(0.5 <= ratio <= 2 for ratio in ratios(cell))


def counts(cells):
    """The paper's three counts against those of every bound, merging, wave height and kind of polygon."""
    rows = [[f"**{CHUANG.number('polygons'):,} (paper)**", "", "hybrid", "cones"] + [f"**{count:,}**" for count in PAPER]]
    kinds = ("triangles", "quads")
    order = lambda cell: (kinds.index(cell.value("polygons")), int(cell.value("resolution")), cell.value("bound") != "hybrid",
                          cell.value("bound"), cell.value("merging") != "rays", float(cell.value("wave_height")))
    for cell in sorted(cells, key=order):
        mark = "**" if is_near_the_paper(cell) else ""
        merging = cell.value("merging") if cell.value("bound") != "sphere_swept" else ""
        rows.append([f"{cell.counters['polygons']:,} {cell.value('polygons')}", cell.value("wave_height"),
                     cell.value("bound"), merging]
                    + [f"{cell.counters[name]:,} ({mark}{ratio:.2f}{mark})" for name, ratio in zip(COUNTS, ratios(cell))])
    return table(["polygons", "waves", "bound", "merging"] + COUNT_HEADING, rows)


def point_costs(cell, eye_pass):
    return [short(cell.per_point(name)) for name in COUNTS] + [
        f"{microseconds(cell, eye_pass):.2f}", f"{1e3 * cell.build():.0f}", f"{cell.bytes / 1e6:.2f}"]


COST_HEADING = POINT_HEADING + ["µs a point", "build [ms]", "MB"]


def bounds(cells):
    """One scene's bounds, and `hybrid` over its threshold."""
    eye_pass = select(cells, method="none")[0]
    rows = [[bound, ""] + point_costs(select(cells, bound=bound)[0], eye_pass) for bound in BOUNDS]
    for cell in thresholds(cells):
        rows.append(["hybrid", f"{cell.value('spread_threshold')}°"] + point_costs(cell, eye_pass))
    return table(["bound", "threshold"] + COST_HEADING, rows)


def thresholds(cells):
    return sorted(select(cells, bound="hybrid"), key=lambda cell: float(cell.value("spread_threshold")))


def heights(cells):
    """Cost a point over the tree's height, and the exponents of its growth."""
    rows, fits = [], []
    for bound in GROWING:
        group = by_resolution(select(cells, bound=bound))
        for cell in group:
            eye_pass = select(cells, method="none", resolution=cell.value("resolution"))[0]
            rows.append([bound, f"{cell.counters['polygons']:,}", str(cell.counters["height"])]
                        + point_costs(cell, eye_pass))
        fits.append(height_fits(bound, cells, resolved(group)))
    return (table(["bound", "polygons", "height"] + COST_HEADING, rows) + "\n\n"
            + table(["bound", "cone-point tests a point", "~ height^p", "~ polygons^p", "µs a point ~ polygons^p"], fits))


def by_resolution(cells):
    return sorted(cells, key=lambda cell: int(cell.value("resolution")))


def resolved(cells):
    """Meshes of which no polygon is quartered: coarser ones send as many beams, from trees as high."""
    return [cell for cell in cells if int(cell.value("resolution")) >= 32]


def per_level(cells, tests):
    """Tests that one more level costs, and the level at which that line starts."""
    step, start = statistics.linear_regression([cell.counters["height"] for cell in cells], tests)
    return f"{step:.1f} (height - {-start / step:.1f})"


def height_fits(bound, cells, group):
    tests = [cell.per_point("cone_point_tests") for cell in group]
    times = [microseconds(cell, select(cells, method="none", resolution=cell.value("resolution"))[0])
             for cell in group]
    polygons = [cell.counters["polygons"] for cell in group]
    return [bound, per_level(group, tests), f"{exponent([cell.counters['height'] for cell in group], tests):.2f}",
            f"{exponent(polygons, tests):.2f}", f"{exponent(polygons, times):.2f}"]


@dataclasses.dataclass(frozen=True)
class WattAxis:
    """One of the three numbers that Watt's cost is the product of."""
    symbol: str
    words: str
    parameter: str

    def of(self, cell):
        if self.symbol == "n_s":
            return cell.counters["beams"]  # polygons are quartered where they are too coarse
        return cell.counters["receiver_polygons"] if self.symbol == "n_d" else int(cell.value(self.parameter))


AXES = (WattAxis("n_s", "specular polygons, by their beams", "resolution"), WattAxis("n_d", "diffuse polygons", "receiver_resolution"),
        WattAxis("n_l", "light samples", "light_samples"))


def sweep_time(cell):
    """CPU time of what grows: Watt's sweep of beams through polygons, or the tree over the beams."""
    phase = "precompute/polygons" if cell.method == "causticpolygons" else "precompute/tree"
    return cell.cpu[phase].median


def watt(groups):
    """`groups`: the cells of the sweeps over n_s, n_d and n_l."""
    rows, fits = [], []
    for axis, cells in zip(AXES, groups):
        for method in ("causticpolygons", "beamtree"):
            group = sorted(select(cells, method=method), key=lambda cell: int(cell.value(axis.parameter)))
            if not group:
                continue
            rows += [watt_row(axis, cell) for cell in group]
            fits.append(watt_fit(axis, method, group))
    return (table(["method", "n_s", "n_d", "n_l", "beams", "tests of beam with polygon", "caustic polygons",
                   "sweep or tree [ms]", "tests a point", "render [ms]"], rows) + "\n\n"
            + table(["method", "over", "tests while building ~ n^p", "time of building ~ n^p", "tests a point ~ n^p"], fits))


def tests_a_point(cell):
    return sum(cell.counters.get(name, 0) for name in COUNTS[:2]) / cell.counters["camera_rays"]


def watt_row(axis, cell):
    counter = lambda name: f"{cell.counters[name]:,}" if name in cell.counters else ""
    return [cell.method, counter("polygons"), counter("receiver_polygons"), cell.value("light_samples"), counter("beams"),
            counter("beam_polygon_tests"), counter("caustic_polygons"), f"{1e3 * sweep_time(cell):.1f}",
            short(tests_a_point(cell)), f"{1e3 * cell.cpu['render'].median:.0f}"]


def watt_fit(axis, method, group):
    n = [axis.of(cell) for cell in group]
    power = lambda values: f"{exponent(n, values):.2f}"
    counted = method == "causticpolygons"
    return [method, f"{axis.symbol} ({axis.words})",
            power([cell.counters["beam_polygon_tests"] for cell in group]) if counted else "",
            power([sweep_time(cell) for cell in group]), power([tests_a_point(cell) for cell in group])]
