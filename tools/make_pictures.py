#!/usr/bin/python3
"""Makes results/pictures/caustics.png, README's three caustics, glass.png and rooms.png.

caustics.png: the ring, the ball and the pool with the photon map (2 million photons, N = 80, 16 samples a
pixel) side by side. glass.png: bowl, crystal bowl and cognac above prism, rainbow and gem (2 million photons,
N = 200). rooms.png: room and crystal room, with the light between their walls (globalphotonmap, 16 rays
from each point). Needs build/release (tools/build.sh release causticbench) and some ten minutes; run from the
project's folder.
"""

import pathlib
import subprocess
import sys
import tempfile

import matplotlib.image
import numpy as np

PROGRAM = pathlib.Path("build/release/bin/causticbench")
FOLDER = pathlib.Path("results/pictures")
INDIRECT = ["--indirect", "globalphotonmap", "--indirect-param", "gather=16"]
# Rows of (scene, exposure in stops or None), the photons of an estimate, pixels, and further words.
PICTURES = {
    "caustics": ([[("ring", None), ("ball_area", None), ("pool", None)]], 80, (480, 360), []),
    "glass": ([[("bowl", 0.6), ("crystal_bowl", 0.6), ("cognac", None)],
               [("prism", 2), ("rainbow", None), ("gem", 0.9)]], 200, (480, 360), []),
    "rooms": ([[("room", None), ("crystal_room", None)]], 100, (360, 360), INDIRECT),
}


def render(scene, exposure, nearest, size, words, picture):
    command = [PROGRAM, "render", f"experiments/scenes/{scene}.json", "--method", "photonmap",
               "--param", "photons=2000000", "--param", f"nearest={nearest}", "--param", "tree=packed", "--spp", "16",
               "--set", f"/sensor/film/width={size[0]}", "--set", f"/sensor/film/height={size[1]}",
               *words, "-o", picture]
    if exposure is not None:
        command += ["--exposure", str(exposure)]
    subprocess.run(command, check=True)
    return matplotlib.image.imread(picture)[..., :3]


def make(name, folder):
    rows, nearest, size, words = PICTURES[name]
    pictures = [np.concatenate([render(scene, exposure, nearest, size, words, folder / f"{scene}.png")
                               for scene, exposure in row],
                               axis=1) for row in rows]
    target = FOLDER / f"{name}.png"
    joined = np.round(255 * np.concatenate(pictures, axis=0)).astype(np.uint8)
    matplotlib.image.imsave(target, joined, format="png", metadata={"Software": ""})
    print(f"{target}: {target.stat().st_size} bytes")


def main():
    if not PROGRAM.exists():
        sys.exit(f"{PROGRAM}: not there (tools/build.sh release causticbench)")
    unknown = [name for name in sys.argv[1:] if name not in PICTURES]
    if unknown:
        sys.exit(f"unknown picture {unknown[0]} (known: {', '.join(PICTURES)})")
    FOLDER.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in sys.argv[1:] or PICTURES:
            make(name, pathlib.Path(folder))


if __name__ == "__main__":
    main()
