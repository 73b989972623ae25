"""The caustic of experiments/scenes/pool_overhead.json by a quadrature of its own: no code of the program is in it.

Light from the point lamp is bent at the corners of n x n cells of the smooth water (Snell's law and Fresnel's for
unpolarised light) and meets the floor, which the camera looks straight down on, so that pixels are squares of it. Each half
cell's flux (intensity x solid angle x mean transmittance) is spread evenly over its image, a triangle, and what of
the triangle lies in each pixel is found exactly, by adding up its edges. Of second order in 1/n.
"""
import json
import math
import struct

import numpy as np

MARGIN = 8  # pixels round the film; edges are shorter
SMALLEST = 1e-9  # pixels²: what is smaller lies in one pixel


class Pool:
    """The scene as in the file, its waves `scale` times as high."""

    def __init__(self, path, scale):
        scene = json.loads(path.read_text(encoding="utf-8"))
        water, eye = scene["water"], scene["sensor"]["to_world"][0]["look_at"]["origin"]
        self.waves = [(scale * wave["amplitude"], wave["wave_vector"], wave["phase"]) for wave in water["waves"]]
        self.half_size = water["half_size"]
        self.ior = water["bsdf"]["int_ior"] / water["bsdf"]["ext_ior"]
        self.lamp, self.intensity = scene["light"]["position"], scene["light"]["intensity"]
        self.floor = scene["floor"]["to_world"][1]["translate"][2]
        self.reflectance = scene["floor"]["bsdf"]["reflectance"]
        self.pixels = scene["sensor"]["film"]["width"]
        half = (eye[2] - self.floor) * math.tan(math.radians(scene["sensor"]["fov"]) / 2)
        self.corner, self.pixel = (eye[0] - half, eye[1] + half), 2 * half / self.pixels

    def surface(self, x, y):
        """Height, and the slopes along x and y."""
        sums = [np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)]
        for amplitude, (kx, ky), phase in self.waves:
            angle = kx * x + ky * y + phase
            slope = amplitude * np.cos(angle)
            for total, term in zip(sums, (amplitude * np.sin(angle), kx * slope, ky * slope)):
                total += term
        return sums

    def rays(self, x, y):
        """Vectors from the lamp to points of the water, the places of the film [pixels] they light, and what is let through."""
        height, slope_x, slope_y = self.surface(x, y)
        away = np.stack([x - self.lamp[0], y - self.lamp[1], height - self.lamp[2]])
        into = away / np.linalg.norm(away, axis=0)
        normal = np.stack([-slope_x, -slope_y, np.ones_like(x)])
        normal /= np.linalg.norm(normal, axis=0)
        outer = -(into * normal).sum(axis=0)
        inner = np.sqrt(1 - (1 - outer**2) / self.ior**2)
        across = (outer - self.ior * inner) / (outer + self.ior * inner)
        along = (inner - self.ior * outer) / (inner + self.ior * outer)
        down = into / self.ior + (outer / self.ior - inner) * normal
        way = (self.floor - height) / down[2]
        place = ((x + way * down[0] - self.corner[0]) / self.pixel, (self.corner[1] - y - way * down[1]) / self.pixel)
        return away, place, 1 - (across**2 + along**2) / 2

    def irradiance(self, cells):
        """Mean irradiance of each pixel [W/m²], rows from the top, from cells x cells cells."""
        side = self.pixels + 2 * MARGIN
        edges, points = np.zeros(side * (side + 2)), np.zeros(side * side)
        rows = max(1, 2**18 // cells)
        xs = np.linspace(-self.half_size[0], self.half_size[0], cells + 1)
        ys = np.linspace(-self.half_size[1], self.half_size[1], cells + 1)
        for first in range(0, cells, rows):
            away, place, share = self.rays(*np.meshgrid(xs, ys[first:first + rows + 1]))
            place = [at + MARGIN for at in place]
            of = lambda values, i, j: values[..., j:values.shape[-2] - 1 + j, i:values.shape[-1] - 1 + i]
            for corners in (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))):
                flux = self.intensity * solid_angle(*(of(away, *c) for c in corners)) * sum(of(share, *c) for c in corners) / 3
                add_triangles(edges, points, side, [[of(at, *c).ravel() for c in corners] for at in place], flux.ravel())
        flux = edges.reshape(side, side + 2).cumsum(axis=1)[:, :side] + points.reshape(side, side)
        return flux[MARGIN:-MARGIN, MARGIN:-MARGIN] / self.pixel**2

    def radiance(self, irradiance):
        return irradiance * self.reflectance / math.pi

    def radiance_with_error(self, cells):
        """From cells x cells cells, and about its error in each pixel: of second order, a third of what half as many change."""
        coarse, fine = (self.radiance(self.irradiance(n)) for n in (cells // 2, cells))
        return fine, np.abs(fine - coarse) / 3


def solid_angle(a, b, c):
    """Of triangles with corners at a, b, c from the origin [Van Oosterom and Strackee 1983]."""
    dot = lambda u, v: (u * v).sum(axis=0)
    p, q, r = (np.sqrt(dot(u, u)) for u in (a, b, c))
    volume = dot(a, np.cross(b, c, axis=0))
    return 2 * np.abs(np.arctan2(volume, p * q * r + dot(a, b) * r + dot(b, c) * p + dot(c, a) * q))


def add_triangles(edges, points, side, place, flux):
    """Spreads each triangle's flux: as edges whose sums along rows are pixels, or as a point where it is too small."""
    (x0, x1, x2), (y0, y1, y2) = place
    area = ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)) / 2
    small = np.abs(area) < SMALLEST
    if small.any():
        column, row = (np.clip(at[0][small].astype(int), 0, side - 1) for at in place)
        points += np.bincount(row * side + column, flux[small], side * side)
    density = np.where(small, 0, flux / np.where(small, 1, area))
    corners = [np.clip(np.stack(at), 0, side - 1e-6) for at in place]
    for i, j in ((0, 1), (1, 2), (2, 0)):
        add_edges(edges, side, *(at[k] for k in (i, j) for at in corners), density)


