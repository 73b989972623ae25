#!/usr/bin/env python3
"""Measures the memory of `info` and `render` on scenes whose texture is small as a file and large as a picture, of every
format that is read.

Usage: picture_memory_test.py CAUSTICBENCH [--table]     --table prints what was measured
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

PROGRAM = ""
MOST = 220.0  # MB, of the program and the process that decodes together
# The header of a progressive JPEG is known when libjpeg has decoded all of it.
NOISE = 6.0  # MB: stacks, libraries' pages that the small picture does not touch
MEASURED = {}


def png(width, height, colour, depth, interlaced):
    """A black PNG; `colour` as in its header."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    channels = {0: 1, 2: 3, 6: 4}[colour]
    passes = [(0, 0, 1, 1)]
    if interlaced:
        passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
    packer, data = zlib.compressobj(9), b""
    for left, top, across, down in passes:
        columns, rows = (width - left + across - 1) // across, (height - top + down - 1) // down
        row = bytes(1 + (columns * channels * depth + 7) // 8)
        for _ in range(rows if columns > 0 else 0):
            data += packer.compress(row)
    data += packer.flush()
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlaced)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def tiff(width, height, channels, bits, rows_of_strip, tile=0):
    """A black TIFF by deflate, in strips or in tiles."""
    if tile:
        block, count = tile * tile * channels * bits // 8, (-(-width // tile)) * (-(-height // tile))
    else:
        block, count = width * rows_of_strip * channels * bits // 8, -(-height // rows_of_strip)
    data = zlib.compress(bytes(block), 9)
    entries = [(256, 4, 1, width), (257, 4, 1, height), (259, 3, 1, 8), (262, 3, 1, 2 if channels > 1 else 1), (277, 3, 1, channels)]
    tail = b""
    end = 8 + len(data)

    def put(values, code):
        nonlocal tail
        packed = struct.pack(f"<{len(values)}{code}", *values)
        if len(packed) <= 4:
            return int.from_bytes(packed.ljust(4, b"\0"), "little")
        at = end + len(tail)
        tail += packed + b"\0" * (len(packed) % 2)
        return at
    entries.append((258, 3, channels, put([bits] * channels, "H")))
    entries += [(322, 4, 1, tile), (323, 4, 1, tile)] if tile else [(278, 4, 1, rows_of_strip)]
    entries += [(324 if tile else 273, 4, count, put([8] * count, "I")), (325 if tile else 279, 4, count, put([len(data)] * count, "I"))]
    directory = struct.pack("<H", len(entries))
    for tag, kind, number, value in sorted(entries):
        directory += struct.pack("<HHI", tag, kind, number)
        directory += struct.pack("<HH", value, 0) if kind == 3 and number == 1 else struct.pack("<I", value)
    return struct.pack("<2sHI", b"II", 42, end + len(tail)) + data + tail + directory + bytes(4)


