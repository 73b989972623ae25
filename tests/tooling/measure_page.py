#!/usr/bin/python3
"""Measures a report's page in a real browser: its size, when its first picture stands, what it asks for, whether it fits the window.

Usage: tests/tooling/measure_page.py PAGE [-o results/bench/page.md] [--pictures DIR]

The page is opened from the disk by headless Chromium (Debian's package), seven times at each window size; seconds are those on the
wall from opening to the first picture (the strip) and to the viewer of single pictures. DIR gets what is seen at first.
"""
import argparse
import os
import pathlib
import statistics
import sys
import time

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import browser
from report.program import processor, show

WINDOWS = ((1920, 1080), (1280, 720))
OPENINGS = 7


def seconds_until(page, element):
    """From opening the page until the element is drawn."""
    page.open("about:blank")
    page.call("Page.navigate", url=page.address)
    begun = time.monotonic()
    page.wait_for(f"typeof byId === 'function' && byId('{element}') && byId('{element}').dataset.ready && true")
    return time.monotonic() - begun


def row(file, width, height, pictures):
    page = browser.Browser(width, height)
    page.address = file.as_uri()
    try:
        strip, viewer = ([seconds_until(page, element) for _ in range(OPENINGS)] for element in ("strip", "viewer"))
        wider = page.run("document.documentElement.scrollWidth - innerWidth")
        if pictures:
            pictures.mkdir(parents=True, exist_ok=True)
            page.screenshot(pictures / f"page_{width}.png")
        asked = {url for url in page.requests if not url.startswith(("data:", "about:"))} - {page.address}
        spread = lambda values: f"{statistics.median(values):.2f} ({min(values):.2f}–{max(values):.2f})"
        return (f"| {width} × {height} | {spread(strip)} | {spread(viewer)} | {'yes' if wider <= 0 else f'{wider} pixels too wide'} | "
                f"{len(page.console)} | {len(asked)} |")
    finally:
        page.close()


def table(file, pictures):
    yield "# The report's page\n"
    yield (f"By `tests/tooling/measure_page.py {file.name}`: {file.stat().st_size / 1e6:.1f} MB; {processor()}, {os.cpu_count()} processors, "
           f"load average {os.getloadavg()[0]:.1f}; {OPENINGS} openings each, median (least–greatest).\n")
    yield "| window | s to the first picture | s to the viewer | fits its width | complaints | requests beside the file |\n|---|---|---|---|---|---|"
    for width, height in WINDOWS:
        yield row(file, width, height, pictures)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("page", type=pathlib.Path, metavar="PAGE")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE", help="where the table goes, too")
    parser.add_argument("--pictures", type=pathlib.Path, metavar="DIR", help="for what is seen at first (PNG)")
    chosen = parser.parse_args()
    if browser.PROGRAM is None:
        sys.exit("measure_page: needs the Debian package chromium")
    if not chosen.page.is_file():
        parser.error(f"{chosen.page}: no such file")
    show(table(chosen.page.resolve(), chosen.pictures), chosen.output)


if __name__ == "__main__":
    main()