def add_edges(edges, side, x0, y0, x1, y1, density):
    """What lies to the right of each edge, row by row and pixel by pixel: positive where the edge goes up the rows' numbers
    backwards, so that the edges of a triangle leave what is inside."""
    first, last = np.floor(np.minimum(y0, y1)), np.floor(np.maximum(y0, y1))
    for step in range(int((last - first).max()) + 1):
        in_row = first + step <= last
        row = first[in_row] + step
        at = [values[in_row] for values in (x0, y0, x1, y1)]
        (xa, ya), (xb, yb) = cut(at[1], at[0], at[3], at[2], row), cut(at[3], at[2], at[1], at[0], row)
        add_in_rows(edges, side, row, xa, xb, (ya - yb) * density[in_row])


def cut(y, x, other_y, other_x, row):
    """(x, y) of an edge's end, moved along the edge into the row."""
    inside = np.clip(y, row, row + 1)
    length = other_y - y
    share = np.where(length != 0, (inside - y) / np.where(length != 0, length, 1), 0)
    return x + share * (other_x - x), inside


def add_in_rows(edges, side, row, xa, xb, rise):
    """Edges within one row of pixels each: `rise` is their height times the density."""
    left, right = np.minimum(xa, xb), np.maximum(xa, xb)
    first, last = np.floor(left), np.floor(right)
    width = right - left
    for step in range(int((last - first).max()) + 1):
        in_column = first + step <= last
        column = first[in_column] + step
        low, high = np.maximum(left[in_column], column), np.minimum(right[in_column], column + 1)
        whole = width[in_column]
        part = rise[in_column] * np.where(whole > 0, (high - low) / np.where(whole > 0, whole, 1), 1)
        beyond = part * ((low + high) / 2 - column)
        place = (row[in_column] * (side + 2) + column).astype(int)
        edges += np.bincount(place, part - beyond, edges.size)
        edges += np.bincount(place + 1, beyond, edges.size)


def binned(picture, side):
    """Means over squares, `side` of them along each edge."""
    step = picture.shape[0] // side
    return picture.reshape(side, step, side, step).mean(axis=(1, 3))


def write_exr(path, grey):
    """A picture with equal channels as an uncompressed float32 EXR whose layers are beauty and caustic."""
    height, width = grey.shape
    channels = [prefix + name for prefix in ("", "caustic.") for name in "BGR"]
    def attribute(name, kind, value):
        return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value
    described = b"".join(f"{name}\0".encode() + struct.pack("<iB3xii", 2, 0, 1, 1) for name in channels) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"".join([
        struct.pack("<ii", 20000630, 2), attribute("channels", "chlist", described),
        attribute("compression", "compression", b"\0"), attribute("dataWindow", "box2i", window),
        attribute("displayWindow", "box2i", window), attribute("lineOrder", "lineOrder", b"\0"),
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)), b"\0"])
    line = 4 * width * len(channels)
    start = len(header) + 8 * height
    rows = grey.astype("<f4")
    with open(f"{path}.part", "wb") as file:
        file.write(header + struct.pack(f"<{height}Q", *(start + y * (line + 8) for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<ii", y, line) + rows[y].tobytes() * len(channels))
    path.with_name(f"{path.name}.part").replace(path)
