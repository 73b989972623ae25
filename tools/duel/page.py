"""results/duel: the teacher's page, tables, verdicts and plots, all from records."""
import json
import re

from duel import curves, measures, plots, scores, tables, verdicts
from duel.curves import Field
from duel.race import LEFT_OUT, SEARCH, FINAL, cells_of
from papers.latex import latex_tables
from papers.page import comma, markdown_table
from papers.part import Table
from papers.verdict import FAILS, HOLDS, UNDECIDED, UNMEASURED
from report.report_files import write

ORDER = (FAILS, HOLDS, UNDECIDED, UNMEASURED)


class Records(measures.Results):
    """What is in OUTPUT/records."""

    def __init__(self, duel, output):
        folder = output / "records"
        self.rows, self.left_out, self.spread, self.plain = [], [], {}, {}
        fields, searched = {}, {}
        for scene in duel.scenes:
            for phase in (SEARCH, FINAL):
                path = folder / f"{scene.name}_{phase}.csv"
                if not path.is_file():
                    continue
                rows = scores.read_csv(path)
                self.rows += rows
                self.read_more(path, phase)
                cells = cells_of(duel.settings(scene), rows)
                if phase == SEARCH:
                    searched[scene.name] = cells
                else:
                    fields[scene.name] = Field(cells)
                    self.plain[scene.name] = Field(cells_of(duel.settings(scene), rows, True))
        environment, folds = output / "environment.json", folder / "folds.json"
        self.environment = json.loads(environment.read_text(encoding="utf-8")) if environment.is_file() else {}
        super().__init__(duel, fields, searched, read_if(folder / "folds.csv", ("method",)), read_if(folder / "counts.csv", counted_texts()),
                         json.loads(folds.read_text(encoding="utf-8")) if folds.is_file() else None)

    def read_more(self, path, phase):
        self.left_out += read_if(path.with_name(f"{path.stem}_left_out.csv"), LEFT_OUT)
        if phase == FINAL:
            for row in read_if(path.with_name(f"{path.stem}_spread.csv"), ("scene", "label", "settings")):
                self.spread[row["scene"], row["label"], row["settings"]] = row

    def spread_of(self, *key):
        return self.spread.get(key)

    def machine(self):
        """One line on where the times were taken."""
        several = lambda name: ", ".join(sorted({row[name] for row in self.rows}))
        loads = sorted(row["load_average"] for row in self.rows)
        cpu = sum(row["build_s"] + row["query_s"] for row in self.rows) / 60
        built = f"{self.environment['compiler']}, {self.environment['flags']}" if self.environment else "its build is not known"
        built += "" if "NDEBUG" in built else ", assertions on"
        return (f"{several('cpu')}, one thread a trial; causticbench {several('code_version')}, {built}; load average {loads[0]:.0f} to {loads[-1]:.0f} by other "
                f"work (times are CPU times); {len(self.rows)} trials, {cpu:.0f} CPU minutes in the methods.")


def counted_texts():
    from duel.counts import TEXTS

    return TEXTS


def read_if(path, texts):
    return scores.read_csv(path, texts) if path.is_file() else []


def entries(results):
    """One a hypothesis: its words, its cases and its verdict."""
    found = []
    for hypothesis in results.duel.hypotheses:
        cases = measures.cases_of(hypothesis, results)
        verdict, own = verdicts.judge(hypothesis, cases)
        found.append({**{key: hypothesis[key] for key in ("id", "question", "hypothesis", "says", "refuted_if", "metric", "swept")}, "verdict": verdict,
                      "cases": [{"case": case.name, "measured": case.text(), "verdict": each, "note": case.note} for case, each in zip(cases, own)]})
    return found


def verdict_table(found):
    rows = []
    for verdict in ORDER:
        for entry in found:
            if entry["verdict"] == verdict:
                measured = "; ".join(f"{case['case']}: {case['measured']}" for case in entry["cases"]) or "–"
                rows.append([entry["question"], f"{entry['hypothesis']} ({entry['says']})", measured, f"**{verdict}**"])
    return Table("verdicts", "Hypotheses", ["question", "hypothesis", "measured", "verdict"], rows,
                 "95 % intervals in brackets. A hypothesis does not hold where one case lies outside of the region that refutes it.")


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


def number(results, found, kind, words):
    """A number of the page's prose: {error SCENE METHOD SECONDS}, {factor SCENE SECONDS}, {case HYPOTHESIS CASE}, {last SCENE METHOD}
    (seconds at the end of a front)."""
    if kind == "case":
        name, _, case = words.partition(" ")
        return next((each["measured"] for each in found[name]["cases"] if each["case"] == case), "not measured")
    if kind == "last":
        scene, _, method = words.partition(" ")
        field = results.fields.get(scene)
        return tables.seconds(field.curve(method)[-1][0]) if field else "not measured"
    scene, *method, seconds = words.split(" ")
    field = results.fields.get(scene)
    if field is None:
        return "not measured"
    if kind == "factor":
        return tables.factor(curves.quantity(field.seeds, lambda draw: measures.errors_at(field, draw, float(seconds))))
    error = curves.at_time(field.curve(" ".join(method)), float(seconds))
    return tables.percent(error) if error else "no picture yet"


def rendered(results):
    """{file name: text} of all pages."""
    found, every = entries(results), tables.everything(results)
    verdict, lacking = verdict_table(found), not_measured(results)
    of = {entry["id"]: entry for entry in found}
    kept = [verdict, *every, lacking]
    words = (results.duel.folder / "page.md").read_text(encoding="utf-8")
    tally = ", ".join(f"{sum(entry['verdict'] == each for entry in found)} {'hold' if each == HOLDS else each}" for each in ORDER)
    facts = {"machine": results.machine(), "tally": tally.replace("does not hold", "do not hold"), "seeds": str(max(field.seeds for field in results.fields.values())),
             **{table.name: section(table).lstrip("\n").partition("\n\n")[2].rstrip("\n") for table in kept}}
    for name, text in facts.items():
        words = words.replace("{" + name + "}", text)
    words = re.sub(r"\{(error|factor|case|last) ([^}]+)\}", lambda place: number(results, of, *place.groups()), words)
    title = "The duel of photon map and beam tree"
    return {"README.md": words, "verdicts.json": json.dumps(found, indent=1, ensure_ascii=False) + "\n",
            "tables.md": f"# {title}: all tables\n\n{results.machine()}\n" + "".join(map(section, kept)),
            "tables.csv": comma(list(map(plain, kept))), "tables.tex": latex_tables(title, list(map(plain, kept)))}


def write_all(duel, output, quick=False):
    results = Records(duel, output)
    for name, text in rendered(results).items():
        write(output / name, text)
    plots.write(results, output / "plots")
