#!/usr/bin/python3
"""Makes experiments/papers/scenes/dolphin.ply: a dolphin of 1 m, a spine with elliptic cross-sections, and fins.

The body is a tube of ellipses about a bent spine; flukes, dorsal fin and flippers are flat lenses that stick in it. Each part is
closed, so that the whole is a closed surface where parts overlap. Along +x from the snout; z is up. The same numbers give the same
bytes. Run from the project's folder.
"""
import math
import pathlib
import struct

import numpy as np
from scipy.interpolate import PchipInterpolator

TARGET = pathlib.Path("experiments/papers/scenes/dolphin.ply")
# x along the body: half height, half width.
SECTIONS = {0: (0.008, 0.010), 0.04: (0.016, 0.020), 0.10: (0.022, 0.026), 0.13: (0.052, 0.050), 0.20: (0.078, 0.072), 0.30: (0.098, 0.092),
            0.40: (0.105, 0.098), 0.50: (0.098, 0.090), 0.60: (0.082, 0.072), 0.70: (0.060, 0.050), 0.80: (0.040, 0.030), 0.90: (0.024, 0.016),
            0.97: (0.016, 0.010)}
ALONG, AROUND, FIN_ALONG, FIN_ACROSS = 128, 80, 16, 24  # cells


def spine(x):
    return 0.05 * math.sin(math.pi * x)


def rings(points, around):
    """Triangles between neighbouring closed rings of `around` vertices, with a cap at both ends."""
    vertices = [vertex for ring in points for vertex in ring]
    faces = []
    for i in range(len(points) - 1):
        for k in range(around):
            a, b = i * around + k, i * around + (k + 1) % around
            faces += [(a, b, b + around), (a, b + around, a + around)]
    for ring, forward in ((0, False), (len(points) - 1, True)):
        middle = len(vertices)
        vertices.append(tuple(np.mean(points[ring], axis=0)))
        for k in range(around):
            a, b = ring * around + k, ring * around + (k + 1) % around
            faces.append((middle, a, b) if forward else (middle, b, a))
    return vertices, faces


def body():
    sizes = PchipInterpolator(list(SECTIONS), list(SECTIONS.values()))
    points = []
    for i in range(ALONG + 1):
        x = 0.97 * (0.5 - 0.5 * math.cos(math.pi * i / ALONG))  # closer at both ends
        high, wide = sizes(x)
        turn = [2 * math.pi * k / AROUND for k in range(AROUND)]
        points.append([(x, wide * math.cos(t), spine(x) + high * math.sin(t)) for t in turn])
    return rings(points, AROUND)


def fin(root, tip, chord_root, chord_tip, thickness, sweep):
    """A flat lens from `root` to `tip`; chords lie along x, the tip's shifted back by `sweep`."""
    root, tip = np.array(root), np.array(tip)
    out = tip - root
    flat = np.cross(out, (1, 0, 0))
    flat /= np.linalg.norm(flat)
    points = []
    for i in range(FIN_ALONG + 1):
        t = i / FIN_ALONG
        chord = (chord_root + (chord_tip - chord_root) * t) * math.sqrt(max(1 - t**4, 0.01))
        middle = root + t * out + np.array([sweep * t * t, 0, 0])
        turn = [-2 * math.pi * k / FIN_ACROSS for k in range(FIN_ACROSS)]
        thick = thickness * (1 - 0.8 * t)
        points.append([tuple(middle + np.array([chord / 2 * math.cos(a), 0, 0]) + flat * thick * math.sin(a)) for a in turn])
    return rings(points, FIN_ACROSS)


def parts():
    yield body()
    tail = spine(0.96)
    for side in (-1, 1):
        yield fin((0.96, 0, tail), (0.99, 0.14 * side, tail), 0.09, 0.025, 0.008, 0.07)
        down = 0.17 * math.sin(math.radians(45))
        yield fin((0.24, 0.05 * side, spine(0.24) - 0.03), (0.30, 0.05 * side + down * side, spine(0.24) - 0.03 - down), 0.075, 0.02, 0.009, 0.05)
    yield fin((0.48, 0, spine(0.48) + 0.085), (0.53, 0, spine(0.48) + 0.195), 0.14, 0.02, 0.009, 0.05)


def outwards(vertices, faces):
    """The faces turned so that a part encloses a positive volume."""
    a, b, c = (np.array(vertices)[[face[k] for face in faces]] for k in range(3))
    return faces if (np.cross(a, b) * c).sum() > 0 else [(i, k, j) for i, j, k in faces]


def main():
    vertices, faces = [], []
    for own, triangles in parts():
        faces += [tuple(len(vertices) + index for index in face) for face in outwards(own, triangles)]
        vertices += own
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    data = header.encode() + b"".join(struct.pack("<3f", *vertex) for vertex in vertices)
    TARGET.write_bytes(data + b"".join(struct.pack("<B3i", 3, *face) for face in faces))
    print(f"{TARGET}: {len(faces)} triangles, {TARGET.stat().st_size} bytes")


if __name__ == "__main__":
    main()
