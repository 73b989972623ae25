#!/usr/bin/python3
"""Makes plots (SVG), tables (CSV, Markdown, LaTeX) and a page from DIR/records.csv, and from nothing else.

The same records give the same bytes. Exit codes: 0 done, 2 bad input or usage.
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


def main():
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0],
        epilog="Other axes, metrics, colours and tables of chosen rows and columns: causticbench report DIR [--tables OUT].")
    parser.add_argument("directory", metavar="DIR", help="folder with records.csv, as a sweep leaves it")
    parser.add_argument("-o", "--output", metavar="OUT", help="where the report goes (default: DIR/report)")
    arguments = parser.parse_args()
    output = arguments.output or os.path.join(arguments.directory, "report")
    own = [os.path.join(output, "plots")] + ([] if arguments.output else [output])
    return report("plot_records", "the plots", output, lambda: write_report(arguments.directory, output, own))


def write_report(directory, output, own):
    """Writes into `output`. None of the folders `own` may be a link: results may come from anywhere."""
    for folder in filter(os.path.islink, own):
        raise records.RecordsError(f"{folder}: is a symbolic link, which leads out of the results (name a folder by -o)")
    table = records.read(os.path.join(directory, "records.csv"))
    from report import record_plots  # here, so that a broken table is named even without matplotlib

    plots, left_out = record_plots.make(table)
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
