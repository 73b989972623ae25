"""results/bench/peers.md, peers.png: from the records (peers.csv) and what is known of the run (peers.json) alone."""
import json

from peers import contest, scores
from report.records import RecordsError
from report.report_files import write

PEERS = ("povray", "mitsuba", "splat")
OFF = 0.01  # of a mean from the truth's, beyond which it is named


class Results:
    def __init__(self, folder):
        if not (folder / "peers.csv").is_file() or not (folder / "peers.json").is_file():
            raise RecordsError(f"{folder}: no peers.csv and peers.json (tools/bench_peers.py)")
        self.held, self.kept = contest.Contest(), {}
        self.records = scores.read(folder / "peers.csv")
        about = json.loads((folder / "peers.json").read_text(encoding="utf-8"))
        self.environment, self.absent, self.truths = about["environment"], about["absent"], about["truths"]
        self.scenes = [scene for scene in self.held.scenes if any(row["scene"] == scene.name and row["phase"] == scores.FINAL for row in self.records)]

    def cells(self, scene, measure=scores.RELATIVE):
        key = scene.name, measure
        if key not in self.kept:
            self.kept[key] = scores.cells(self.records, scene.name, scores.FINAL, measure)
        return self.kept[key]

    def ratios(self, measured, peers=PEERS, measure=scores.RELATIVE):
        """{(scene, peer): Ratio}, without what cannot be told."""
        found = {}
        for scene in self.scenes:
            cells = self.cells(scene, measure)
            for peer in peers:
                ratio = scores.with_range(measured, cells, peer, measure)
                if ratio is not None:
                    found[scene.name, peer] = ratio
        return found


def write_all(folder):
    results = Results(folder)
    write(folder / "peers.md", text(results))
    from peers import plot  # here, so that the page is there even without matplotlib

    plot.draw(results, folder / "peers.png")


def text(results):
    parts = [head(results), verdicts(results), factors(results), fronts(results), truths(results), against_us(results), method(results)]
    return "\n\n".join("\n".join(lines) for lines in parts) + "\n"


def row(*words):
    return f"| {' | '.join(map(str, words))} |"


def table(heading, rows):
    return [row(*heading), "|" + "---|" * len(heading), *(row(*each) for each in rows)]


def percent(error):
    return f"{100 * error:.3g} %"


def factor(ratio, ranged=True):
    if ratio is None:
        return "–"
    sign = {"bound": "≥ ", "law": "~ "}.get(ratio.kind, "")
    spread = f" ({ratio.low:.3g} to {ratio.high:.3g})" if ranged and ratio.kind == "measured" else ""
    return f"{sign}{ratio.value:.3g} ×{spread}"


def head(results):
    about = results.environment
    loads = [each["load"] for each in results.records if each["load"] != ""]
    versions = "; ".join(about[name] for name in ("causticbench", "povray", "mitsuba", "compiler") if name in about)
    lines = ["# Beside POV-Ray, Mitsuba and plain splatting", "",
             "By `tools/bench_peers.py`. Error of the caustic (root of relmse, the truth's own noise taken away) over CPU seconds of whole processes, "
             "one thread each; every contestant with its own best settings, found on another seed; three seeds, in brackets the least and the "
             "greatest of them.",
             f"{about['cpu']}, {about['processors']} processors, load average {min(loads):.1f} to {max(loads):.1f} by other work ({about['date']}). "
             f"{versions}.", "",
             "![Error over CPU time on five scenes](peers.png)"]
    return lines + [f"\n**Left out**: {results.held.titles[name]}: {why}." for name, why in results.absent.items()]


