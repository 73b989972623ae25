#!/usr/bin/env python3
"""The error and the processor time of `beamtree` by two programs, at points of four floors.

Usage: equal_time.py BEFORE AFTER     two files `causticbench`

Prints a Markdown table: for each scene and mesh the processor seconds of `probe` on one thread, and the mean error of
the irradiance over its mean. The truth is AFTER's with 96 polygons a side and nothing pruned; agreement_roots holds that against brute force.
Both programs read the same scenes, of which one is written here: sunlit water of one wave that folds its light.
"""

import csv
import json
import os
import random
import sys
import tempfile

from timed_run import timed_run

POINTS = 10000
MESHES = (16, 32, 64, 128, 256)
TRUTH = ("mesh_resolution=96", "prune=0")
SCENES = os.path.join(os.path.dirname(__file__), "../../experiments/scenes")


def folded_pool(folder):
    floor = {"type": "rectangle", "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": 0.5}}}
    water = {
        "type": "heightfield",
        "half_size": [2, 2],
        "waves": [{"amplitude": 0.03, "wave_vector": [-6, 15]}],
        "to_world": [{"translate": [0, 0, 0.8]}],
        "bsdf": {"type": "dielectric", "int_ior": 1.33, "ext_ior": 1},
    }
    sun = {"type": "directional", "direction": [0, 0, -1], "irradiance": 1}
    look = {"look_at": {"origin": [0, -6, 4], "target": [0, 0, 0], "up": [0, 0, 1]}}
    film = {"type": "hdrfilm", "width": 64, "height": 64}
    sensor = {"type": "perspective", "fov": 45, "to_world": [look], "film": film}
    path = os.path.join(folder, "folded_pool.json")
    with open(path, "w") as file:
        json.dump({"type": "scene", "version": 1, "sensor": sensor, "sun": sun, "floor": floor, "water": water}, file)
    return path


def write_points(path, half_width, height):
    chance = random.Random(1)
    with open(path, "w") as file:
        file.write("x,y,z,nx,ny,nz\n")
        for _ in range(POINTS):
            x, y = (chance.uniform(-half_width, half_width) for _ in range(2))
            file.write(f"{x},{y},{height},0,0,1\n")


def probe(program, scene, points, *params):
    """Irradiances, and the processor seconds that they took."""
    command = [program, "probe", scene, "--method", "beamtree", "--points", points, "--threads", "1"]
    output, seconds = timed_run(command + [word for param in params for word in ("--param", param)])
    return [float(row["irradiance_g"]) for row in csv.DictReader(output.splitlines())], seconds


def error(found, truth):
    return sum(abs(a - b) for a, b in zip(found, truth)) / sum(truth)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    programs = sys.argv[1:]
    print("| scene | mesh | before [s] | error | after [s] | error |\n|---|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        scenes = {
            "ring": (os.path.join(SCENES, "ring.json"), 0.49, 0),
            "ball": (os.path.join(SCENES, "ball.json"), 1.4, 0),
            "calm pool": (os.path.join(SCENES, "pool.json"), 0.95, -1),
            "folded pool": (folded_pool(folder), 0.95, 0),
        }
        points = os.path.join(folder, "points.csv")
        for name, (scene, half_width, height) in scenes.items():
            write_points(points, half_width, height)
            truth, _ = probe(programs[1], scene, points, *TRUTH)
            for mesh in MESHES:
                cells = []
                for program in programs:
                    found, seconds = probe(program, scene, points, f"mesh_resolution={mesh}")
                    cells.append(f"{seconds:.2f} | {error(found, truth):.2g}")
                print(f"| {name} | {mesh} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
