"""results/duel: the teacher's page, tables, verdicts and plots, all from records."""
import json

from duel import factors, lists, measures, plots, prose, scores, tables, variables, verdicts
from duel.curves import Field
from duel.ranges import OUTSIDE
from duel.race import LEFT_OUT, SEARCH, FINAL, cells_of
from papers.latex import latex_tables
from papers.page import comma, markdown_table
from papers.part import Table
from papers.verdict import FAILS, HOLDS, UNDECIDED, UNMEASURED
from report.report_files import write

WORDS = ("id", "question", "hypothesis", "says", "refuted_if", "metric", "swept")
ORDER = (FAILS, HOLDS, UNDECIDED, UNMEASURED)


class Records(factors.Results):
    """What is in OUTPUT/records."""

    def __init__(self, duel, output):
        folder = output / "records"
        self.rows, left_out, self.spread, self.plain = [], [], {}, {}
        fields, searched = {}, {}
        for scene in duel.scenes:
            for phase in (SEARCH, FINAL):
                path = folder / f"{scene.name}_{phase}.csv"
                if not path.is_file():
                    continue
                rows = scores.read_csv(path)
                self.rows += rows
                left_out += self.read_more(path, phase)
                cells = cells_of(duel.settings(scene), rows)
                if phase == SEARCH:
                    searched[scene.name] = cells
                else:
                    pixels = scene.size[0] * scene.size[1]
                    fields[scene.name] = Field(cells, pixels)
                    self.plain[scene.name] = Field(cells_of(duel.settings(scene), rows, True), pixels)
        self.environment, self.before, folds = map(json_if, (output / "environment.json", output / "verdicts_before.json", folder / "folds.json"))
        super().__init__(duel, fields, searched, read_if(folder / "folds.csv", ("method",)), read_if(folder / "counts.csv", counted_texts()),
                         folds, left_out)

    def read_more(self, path, phase):
        """Spreads of final runs; returns what was left out."""
        if phase == FINAL:
            for row in read_if(path.with_name(f"{path.stem}_spread.csv"), ("scene", "label", "settings")):
                self.spread[row["scene"], row["label"], row["settings"]] = row
        return read_if(path.with_name(f"{path.stem}_left_out.csv"), LEFT_OUT)

    def spread_of(self, *key):
        return self.spread.get(key)

    def machine(self):
        """One line on where the times were taken."""
        several = lambda name: ", ".join(sorted({row[name] for row in self.rows}))
        loads = sorted(row["load_average"] for row in self.rows)
        cpu = sum(row["build_s"] + row["query_s"] for row in self.rows) / 60
        built = f"{self.environment['compiler']}, {self.environment['flags']}" if self.environment else "its build is not known"
        built += "" if "NDEBUG" in built else ", assertions on"
        return (f"{several('cpu')}, one thread a trial; causticbench {several('code_version')}, {built}; load average {loads[0]:.0f} to "
                f"{loads[-1]:.0f} by other work (times are CPU times); {len(self.rows)} trials, {cpu:.0f} CPU minutes in the methods.")


def counted_texts():
    from duel.counts import TEXTS

    return TEXTS


def read_if(path, texts):
    return scores.read_csv(path, texts) if path.is_file() else []


def json_if(path):
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


def entries(results):
    """One a hypothesis: its words, its cases and its verdict; what it was in the run before, where that differs, and why."""
    judged = [(hypothesis, measures.cases_of(hypothesis, results)) for hypothesis in results.duel.hypotheses]
    of = sum(len(cases) for _, cases in judged)
    before = {entry["id"]: entry for entry in results.before or []}
    found = []
    for hypothesis, cases in judged:
        verdict, own = verdicts.judge(hypothesis, cases)
        strict, _ = verdicts.judge(hypothesis, cases, OUTSIDE / of)
        hidden = lambda case: f", {tables.HIDDEN}" if verdicts.is_hidden(case, hypothesis["region"]) else ""
        measured = [{"case": case.name, "measured": case.text() + hidden(case), "verdict": each, "note": case.note} for case, each in zip(cases, own)]
        entry = {**{key: hypothesis[key] for key in WORDS}, "verdict": verdict, "of_all_at_once": strict, "cases": measured}
        exploratory = results.duel.judged["exploratory"].get(hypothesis["id"])
        if exploratory:
            entry["exploratory"] = exploratory
        was = before.get(hypothesis["id"])
        if was and was["verdict"] != verdict:
            why = results.duel.judged["anew"].get(hypothesis["id"], "not said")
            entry["before"] = {"verdict": was["verdict"], "measured": measured_words(was), "why": why}
        found.append(entry)
    return found


