#!/usr/bin/python3
"""Fills the column `flip` of a sweep's records: how different its pictures look beside their references.

Usage: .venv/bin/python tools/flip_column.py DIR [--references FOLDER]

HDR-FLIP (Andersson et al. 2021) by the package flip-evaluator, averaged over the pixels that the trial and its reference
reach, between two pictures that differ in the caustic alone: the reference's beauty, and the same with the trial's
caustic in place of the reference's. Its defaults (67 pixels a degree, ACES), and its rule for the exposures from the
reference, with the median over the pixels that are not black: it has none where half of a picture is.

Writes `flip` to DIR/trials/ID/record.json, from which a sweep and `merge` make their tables, and to DIR/records.csv and
records.jsonl; the map of each picture, which the report shows, to DIR/trials/ID/flip.exr (channel flip.Y). References are looked for in DIR/references, then in FOLDER (default: experiments/references).
Without flip-evaluator, NumPy and OpenEXR (tools/flip-requirements.txt) nothing is changed, so that the column stays
empty, and a line says so. Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import csv
import io
import json
import math
import os
import pathlib
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report import records
from report.report_files import report, write

REFERENCES = pathlib.Path(__file__).resolve().parent.parent / "experiments" / "references"
LUMINANCE = (0.2126, 0.7152, 0.0722)
ACES_WHITE = 2.1188  # what FLIP's tone curve maps to 0.85: its exposures bring the brightest and the median there


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", metavar="DIR", type=pathlib.Path, help="folder of a sweep that has run")
    parser.add_argument("--references", metavar="FOLDER", type=pathlib.Path, default=REFERENCES)
    arguments = parser.parse_args()
    try:
        import flip_evaluator, numpy, OpenEXR  # noqa: F401
    except ImportError as error:
        print(f"flip_column: {error}: the column flip stays empty (pip install -r tools/flip-requirements.txt)",
              file=sys.stderr)
        return 0
    return report("flip_column", "the column", arguments.directory,
                  lambda: fill(arguments.directory, arguments.references))


def fill(directory, references):
    found = {}
    for _, row in records.read_rows(directory / "records.csv")[1]:
        if row["status"] == "done" and row["reference"]:
            found[row["trial"]] = score(directory, references, row["trial"])
    write_tables(directory, found)


def score(directory, references, trial):
    """The trial's FLIP, written to its record, with its map beside it; None where its reference is black."""
    file = directory / "trials" / trial / "record.json"
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
        key = record["reference"]["key"]
    except (ValueError, KeyError) as error:
        raise records.RecordsError(f"{file}: no record of a trial with a reference ({error})") from error
    places = [folder / f"{key}.exr" for folder in (directory / "references", references)]
    reference = next((place for place in places if place.is_file()), None)
    if reference is None:
        raise records.RecordsError(f"{file}: no reference {places[0]} or {places[1]} (give --references its folder)")
    record["flip"], errors = flip(read_layers(file.with_name("image.exr")), read_layers(reference))
    if errors is not None:
        write_map(file.with_name("flip.exr"), errors, record.get("picture_hash", ""))
    write(file, json.dumps(record, indent=2, ensure_ascii=False) + "\n")
    return record["flip"]


def read_layers(file):
    """Layer -> height x width x 3 ('' = beauty), and `unreached`, height x width, where it is there."""
    import numpy
    import OpenEXR
    if not file.is_file():
        raise records.RecordsError(f"{file}: no such picture")
    planes = {name: plane.pixels for name, plane in OpenEXR.File(str(file), separate_channels=True).channels().items()}
    layers = {layer: numpy.stack([planes[f"{prefix}{channel}"] for channel in "RGB"], axis=2)
              for layer, prefix in (("", ""), ("caustic", "caustic."))}
    layers["unreached"] = planes.get("unreached.Y", numpy.zeros_like(planes["R"]))
    return layers


def write_map(file, errors, picture_hash):
    """The map as an OpenEXR file that names the picture it is of."""
    import numpy
    import OpenEXR
    part = file.with_name("flip.part.exr")
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "causticbench.picture_hash": picture_hash}
    OpenEXR.File(header, {"flip.Y": numpy.ascontiguousarray(errors, numpy.float32)}).write(str(part))
    os.replace(part, file)


def flip(picture, reference):
    """(mean, map) of HDR-FLIP of the picture's caustic in the reference's surroundings; (None, None) for a black reference."""
    import flip_evaluator
    import numpy
    if picture["caustic"].shape != reference["caustic"].shape:
        raise records.RecordsError(f"a picture of {picture['caustic'].shape[:2]} pixels beside a reference of "
                                   f"{reference['caustic'].shape[:2]}")
    reached = (picture["unreached"] == 0) & (reference["unreached"] == 0)
    exposures = exposures_of(reference[""])
    if exposures is None or not reached.any():
        return None, None
    changed = numpy.maximum(reference[""] + picture["caustic"] - reference["caustic"], 0)
    shown = numpy.where(reached[..., None], changed, reference[""])
    errors, _, _ = flip_evaluator.evaluate(numpy.maximum(reference[""], 0), shown, "HDR", applyMagma=False,
                                           computeMeanError=False, parameters=exposures)
    return float(errors[..., 0][reached].mean(dtype=float)), errors[..., 0]


def exposures_of(picture):
    """FLIP's first and last exposure [stops], at least one apart."""
    import numpy
    luminance = picture @ numpy.array(LUMINANCE)
    lit = luminance[luminance > 0]
    if not lit.size:
        return None
    start = math.log2(ACES_WHITE / lit.max())
    return {"startExposure": start, "stopExposure": max(math.log2(ACES_WHITE / float(numpy.median(lit))), start + 1)}


def write_tables(directory, found):
    """The tables with the column; a table from before there was one gets it as its last."""
    header, rows = records.read_rows(directory / "records.csv")
    columns = header if "flip" in header else [*header, "flip"]
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    for _, row in rows:
        value = found.get(row["trial"])
        fields = {name: records.marked(field) for name, field in row.items()}
        writer.writerow({**fields, "flip": "" if value is None else repr(value)})
    write(directory / "records.csv", text.getvalue())
    lines = directory / "records.jsonl"
    if lines.is_file():
        kept = [json.loads(line) for line in lines.read_text(encoding="utf-8").splitlines()]
        write(lines, "".join(json.dumps({**row, "flip": found.get(row["trial"])}, ensure_ascii=False,
                                        separators=(",", ":")) + "\n" for row in kept))


if __name__ == "__main__":
    sys.exit(main())
