"""Figures: pictures beside each other, tone-mapped alike, and plots."""
import io

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image  # matplotlib needs it, too

from report import exr

DPI = 100
GAP, TITLE = 6, 20  # pixels
LARGE = 1_000_000  # bytes of a PNG
STYLE = {"font.family": "DejaVu Sans", "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.7,
         "legend.frameon": False, "legend.fontsize": 8, "lines.linewidth": 1.3, "lines.markersize": 4}
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def luminance(picture):
    return picture @ LUMINANCE


def mean_of(pictures, layer=""):
    """Of one layer of several."""
    return np.mean([layers[layer] for layers in pictures], axis=0)


def largest_difference(one, other):
    """In any layer of two pictures."""
    return max(float(np.abs(one[layer] - other[layer]).max()) for layer in one)


def is_diffuse(layers):
    """Which pixels see a diffuse surface and nothing else: glass has an albedo of 1, what lies behind everything 0."""
    albedo = layers["albedo"]
    return (albedo < 0.7).all(axis=2) & (albedo > 0).all(axis=2)


def white(*pictures):
    """The radiance shown as white: the 99th percentile of luminance over lit pixels."""
    lit = np.concatenate([luminance(picture)[luminance(picture) > 0] for picture in pictures])
    return float(np.percentile(lit, 99)) if lit.size else 1.0


def srgb(linear):
    """IEC 61966-2-1."""
    v = np.clip(linear, 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)


def strip(rows, level=None):
    """(PNG, EXR) of rows of (title, picture); white is `level`, a number, or one a row, or of all pictures together.

    A picture with a level of its own is (title, picture, level).
    """
    rows = [[(each[0], np.maximum(each[1], 0), each[2] if len(each) > 2 else None) for each in row] for row in rows]
    shared = [picture for row in rows for _, picture, own in row if own is None]
    level = level or (white(*shared) if shared else 1.0)
    heights = [max(picture.shape[0] for _, picture, _ in row) for row in rows]
    width = max(sum(picture.shape[1] for _, picture, _ in row) + GAP * (len(row) - 1) for row in rows)
    title_of = TITLE if any(title for row in rows for title, _, _ in row) else 0
    height = sum(heights) + title_of * len(rows) + GAP * (len(rows) - 1)
    figure = plt.figure(figsize=(width / DPI, height / DPI), dpi=DPI)
    linear = np.zeros((sum(heights) + GAP * (len(rows) - 1), width, 3), np.float32)
    top = below = 0
    for row, tall in zip(rows, heights):
        left = 0
        for title, picture, own in row:
            high, wide = picture.shape[:2]
            figure.text(left / width, 1 - (top + title_of * 0.75) / height, title, fontsize=8.5, va="baseline")
            ax = figure.add_axes([left / width, 1 - (top + title_of + high) / height, wide / width, high / height])
            ax.imshow(srgb(picture / (own or level)), interpolation="none", aspect="auto")
            ax.axis("off")
            linear[below:below + high, left:left + wide] = picture
            left += wide + GAP
        top += title_of + tall + GAP
        below += tall + GAP
    return png(figure), exr.encode(linear)


def plot(draw, width=6.4, height=3.2, columns=1):
    """PNG of `columns` axes that draw(axes) fills."""
    with matplotlib.rc_context(STYLE):
        figure, axes = plt.subplots(1, columns, figsize=(width, height), dpi=150, layout="constrained", squeeze=False)
        draw(*axes[0])
        return png(figure)


def png(figure):
    drawn, data = io.BytesIO(), io.BytesIO()
    figure.savefig(drawn, format="png", metadata={"Software": None})
    plt.close(figure)
    picture = Image.open(drawn).convert("RGB")
    picture.save(data, format="png", optimize=True)
    if len(data.getvalue()) > LARGE:  # noise does not compress: 256 colours of its own, dithered
        data = io.BytesIO()
        palette = picture.quantize(256)
        picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(data, format="png", optimize=True)
    return data.getvalue()
