"""The page and tables of one paper: index.html, tables.md, tables.csv, tables.tex, verdicts.json, figures; and the gallery of all, README.md."""
import csv
import html
import io
import json
import os

from papers.kept import made_on, read
from papers.latex import latex_tables
from papers.part import Table
from papers.verdict import BY_CONSTRUCTION, FAILS, HOLDS, PARTLY, UNDECIDED, UNMEASURED
from papers.words import short
from report.paper import PUBLISHED
from report.report_files import write

UNSAID = ["what", "chosen here", "how much it matters"]
NOT_TESTED = ["claim of the paper", "where", "why it is not tested"]
CLAIMS = ["claim", "paper", "paper as ratio", "ours", "ours as ratio", "holds?", "factor off"]
STYLE = """body{font:15px/1.45 sans-serif;max-width:72em;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:1em 0;font-size:13px}td,th{border-bottom:1px solid #ddd;padding:.25em .6em;text-align:left;
vertical-align:top}th{border-bottom:2px solid #999}.grey,.grey td{color:#999}h3{margin-bottom:.2em}figure{margin:1.5em 0}
img{max-width:100%}figcaption,.note{font-size:13px;color:#444}.group td{background:#f3f3f3;font-weight:bold}
.verdict{font-weight:bold}code{font-size:12px}"""
COLOURS = {HOLDS: "#1a7f37", BY_CONSTRUCTION: "#57606a", PARTLY: "#0550ae", FAILS: "#c0392b", UNDECIDED: "#9a6700", UNMEASURED: "#777"}


def paper_text(entry):
    return entry["paper"] if isinstance(entry["paper"], str) else f"{short(entry['paper'])} {entry['paper_unit']}".strip()


def ours_text(entry):
    """Median and range of what was measured, and of what it is divided by."""
    if entry["verdict"] == UNMEASURED:
        return UNMEASURED
    return f"{' over '.join(map(ranged, entry['made_of']))} {entry['made_of_unit']}".strip()


def ranged(summary):
    return short(summary["median"]) + (f" ({short(summary['least'])}–{short(summary['greatest'])})" if summary["least"] != summary["greatest"] else "")


def notes(entry):
    """Sentences below a claim: how it was measured, why it cannot fail, what of it is missing, what stands beside the judged counter."""
    texts = [entry["note"], entry["by_construction"] and f"By construction: {entry['by_construction']}", entry["missing"] and f"Missing: {entry['missing']}",
             *[f"Beside it, not judged: {what} {ranged(part)}" for what, part in entry["beside"].items()]]
    return " ".join(f"{text.rstrip('.')}." for text in texts if text)


def ratio_text(entry):
    if entry["ours"] is None or not entry["is_ratio"]:
        return ""
    low, high = entry["spread"]
    return short(entry["ours"]) + (f" ({short(low)}–{short(high)})" if low != high else "")


def claims_table(entries):
    rows = [[entry["claim"], paper_text(entry), short(entry["paper_ratio"]) if entry["paper_ratio"] is not None else "", ours_text(entry),
             ratio_text(entry), entry["verdict"], short(entry["factor_off"]) if entry["factor_off"] is not None else ""] for entry in entries]
    return Table("claims", "Claims", CLAIMS, rows)


