"""A sweep's folder made by hand: a few pictures of known bias and noise, beside a reference of known values."""
import csv
import os
import pathlib
import struct
import zlib

import numpy

from report import exr

COLUMNS = ("trial,status,scene,method,seed,repeat,threads,isa,photons_emitted,photons_stored,nearest,alpha,mesh_resolution,"
           "map_bytes,peak_rss_bytes,parse_s,precompute_s,balance_s,render_s,total_s,cpu_s,rmse,relmse,bias,variance,mean_ratio,"
           "leak_energy,beauty_rmse,unreached_fraction,reference,reference_stderr,config_hash,code_version,mask_rmse,flip,"
           "precompute_cpu_s,balance_cpu_s,render_cpu_s,indirect_rmse,indirect_cpu_s,reference_mean,spp,picture_hash,finished,cpu,load_average,message,"
           "photons").split(",")
WIDTH, HEIGHT = 16, 12
KEY = "0123456789abcdef"
TYPES = {"<u4": 0, "<f2": 1, "<f4": 2}


def write_exr(path, planes, compression=3, kind="<f4", texts=()):
    """An OpenEXR file of scan lines: compression 0 none, 2 zips, 3 zip."""
    names = sorted(planes)
    height, width = planes[names[0]].shape
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iB3x2i", TYPES[kind], 0, 1, 1) for name in names) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = [("channels", "chlist", channels), ("compression", "compression", bytes([compression])),
                  ("dataWindow", "box2i", box), ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
                  ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", bytes(8)),
                  ("screenWindowWidth", "float", struct.pack("<f", 1))]
    attributes += [(name, "string", text.encode()) for name, text in texts]
    head = b"\x76\x2f\x31\x01" + struct.pack("<i", 2)
    for name, type_name, data in attributes:
        head += name.encode() + b"\0" + type_name.encode() + b"\0" + struct.pack("<i", len(data)) + data
    head += b"\0"
    lines = 16 if compression == 3 else 1
    chunks = []
    for first in range(0, height, lines):
        raw = b"".join(planes[name][y].astype(kind).tobytes() for y in range(first, min(first + lines, height)) for name in names)
        chunks.append((first, shrunk(raw) if compression else raw))
    place, table = len(head) + 8 * len(chunks), []
    for _, data in chunks:
        table.append(place)
        place += 8 + len(data)
    pathlib.Path(path).write_bytes(head + struct.pack(f"<{len(table)}Q", *table)
                                   + b"".join(struct.pack("<ii", first, len(data)) + data for first, data in chunks))


def shrunk(raw):
    """Bytes as OpenEXR deflates them: even ones before odd ones, each as a step from the one before."""
    plain = numpy.frombuffer(raw, numpy.uint8)
    parts = numpy.concatenate([plain[0::2], plain[1::2]]).astype(int)
    steps = numpy.concatenate([parts[:1], (parts[1:] - parts[:-1] + 128) % 256]).astype(numpy.uint8)
    data = zlib.compress(steps.tobytes())
    return data if len(data) < len(raw) else raw


def reference_planes():
    """Caustic of the reference, in colour, above a grey rest; a corner that is not reached."""
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    bright = (1 + x + 2 * y) / 64
    caustic = numpy.stack([bright, 0.5 * bright, 0.25 * bright]).astype(numpy.float32)
    unreached = numpy.zeros((HEIGHT, WIDTH), numpy.float32)
    unreached[0, :3] = 1
    return caustic, numpy.full((HEIGHT, WIDTH), 0.125, numpy.float32), unreached


def planes_of(caustic, rest):
    return {**{colour: plane + rest for colour, plane in zip("RGB", caustic)},
            **{f"caustic.{colour}": plane for colour, plane in zip("RGB", caustic)}}


def picture_of(method, seed, step):
    """The reference with a bias that falls with the work, and a noise that is one pattern, scaled by the seed."""
    caustic, rest, _ = reference_planes()
    bias = (0.02 if method == "photonmap" else 0.01) / step
    noise = numpy.where((numpy.indices((HEIGHT, WIDTH)).sum(axis=0) % 2) == 0, 1, -1) * (seed - 3) * 0.005 / step
    return (caustic + bias + noise).astype(numpy.float32), rest


