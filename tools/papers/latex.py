"""Tables for LaTeX: long tables whose columns share the line by what they hold, in plain ASCII, so that any LaTeX takes them."""

LEAST, MOST = 7, 34  # letters of a column, for its share of the line; a word that is longer makes it wider
LETTERS = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}",
           "^": r"\textasciicircum{}", "–": "--", "×": r"$\times$", "·": r"$\cdot$", "µ": r"$\mu$", "°": r"$^\circ$", "<": r"$<$", ">": r"$>$",
           "≤": r"$\le$", "†": r"$\dagger$", "≥": r"$\ge$", "|": r"$|$", "é": r"\'e", "ü": r'\"u', "“": "``", "”": "''", "’": "'"}
RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def escaped(field):
    """A cell's text; raises ValueError for a letter that has no ASCII form here."""
    text, raised = [], ""
    for letter in [*str(field), ""]:
        if letter and ord(letter) in RAISED:
            raised += letter.translate(RAISED)
            continue
        if raised:
            text.append(f"$^{{{raised}}}$")
            raised = ""
        text.append(LETTERS.get(letter, letter))
    found = "".join(text)
    if not found.isascii():
        raise ValueError(f"no LaTeX form for a letter of {field!r}")
    return found


def columns(table):
    """p-columns, each with a share of the line."""
    every = [table.heading, *table.rows]
    letters = [[str(row[k]) for row in every] for k in range(len(table.heading))]
    word = lambda fields: 2 + max(len(each) for field in fields for each in (field.split() or [""]))
    wide = [max(LEAST, word(fields), min(MOST, max(map(len, fields)))) for fields in letters]
    return "".join(rf">{{\raggedright\arraybackslash}}p{{\dimexpr {each / sum(wide):.3f}\linewidth-2\tabcolsep\relax}}" for each in wide)


def latex_tables(title, tables):
    """Tables one after another, below a comment that names the packages."""
    line = lambda fields: " & ".join(map(escaped, fields)) + r" \\"
    text = [f"% {escaped(title)}; needs the packages array, booktabs and longtable", r"\begingroup\footnotesize\setlength{\tabcolsep}{2pt}"]
    for table in tables:
        text += [rf"\begin{{longtable}}{{{columns(table)}}}", rf"\caption{{{escaped(table.title)}}}\\", r"\toprule", line(table.heading),
                 r"\midrule\endhead", *map(line, table.rows), r"\bottomrule", r"\end{longtable}", *([escaped(table.note), ""] if table.note else [""])]
    return "\n".join([*text, r"\endgroup", ""])
