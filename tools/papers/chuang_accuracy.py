"""Chuang & Cheng 1995: light from the specular point, aliasing of Arvo's map, leaf rays almost parallel, receivers without polygons."""
import functools
import pathlib

import numpy as np

import pool_truth
from papers.chuang_counts import COUNTS
from papers.figures import luminance
from papers.part import Part, Table
from papers.study import ROOT
from papers.verdict import Measured, counted
from papers.words import short, spread
from report.records import natural

OVERHEAD = pathlib.Path("experiments") / "scenes" / "pool_overhead.json"
TRUTH_CELLS = 1024


class Overhead(pool_truth.Pool):
    """pool_overhead.json with other pixels; what is asked of it does not use the program."""

    def __init__(self, waves, pixels):
        super().__init__(ROOT / OVERHEAD, waves)
        self.pixel *= self.pixels / pixels
        self.pixels = pixels


@functools.cache
def truth_of(waves, pixels):
    """Mean radiance of each pixel."""
    pool = Overhead(float(waves), pixels)
    return pool.radiance(pool.irradiance(TRUTH_CELLS))


def errors(trials, truth, **wanted):
    """Mean and median over pixels of the absolute error, over the mean."""
    off = np.abs(luminance(trials.picture(**wanted)["caustic"]) - truth)
    return float(off.mean() / truth.mean()), float(np.median(off) / truth.mean())


def specular_point(study):
    trials = study.sweep("accuracy")
    rows, better, at_points = [], [], []
    for waves in sorted(trials.values("wave_height"), key=float):
        truth = truth_of(waves, int(trials.rows[0]["width"]))
        found = {(bound, intensity): errors(trials, truth, wave_height=waves, bound=bound, intensity=intensity)
                 for bound in ("hybrid", "two_slice") for intensity in ("area", "refined")}
        better.append(found["two_slice", "area"][0] / found["two_slice", "refined"][0])
        at_points.append(found["hybrid", "area"][1] / found["hybrid", "refined"][1])
        rows += [[waves, "4 points a pixel" if bound == "hybrid" else "mean over the pixel", "eq. 11" if intensity == "area" else "specular point",
                  f"{100 * mean:.3g}", f"{100 * median:.3g}"] for (bound, intensity), (mean, median) in found.items()]
    several = lambda values: ", ".join(map(short, values))
    heights = ", ".join(sorted(trials.values("wave_height"), key=float))
    note = (f"means over whole pixels, waves x {heights}: {several(better)}; the median pixel from four points, by the paper's trees: "
            f"{several(at_points)}")
    return Part({"specular_point": Measured(better, unit="times the error, eq. 11 over specular point", counted=True, note=note)}, [Table(
        "accuracy", "Light from the specular point", ["waves", "caustic of", "intensity by", "mean error [%]", "median error [%]"], rows,
        "pool_overhead.json, 75 x 101 quads, 64 × 64 pixels; absolute error over the mean, against a quadrature of the smooth water that shares no "
        f"code with the program (tools/pool_truth.py, {TRUTH_CELLS} x {TRUTH_CELLS} cells). Four points a pixel miss most of the narrow folds, by "
        "either intensity: that is in the mean, and hardly in the median. Means over pixels are of bound two_slice, pixel_footprint.")])


def aliasing(study):
    """Arvo's map against beams: errors of both where the water is calm and rough; of the map's, what more light paths would not take away."""
    maps, beams = study.sweep("texels"), study.sweep("accuracy")
    sides = sorted({int(maps.value(row, "with_resolution")) for row in maps.rows})
    rows, over = [], {}
    for waves in sorted(maps.values("wave_height"), key=float):
        known = truth_of(waves, int(beams.rows[0]["width"]))
        mean = lambda picture: float(np.abs(picture - known).mean() / known.mean())
        of_map = {}
        for side in sides:
            pictures = [luminance(each["caustic"]) for each in maps.pictures(wave_height=waves, with_resolution=side)]
            of_map[side] = [mean(each) for each in pictures]
            rows.append([waves, f"map of {side} × {side} texels", spread([100 * each for each in of_map[side]]),
                         f"{100 * mean(np.mean(pictures, axis=0)):.3g}"])
        own, whole = (errors(beams, known, wave_height=waves, bound=name, intensity="area")[0] for name in ("hybrid", "two_slice"))
        rows += [[waves, "beams, 75 × 101 quads", f"{100 * own:.3g}", ""], [waves, "beams, means over whole pixels", f"{100 * whole:.3g}", ""]]
        over[waves] = Measured([min(seed) / own for seed in zip(*of_map.values())], unit="error of the map's best over the beams'", note=(
            f"waves x {waves}: the map of {best(of_map)} × {best(of_map)} texels{bound(of_map)}, against beams at four points a "
            f"pixel, {100 * own:.2g} %; by means over whole pixels the beams are off by {100 * whole:.2g} %"))
    calm, rough = sorted(over, key=float)
    return Part({"aliasing_rough": over[rough], "aliasing_calm": over[calm]}, [Table(
        "aliasing", "Arvo's map and beams", ["waves", "method", "mean error [%]", "of the mean of three maps [%]"], rows,
        "pool_overhead.json, 64 × 64 pixels of four points, against the quadrature; 1,000,000 light paths a map, three seeds. Where the mean of "
        "three maps is hardly nearer than one, the map's own cells make the error, and not the number of its light paths.")])