def write_sweep(folder, seeds=(1, 2, 3, 4, 5), scenes=("ring",)):
    """Writes records.csv, pictures and references; returns the rows."""
    folder = pathlib.Path(folder)
    (folder / "references").mkdir(parents=True)
    caustic, rest, unreached = reference_planes()
    write_exr(folder / "references" / f"{KEY}.exr", {**planes_of(caustic, rest), "unreached.Y": unreached,
                                                     "stderr.Y": numpy.full_like(rest, 0.001)})
    rows = []
    for scene in scenes:
        for method, steps in (("photonmap", (1, 2, 4)), ("beamtree", (1, 2))):
            for step in steps:
                for seed in seeds:
                    rows.append(write_trial(folder, scene, method, step, seed))
    write_table(folder, rows)
    return rows


def write_trial(folder, scene, method, step, seed):
    trial = f"{scene}-{method}-{step}-s{seed}"
    (folder / "trials" / trial).mkdir(parents=True)
    picture, rest = picture_of(method, seed, step)
    command = f"causticbench render {scene}.json --method {method} --seed {seed}"
    write_exr(folder / "trials" / trial / "image.exr", planes_of(picture, rest), texts=[("causticbench.command", command)])
    caustic, _, unreached = reference_planes()
    error = (picture.astype(float) - caustic)[:, unreached == 0]
    mean = float(caustic[:, unreached == 0].mean(dtype=float))
    values = {"trial": trial, "status": "done", "scene": scene, "method": method, "seed": seed, "repeat": 1, "threads": 1,
              "isa": "plain", "total_s": 0.5 * step, "rmse": repr(float(numpy.sqrt((error ** 2).mean()))),
              "relmse": repr(float((error ** 2).mean())), "bias": repr(float(error.mean() / mean)), "mean_ratio": "1.0123456789012345",
              "variance": 0.25, "reference": f"lighttrace:{KEY}", "reference_stderr": "0.01", "reference_mean": repr(mean), "config_hash": "c" * 16,
              "code_version": "0.1.0 (abc)", "precompute_cpu_s": repr(0.1 * step), "render_cpu_s": repr(0.2 * step + 0.001 * seed),
              "picture_hash": f"{zlib.crc32(trial.encode()):016x}", "finished": "2026-11-23T00:00:00Z",
              "cpu": "Test CPU", "load_average": "0.5", "spp": 4, "map_bytes": 1000 * step}
    values.update({"photons": 1000 * step, "photons_stored": 1000 * step, "nearest": 50} if method == "photonmap"
                  else {"mesh_resolution": 16 * step})
    return {name: str(values.get(name, "")) for name in COLUMNS}


def add_indirect(folder, rows):
    """Light between surfaces of 0.25 for the reference, and 0.01 a seed above it for the trials."""
    caustic, rest, unreached = reference_planes()
    stderr = {name: numpy.full_like(rest, value) for name, value in (("stderr.Y", 0.001), ("indirect_stderr.Y", 0.002))}
    write_exr(folder / "references" / f"{KEY}.exr", {**lit(planes_of(caustic, rest), 0.25), **stderr, "unreached.Y": unreached})
    for row in rows:
        path = folder / "trials" / row["trial"] / "image.exr"
        planes, texts = exr.read(path)
        write_exr(path, lit(planes, 0.25 + 0.01 * int(row["seed"])), texts=texts.items())
        row.update(indirect_rmse=repr(0.01 * int(row["seed"])), indirect_cpu_s="0.5")
    write_table(folder, rows)


def lit(planes, indirect):
    """The planes with an indirect layer of one value."""
    found = {name: plane + numpy.float32(indirect) if name in "RGB" else plane for name, plane in planes.items()}
    return {**found, **{f"indirect.{colour}": numpy.full_like(planes["R"], indirect) for colour in "RGB"}}


def add_flip(folder, rows, methods=("photonmap", "beamtree")):
    """Maps that rise from 0 to 1 from left to right, as flip_column keeps them, for some methods."""
    flip = numpy.tile(numpy.linspace(0, 1, WIDTH, dtype=numpy.float32), (HEIGHT, 1))
    for row in (row for row in rows if row["method"] in methods):
        write_exr(folder / "trials" / row["trial"] / "flip.exr", {"flip.Y": flip},
                  texts=[("causticbench.picture_hash", row["picture_hash"])])
        row["flip"] = repr(float(flip[reference_planes()[2] == 0].mean(dtype=float)))
    write_table(folder, rows)


def write_table(folder, rows):
    with open(os.path.join(folder, "records.csv"), "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
