"""The summary of records.csv as tables, and the page that shows them beside the plots and figures."""
import csv
import html
import io
import os
import urllib.parse

from report.records import FORMULAS, UNITS, missed_text, table_head

SUMMARISED = ("rmse", "relmse", "mean_ratio", "total_s", "precompute_s", "render_s", "photons_stored",
              "reference_stderr")
PRINTED = ("rmse", "relmse", "mean_ratio", "total_s")
TEX_UNITS = {**UNITS, "rmse": r"$\mathrm{W\,m^{-2}\,sr^{-1}}$"}
CAPTION = ("Median [min, max] over seeds and repeats; x the picture, r the reference, over all reached pixels and "
           "channels of the caustic layer; " + "; ".join(FORMULAS.values()) + "; total_s: wall time of the whole "
           "trial [s]. In summary.csv reference_stderr is a share of mean(r). An empty field does not apply.")
TEX_CAPTION = (r"Median [min, max] over seeds and repeats; $x$ the picture, $r$ the reference, over all reached pixels "
               r"and channels of the caustic layer; $\mathrm{rmse}=\sqrt{\mathrm{mean}\,(x-r)^2}$; "
               r"$\mathrm{relmse}=\mathrm{mean}\,\frac{(x-r)^2}{r^2+\varepsilon}$ with "
               r"$\varepsilon=0.01\,\mathrm{mean}(r)^2$; $\mathrm{mean\_ratio}=\mathrm{mean}(x)/\mathrm{mean}(r)$; "
               r"total\_s: wall time of the whole trial.")
PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>causticbench report</title>
<style>
body {{ font: 16px/1.5 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; color: #222; }}
figure {{ display: inline-block; margin: 0 1.5em 1.5em 0; vertical-align: top; max-width: 100%; }}
figcaption {{ font-size: 0.85em; color: #555; }}
img {{ max-width: 100%; height: auto; }}
.table {{ overflow-x: auto; }}
table {{ border-collapse: collapse; font-size: 0.8em; font-variant-numeric: tabular-nums; }}
caption {{ text-align: left; padding-bottom: 0.5em; }}
th, td {{ padding: 0.15em 0.8em 0.15em 0; text-align: left; white-space: nowrap; }}
thead th {{ border-top: 2px solid; border-bottom: 1px solid; }}
tbody tr:last-child td {{ border-bottom: 2px solid; }}
</style>
</head>
<body>
<h1>causticbench report</h1>
<p>{counts}</p>
<h2>Plots</h2>
{plots}
<h2>Table</h2>
<p>The same as <a href="summary.csv">summary.csv</a> (more columns, all digits), <a href="summary.md">summary.md</a>,
<a href="summary.tex">summary.tex</a>.</p>
<div class="table">
{table}
</div>
{missed}<h2>Figures</h2>
{figures}
</body>
</html>
"""


def shown_parameters(records):
    """The parameters worth a column: those that differ among the cells."""
    return [name for name in records.parameters if len(values_of(records, name)) > 1]


def shared_parameters(records):
    """The others, a name and a value each."""
    return [(name, value) for name in records.parameters if len(values_of(records, name)) == 1
            for value in values_of(records, name) if value]


def values_of(records, name):
    return {cell.parameters.get(name, "") for cell in records.cells}


def said_of_shared(records, word=str):
    """The end of a caption: what has no column, because it is the same in every row."""
    shared = ", ".join(f"{word(name)} {word(value)}" for name, value in shared_parameters(records))
    return f" In all rows: {shared}." if shared else ""


def summary_csv(records):
    """Every cell with the median, minimum and maximum of each summarised measure, all digits."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    measured = [f"{name}_{what}" for name in SUMMARISED for what in ("median", "min", "max")]
    writer.writerow(table_head(records.parameters, ["scene", "method"], ["records", "seeds", *measured]))
    for cell in records.cells:
        numbers = []
        for name in SUMMARISED:
            spread = cell.spread(name)
            numbers += [repr(v) for v in (spread.median, spread.low, spread.high)] if spread else [""] * 3
        writer.writerow([cell.scene, cell.method, *(cell.parameters.get(name, "") for name in records.parameters),
                         len(cell.records), cell.seeds(), *numbers])
    return text.getvalue()


def body(records):
    """The rows of the printed tables, without their heading."""
    for cell in records.cells:
        yield ([cell.scene, cell.method] + [cell.parameters.get(name, "") for name in shown_parameters(records)]
               + [str(cell.seeds())] + [spread_text(cell.spread(name)) for name in PRINTED])


def spread_text(spread):
    if spread is None:
        return ""
    short = lambda value: f"{value:.3g}"
    if spread.low == spread.high:
        return short(spread.median)
    return f"{short(spread.median)} [{short(spread.low)}, {short(spread.high)}]"


def heading(records):
    return ["scene", "method", *shown_parameters(records), "seeds"] + [f"{name} [{UNITS[name]}]" for name in PRINTED]


def missed_light(records):
    """A sentence for each cell whose caustic lacks light."""
    for cell in records.cells:
        told = missed_text(cell.records)
        if told:
            named = [f"{name} {cell.parameters[name]}" for name in shown_parameters(records) if name in cell.parameters]
            yield f"{', '.join([cell.scene, cell.method, *named])}: {told}."


def summary_md(records):
    line = lambda fields: "| " + " | ".join(map(markdown, fields)) + " |\n"
    titles = heading(records)
    return (CAPTION + said_of_shared(records, markdown) + "\n\n" + line(titles) + "|" + "---|" * len(titles) + "\n"
            + "".join(line(row) for row in body(records))
            + "".join(["\nLight that caustics lack:\n\n"] * any(missed_light(records)))
            + "".join(f"* {markdown(sentence)}\n" for sentence in missed_light(records)))


def markdown(text):
    """A text of others in Markdown: its HTML is shown, not obeyed, and it stays in its line and its cell."""
    return " ".join(html.escape(text, quote=False).replace("|", r"\|").split())


def summary_tex(records):
    """A fragment for \\input; needs the packages booktabs and longtable."""
    words = ["scene", "method", *shown_parameters(records), "seeds"]
    titles = " & ".join([tex(word) for word in words] + [f"{tex(name)} [{TEX_UNITS[name]}]" for name in PRINTED])
    columns = "l" * len(words) + "l" * len(PRINTED)
    rows = "".join(" & ".join(tex(field) for field in row) + " \\\\\n" for row in body(records))
    return ("% Needs \\usepackage{booktabs,longtable} and one column of text; tables that fit any column: causticbench report"
            " DIR --tables OUT\n"
            f"\\begin{{longtable}}{{@{{}}{columns}@{{}}}}\n\\caption{{{TEX_CAPTION}{said_of_shared(records, tex)}}}\\\\\n\\toprule\n{titles} \\\\\n"
            f"\\midrule\n\\endfirsthead\n\\toprule\n{titles} \\\\\n\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n"
            f"{rows}\\end{{longtable}}\n")


def tex(text):
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
               "[": "{[}", "]": "{]}"}  # a bracket after \\ would be read as its argument
    special.update({c: "\\" + c for c in "#$%&_{}"})
    return "".join(special.get(c, c) for c in text)


def page(records, plots, figures):
    """index.html; `plots` are (path, caption), `figures` paths, all relative to the page."""
    left_out = "; ".join(f"{count} {status} left out" for status, count in records.left_out.items())
    done = sum(len(cell.records) for cell in records.cells)
    picture = lambda path, caption: (f'<figure><img src="{urllib.parse.quote(path)}" alt="{html.escape(caption)}">'
                                     f"<figcaption>{html.escape(caption)}</figcaption></figure>")
    cells = lambda fields, tag: "".join(f"<{tag}>{html.escape(field)}</{tag}>" for field in fields)
    rows = "\n".join(f"<tr>{cells(row, 'td')}</tr>" for row in body(records))
    table = (f"<table>\n<caption>{html.escape(CAPTION + said_of_shared(records))}</caption>\n"
             f"<thead><tr>{cells(heading(records), 'th')}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n</table>")
    return PAGE.format(
        counts=html.escape(f"{done} trials done" + (f"; {left_out}" if left_out else "") + "."),
        plots="\n".join(picture(path, caption) for path, caption in plots) or "<p>None.</p>",
        table=table,
        missed="".join(f"<p>{html.escape(sentence)}</p>\n" for sentence in missed_light(records)),
        figures="\n".join(picture(path, os.path.basename(path)) for path in figures) or "<p>None.</p>")
