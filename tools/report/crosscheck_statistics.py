"""Whether two estimates of one picture differ by more than the spread of their seeds."""
import numpy as np

DRAWS = 50_000  # simulated pictures that a p-value is a share of


def cells(picture, mask, side):
    """Mean radiance of the pixels of `mask` in each square of `side` pixels; NaN where there are none."""
    height, width = mask.shape
    shape = (height // side, side, width // side, side)
    counted = mask.reshape(shape).sum(axis=(1, 3)).astype(float)
    total = np.where(mask, picture.mean(axis=2), 0).reshape(shape).sum(axis=(1, 3))
    return np.where(counted > 0, total / np.maximum(counted, 1), np.nan).ravel()


def of_pictures(pictures, mask, side):
    """What compare() wants of an estimator: one row a seed."""
    return {"cells": np.array([cells(p, mask, side) for p in pictures]),
            "means": np.array([p[mask].mean() for p in pictures])}


def relative_error(means):
    """Standard error of the mean over the seeds, as a share of it."""
    return means.std(ddof=1) / np.sqrt(len(means)) / means.mean()


def ratio_of(a, b):
    """Of the means over the seeds, and its standard error."""
    ratio = a.mean() / b.mean()
    return ratio, ratio * float(np.hypot(relative_error(a), relative_error(b)))


def compare(a, b, generator):
    """Ratio of the means of a to b with its standard error, and of the caustics alone, where b says what is direct;
    z-scores by cell, and how likely chance alone is to give as large a sum of their squares (p_squares) and as large
    a largest one (p_largest).

    The standard errors come from few seeds, so that the scores are Student's with Welch's degrees of freedom: what
    chance gives is drawn, cell by cell.
    """
    n = len(a["means"])
    ratio, ratio_error = ratio_of(a["means"], b["means"])
    direct = b.get("direct")
    caustic_ratio, caustic_error = (ratio, ratio_error) if direct is None else ratio_of(a["means"] - direct, b["means"] - direct)
    squares = [x["cells"].var(axis=0, ddof=1) / n for x in (a, b)]
    used = np.isfinite(squares[0] + squares[1]) & (squares[0] + squares[1] > 0)
    of_a, of_b = squares[0][used], squares[1][used]
    z = (a["cells"].mean(axis=0) - b["cells"].mean(axis=0))[used] / np.sqrt(of_a + of_b)
    degrees = (n - 1) * (of_a + of_b) ** 2 / (of_a ** 2 + of_b ** 2)
    drawn = generator.standard_t(degrees, size=(DRAWS, len(z)))
    as_large = lambda found, by_chance: (1 + int((by_chance >= found).sum())) / (1 + DRAWS)
    return {"ratio": ratio, "ratio_error": ratio_error, "caustic_ratio": caustic_ratio, "caustic_error": caustic_error,
            "cells": len(z),
            "z2_mean": float((z ** 2).mean()), "z2_expected": float((drawn ** 2).mean()),
            "z_largest": float(np.abs(z).max()),
            "above_3": int((np.abs(z) > 3).sum()), "above_3_expected": float((np.abs(drawn) > 3).mean() * len(z)),
            "p_squares": as_large((z ** 2).sum(), (drawn ** 2).sum(axis=1)),
            "p_largest": as_large(np.abs(z).max(), np.abs(drawn).max(axis=1))}


def is_remarkable(pair, pairs):
    """Whether a score of the pair is one that chance gives to fewer than 1 in 100 whole tables (Bonferroni)."""
    return 2 * len(pairs) * min(pair["p_squares"], pair["p_largest"]) < 0.01
