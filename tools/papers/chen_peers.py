"""Chen 2011: both bowls by POV-Ray, which the text used, and by today's Mitsuba, beside the photon map; what is not installed is left out."""
import json
import os
import pathlib
import shutil
import statistics
import subprocess

import numpy as np

from papers.chuang_pictures import enlarged
from papers.figures import luminance, strip, white
from papers.part import Figure, Part, Table
from papers.study import ROOT
from papers.verdict import Measured, unmeasured
from papers.words import spread
from peers.aimed_lamp import DARK, aimed
from report import exr

BOWLS = {"bowl": "glass, n = 1.5", "crystal_bowl": "cut crystal, n = 1.7"}
SETTING = ("/room/radiance=0", "/sensor/film/width=160", "/sensor/film/height=120", "/sensor/sampler/sample_count=4")
INDEX = {"bowl": (), "crystal_bowl": ("/bowl/bsdf/int_ior=1.7",)}
SEEDS = (1, 2, 3)
PHOTONS = {1: 30000, 2: 30390, 3: 29610}  # POV-Ray's: it has no seed
RAYS = 256  # a pixel, of Mitsuba's light paths; its sampler wants a square
CUTOFF = 20  # degrees: the spot light in the point light's place lights all that the picture shows


def words(scene):
    return [word for each in (*SETTING, *INDEX[scene]) for word in ("--set", each)]


def ours(study, scene, seed):
    file, = study.single("peers", "render", [f"experiments/scenes/{scene}.json", *words(scene), "--method", "photonmap", "--param", "photons=300000",
                                             "--param", "nearest=100", "--param", "max_bounces=64", "--seed", str(seed), "--threads", "1"],
                         f"ours-{scene}-s{seed}.exr")
    return exr.read_layers(file)


def exported(study, scene, target):
    folder = study.output / "trials" / "peers" / f"{target}-{scene}"
    if not any(folder.glob("scene.*")):
        study.run(["export", f"experiments/scenes/{scene}.json", *words(scene), "--to", target, "-o", folder])
        if target == "mitsuba":
            aim(folder / "scene.xml", json.loads((ROOT / "experiments" / "scenes" / f"{scene}.json").read_text(encoding="utf-8"))["sun"]["position"])
    return folder


def aim(file, position):
    """Mitsuba's point lights send nearly all their particles past the scene."""
    text = file.read_text(encoding="utf-8")
    file.write_text(aimed(text, file, position, (0, 0, 0), (0, 0, 1), CUTOFF, 0.999 * CUTOFF), encoding="utf-8")


def timed(command, folder):
    """CPU seconds of a program of one thread; raises ChildProcessError."""
    before = os.times()
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise ChildProcessError(f"{pathlib.Path(command[0]).name}: exit code {done.returncode}: {' '.join(done.stderr.strip().splitlines()[-1:])}")
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def povray(study, scene, seed):
    """(picture, CPU seconds), kept as a file."""
    kept = study.output / "trials" / "peers" / f"povray-{scene}-{PHOTONS[seed]}.npz"
    if not kept.is_file():
        study.log(f"POV-Ray: {scene}, {PHOTONS[seed]} photons")
        folder = exported(study, scene, "povray")
        used = timed(["povray", "scene.ini", "+WT1", f"Declare=Photon_Count={PHOTONS[seed]}"], folder)
        np.savez_compressed(kept, picture=exr.read_layers(folder / "scene.exr")[""][..., :3], cpu_s=used)
    return load(kept)


def mitsuba(study, scene, seed):
    kept = study.output / "trials" / "peers" / f"mitsuba-{scene}-{RAYS}-s{seed}.npz"
    if not kept.is_file():
        study.log(f"Mitsuba: {scene}, seed {seed}")
        file = exported(study, scene, "mitsuba") / "scene.xml"
        timed([mitsuba_python(), ROOT / "tools" / "papers" / "mitsuba_picture.py", file, RAYS, seed, kept], file.parent)
    picture, used = load(kept)
    return picture / DARK, used


def load(file):
    with np.load(file) as found:
        return found["picture"].astype(np.float64), float(found["cpu_s"])


def mitsuba_python():
    return os.environ.get("CAUSTICS_MITSUBA_PYTHON", str(ROOT / ".venv" / "bin" / "python"))


def absent(name):
    """Why a program is left out, or nothing."""
    if name == "POV-Ray":
        return "" if shutil.which("povray") else "POV-Ray is not installed (apt-get install povray)"
    python = mitsuba_python()
    there = shutil.which(python) and subprocess.run([python, "-c", "import mitsuba"], capture_output=True).returncode == 0
    return "" if there else "no Python with Mitsuba (CAUSTICS_MITSUBA_PYTHON; tools/crosscheck-requirements.txt)"


def table_light(picture, layers):
    """Mean over the pixels of the table that the lamp does not reach: the caustic in the bowl's shadow."""
    table = (layers["albedo"] < 0.7).all(axis=2) & (layers["albedo"] > 0).all(axis=2)
    return float(luminance(picture)[table & (luminance(layers["direct"]) == 0)].mean())


def peers(study):
    programs = {"POV-Ray": povray, "Mitsuba": mitsuba}
    missing = {name: absent(name) for name in programs}
    own = {(scene, seed): ours(study, scene, seed) for scene in BOWLS for seed in SEEDS}
    found = {(name, scene, seed): run(study, scene, seed) for name, run in programs.items() if not missing[name] for scene in BOWLS for seed in SEEDS}
    over = {(name, scene): [table_light(found[name, scene, seed][0], own[scene, seed]) / table_light(own[scene, seed][""], own[scene, seed])
                            for seed in SEEDS] for name, scene, _ in found}
    measured, rows, shown = {}, [], []
    for name in programs:
        samples = [statistics.fmean(over[name, scene][k] for scene in BOWLS) for k in range(len(SEEDS))] if not missing[name] else []
        measured[name.replace("-", "").lower()] = Measured(samples, note="mean of both bowls") if samples else unmeasured(missing[name])
    for scene, what in BOWLS.items():
        level = white(own[scene, 1][""])
        shown.append([(f"{what}: photon map", enlarged(own[scene, 1][""]), level)] + [
            (name, enlarged(found[name, scene, 1][0]), level) for name in programs if not missing[name]])
        rows += [[what, name, spread(over[name, scene]), spread([found[name, scene, seed][1] for seed in SEEDS])]
                 for name in programs if not missing[name]]
    study.keep("peers", ["tools/reproduce.sh", "chen2011", "--only", "peers"], 0)
    return Part(measured, [Table(
        "peers", "The bowls by other programs", ["bowl", "program", "light in the bowl's shadow, over the photon map's", "CPU s"], rows,
        "160 × 120 pixels, a dark room, crystal without dispersion. POV-Ray: some 30,000 photons aimed at the bowl, both ways at every surface, the nearest 20 to 100 gathered; "
        f"Mitsuba: ptracer, {RAYS} light paths a pixel from a spot light in the point light's place, over a table a thousand times darker; ours: 300,000 photons. Times are for pictures of other noise each: results/bench/peers.md "
        "compares at equal error.")] if rows else [], [Figure(
            "peers", "The bowls by the photon map, POV-Ray and Mitsuba", "One scene, exported to each program; each row at one exposure. "
            "The table of numbers is of what is seen without glass before it. Mitsuba's particles do not reach pixels that see the glass.", *strip(shown))])


SECTIONS = {"peers": peers}
