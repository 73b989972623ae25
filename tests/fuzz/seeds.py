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

import scene_seeds

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
    yield from scene_seeds.variants()


def sweeps():
    for file in sorted((ROOT / "experiments").glob("**/sweeps/*.json")):
        value = inlined(json.loads(file.read_text(encoding="utf-8")), file.parent)
        value["scenes"] = ["small.json"]
        for axis in value.get("set", {}).values():
            axis["pointer"] = "/ball/radius"
        yield file.stem, json.dumps(value).encode()
    whole = {
        "version": 1, "scenes": ["small.json"], "seeds": [1, 2], "repeats": 2, "spp": 4, "threads": 2,
        "set": {"r": {"pointer": "/ball/radius", "values": [0.5, 0.25]}},
        "methods": [{"method": "photonmap", "param": {"photons": [100, 200], "tree": "packed"}},
                    {"method": "beamtree", "param": {"mesh_resolution": 4}}],
        "indirect": [{"method": "none"}],
        "reference": {"method": "lighttrace", "param": {"paths": 100}, "spp": 4, "seed": 3}}
    yield "all", json.dumps(whole).encode()
    none = {"version": 1, "scenes": ["small.json"], "methods": [{"method": "none"}]}
    radius = {"pointer": "/ball/radius", "values": [0.5]}
    light = [{"method": "globalphotonmap", "param": {"photons": [50, 60], "nearest": 5}}]
    for i, part in enumerate((
            {"version": 2}, {"scenes": []}, {"scenes": ["none.json"]}, {"scenes": ["small.json", "other/small.json"]},
            {"set": {"a": radius, "b": radius}}, {"set": {"A b": radius}}, {"set": {"rmse": radius}}, {"set": {"photons": radius}},
            {"set": {"a": {"pointer": "/none/x", "values": [1]}}}, {"set": {f"a{k}": radius for k in range(101)}},
            {"set": {"a": {**radius, "values": []}}}, {"seeds": list(range(400)), "repeats": 300}, {"seeds": [-1]},
            {"seeds": list(range(20000)), "set": {f"a{k}": {"pointer": f"/x{k}", "values": [1]} for k in range(60)}}, {"repeats": 1000000000},
            {"methods": []}, {"methods": [{"method": "x"}]}, {"methods": [{"method": "none", "x": 1}]},
            {"methods": [{"method": "photonmap", "param": {"photons": []}}]}, {"methods": [{"method": "photonmap", "param": {"save": "x"}}]},
            {"methods": [{"method": "photonmap", "param": {"load": "none.map"}}]}, {"methods": [{"method": "photonmap", "param": {"photons": [10] * 2}}]},
            {"methods": [{"method": "photonmap", "param": {"photons": 10}}], "set": {"photons": radius}},
            {"indirect": light}, {"indirect": light, "reference": {"method": "lighttrace", "param": {"paths": 100}}},
            {"indirect": light, "reference": {"method": "lighttrace", "param": {"paths": 100}, "indirect": {"method": "lighttrace", "param": {"paths": 50}}}},
            {"indirect": light, "set": {"indirect_photons": radius}}, {"indirect": []}, {"indirect": [{"method": "globalphotonmap", "param": {"save": "x"}}]},
            {"reference": {"method": "pathtrace"}}, {"reference": {"method": "lighttrace", "param": {"paths": 100}, "seed": 1.5}}, {"spq": 1})):
        text = json.dumps({**none, **part}).encode()
        while fnv1a(text) % 4 != 0:  # of these the target makes plans
            text += b"\t"
        yield f"part-{i}", text


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