def write_page(folder, paper, entries, kept, figures):
    """All files of a paper; the tables' texts go to tables.json, from which a test makes the others again."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "figures").mkdir(exist_ok=True)
    for figure in figures:
        (folder / "figures" / f"{figure.name}.png").write_bytes(figure.png)
        if figure.exr:
            (folder / "figures" / f"{figure.name}.exr").write_bytes(figure.exr)
    write(folder / "verdicts.json", json.dumps(entries, indent=1, ensure_ascii=False) + "\n")
    write(folder / "tables.json", json.dumps(kept, indent=1, ensure_ascii=False) + "\n")
    for name, text in rendered(paper, entries, kept).items():
        write(folder / name, text)


def rendered(paper, entries, kept):
    """{file name: text} of everything that follows from verdicts.json and tables.json."""
    tables = [Table(**each) for each in kept["tables"]]
    every = [claims_table(entries), *stated(kept), *tables, Table("tolerances", "Tolerances", COMMANDS[:3], [row[:3] for row in commands(entries)])]
    return {"tables.md": markdown(paper, entries, kept, tables), "tables.csv": comma(every),
            "tables.tex": latex_tables(f"{paper.text['author']}: {paper.text['title']}", every), "index.html": page(paper, entries, kept, tables)}


def stated(kept):
    """What the paper leaves open, and what of it is not tested."""
    open_questions = [Table("unsaid", "What the paper does not say", UNSAID, kept["unsaid"])]
    untested = kept.get("not_tested", [])
    return open_questions + ([Table("not_tested", "Claims that are not tested", NOT_TESTED, untested)] if untested else [])


def took(kept):
    return "single sections" if not kept["machine"] else f"{kept['minutes']:.0f} minutes ({kept['cpu_minutes']:.0f} of CPU time)"


def made(kept):
    return f"in {took(kept)} {made_on(kept)}" if kept["machine"] else made_on(kept)


def tally(entries):
    count = lambda verdict: sum(entry["verdict"] == verdict for entry in entries)
    several = {HOLDS: "hold", BY_CONSTRUCTION: "hold by construction", PARTLY: "hold partly", FAILS: "do not hold"}
    one = {BY_CONSTRUCTION: "holds by construction", PARTLY: "holds partly"}
    return ", ".join(f"{count(verdict)} {(several if count(verdict) > 1 else one).get(verdict, verdict)}"
                     for verdict in (HOLDS, PARTLY, BY_CONSTRUCTION, FAILS, UNDECIDED, UNMEASURED) if count(verdict))


def by_group(entries):
    groups = {}
    for entry in entries:
        groups.setdefault(entry["group"], []).append(entry)
    return groups.items()


def markdown_table(heading, rows):
    line = lambda fields: "| " + " | ".join(str(field).replace("|", "\\|") for field in fields) + " |"
    return "\n".join([line(heading), "|" + "---|" * len(heading), *map(line, rows)]) + "\n"


def markdown(paper, entries, kept, tables):
    text = [f"# {paper.text['author']}: {paper.text['title']}\n", f"{paper.text['published']}. {len(entries)} claims: {tally(entries)}.\n",
            f"Made by `tools/reproduce.sh {paper.name}` {made(kept)}\n", HOW]
    for group, own in by_group(entries):
        rows = claims_table(own).rows
        for row, entry in zip(rows, own):
            row[5] = f"**{entry['verdict']}**"
        text.append(f"\n## {group}\n\n" + markdown_table(CLAIMS, rows))
        below = [f"* {entry['claim']}: {notes(entry)}" for entry in own if notes(entry)]
        if below:
            text.append("\n".join(below) + "\n")
    for table in [*stated(kept), *tables]:
        text.append(f"\n## {table.title}\n\n" + markdown_table(table.heading, table.rows) + (f"\n{table.note}\n" if table.note else ""))
    if paper.text["seconds"]:
        text.append(f"\n## The paper's seconds\n\nOn {paper.text['machine']}; ours are compared as ratios only.\n\n"
                    + markdown_table(["what", "s", "where"], seconds(paper)))
    text.append("\n## Tolerances and commands\n\n" + markdown_table(COMMANDS, [[*row[:-1], row[-1] and f"`{row[-1]}`"] for row in commands(entries)])
                + f"\n{ANEW.format(paper.name)}\n")
    return "\n".join(text)


HOW = ("A claim holds where the interval of ours lies within the region of the last table, does not hold where it lies outside, and is undecided "
       "between. The interval is Student's 95 % interval of the mean over seeds or repeats: it leaves out 2.5 % at each end. Its scale is that of "
       "ratios; of what may be negative it is linear. Counted values are the same on every run. \"By construction\" is what cannot fail, because it "
       "follows from numbers that were put in: it is counted apart from what holds. \"Partly\" is what holds while a part of the claim is not built "
       "or not tested; the row names that part. "
       "Times are CPU times of one thread: median (least–greatest); sweeps on whose times no claim rests run two trials at a time. "
       "Factor off: ours over the paper's.\n")


COMMANDS = ["claim", "holds where ours is", "because of", "section", "minutes", "MB", "command"]
ANEW = "`tools/reproduce.sh {} --only SECTION` makes the rows, tables and figures of one section anew, if its trials are removed first."


def commands(entries):
    disk = lambda entry: "" if entry["megabytes"] is None else f"{entry['megabytes']:.1f}"
    return [[entry["claim"], entry["region"], entry["tolerance_from"], entry["section"], f"{entry['minutes']:.1f}", disk(entry), entry["command"]]
            for entry in entries]


def seconds(paper):
    return [[what, short(paper.number(name)), paper.text["numbers"][name]["where"]] for what, name in paper.text["seconds"]]


def comma(tables):
    """Tables one after another as CSV, each below a line with its title."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for table in tables:
        writer.writerow([f"# {table.title}"])
        writer.writerow(table.heading)
        writer.writerows(table.rows)
    return text.getvalue()


