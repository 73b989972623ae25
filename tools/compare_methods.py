#!/usr/bin/python3
"""Compares the methods of a sweep: errors with confidence intervals, bias and variance apart, efficiency, and which
method is best at equal time and at equal error, with ties where the seeds do not tell.

Reads DIR/records.csv, writes statistics.csv, statistics.md, equal_time.md and equal_error.md. Wants several seeds; a
cell of one seed has no interval, and wins or loses nothing. Times are CPU seconds of the whole trial without reading
the scene, so compare records of one machine. The same records give the same bytes.
Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import csv
import io
import math
import os
import random
import statistics
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

import records
from curves import along
from estimate_cells import STAGES
from report_files import report, write

RESAMPLINGS = 400
STEPS = 5  # times and errors asked for, a scene
# Student's t for a two-sided 95 % interval, by degrees of freedom; beyond the list the normal's.
STUDENT = (12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("directory", metavar="DIR", help="folder with records.csv, as the sweep leaves it")
    parser.add_argument("-o", "--output", metavar="OUT", help="default: DIR/report")
    arguments = parser.parse_args()
    output = arguments.output or os.path.join(arguments.directory, "report")
    return report("compare_methods", "the tables", output, lambda: write_all(arguments.directory, output))


def write_all(directory, output):
    cells = [Scored(cell) for cell in records.read(os.path.join(directory, "records.csv")).cells if cell.spread("rmse")]
    if not cells:
        raise records.RecordsError(f"{directory}/records.csv: no row has an rmse (a sweep without a reference)")
    os.makedirs(output, exist_ok=True)
    write(os.path.join(output, "statistics.csv"), statistics_csv(cells))
    write(os.path.join(output, "statistics.md"), statistics_md(cells))
    write(os.path.join(output, "equal_time.md"), contests(cells, equal_time))
    write(os.path.join(output, "equal_error.md"), contests(cells, equal_error))


class Scored:
    """A cell of the records, seed by seed: rmse, and CPU seconds."""

    def __init__(self, cell):
        self.scene, self.method, self.parameters = cell.scene, cell.method, cell.parameters
        rows = [row for row in cell.records if row.get("rmse")]
        self.reference = rows[0].get("reference", "")  # the same for all pictures of one scene as it was set
        self.errors = [float(row["rmse"]) for row in rows]
        self.times = [sum(float(row.get(stage) or 0) for stage in STAGES) for row in rows]
        own = cell.reference_error()
        self.reference_square = own * own if own else 0.0
        variance = cell.spread("variance")
        self.variance = variance.median if variance else None

    def mean(self):
        return statistics.mean(self.errors)

    def half_interval(self):
        """Half the 95 % interval of the mean rmse, or None for one seed."""
        return half_interval(self.errors)

    def square(self):
        return statistics.mean(error * error for error in self.errors)

    def bias_square(self):
        """mse = bias² + variance + the reference's own squared error; may come out a little below 0 by chance."""
        return None if self.variance is None else self.square() - self.variance - self.reference_square

    def seconds(self):
        return statistics.median(self.times)

    def efficiency(self):
        """1 / (mse x time): doubles where half the time gives the same error."""
        product = self.square() * self.seconds()
        return 1 / product if product > 0 else None

    def is_at_the_references_noise(self):
        return self.square() < 2 * self.reference_square

    def drawn(self, generator):
        """(seconds, rmse), the rmse of as many seeds drawn again, for the bootstrap."""
        return self.seconds(), statistics.mean(generator.choices(self.errors, k=len(self.errors)))


def half_interval(values):
    if len(values) < 2:
        return None
    degrees = len(values) - 1
    t = STUDENT[degrees - 1] if degrees <= len(STUDENT) else 1.96
    return t * statistics.stdev(values) / math.sqrt(len(values))


def parameter_names(cells):
    names = dict.fromkeys(name for cell in cells for name in cell.parameters)
    return [name for name in names if len({cell.parameters.get(name) for cell in cells}) > 1]


def statistics_csv(cells):
    names = parameter_names(cells)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["scene", "method", *names, "seeds", "rmse_mean", "rmse_half_interval_95", "bias_square", "variance",
                     "reference_square", "cpu_s_median", "efficiency"])
    for cell in cells:
        numbers = [cell.mean(), cell.half_interval(), cell.bias_square(), cell.variance, cell.reference_square,
                   cell.seconds(), cell.efficiency()]
        writer.writerow([cell.scene, cell.method, *(cell.parameters.get(name, "") for name in names), len(cell.errors)]
                        + ["" if number is None else repr(number) for number in numbers])
    return text.getvalue()