def best(of_map):
    return min(of_map, key=lambda side: sum(of_map[side]))


def bound(of_map):
    return " (the finest; finer ones may do better)" if best(of_map) == max(of_map) else ""


def leaf_rays(study):
    """Spread of the rays of each polygon, about the axis of eq. 1, on the smooth waves; no rendering."""
    limit = study.paper.number("spread_threshold")
    cells = next(each for each in study.sweep("accuracy").values("cells"))
    across, along = (int(each) for each in cells.strip("[]").split(","))
    rows, below = [], []
    for waves in sorted(study.sweep("counts").values("wave_height"), key=float):
        spreads = spread_of_cells(Overhead(float(waves), 1), across, along)
        apex = np.hypot(2 / across, 2 / along) / 2 / np.tan(np.radians(spreads))
        below.append(float((spreads < limit).mean()))
        whole = spread_of_cells(Overhead(float(waves), 1), 1, 1).item()
        numbers = (np.median(spreads), spreads.max(), 100 * (spreads < 1).mean(), 100 * below[-1], np.median(apex), whole)
        rows.append([waves, *[f"{value:.3g}" for value in numbers]])
    medians = ", ".join(row[1] for row in rows)
    return Part({"leaf_rays": Measured(below, unit="share of leaves", counted=True, note=(
        f"waves x {', '.join(row[0] for row in rows)}: median spread of a leaf {medians} degrees, apexes at {', '.join(row[5] for row in rows)} m "
        f"(median), where the pool is {-Overhead(1.0, 1).floor:g} m deep"))}, [Table(
        "leaves", "Spread of the leaves' rays", ["waves", "median [degrees]", "largest", "below 1 degree [%]", f"below {limit:g} degrees [%]",
                                                 "distance of the apex, median [m]", "four corners of the pool [degrees]"], rows,
        "Refracted rays at the corners of 75 x 101 quads of the smooth waves, about the axis of eq. 1 and figure 4.")])


def rays_of_cells(pool, across, along):
    """(corners, unit rays, unit axes of eq. 1) of all quads of the water: four a quad, then one."""
    x, y = np.meshgrid(np.linspace(-pool.half_size[0], pool.half_size[0], across + 1), np.linspace(-pool.half_size[1], pool.half_size[1], along + 1))
    _, (column, row), _ = pool.rays(x, y)
    water = np.stack([x, y, pool.surface(x, y)[0]])
    rays = np.stack([pool.corner[0] + column * pool.pixel, pool.corner[1] - row * pool.pixel, np.full_like(x, pool.floor)]) - water
    rays /= np.linalg.norm(rays, axis=0)
    corners = lambda field: np.stack([field[:, j:along + j, i:across + i].reshape(3, -1).T for j in (0, 1) for i in (0, 1)])
    starts, rays = corners(water), corners(rays)
    axes = (rays.min(axis=0) + rays.max(axis=0)) / 2
    return starts, rays, axes / np.linalg.norm(axes, axis=1, keepdims=True)


def spread_of_cells(pool, across, along):
    _, rays, axes = rays_of_cells(pool, across, along)
    return np.degrees(np.arccos(np.clip((rays * axes).sum(axis=2).min(axis=0), -1, 1)))


def receivers(study):
    """A ball as receiver: Watt's polygons on it against the tree, which has none."""
    trials = study.sweep("receivers")
    whole = trials.picture(method="beamtree")["caustic"]
    own = trials.record(trials.where(method="beamtree")[0])["counters"]
    rows = [["tree", "", "", "", f"{own[COUNTS[0]] + own[COUNTS[1]]:,}"]]
    off = {}
    for row in sorted(trials.where(method="causticpolygons"), key=lambda row: natural(row["receiver_resolution"])):
        picture = trials.picture(method="causticpolygons", receiver_resolution=row["receiver_resolution"])["caustic"]
        found, side = trials.record(row)["counters"], int(row["receiver_resolution"])
        difference = np.abs(luminance(picture - whole))
        on_ball = difference > 1e-6 * luminance(whole).max()
        off[side] = float(difference[on_ball].sum() / luminance(whole)[on_ball].sum())
        rows.append(["Watt's", f"{found['receiver_polygons']:,}", f"{int(on_ball.sum()):,}", f"{100 * off[side]:.3g}",
                     f"{found['beam_polygon_tests']:,}"])
    sides = sorted(off)
    usual = 16
    return Part({"receivers": counted(off[usual] / off[sides[-1]], "deviation with 16 cells over that with 32", (
        f"on the pixels that differ, Watt's light is off by {', '.join(f'{100 * off[side]:.2g} %' for side in sides)} with "
        f"{', '.join(map(str, sides))} cells along each side: it comes nearer to the tree's light, which has no polygons there"))}, [Table(
        "receivers", "A ball as receiver", ["method", "polygons of receivers", "pixels that differ from the tree's", "by [%]", "tests"], rows,
        "A ball of 0.3 m in the pool, 100 × 100 pixels, 75 x 101 quads. Watt's method divides the ball and the walls into cells; tests of beam "
        "with polygon, and the tree's tests for the picture.")])


SECTIONS = {"specular-point": specular_point, "aliasing": aliasing, "leaf-rays": leaf_rays, "receivers": receivers}
