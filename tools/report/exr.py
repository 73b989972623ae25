"""OpenEXR pictures as causticbench writes them: scan lines, ZIP, 32-bit float; read and written with numpy alone."""
import struct
import zlib

import numpy as np

from report.records import RecordsError

MAGIC = b"\x76\x2f\x31\x01\x02\x00\x00\x00"
LINES = 16  # of a ZIP block
HALF, FLOAT = 1, 2


def read(path):
    """{layer: height x width x 3}, '' the beauty, and {layer: height x width} for layers of one channel."""
    data = path.read_bytes()
    if data[:4] != MAGIC[:4]:
        raise RecordsError(f"{path}: not an OpenEXR file")
    header, place = attributes(data)
    if header["compression"] != b"\x03" or data[5] & 0x1A:
        raise RecordsError(f"{path}: expected scan lines with ZIP compression")
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    planes = planes_of(data, place, channels_of(header["channels"]), right - left + 1, bottom - top + 1)
    return layers_of(planes)


def attributes(data):
    """{name: bytes} of the header, and where it ends."""
    found, place = {}, 8
    while data[place]:
        name, place = word(data, place)
        _, place = word(data, place)
        size, = struct.unpack_from("<i", data, place)
        found[name] = data[place + 4:place + 4 + size]
        place += 4 + size
    return found, place + 1


def word(data, place):
    end = data.index(b"\0", place)
    return data[place:end].decode(), end + 1


def channels_of(data):
    found, place = [], 0
    while data[place]:
        name, place = word(data, place)
        kind, = struct.unpack_from("<i", data, place)
        if kind not in (HALF, FLOAT):
            raise RecordsError(f"channel {name}: whole numbers are not read")
        found.append((name, np.dtype("<f2" if kind == HALF else "<f4")))
        place += 16
    return found


def planes_of(data, place, channels, width, height):
    planes = {name: np.empty((height, width), np.float32) for name, _ in channels}
    count = -(-height // LINES)
    for offset in struct.unpack_from(f"<{count}q", data, place):
        first, size = struct.unpack_from("<2i", data, offset)
        lines = min(LINES, height - first)
        raw_size = lines * width * sum(kind.itemsize for _, kind in channels)
        block = data[offset + 8:offset + 8 + size]
        raw = block if size == raw_size else unpacked(block)
        at = 0
        for y in range(first, first + lines):
            for name, kind in channels:
                planes[name][y] = np.frombuffer(raw, kind, width, at)
                at += width * kind.itemsize
    return planes


def unpacked(block):
    """Undoes ZIP, the predictor, and the split into even and odd bytes."""
    delta = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.uint64)
    delta[1:] += 128
    plain = np.cumsum(delta).astype(np.uint8)
    half = (len(plain) + 1) // 2
    raw = np.empty(len(plain), np.uint8)
    raw[0::2], raw[1::2] = plain[:half], plain[half:]
    return raw.tobytes()


def packed(raw):
    plain = np.frombuffer(raw, np.uint8)
    split = np.concatenate([plain[0::2], plain[1::2]]).astype(np.int16)
    delta = split.copy()
    delta[1:] = split[1:] - split[:-1] + 128
    return zlib.compress((delta & 255).astype(np.uint8).tobytes(), 6)


def layers_of(planes):
    """Channels R, G, B of one prefix together; any other alone, by its prefix."""
    layers = {}
    for name, plane in planes.items():
        prefix, _, channel = name.rpartition(".")
        if channel == "R" and f"{name[:-1]}G" in planes:
            layers[prefix] = np.stack([planes[f"{name[:-1]}{each}"] for each in "RGB"], axis=2)
        elif channel not in "RGB":
            layers[prefix or channel] = plane
    return layers


def encode(picture):
    """The bytes of a picture, height x width x 3, linear, as half floats."""
    height, width, _ = picture.shape
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channel = lambda name: name.encode() + b"\0" + struct.pack("<4i", HALF, 0, 1, 1)
    header = b"".join(name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value for name, kind, value in (
        ("channels", "chlist", b"".join(map(channel, "BGR")) + b"\0"), ("compression", "compression", b"\x03"),
        ("dataWindow", "box2i", box), ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)))) + b"\0"
    halves = np.clip(picture, -65504, 65504).astype("<f2")
    blocks = []
    for first in range(0, height, LINES):
        raw = b"".join(halves[y, :, channel].tobytes() for y in range(first, min(first + LINES, height)) for channel in (2, 1, 0))
        small = packed(raw)
        body = small if len(small) < len(raw) else raw
        blocks.append(struct.pack("<2i", first, len(body)) + body)
    offset = len(MAGIC) + len(header) + 8 * len(blocks)
    table = b""
    for block in blocks:
        table += struct.pack("<q", offset)
        offset += len(block)
    return MAGIC + header + table + b"".join(blocks)