def exr_headers():
    """Pictures of one pixel by hand: what no tool writes."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    def header(width=0, channel=2, **more):
        window = struct.pack("<4i", 0, 0, width, 0)
        channels = b"Y\0" + struct.pack("<i4B2i", channel, 0, 0, 0, 0, 1, 1) + b"\0"
        texts = b"".join(attribute(name, kind, value) for name, (kind, value) in more.items())
        return (attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0") +
                attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) +
                attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) +
                attribute("screenWindowCenter", "v2f", bytes(8)) + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) +
                texts + b"\0")

    def file(head, flags=0, width=1):
        start = b"\x76\x2f\x31\x01" + struct.pack("<I", 2 | flags) + head
        return start + struct.pack("<Q2i", len(start) + 8, 0, 4 * width) + struct.pack("<f", 0.5) * width
    rec709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)
    yield "exr-one", file(header())
    yield "exr-whole-number", file(header(channel=0))
    yield "exr-wide", file(header(width=1 << 26))
    for name, white in (("rec709", rec709[7]), ("other", 0.4)):
        yield f"exr-{name}", file(header(chromaticities=("chromaticities", struct.pack("<8f", *rec709[:7], white))))
    yield "exr-text", file(header(comment=("string", b"text"), odd=("string", b"a\nb")))
    parts = header(name=("string", b"a"), type=("string", b"scanlineimage"), chunkCount=("int", struct.pack("<i", 1)))
    yield "exr-parts", file(parts + parts.replace(b"\1\0\0\0a", b"\1\0\0\0b") + b"\0", 0x1000)
    deep = header(name=("string", b"a"), type=("string", b"deepscanline"), chunkCount=("int", struct.pack("<i", 1)),
                  version=("int", struct.pack("<i", 1)), maxSamplesPerPixel=("int", struct.pack("<i", 1)))
    yield "exr-deep", file(deep, 0x800)


def pictures():
    for name, depth, colour, size in (("grey8", 8, 0, 3), ("grey16", 16, 0, 6), ("rgb8", 8, 2, 9), ("rgba8", 8, 6, 12),
                                      ("palette", 8, 3, 3), ("rgb16", 16, 2, 18), ("bits", 1, 0, 1)):
        rows = b"".join(b"\x00" + bytes((40 * y + x) % (4 if colour == 3 else 256) for x in range(size))
                        for y in range(2))
        yield name, png(3, 2, depth, colour, rows)
    yield "huge", png(1 << 16, 1 << 15, 8, 0, b"")
    for name, line in exr_headers():
        yield name, line
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
    head = "x,y,z,nx,ny,nz"
    for i, text in enumerate((
            "", "\ufeff" + head + "\n0,0,-1,0,0,1\n\n", head + "\n1e19,0,0,0,0,1\n", head + "\n0,0,-1,0,0,nan\n",
            head + "\n0,0,-1,0,0,x\n", head + "\n0,0,-1,0,0,1,2\n", head + "\n0,0,-1,0,0,0\n", head + "\n0,0,9,0,0,1\n",
            head + ",q\n", head + ",x\n", "x,y\n", head + ",wx\n0,0,-1,0,0,1,1\n", head + ",wx,wy,wz\n0,0,-1,0,0,1,0,0,-1\n",
            head + ",radius\n0,0,-1,0,0,1,0\n", head + "\n0.1,0.1,-1,0,0,-1\n", head + "\n0,0.5,0,0,1,0\n")):
        yield f"other-{i}", text.encode()


# What a method is asked by one word each, for all that have such a key.
ASSIGNMENTS = """preset=jensen1996 preset=chuangcheng1995 preset=x photons=1000 photons=0 photons=1e3 photons=1.5 emitted=100 nearest=20
nearest=1 filter=cone filter_k=1.5 filter=gaussian filter_beta=2 filter_alpha=0.9 tree=balanced tree="packed" tree=5 passes=2
estimator=raw radius=0.1 radius=0 radius=none max_radius=1 adaptive=true adaptive=1 footprint=0.1 pixel_footprint=true
load=none.map load=small.json save=a.map save=none/a.map tables=true emission=stratified interaction=split max_bounces=3 paths=100
resolution=4 mesh_resolution=4 light_samples=4 rest=photons intensity=area refine=2 spp=4 seed=-1 x=1 = photons"""


def lines():
    texts = [
        "render small.json --method photonmap --param photons=100 --set /ball/radius=0.25 --spp 4 --seed 7 -o a.exr -o b.png",
        "render small.json --indirect globalphotonmap --indirect-param photons=5 --exposure 1 --seconds 2.5 --work 1e5 -o a.exr",
        "render small.json --isa avx9 --threads 0", "render small.json --spp x -o a.bmp", "render", "render a b c",
        "probe small.json --method none --points p.csv -o out.csv --threads 2 --isa plain --layer caustic",
        "sweep a.json b.json -o out --filter seed=1 --shard 2/5 --timeout 1.5 --memory 100 --jobs 2 --rerun failed",
        "sweep a.json -o out --list --force --fail-fast --references rebuild --dry-run", "sweep a.json --timeout -1 --jobs 0",
        "compare a.exr b.exr --json --layer caustic --mask m.exr --strip s.png", "merge a b -o c", "explain out trial",
        "verify --gallery --method none", "export small.json --to mitsuba -o x --max-bounces 3 --wavelengths 5",
        "info small.json --scene s --beams b.obj --dot d.dot", "report out --tables --columns 3 --references --megabytes 5",
        "help scene", "help", "--help", "--version", "info --help", "--verb", "teapot", "info \xff", "info --set  a", "1/1 3/2 auto 02/3 1/0",
        "set /ball/radius=1 /lamp/intensity=[1,2,3] /floor/bsdf={\"type\":\"phong\"}", "set /ball={\"$include\":\"small.json\"}",
        "set /ball={\"$include\":\"small.json\"} /ball/x=1 /ball=1",
        "set /camera/to_world/0/look_at/origin/2=5 /camera/to_world/9=1", "set /camera/to_world/00=1", "set ball=1", "set /none/x=1",
        "set /ball/radius/x=1", "set /ball/bsdf/type=diffuse /floor/bsdf/reflectance=.5", "set /~2=1", "set =", "set /a~1b~0=[", "set",
        "slurm", "slurm 3 1 5 5", "slurm 0 0 4 5", "slurm 3 2 5 4",
        "slurm 6 1 5 5", "slurm x 1 5 5", "param", "param teapot", "indirect teapot", "indirect none x=1", "indirect globalphotonmap photons=100 nearest=5"]
    for method in ("none", "pathtrace", "lighttrace", "photonmap", "beamtree", "illuminationmap", "causticpolygons"):
        texts += [f"param {method} {word}" for word in ASSIGNMENTS.split()]
    for method in ("pathtrace", "lighttrace", "globalphotonmap"):
        texts += [f"indirect {method} {word}" for word in ("photons=50", "nearest=3", "paths=9", "x=1")]
    for i, line in enumerate(texts):
        yield str(i), line.replace(" ", "\n").encode("latin-1")


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
    variants = {"whole": folder, "no_table": {key: folder[key] for key in list(folder)[:3]},
                "text": {"plan.json": json.dumps(plan)[:-9], "trials/a/record.json": "{"}, "empty": {}}
    both = {"plan.json": plan, "trials/a/record.json": record, "environment.json": {}, "references/r.exr": "1",
            "two/plan.json": plan, "two/trials/b/record.json": failed, "two/environment.json": {}, "two/references/r.exr": "1"}
    judged = {"reference": {"key": "r", "mean": 1.0, "name": "lighttrace", "parameters": {}, "spp": 4, "seed": 1}}
    variants |= {
        "two": both, "two-pictures": {**both, "two/references/r.exr": "2"}, "two-environment": {**both, "environment.json": []},
        "two-plans": {**both, "two/plan.json": {**plan, "trials": []}}, "two-codes": {**both, "two/trials/b/record.json": {**failed, "code_version": "y"}},
        "two-isa": {**both, "two/trials/b/record.json": {**failed, "isa": "avx2"}},
        "two-cpu": {**both, "two/trials/b/record.json": {**failed, "machine": {"cpu": "d"}}},
        "twice": {**both, "trials/b/record.json": failed}, "figure": {**both, "report/figures/a.png": "x"},
        "missing": {"plan.json": {**plan, "trials": [{**plan["trials"][0], "trial": str(i)} for i in range(9)]}}}
    for i, part in enumerate(({"version": 2}, {"swept": ["A b"]}, {"trials": [{"trial": "../x", "cell": "", "seed": 1, "chosen": True}]},
                              {"trials": [{"trial": "x", "cell": "", "seed": -1, "chosen": True}]}, {"filters": 5})):
        variants[f"plan-{i}"] = {"plan.json": {**plan, **part}}
    method = {"name": "photonmap", "parameters": {"photons": 100, "nearest": 5}}
    for i, part in enumerate((
            {"status": "running"}, {"spp": 3000000000}, {"indirect": {"name": "globalphotonmap", "parameters": {"save": "x"}}}, {"machine": 5}, {"seed": -1}, {"spp": "x"}, {"isa": 5}, {"repeat": 99999999999}, judged,
            {"method": method}, {"method": {"name": "photonmap", "parameters": {"save": "x"}}}, {"method": {"name": "x"}},
            {"method": {"name": "photonmap", "parameters": {"load": "m.map"}, "files": {"load": "0"}}}, {"scene": {"file": "none.json"}},
            {"indirect": {"name": "globalphotonmap", "parameters": {"photons": 50}}}, {"swept": {"method_seed": 1, "x": "=2"}},
            {"scene": {**record["scene"], "set": {"/ball/radius": "x"}}}, {"scene": {**record["scene"], "file": "/dev/null"}})):
        variants[f"record-{i}"] = {**both, "trials/a/record.json": {**record, **part}}
    for name, part in (("target-inside", {"into": "out/merged"}), ("target-there", {"into": "two"}), ("text-beside", {"references/r.txt": "x"})):
        variants[name] = {**both, **part}
    for i, record_of_kind in enumerate(({"threads": "x"}, {"message": 5}, {"message": 'a, "b"\nc'}, {"swept": {"x": "=1", "seed": 5}})):
        variants[f"kind-{i}"] = {**both, "plan.json": {**plan, "swept": ["alpha", "x", "seed", "method_seed"]}, "trials/a/record.json": {**record, **record_of_kind}}
    own = {**table, "code_version": "own", "csv": "own", "jsonl": "own"}
    variants |= {"own-table": {**folder, ".table": own}, "own-row": {**folder, ".table": own, "records.csv": 'trial,"x"\na,1\n'},
                 "deep-table": {**folder, ".table": "[" * 70}, "null-mean": {**folder, ".table": {**own, "variances": {"x": ["0", None]}}}}
    variants["judges"] = {**both, "trials/a/record.json": {**record, **judged},
                          "two/trials/b/record.json": {**failed, "reference": {**judged["reference"], "mean": 2.0}}}
    for name in ("b", "none", "x", ""):
        variants[f"explain-{name}"] = {**folder, "explain": name}
    for name, files in variants.items():
        yield name, json.dumps(files).encode()


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