def page(paper, entries, kept, tables):
    e = html.escape
    cells = lambda fields, tag="td": "<tr>" + "".join(f"<{tag}>{e(str(field))}</{tag}>" for field in fields) + "</tr>\n"
    table = lambda heading, rows, kind="": f"<table class='{kind}'>{cells(heading, 'th')}{''.join(map(cells, rows))}</table>\n"
    body = [f"<h1>{e(paper.text['title'])}</h1>\n<p>{e(paper.text['author'])}. {e(paper.text['published'])}.</p>\n<p><b>{len(entries)} claims: "
            f"{tally(entries)}.</b> Made by <code>tools/reproduce.sh {paper.name}</code> {e(made(kept))}</p>\n"
            f"<p class='note'>{e(HOW)}</p>\n<table>{cells(CLAIMS, 'th')}"]
    for group, own in by_group(entries):
        body.append(f"<tr class='group'><td colspan='{len(CLAIMS)}'>{e(group)}</td></tr>\n")
        for row, entry in zip(claims_table(own).rows, own):
            note = f"<br><span class='note'>{e(notes(entry))}</span>" if notes(entry) else ""
            verdict = f"<td class='verdict' style='color:{COLOURS[entry['verdict']]}'>{entry['verdict']}</td>"
            body.append("<tr>" + f"<td>{e(row[0])} <span class='grey'>{e(entry['where'])}</span>{note}</td>"
                        + "".join(f"<td>{e(field)}</td>" for field in row[1:5]) + verdict + f"<td>{e(row[6])}</td></tr>\n")
    body.append("</table>\n")
    body += [f"<h2>{e(each.title)}</h2>\n{table(each.heading, each.rows)}" for each in stated(kept)]
    for each in kept["figures"]:
        body.append(f"<figure><h3>{e(each['title'])}</h3><img src='figures/{each['name']}.png' alt='{e(each['title'], quote=True)}'>"
                    f"<figcaption>{e(each['caption'])}</figcaption></figure>\n")
    for each in tables:
        body.append(f"<h3>{e(each.title)}</h3>\n{table(each.heading, each.rows)}" + (f"<p class='note'>{e(each.note)}</p>\n" if each.note else ""))
    if paper.text["seconds"]:
        body.append(f"<h3 class='grey'>The paper's seconds</h3><p class='grey'>On {e(paper.text['machine'])}; ours are compared as ratios only.</p>\n"
                    + table(["what", "s", "where"], seconds(paper), "grey"))
    body.append(f"<h2>Tolerances and commands</h2>\n<p class='note'>{e(ANEW.format(paper.name))}</p>\n<table>{cells(COMMANDS, 'th')}")
    for *fields, command in commands(entries):
        body.append("<tr>" + "".join(f"<td>{e(field)}</td>" for field in fields) + f"<td><code>{e(command)}</code></td></tr>\n")
    body.append("</table>\n")
    return (f"<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><title>{e(paper.text['title'])}: reproduced</title>"
            f"<style>{STYLE}</style></head><body>\n{''.join(body)}</body></html>\n")


GALLERY = """# The papers, reproduced

Made by `tools/reproduce.sh`: every figure, table cell and testable claim of the three papers beside ours. The page of a paper is its
`index.html`; `tables.md`, `.csv` and `.tex` are its tables, `verdicts.json` its claims with what was measured, the interval, the tolerance
and the command of each; `records/` the sweeps' tables. Figures are here as PNG; a run writes those that show radiance as EXR
beside them, which are too large to be kept here.
[replicability.md]({guide}) is for a reviewer: system, commands, minutes, disk, how to compare.

"""


def write_gallery(folder, papers):
    """Of the papers that have been reproduced into the folder."""
    rows, figures = [], []
    for paper in papers:
        if not (folder / paper.name / "tables.json").is_file():
            continue
        entries, kept = read(folder / paper.name)
        rows.append([f"[{paper.text['author']}: {paper.text['title']}]({paper.name}/tables.md)", tally(entries), took(kept),
                     f"`tools/reproduce.sh {paper.name}`"])
        figures.append(f"\n## {paper.text['author']}: {paper.text['title']}\n")
        figures += [f"\n### {each['title']}\n\n![{each['title']}]({paper.name}/figures/{each['name']}.png)\n\n{each['caption']}\n" for each in kept["figures"]]
        figures.append(f"\nTaken {made_on(kept)}\n")
    guide = os.path.relpath(PUBLISHED / "replicability.md", folder)
    write(folder / "README.md", GALLERY.format(guide=guide) + markdown_table(["paper", "claims", "took", "command"], rows) + "".join(figures))
