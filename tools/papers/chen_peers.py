"""Chen 2011: both bowls by POV-Ray, which the text used, and by today's Mitsuba, beside ours; what is not installed is left out."""
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy.ndimage import binary_erosion, median_filter

from papers.figures import is_diffuse, luminance, mean_of, strip, white
from papers.part import Figure, Part, Table
from papers.study import ROOT, Cost, shown
from papers.verdict import Measured, unmeasured
from papers.words import spread
from peers.aimed_lamp import DARK, aimed, independent
from peers.contestants import REPEATS
from report import exr

SETTING = ("/room/radiance=0", "/sensor/film/width=240", "/sensor/film/height=180", "/sensor/sampler/sample_count=4")
# case -> title, scene, what is changed
BOWLS = {"bowl": ("glass, n = 1.5", "bowl", ()),
         "facets": ("glass, n = 1.5, bent by its facets' planes", "bowl", ("/bowl/face_normals=true",)),
         "crystal": ("cut crystal, n = 1.7", "crystal_bowl", ("/bowl/bsdf/int_ior=1.7", "/bowl/face_normals=true"))}
SHOWN = ("bowl", "crystal")
SEEDS = (1, 2, 3)
FREE_OF_BIAS = (1, 2, 3, 4, 5)  # seeds of Mitsuba and of our light tracing, which are held to each other more narrowly
PHOTONS = {seed: round(30000 * REPEATS[seed]) for seed in SEEDS}  # POV-Ray's: it has no seed
RAYS, EYE_RAYS = 256, 64  # a pixel, of Mitsuba's light paths and of its path tracer; its sampler wants squares
CUTOFF = 20  # degrees: the spot light in the point light's place lights all that is compared


def words(case):
    return [f"experiments/scenes/{BOWLS[case][1]}.json", *[word for each in (*SETTING, *BOWLS[case][2]) for word in ("--set", each)]]


def ours(study, case, seed, method, *parameters):
    file, = study.single("peers", "render", [*words(case), "--method", method, *[word for each in parameters for word in ("--param", each)], "--seed",
                                             str(seed)], f"{method}-{case}-s{seed}.exr")
    return exr.read_layers(file)


def photon_map(study, case, seed):
    return ours(study, case, seed, "photonmap", "photons=300000", "nearest=100", "max_bounces=64")


def light_traced(study, case, seed):
    return ours(study, case, seed, "lighttrace", "paths=3000000", "max_bounces=64")


def exported(study, case, target):
    """(folder, command) of a scene as another program reads it."""
    folder = study.output / "trials" / "peers" / f"{target}-{case}"
    command = ["export", *words(case), "--to", target, "-o", folder]
    if not any(folder.glob("scene.*")):
        study.run(command)
    return folder, command


def aim(source, position):
    """Mitsuba's point lights send nearly all their particles past the scene."""
    file = source.with_name("aimed.xml")
    text = aimed(source.read_text(encoding="utf-8"), source, position, (0, 0, 0), (0, 0, 1), CUTOFF, 0.999 * CUTOFF)
    file.write_text(independent(text), encoding="utf-8")
    return file


