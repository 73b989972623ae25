#!/usr/bin/python3
"""Compares the methods of a sweep: errors with confidence intervals, bias and variance apart, efficiency, and which
method is best at equal time and at equal error, with ties where the seeds do not tell.

Reads DIR/records.csv, writes statistics.csv, statistics.md, equal_time.md and equal_error.md. Wants five seeds; a cell
of one seed has no interval, and with fewer than five no method is called the best. Repeats make the same picture again, so
they are no seeds. Times are CPU seconds of build (of indirect light too) and query, so compare records of one machine. The
same records give the same bytes.
Exit codes: 0 done, 2 bad input or usage.
"""
import argparse
import csv
import dataclasses
import io
import math
import os
import statistics
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report import records
from report.intervals import FEWEST_SEEDS, Answer, half_interval, is_worse, log_variance
from report.record_tables import markdown
from report.report_files import report, write

STEPS = 5  # times and errors asked for, a scene


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
    """A cell of the records: rmse and CPU seconds seed by seed, and the CPU seconds of every trial."""

    def __init__(self, cell):
        self.scene, self.method, self.parameters = cell.scene, cell.method, cell.parameters
        self.told_method = cell.told_method()
        rows = [row for row in cell.records if row.get("rmse")]
        self.reference = rows[0].get("reference", "")  # the same for all pictures of one scene as it was set
        seeds = records.by_seed(rows).values()
        self.errors = [float(repeats[0]["rmse"]) for repeats in seeds]
        self.times = [statistics.median(map(records.cpu_seconds, repeats)) for repeats in seeds]
        self.trial_times = [records.cpu_seconds(row) for row in rows]
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

    def bias_square_error(self):
        """The standard error of bias², by how the squares scatter from seed to seed; None for one seed."""
        if self.variance is None or len(self.errors) < 2:
            return None
        return statistics.stdev(error * error for error in self.errors) / math.sqrt(len(self.errors))

    def seconds(self):
        """The median over seeds and repeats."""
        return statistics.median(self.trial_times)

    def efficiency(self):
        """1 / (mse x time): doubles where half the time gives the same error."""
        product = self.square() * self.seconds()
        return 1 / product if product > 0 else None

    def is_at_the_references_noise(self):
        return self.square() < 2 * self.reference_square

    def point(self):
        return Point(self.seconds(), self.mean(), log_variance(self.times), log_variance(self.errors), len(self.errors))


@dataclasses.dataclass(frozen=True)
class Point:
    """A cell on a convergence curve; the variances are of the logarithms, as far as the seeds tell them."""
    seconds: float
    error: float
    seconds_variance: float = 0.0
    error_variance: float = 0.0
    seeds: int = FEWEST_SEEDS

    def turned(self):
        """Error for time, to ask for the time at an error."""
        return Point(self.error, self.seconds, self.error_variance, self.seconds_variance, self.seeds)


def parameter_names(cells):
    names = dict.fromkeys(name for cell in cells for name in cell.parameters)
    return [name for name in names if len({cell.parameters.get(name) for cell in cells}) > 1]


def statistics_csv(cells):
    names = parameter_names(cells)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(records.table_head(names, ["scene", "method"], [
        "seeds", "rmse_mean", "rmse_half_interval_95", "bias_square", "bias_square_stderr", "variance", "reference_square",
        "cpu_s_median", "efficiency"]))
    for cell in cells:
        numbers = [cell.mean(), cell.half_interval(), cell.bias_square(), cell.bias_square_error(), cell.variance,
                   cell.reference_square, cell.seconds(), cell.efficiency()]
        writer.writerow([cell.scene, cell.method, *(cell.parameters.get(name, "") for name in names), len(cell.errors)]
                        + ["" if number is None else repr(number) for number in numbers])
    return text.getvalue()


def statistics_md(cells):
    names = parameter_names(cells)
    yes = lambda number, form: "" if number is None else format(number, form)
    lines = ["rmse: mean over the seeds ± half its 95 % interval (Student). mse = bias² + variance + (the reference's own "
             "error)², each a mean over pixels and channels; \\* marks errors of which half or more is the reference's: "
             "cells so marked are not distinguished. bias² is what is left of the mse, ± its standard error by the scatter "
             "of the seeds: an unbiased estimate, so below 0 in half the cells that have no bias; † marks those not "
             "distinguishable from 0 (less than two standard errors above it). efficiency = 1 / (mse × CPU seconds).", "",
             "| scene | method | " + " | ".join([*names, "seeds", "rmse", "bias²", "variance", "CPU s", "efficiency"]) + " |",
             "|" + "---|" * (len(names) + 8)]
    for cell in cells:
        interval = cell.half_interval()
        error = f"{cell.mean():.4g}" + (f" ± {interval:.1g}" if interval is not None else "")
        error += " \\*" if cell.is_at_the_references_noise() else ""
        lines.append("| " + " | ".join(
            [*map(markdown, (cell.scene, cell.method, *(cell.parameters.get(name, "") for name in names))), str(len(cell.errors)), error,
             bias_text(cell), yes(cell.variance, ".2g"), f"{cell.seconds():.3g}",
             yes(cell.efficiency(), ".3g")]) + " |")
    return "\n".join(lines) + "\n"


