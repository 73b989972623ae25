"""What came of mutants, as tables in Markdown."""
from collections import Counter

KILLED = ("killed at first", "killed since")


def words(path):
    """Class and reason by the mutant's number, from lines with tabs; what begins with # is for readers."""
    found = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            cells = line.split("\t")
            if len(cells) != 3 or not cells[0].isdigit():
                raise ValueError(f"{path}: not a number, a class and a reason with tabs between: {line}")
            found[int(cells[0])] = (cells[1], cells[2])
    return found


def text(sites, rows, judged):
    """Tables of folders and of what survived the first round. `rows` are results in the order of trials."""
    site_of = {site.number: site for site in sites}  # the compiler may have dropped some numbers
    ends = {}
    for row in rows:
        ends.setdefault(row["number"], []).append(row)
    lines = counted("folder", lambda number: site_of[number].file.split("/")[0], ends, judged)
    lines += ["", "| no. | place | what is there | mutant | came of it | reason |", "|--:|---|---|---|---|---|"]
    for number in sorted(ends, key=lambda number: (site_of[number].file, site_of[number].start)):
        if ends[number][0]["status"] != "killed":
            site = site_of[number]
            what, reason = outcome(ends[number], judged.get(number))
            lines.append(f"| {number} | {site.file}:{site.line} | {code(site.before)} | {code(site.after)} | {what} | {reason} |")
    return "\n".join(lines)


def counted(head, group, ends, judged):
    """A line a group: how many mutants were tried, killed in the first round and since, and what the others are."""
    counts = {}
    for number, own in ends.items():
        what = outcome(own, judged.get(number))[0]
        for name in (group(number), "**all**"):
            counts.setdefault(name, Counter())[what] += 1
    columns = [*KILLED, *sorted(set(counts.get("**all**", ())) - set(KILLED))]
    lines = [f"| {head} | tried | {' | '.join(columns)} |", "|---|--:|" + "--:|" * len(columns)]
    for name in sorted(counts, key=lambda name: (name == "**all**", name)):
        cells = [str(counts[name][column] or "") for column in columns]
        lines.append(f"| {name} | {counts[name].total()} | {' | '.join(cells)} |")
    return lines


def is_alive(own):
    return own[-1]["status"] != "killed"


def outcome(own, word):
    """What a mutant is in the end, and why."""
    if not is_alive(own):
        return KILLED[own[-1]["round"] > 1], f"by {own[-1]['by']}"
    return word or ("not reached" if own[-1]["status"] == "unreached" else "not judged", "")


def code(source):
    """Source in a cell of a table; nothing is a deletion."""
    short = source if len(source) <= 60 else source[:57] + "..."
    return "`" + short.replace("|", "\\|") + "`" if source else "deleted"