def timed(command, folder):
    """(CPU seconds, seconds) of a program of one thread; raises ChildProcessError."""
    start = time.monotonic()
    with subprocess.Popen([str(word) for word in command], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as process:
        complaints = process.stderr.read()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise ChildProcessError(f"{pathlib.Path(command[0]).name}: exit code {process.returncode}: {' '.join(complaints.strip().splitlines()[-1:])}")
    return used.ru_utime + used.ru_stime, time.monotonic() - start


def kept_run(study, name, title, make):
    """(picture, CPU seconds) of NAME.npz, which make(file) writes and whose command it gives; what it cost goes to the page."""
    file = study.output / "trials" / "peers" / f"{name}.npz"
    note = file.with_suffix(".json")
    if not (file.is_file() and note.is_file()):
        study.log(f"{title}: {name}")
        command, seconds = make(file)
        note.write_text(json.dumps({"command": command, "seconds": seconds}) + "\n")
    told = json.loads(note.read_text())
    cost = study.costs.setdefault(title.lower().replace("-", ""), Cost(told["command"]))
    cost.seconds += told["seconds"]
    cost.bytes += file.stat().st_size
    with np.load(file) as found:
        return found["picture"].astype(np.float64), float(found["cpu_s"])


def povray(study, case, seed):
    def make(file):
        folder, command = exported(study, case, "povray")
        call = ["povray", "scene.ini", "+WT1", f"Declare=Photon_Count={PHOTONS[seed]}"]
        used, seconds = timed(call, folder)
        np.savez_compressed(file, picture=exr.read_layers(folder / "scene.exr")[""][..., :3], cpu_s=used)
        return also(command, folder, call), seconds

    return kept_run(study, f"povray-{case}-{PHOTONS[seed]}", "POV-Ray", make)


def mitsuba(study, case, seed):
    picture, used = by_mitsuba(study, case, seed, "ptracer", RAYS)
    return picture / DARK, used


def by_mitsuba(study, case, seed, integrator, rays):
    def make(file):
        folder, command = exported(study, case, "mitsuba")
        scene = folder / "scene.xml"
        if integrator == "ptracer":
            scene = aim(scene, study.scene(words(case)[0])["sun"]["position"])
        tool = ROOT / "tools" / "papers" / "mitsuba_picture.py"
        _, seconds = timed([mitsuba_python(), tool, scene, integrator, rays, seed, file], folder)
        return also(command, folder, ["python", tool, scene.name, integrator, rays, seed, "OUT.npz"]), seconds

    return kept_run(study, f"mitsuba-{case}-{integrator}{rays}-s{seed}", "Mitsuba", make)


def also(export, folder, call):
    """Both commands as a reader types them."""
    text = f"cd {folder} && {shlex.join(map(str, call))}".replace(f"{ROOT}/", "")
    return f"{shown(export)}; ({text})"


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
    """Mean over the pixels of the table in the bowl's shadow: the caustic there.

    The shadow's edge is left out: a pixel that no sample of ours sees lit may be lit in part in a program that takes more of them.
    """
    shadow = is_diffuse(layers) & (luminance(layers["direct"]) == 0)
    return float(luminance(picture)[binary_erosion(shadow, np.ones((3, 3)))].mean())


def all_bowls(study, run, seeds):
    return {case: [run(study, case, seed) for seed in seeds] for case in BOWLS}


PROGRAMS = {"POV-Ray": (povray, SEEDS), "Mitsuba": (mitsuba, FREE_OF_BIAS)}


def by_programs(study, names):
    """{(program, case): [(picture, CPU seconds)]}; side by side, since each has one thread."""
    with ThreadPoolExecutor(len(PROGRAMS)) as pool:
        begun = {name: pool.submit(all_bowls, study, *PROGRAMS[name]) for name in names}
        return {(name, case): pictures for name, run in begun.items() for case, pictures in run.result().items()}


def peers(study):
    missing = {name: absent(name) for name in PROGRAMS}
    truth = all_bowls(study, light_traced, FREE_OF_BIAS)
    maps = all_bowls(study, photon_map, SEEDS)
    found = by_programs(study, [name for name in PROGRAMS if not missing[name]])
    base = {case: [table_light(each[""], each) for each in truth[case]] for case in BOWLS}
    at = {seed: i for i, seed in enumerate(FREE_OF_BIAS)}
    over = lambda case, pictures, seeds: [table_light(picture, truth[case][at[seed]]) / base[case][at[seed]]
                                          for picture, seed in zip(pictures, seeds, strict=True)]
    measured, rows = {}, []
    for case, (title, *_) in BOWLS.items():
        ours_too = spread(over(case, [each[""] for each in maps[case]], SEEDS))
        notes = {f"povray_{case}": f"the nearest photons hold too much light where it is uneven; our photon map's: {ours_too}"}
        rows.append([title, "photon map", ours_too, ""])
        for name, (_, seeds) in PROGRAMS.items():
            claim = f"{name.replace('-', '').lower()}_{case}"
            if missing[name]:
                measured[claim] = unmeasured(missing[name])
                continue
            measured[claim] = Measured(over(case, [picture for picture, _ in found[name, case]], seeds), note=notes.get(claim, ""))
            rows.append([title, name, spread(measured[claim].samples), spread([used for _, used in found[name, case]])])
    return Part(measured, [Table(
        "peers", "The bowls by other programs", ["bowl", "program", "light in the bowl's shadow, over light tracing's", "CPU s"], rows,
        "240 × 180 pixels, a dark room, crystal without dispersion and bent by its facets' planes. POV-Ray: some 30,000 photons aimed at the bowl, "
        f"both ways at every surface, the nearest 20 to 100 gathered; Mitsuba: ptracer, {RAYS} light paths a pixel from a spot light in the point "
        "light's place, over a table a thousand times darker; ours: 3,000,000 light paths, and 300,000 photons. The "
        "shadow's edge is left out. Times are for pictures of other noise each: results/bench/peers.md compares at equal error.")],
        [picture_of(study, maps, found)])


def completed(light, eye):
    """Mitsuba's light tracer where its spot light reaches, round about; its path tracer elsewhere."""
    about = lambda picture: median_filter(luminance(picture), 7)
    return np.where((about(light) >= 0.5 * about(eye))[..., None], light, eye)


def picture_of(study, maps, found):
    shown_rows = []
    for case in SHOWN:
        mean = mean_of(maps[case])
        row = [(f"{BOWLS[case][0]}: photon map", mean)]
        if ("POV-Ray", case) in found:
            row.append(("POV-Ray", np.mean([picture for picture, _ in found["POV-Ray", case]], axis=0)))
        if ("Mitsuba", case) in found:
            light = np.mean([picture for picture, _ in found["Mitsuba", case]], axis=0)
            eye, _ = by_mitsuba(study, case, 1, "path", EYE_RAYS)
            row.append(("Mitsuba", completed(light, eye)))
        shown_rows.append([(title, picture, white(mean)) for title, picture in row])
    return Figure("peers", "The bowls by the photon map, POV-Ray and Mitsuba", "One scene, exported to each program; each row at one exposure, means of "
                  f"{len(SEEDS)} runs, Mitsuba's of {len(FREE_OF_BIAS)}. Mitsuba's light tracer does not reach pixels that see the glass, nor those beyond its spot light: there the "
                  "picture is by its path tracer, which has no caustic. The table of numbers is of what is seen without glass before it.",
                  *strip(shown_rows))


SECTIONS = {"peers": peers}