def exr(width, height, channels):
    """A black OpenEXR file of floats by zip, in blocks of 16 lines."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    listed = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in channels) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    head = struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", listed)
    head += attribute(b"compression", b"compression", b"\3") + attribute(b"dataWindow", b"box2i", window)
    head += attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0")
    head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", bytes(8)) + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    blocks = []
    for top in range(0, height, 16):
        # Its predictor turns zeros into a first 0 and then 128s.
        size = min(16, height - top) * width * 4 * len(channels)
        blocks.append(struct.pack("<i", top) + (lambda data: struct.pack("<i", len(data)) + data)(zlib.compress(b"\0" + b"\x80" * (size - 1), 9)))
    at, table = len(head) + 8 * len(blocks), b""
    for block in blocks:
        table += struct.pack("<Q", at)
        at += len(block)
    return head + table + b"".join(blocks)


def targa(width, height):
    run = b"\xff" + bytes(4)
    return struct.pack("<BBBHHBHHHHBB", 0, 0, 10, 0, 0, 0, 0, 0, width, height, 32, 0x28) + run * (width * height // 128)


def radiance(width, height):
    line = bytes([2, 2, width >> 8, width & 255]) + (b"\xff\0" * (width // 127) + bytes([128 + width % 127, 0])) * 4
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + line * height


def jpeg(width, height, components, progressive):
    """A grey JPEG whose only codes are those of nothing: a bit for each block's mean, and one for its end."""
    def segment(kind, data):
        return struct.pack(">BBH", 255, kind, len(data) + 2) + data
    head = b"\xff\xd8" + segment(0xDB, b"\0" + b"\1" * 64)
    sampling = b"".join(bytes([i + 1, 0x11, 0]) for i in range(components))
    head += segment(0xC2 if progressive else 0xC0, struct.pack(">BHHB", 8, height, width, components) + sampling)
    head += segment(0xC4, b"\0\1" + bytes(15) + b"\0") + segment(0xC4, b"\x10\1" + bytes(15) + b"\0")
    scan = bytes([components]) + b"".join(bytes([i + 1, 0]) for i in range(components))
    blocks = (-(-width // 8)) * (-(-height // 8)) * components
    bits = blocks if progressive else 2 * blocks
    return head + segment(0xDA, scan + (b"\0\0\0" if progressive else b"\0\x3f\0")) + bytes(-(-bits // 8)) + b"\xff\xd9"


def pnm(width, height):
    return f"P4\n{width} {height}\n".encode() + bytes(-(-width // 8) * height)


# Name -> file. Where 16.8 million pixels are taken, they are asked for, and else what fits beside its decoder.
PICTURES = {
    "small": lambda: png(2, 2, 2, 8, 0),
    "small.ppm": lambda: b"P3\n1 1\n255\n1 1 1\n",
    "png": lambda: png(4096, 4096, 2, 8, 0),
    "png, 16 bits and alpha": lambda: png(4096, 4096, 6, 16, 0),
    "png, interlaced": lambda: png(4096, 4096, 6, 16, 1),
    "png, interlaced, 8.6 million": lambda: png(2930, 2930, 6, 16, 1),
    "png, one row": lambda: png(1_000_000, 16, 6, 16, 0),
    "tiff": lambda: tiff(4096, 4096, 3, 8, 16),
    "tiff, one strip": lambda: tiff(4096, 4096, 3, 8, 4096),
    "tiff, one row": lambda: tiff(1 << 24, 1, 3, 8, 1),
    "tiff, tiles": lambda: tiff(4096, 4096, 4, 16, 0, 256),
    "tiff, large tiles": lambda: tiff(4096, 4096, 4, 16, 0, 4096),
    "exr": lambda: exr(4096, 4096, [b"B", b"G", b"R"]),
    "exr, one row": lambda: exr(1 << 24, 1, [b"B", b"G", b"R"]),
    "targa": lambda: targa(4096, 4096),
    "targa, 11.9 million": lambda: targa(3456, 3456),
    "hdr": lambda: radiance(4096, 3900),
    "jpeg": lambda: jpeg(4096, 4096, 3, False),
    "jpeg, progressive": lambda: jpeg(4096, 4096, 3, True),
    "jpeg, progressive, grey": lambda: jpeg(3400, 3400, 1, True),
    "pnm": lambda: pnm(2896, 2896),
}
SCENE = {"sensor": {"type": "perspective", "film": {"type": "hdrfilm", "width": 4, "height": 3},
                    "to_world": [{"look_at": {"origin": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0]}}]},
         "light": {"type": "point", "position": [0, 0, 2], "intensity": 1},
         "floor": {"type": "rectangle", "bsdf": {"type": "diffuse", "reflectance": {"type": "bitmap", "filename": "picture"}}}}


def most_resident(process):
    """The most memory that a process had so far [MB], or 0 when it is gone."""
    try:
        text = pathlib.Path(f"/proc/{process}/status").read_text(encoding="ascii")
    except OSError:
        return 0.0
    line = next((line for line in text.splitlines() if line.startswith("VmHWM:")), "VmHWM: 0 kB")
    return int(line.split()[1]) * 1024 / 1e6


def children(process):
    try:
        return pathlib.Path(f"/proc/{process}/task/{process}/children").read_text(encoding="ascii").split()
    except OSError:
        return []


def measure(folder, verb):
    """Exit code, what was said, the most memory of the program and of what it started, added [MB], and how many processes these were."""
    line = {"info": [PROGRAM, "info", "scene.json", "--quick"],
            "render": [PROGRAM, "render", "scene.json", "--method", "none", "--spp", "1", "--threads", "1", "-o", "out.exr"]}[verb]
    most = {}
    with open(folder / "said", "w", encoding="utf-8") as said, \
            subprocess.Popen(line, cwd=folder, stdout=subprocess.DEVNULL, stderr=said) as program:
        while program.poll() is None:
            for process in (str(program.pid), *children(program.pid)):
                most[process] = max(most.get(process, 0.0), most_resident(process))
            time.sleep(0.001)
    return program.returncode, (folder / "said").read_text(encoding="utf-8"), sum(most.values()), len(most)


class Memory(unittest.TestCase):
    def test_any_small_file_takes_at_most_220_megabytes(self):
        read = []
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "scene.json").write_text(json.dumps(SCENE), encoding="utf-8")
            before = {}
            for picture, make in PICTURES.items():
                data = make()
                self.assertLessEqual(len(data), 1 << 20, picture)
                (folder / "picture").write_bytes(data)
                for verb in ("info", "render"):
                    code, said, memory, processes = measure(folder, verb)
                    own = picture.startswith("png") or picture == "small"
                    if picture.startswith("small"):
                        before[own, verb] = memory
                    more = memory - before[own, verb]
                    MEASURED[picture, verb] = len(data), code, more, said.strip()
                    with self.subTest(picture=picture, verb=verb):
                        self.assertIn(code, (0, 2), said)
                        if verb == "render" and not picture.startswith("small"):
                            self.assertGreater(processes, 1, "the process that decodes was not seen: its memory is not in the sum")
                        if code == 2:
                            self.assertIn("picture: cannot be read (", said)
                        self.assertLess(more, MOST + NOISE if verb == "render" else 110.0 if "progressive" in picture else 30.0)
                    if verb == "render" and code == 0:
                        read.append(picture)
        # The limit refuses what does not fit, not every large picture.
        for picture in ("png", "tiff", "exr", "hdr", "jpeg", "pnm", "targa, 11.9 million", "jpeg, progressive, grey"):
            self.assertIn(picture, read)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    table = "--table" in sys.argv
    if table:
        sys.argv.remove("--table")
    result = unittest.main(exit=False)
    if table:
        for (picture, verb), (size, code, more, said) in MEASURED.items():
            print(f"{picture:32} {verb:7} {size:8} bytes, exit {code}, {more:7.1f} MB {said[:150]}")
    sys.exit(not result.result.wasSuccessful())
