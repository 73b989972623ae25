"""The contestants as programs of one thread: each makes the picture of a caustic (green channel, W/m2/sr) and is timed whole.

Seconds are user + system time of the process that makes the picture. What only serves the comparison is not timed: the export of the
scene, the compilation of the splat, and the picture of the direct light that is taken away from what POV-Ray and Mitsuba make.
"""
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess

import numpy as np

from peers import contest
from peers.aimed_lamp import DARK, aimed, independent
from report import exr

HERE = pathlib.Path(__file__).resolve().parent
OUR_METHODS = ("photonmap", "beamtree", "lighttrace")
FIXED = {"photonmap": {"kernel": "point", "emission": "stratified", "filter": "epanechnikov"}, "lighttrace": {"emission": "stratified"}}
REPEATS = {1: 1.0, 2: 1.013, 3: 0.987}  # of POV-Ray's photons, which have no seed
DEPTH = 18  # of Mitsuba's paths: our 16 events, floor and eye
JITTER = 0.4  # of POV-Ray's photons, in spacings


class TooLong(Exception):
    """A trial beyond the CPU seconds that one may take."""


class Contestants:
    def __init__(self, bench, mitsuba, work, longest):
        self.bench, self.work, self.longest = str(bench), work, longest
        self.mitsuba = str(mitsuba) if mitsuba and pathlib.Path(mitsuba).exists() else None
        self.povray = shutil.which("povray")
        self.compiler = shutil.which("c++")
        self.llvm = os.environ.get("DRJIT_LIBLLVM_PATH")

    def absent(self):
        """{contestant: why it is left out}."""
        gone = {}
        if self.povray is None:
            gone["povray"] = "POV-Ray is not installed (apt-get install povray)"
        if self.mitsuba is None:
            gone["mitsuba"] = "no Python with Mitsuba (--mitsuba; tools/crosscheck-requirements.txt)"
        if self.compiler is None:
            gone["splat"] = "no C++ compiler"
        return gone

    def trial(self, name, scene, setting, seed):
        """(CPU seconds, picture height x width). Raises TooLong or ChildProcessError."""
        own = dict(setting)
        if name in OUR_METHODS:
            return self.ours(name, scene, setting, own, seed)
        return getattr(self, f"run_{name}")(scene, setting, own, seed)

    def ours(self, name, scene, setting, own, seed):
        params = {**FIXED.get(name, {}), **{key: value for key, value in own.items() if key not in ("spp", "mesh", "jitter")}}
        out = self.work / "ours.exr"
        out.unlink(missing_ok=True)
        given = [word for key, value in params.items() for word in ("--param", f"{key}={plain(value)}")]
        seconds = self.timed([self.bench, "render", contest.ROOT / scene.file, *sets(scene, setting), "--method", name, *given, "--spp", own["spp"],
                              "--seed", seed, "--threads", 1, "-o", out])
        return seconds, exr.read_layers(out)["caustic"][..., 1].astype(np.float64)

    def exported(self, scene, setting, target):
        own = dict(setting)
        folder = self.work / f"{target}_{scene.name}_{own.get('mesh', 0)}{own.get('normals', '')}_{own['spp'] if target == 'povray' else 0}"
        if not (folder / "done").exists():
            samples = ["--set", f"/sensor/sampler/sample_count={own['spp']}"] if target == "povray" else []
            self.timed([self.bench, "export", contest.ROOT / scene.file, *sets(scene, setting), *samples, "--to", target, "--max-bounces", "16", "-o", folder])
            edit = povray_options if target == "povray" else aimed_lamp
            path = folder / ("scene.pov" if target == "povray" else "scene.xml")
            path.write_text(edit(path.read_text(encoding="utf-8"), scene), encoding="utf-8")
            (folder / "done").touch()
        return folder

    def povray_picture(self, folder, declared):
        (folder / "scene.exr").unlink(missing_ok=True)
        seconds = self.timed([self.povray, "scene.ini", "+WT1", *[f"Declare={name}={value}" for name, value in declared.items()]], cwd=folder)
        return seconds, exr.read_layers(folder / "scene.exr")[""][..., 1].astype(np.float64)

    def povray_direct(self, folder):
        """The picture with a black caster: its shadow, and no photons."""
        kept = folder / "direct.npy"
        if not kept.exists():
            np.save(kept, self.povray_picture(folder, {"Photon_Count": 1000, "Caster_Black": 1})[1])
        return np.load(kept)

    def run_povray(self, scene, setting, own, seed):
        folder = self.exported(scene, setting, "povray")
        declared = {"Photon_Count": round(own["count"] * REPEATS.get(seed, 1.007)), "Photon_Jitter": JITTER}
        declared |= {"Photon_Gather": own["gather"]} if "gather" in own else {"Photon_Radius": plain(own["radius"])}
        seconds, picture = self.povray_picture(folder, declared)
        return seconds, picture - self.povray_direct(folder) if scene.direct else picture

    def run_mitsuba(self, scene, setting, own, seed):
        folder, out = self.exported(scene, setting, "mitsuba"), self.work / "mitsuba.npz"
        depth = scene.text.get("depth", DEPTH)
        self.timed([self.mitsuba, HERE / "mitsuba_trial.py", folder / "scene.xml", own["variant"], own["spp"], seed, depth, own.get("roulette", DEPTH),
                    int(scene.direct), out])
        with np.load(out) as kept:
            return float(kept["cpu_s"]), kept["caustic"] / DARK

    def run_splat(self, scene, setting, own, seed):
        seconds, picture = self.splat_picture(scene, own["samples"], seed)
        return seconds, picture * contest.lamp(scene.resolved())[1]

    def splat_picture(self, scene, samples, seed):
        program, out = self.work / "splat", self.work / "splat.bin"
        if not program.exists():
            self.timed([self.compiler, "-std=c++20", "-O3", "-march=native", "-o", program, HERE / "splat.cpp"])
        numbers = " ".join(map(repr, contest.splat_numbers(scene)))
        seconds = self.timed([program, scene.shape, samples, seed, out], given=numbers)
        width, height = scene.size
        return seconds, np.fromfile(out, np.float32).reshape(height, width).astype(np.float64)

    def timed(self, command, cwd=None, given=""):
        """CPU seconds of a process, as the system counts them when it ends."""
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (self.longest, self.longest + 5))
        source, log = self.work / "given.txt", self.work / "log.txt"
        source.write_text(given, encoding="utf-8")
        with open(source, encoding="utf-8") as stdin, open(log, "wb") as output:
            process = subprocess.Popen([str(word) for word in command], cwd=cwd, stdin=stdin, stdout=output, stderr=output, preexec_fn=limit)
            _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = used.ru_utime + used.ru_stime
        if process.returncode != 0:
            if process.returncode == -signal.SIGXCPU or seconds > 0.95 * self.longest:
                raise TooLong
            last = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()[-1:]
            raise ChildProcessError(f"{pathlib.Path(command[0]).name}: exit code {process.returncode}: {' '.join(last)}")
        return seconds