def statistics_md(cells):
    names = parameter_names(cells)
    yes = lambda number, form: "" if number is None else format(number, form)
    lines = ["rmse: mean over the seeds ± half its 95 % interval (Student). mse = bias² + variance + (the reference's own "
             "error)², each a mean over pixels and channels; \\* marks errors of which half or more is the reference's: "
             "cells so marked are not told apart. efficiency = 1 / (mse × CPU seconds).", "",
             "| scene | method | " + " | ".join([*names, "seeds", "rmse", "bias²", "variance", "CPU s", "efficiency"]) + " |",
             "|" + "---|" * (len(names) + 8)]
    for cell in cells:
        interval = cell.half_interval()
        error = f"{cell.mean():.4g}" + (f" ± {interval:.1g}" if interval is not None else "")
        error += " \\*" if cell.is_at_the_references_noise() else ""
        lines.append("| " + " | ".join(
            [cell.scene, cell.method, *(cell.parameters.get(name, "") for name in names), str(len(cell.errors)), error,
             yes(cell.bias_square(), ".2g"), yes(cell.variance, ".2g"), f"{cell.seconds():.3g}",
             yes(cell.efficiency(), ".3g")]) + " |")
    return "\n".join(lines) + "\n"


def front(points):
    """The convergence curve: of (seconds, error) those that nothing faster beats, by time."""
    curve = []
    for seconds, error in sorted(points):
        if not curve or error < curve[-1][1]:
            curve.append((seconds, error))
    return curve


def equal_time(curve, seconds):
    """The error that a method has reached after a time; more time than was measured does no harm."""
    if curve and seconds > curve[-1][0]:
        return curve[-1][1]
    return along(curve, seconds)


def equal_error(curve, error):
    """The time after which a method has reached an error; one that it had at once takes its first time."""
    if curve and error > curve[0][1]:
        return curve[0][0]
    return along([(e, s) for s, e in curve], error)


def asked(curves, question):
    """Times, or errors, spread evenly (as powers) over what at least two methods reach."""
    column = 0 if question is equal_time else 1
    lows = sorted(min(point[column] for point in curve) for curve in curves)
    highs = sorted((max(point[column] for point in curve) for curve in curves), reverse=True)
    if len(curves) < 2 or lows[1] >= highs[0]:
        return []
    low, high = lows[1], highs[0]
    return [low * (high / low) ** (i / (STEPS - 1)) for i in range(STEPS)]


def contests(cells, question):
    name, unit = ("time", "s") if question is equal_time else ("error", "rmse")
    value = "rmse" if question is equal_time else "CPU seconds"
    lines = [f"{value} at equal {name}, along each method's convergence curve: its cells that nothing faster beats, a power "
             "law between neighbours. Bold: the best, and all that the seeds do not tell from it (95 % of "
             f"{RESAMPLINGS} bootstrap samples over seeds); – where a method was not measured."]
    for title, own in by_scene(cells):
        groups = {}
        for cell in own:
            if cell.seconds() > 0 and cell.mean() > 0:
                groups.setdefault(cell.method, []).append(cell)
        lines += ["", f"## {title}", ""] + contest(groups, question, unit)
    return "\n".join(lines) + "\n"


def by_scene(cells):
    """(title, cells) of each scene as it was set, which is what has one reference."""
    parts = {}
    for cell in cells:
        parts.setdefault((cell.scene, cell.reference), []).append(cell)
    for (scene, _), own in sorted(parts.items(), key=lambda part: (part[0][0], len(part[1]), part[0][1])):
        others = [cell for cell in cells if cell.scene == scene]
        constant = {name: own[0].parameters[name] for name in parameter_names(others)
                    if len({cell.parameters.get(name) for cell in own}) == 1 and name in own[0].parameters}
        yield ", ".join([scene, *(f"{name} {value}" for name, value in constant.items())]), own


def contest(groups, question, unit):
    generator = random.Random(1)
    curves = {method: front((cell.seconds(), cell.mean()) for cell in own) for method, own in groups.items()}
    places = asked(list(curves.values()), question)
    if not places:
        return ["Fewer than two methods cover a common range."]
    again = [{method: front(cell.drawn(generator) for cell in own) for method, own in groups.items()}
             for _ in range(RESAMPLINGS)]
    lines = ["| method | " + " | ".join(f"{place:.3g} {unit}" for place in places) + " |", "|---|" + "---|" * len(places)]
    bold = [tied(curves, groups, again, question, place) for place in places]
    for method in sorted(curves):
        fields = []
        for place, best in zip(places, bold):
            value = question(curves[method], place)
            text = "–" if value is None else f"{value:.3g}"
            fields.append(f"**{text}**" if method in best else text)
        lines.append(f"| {method} | " + " | ".join(fields) + " |")
    return lines


def tied(curves, groups, again, question, place):
    """The best method there, and those that are not worse in at least 1 of 40 samples; also those of one seed."""
    values = {method: question(curve, place) for method, curve in curves.items()}
    reached = {method: value for method, value in values.items() if value is not None}
    if not reached:
        return set()
    best = min(reached, key=reached.get)
    result = {best}
    for method in reached:
        pairs = [(question(sample[method], place), question(sample[best], place)) for sample in again]
        pairs = [pair for pair in pairs if None not in pair]
        worse = sum(mine > other for mine, other in pairs)
        if all(len(cell.errors) < 2 for cell in groups[method] + groups[best]):
            worse = len(pairs) if reached[method] > reached[best] else 0
        if not pairs or worse < 0.975 * len(pairs):
            result.add(method)
    return result


if __name__ == "__main__":
    sys.exit(main())