def verdicts(results):
    common, later = results.ratios(scores.common), results.ratios(scores.after_a_second)
    laws = results.ratios(scores.by_law, ("mitsuba",))
    rows = []
    for mark in results.held.text["marks"]:
        sure, beyond = scores.verdict(mark, common, later)
        far = lambda name: (name, mark["peer"]) in laws and laws[name, mark["peer"]].value >= mark["least"]
        drawn = [name for name in mark["among"] if name not in sure + beyond and far(name)]
        names = lambda found: ", ".join(found) or "none"
        asked = f"on {mark['scenes']} of {', '.join(mark['among'])}" if len(mark["among"]) > 1 else f"on the {mark['among'][0]}"
        rows.append([f"{results.held.titles[mark['peer']]} / ours ≥ {mark['least']} {asked}", names(sure), names(beyond), names(drawn),
                     said(mark["scenes"], len(sure), len(beyond), len(drawn))])
    heading = ["mark, written before measuring", "reached at the least common error", "reached at smaller errors, as a bound",
               "only by the law of unbiased estimates", "verdict"]
    return ["## Marks", "", *table(heading, rows)]


def said(wanted, sure, beyond, drawn):
    if sure >= wanted:
        return "**met**"
    if sure + beyond >= wanted:
        return "met, if errors count that the peer never reached"
    return "met only if the peer's curve is drawn on" if sure + beyond + drawn >= wanted else "**NOT MET**"


def factors(results):
    lines = ["## The peer's time over ours at equal error", "",
             "Ours is the better of photon map and beam tree. *Common*: at the least error that both reach. *After a second*: at the error that ours "
             "has after one CPU second; ≥ is a bound, the peer's longest run never got there; ~ draws the peer's curve on by its law, squared error "
             "as one over work. A ratio is of the seeds' median times and mean errors; in brackets the least and the greatest that one seed alone "
             "gives at a common error of its own, so that the ratio may lie beside them.", ""]
    common, later = results.ratios(scores.common), results.ratios(scores.after_a_second)
    plain = results.ratios(scores.common, measure=scores.PLAIN)
    laws = results.ratios(scores.by_law, scores.UNBIASED)
    rows = []
    for peer in PEERS:
        for scene in results.scenes:
            key = scene.name, peer
            if key in common:
                expected = results.held.text["expected"].get(peer, {}).get(scene.name)
                second = later.get(key)
                rows.append([results.held.titles[peer], scene.title, expected or "", percent(common[key].at), factor(common[key]),
                             percent(second.at) if second else "", factor(second), factor(laws.get(key)), factor(plain.get(key))])
    heading = ["peer", "scene", "expected", "common error", "ratio", "ours after a second", "ratio", "by law", "by rmse, common"]
    return lines + table(heading, rows)


def fronts(results):
    lines = ["## Fronts", "",
             "What nothing faster of the same contestant beats. rmse is over the truth's mean; mean is the picture's over the truth's."]
    for scene in results.scenes:
        title = f"### {scene.title.capitalize()}, {scene.size[0]} × {scene.size[1]}"
        lines += ["", title, "", *table(["contestant", "setting", "CPU s", "error", "rmse", "mean"], front_rows(results, scene))]
    return lines


def front_rows(results, scene):
    cells, plain = results.cells(scene), {(cell.name, cell.setting): cell.error for cell in results.cells(scene, scores.PLAIN)}
    ranged = lambda value, ends, shown: f"{shown(value)} ({shown(ends[0])} to {shown(ends[1])})"
    for name in results.held.names:
        kept = scores.curve(cells, (name,))
        own = [cell for cell in cells if cell.name == name and (cell.seconds, cell.error) in kept]
        for cell in sorted(own, key=lambda each: each.seconds):
            yield [results.held.titles[name], cell.setting, ranged(cell.seconds, cell.seconds_range, "{:.3g}".format),
                   ranged(cell.error, cell.range, percent), percent(plain[name, cell.setting]), f"{cell.mean_ratio:.4f}"]


def truths(results):
    rows = [[scene.title, about["how"], percent(about["own_error"]), f"{about['lighttrace_mean_ratio']:.4f}", f"{about['z']:.2f} ({about['blocks']})",
             about["pixels"]] for scene in results.scenes for about in [results.truths[scene.name]]]
    heading = ["scene", "truth", "its own error", "lighttrace's mean over it", "root mean z² of blocks of 8 × 8 (blocks)", "pixels that count"]
    lines = ["## Truths, and the same light", "", *table(heading, rows), "",
             f"Means of each contestant's most accurate setting over the truth's; in bold what is off by more than {OFF:.0%}:", ""]
    names = results.held.names
    return lines + table(["scene", *(results.held.titles[name] for name in names)], [[scene.title, *means(results, scene)] for scene in results.scenes])


