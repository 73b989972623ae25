"""records.csv: its rows, checked, and grouped into cells.

A *record* is one trial that is done. A *cell* is every record that differs only in seed and repeat; medians and ranges
are always taken over a cell. The swept keys are those columns after `code_version` that plan.json names, or that are not known
below as something else and are no measures; an empty field means that a quantity does not apply to its row.
"""
import csv
import dataclasses
import json
import math
import os
import re
import statistics

from report.intervals import half_interval

STATUSES = ("done", "failed", "timeout", "interrupted", "unsupported")
FIXED_PARAMETERS = ("nearest", "alpha", "mesh_resolution", "threads", "isa", "code_version")
OPTIONAL_PARAMETERS = ("spp", "indirect")
# The first of these that a row has says how many photons were asked for.
PHOTON_PARAMETERS = ("photons", "emitted", "photons_stored")
REQUIRED = ("trial", "status", "scene", "method", "seed", "repeat", "photons_stored", "total_s",
            "rmse", "relmse", "mean_ratio", "reference_stderr") + FIXED_PARAMETERS
MEASURES = ("photons_emitted", "photons_stored", "parse_s", "precompute_s", "balance_s", "render_s", "total_s",
            "cpu_s", "rmse", "relmse", "bias", "variance", "mean_ratio", "leak_energy", "beauty_rmse",
            "unreached_fraction", "reference_stderr", "reference_mean", "mask_rmse", "mask_relmse", "mask_mean_ratio",
            "mask_fraction", "flip", "parse_cpu_s", "precompute_cpu_s", "balance_cpu_s", "render_cpu_s", "gathers",
            "gathered_photons", "nodes_visited", "nodes_passed", "used_photons", "camera_rays", "trees", "trees_binned", "nodes", "tree_height",
            "casters_with_face_normals", "flux_share_captured", "flux_share_pruned", "flux_share_over_budget",
            "flux_share_rest", "events_by_beams", "beam_share", "pencils_traced", "pencil_prints", "rest_photons_stored",
            "beams_unreceived", "photons_aimed", "photons_reflected",
            "photons_refracted", "photons_connected", "empty_gathers", "receiver_points", "lit_points", "indirect_rmse",
            "indirect_relmse", "indirect_mean_ratio", "indirect_s", "indirect_cpu_s", "reference_indirect_mean",
            "reference_indirect_stderr", "light_sent", "light_arrived", "light_cut", "light_pruned", "light_misdirected",
            "light_absorbed", "light_escaped", "light_cut_share", "light_pruned_share", "light_misdirected_share",
            "light_absorbed_share", "light_escaped_share", "caustic_missed_by_cut", "caustic_missed_by_pruning",
            "caustic_missed_by_normals", "caustic_sum", "caustic_sum_error")
RUN = ("picture_hash", "elapsed_s", "finished", "host", "cpu", "load_average", "other_cores", "jobs", "timeout_s",
       "memory_limit_bytes", "message", "why_empty", "mesh_flaws")  # of one run of a trial
NOT_SWEPT = MEASURES + FIXED_PARAMETERS + OPTIONAL_PARAMETERS + RUN
# Photons and light paths asked for: above 0 wherever they apply.
ASKED_COUNTS = ("photons", "emitted", "paths")
NUMBERS = ("seed", "repeat", "nearest", "alpha", "mesh_resolution", "threads", "spp", "polygons", "beams", "cone_point_tests",
           "beam_point_tests", "beam_point_hits", "map_bytes", "rss_start_bytes", "peak_rss_bytes", "elapsed_s", "load_average",
           "other_cores", "jobs", "timeout_s", "memory_limit_bytes") + MEASURES + ASKED_COUNTS
COMPLETED_BY = "completed_by"
LABELS = ("isa", "code_version", COMPLETED_BY)  # never numbers, whatever they look like
# CPU seconds of a trial's parts, each empty where a method has no such part: what all tools add up.
BUILD = ("precompute_cpu_s", "balance_cpu_s")
INDIRECT = ("indirect_cpu_s",)
QUERY = ("render_cpu_s",)
CPU_PARTS = BUILD + INDIRECT + QUERY
# Colours of one wavelength have channels below 0, and so may means of pictures; a share that is what others leave of 1 may be below
# 0 by rounding, and light that is absorbed on average by chance. All other numbers count or measure something.
SIGNED = ("alpha", "bias", "mean_ratio", "mask_mean_ratio", "indirect_mean_ratio", "leak_energy", "reference_mean",
          "reference_indirect_mean", "flux_share_captured", "light_absorbed", "light_absorbed_share", "caustic_sum")

