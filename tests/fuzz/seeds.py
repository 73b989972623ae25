#!/usr/bin/env python3
"""Writes first inputs for the fuzzers of tests/fuzz, from the scenes and sweeps of the tree and small files of
every format.

Usage: seeds.py FOLDER      FOLDER/scene/*, FOLDER/ply/*, ...
"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIG_KEYS = {"resolution": 8, "segments": 4, "levels": 3, "split_depth": 1, "mesh_resolution": 8, "photons": 500,
            "emitted": 500, "paths": 500, "spp": 4, "repeats": 2, "receiver_resolution": 8, "count": 8}


def inlined(value, folder):
    """A scene without the files it names: those it includes in their places, others by what the fuzzer has."""
    if isinstance(value, list):
        return [inlined(each, folder) for each in value]
    if not isinstance(value, dict):
        return value
    if "$include" in value:
        file = folder / value["$include"]
        return inlined(json.loads(file.read_text(encoding="utf-8")), file.parent)
    result = {}
    for key, child in value.items():
        if key == "filename":
            ending = pathlib.Path(child).suffix
            child = {".ply": "mesh.ply", ".obj": "mesh.obj", ".exr": "heights.exr"}.get(ending, "texture.png")
        elif key in BIG_KEYS:
            child = smaller(child, BIG_KEYS[key])
        result[key] = inlined(child, folder)
    return result


def smaller(value, most):
    if isinstance(value, list):
        return [smaller(each, most) for each in value[:3]]
    return min(value, most) if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def scenes():
    for file in sorted((ROOT / "experiments").glob("**/scenes/**/*.json")):
        value = json.loads(file.read_text(encoding="utf-8"))
        yield file.stem, json.dumps(inlined(value, file.parent)).encode()


def sweeps():
    for file in sorted((ROOT / "experiments").glob("**/sweeps/*.json")):
        value = inlined(json.loads(file.read_text(encoding="utf-8")), file.parent)
        value["scenes"] = ["small.json"]
        for axis in value.get("set", {}).values():
            axis["pointer"] = "/ball/radius"
        yield file.stem, json.dumps(value).encode()
    yield "all", json.dumps({
        "version": 1, "scenes": ["small.json"], "seeds": [1, 2], "repeats": 2, "spp": 4, "threads": 2,
        "set": {"r": {"pointer": "/ball/radius", "values": [0.5, 0.25]}},
        "methods": [{"method": "photonmap", "param": {"photons": [100, 200], "tree": "packed"}},
                    {"method": "beamtree", "param": {"mesh_resolution": 4}}],
        "indirect": [{"method": "none"}],
        "reference": {"method": "lighttrace", "param": {"paths": 100}, "spp": 4, "seed": 3}}).encode()


CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)]
FACES = [(0, 1, 2, 3), (0, 1, 4), (1, 2, 4)]


def plies():
    head = "ply\nformat {} 1.0\ncomment c\nelement vertex 5\n{}element face 3\nproperty list uchar int {}\nend_header\n"
    xyz = "property float x\nproperty float y\nproperty float z\n"
    ascii_rows = "".join(f"{x} {y} {z}\n" for x, y, z in CORNERS)
    ascii_faces = "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in FACES)
    yield "ascii", (head.format("ascii", xyz, "vertex_indices") + ascii_rows + ascii_faces).encode()
    more = xyz + "property double nx\nproperty double ny\nproperty double nz\nproperty float u\nproperty float v\n"
    rows = "".join(f"{x} {y} {z} 0 0 1 {x} {y}\n" for x, y, z in CORNERS)
    yield "normals", (head.format("ascii", more, "vertex_index") + rows + ascii_faces).encode()
    for name, order in (("little", "<"), ("big", ">")):
        data = b"".join(struct.pack(order + "3f", *corner) for corner in CORNERS)
        data += b"".join(struct.pack(f"{order}B{len(face)}i", len(face), *face) for face in FACES)
        yield name, head.format(f"binary_{name}_endian", xyz, "vertex_indices").encode() + data
    extra = ("ply\nformat ascii 1.0\nobj_info o\nelement material 1\nproperty uchar red\nelement vertex 3\n" + xyz +
             "property list uchar float weights\nproperty float s\nproperty float t\nelement face 1\n"
             "property list uint8 uint32 vertex_indices\nproperty short flags\nelement edge 1\nproperty int a\n"
             "end_header\n7\n0 0 0 2 1 1 0 0\n1 0 0 0 1 0\n0 1 0 1 3 0 1\n3 0 1 2 5\n4\n")
    yield "elements", extra.encode()


def objs():
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS)
    yield "plain", (corners + "f 1 2 3 4\nf 1 2 5\n").encode()
    yield "full", ("mtllib a.mtl\no a\ng b\ns 1\n" + corners + "vt 0 0\nvt 1 0\nvt 1 1 0\nvn 0 0 1\nvn 0 1 0\n"
                   "usemtl m\nf 1/1/1 2/2/1 3/3/2\nf 1//1 2//2 5//1\nf -1/1 -2/2 -3/3\nl 1 2\np 1\n").encode()
    yield "words", (b"v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\r\nv 1e-3 1.25E+2 .5 # c\nv -0 12345678901234567890 1\n"
                    b"f 1 2 \\\n 3\nf 1 2 4\n")


def fnv1a(data):
    state = 0xCBF29CE484222325
    for byte in data:
        state = (state ^ byte) * 0x100000001B3 % (1 << 64)
    return state


def photon_maps():
    photons = b"".join(struct.pack("<3f4B2BH", 0.1 * i, -0.2, 1, 130, 120, 110, 128 + i, 40 * i, 90, 4 * i)
                       for i in range(5))
    for version, words, counts in ((2, 3, 12), (3, 3, 13), (4, 5, 13)):
        header = struct.pack("<2Q", 12345, 1) + struct.pack(f"<{words}I", *((0, 1, 16, 0, 0)[:words]))
        numbers = [100, 90, 0, 5, 5, 1, 1, 1, 0, 0, 5, 0, 0][:counts]
        header += struct.pack(f"<{counts}Q", *numbers) + struct.pack("<3f", 1, 2, 0.5) + b"causticbench render"
        data = b"causticbench photon map\n" + struct.pack("<2I", version, len(header)) + header
        data += struct.pack("<Q", 5) + photons
        yield f"version{version}", data + struct.pack("<Q", fnv1a(data))


def png(width, height, depth, colour, rows):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    palette = chunk(b"PLTE", bytes(range(12))) if colour == 3 else b""
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, depth, colour, 0, 0, 0)) +
            palette + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def pictures():
    for name, depth, colour, size in (("grey8", 8, 0, 3), ("grey16", 16, 0, 6), ("rgb8", 8, 2, 9), ("rgba8", 8, 6, 12),
                                      ("palette", 8, 3, 3), ("rgb16", 16, 2, 18), ("bits", 1, 0, 1)):
        rows = b"".join(b"\x00" + bytes((40 * y + x) % (4 if colour == 3 else 256) for x in range(size))
                        for y in range(2))
        yield name, png(3, 2, depth, colour, rows)
    if shutil.which("oiiotool") is None:
        return
    folder = pathlib.Path(sys.argv[1])
    made = folder / "made.exr"
    for options in ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "tiled", "half"):
        line = ["oiiotool", "--pattern", "fill:topleft=0,0,0:bottomright=1,0.5,0.2", "7x5", "3"]
        line += ["--tile", "4", "4"] if options == "tiled" else []
        line += ["-d", "half"] if options == "half" else ["-d", "float"]
        line += [] if options in ("tiled", "half") else ["--compression", options]
        if subprocess.run([*line, "-o", made], check=False, capture_output=True).returncode == 0:
            yield options, made.read_bytes()
    made.unlink(missing_ok=True)


def points():
    yield "plain", b"x,y,z,nx,ny,nz\n0,0,-1,0,0,1\n0.5,-0.25,-1,0,0,2\n"
    yield "viewers", b"nx,ny,nz,x,y,z,wx,wy,wz,radius\r\n0,0,1,0,0,-1,0,-1,1,0.5\r\n0,0,1,+1,1e0,-1,0,0,1,0.1\r\n"
    yield "wrong", b"x,y,z,nx,ny,nz\n1e19,0,0,0,0,1\n0,0,-1,0,0,nan\n"


def lines():
    for i, line in enumerate((
            "render small.json --method photonmap --param photons=100 --set /ball/radius=0.25 --spp 4 --seed 7 -o a.exr",
            "probe small.json --method none --points p.csv -o out.csv --threads 2 --isa plain",
            "sweep a.json b.json -o out --filter seed=1 --shard 2/5 --timeout 1.5 --memory 100 --jobs 2 --rerun failed",
            "compare a.exr b.exr --json --layer caustic --mask m.exr", "merge a b -o c", "explain out trial",
            "verify --gallery", "export small.json --to mitsuba -o x", "help scene", "info small.json --version",
            "photons=1000 nearest=20 tree=packed filter=cone filter_k=1.5 passes=2", "bound=two_slice leaf=\"n\"",
            "/ball/radius=1 /lamp/intensity=[1,2,3] /floor/bsdf={\"type\":\"phong\"}", "1/1 3/2 auto 02/3")):
        yield str(i), line.replace(" ", "\n").encode()


def folders():
    plan = {"version": 1, "sweeps": ["/tmp/sweep.json"], "filters": [], "started_in": "/tmp", "swept": ["alpha"],
            "trials": [{"trial": "a", "cell": "x", "seed": 1, "chosen": True},
                       {"trial": "b", "cell": "y", "seed": 2, "chosen": False}]}
    record = {"version": 1, "trial": "a", "status": "done", "seed": 1, "repeat": 1, "threads": 1, "isa": "plain",
              "spp": 1, "config_hash": "0" * 16, "code_version": "x", "machine": {"host": "h", "cpu": "c"},
              "picture_hash": "0123456789abcdef", "swept": {"alpha": 0.5},
              "scene": {"name": "small", "file": "small.json", "hash": "0" * 16, "set": {"/ball/radius": "0.5"}},
              "method": {"name": "none", "parameters": {}}, "metrics": {"rmse": 0.5, "pixels": 16},
              "counters": {"photons_emitted": 5}, "seconds": {"total": {"wall": 1.5, "cpu": 1}}}
    failed = {**record, "trial": "b", "status": "failed", "message": "=1+1"}
    table = {"code_version": "x", "complete": True, "csv": "0", "jsonl": "0", "rows": [["a", "1 2", 3]],
             "variances": {"x": ["0", 0.5]}}
    folder = {"plan.json": plan, "trials/a/record.json": record, "trials/b/record.json": failed, ".table": table,
              "environment.json": {"commit": "x"}, "records.csv": "trial\n", "records.jsonl": "{}\n"}
    yield "whole", json.dumps(folder).encode()
    yield "no_table", json.dumps({key: folder[key] for key in list(folder)[:3]}).encode()
    yield "text", json.dumps({"plan.json": json.dumps(plan)[:-9], "trials/a/record.json": "{"}).encode()


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    makers = {"scene": scenes, "sweep": sweeps, "ply": plies, "obj": objs, "photon_map": photon_maps,
              "picture": pictures, "points": points, "command_line": lines, "folder": folders}
    for target, make in makers.items():
        folder = pathlib.Path(sys.argv[1]) / target
        folder.mkdir(parents=True, exist_ok=True)
        for name, data in make():
            (folder / f"seed-{name}").write_bytes(data)


if __name__ == "__main__":
    main()
