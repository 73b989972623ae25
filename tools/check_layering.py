#!/usr/bin/python3
"""Reads the #include lines of the sources and fails on an arrow that ARCHITECTURE.md does not draw.

Usage: check_layering.py [ROOT]     check the tree at ROOT (default: the folder above this one)
       check_layering.py --self-test   plant wrong arrows in a scratch tree and see each one found
"""
import pathlib
import re
import sys
import tempfile

# Layer -> layers it may include, besides itself. A file belongs to the longest layer it lies under.
LAYERS = {
    "core": [],
    "photonmap": ["core"],
    "beamtree": ["core"],
    "experiments": ["core"],
    "tests/support": ["core"],
    "tests/core": ["core", "tests/support"],
    "tests/photonmap": ["core", "photonmap", "tests/support"],
    "tests/beamtree": ["core", "beamtree", "tests/support"],
    "tests/bench": ["core", "photonmap", "beamtree", "tests/support"],
    "tests": ["core", "photonmap", "beamtree", "experiments", "tests/support"],
}
# The one file that names all methods, what tells of a photon map's file, and what draws beams.
EXCEPTIONS = {
    "experiments/methods.h": ["photonmap", "beamtree"],
    "experiments/methods.cpp": ["photonmap", "beamtree"],
    "experiments/beam_picture.h": ["beamtree"],
    "experiments/beam_picture.cpp": ["beamtree"],
    "experiments/map_info.h": ["photonmap"],
    "experiments/map_info.cpp": ["photonmap"],
}
# Header prefix -> the files or folders that may include it. fmt, Eigen and the standard library are free.
LIBRARIES = {
    "embree3/": ["core/intersector.cpp", "tests/bench/"],
    "embree4/": ["core/intersector.cpp", "tests/bench/"],
    "OpenImageIO/": ["core/film.cpp", "core/picture_file.h", "core/picture_file.cpp", "tests/"],
    "assimp/": ["core/mesh_io.cpp"],
    "nlohmann/": ["core/json_reader.cpp", "core/json_document.h", "core/json_document.cpp",
                  "experiments/", "tests/"],
    "tbb/": ["core/parallel.cpp"],
    "oneapi/": ["core/parallel.cpp"],
    "CLI/": ["experiments/", "tests/experiments/"],
    "spdlog/": ["experiments/", "tests/experiments/"],
    "build_info.h": ["experiments/", "tests/experiments/"],
    "benchmark/": ["tests/bench/"],
    "nanoflann.hpp": ["tests/bench/"],
    "gtest/": ["tests/"],
    "gmock/": ["tests/"],
}
SUFFIXES = {".h", ".hpp", ".cpp", ".inl"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def layer_of(path):
    """The layer a path relative to the root lies in, or None."""
    found = [layer for layer in LAYERS if path.startswith(layer + "/")]
    return max(found, key=len, default=None)


def complaint(root, source, quote, header):
    """Why this include is wrong, or None."""
    for prefix, allowed in LIBRARIES.items():
        if header.startswith(prefix):
            fits = any(source == place or place.endswith("/") and source.startswith(place)
                       for place in allowed)
            return None if fits else f"{prefix} belongs to {', '.join(allowed)} only"
    if ".." in header.split("/"):
        return "includes start at the project's root, without '..'"
    if "/" not in header and (root / source).with_name(header).is_file():
        return None  # a neighbour in the same folder
    here, there = layer_of(source), layer_of(header)
    if there is None:
        return None if quote == "<" else "not a path from the project's root"
    allowed = [here, *LAYERS[here], *EXCEPTIONS.get(source, [])]
    return None if there in allowed else f"{here} may include {', '.join(allowed)}, not {there}"


def check(root):
    """(number of files read, list of 'file:line: include: reason') of the tree at root."""
    wrong = []
    files = 0
    for top in sorted({layer.split("/")[0] for layer in LAYERS}):
        for path in sorted((root / top).rglob("*")):
            if path.suffix not in SUFFIXES or not path.is_file():
                continue
            files += 1
            source = path.relative_to(root).as_posix()
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                reason = match and complaint(root, source, *match.groups())
                if reason:
                    wrong.append(f"{source}:{number}: {match.group(2)}: {reason}")
    return files, wrong


def self_test():
    """Every planted wrong arrow must be found, and no right one."""
    right = [
        ("core/scene.cpp", '"core/vec.h"'), ("core/intersector.cpp", "<embree4/rtcore.h>"),
        ("core/reference/path_trace.cpp", '"core/scene.h"'), ("core/vec.h", "<Eigen/Core>"),
        ("photonmap/photon.h", '"core/vec.h"'), ("experiments/methods.h", '"photonmap/photon_map.h"'),
        ("experiments/main.cpp", '"build_info.h"'), ("tests/core/a_test.cpp", '"tests/support/a.h"'),
        ("tests/agreement/a_test.cpp", '"photonmap/photon_map.h"'), ("tests/core/b.cpp", "<gtest/gtest.h>"),
        ("tests/photonmap/a_test.cpp", '"neighbour.h"'), ("tests/photonmap/neighbour.h", "<vector>"),
    ]
    planted = [
        ("core/scene.cpp", '"photonmap/photon.h"'), ("core/film.cpp", '"experiments/record.h"'),
        ("photonmap/photon.h", '"beamtree/beam.h"'), ("beamtree/beam.h", '"photonmap/photon.h"'),
        ("photonmap/kd_tree.cpp", '"experiments/stopwatch.h"'), ("experiments/sweep.cpp", '"photonmap/photon.h"'),
        ("core/camera.cpp", "<embree3/rtcore.h>"), ("photonmap/a.cpp", "<nlohmann/json.hpp>"),
        ("core/scene.h", "<OpenImageIO/imageio.h>"), ("core/rng.cpp", "<spdlog/spdlog.h>"),
        ("core/mesh.cpp", '"build_info.h"'), ("core/mesh.cpp", '"tests/support/a.h"'),
        ("tests/core/a_test.cpp", '"photonmap/photon.h"'), ("tests/photonmap/b_test.cpp", '"beamtree/beam.h"'),
        ("photonmap/b.cpp", '"../beamtree/beam.h"'), ("core/optics.cpp", "<photonmap/photon.h>"),
        ("core/light.cpp", '"nowhere.h"'), ("photonmap/c.cpp", "  #  include <tbb/parallel_for.h>"),
    ]
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        for name, header in right + planted:
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            line = header if "include" in header else f"#include {header}"
            with open(root / name, "a", encoding="utf-8") as file:
                file.write(line + "\n")
        _, wrong = check(root)
    found = {(line.split(":")[0], line.split(": ")[1]) for line in wrong}
    expected = {(name, re.search(r'[<"](.+)[>"]', header).group(1)) for name, header in planted}
    for name, header in sorted(expected - found):
        print(f"self-test: {name}: {header}: a wrong arrow went unseen")
    for name, header in sorted(found - expected):
        print(f"self-test: {name}: {header}: a right arrow was refused")
    print(f"self-test: {len(expected & found)} of {len(expected)} planted wrong arrows found")
    return 0 if found == expected else 1


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if len(arguments) > 1 or arguments and arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent
    files, wrong = check(root)
    if files == 0:
        print(f"check_layering: no sources under {root}", file=sys.stderr)
        return 2
    for line in wrong:
        print(line)
    print(f"check_layering: {files} files, {len(wrong)} wrong arrows")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