# Light that the caustic lacks, as a share of the caustic with it; told from 1 % on.
MISSED = {"caustic_missed_by_cut": "cut at max_bounces", "caustic_missed_by_pruning": "in beams that are not followed",
          "caustic_missed_by_normals": "lost by shading normals"}
LEAST_MISSED = 0.01
ERRORS_OF_SUM = 3  # from which a picture's sum is none of chance

# What each metric is, as captions and axes say it: x the picture, r the reference, over all reached pixels and channels
# of the caustic layer; radiance is in linear sRGB.
FORMULAS = {
    "rmse": "rmse = √ mean (x − r)²",
    "relmse": "relmse = mean (x − r)² / (r² + ε),  ε = 0.01 mean(r)²",
    "mean_ratio": "mean_ratio = mean(x) / mean(r)",
}
UNITS = {"rmse": "W m⁻² sr⁻¹", "relmse": "1", "mean_ratio": "1", "total_s": "s"}


class RecordsError(Exception):
    """One line for the user: the place, the reason, what would be right."""


@dataclasses.dataclass
class Spread:
    """Median and range, or mean and interval, of one quantity over the records of a cell."""
    median: float
    low: float
    high: float


@dataclasses.dataclass
class Cell:
    """The records of one scene, method and set of parameters; `parameters` has only those that apply."""
    scene: str
    method: str
    parameters: dict
    records: list = dataclasses.field(default_factory=list)

    def spread(self, column):
        """The spread of a measure, or None where it does not apply to any record of the cell."""
        values = [float(record[column]) for record in self.records if record.get(column)]
        return Spread(statistics.median(values), min(values), max(values)) if values else None

    def mean(self, column):
        """The mean over the seeds and its 95 % interval (Student; none of one seed), as spread()."""
        seeds = [[float(record[column]) for record in rows if record.get(column)] for rows in by_seed(self.records).values()]
        values = [statistics.mean(several) for several in seeds if several]
        if not values:
            return None
        reach = half_interval(values) or 0
        return Spread(statistics.mean(values), statistics.mean(values) - reach, statistics.mean(values) + reach)

    def reference_error(self):
        """The reference's own standard error [W m⁻² sr⁻¹], or None: the table has it as a share of the mean radiance of
        the reference, and that mean only where there is a column reference_mean."""
        share, mean = self.spread("reference_stderr"), self.spread("reference_mean")
        return share.median * mean.median if share and mean and share.median * mean.median > 0 else None

    def told_method(self):
        """The method, and what carries the light that its beams do not."""
        other = self.parameters.get(COMPLETED_BY)
        return f"{self.method}, completed by {other}" if other else self.method

    def seeds(self):
        return len({record["seed"] for record in self.records})

    def photon_parameter(self):
        """(name, value) of the number of photons asked for, or None for a method without photons."""
        return next(((name, self.parameters[name]) for name in PHOTON_PARAMETERS if name in self.parameters), None)


@dataclasses.dataclass
class Records:
    """A whole table: its cells in a natural order, its parameters in the table's order, and what was left out."""
    cells: list
    parameters: list
    left_out: dict

    def scenes(self):
        return sorted({cell.scene for cell in self.cells}, key=natural)


def completed_by(row):
    """What carries the light of beams that are not traced, or nothing where beams carry all: rows of their own in every table."""
    if float(row.get("pencils_traced") or 0) > 0:
        return "pencils"
    return "photons" if float(row.get("flux_share_rest") or 0) > 0 else ""


def cpu_seconds(row, parts=CPU_PARTS):
    """CPU seconds of a trial's parts: of build, indirect light and query unless others are named."""
    return sum(float(row.get(part) or 0) for part in parts)


def missed_text(rows):
    """What the caustic of these records lacks: "the caustic lacks 12.3 % cut at max_bounces", or nothing."""
    medians = {}
    for name, why in MISSED.items():
        values = [float(row[name]) for row in rows if row.get(name)]
        if values and statistics.median(values) >= LEAST_MISSED:
            medians[why] = statistics.median(values)
    told = ", ".join(f"{100 * share:.1f} % {why}" for why, share in medians.items())
    return "; ".join(text for text in (f"the caustic lacks {told}" if told else "", sum_text(rows)) if text)


def sum_text(rows):
    """Where the caustic of these records adds up to more or less than arrives, by 1 % and three standard errors."""
    sums = [(float(row["caustic_sum"]), float(row["caustic_sum_error"])) for row in rows if row.get("caustic_sum") and row.get("caustic_sum_error")]
    if not sums:
        return ""
    ratio, error = (statistics.median(values) for values in zip(*sums))
    if abs(ratio - 1) < max(LEAST_MISSED, ERRORS_OF_SUM * error):
        return ""
    return f"the picture has {ratio:.2f} of the light that arrives where the camera sees it"