def bias_text(cell):
    square, error = cell.bias_square(), cell.bias_square_error()
    if square is None:
        return ""
    if error is None:
        return f"{square:.2g}"
    return f"{square:.2g} ± {error:.1g}" + (" †" if square < 2 * error else "")


def front(points):
    """The convergence curve: the points that nothing faster beats, by time."""
    curve = []
    for point in sorted(points, key=lambda point: (point.seconds, point.error)):
        if not curve or point.error < curve[-1].error:
            curve.append(point)
    return curve


def along(curve, seconds):
    """The error at a time, as a power between neighbours; None outside of the curve. Seconds may fall as well as rise."""
    for a, b in zip(curve, curve[1:]):
        if min(a.seconds, b.seconds) <= seconds <= max(a.seconds, b.seconds):
            weight = math.log(seconds / a.seconds) / math.log(b.seconds / a.seconds)
            power = math.log(b.error / a.error) / math.log(b.seconds / a.seconds)
            terms = tuple((share ** 2 * (point.error_variance + power ** 2 * point.seconds_variance), point.seeds - 1)
                          for share, point in ((1 - weight, a), (weight, b)))
            return Answer(a.error * (b.error / a.error) ** weight, terms)
    return None


def equal_time(curve, seconds):
    """The error that a method has reached after a time; more time than was measured does no harm."""
    last = curve[-1]
    if seconds >= last.seconds:
        return Answer(last.error, ((last.error_variance, last.seeds - 1),))
    return along(curve, seconds)


def equal_error(curve, error):
    """The time after which a method has reached an error; one that it had at once takes its first time."""
    first = curve[0]
    if error >= first.error:
        return Answer(first.seconds, ((first.seconds_variance, first.seeds - 1),))
    return along([point.turned() for point in curve], error)


def asked(curves, question):
    """Times, or errors, spread evenly (as powers) over what at least two methods reach."""
    place = (lambda point: point.seconds) if question is equal_time else (lambda point: point.error)
    lows = sorted(min(map(place, curve)) for curve in curves)
    highs = sorted((max(map(place, curve)) for curve in curves), reverse=True)
    if len(curves) < 2 or lows[1] >= highs[0]:
        return []
    low, high = lows[1], highs[0]
    return [low * (high / low) ** (i / (STEPS - 1)) for i in range(STEPS)]


def contests(cells, question):
    name, unit = ("time", "s") if question is equal_time else ("error", "rmse")
    value = "rmse" if question is equal_time else "CPU seconds"
    lines = [f"{value} at equal {name}, along each method's convergence curve: its cells that nothing faster beats, a power "
             "law between neighbours. Bold: the best, and all that the seeds do not tell from it (Welch's t of the logarithms, "
             f"two-sided, 95 %), where there are {FEWEST_SEEDS} seeds; – where a method was not measured."]
    for title, own in by_scene(cells):
        groups = {}
        for cell in own:
            if cell.seconds() > 0 and cell.mean() > 0:
                groups.setdefault(cell.told_method, []).append(cell)
        lines += ["", f"## {markdown(title)}", ""] + contest(groups, question, unit)
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
    curves = {method: front(cell.point() for cell in own) for method, own in groups.items()}
    places = asked(list(curves.values()), question)
    if not places:
        return ["Fewer than two methods cover a common range."]
    few = min(point.seeds for curve in curves.values() for point in curve)
    lines = []
    if few < FEWEST_SEEDS:
        lines += [f"Too few seeds ({few}, not {FEWEST_SEEDS}) to call a method the best.", ""]
    lines += ["| method | " + " | ".join(f"{place:.3g} {unit}" for place in places) + " |", "|---|" + "---|" * len(places)]
    bold = [set() if few < FEWEST_SEEDS else tied(curves, question, place) for place in places]
    for method in sorted(curves):
        fields = []
        for place, best in zip(places, bold):
            answer = question(curves[method], place)
            text = "–" if answer is None else f"{answer.value:.3g}"
            fields.append(f"**{text}**" if method in best else text)
        lines.append(f"| {method} | " + " | ".join(fields) + " |")
    return lines


def tied(curves, question, place):
    """The best method there, and those that the seeds do not tell from it."""
    answers = {method: question(curve, place) for method, curve in curves.items()}
    reached = {method: answer for method, answer in answers.items() if answer is not None}
    if not reached:
        return set()
    best = min(reached.values(), key=lambda answer: answer.value)
    return {method for method, answer in reached.items() if not is_worse(answer, best)}


if __name__ == "__main__":
    sys.exit(main())
