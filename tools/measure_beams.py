#!/usr/bin/python3
"""Measures the beam tree and Watt's caustic polygons, and writes results/beamtree: tables and plots.

Runs the sweeps experiments/sweeps/beam_*.json on one thread, one after another; their trials stay in
results/beamtree/trials (not in git). Counts are exact on any machine; times are CPU times of one
thread, so run it where nothing else runs. With --rest it measures beams of several events that photons complete
instead (experiments/sweeps/rest_*.json), and writes rest.md. Needs build/release (tools/build.sh release causticbench).
Exit codes: 0 done, 1 a sweep failed, 2 bad input or usage.
"""
import argparse
import pathlib
import re
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from report import beam_report
from report import beam_trials
from report import records
from report import rest_report
from report.program import BENCH, Program, machine
from report.report_files import write

SWEEPS = ("counts", "counts_quads", "bounds_pool", "bounds_ring", "height", "watt_ns", "watt_nd", "watt_nl")
REST = ("rest_ball", "rest_bowl", "rest_cognac")
BLOCK = "<!-- {0} -->\n{1}<!-- end of {0} -->"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--keep", action="store_true", help="take the trials that are there, run only those that are not")
    parser.add_argument("--rest", action="store_true", help="beams of several events, completed by photons, beside the photon map")
    parser.add_argument("--program", type=pathlib.Path, default=BENCH)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results" / "beamtree", metavar="DIR",
                        help="a folder with the page README.md to fill in (default: results/beamtree)")
    return parser.parse_args()


def fill(page, blocks):
    """The page with the text between its marks renewed; raises RecordsError for a mark that is missing."""
    for name, text in blocks.items():
        pattern = re.compile(BLOCK.format(re.escape(name), ".*?"), re.DOTALL)
        if len(pattern.findall(page)) != 1:
            raise records.RecordsError(f'README.md: no place for the table "{name}" (marks: {BLOCK.format(name, "...")!r})')
        page = pattern.sub(lambda _: BLOCK.format(name, text + "\n"), page)
    return page


def write_results(output, folders):
    from report import beam_plots  # here, so that a missing matplotlib differs from bad records

    cells = {name: beam_trials.read(folder) for name, folder in folders.items()}
    watt = [cells["watt_ns"], cells["watt_nd"], cells["watt_nl"]]
    blocks = {"machine": machine(folders.values()), "counts": beam_report.counts(cells["counts"] + cells["counts_quads"]),
              "bounds pool": beam_report.bounds(cells["bounds_pool"]), "bounds ring": beam_report.bounds(cells["bounds_ring"]),
              "height": beam_report.heights(cells["height"]), "watt": beam_report.watt(watt)}
    plots = {"bounds.svg": beam_plots.bounds({"pool": cells["bounds_pool"], "ring": cells["bounds_ring"]}),
             "height.svg": beam_plots.heights(cells["height"]), "watt.svg": beam_plots.watt(watt)}
    page = output / "README.md"
    write(page, fill(page.read_text(encoding="utf-8"), blocks))
    for name, text in plots.items():
        write(output / name, text)


def write_rest(output, folders):
    rows = [row for folder in folders for _, row in records.read_rows(folder / "records.csv")[1] if row["status"] == "done"]
    write(output / "rest.md", rest_report.page(rows, machine(folders)))


def measure(chosen):
    """Runs the sweeps and writes their page, whose name it returns."""
    program = Program("measure_beams", chosen.program)
    folders = {name: chosen.output / "trials" / name for name in (REST if chosen.rest else SWEEPS)}
    for name, folder in folders.items():
        program.sweep(name if chosen.rest else f"beam_{name}", folder, chosen.keep)
    if chosen.rest:
        write_rest(chosen.output, folders.values())
        return "rest.md"
    write_results(chosen.output, folders)
    return "README.md"


def main():
    chosen = arguments()
    try:
        page = measure(chosen)
    except records.RecordsError as error:
        print(f"measure_beams: {error}", file=sys.stderr)
        return 2
    except (ChildProcessError, ImportError, OSError) as error:
        print(f"measure_beams: {error}", file=sys.stderr)
        return 1
    print(f"measure_beams: {chosen.output / page}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