def by_seed(rows):
    """{seed: its rows}. Repeats measure the time again and make the same picture again, so an error is that of any of them."""
    seeds = {}
    for row in rows:
        seeds.setdefault(row["seed"], []).append(row)
    return seeds


def natural(text):
    """Sort key: numbers by value, before words by letter."""
    number = as_number(text)
    return (1, 0.0, str(text)) if number is None else (0, number, "")


def as_number(text):
    try:
        return float(text)
    except ValueError:
        return None


def same(text, value):
    """Whether two spellings are of one number, or of one word."""
    numbers = as_number(text), as_number(value)
    return text == value if None in numbers else numbers[0] == numbers[1]


def read(path):
    """Reads and groups the table at `path`; raises RecordsError."""
    header, rows = read_rows(path)
    left_out = {}
    done = []
    for line, row in rows:
        check(path, line, row)
        if row["status"] == "done":
            done.append((line, row))
        else:
            left_out[row["status"]] = left_out.get(row["status"], 0) + 1
    check_trials(path, done)
    for _, row in done:
        row[COMPLETED_BY] = completed_by(row)
    if not done:
        counts = ", ".join(f"{count} {status}" for status, count in left_out.items())
        raise RecordsError(f"{path}: no row has the status done ({counts})")
    unknown = [name for name in header[header.index("code_version") + 1:] if name not in NOT_SWEPT]
    swept = swept_columns(path, unknown, [row for _, row in done])
    parameters = [name for name in ("photons", "emitted") if name in swept] + list(FIXED_PARAMETERS[:3])
    parameters += [name for name in swept if name not in parameters] + [COMPLETED_BY]
    parameters += [name for name in OPTIONAL_PARAMETERS if name in header] + list(FIXED_PARAMETERS[3:])
    cells, photons_counted = group(path, done, parameters)
    if photons_counted:
        parameters.insert(0, "photons_stored")
    present = [name for name in parameters if any(name in cell.parameters for cell in cells)]
    order = lambda cell: [natural(cell.scene), natural(cell.method)] + [
        natural(cell.parameters.get(name, "-inf")) for name in present]
    return Records(sorted(cells, key=order), present, left_out)


def swept_columns(path, unknown, rows):
    """Those of the columns that the sweep varied: as plan.json beside the table says, and else those that are no measures."""
    try:
        with open(os.path.join(os.path.dirname(path), "plan.json"), encoding="utf-8") as file:
            planned = json.load(file)["swept"]
        return [name for name in unknown if name in planned or name.removeprefix("method_") in planned]
    except (OSError, ValueError, KeyError, TypeError):
        return [name for name in unknown if not is_measure(name, rows)]


def is_measure(column, rows):
    """Where a method has several seeds, a value that was asked for is had by more than one of them; a measured one mostly is not."""
    seeds, of_method = {}, {}
    for row in rows:
        if row[column]:
            seeds.setdefault((row["scene"], row["method"], row[column]), set()).add(row["seed"])
            of_method.setdefault((row["scene"], row["method"]), set()).add(row["seed"])
    shared = [len(seeds[row["scene"], row["method"], row[column]]) > 1 for row in rows
              if row[column] and len(of_method[row["scene"], row["method"]]) > 1]
    return bool(shared) and sum(shared) < len(shared) / 2


def read_rows(path):
    """The header, and (line number, {column: text}) for each row."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.reader(file, strict=True)
            header = next(reader, None)
            if not header:
                raise RecordsError(f"{path}: the file is empty, expected a header and one row per trial")
            check_header(path, header)
            rows = []
            for fields in reader:
                if len(fields) != len(header):
                    raise RecordsError(f"{path}: line {reader.line_num} has {len(fields)} fields, "
                                       f"the header has {len(header)}")
                if any("\0" in field for field in fields):
                    raise RecordsError(f"{path}: line {reader.line_num} holds a NUL")
                rows.append((reader.line_num, dict(zip(header, map(plain, fields)))))
    except OSError as error:
        raise RecordsError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise RecordsError(f"{path}: not UTF-8 text ({error.reason} at byte {error.start})") from error
    except csv.Error as error:
        raise RecordsError(f"{path}: line {reader.line_num}: {error}") from error
    if not rows:
        raise RecordsError(f"{path}: a header without rows, expected one row per trial")
    return header, rows


def plain(field):
    """Without the apostrophe that keeps a spreadsheet from taking text for a formula."""
    return field[1:] if re.match(r"'+[=+\-@\t\r]", field) else field


def table_head(parameters, before, after):
    """The heads of a table's columns, with swept parameters in the middle. A parameter may have any name that no column of
    records.csv has; one that is another column's here is called swept_… ."""
    taken = {*before, *after}
    heads = []
    for name in parameters:
        while name in taken:
            name = f"swept_{name}"
        taken.add(name)
        heads.append(name)
    return [*before, *heads, *after]