def plain(value):
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)


def sets(scene, setting):
    return [word for pointer, value in scene.all_set(setting).items() for word in ("--set", f"{pointer}={json.dumps(value)}")]


def povray_options(text, scene):
    """Jitter, a caster that may be black, and on the pools no photons up from the water: all to POV-Ray's gain."""
    text, jittered = re.subn(r"(\n  photons \{\n)", r"\1    #ifdef (Photon_Jitter) jitter Photon_Jitter #end\n", text, count=1)
    caster = r"(  texture \{[^\n]*\n(?:  interior [^\n]*\n)?  photons \{ target[^\n]*\n)"
    black = "  #ifdef (Caster_Black) texture { pigment { rgb 0 } finish { ambient 0 diffuse 0 } }\n  #else\n"
    text, dark = re.subn(caster, rf"{black}\1  #end\n", text, count=1)
    if scene.kind == "pool":
        text = text.replace("photons { target reflection on refraction on", "photons { target reflection off refraction on")
    if jittered != 1 or dark != 1:
        raise ChildProcessError(f"{scene.name}: the export to POV-Ray is not as this tool knows it")
    return text


def aimed_lamp(text, scene):
    """A spot light as wide as the caster in the point light's place; roulette and a sampler that serve light paths."""
    position, _ = contest.lamp(scene.resolved())
    axis, angle = contest.cone(scene.around, position)
    up = (1, 0, 0) if abs(axis[0]) < 0.9 else (0, 1, 0)
    text = aimed(text, scene.name, position, np.array(position) + axis, up, angle, 0.9999 * angle)
    text = text.replace('name="rr_depth" value="$max_depth"', 'name="rr_depth" value="$roulette"')
    text = text.replace('<default name="spp"', '<default name="roulette" value="18"/>\n  <default name="spp"')
    return independent(text)
