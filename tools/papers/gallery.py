"""results/papers/README.md: what each paper's page says in one line, and all figures with a paragraph each."""
from papers.kept import made_on, read
from papers.page import markdown_table, tally, took
from report.report_files import write

HEAD = """# The papers, reproduced

Made by `tools/reproduce.sh`: every figure, table cell and testable claim of the three papers beside ours. The page of a paper is its
`index.html`; `tables.md`, `.csv` and `.tex` are its tables, `verdicts.json` its claims with what was measured, the interval, the tolerance
and the command of each; `records/` the sweeps' tables. Figures are here as PNG; a run writes those that show radiance as EXR
beside them, which are too large to be kept here.
[replicability.md](replicability.md) is for a reviewer: system, commands, minutes, disk, how to compare.

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
        figures.append(f"\nTaken on {made_on(kept)}\n")
    write(folder / "README.md", HEAD + markdown_table(["paper", "claims", "took", "command"], rows) + "".join(figures))