def best(cells, name):
    own = [cell for cell in cells if cell.name == name]
    return min(own, key=lambda cell: cell.error) if own else None


def means(results, scene):
    for name in results.held.names:
        cell = best(results.cells(scene), name)
        shown = f"{cell.mean_ratio:.4f}" if cell else "–"
        yield f"**{shown}**" if cell and abs(cell.mean_ratio - 1) > OFF else shown


def against_us(results):
    """Where ours is behind, or missed what was expected: printed as large as the rest."""
    common, lines = results.ratios(scores.common), ["## What speaks against us", ""]
    plain = results.ratios(scores.common, measure=scores.PLAIN)
    titles = {scene.name: scene.title for scene in results.scenes}
    for (name, peer), ratio in common.items():
        wanted = results.held.text["expected"].get(peer, {}).get(name)
        who = f"{titles[name].capitalize()}, {results.held.titles[peer]}"
        if ratio.value < 1:
            lines.append(f"- **{who}: it is {1 / ratio.value:.3g} times as fast as ours, at an error of {percent(ratio.at)}.**")
        elif wanted and ratio.value < wanted:
            lines.append(f"- {who}: {ratio.value:.3g} × at the least common error, {wanted} × were expected.")
        if (name, peer) in plain and plain[name, peer].value < 1 <= ratio.value:
            faster = 1 / plain[name, peer].value
            lines.append(f"- **{who}: by rmse it is {faster:.3g} times as fast as ours** (at {percent(plain[name, peer].at)} of the mean).")
    for scene in results.scenes:
        for name in contest.OURS:
            cell = best(results.cells(scene), name)
            if cell and abs(cell.mean_ratio - 1) > OFF:
                lines.append(f"- {scene.title.capitalize()}, {results.held.titles[name]}: the mean is {cell.mean_ratio:.4f} of the truth's.")
    return lines


def method(results):
    undone = [each for each in results.records if each["status"] != scores.DONE]
    over = sorted({f"{each['scene']}: {results.held.titles[each['contestant']]} ({each['setting']}), {each['status']}" for each in undone})
    return ["## How, and what was not measured", "",
            "- The same question for all: the caustic's mean over each pixel that sees nothing but the floor, green channel, without light from floor to floor. "
            "Error is √mean((x − r)² / (r² + 0.01 mean(r)²)).",
            "- Seconds are user + system time of the process that makes the picture, start and reading included. Not counted: export, compiling the "
            "splat, and the picture of direct light that is taken away from POV-Ray's (a black caster) and Mitsuba's (the same light paths, ended at "
            "the first surface).",
            "- POV-Ray: jitter 0.4; on the pools refraction alone; nearest 20 to N, or a fixed radius. It has no seed: repeats have 1, 1.013 and "
            "0.987 times the photons.",
            "- Mitsuba: `ptracer` with a spot light as wide as the caster, independent samples, on the pools paths that end at the floor, llvm and "
            "scalar. Its `path` meets no point light. Its stratified sampler without jitter would give each pixel's light paths the same numbers.",
            "- Plain splatting is an ideal rival: it knows the one caster's shape and has no intersector, no scene, no other light. It cannot serve "
            "the cut bowl; `lighttrace` stands for it there.",
            "- Pools: each contestant chooses among meshes of the water; the truth is the smooth surface.",
            f"- Settings tried and chosen: peers.csv. Ended for their CPU time: {'; '.join(over) or 'none'}.",
            "- On the ball rmse is that of the focus, which is finer than a pixel; relmse weighs all pixels.",
            "- Not measured: larger pictures, several threads, area lights, glossy floors, longer runs; beams of more than four events in the cut bowl, "
            "and, but for one search, Mitsuba there by more than 256 samples without roulette; at most three repeats, so ratios below 1.2 are noise."]
