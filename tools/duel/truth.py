"""Truths that share no code with the program: the pools' quadrature, and where the smooth water's caustic folds.

The quadrature is tools/pool_truth.py, held against `lighttrace` by tools/equal_error.py.
"""
import json
import math

import numpy as np
import pool_truth


def pool(scene, folder):
    """(irradiance as radiance, height x width; its own standard error, root mean square over pixels); kept in the folder."""
    path = folder / f"truth_{scene.truth['cells']}.npz"
    if not path.exists():
        radiance, error = smooth_pool(scene, folder).radiance_with_error(scene.truth["cells"])
        np.savez(path, radiance=radiance, error=error)
    kept = np.load(path)
    return kept["radiance"], kept["error"]


def smooth_pool(scene, folder):
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "scene.json"
    path.write_text(json.dumps(scene.resolved()), encoding="utf-8")
    return pool_truth.Pool(path, scene.set["/water/to_world/0/scale/2"])


def fold_distance(water, pixels, cells=3000):
    """Distance of each pixel's middle to the nearest fold [pixels]: where the map from the water to the floor turns over."""
    from scipy.ndimage import distance_transform_edt

    x, y = np.meshgrid(*(np.linspace(-half, half, cells) for half in water.half_size))
    _, (u, v), _ = water.rays(x, y)
    turn = (u[:-1, 1:] - u[:-1, :-1]) * (v[1:, :-1] - v[:-1, :-1]) - (u[1:, :-1] - u[:-1, :-1]) * (v[:-1, 1:] - v[:-1, :-1])
    edge = np.zeros(turn.shape, bool)
    edge[:, 1:] |= np.sign(turn[:, 1:]) != np.sign(turn[:, :-1])
    edge[1:] |= np.sign(turn[1:]) != np.sign(turn[:-1])
    fine = 8  # marks a pixel
    column, row = (np.floor(at[:-1, :-1][edge] * fine).astype(int) for at in (u, v))
    inside = (column >= 0) & (row >= 0) & (column < pixels * fine) & (row < pixels * fine)
    marks = np.ones((pixels * fine, pixels * fine), bool)
    marks[row[inside], column[inside]] = False
    away = distance_transform_edt(marks) / fine
    return away[fine // 2::fine, fine // 2::fine]


def relative(difference, truth):
    """(x - r)^2 / (r^2 + 0.01 mean(r)^2), pixel by pixel."""
    return difference ** 2 / (truth ** 2 + 0.01 * float(truth.mean()) ** 2)


def root(values):
    return math.sqrt(float(np.mean(values)))
