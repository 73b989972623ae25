#!/usr/bin/env python3
"""Prints the lines of each reader of files that fuzzing reached.

Usage: coverage.py PROFILE PROGRAM...       what llvm-profdata merged; the programs that ran
"""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# A file, and where it does other work as well, the functions of it that read.
READERS = {file: "" for file in """
core/picture/picture_file.cpp core/picture/exr_file.cpp core/picture/exr_header.cpp core/picture/png_file.cpp
core/base/printable.cpp core/base/decimal.cpp
core/scene_file/json_document.cpp core/scene_file/json_reader.cpp core/scene_file/values.cpp core/scene_file/strength.cpp
core/scene/scene_reader.cpp core/scene/shape_reader.cpp core/scene/scene_frame.cpp core/material/bsdf_reader.cpp
core/material/ior_reader.cpp core/material/texture_reader.cpp core/shapes/cut_shape.cpp
core/shapes/heightfield_shape.cpp core/shapes/lathe_shape.cpp core/exact_shapes/shape_keys.cpp
core/geometry/profile_curve.cpp core/geometry/cut_solid.cpp core/geometry/polytope.cpp core/mesh/ply_file.cpp
core/mesh/ply_mesh.cpp core/mesh/obj_mesh.cpp core/mesh/mesh_io.cpp core/mesh/vertex_normals.cpp
core/math/polygon.cpp core/method/parameter.cpp photonmap/photons/photon_map_file.cpp
experiments/base/bounded_json.cpp experiments/base/csv.cpp experiments/base/number_option.cpp
experiments/cli/command_line.cpp experiments/cli/explain.cpp experiments/plan/plan_file.cpp
experiments/plan/sweep_file.cpp experiments/plan/sweep_plan.cpp
experiments/report/table_index.cpp experiments/report/trial_rows.cpp experiments/sweep/merge.cpp
""".split()} | {
    "core/render/film.cpp": "read_exr|Film::plane",
    "core/material/texture.cpp": "load_bitmap|evaluate|Evaluate|folded|wrapped|texel|transformed|srgb",
    "core/lights/light.cpp": "read_light|light_types|light_keys",
    **{f"core/lights/{light}_light.cpp": "read|text" for light in ("spot", "point", "directional", "constant", "ambient", "area")},
    "core/material/dielectric.cpp": "read|text", "core/material/conductor.cpp": "read|text",
    "core/material/schlick.cpp": "read|text", "core/material/phong.cpp": "read|text", "core/material/diffuse.cpp": "read|text",
    "core/exact_shapes/sphere.cpp": "read|text", "core/exact_shapes/cylinder.cpp": "read|text",
    "experiments/plan/record.cpp": "places|place_of|is_|name_of|cell|flaw_of|column|record_row|json_line",
    "experiments/run/probe.cpp": "read_probe_list|fail_at|vector_at|direction_at",
    "experiments/run/method.cpp": "parse|parameters_node|describe|find_method|names",
    "experiments/plan/trial_store.cpp": "::record",
    "experiments/plan/sweep_selection.cpp": "parse_shard|slurm|array_task",
}


def ask(tool, *words):
    return subprocess.run([tool, *words], check=True, capture_output=True, text=True).stdout


def functions(exported):
    """For each file the names and line ranges of its functions."""
    found = {}
    names = ask("c++filt", *[each["name"].split(":")[-1] for each in exported]).splitlines()
    for each, name in zip(exported, names):
        first, _, last = each["regions"][0][:3]
        found.setdefault(each["filenames"][0], []).append((re.sub(r"\(.*", "", name.replace("(anonymous namespace)", "")), first, last))
    return found


def lines(shown):
    """For each file whether its lines were reached, of those that can be."""
    found = {}
    for file, text in re.findall(r"^(/.*):\n((?: .*\n)*)", shown, re.M):
        found[file] = {int(line): int(count != "0") for line, count in re.findall(r"^ +(\d+)\| +([\d.]+[kMGE]?)\|", text, re.M)}
    return found


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    words = ["-instr-profile", sys.argv[1], sys.argv[2], *[word for each in sys.argv[3:] for word in ("-object", each)]]
    sources = [str(ROOT / reader) for reader in READERS]
    ranges = functions(json.loads(ask("llvm-cov", "export", *words, "-skip-expansions", *sources))["data"][0]["functions"])
    reached = lines(ask("llvm-cov", "show", *words, *sources))
    print("| reader | lines | reached | not reached |\n|---|--:|--:|---|")
    for reader, chosen in READERS.items():
        file = str(ROOT / reader)
        wanted = [(first, last) for name, first, last in ranges.get(file, []) if not chosen or re.search(chosen, name)]
        inside = {line: count for line, count in reached.get(file, {}).items()
                  if not chosen or any(first <= line <= last for first, last in wanted)}
        missed = ", ".join(str(line) for line in sorted(inside) if not inside[line])
        if inside:
            print(f"| `{reader}` | {len(inside)} | {100 * sum(inside.values()) / len(inside):.1f} % | {missed} |")


if __name__ == "__main__":
    main()