def measured_words(entry):
    return "; ".join(f"{case['case']}: {case['measured']}" for case in entry["cases"]) or "–"


def verdict_words(entry):
    words = [f"**{entry['verdict']}**"] + (["exploratory"] if "exploratory" in entry else [])
    return ", ".join(words) + (f"; before: {entry['before']['verdict']}" if "before" in entry else "")


def verdict_table(found):
    rows = []
    for verdict in ORDER:
        for entry in found:
            if entry["verdict"] == verdict:
                rows.append([entry["question"], f"{entry['hypothesis']} ({entry['says']})", measured_words(entry), verdict_words(entry)])
    return Table("verdicts", "Hypotheses", ["question", "hypothesis", "measured", "verdict"], rows,
                 "95 % intervals in brackets; < and > are bounds. A hypothesis does not hold where one case lies outside of the region that refutes "
                 "it. " + multiplicity(found))


def multiplicity(found):
    """What becomes of the verdicts where all cases are judged at once (Bonferroni)."""
    changed = [f"{entry['id']} ({entry['of_all_at_once']})" for entry in found if entry["of_all_at_once"] != entry["verdict"]]
    cases = sum(len(entry["cases"]) for entry in found)
    return (f"Each of the {cases} cases is judged at 95 %, with no correction. At 95 % for all at once (Bonferroni) "
            f"{'other verdicts: ' + ', '.join(changed) if changed else 'the verdicts are the same'}.")


def anew_table(found):
    before = lambda entry: f"{entry['before']['verdict']} ({entry['before']['measured']})"
    rows = [[entry["question"], before(entry), f"**{entry['verdict']}** ({measured_words(entry)})", entry["before"]["why"]]
            for entry in found if "before" in entry]
    return Table("anew", "Since the run before", ["question", "before", "now", "why"], rows)


def plain(table):
    """Without Markdown's stars."""
    strip = lambda field: str(field).replace("**", "")
    return Table(table.name, table.title, table.heading, [[strip(field) for field in row] for row in table.rows], table.note)


def section(table):
    return f"\n## {table.title}\n\n" + markdown_table(table.heading, table.rows) + (f"\n{table.note}\n" if table.note else "")


def not_measured(results):
    rows = [[each["question"], each["says"], each["why"]] for each in results.duel.text["not_measured"]]
    lacking = [scene.title for scene in results.duel.scenes if scene.name not in results.fields]
    rows += [[f"Scene: {title}", "", "not run"] for title in lacking]
    return Table("not_measured", "Not measured here", ["question", "says", "why"], rows)


def tables_of(results):
    """All tables of numbers, in their order."""
    raced = [tables.light, tables.wanted, tables.crossings, tables.memory, lists.truths, lists.parts, lists.settings, lists.left_out]
    return [*(tables.winners(results, time) for time in tables.TIMES), tables.winners(results, 1, True), *(each(results) for each in raced)]


def of_some(results):
    """The sentence at the head of the page where not all scenes were run."""
    run = [scene.title for scene in results.duel.scenes if scene.name in results.fields]
    if len(run) == len(results.duel.scenes):
        return ""
    return (f"**This run has {len(run)} of {len(results.duel.scenes)} scenes: {', '.join(run) or 'none'}.** Sentences about other scenes are those of the "
            f'whole duel; their numbers read "{prose.ABSENT}".\n\n')


def rendered(results):
    """{file name: text} of all pages."""
    found, every = entries(results), tables_of(results)
    verdict, lacking = verdict_table(found), not_measured(results)
    kept = [verdict, anew_table(found), *every, lacking]
    words = (results.duel.folder / "page.md").read_text(encoding="utf-8").replace("\n\n", f"\n\n{of_some(results)}", 1)
    tally = ", ".join(f"{sum(entry['verdict'] == each for entry in found)} {'hold' if each == HOLDS else each}" for each in ORDER)
    facts = {**prose.facts(results), "tally": tally.replace("does not hold", "do not hold"),
             **{table.name: section(table).lstrip("\n").partition("\n\n")[2].rstrip("\n") for table in kept}}
    words = prose.filled(words, results, {entry["id"]: entry for entry in found}, facts)
    title = "The duel of photon map and beam tree"
    return {"README.md": words, "verdicts.json": json.dumps(found, indent=1, ensure_ascii=False) + "\n",
            "tables.md": f"# {title}: all tables\n\n{results.machine()}\n" + "".join(map(section, kept)),
            "tables.csv": comma(list(map(plain, kept))), "tables.tex": latex_tables(title, list(map(plain, kept)))}


def write_all(duel, output):
    results = Records(duel, output)
    for name, text in rendered(results).items():
        write(output / name, text)
    plots.write(results, output / "plots")
    variables.write(results, output / "plots")
