"""Numbers as words, the same on every page."""
import statistics


def short(value):
    """Three digits, or all of a whole number."""
    if value == int(value) and abs(value) < 1e12:
        return f"{int(value):,}"
    if abs(value) >= 1000:
        return f"{value:,.0f}"
    text = f"{value:.3g}"
    return text if "e" not in text else f"{value:.2g}"


def spread(values, unit=""):
    """Median and range."""
    if not values:
        return ""
    low, middle, high = short(min(values)), short(statistics.median(values)), short(max(values))
    text = middle if low == high else f"{middle} ({low}–{high})"
    return f"{text} {unit}".strip()
