"""Numbers of results/papers that other pages cite: each is a link whose title names the claim, and has the claim's value.

A number is cited as [1.16](results/papers/jensen1996/tables.md "ball_growth").
"""
import json
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from papers.words import short
from report.paper import NAMES

PAGES = ("PAPERS.md", "photonmap/README.md", "beamtree/README.md")
CITED = re.compile(r'\[([^]]+)\]\(([^)\s]+/)?results/papers/(\w+)/tables\.md "([\w.]+)"\)')
CLAUSE = re.compile(r"[;|\n]|\. ")
THEIRS = re.compile(r"\(paper: [^)]*\)")  # what the paper has is not ours


def values(paper):
    """{claim: its value as the page shows it}."""
    entries = json.loads((ROOT / "results" / "papers" / paper / "verdicts.json").read_text(encoding="utf-8"))
    return {entry["id"]: short(entry["ours"]) for entry in entries if entry["ours"] is not None}


def wrong(text):
    """Citations of results/papers in a text that have no link, or whose number is not there."""
    kept = {paper: values(paper) for paper in NAMES}
    found = [f"{number} of {paper} {claim}: it is {kept.get(paper, {}).get(claim, 'no claim')}"
             for number, _, paper, claim in CITED.findall(text) if kept.get(paper, {}).get(claim) != number]
    for clause in CLAUSE.split(THEIRS.sub("", CITED.sub(lambda match: f"results/papers/{match[3]}", text))):
        if "results/papers" in clause:
            found += [f"{number}: a number without a link in: {clause.strip()}" for number in re.findall(r"(?<![\w.])\d+\.\d+(?![\w.])", clause)]
    return found


class Cited(unittest.TestCase):
    def test_pages_cite_what_is_published(self):
        for page in PAGES:
            self.assertEqual(wrong((ROOT / page).read_text(encoding="utf-8")), [], page)

    def test_something_is_cited(self):
        self.assertGreaterEqual(sum(len(CITED.findall((ROOT / page).read_text(encoding="utf-8"))) for page in PAGES), 6)

    def test_stale_numbers_are_found(self):
        claim, value = next(iter(values("jensen1996").items()))
        link = f'[{{}}](../results/papers/jensen1996/tables.md "{claim}")'
        self.assertEqual(wrong(f"| a | {link.format(value)} times (paper: 1.52) |"), [])
        self.assertEqual(len(wrong(link.format(value + "1"))), 1)
        self.assertEqual(len(wrong('[1](results/papers/jensen1996/tables.md "nowhere")')), 1)

    def test_numbers_without_a_link_are_found(self):
        self.assertEqual(len(wrong("| results/papers/jensen1996, on its own scene: renderings 2.09 and 2.64 |")), 2)
        self.assertEqual(wrong("| results/bench: 4.4 times; results/papers/jensen1996 (figure 3) |"), [])


if __name__ == "__main__":
    unittest.main()
