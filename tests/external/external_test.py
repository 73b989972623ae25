"""Exports scenes, has another renderer draw them, and scores its pictures by `causticbench compare`.

Usage: external_test.py mitsuba|povray PROGRAM PYTHON     (PYTHON: one that has Mitsuba)

Exit code 77 where the renderer is not installed. tools/crosscheck.py does the same with statistics.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCENES = pathlib.Path(__file__).resolve().parents[2] / "experiments" / "scenes" / "crosscheck"
RENDER_MITSUBA = """
import sys, mitsuba
mitsuba.set_variant("scalar_rgb")
mitsuba.set_log_level(mitsuba.LogLevel.Error)
to, integrator, spp, *scenes = sys.argv[1:]
picture = 0
for seed, scene in enumerate(scenes, 1):
    picture += mitsuba.render(mitsuba.load_file(scene, integrator=integrator), spp=int(spp), seed=seed)
mitsuba.Bitmap(picture).write(to)
"""
# Scene; integrator and samples a pixel, or what POV-Ray is told; how far the ratio of the means may be off, and how
# large relmse may be, which tells a picture that is turned round. Both are mostly the noise of one small picture.
MITSUBA = [
    ("plain_checker", "path", "64", 0.004, 0.02),
    ("plain_two", "path", "64", 0.01, 0.02),
    ("plain_mesh", "path", "64", 0.004, 0.02),
    ("ring_point", "ptracer", "600", 0.02, 0.03),
    ("pool_area", "ptracer", "1000", 0.02, 0.1),
    ("ball_area", "ptracer", "600", 0.02, 0.15),
    ("ball_flint", "ptracer", "60", 0.02, 0.15),  # a scene for each wavelength
]
# Scenes that are others, changed.
CHANGED = {"ball_flint": ("ball_area", "--set", '/ball/bsdf/int_ior={"type": "sellmeier", "material": "sf10"}')}
POVRAY = [
    ("plain_checker", [], 0.004, 0.01),
    ("plain_sun", [], 0.004, 0.01),
    ("plain_mesh", [], 0.004, 0.01),
    ("ball_point", ["Declare=Photon_Radius=0.01"], 0.03, 0.02),
    ("pool_point", ["Declare=Photon_Radius=0.02", "Declare=Photon_Count=1000000"], 0.03, 0.02),
]


def run(*command, **more):
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL, **more)


def scene_of(name):
    """The words that name a scene: its file, and a change."""
    return [SCENES / f"{CHANGED.get(name, (name,))[0]}.json", *CHANGED.get(name, (name,))[1:]]


def ours(program, scene, picture):
    method = ["none"] if scene.startswith("plain") else ["lighttrace", "--param", "paths=1000000"]
    run(program, "render", *scene_of(scene), "--method", *method, "--spp", 64, "-o", picture, stderr=subprocess.DEVNULL)


def mitsuba(program, python, folder, scene, integrator, samples):
    more = ["--wavelengths", 16] if scene in CHANGED else []
    run(program, "export", *scene_of(scene), "--to", "mitsuba", *more, "-o", folder, stderr=subprocess.DEVNULL)
    run(python, "-c", RENDER_MITSUBA, folder / "theirs.exr", integrator, samples, *sorted(folder.glob("scene*.xml")))
    return folder / "theirs.exr"


def povray(program, folder, scene, declared):
    run(program, "export", SCENES / f"{scene}.json", "--to", "povray", "-o", folder,
        "--set", "/sensor/sampler/sample_count=64", stderr=subprocess.DEVNULL)
    run("povray", "scene.ini", *declared, cwd=folder, stderr=subprocess.DEVNULL)
    return folder / "scene.exr"


def scored(program, theirs, reference):
    answer = subprocess.run([program, "compare", str(theirs), str(reference), "--json"], check=True,
                            capture_output=True, text=True).stdout
    metrics = json.loads(answer)["metrics"]
    return abs(metrics["mean_ratio"] - 1), metrics["relmse"]


def missing(renderer, python):
    if renderer == "povray":
        return None if shutil.which("povray") else "povray is not installed (apt-get install povray)"
    try:
        found = subprocess.run([python, "-c", "import mitsuba"], capture_output=True).returncode == 0
    except OSError:
        found = False
    return None if found else f"{python} has no Mitsuba (pip install -r tools/crosscheck-requirements.txt)"


def main():
    renderer, program, python = sys.argv[1:]
    reason = missing(renderer, python)
    if reason:
        print(f"skipped: {reason}")
        sys.exit(77)
    failed = 0
    with tempfile.TemporaryDirectory() as work:
        for scene, *how, most_off, most_relmse in MITSUBA if renderer == "mitsuba" else POVRAY:
            folder = pathlib.Path(work) / scene
            theirs = mitsuba(program, python, folder, scene, *how) if renderer == "mitsuba" else povray(program, folder, scene, *how)
            ours(program, scene, folder / "ours.exr")
            off, relmse = scored(program, theirs, folder / "ours.exr")
            bad = off > most_off or relmse > most_relmse
            failed += bad
            print(f"{'FAILED' if bad else 'ok':6} {scene}: mean off by {off:.4f} (to {most_off}), "
                  f"relmse {relmse:.4g} (to {most_relmse})")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
