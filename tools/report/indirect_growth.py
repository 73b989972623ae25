"""Where the time of `globalphotonmap` goes, how it grows, and what a second thread gains: from the records of the sweep
indirect_growth.json on one thread and on two.

Gathering is the eye pass without that of a picture without indirect light.
"""
import json
import statistics

PHASES = ("indirect/trace", "indirect/balance", "indirect/precompute")
USUAL = {"indirect_photons": 200_000, "indirect_gather": 16}

SECTION = """## Where the time goes, and how it grows

The room at 4 samples a pixel (experiments/sweeps/indirect_growth.json), one thread, CPU seconds, medians over {seeds} seeds: tracing
the photons, ordering them, the irradiance known beforehand, gathering; in brackets the share of all four.

| photons | rays a sample | pixels | trace | order | beforehand | gather | all |
|---|---|---|---|---|---|---|---|
{rows}
Of {photons:,} photons and {gather} rays, at {pixels:,} pixels, two threads take {wall:.1f} s where one takes {single:.1f} s: {gain:.2f} times as
fast (wall seconds, medians; load average {loads} as the trials began: without other work on the machine it is 0 to 2). CPU
seconds of two threads are {work:.2f} times those of one.

"""


def section(one, two):
    """The section, of the folders of the sweep on one thread and on two."""
    single, double = Trials(one), Trials(two)
    rows = "".join(single.row(setting) for setting in single.settings())
    usual = max((setting for setting in single.settings() if dict(USUAL).items() <= dict(setting).items()),
                key=lambda setting: dict(setting)["width"])
    walls, works = ([sum(trials.seconds(usual, kind)) for trials in (single, double)] for kind in ("wall", "cpu"))
    return SECTION.format(seeds=single.seeds(), rows=rows, photons=USUAL["indirect_photons"], gather=USUAL["indirect_gather"],
                          pixels=pixels(dict(usual)), wall=walls[1], single=walls[0], gain=walls[0] / walls[1],
                          work=works[1] / works[0], loads=load_range(single, double))


class Trials:
    """The records of one folder, by their swept settings; trials without indirect light have the film's alone."""

    def __init__(self, folder):
        self.of = {}
        for file in sorted(folder.glob("trials/*/record.json")):
            record = json.loads(file.read_text(encoding="utf-8"))
            if record["status"] == "done":
                self.of.setdefault(tuple(sorted(record["swept"].items())), []).append(record)

    def settings(self):
        """Of trials with indirect light: by photons, rays, pixels."""
        keys = ("indirect_photons", "indirect_gather", "width", "height")
        found = [setting for setting in self.of if "indirect_gather" in dict(setting)]
        return sorted(found, key=lambda setting: [dict(setting)[key] for key in keys])

    def seeds(self):
        return min(len({record["seed"] for record in records}) for records in self.of.values())

    def seconds(self, setting, kind):
        """Medians of the phases and of gathering; `kind`: cpu or wall."""
        film = tuple((key, value) for key, value in setting if not key.startswith("indirect_"))
        of = lambda records, phase: statistics.median(record["phases"][phase][kind] for record in records)
        phases = [of(self.of[setting], phase) for phase in PHASES]
        return [*phases, of(self.of[setting], "render") - of(self.of[film], "render")]

    def row(self, setting):
        words, seconds = dict(setting), self.seconds(setting, "cpu")
        shares = [f"{each:.2f} ({100 * each / sum(seconds):.0f} %)" for each in seconds]
        return (f"| {words['indirect_photons']:,} | {words['indirect_gather']} | {pixels(words):,} | {' | '.join(shares)} "
                f"| {sum(seconds):.2f} |\n")

    def loads(self):
        return [record["load"]["average"] for records in self.of.values() for record in records]


def pixels(words):
    return words["width"] * words["height"]


def load_range(*trials):
    loads = [load for each in trials for load in each.loads()]
    return f"{min(loads):.1f} to {max(loads):.1f}"
