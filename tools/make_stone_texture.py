#!/usr/bin/python3
"""Makes experiments/scenes/textures/stone.png: a seamless synthetic stone, 256 x 256, 8-bit sRGB.

Fractal noise (a sum of periodic value noises whose amplitude halves as the frequency doubles),
warped by itself for veins, mapped between two greys. Run from the project's folder; the same
numbers give the same picture.
"""

import pathlib

import matplotlib.image
import numpy as np

SIZE = 256


def value_noise(rng, cells):
    """Periodic noise on a lattice of cells x cells random values, smoothly interpolated."""
    lattice = rng.random((cells, cells))
    t = np.arange(SIZE) * cells / SIZE
    low = t.astype(int)
    f = t - low
    f = f * f * (3 - 2 * f)
    high = (low + 1) % cells
    rows = lattice[low][:, low] * (1 - f)[None, :] + lattice[low][:, high] * f[None, :]
    next_rows = lattice[high][:, low] * (1 - f)[None, :] + lattice[high][:, high] * f[None, :]
    return rows * (1 - f)[:, None] + next_rows * f[:, None]


def fractal(rng, first=4, octaves=6):
    return sum(value_noise(rng, first << k) / 2**k for k in range(octaves)) / 2


def main():
    rng = np.random.default_rng(1996)
    base, warp, speckle = fractal(rng), fractal(rng), fractal(rng, 32, 3)
    veins = np.abs(np.sin(2 * np.pi * (base + 0.6 * warp)))
    grey = 0.30 + 0.28 * base + 0.16 * veins + 0.14 * (speckle - 0.5)
    tint = np.array([1.0, 0.965, 0.91])
    linear = np.clip(grey[..., None] * tint, 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    target = pathlib.Path("experiments/scenes/textures/stone.png")
    pixels = np.round(255 * srgb).astype(np.uint8)
    matplotlib.image.imsave(target, pixels, format="png", metadata={"Software": ""})
    print(f"{target}: {target.stat().st_size} bytes")


if __name__ == "__main__":
    main()
