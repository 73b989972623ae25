#!/usr/bin/python3
"""Makes the tables and heat maps of results/photonmap from the records of experiments/sweeps/estimate_*.json.

An error is the median over the seeds of sqrt(relmse), or of rmse over the reference's mean where it says so. The same
records give the same bytes. Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import os
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

import records
from estimate_cells import Estimate, best, fixed
from report_files import report, write

FILTERS = ("none", "cone", "gaussian", "epanechnikov")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", metavar="DIR", help="folder with records.csv, as the sweep leaves it")
    parser.add_argument("-o", "--output", metavar="OUT", default="results/photonmap", help="default: %(default)s")
    arguments = parser.parse_args()
    return report("estimate_tables", "the heat maps", arguments.output,
                  lambda: write_all(arguments.directory, arguments.output))


def write_all(directory, output):
    cells = [Estimate(cell) for cell in records.read(os.path.join(directory, "records.csv")).cells]
    import estimate_heat_maps  # here, so that a broken table is named even without matplotlib

    os.makedirs(output, exist_ok=True)
    scenes = sorted({cell.scene for cell in cells})
    tables = {"filters.md": filters, "adaptive.md": adaptive}
    for name, table in tables.items():
        write(os.path.join(output, name), "\n".join(table(cells, scenes)) + "\n")
    for scene in scenes:
        picture = estimate_heat_maps.draw([cell for cell in cells if cell.scene == scene])
        if picture:
            write(os.path.join(output, f"heat_map-{scene}.svg"), picture)


def filters(cells, scenes):
    yield "Each estimator at its own best N, 100,000 photons. Error: sqrt(relmse), and rmse / mean; beside each its"
    yield "ratio to eq. 4 (`raw` without a filter)."
    for scene in scenes:
        equation = fixed(cells, scene, photons=100000, filter="none", raw=True)
        if not equation:
            continue
        yield f"\n## {scene}\n"
        yield "| estimator | filter | best N | sqrt(relmse) | to eq. 4 | best N for rmse | rmse / mean | to eq. 4 |"
        yield "|---|---|---|---|---|---|---|---|"
        base = best(equation)
        for raw, kind in [(True, "none")] + [(False, kind) for kind in FILTERS]:
            own = fixed(cells, scene, photons=100000, filter=kind, raw=raw)
            if not own:
                continue
            error, rmse = best(own)
            yield (f"| {'raw' if raw else 'unbiased'} | {kind} | {error.nearest} | {error.error:.3f} "
                   f"| {error.error / base[0].error:.2f} | {rmse.nearest} | {rmse.rmse:.3f} "
                   f"| {rmse.rmse / base[1].rmse:.2f} |")


def adaptive(cells, scenes):
    yield "Adaptive N against the best fixed N, both with the Epanechnikov filter. Ratios below 1: adaptive is better."
    yield "The best N for sqrt(relmse) and for rmse are two."
    for scene in scenes:
        yield f"\n## {scene}\n"
        yield ("| photons | best N | sqrt(relmse) | adaptive | ratio | best N for rmse | rmse / mean | adaptive | ratio "
               "| mean N used |")
        yield "|---|---|---|---|---|---|---|---|---|---|"
        for own in sorted((cell for cell in cells if cell.scene == scene and cell.method == "photonmap" and cell.adaptive),
                          key=lambda cell: cell.photons):
            others = fixed(cells, scene, photons=own.photons, filter=own.filter, raw=False)
            if not others:
                continue
            error, rmse = best(others)
            yield (f"| {own.photons} | {error.nearest} | {error.error:.3f} | {own.error:.3f} "
                   f"| {own.error / error.error:.2f} | {rmse.nearest} | {rmse.rmse:.3f} | {own.rmse:.3f} "
                   f"| {own.rmse / rmse.rmse:.2f} | {own.used:.0f} |")


if __name__ == "__main__":
    sys.exit(main())
