#!/usr/bin/env python3
"""Cost and error of `beamtree` by default beside those of `photonmap` by default, on glass.

Usage: glass.py PROGRAM SCENE...     a file `causticbench`, and scene files; `water` is the project's glass of cognac,
                                     with water on a table

Prints a Markdown table. Each picture has 240 x 180 pixels of 4 samples, on one thread. Processor seconds are those of the whole
program, loading included, medians of three seeds. The truth is `lighttrace` of 32 million paths, twice: half of the relmse between
the two is noise of the truth, and is taken off every other. For the last columns `photonmap` gets so many photons that it takes as
long as `beamtree`.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from report import exr
from timed_run import processor_seconds

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../experiments/scenes")
FILM = ("--set", "/sensor/film/width=240", "--set", "/sensor/film/height=180", "--spp", "4")
PATHS = 32_000_000
PHOTONS = 100_000  # photonmap's default
SEEDS = (1, 2, 3)


def glass_of_water(folder):
    with open(os.path.join(SCENES, "cognac.json")) as file:
        scene = json.load(file)
    for name in ("sand", "room"):
        del scene[name]
    for name in ("inside", "cognac"):
        scene[name]["bsdf"]["int_ior"] = 1.333
        del scene[name]["bsdf"]["absorption"]
    scene["table"] = {"type": "rectangle", "to_world": [{"scale": 0.4}],
                      "bsdf": {"type": "diffuse", "reflectance": [0.6, 0.5, 0.4]}}
    path = os.path.join(folder, "water.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    return path


class Pictures:
    """Renders of one scene."""

    def __init__(self, program, scene, folder):
        self.program, self.scene, self.folder = program, scene, folder
        self.truths = [os.path.join(folder, f"truth{seed}.exr") for seed in (77, 78)]
        for seed, truth in zip((77, 78), self.truths):
            self.render("lighttrace", seed, truth, [f"paths={PATHS}"], threads=2)
        self.noise = self.compared(*self.truths)["relmse"] / 2

    def render(self, method, seed, output, params=(), threads=1):
        """Processor seconds of a picture."""
        command = [self.program, "render", self.scene, *FILM, "--method", method, "--seed", str(seed), "--threads", str(threads),
                   "-o", output]
        return processor_seconds(command + [word for param in params for word in ("--param", param)])

    def compared(self, picture, truth):
        told = subprocess.run([self.program, "compare", picture, truth, "--json"], check=True, capture_output=True, text=True)
        return json.loads(told.stdout)["metrics"]

    def scored(self, method, params=()):
        """Medians over the seeds of processor seconds, relmse and rmse, the mean of the light over the truth's, and the beams' share."""
        seconds, metrics, shares = [], [], []
        for seed in SEEDS:
            output = os.path.join(self.folder, f"{method}.exr")
            seconds.append(self.render(method, seed, output, params))
            both = [self.compared(output, truth) for truth in self.truths]
            metrics.append({key: statistics.mean(one[key] for one in both) for key in ("relmse", "rmse", "mean_ratio")})
            metrics[-1]["relmse"] -= self.noise
            _, attributes = exr.read(output)
            shares.append(json.loads(attributes.get("causticbench.resolved", "{}")).get("beam_share"))
        middle = statistics.median
        return {"seconds": middle(seconds), "relmse": middle(m["relmse"] for m in metrics), "rmse": middle(m["rmse"] for m in metrics),
                "light": statistics.mean(m["mean_ratio"] for m in metrics), "share": shares[0]}


def row(name, pictures):
    least = pictures.render("none", 1, os.path.join(pictures.folder, "none.exr"))
    photons = pictures.scored("photonmap")
    beams = pictures.scored("beamtree")
    more = max(1, (beams["seconds"] - least) / (photons["seconds"] - least))
    equal = pictures.scored("photonmap", [f"photons={round(PHOTONS * more)}"])
    # Half of the time does not grow with the photons: what is missing is added once.
    if equal["seconds"] < 0.95 * beams["seconds"]:
        more *= (beams["seconds"] - least) / (equal["seconds"] - least)
        equal = pictures.scored("photonmap", [f"photons={round(PHOTONS * more)}"])
    return (f"| {name} | {photons['seconds']:.2f} | {beams['seconds']:.2f} | {beams['seconds'] / photons['seconds']:.1f} | {beams['share']:.2f} | "
            f"{beams['light']:.4f} | {beams['relmse']:.4f} | {equal['seconds']:.2f} | {equal['relmse']:.4f} | "
            f"{beams['relmse'] / equal['relmse']:.2f} | {beams['rmse'] / equal['rmse']:.2f} |")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    print("| scene | `photonmap` [CPU s] | `beamtree` [CPU s] | over it | beam_share | light | relmse | photon map of equal time [CPU s] | "
          "its relmse | relmse over its | rmse over its |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
    for scene in sys.argv[2:]:
        with tempfile.TemporaryDirectory() as folder:
            path = glass_of_water(folder) if scene == "water" else scene
            name = os.path.splitext(os.path.basename(path))[0]
            print(row(name, Pictures(sys.argv[1], path, folder)), flush=True)


if __name__ == "__main__":
    main()
