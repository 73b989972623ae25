"""verdicts.json and tables.json of one paper: what its pages are made from, and how a run of some sections changes them."""
import ast
import json
import pathlib

from papers.entries import entries


class Facts(dict):
    """Words for the texts of PAPER.json in braces."""

    def __missing__(self, name):
        return "(not run yet)"


def sections(modules):
    """{section: function} of all parts, in their order."""
    return {name: run for module in modules for name, run in module.SECTIONS.items()}


def section_names(module):
    """The sections of a part, read from its source: NumPy, which it imports, may not be installed yet."""
    source = (pathlib.Path(__file__).parent / f"{module}.py").read_text(encoding="utf-8")
    assigned = {target.id: node.value for node in ast.parse(source).body if isinstance(node, ast.Assign)
                for target in node.targets if isinstance(target, ast.Name)}
    return [key.value for key in assigned["SECTIONS"].keys]


def read(folder):
    """(entries, kept) of an earlier run."""
    return tuple(json.loads((folder / name).read_text(encoding="utf-8")) for name in ("verdicts.json", "tables.json"))


def is_there(folder):
    """True where an earlier run left its rows and tables in the folder."""
    return (folder / "tables.json").is_file()


def nothing(study):
    """The tables of a folder without an earlier run: those of its first sections follow."""
    return {"machine": "", "anew": {}, "minutes": round(study.minutes(), 1), "cpu_minutes": round(study.cpu_minutes(), 1),
            "tables": [], "figures": []}


def of_whole_run(study, part, machine):
    """(entries, kept) of a run of all sections."""
    texts = {"machine": machine, "anew": {}, "minutes": round(study.minutes(), 1), "cpu_minutes": round(study.cpu_minutes(), 1)}
    return entries(study, part), texts | pieces(study.paper, part, dict(part.facts))


def of_some(study, part, machine, order, ran):
    """(entries, kept) where the sections `ran` were made anew; the other rows, tables and figures are the earlier run's, or none.

    `order` names all sections. Minutes stay those of the whole run.
    """
    rows, kept = read(study.output) if is_there(study.output) else ([], nothing(study))
    found = entries(study, part, {row["id"]: row for row in rows})
    own = pieces(study.paper, part, kept.get("facts", {}) | part.facts)
    for kind in ("tables", "figures"):
        others = [each for each in kept[kind] if each["section"] in order and each["section"] not in ran]
        own[kind] = sorted([*others, *own[kind]], key=lambda each: order.index(each["section"]))
    anew = {name: text for name, text in kept.get("anew", {}).items() if name in order} | dict.fromkeys(ran, machine)
    return found, kept | own | {"anew": anew}


def pieces(paper, part, facts):
    unsaid = [[each["what"], each["chosen"], each["matters"].format_map(Facts(facts))] for each in paper.text["unsaid"]]
    untested = [[each["claim"], each["where"], each["reason"].format_map(Facts(facts))] for each in paper.text.get("not_tested", [])]
    figures = [{"name": figure.name, "title": figure.title, "caption": figure.caption, "section": figure.section} for figure in part.figures]
    return {"facts": facts, "unsaid": unsaid, "not_tested": untested, "tables": [vars(table) for table in part.tables], "figures": figures}


def made_on(kept):
    """Where the whole run was made, if there was one, and which sections since then."""
    by_machine = {}
    for section, machine in kept["anew"].items():
        by_machine.setdefault(machine, []).append(section)
    since = [f"{', '.join(names)}{f' on {machine}' if machine else ''}".rstrip(".") for machine, names in by_machine.items()]
    if not kept["machine"]:
        return f"section by section: {'; '.join(since)}."
    return "on " + kept["machine"] + (f" Made anew since: {'; '.join(since)}." if since else "")
