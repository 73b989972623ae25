#!/usr/bin/env python3
"""The light below sunlit water, as an exact height field and as smooth meshes of it, beside a quadrature.

Usage: smooth_water.py PROGRAM [POINTS]     a file `causticbench`, and how many points (default 1000000)

The sun stands straight above one wave (3 cm high, wave vector (-6, 15) rad/m, n = 1.33), whose mean level is 0.8 m above a floor
of 2 x 2 m. The mean irradiance of the floor is the light of all places of the water whose refracted rays come to the floor: a
sum over 6000 x 6000 of them, which asks for no roots. `probe` by `beamtree` answers at jittered points. Prints a Markdown table.
Needs numpy.
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy

HEIGHT, LEVEL, HALF_WATER, HALF_FLOOR, INDEX = 0.03, 0.8, 2.0, 1.0, 1.33
WAVE = numpy.array([-6.0, 15.0])
CELLS = (32, 64, 128, 256)
PLACES = 6000


def surface(x, y):
    """Heights and unit normals."""
    phase = WAVE[0] * x + WAVE[1] * y
    slope = HEIGHT * numpy.cos(phase)
    normal = numpy.stack([-slope * WAVE[0], -slope * WAVE[1], numpy.ones_like(slope)], axis=-1)
    return LEVEL + HEIGHT * numpy.sin(phase), normal / numpy.linalg.norm(normal, axis=-1, keepdims=True)


def transmittance(cos_in, cos_out):
    """The share of unpolarised light that goes into the water."""
    across = (cos_in - INDEX * cos_out) / (cos_in + INDEX * cos_out)
    along = (INDEX * cos_in - cos_out) / (INDEX * cos_in + cos_out)
    return 1 - (across**2 + along**2) / 2


def mean_of_floor():
    """The floor's mean irradiance, by rays of equal power from all of the water."""
    edges = (numpy.arange(PLACES) + 0.5) / PLACES * 2 * HALF_WATER - HALF_WATER
    total = 0.0
    for y in edges:
        z, normal = surface(edges, numpy.full(PLACES, y))
        cos_in = normal[:, 2]
        cos_out = numpy.sqrt(1 - (1 - cos_in**2) / INDEX**2)
        bend = (cos_in / INDEX - cos_out)[:, None] * normal
        down = bend[:, 2] - 1 / INDEX
        x_hit, y_hit = edges - bend[:, 0] / down * z, y - bend[:, 1] / down * z
        hits = (abs(x_hit) < HALF_FLOOR) & (abs(y_hit) < HALF_FLOOR)
        total += transmittance(cos_in, cos_out)[hits].sum()
    return total * (2 * HALF_WATER / PLACES) ** 2 / (2 * HALF_FLOOR) ** 2


def write_mesh(path, cells):
    along = numpy.linspace(-HALF_WATER, HALF_WATER, cells + 1)
    x, y = (side.ravel() for side in numpy.meshgrid(along, along))
    z, normal = surface(x, y)
    corner = (numpy.arange(cells)[:, None] * (cells + 1) + numpy.arange(cells)).ravel()
    faces = numpy.concatenate([numpy.stack([corner, corner + 1, corner + cells + 2], 1),
                               numpy.stack([corner, corner + cells + 2, corner + cells + 1], 1)])
    with open(path, "w", encoding="ascii") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(x)}\n")
        file.writelines(f"property double {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
        file.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        numpy.savetxt(file, numpy.column_stack([x, y, z, normal]), fmt="%.17g")
        numpy.savetxt(file, numpy.column_stack([numpy.full(len(faces), 3), faces]), fmt="%d")


def scene(water):
    return {"type": "scene", "version": 1,
            "sensor": {"type": "perspective", "fov": 45, "to_world": [{"look_at": {"origin": [0, -6, 4], "target": [0, 0, 0], "up": [0, 0, 1]}}],
                       "film": {"type": "hdrfilm", "width": 8, "height": 8}},
            "sun": {"type": "directional", "direction": [0, 0, -1], "irradiance": 1},
            "floor": {"type": "rectangle", "to_world": [{"scale": HALF_FLOOR}], "bsdf": {"type": "diffuse", "reflectance": 0.5}},
            "water": {**water, "bsdf": {"type": "dielectric", "int_ior": INDEX, "ext_ior": 1.0}}}


def write_points(path, count):
    side = round(count**0.5)
    rng = numpy.random.default_rng(1)
    cell = numpy.stack(numpy.meshgrid(numpy.arange(side), numpy.arange(side)), axis=-1).reshape(-1, 2)
    place = (cell + rng.random(cell.shape)) / side * 2 * HALF_FLOOR - HALF_FLOOR
    table = numpy.column_stack([place, numpy.zeros((len(place), 3)), numpy.ones(len(place))])
    numpy.savetxt(path, table, fmt="%.9g", delimiter=",", header="x,y,z,nx,ny,nz", comments="")


def mean_of_probe(program, folder, water, params):
    path = os.path.join(folder, "scene.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene(water), file)
    words = [word for param in params for word in ("--param", param)]
    out = os.path.join(folder, "out.csv")
    subprocess.run([program, "probe", path, "--method", "beamtree", *words, "--points", os.path.join(folder, "points.csv"), "-o", out],
                   check=True, capture_output=True)
    rows = numpy.genfromtxt(out, delimiter=",", names=True)
    values = rows["irradiance_g"]
    # Jittered points of neighbouring cells scatter alike.
    pairs = values[: len(values) // 2 * 2].reshape(-1, 2)
    return values.mean(), numpy.sqrt(((pairs[:, 0] - pairs[:, 1]) ** 2).sum() / 2) / len(values)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    program = os.path.abspath(sys.argv[1])
    truth = mean_of_floor()
    print(f"Mean by quadrature: {truth:.5f} W/m²\n\n| water | cells a side | mean over truth |\n|---|--:|--:|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        write_points(os.path.join(folder, "points.csv"), int(sys.argv[2]) if len(sys.argv) == 3 else 1_000_000)
        exact = {"type": "heightfield", "half_size": [HALF_WATER, HALF_WATER], "to_world": [{"translate": [0, 0, LEVEL]}],
                 "waves": [{"amplitude": HEIGHT, "wave_vector": list(WAVE)}]}
        for cells in CELLS:
            mean, error = mean_of_probe(program, folder, exact, [f"mesh_resolution={cells}"])
            print(f"| exact | {cells} | {mean / truth:.4f} ± {error / truth:.4f} |", flush=True)
        for cells in CELLS:
            write_mesh(os.path.join(folder, "water.ply"), cells)
            mean, error = mean_of_probe(program, folder, {"type": "ply", "filename": "water.ply"}, [])
            print(f"| smooth mesh | {cells} | {mean / truth:.4f} ± {error / truth:.4f} |", flush=True)


if __name__ == "__main__":
    main()
