"""Reads the OpenEXR files that the program writes: one part of scan lines, float, half or uint, plain or deflated.

Needs NumPy alone. What else the format knows (tiles, several parts, other compressions, subsampling) is refused by name.
"""
import struct
import zlib

import numpy

MAGIC = b"\x76\x2f\x31\x01"
TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}
LINES = {0: 1, 2: 1, 3: 16}  # compression -> lines of a chunk: none, zips, zip
COMPRESSIONS = ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab")
MOST_PIXELS = 1 << 28


class PictureError(Exception):
    """One line on what is wrong with a picture, without its name."""


def read(path):
    """({channel: height x width array, as stored}, {attribute: text}); channels by their names in the file: R, caustic.R,
    stderr.Y. Raises PictureError."""
    try:
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
