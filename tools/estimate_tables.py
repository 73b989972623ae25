#!/usr/bin/python3
"""Makes the tables and heat maps of results/photonmap from the records of experiments/sweeps/estimate_*.json.

An error is the median over the seeds of sqrt(relmse), or of rmse over the reference's mean where it says so. Whatever
else a sweep varies (alpha, a mesh) makes tables and maps of its own; a table or a map that the records do not carry is
named, with the reason. The same records give the same bytes. Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import os
import re
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report import records
from report.estimate_cells import Estimate, best, fixed, settings
from report.report_files import report, write

FILTERS = ("none", "cone", "gaussian", "epanechnikov")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", metavar="DIR", help="folder with records.csv, as the sweep leaves it")
    parser.add_argument("-o", "--output", metavar="OUT", help="default: DIR/report")
    arguments = parser.parse_args()
    output = arguments.output or os.path.join(arguments.directory, "report")
    return report("estimate_tables", "the heat maps", output, lambda: write_all(arguments.directory, output))


def write_all(directory, output):
    path = os.path.join(directory, "records.csv")
    cells = [Estimate(cell) for cell in records.read(path).cells if cell.spread("relmse") and cell.spread("reference_mean")]
    parts = settings(cells)
    if not parts:
        raise records.RecordsError(f"{path}: no photonmap with `photons` was judged by a reference")
    from report import estimate_heat_maps  # here, so that a broken table is named even without matplotlib

    texts, missing = {}, []
    if others := sum(cell.method == "photonmap" and cell.photons is None for cell in cells):
        missing.append(f"{others} cells whose photons were not asked for by `photons`")
    for name, table, wanted in (("filters.md", filters, "an unfiltered raw estimate of 100,000 photons"),
                                ("adaptive.md", adaptive, "adaptive N beside fixed ones of the same filter")):
        lines = list(table(parts))
        if any(line.startswith("|") for line in lines):
            texts[name] = "\n".join(lines) + "\n"
        else:
            missing.append(f"{name} (wants {wanted})")
    maps, without = heat_maps(parts, estimate_heat_maps)
    texts.update(maps)
    missing += without
    if not texts:
        raise records.RecordsError(f"{path}: carries nothing to write: {'; '.join(missing)}")
    os.makedirs(output, exist_ok=True)
    for name, text in texts.items():
        write(os.path.join(output, name), text)
    print(f"written to {output}: {', '.join(texts)}" + (f"; left out: {'; '.join(missing)}" if missing else ""))


def heat_maps(parts, plots):
    """{file name: SVG} of a map for each setting and estimator, and why others have none."""
    drawn, missing = {}, []
    for title, own in parts.items():
        for estimator in sorted({cell.estimator() for cell in own}):
            members = [cell for cell in own if cell.estimator() == estimator]
            if reason := plots.why_none(members):
                missing.append(f"heat map of {title}, {estimator} ({reason})")
            else:
                drawn[title, estimator] = members
    maps = {}
    for (title, estimator), members in drawn.items():
        alone = len({other for scene, other in drawn if scene == title}) == 1
        words = title if alone else f"{title}, {estimator}"
        name = re.sub(r"[^\w.]+", "-", words)
        maps[f"heat_map-{name}.svg"] = plots.draw(f"{title}, {estimator}", members)
    if len(maps) < len(drawn):
        raise records.RecordsError("two heat maps would have the same file name: " + ", ".join(sorted(maps)))
    return maps, missing


def filters(parts):
    yield "Each estimator at its own best N, 100,000 photons. Error: sqrt(relmse), and rmse / mean; beside each its"
    yield "ratio to eq. 4 (`raw` without a filter)."
    for title, cells in parts.items():
        equation = fixed(cells, photons=100000, filter="none", raw=True)
        if not equation:
            continue
        yield f"\n## {title}\n"
        yield "| estimator | filter | best N | sqrt(relmse) | to eq. 4 | best N for rmse | rmse / mean | to eq. 4 |"
        yield "|---|---|---|---|---|---|---|---|"
        base = best(equation)
        for raw, kind in [(True, "none")] + [(False, kind) for kind in FILTERS]:
            own = fixed(cells, photons=100000, filter=kind, raw=raw)
            if not own:
                continue
            error, rmse = best(own)
            yield (f"| {'raw' if raw else 'unbiased'} | {kind} | {error.nearest} | {error.error:.3f} "
                   f"| {error.error / base[0].error:.2f} | {rmse.nearest} | {rmse.rmse:.3f} "
                   f"| {rmse.rmse / base[1].rmse:.2f} |")


def adaptive(parts):
    yield "Adaptive N against the best fixed N of the same filter. Ratios below 1: adaptive is better."
    yield "The best N for sqrt(relmse) and for rmse are two."
    for title, cells in parts.items():
        for estimator in sorted({cell.estimator() for cell in cells if cell.adaptive}):
            yield from adaptive_rows(title, [cell for cell in cells if cell.estimator() == estimator])


def adaptive_rows(title, cells):
    pairs = [(own, fixed(cells, photons=own.photons))
             for own in sorted((cell for cell in cells if cell.adaptive), key=lambda cell: cell.photons)]
    pairs = [(own, others) for own, others in pairs if others]
    if not pairs:
        return
    yield f"\n## {title}, {cells[0].estimator()}\n"
    yield ("| photons | best N | sqrt(relmse) | adaptive | ratio | best N for rmse | rmse / mean | adaptive | ratio "
           "| mean N used |")
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for own, others in pairs:
        error, rmse = best(others)
        yield (f"| {own.photons} | {error.nearest} | {error.error:.3f} | {own.error:.3f} "
               f"| {own.error / error.error:.2f} | {rmse.nearest} | {rmse.rmse:.3f} | {own.rmse:.3f} "
               f"| {own.rmse / rmse.rmse:.2f} | {'' if own.used is None else format(own.used, '.0f')} |")


if __name__ == "__main__":
    sys.exit(main())
