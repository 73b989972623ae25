"""Pages lead where they say: every link of a page, and every test that a page names, is there."""
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
# Written to another folder with its links as they are: results/duel.
TEMPLATES = {"experiments/duel/page.md"}
# What came and went, and the example of a test that is to be written.
FREE = {"CHANGELOG.md"}
EXAMPLES = {"caustics_test", "kd_tree_test"}


def pages():
    """{path: text without code blocks} of the pages that a clone has."""
    skipped = {".git", ".venv", "build", "out"}
    found = (path for path in ROOT.rglob("*.md") if not skipped & set(path.relative_to(ROOT).parts))
    return {path: re.sub(r"```.*?```", "", path.read_text(encoding="utf-8"), flags=re.DOTALL) for path in sorted(found)}


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def broken(page, text):
    """The page's links that lead nowhere."""
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        place, _, part = link.partition("#")
        if re.match(r"[a-z]+:", link):
            continue
        target = page.parent / place if place else page
        if not target.exists():
            yield link
        elif part and part not in map(anchor, re.findall(r"^#+ (.*)$", target.read_text(encoding="utf-8"), re.MULTILINE)):
            yield link


class Pages(unittest.TestCase):
    def setUp(self):
        self.pages = pages()
        self.assertGreater(len(self.pages), 50)

    def name(self, page):
        return page.relative_to(ROOT).as_posix()

    def test_links_lead_somewhere(self):
        for page, text in self.pages.items():
            if self.name(page) not in TEMPLATES:
                self.assertEqual(list(broken(page, text)), [], self.name(page))

    def test_a_link_that_leads_nowhere_is_noticed(self):
        readme = ROOT / "README.md"
        text = "[a](no/such/file.md) [b](PAPERS.md#symbols) [c](PAPERS.md#no-such-part) [d](#methods) [e](https://example.org)"
        self.assertEqual(list(broken(readme, text)), ["no/such/file.md", "PAPERS.md#no-such-part"])

    def test_no_page_holds_the_marks_of_a_merge(self):
        for page, text in self.pages.items():
            self.assertNotRegex(text, r"(?m)^(<<<<<<<|>>>>>>>)( |$)", self.name(page))

    def test_tests_that_are_named_are_there(self):
        files = [path.relative_to(ROOT / "tests").with_suffix("").as_posix() for path in (ROOT / "tests").rglob("*_test.*")]
        for page, text in self.pages.items():
            for name in set(re.findall(r"(?<![\w.])([\w/]+_test)\b", text)) - EXAMPLES:
                if self.name(page) not in FREE:
                    self.assertTrue(any(f"/{file}".endswith(f"/{name.removeprefix('tests/')}") for file in files), f"{self.name(page)}: {name}")

    def test_cases_that_are_named_are_there(self):
        sources = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("*.cpp"))
        cases = set(re.findall(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", sources))
        suites = {suite for suite, _ in cases}
        for page, text in self.pages.items():
            for suite, case in re.findall(r"\b([A-Z]\w+)\.([A-Z]\w+)(?!…)\b", text):
                if suite in suites and self.name(page) not in FREE:
                    self.assertTrue((suite, case) in cases, f"{self.name(page)}: {suite}.{case}")


if __name__ == "__main__":
    unittest.main()
