"""Measured curves, (x, y) by x, between their points."""
import math


def along(curve, x):
    """y where the curve has x, as a power between neighbours; None outside of it. x may fall as well as rise."""
    for (x0, y0), (x1, y1) in zip(curve, curve[1:]):
        if min(x0, x1) <= x <= max(x0, x1) and x1 != x0:
            return math.exp(math.log(y0) + math.log(x / x0) / math.log(x1 / x0) * math.log(y1 / y0))
    return None
