"""Pictures as the page keeps them: planes of half floats, deflated, in base64.

A plane's values are multiplied by a power of two so that its largest is between 2^13 and 2^14: no radiance overflows,
and 11 bits of each are kept. Red, green and blue that are equal everywhere are kept once; of others red and blue are kept
as steps from green, between the halves' bits as whole numbers: colours that hardly change deflate better so.
"""
import base64
import zlib

import numpy

from report import exr

LARGEST = 14  # exponent above the largest half that is stored


def read(path):
    """The layers that the page shows, as float32 arrays of 1 or 3 planes, and the texts in the picture's metadata.

    Layers: `caustic`; `rest`, the beauty without it and without `indirect`; where they are there `indirect`, the light
    between diffuse surfaces, `stderr` and `indirect_stderr`, the standard error of a pixel of the caustic and of that
    light, and `unreached`, the share of its samples that were not reached. Raises exr.PictureError.
    """
    planes, texts = exr.read(path)
    beauty, caustic = layer(planes, ""), layer(planes, "caustic")
    for name, values in (("beauty", beauty), ("caustic", caustic)):
        require_finite(name, values)
    layers = {"caustic": caustic, "rest": beauty - caustic}
    if "indirect.R" in planes:
        layers["indirect"] = layer(planes, "indirect")
        require_finite("indirect", layers["indirect"])
        layers["rest"] -= layers["indirect"]
    for name in ("stderr", "indirect_stderr"):
        if f"{name}.Y" in planes:
            layers[name] = planes[f"{name}.Y"].astype(numpy.float32)[None]
        elif f"{name}.R" in planes:
            layers[name] = layer(planes, name)
    if "unreached.Y" in planes and planes["unreached.Y"].any():
        layers["unreached"] = planes["unreached.Y"].astype(numpy.float32)[None]
    return layers, texts


def read_flip(path, picture_hash):
    """The FLIP map that flip_column keeps beside a picture, one plane. Raises exr.PictureError."""
    planes, texts = exr.read(path)
    if "flip.Y" not in planes:
        raise exr.PictureError(f"no channel flip.Y (it has: {', '.join(sorted(planes))})")
    if texts.get("causticbench.picture_hash", "") != picture_hash:
        raise exr.PictureError("it is of another picture (run tools/flip_column.py again)")
    return planes["flip.Y"].astype(numpy.float32)[None]


def layer(planes, name):
    """The three planes of a layer ("" = beauty)."""
    channels = [f"{name}.{colour}" if name else colour for colour in "RGB"]
    missing = [channel for channel in channels if channel not in planes]
    if missing:
        raise exr.PictureError(f"no channel {missing[0]} (it has: {', '.join(sorted(planes))})")
    return numpy.stack([planes[channel].astype(numpy.float32) for channel in channels])


def require_finite(name, values):
    wrong = numpy.argwhere(~numpy.isfinite(values))
    if len(wrong):
        _, y, x = wrong[0]
        raise exr.PictureError(f"layer {name} is not finite at pixel ({x}, {y})")


def packed(values):
    """(description, base64) of planes: what `unpacked` and the page read."""
    kept = values[:1] if all(numpy.array_equal(values[0], plane) for plane in values[1:]) else values
    largest = float(numpy.abs(kept).max())
    scale = LARGEST - int(numpy.frexp(largest)[1]) if largest > 0 else 0
    halves = numpy.ldexp(kept.astype(numpy.float64), scale).astype("<f2")
    bits = halves.view(numpy.uint16)
    if len(bits) == 3:
        bits[0] -= bits[1]
        bits[2] -= bits[1]
    pairs = bits.view(numpy.uint8).reshape(-1, 2)
    data = zlib.compress(pairs.T.tobytes(), 9)  # all low bytes, then all high bytes: high bytes are alike
    about = {"width": kept.shape[2], "height": kept.shape[1], "planes": kept.shape[0], "scale": scale}
    return about, base64.b64encode(data).decode("ascii")


def unpacked(about, text):
    """The planes again, as float64."""
    low_then_high = numpy.frombuffer(zlib.decompress(base64.b64decode(text)), numpy.uint8)
    shape = (about["planes"], about["height"], about["width"])
    bits = numpy.ascontiguousarray(low_then_high.reshape(2, -1).T).view("<u2").reshape(shape)
    if len(bits) == 3:
        bits[0] += bits[1]
        bits[2] += bits[1]
    return numpy.ldexp(bits.view("<f2").astype(numpy.float64), -about["scale"])
