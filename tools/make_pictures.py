#!/usr/bin/python3
"""Makes results/pictures/caustics.png, the picture on README's first screen.

Renders the ring, the ball and the pool with the photon map (2 million photons, N = 80, 16 samples a
pixel) and sets them side by side. Needs build/release (tools/build.sh release causticbench) and some
two minutes; run from the project's folder.
"""

import pathlib
import subprocess
import sys
import tempfile

import matplotlib.image
import numpy as np

PROGRAM = pathlib.Path("build/release/bin/causticbench")
SCENES = ["ring", "ball_area", "pool"]
TARGET = pathlib.Path("results/pictures/caustics.png")


def render(scene, picture):
    command = [PROGRAM, "render", f"experiments/scenes/{scene}.json", "--method", "photonmap",
               "--param", "photons=2000000", "--param", "nearest=80", "--spp", "16",
               "--set", "/sensor/film/width=480", "--set", "/sensor/film/height=360",
               "-o", picture]
    subprocess.run(command, check=True)
    return matplotlib.image.imread(picture)[..., :3]


def main():
    if not PROGRAM.exists():
        sys.exit(f"{PROGRAM}: not there (tools/build.sh release causticbench)")
    with tempfile.TemporaryDirectory() as folder:
        pictures = [render(scene, pathlib.Path(folder) / f"{scene}.png") for scene in SCENES]
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    joined = np.round(255 * np.concatenate(pictures, axis=1)).astype(np.uint8)
    matplotlib.image.imsave(TARGET, joined, format="png", metadata={"Software": ""})
    print(f"{TARGET}: {TARGET.stat().st_size} bytes")


if __name__ == "__main__":
    main()
