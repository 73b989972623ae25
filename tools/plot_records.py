#!/usr/bin/python3
"""Makes plots, tables (CSV, Markdown, LaTeX) and a page from DIR/records.csv, and from nothing else.

With --x or --metric only those plots are made, for a paper: tools/plot_records.py out -o figures --metric relmse --x time
--filter scene=ring --format pdf --bare --slope -0.5. The same records give the same bytes. Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import os
import re
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report import record_tables
from report import records
from report.report_files import report, write

OWN_PLOT = re.compile(r"((rmse|relmse|mean_ratio)_vs_(photons|time|alpha|mesh_resolution)-.*|mean_ratio)\.svg")

STEEPEST = 10  # slope of a guide


def main():
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0],
        epilog="Other axes, metrics, colours and tables of chosen rows and columns: causticbench report DIR [--tables OUT].")
    parser.add_argument("directory", metavar="DIR", help="folder with records.csv, as a sweep leaves it")
    parser.add_argument("-o", "--output", metavar="OUT", help="where the report goes (default: DIR/report)")
    parser.add_argument("--metric", metavar="COLUMN", help="what is drawn: rmse, relmse, flip, indirect_rmse … (with --x alone: rmse)")
    parser.add_argument("--x", metavar="NAME", help="against what: time, photons, or a swept number (with --metric alone: time)")
    parser.add_argument("--filter", metavar="KEY=VALUE", action="append", default=[], help="only records with that value. Repeatable")
    parser.add_argument("--format", choices=("svg", "pdf", "png"), default="svg", help="of the plots (default: svg)")
    parser.add_argument("--width", metavar="INCHES", type=float, default=3.5, help="of a figure of one panel (default: 3.5)")
    parser.add_argument("--slope", metavar="EXPONENT", type=float, help="draws a guide of that slope, such as -0.5")
    parser.add_argument("--interval", action="store_true", help="points are means over the seeds, bands their 95 %% intervals by "
                        "Student's t (default: medians and ranges)")
    parser.add_argument("--bare", action="store_true", help="without the words above the axes, for a paper's own caption")
    arguments = parser.parse_args()
    if not 1 <= arguments.width <= 40:
        parser.error(f"--width: {arguments.width:g} is not from 1 to 40 inches")
    if arguments.slope is not None and not -STEEPEST <= arguments.slope <= STEEPEST:
        parser.error(f"--slope: {arguments.slope:g} is not from {-STEEPEST} to {STEEPEST}")
    if not arguments.output and (arguments.metric or arguments.x or arguments.filter or arguments.interval or arguments.format != "svg"):
        parser.error("--metric, --x, --filter, --interval and --format need -o: DIR/report is of all records")
    output = arguments.output or os.path.join(arguments.directory, "report")
    own = [os.path.join(output, "plots")] + ([] if arguments.output else [output])
    return report("plot_records", "the plots", output, lambda: write_report(arguments, output, own))


def write_report(arguments, output, own):
    """Writes into `output`. None of the folders `own` may be a link: results may come from anywhere."""
    for folder in filter(os.path.islink, own):
        raise records.RecordsError(f"{folder}: is a symbolic link, which leads out of the results (name a folder by -o)")
    directory = arguments.directory
    table = records.read(os.path.join(directory, "records.csv"))
    for condition in arguments.filter:
        keep(table, condition)
    from report import record_plots  # here, so that a broken table is named even without matplotlib

    look = record_plots.Look(arguments.format, arguments.width, arguments.slope, arguments.bare, arguments.interval)
    plots, left_out = record_plots.make(table, kinds(arguments, table, record_plots.KINDS), look)
    os.makedirs(os.path.join(output, "plots"), exist_ok=True)
    for name, _, text in plots:
        write(os.path.join(output, "plots", name), text)
    written = [name for name, _, _ in plots]
    for name in os.listdir(os.path.join(output, "plots")):
        if OWN_PLOT.fullmatch(name) and name not in written:
            os.remove(os.path.join(output, "plots", name))  # of an earlier state of the records
    write(os.path.join(output, "summary.csv"), record_tables.summary_csv(table))
    write(os.path.join(output, "summary.md"), record_tables.summary_md(table))
    write(os.path.join(output, "summary.tex"), record_tables.summary_tex(table))
    links = [(f"plots/{name}", caption) for name, caption, _ in plots]
    figures = find_figures(os.path.join(directory, "report", "figures"), output)
    write(os.path.join(output, "index.html"), record_tables.page(table, links, figures))
    tell(table, written, left_out, output)


def keep(table, condition):
    """Leaves the records of the table that have a value."""
    key, equals, value = condition.partition("=")
    known = sorted({name for cell in table.cells for record in cell.records for name in record})
    if not equals or key not in known:
        raise records.RecordsError(f'--filter {condition}: not a KEY=VALUE with a column of the table (known: {", ".join(known)})')
    for cell in table.cells:
        cell.records = [record for record in cell.records if records.same(record[key], value)]
    table.cells = [cell for cell in table.cells if cell.records]
    if not table.cells:
        raise records.RecordsError(f"--filter {condition}: no record that is done has it")


def kinds(arguments, table, usual):
    """The plots that are asked for."""
    if not (arguments.metric or arguments.x):
        return usual
    from report.plot_panels import Kind
    metric, x = arguments.metric or "rmse", arguments.x or "time"
    numbers = [name for name in records.MEASURES if any(cell.spread(name) for cell in table.cells)]
    if metric not in numbers:
        raise records.RecordsError(f"--metric {metric}: no number of the table (known: {', '.join(numbers)})")
    swept = sorted({name for cell in table.cells for name, value in cell.parameters.items() if records.as_number(value) is not None})
    if x not in ("time", "photons", *swept):
        raise records.RecordsError(f"--x {x}: not time, photons or a swept number ({', '.join(swept)})")
    return (Kind(metric, x),)


def find_figures(folder, output):
    """Every PNG under the folder, relative to the page, in a fixed order."""
    found = [os.path.join(place, name) for place, _, names in os.walk(folder)
             for name in names if name.lower().endswith(".png")]
    return sorted(os.path.relpath(path, output).replace(os.sep, "/") for path in found)


def tell(table, written, left_out, output):
    done = sum(len(cell.records) for cell in table.cells)
    counts = ", ".join(f"{count} {status}" for status, count in sorted(table.left_out.items()))
    print(f"records: {done} done" + (f"; left out of the plots: {counts}" if counts else ""))
    print("plots written: " + (", ".join(written) or "none") + "; left out: " + (reasons(table, left_out) or "none"))
    print(f"report: {os.path.join(output, 'index.html')}")


def reasons(table, left_out):
    """One phrase per plot and reason; the scenes are named unless it is all of them."""
    scenes = {}
    for plot, scene, reason in left_out:
        scenes.setdefault((plot, reason), []).append(scene)
    phrase = lambda names: "" if None in names or len(names) == len(table.scenes()) else " of " + ", ".join(names)
    return ", ".join(f"{plot}{phrase(names)} ({reason})" for (plot, reason), names in scenes.items())


if __name__ == "__main__":
    sys.exit(main())
