#!/usr/bin/env python3
"""Prints the lines of each reader of files that fuzzing reached. Reads llvm-cov export -summary-only."""
import json
import sys

READERS = """
core/picture/picture_file.cpp core/picture/exr_file.cpp core/picture/exr_header.cpp core/picture/png_file.cpp
core/base/printable.cpp
core/scene_file/json_document.cpp core/scene_file/json_reader.cpp core/scene_file/values.cpp
core/scene/scene_reader.cpp core/scene/shape_reader.cpp core/scene/scene_frame.cpp core/material/bsdf_reader.cpp
core/material/ior_reader.cpp core/material/texture_reader.cpp core/material/texture.cpp core/shapes/cut_shape.cpp
core/shapes/heightfield_shape.cpp core/shapes/lathe_shape.cpp core/exact_shapes/shape_keys.cpp
core/geometry/profile_curve.cpp core/geometry/cut_solid.cpp core/geometry/polytope.cpp core/lights/light.cpp
core/lights/spot_light.cpp core/lights/point_light.cpp core/lights/directional_light.cpp core/mesh/ply_file.cpp
core/mesh/ply_mesh.cpp core/mesh/obj_mesh.cpp core/mesh/mesh_io.cpp core/mesh/vertex_normals.cpp
core/math/polygon.cpp core/render/film.cpp core/method/parameter.cpp photonmap/photons/photon_map_file.cpp
experiments/base/bounded_json.cpp experiments/base/csv.cpp experiments/base/number_option.cpp
experiments/cli/command_line.cpp experiments/cli/explain.cpp experiments/plan/plan_file.cpp
experiments/plan/record.cpp experiments/plan/sweep_file.cpp experiments/plan/sweep_plan.cpp
experiments/plan/trial_store.cpp experiments/report/table_index.cpp experiments/report/trial_rows.cpp
experiments/run/method.cpp experiments/run/cli_options.cpp experiments/run/probe.cpp experiments/sweep/merge.cpp
""".split()


def main():
    files = json.load(sys.stdin)["data"][0]["files"]
    print("| reader | lines | reached |\n|---|--:|--:|")
    for reader in READERS:
        for file in files:
            if file["filename"].endswith("/" + reader):
                lines = file["summary"]["lines"]
                print(f"| `{reader}` | {lines['count']} | {lines['percent']:.1f} % |")


if __name__ == "__main__":
    main()
