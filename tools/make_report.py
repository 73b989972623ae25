#!/usr/bin/python3
"""Makes one HTML file of the records and pictures of sweeps: it opens without a network and holds everything it shows.

Usage: causticbench report DIR [DIR...] -o report.html, or tools/make_report.py with the same words. DIR is the folder of a
sweep; its references are looked for in DIR/references, then in the folder of --references. A missing or damaged picture
is a hole in the page with its reason. The same records and pictures give the same bytes. Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import os
import pathlib
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report.records import RecordsError
from report.report_files import Progress, end_on_interrupt, no_folder, report, require_place, write

end_on_interrupt("report")  # what follows may take a while to load

from report_page import scenes, tables


def arguments():
    parser = argparse.ArgumentParser(prog="causticbench report", description=__doc__.split("\n\n")[0])
    parser.add_argument("directories", metavar="DIR", nargs="+", help="folder with records.csv, as a sweep leaves it")
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the page to write: report.html")
    parser.add_argument("--tables", metavar="FOLDER", help="writes every table there, as CSV and as LaTeX (booktabs)")
    parser.add_argument("--columns", metavar="NAMES", type=lambda text: text.split(","),
                        help=f"columns of the LaTeX tables, of {', '.join(tables.KNOWN)} (default: {','.join(tables.USUAL)})")
    parser.add_argument("--references", metavar="FOLDER", type=pathlib.Path, help="where references are kept as well")
    parser.add_argument("--megabytes", metavar="NUMBER", type=positive, default=30,
                        help="most that the pictures may take; what does not fit is left out and named (default: 30)")
    return parser.parse_args()


def positive(text):
    number = float(text)
    if not 0 < number < float("inf"):
        raise argparse.ArgumentTypeError(f'"{text}" is not a number above 0')
    return number


def require_folder(path):
    if above := no_folder(path):
        raise RecordsError(f"{path}: no folder for tables ({above} is none)")


def columns_of(chosen):
    """Of the LaTeX tables."""
    if chosen.columns is None:
        return tables.USUAL
    tables.check_columns(chosen.columns)
    if not chosen.tables:
        raise RecordsError("--columns: belongs to --tables, whose LaTeX tables have them")
    return chosen.columns


def require_references(folder):
    if folder is not None and not folder.is_dir():
        raise RecordsError(f"--references {folder}: {'is no' if folder.exists() else 'no such'} folder")


def write_report(chosen):
    columns = columns_of(chosen)
    require_references(chosen.references)
    require_place(chosen.output)
    if not chosen.output.endswith(".html"):
        raise RecordsError(f"{chosen.output}: pages are written as .html")
    if chosen.tables:
        require_folder(chosen.tables)
    sweeps = [scenes.Sweep(directory) for directory in chosen.directories]
    scenes.require_each_once(sweeps)
    found = scenes.scenes_of(sweeps)
    from report_page import page  # here, so that a broken table is named even without NumPy

    folders = [folder for folder in (chosen.references, *page.REFERENCES) if folder]
    progress = Progress("report", page.picture_count(found))
    text, notes = page.make(sweeps, found, folders, chosen.megabytes, progress.step)
    progress.end()
    write(chosen.output, text)
    written = [chosen.output]
    if chosen.tables:
        os.makedirs(chosen.tables, exist_ok=True)
        for name, table in tables.all_of(found, columns):
            write(os.path.join(chosen.tables, name), table)
        written.append(chosen.tables)
    for note in notes:
        print(f"report: note: {note}", file=sys.stderr)
    print(f"report: {', '.join(written)} ({len(text.encode()) / 1e6:.1f} MB)")


def main():
    chosen = arguments()
    return report("report", "the page", chosen.output, lambda: write_report(chosen))


if __name__ == "__main__":
    sys.exit(main())