def marked(field):
    """With it, where it is needed: what is read plainly is written so."""
    needs = re.match(r"'*[=+\-@\t\r]", field) and (field.startswith("'") or as_number(field) is None)
    return "'" + field if needs else field


def check_header(path, header):
    missing = [name for name in REQUIRED if name not in header]
    if missing:
        raise RecordsError(f"{path}: missing column{'s' * (len(missing) > 1)} {', '.join(missing)} "
                           f"(it has: {', '.join(header)})")
    twice = sorted({name for name in header if header.count(name) > 1})
    if twice:
        raise RecordsError(f"{path}: column {twice[0]} is there twice")


def check(path, line, row):
    """Refuses a row that cannot be trusted; a number that is not finite is named, never skipped."""
    place = f"{path}: line {line} (trial {row['trial'] or 'without a name'})"
    if row["status"] not in STATUSES:
        raise RecordsError(f'{place}: unknown status "{row["status"]}" (known: {", ".join(STATUSES)})')
    if row["status"] != "done":
        return
    for name in ("trial", "scene", "method", "seed"):
        if not row[name]:
            raise RecordsError(f"{place}: column {name} is empty")
    for name in NUMBERS:
        if row.get(name):
            expected = what_is_expected(name, as_number(row[name]))
            if expected:
                raise RecordsError(f'{place}: column {name} is "{row[name]}", expected {expected}')


def what_is_expected(name, number):
    """Of a column, where the number (None: no number) is not that; else None."""
    if number is None or not math.isfinite(number):
        return "a finite number or nothing"
    if not math.isfinite(number * number):
        return "a number whose square is finite"
    if number <= 0 and name in ASKED_COUNTS:
        return "a number > 0"
    return "a number ≥ 0" if number < 0 and name not in SIGNED else None


def check_trials(path, rows):
    """A trial is one row: a repeat has a name of its own."""
    first = {}
    for line, row in rows:
        if row["trial"] in first:
            raise RecordsError(f'{path}: lines {first[row["trial"]]} and {line} are both of the trial {row["trial"]}')
        first[row["trial"]] = line


def group(path, rows, parameters):
    """The cells of the rows, and whether the stored photons had to serve as a parameter.

    Stored photons vary from seed to seed where emitted ones were asked for, so they tell cells apart only where
    nothing else does: rows of one cell may not repeat a seed.
    """
    cells = {}
    for line, row in rows:
        own = {name: row[name] if name in LABELS else canonical(row[name])
               for name in parameters if row[name]}
        key = (row["scene"], row["method"], tuple(own.items()))
        cells.setdefault(key, (Cell(row["scene"], row["method"], own), []))[1].append((line, row))
    result = []
    photons_counted = False
    for cell, members in cells.values():
        if repeated(members) and cell.photon_parameter() is None and all(row["photons_stored"] for _, row in members):
            photons_counted = True
            result += split_by_photons(cell, members)
        else:
            result.append((cell, members))
    for cell, members in result:
        same = repeated(members)
        if same:
            raise RecordsError(f"{path}: lines {same[0]} and {same[1]} have the same scene, method, parameters, seed "
                               "and repeat; a column that distinguishes them is missing after code_version")
        cell.records = [row for _, row in members]
    return [cell for cell, _ in result], photons_counted


def split_by_photons(cell, members):
    parts = {}
    for line, row in members:
        parts.setdefault(canonical(row["photons_stored"]), []).append((line, row))
    return [(Cell(cell.scene, cell.method, {"photons_stored": count, **cell.parameters}), part)
            for count, part in parts.items()]


def repeated(members):
    """The lines of the first two rows with the same seed and repeat, or None."""
    first = {}
    for line, row in members:
        key = (row["seed"], row["repeat"])
        if key in first:
            return first[key], line
        first[key] = line
    return None


def canonical(text):
    """One spelling per value, so that 0.10 and 0.1, or 1e5 and 100000, are the same cell."""
    number = as_number(text)
    if number is None or not math.isfinite(number):
        return text
    return str(int(number)) if number == int(number) and abs(number) < 1e15 else repr(number)
