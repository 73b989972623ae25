"""OpenEXR pictures, by NumPy alone: reads those that the program writes (one part of scan lines, float, half or uint, plain or
deflated), and writes pictures of half floats.

What else the format knows (tiles, several parts, other compressions, subsampling) is refused by name.
"""
import os
import stat
import struct
import zlib

import numpy

from report.records import RecordsError

MAGIC = b"\x76\x2f\x31\x01"
TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}
LINES = {0: 1, 2: 1, 3: 16}  # compression -> lines of a chunk: none, zips, zip
COMPRESSIONS = ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab")
MOST_PIXELS = 1 << 28
# What is written: one part, deflated.
START = MAGIC + b"\x02\x00\x00\x00"
ZIP_LINES = LINES[3]


class PictureError(Exception):
    """One line on what is wrong with a picture, without its name."""


def read(path):
    """({channel: height x width array, as stored}, {attribute: text}); channels by their names in the file: R, caustic.R,
    stderr.Y. Raises PictureError."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):  # a pipe may never answer, a device never end
            raise PictureError("no regular file")
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise PictureError("no such file" if isinstance(error, FileNotFoundError) else error.strerror) from error
    try:
        return read_parts(data)
    except (struct.error, IndexError, KeyError, ValueError, zlib.error) as error:
        raise PictureError(f"damaged, or cut short ({error})") from error


def read_parts(data):
    if data[:4] != MAGIC:
        raise PictureError("no OpenEXR file")
    if data[4] != 2 or data[5] & ~0x04:  # long names are the same file
        raise PictureError("an OpenEXR file of tiles or several parts, which is not read")
    attributes, texts, place = read_attributes(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    if width < 1 or height < 1 or width * height > MOST_PIXELS:
        raise PictureError(f"{width} x {height} pixels")
    compression = attributes["compression"][0]
    if compression not in LINES:
        known = COMPRESSIONS[compression] if compression < len(COMPRESSIONS) else compression
        raise PictureError(f"compression {known}, which is not read (none, zips, zip are)")
    channels = read_channels(attributes["channels"])
    planes = {name: numpy.empty((height, width), kind) for name, kind in channels}
    lines = LINES[compression]
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, place):
        first, size = struct.unpack_from("<ii", data, offset)
        rows = range(first - top, min(first - top + lines, height))
        if first < top or size < 0 or offset + 8 + size > len(data):
            raise ValueError(f"a chunk of {size} bytes at line {first}")
        wanted = len(rows) * width * sum(numpy.dtype(kind).itemsize for _, kind in channels)
        fill(planes, channels, rows, unpacked(data[offset + 8:offset + 8 + size], wanted))
    return planes, texts


def read_attributes(data):
    """{name: bytes} of the header, {name: text} of those that are text, and where the header ends."""
    attributes, texts, place = {}, {}, 8
    while data[place] != 0:
        name, place = text_at(data, place)
        kind, place = text_at(data, place)
        size, = struct.unpack_from("<i", data, place)
        attributes[name] = data[place + 4:place + 4 + size]
        if kind == "string":
            texts[name] = attributes[name].decode("utf-8", "replace")
        place += 4 + size
    return attributes, texts, place + 1


def text_at(data, place):
    end = data.index(b"\0", place)
    return data[place:end].decode("utf-8", "replace"), end + 1


def read_channels(data):
    """[(name, type)] in the order of the file."""
    channels, place = [], 0
    while data[place] != 0:
        name, place = text_at(data, place)
        kind, _, across, down = struct.unpack_from("<iB3x2i", data, place)
        if (across, down) != (1, 1):
            raise PictureError(f"channel {name} is subsampled, which is not read")
        channels.append((name, TYPES[kind]))
        place += 16
    return channels


def unpacked(chunk, wanted):
    """The bytes of some lines; a chunk that deflating would not shrink is stored as it is."""
    if len(chunk) == wanted:
        return chunk
    raw = numpy.frombuffer(zlib.decompress(chunk), numpy.uint8)
    if raw.size != wanted:
        raise ValueError(f"{raw.size} bytes where {wanted} belong")
    steps = raw - numpy.uint8(128)
    steps[0] = raw[0]
    plain = numpy.cumsum(steps, dtype=numpy.uint8)
    joined = numpy.empty(wanted, numpy.uint8)
    joined[0::2] = plain[:(wanted + 1) // 2]
    joined[1::2] = plain[(wanted + 1) // 2:]
    return joined.tobytes()


def fill(planes, channels, rows, data):
    place = 0
    for row in rows:
        for name, kind in channels:
            width = planes[name].shape[1]
            planes[name][row] = numpy.frombuffer(data, kind, width, place)
            place += width * numpy.dtype(kind).itemsize


def read_layers(path):
    """{layer: height x width x 3}, '' the beauty, and {layer: height x width} for layers of one channel. Raises RecordsError."""
    try:
        planes, _ = read(path)
    except PictureError as error:
        raise RecordsError(f"{path}: {error}") from error
    layers = {}
    for name, plane in planes.items():
        prefix, _, channel = name.rpartition(".")
        if channel == "R" and f"{name[:-1]}G" in planes:
            layers[prefix] = numpy.stack([planes[f"{name[:-1]}{each}"] for each in "RGB"], axis=2)
        elif channel not in "RGB":
            layers[prefix or channel] = plane
    return layers


def packed(raw):
    plain = numpy.frombuffer(raw, numpy.uint8)
    split = numpy.concatenate([plain[0::2], plain[1::2]]).astype(numpy.int16)
    delta = split.copy()
    delta[1:] = split[1:] - split[:-1] + 128
    return zlib.compress((delta & 255).astype(numpy.uint8).tobytes(), 6)


def encode(picture):
    """The bytes of a picture, height x width x 3, linear, as half floats."""
    height, width, _ = picture.shape
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channel = lambda name: name.encode() + b"\0" + struct.pack("<4i", 1, 0, 1, 1)
    header = b"".join(name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value for name, kind, value in (
        ("channels", "chlist", b"".join(map(channel, "BGR")) + b"\0"), ("compression", "compression", b"\x03"),
        ("dataWindow", "box2i", box), ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)))) + b"\0"
    halves = numpy.clip(picture, -65504, 65504).astype("<f2")
    blocks = []
    for first in range(0, height, ZIP_LINES):
        raw = b"".join(halves[y, :, channel].tobytes() for y in range(first, min(first + ZIP_LINES, height)) for channel in (2, 1, 0))
        small = packed(raw)
        body = small if len(small) < len(raw) else raw
        blocks.append(struct.pack("<2i", first, len(body)) + body)
    offset = len(START) + len(header) + 8 * len(blocks)
    table = b""
    for block in blocks:
        table += struct.pack("<q", offset)
        offset += len(block)
    return START + header + table + b"".join(blocks)
