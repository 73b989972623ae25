#!/usr/bin/python3
"""Makes the tables and plots of results/photonmap that compare by time, from the records of
experiments/sweeps/equal_time_*.json and alpha_sampling.json.

Times are CPU times of one thread, of precompute and eye pass together, medians over the seeds or repeats. The same records
give the same bytes. Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import math
import os
import statistics
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report import records
from report.curves import along
from report.estimate_cells import Estimate
from report.paper import Paper
from report.report_files import report, write

TIMES = (0.5, 0.7, 1.0, 1.5, 2.0, 3.0)  # seconds
PASSES_OF = 20000  # photons


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("directory", metavar="DIR", help="folder with records.csv, as the sweep leaves it")
    parser.add_argument("-o", "--output", metavar="OUT", help="default: DIR/report")
    arguments = parser.parse_args()
    output = arguments.output or os.path.join(arguments.directory, "report")
    return report("time_tables", "the plots", output, lambda: write_all(arguments.directory, output))


def write_all(directory, output):
    from report import time_plots  # here, so that a missing matplotlib differs from bad records

    cells = records.read(os.path.join(directory, "records.csv")).cells
    scored = [Estimate(cell) for cell in cells if cell.spread("relmse")]
    os.makedirs(output, exist_ok=True)
    by_scene = {scene: [cell for cell in scored if cell.scene == scene] for scene in sorted({c.scene for c in scored})}
    curves = {scene: curves_of(own) for scene, own in by_scene.items()}
    tables = {"progressive.md": progressive(by_scene), "equal_time.md": equal_time(curves),
              "sampling.md": sampling([cell for cell in cells if "max_samples" in cell.parameters])}
    for name, lines in tables.items():
        write(os.path.join(output, name), "\n".join(lines) + "\n")
    write(os.path.join(output, "equal_time.svg"), time_plots.draw(curves))


def progressive(by_scene):
    yield f"Progressive passes of {PASSES_OF:,} photons, N = 30: mean squared error over mean², and the fitted power of the"
    yield "number of passes. Theory: -2/3, once discs are small against what they show. At folds blur falls more slowly,"
    yield "and what the reference and the camera samples leave does not fall at all."
    for scene, cells in by_scene.items():
        own = sorted((cell for cell in cells if cell.photons == PASSES_OF), key=lambda cell: cell.passes)
        if len(own) < 2:
            continue
        yield f"\n## {scene}: power {power([(cell.passes, cell.square) for cell in own]):.2f}\n"
        yield "| passes | mse / mean² | sqrt(relmse) | seconds |"
        yield "|---|---|---|---|"
        for cell in own:
            yield f"| {cell.passes} | {cell.square:.4f} | {cell.error:.3f} | {cell.seconds:.2f} |"


def power(points):
    """The slope of log y over log x, by least squares."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean = [statistics.mean(part) for part in zip(*logs)]
    return sum((x - mean[0]) * (y - mean[1]) for x, y in logs) / sum((x - mean[0]) ** 2 for x, _ in logs)


def curves_of(cells):
    """{what a user would call it: [(seconds, error, least, greatest)] in the order of seconds}."""
    curves = {}
    for cell in cells:
        curves.setdefault(words(cell), []).append((cell.seconds, cell.error, cell.least, cell.greatest))
    return {name: sorted(curves[name]) for name in sorted(curves)}


def words(cell):
    if cell.method == "illuminationmap":
        return f"illuminationmap, {cell.resolution} texels a side"
    if cell.method != "photonmap":
        return cell.method
    if cell.photons == PASSES_OF:
        return "photonmap, passes"
    return "photonmap, adaptive" if cell.adaptive else f"photonmap, N = {cell.nearest}"


def equal_time(curves_by_scene):
    yield "sqrt(relmse) after equal CPU times of precompute and eye pass on one thread, interpolated (as powers) between the"
    yield "measured numbers of photons, passes or paths; – where the time is outside what was measured. `lighttrace` has no"
    yield "light in pixels that see the floor through glass: there it is not judged."
    for scene, curves in curves_by_scene.items():
        yield f"\n## {scene}\n"
        yield "| method | " + " | ".join(f"{time:g} s" for time in TIMES) + " |"
        yield "|---|" + "---|" * len(TIMES)
        for name, curve in curves.items():
            values = [along([point[:2] for point in curve], time) for time in TIMES]
            yield f"| {name} | " + " | ".join("–" if value is None else f"{value:.3f}" for value in values) + " |"


def sampling(cells):
    """[J96, figure 1]: times for alpha 1, 0.5, 0.1 and 0.01, and without caustics."""
    jensen = Paper("jensen1996")
    paper = {alpha: jensen.number(f"figure1_rendering_{alpha}_s") for alpha in ("1", "0.5", "0.1", "0.01")}
    said = [str(seconds) for seconds in paper.values()]
    yield f"Figure 1 of the paper: 320 × 240 pixels, {jensen.number('figure1_photons'):,} photons, N = 80; adaptive sampling (4 to 64 samples a pixel)"
    yield f"beside the fixed rate of 4. Seconds of the eye pass; in brackets the same without caustics. The paper: {', '.join(said[:3])},"
    yield f"{said[3]} s, and {jensen.number('figure1_bare_s')} s without.\n"
    yield "| alpha | samples a pixel, adaptive | seconds | to alpha = 1 | the paper | samples a pixel, fixed | seconds | to alpha = 1 |"
    yield "|---|---|---|---|---|---|---|---|"
    table = {(cell.method, cell.parameters["alpha"], cell.parameters["max_samples"]): cell for cell in cells}
    seconds = lambda *key: table[key].spread("render_cpu_s").median
    for alpha, theirs in paper.items():
        if ("photonmap", alpha, "64") not in table:
            continue
        yield f"| {alpha} | " + f" | ".join(
            f"{table['photonmap', alpha, most].spread('camera_rays').median / (320 * 240):.2f} "
            f"| {seconds('photonmap', alpha, most):.2f} ({seconds('none', alpha, most):.2f}) "
            f"| {seconds('photonmap', alpha, most) / seconds('photonmap', '1', most):.2f}"
            + (f" | {theirs / paper['1']:.2f}" if most == "64" else "") for most in ("64", "4")) + " |"


if __name__ == "__main__":
    sys.exit(main())
