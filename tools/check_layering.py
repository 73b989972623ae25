#!/usr/bin/python3
"""Reads the #include lines of the sources and fails on an arrow that ARCHITECTURE.md does not draw, on a
circle of folders or of units (a .h and its .cpp), on a wrong namespace, and on a folder that is too full or
has no README.md.

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
# The one file that names all methods, what describes a photon map's file, and what draws beams.
EXCEPTIONS = {
    "experiments/run/methods.cpp": ["photonmap", "beamtree"],
    "experiments/picture/beam_picture.cpp": ["beamtree"],
    "experiments/cli/map_info.h": ["photonmap"],
    "experiments/cli/map_info.cpp": ["photonmap"],
}
# Header prefix -> the files or folders that may include it. fmt, Eigen and the standard library are free.
LIBRARIES = {
    "embree3/": ["core/scene/intersector.cpp", "tests/bench/"],
    "embree4/": ["core/scene/intersector.cpp", "tests/bench/"],
    "OpenImageIO/": ["core/picture/openimageio_source.cpp"],
    "OpenEXR/": ["core/picture/exr_file.cpp"],
    "png.h": ["core/picture/png_file.cpp", "tests/support/png_kinds.cpp"],
    "nlohmann/": ["core/scene_file/json_reader.h", "core/scene_file/json_reader.cpp", "core/scene_file/json_document.h", "core/scene_file/json_document.cpp",
                  "experiments/", "tests/"],
    "tbb/": ["core/base/parallel.cpp"],
    "oneapi/": ["core/base/parallel.cpp"],
    "CLI/": ["experiments/", "tests/experiments/"],
    "build_info.h": ["experiments/", "tests/experiments/"],
    "benchmark/": ["tests/bench/"],
    "nanoflann.hpp": ["tests/bench/"],
    "gtest/": ["tests/"],
    "gmock/": ["tests/"],
}
MOST_FILES, MOST_NOUNS, MOST_README_LINES = 40, 25, 15
# Folders of like things, and those whose README holds the rows of a paper.
FLAT = {"tests/agreement"}
ROOMS_WITH_ROWS = {"photonmap", "beamtree"}
SUFFIXES = {".h", ".hpp", ".cpp", ".inl"}
NAMESPACES = {"photonmap": "caustics::photonmap", "beamtree": "caustics::beamtree",
              "experiments": "caustics::experiments"}
OPENED = re.compile(r"^(?:inline )?namespace (caustics[\w:]*) \{")
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


def read_includes(root):
    """Yields (source, line's number, quote, header) of every #include of the tree at root."""
    for top in sorted({layer.split("/")[0] for layer in LAYERS}):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file():
                source = path.relative_to(root).as_posix()
                yield source, 0, None, None
                for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                    if match := INCLUDE.match(line):
                        yield source, number, *match.groups()


def unit(path):
    """A header and what implements it are one unit."""
    return path.rpartition(".")[0]


def noun(path):
    """What a file is about: its test is about the same, and so is each instruction set's file."""
    return re.sub(r"(_plain|_avx2|_avx512|_test)?\.\w+$", "", path)


def circle(arrows):
    """Nodes that a graph {node: set of nodes} leads round in, in their order; empty when there is none."""
    done, way = set(), []

    def visit(node):
        if node in way:
            return way[way.index(node):] + [node]
        if node in done:
            return []
        way.append(node)
        found = next(filter(None, map(visit, sorted(arrows.get(node, ())))), [])
        way.pop()
        done.add(node)
        return found

    return next(filter(None, map(visit, sorted(arrows))), [])


def crowds(files):
    """What is wrong with the number of files and nouns in each folder."""
    for folder in sorted({path.rpartition("/")[0] for path in files}):
        inside = [path for path in files if path.rpartition("/")[0] == folder]
        nouns = {noun(path) for path in inside}
        if folder not in FLAT and (len(inside) > MOST_FILES or len(nouns) > MOST_NOUNS):
            yield f"{folder}: {len(inside)} files, {len(nouns)} nouns: more than {MOST_FILES}, {MOST_NOUNS}"


def unexplained(root, files):
    """Folders of sources, tests apart, without a README.md of at most so many lines."""
    for folder in sorted({path.rpartition("/")[0] for path in files if not path.startswith("tests/")}):
        readme = root / folder / "README.md"
        if not readme.is_file():
            yield f"{folder}: no README.md that says what it knows"
            continue
        text = readme.read_text(encoding="utf-8")
        if folder not in ROOMS_WITH_ROWS and len(text.splitlines()) > MOST_README_LINES:
            yield f"{folder}/README.md: more than {MOST_README_LINES} lines"
        inside = {noun(path).rpartition("/")[2] for path in files if path.rpartition("/")[0] == folder}
        for name in sorted(inside - set(re.findall(r"`(\w+)`", text))):
            yield f"{folder}/README.md: says nothing of {name}"


def check(root):
    """(files read, list of 'file:line: include: reason', other complaints) of the tree at root."""
    wrong, files = [], set()
    folders, units = {}, {}
    for source, number, quote, header in read_includes(root):
        files.add(source)
        if header is None:
            continue
        if reason := complaint(root, source, quote, header):
            wrong.append(f"{source}:{number}: {header}: {reason}")
        elif layer_of(header):
            if unit(source) != unit(header):
                units.setdefault(unit(source), set()).add(unit(header))
            here, there = source.rpartition("/")[0], header.rpartition("/")[0]
            if here != there and not here.startswith("tests/"):
                folders.setdefault(here, set()).add(there)
    others = [f"circle of {kind}: {' -> '.join(found)}"
              for kind, graph in (("folders", folders), ("units", units)) if (found := circle(graph))]
    return files, wrong, others


def strays(root, files):
    """Namespaces opened in a top-level folder that has its own; what core declares may be named first."""
    for source in sorted(files):
        own = NAMESPACES.get(source.split("/")[0])
        if own is None:
            continue
        opened = [match[1] for line in (root / source).read_text(encoding="utf-8").splitlines()
                  if (match := OPENED.match(line))]
        if opened and not any((name + "::").startswith(own + "::") for name in opened):
            yield f"{source}: opens {', '.join(opened)}, not {own}"


def self_test():
    """Every planted wrong arrow must be found, and no right one."""
    right = [
        ("core/scene/scene.cpp", '"core/math/vec.h"'), ("core/scene/intersector.cpp", "<embree4/rtcore.h>"),
        ("core/reference/path_trace.cpp", '"core/scene/scene.h"'), ("core/math/vec.h", "<Eigen/Core>"),
        ("photonmap/photons/photon.h", '"core/math/vec.h"'), ("experiments/run/methods.cpp", '"photonmap/photon_map.h"'),
        ("experiments/cli/main.cpp", '"build_info.h"'), ("tests/core/a_test.cpp", '"tests/support/a.h"'),
        ("tests/agreement/a_test.cpp", '"photonmap/photon_map.h"'), ("tests/core/b.cpp", "<gtest/gtest.h>"),
        ("tests/photonmap/a_test.cpp", '"neighbour.h"'), ("tests/photonmap/neighbour.h", "<vector>"),
    ]
    circles = [
        ("core/math/one.h", '"core/math/two.h"'), ("core/math/two.cpp", '"core/math/one.h"'),
        ("core/render/high.h", '"core/math/low.h"'), ("core/math/low.h", '"core/render/other.h"'),
    ]
    planted = [
        ("core/scene/scene.cpp", '"photonmap/photons/photon.h"'), ("core/render/film.cpp", '"experiments/plan/record.h"'),
        ("photonmap/photons/photon.h", '"beamtree/beams/beam.h"'), ("beamtree/beams/beam.h", '"photonmap/photons/photon.h"'),
        ("photonmap/kd_tree.cpp", '"experiments/base/stopwatch.h"'), ("experiments/sweep/sweep.cpp", '"photonmap/photons/photon.h"'),
        ("core/scene/camera.cpp", "<embree3/rtcore.h>"), ("photonmap/a.cpp", "<nlohmann/json.hpp>"),
        ("core/scene/scene.h", "<OpenImageIO/imageio.h>"), ("core/math/rng.cpp", "<CLI/CLI.hpp>"),
        ("core/mesh/mesh.cpp", '"build_info.h"'), ("core/mesh/mesh.cpp", '"tests/support/a.h"'),
        ("tests/core/a_test.cpp", '"photonmap/photons/photon.h"'), ("tests/photonmap/b_test.cpp", '"beamtree/beams/beam.h"'),
        ("photonmap/b.cpp", '"../beamtree/beams/beam.h"'), ("core/material/optics.cpp", "<photonmap/photons/photon.h>"),
        ("core/scene/light.cpp", '"nowhere.h"'), ("photonmap/c.cpp", "  #  include <tbb/parallel_for.h>"),
    ]
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        for name, header in right + circles + planted:
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            line = header if "include" in header else f"#include {header}"
            with open(root / name, "a", encoding="utf-8") as file:
                file.write(line + "\n")
        _, wrong, others = check(root)
        (root / "photonmap/stray.h").write_text("namespace caustics {\n}\n", encoding="utf-8")
        (root / "photonmap/home.h").write_text("namespace caustics {\nclass Film;\n}\n\n"
                                               "namespace caustics::photonmap {\n}\n", encoding="utf-8")
        strayed = list(strays(root, {"photonmap/stray.h", "photonmap/home.h"}))
        missed = [] if any("circle of units" in line for line in others) and any(
            "circle of folders" in line for line in others) else ["self-test: a planted circle went unseen"]
    if len(strayed) != 1:
        missed.append(f"self-test: one header opens a wrong namespace, {len(strayed)} found")
    found = {(line.split(":")[0], line.split(": ")[1]) for line in wrong}
    expected = {(name, re.search(r'[<"](.+)[>"]', header).group(1)) for name, header in planted}
    for line in missed:
        print(line)
    for name, header in sorted(expected - found):
        print(f"self-test: {name}: {header}: a wrong arrow went unseen")
    for name, header in sorted(found - expected):
        print(f"self-test: {name}: {header}: a right arrow was refused")
    print(f"self-test: {len(expected & found)} of {len(expected)} planted wrong arrows found")
    return 0 if found == expected and not missed else 1


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if len(arguments) > 1 or arguments and arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent
    files, wrong, others = check(root)
    if not files:
        print(f"check_layering: no sources under {root}", file=sys.stderr)
        return 2
    scripts = {path.relative_to(root).as_posix() for path in (root / "tools").rglob("*.py")}
    others += [*crowds(files | scripts), *unexplained(root, files | scripts), *strays(root, files)]
    for line in wrong + others:
        print(line)
    print(f"check_layering: {len(files)} files, {len(wrong)} wrong arrows, {len(others)} other complaints")
    return 1 if wrong or others else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
